// Tools for drags on the picture, and the constraint of drags of objects.

import { byId } from "./dom";
import { picture } from "./picture";
import type { Along } from "./protocol";
import { setText } from "./visible";

/** What a drag moves: `move` an object, and all others the camera. */
export type Tool = "move" | "orbit" | "pan" | "dolly" | "roll" | "view_distance" | "look";

/** Step of a handle in screen pixels, unless the control key is held. */
const STEP = 8;
const radios = (name: string) =>
  [...document.querySelectorAll<HTMLInputElement>(`input[name=${name}]`)];

class Tools {
  tool: Tool = "move";
  /** Held keys, which free drags of objects from constraint and step. */
  held = { shiftKey: false, ctrlKey: false };
  /** Chosen constraint; undefined until one is chosen. */
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

  /** Shows the constraints if an object is selected; `hasFloor` sets the default. */
  offer(isSelected: boolean, hasFloor: boolean): void {
    this.hasFloor = hasFloor;
    byId("along").hidden = !isSelected;
    for (const input of radios("along")) input.checked = input.value === this.kept;
  }

  /** Constraint of drags, unless a key frees them. */
  private get kept(): Along | "" { return this.chosen ?? (this.hasFloor ? "floor" : ""); }

  get along(): Along | undefined { return this.held.shiftKey ? undefined : this.kept || undefined; }

  /** Step of a drag, in pixels of the picture. */
  get step(): number | undefined { return this.held.ctrlKey ? undefined : STEP / picture.zoom; }
}

export const tools = new Tools();
