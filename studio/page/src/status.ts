// The line at the bottom, and the bar that says what is wrong with the connection.

import type { ConnectionState } from "./connection";
import { byId } from "./dom";
import type { Fineness } from "./frames";
import { setText, visibleLine } from "./visible";

const FINENESS: Record<Fineness, string> =
  { coarse: "coarse", sharp: "one sample a pixel", final: "finished" };

/** Names what is under the pointer. */
export function point(text: string): void { setText(byId("pointed"), text); }

/** Says what has happened. */
export function say(text: string, tone: "plain" | "warning" = "plain"): void {
  const said = byId("said");
  setText(said, visibleLine(text));
  said.dataset["tone"] = tone;
}

/** What was said is not so any more. */
export function unsay(text: string): void { if (byId("said").textContent === text) say(""); }

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

/** Says what is wrong with the connection, and what becomes of the text until it is not. */
export function connection(state: ConnectionState | "hanging", hasText: boolean): void {
  const isKept = hasText && state !== "connecting" && state !== "open";
  byId("connection-bar").hidden = state === "open";
  byId("connection-kept").hidden = !isKept;
  const said = byId("connection-states").querySelector(`[data-state=${state}]`)?.textContent ?? "";
  setText(byId("connection"), said);
}
