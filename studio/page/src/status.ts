// The line at the bottom: what is under the pointer, what has happened, how far the picture is, and whether the engine answers.

import type { ConnectionState } from "./connection";
import { byId } from "./dom";
import type { Fineness } from "./frames";

const FINENESS: Record<Fineness, string> = { coarse: "coarse", sharp: "one sample a pixel", final: "finished" };

export class Status {
  private readonly pointed = byId("pointed");
  private readonly said = byId("said");

  /** Names what is under the pointer. */
  point(text: string): void {
    this.pointed.textContent = text;
  }

  /** Says what has happened. */
  say(text: string, tone: "plain" | "warning" = "plain"): void {
    this.said.textContent = text;
    this.said.dataset["tone"] = tone;
  }

  picture([width, height]: [number, number], fineness: Fineness): void {
    byId("frame-state").textContent = `${width} × ${height}, ${FINENESS[fineness]}`;
  }

  /** Marks the picture as one of an older text, or no longer. */
  stale(why: string | null): void {
    const note = byId("stale");
    note.hidden = why === null;
    note.textContent = why ?? "";
    byId("stage").toggleAttribute("data-stale", why !== null);
  }

  connection(state: ConnectionState): void {
    const note = byId("connection");
    note.hidden = state === "open";
    note.textContent = state === "lost" ? "Connection lost. The text stays here; connecting again…" : "Connecting…";
  }
}
