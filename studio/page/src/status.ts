// The status line, and the bar that shows the state of the connection.

import type { ConnectionState } from "./connection";
import { byId } from "./dom";
import type { Fineness } from "./frames";
import { setText, visibleLine } from "./visible";

const FINENESS: Record<Fineness, string> =
  { coarse: "coarse", sharp: "one sample a pixel", final: "finished" };

/** Shows a description of what is under the pointer. */
export function point(text: string): void { setText(byId("pointed"), text); }

/** Shows a message in the status line. */
export function say(text: string, tone: "plain" | "warning" = "plain"): void {
  const said = byId("said");
  setText(said, visibleLine(text));
  said.dataset["tone"] = tone;
}

/** Removes the message `text` from the status line if it is still shown. */
export function unsay(text: string): void { if (byId("said").textContent === text) say(""); }

/** Removes the message after a change of the text. A warning stays. */
export function changed(): void { if (byId("said").dataset["tone"] !== "warning") say(""); }

export function picture([width, height]: [number, number], fineness: Fineness): void {
  setText(byId("frame-state"), `${width} × ${height}, ${FINENESS[fineness]}`);
}

/** Marks the picture as outdated and shows the reason `why`. If `why` is null, removes the mark. */
export function markOutdated(why: string | null): void {
  const note = byId("stale");
  note.hidden = why === null;
  setText(note, why ?? "");
  byId("stage").toggleAttribute("data-stale", why !== null);
}

/** Shows the state of the connection; hides the bar if the connection is open. If `hasText` is set,
 * also says where unsaved text is kept while the connection is lost or does not answer. */
export function connection(state: ConnectionState | "hanging", hasText: boolean): void {
  const isKept = hasText && state !== "connecting" && state !== "open";
  byId("connection-bar").hidden = state === "open";
  byId("connection-kept").hidden = !isKept;
  const said = byId("connection-states").querySelector(`[data-state=${state}]`)?.textContent ?? "";
  setText(byId("connection"), said);
}
