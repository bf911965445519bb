// The status line, and the bar with the state of the connection.

import type { ConnectionState } from "./connection";
import { byId } from "./dom";
import type { Fineness } from "./frames";
import { setText, visibleLine } from "./visible";

const FINENESS: Record<Fineness, string> =
  { coarse: "coarse", sharp: "one sample a pixel", final: "finished" };

/** Names what is under the pointer. */
export function point(text: string): void { setText(byId("pointed"), text); }

/** Shows a message. */
export function say(text: string, tone: "plain" | "warning" = "plain"): void {
  const said = byId("said");
  setText(said, visibleLine(text));
  said.dataset["tone"] = tone;
}

/** Removes a message if it is still shown. */
export function unsay(text: string): void { if (byId("said").textContent === text) say(""); }

/** Removes a message about an older text, unless it is a warning. */
export function changed(): void { if (byId("said").dataset["tone"] !== "warning") say(""); }

export function picture([width, height]: [number, number], fineness: Fineness): void {
  setText(byId("frame-state"), `${width} × ${height}, ${FINENESS[fineness]}`);
}

/** Marks the picture as outdated with a reason, or as current for null. */
export function stale(why: string | null): void {
  const note = byId("stale");
  note.hidden = why === null;
  setText(note, why ?? "");
  byId("stage").toggleAttribute("data-stale", why !== null);
}

/** Shows what is wrong with the connection, and what happens to the text meanwhile. */
export function connection(state: ConnectionState | "hanging", hasText: boolean): void {
  const isKept = hasText && state !== "connecting" && state !== "open";
  byId("connection-bar").hidden = state === "open";
  byId("connection-kept").hidden = !isKept;
  const said = byId("connection-states").querySelector(`[data-state=${state}]`)?.textContent ?? "";
  setText(byId("connection"), said);
}
