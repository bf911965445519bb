// Tools, which say what a drag on the picture does, and the axis or plane along which objects move.

import { byId } from "./dom";
import { picture } from "./picture";
import type { Along } from "./protocol";
import { setText } from "./visible";

/** What a drag does. `move` moves an object; all other tools change the camera. */
export type Tool = "move" | "orbit" | "pan" | "dolly" | "roll" | "view_distance" | "look";

/** Step of an object's drag, in screen pixels: coarse enough for round numbers in the text. */
const STEP = 8;
const radios = (name: string) =>
  [...document.querySelectorAll<HTMLInputElement>(`input[name=${name}]`)];

class Tools {
  tool: Tool = "move";
  /** Keys held in a drag: Shift frees it from its axis or plane, Control from its step. */
  held = { shiftKey: false, ctrlKey: false };
  /** Axis or plane that the user chose for drags (`""` is none); undefined before any choice. */
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

  /** Shows the axes and planes if an object is selected. `hasFloor` makes `floor` the default. */
  offer(isSelected: boolean, hasFloor: boolean): void {
    this.hasFloor = hasFloor;
    byId("along").hidden = !isSelected;
    for (const input of radios("along")) input.checked = input.value === this.kept;
  }

  /** Axis or plane of drags without the Shift key; `""` is none. */
  private get kept(): Along | "" { return this.chosen ?? (this.hasFloor ? "floor" : ""); }

  get along(): Along | undefined { return this.held.shiftKey ? undefined : this.kept || undefined; }

  /** Step of a drag, in pixels of the picture; undefined while the Control key is held. */
  get step(): number | undefined { return this.held.ctrlKey ? undefined : STEP / picture.zoom; }
}

export const tools = new Tools();
