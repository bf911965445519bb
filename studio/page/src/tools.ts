// What a drag on the picture does: which tool is chosen, and what drags of objects are held to.

import { byId } from "./dom";
import { picture } from "./picture";
import type { Along } from "./protocol";
import { setText } from "./visible";

/** The tools, by the keys that choose them. All but the first move the camera. */
export const TOOLS = {
  m: "move", o: "orbit", p: "pan", d: "dolly", r: "roll", v: "view_distance", l: "look",
} as const;

export type Tool = (typeof TOOLS)[keyof typeof TOOLS];

/** A handle goes so many screen pixels at once, unless the control key is held. */
const STEP = 8;
const radios = (name: string) =>
  [...document.querySelectorAll<HTMLInputElement>(`input[name=${name}]`)];

class Tools {
  tool: Tool = "move";
  /** The keys that are held, which free drags of objects. */
  held = { shiftKey: false, ctrlKey: false };
  /** What is held to; undefined as long as nobody has chosen. */
  private chosen: Along | "" | undefined;
  private hasFloor = false;

  constructor() {
    for (const input of radios("tool")) {
      input.addEventListener("change", () => this.choose(input.value as Tool));
    }
    for (const input of radios("along")) {
      input.addEventListener("change", () => this.hold(input.value as Along | ""));
    }
  }

  choose(tool: Tool): void {
    this.tool = tool;
    picture.stage.dataset["tool"] = tool;
    for (const input of radios("tool")) input.checked = input.value === tool;
    const name = tool.replace("_", " ");
    const summary = document.querySelector("#camera-menu summary") as Element;
    if (tool !== "move") setText(summary, `Camera: ${name}`);
  }

  /** Offers what is of use: there is an object to drag, and there may be a floor under it. */
  offer(isSelected: boolean, hasFloor: boolean): void {
    this.hasFloor = hasFloor;
    byId("along").hidden = !isSelected;
    this.hold(this.chosen);
  }

  /** What drags are held to, if no key frees them. */
  private get kept(): Along | "" { return this.chosen ?? (this.hasFloor ? "floor" : ""); }

  get along(): Along | undefined {
    return this.held.shiftKey ? undefined : this.kept || undefined;
  }

  /** So far something goes at once, in pixels of the picture. */
  get step(): number | undefined { return this.held.ctrlKey ? undefined : STEP / picture.zoom; }

  hold(along: Along | "" | undefined): void {
    this.chosen = along;
    for (const input of radios("along")) input.checked = input.value === this.kept;
  }

  /** The same by a key, which frees if it is pressed again. */
  toggle(along: Along): void { this.hold(this.kept === along ? "" : along); }
}

export const tools = new Tools();
