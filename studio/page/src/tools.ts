// What a drag on the picture does: which tool is chosen, and what drags of objects are held to.

import { byId } from "./dom";
import { picture } from "./picture";
import type { Along } from "./protocol";
import { setText } from "./visible";

/** What a drag moves; all but the first move the camera. */
export type Tool = "move" | "orbit" | "pan" | "dolly" | "roll" | "view_distance" | "look";

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
    const summary = document.querySelector("#camera-menu summary") as Element;
    for (const input of radios("tool")) input.addEventListener("change", () => {
      this.tool = input.value as Tool;
      picture.stage.dataset["tool"] = this.tool;
      if (this.tool !== "move") setText(summary, `Camera: ${this.tool.replace("_", " ")}`);
    });
    for (const input of radios("along")) input.addEventListener("change", () =>
      (this.chosen = input.value as Along | ""));
  }

  /** Offers what is of use: there is an object to drag, and there may be a floor under it. */
  offer(isSelected: boolean, hasFloor: boolean): void {
    this.hasFloor = hasFloor;
    byId("along").hidden = !isSelected;
    for (const input of radios("along")) input.checked = input.value === this.kept;
  }

  /** What drags are held to, if no key frees them. */
  private get kept(): Along | "" { return this.chosen ?? (this.hasFloor ? "floor" : ""); }

  get along(): Along | undefined { return this.held.shiftKey ? undefined : this.kept || undefined; }

  /** So far something goes at once, in pixels of the picture. */
  get step(): number | undefined { return this.held.ctrlKey ? undefined : STEP / picture.zoom; }
}

export const tools = new Tools();
