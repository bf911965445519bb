// Tools for drags on the picture: the tool says what a drag does, and a constraint is an axis or
// plane along which objects move.

import { byId } from "./dom";
import { picture, type Picture } from "./picture";
import type { Along } from "./protocol";
import { setText } from "./visible";

/** What a drag does. `move` moves an object; all other tools change the camera. */
export type Tool = "move" | "orbit" | "pan" | "dolly" | "roll" | "view_distance" | "look";

/** Step by which a drag moves an object, in screen pixels. A smaller step would write numbers with
 * more decimals into the text; a larger one would make exact placing harder. */
const STEP = 8;
const radios = (name: string) =>
  [...document.querySelectorAll<HTMLInputElement>(`input[name=${name}]`)];

class Tools {
  tool: Tool = "move";
  /** Modifier keys during a drag. With Shift, the object moves in any direction, not only along the
   * chosen axis or plane. With Control, it moves without steps. */
  held = { shiftKey: false, ctrlKey: false };
  /** Axis or plane to which the user restricted drags; `""` means no restriction. Undefined before
   * the user has chosen. */
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

  /** Chooses what is chosen when the page is opened: drags move objects, and the user has chosen no
   * axis or plane. */
  reset(): void {
    radios("tool")[0]?.click();
    this.chosen = undefined;
    for (const input of radios("along")) input.checked = input.value === this.kept;
  }

  /** Offers the axes and planes to which drags can be restricted if an object is selected. Until
   * the user chooses, `floor` is chosen if `hasFloor` is set, and otherwise no restriction. */
  offer(isSelected: boolean, hasFloor: boolean): void {
    this.hasFloor = hasFloor;
    byId("along").hidden = !isSelected;
    for (const input of radios("along")) input.checked = input.value === this.kept;
  }

  /** Axis or plane to which drags are restricted while Shift is not held; `""` means no
   * restriction. Until the user chooses, it is the floor in a scene with a checkerboard. */
  private get kept(): Along | "" { return this.chosen ?? (this.hasFloor ? "floor" : ""); }

  /** Axis or plane along which a drag moves an object, or a handle of the camera; undefined if the
   * movement is not restricted. Without a choice by the user, the floor restricts only objects. */
  along(isObject: boolean): Along | undefined {
    const along = isObject ? this.kept : this.chosen;
    return this.held.shiftKey ? undefined : along || undefined;
  }

  /** Step of a drag, in pixels of `where`; undefined while the Control key is held. */
  step(where: Picture): number | undefined {
    return this.held.ctrlKey ? undefined : STEP / where.zoom;
  }
}

export const tools = new Tools();
