// The line at the bottom: what is under the pointer, what has happened, how far the picture is, and
// whether the engine answers.

import type { ConnectionState } from "./connection";
import { byId } from "./dom";
import type { Fineness } from "./frames";
import { setText, visibleLine } from "./visible";

const FINENESS: Record<Fineness, string> =
  { coarse: "coarse", sharp: "one sample a pixel", final: "finished" };

/** Where a page without a connection gets one. */
const OPEN_PRINTED = "open the address that pinhole studio has printed in its terminal, in this "
  + "tab";

const CONNECTION: Record<ConnectionState, string> = {
  open: "",
  connecting: "Connecting…",
  lost: "Connection lost; connecting again…",
  failed: "The engine has stopped; it is started again…",
  silent: `Nothing answers at this address any more. If Studio was ended, start it again, `
    + `and ${OPEN_PRINTED}.`,
  ended: `Studio was ended. Start it again, and ${OPEN_PRINTED}.`,
  keyless: `This tab has no token of Studio: ${OPEN_PRINTED}.`,
  unknown: `This address is from an earlier run of Studio, or incomplete: ${OPEN_PRINTED}.`,
  restarted: `Studio was started anew, and does not know this tab: ${OPEN_PRINTED}.`,
  late: `The address that a browser is started with serves for a minute, which is over: `
    + `${OPEN_PRINTED}.`,
  twice: `The address that a browser was started with was opened twice, perhaps by `
    + `somebody else on this computer. Its session has ended: ${OPEN_PRINTED}.`,
};

const HANGS = "Nothing has come back for two seconds: Studio is stopped, or has too much to do.";

/** What becomes of a text until there is a connection again. */
const KEPT = " What is written here stays, and can be downloaded.";

/** Names what is under the pointer. */
export function point(text: string): void { setText(byId("pointed"), text); }

/** Says what has happened. */
export function say(text: string, tone: "plain" | "warning" = "plain"): void {
  const said = byId("said");
  setText(said, visibleLine(text));
  said.dataset["tone"] = tone;
}

/** The text has changed: what was said of the one before is not true any more. */
export function changed(): void { if (byId("said").dataset["tone"] !== "warning") say(""); }

export function picture([width, height]: [number, number], fineness: Fineness): void {
  setText(byId("frame-state"), `${width} × ${height}, ${FINENESS[fineness]}`);
}

/** Marks the picture as one of an older text, or no longer. */
export function stale(why: string | null): void {
  const note = byId("stale");
  note.hidden = why === null;
  setText(note, why ?? "");
  byId("stage").toggleAttribute("data-stale", why !== null);
}

/** Says that nothing comes back, although there is a connection. */
export function hanging(isHanging: boolean): void {
  byId("connection-bar").hidden = !isHanging;
  byId("connection-download").hidden = !isHanging;
  if (isHanging) setText(byId("connection"), HANGS + KEPT);
}

/** Says whether there is a connection, and if not, what becomes of the text. */
export function connection(state: ConnectionState, hasText: boolean): void {
  const isKept = hasText && state !== "connecting";
  byId("connection-bar").hidden = state === "open";
  byId("connection-download").hidden = !isKept;
  setText(byId("connection"), CONNECTION[state] + (isKept ? KEPT : ""));
}
