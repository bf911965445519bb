// What a drag on the picture does: which tool is chosen, and what drags of objects are held to.

import { byId } from "./dom";
import type { Along } from "./protocol";
import type { Status } from "./status";

/** The tools, by the keys that choose them. All but the first move the camera. */
export const TOOLS = {
  m: "move", o: "orbit", p: "pan", d: "dolly", r: "roll", v: "view_distance", l: "look",
} as const;

export type Tool = (typeof TOOLS)[keyof typeof TOOLS];

export class Tools {
  tool: Tool = "move";
  shift = false;
  private readonly menu = byId<HTMLSelectElement>("along");
  private readonly inputs = document.querySelectorAll<HTMLInputElement>("input[name=tool]");

  constructor(private readonly stage: HTMLElement, private readonly status: Status) {
    for (const input of this.inputs) {
      input.addEventListener("change", () => this.choose(input.value as Tool));
    }
  }

  choose(tool: Tool): void {
    this.tool = tool;
    this.stage.dataset["tool"] = tool;
    for (const input of this.inputs) input.checked = input.value === tool;
  }

  get along(): Along | undefined {
    if (this.shift) return "floor";
    return (this.menu.value || undefined) as Along | undefined;
  }

  /** Holds drags to an axis or the floor, or frees them of it. */
  hold(along: Along): void {
    this.menu.value = this.menu.value === along ? "" : along;
    const chosen = this.menu.selectedOptions[0]?.text.toLowerCase() ?? "";
    this.status.say(`Drags of objects: ${chosen}.`);
  }
}
