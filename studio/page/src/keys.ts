// The keys of the picture: what arrows move, and the choice of tools, views and what drags are held
// to. They work wherever the focus is not in a text field.

import { byId } from "./dom";
import { Drag } from "./drag";
import { picture } from "./picture";
import type { Point } from "./protocol";
import { selection } from "./selection";
import { say } from "./status";
import { tools, type Tool } from "./tools";

/** How far an arrow key moves, in pixels of the picture; with the control key a tenth of it. */
const KEY_STEP = 10;

/** A pause after which the next arrow key, or turn of the wheel, begins another drag, in ms. */
const KEY_PAUSE = 500;

const ARROWS: Record<string, Point> =
  { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/** Where keys mean something of their own: all of them, or those that arrows and Space are. */
const TEXT = "input:not([type=radio],[type=checkbox],[type=range]), [contenteditable=true], dialog";
const CONTROL = "input, select, button:not(.handle), summary, #divider, [open], [role=group]";

/** The control that a key presses; one that drags are held to already is let go. */
function controlOf(key: string): HTMLElement | undefined {
  const controls = [...document.querySelectorAll<HTMLElement>("[data-key]")];
  const found = controls.find(it => it.dataset["key"]?.split(" ").includes(key));
  return found?.matches("[name=along]:checked") ? byId("free") : found;
}

class Keys {
  space = false;
  private drag: Drag | null = null;
  private pause = 0;

  constructor() {
    const { stage } = picture;
    document.addEventListener("keydown", event => this.down(event));
    document.addEventListener("keyup", event => this.up(event));
    picture.onDolly = turned => {
      this.drag ??= this.ofCamera("dolly");
      this.drag.by([0, -turned * 60]);
      this.rest();
    };
    stage.addEventListener("focusout", event => {
      // From handle to handle the hands stay on the picture.
      if (event.relatedTarget instanceof Node && stage.contains(event.relatedTarget)) return;
      this.end();
      this.freeSpace();
    });
  }

  end(): void {
    clearTimeout(this.pause);
    this.drag?.end();
    this.drag = null;
  }

  private down(event: KeyboardEvent): void {
    const { key } = event;
    const arrow = ARROWS[key];
    const on = event.target as Element;
    if (event.defaultPrevented || on.closest(TEXT) !== null) return;
    const isOfControl = on.closest(CONTROL) !== null && on.closest("#stage") === null;
    if (isOfControl && (arrow !== undefined || key === " " || key === "Escape")) return;
    tools.held = event;
    clearTimeout(this.pause);
    if (arrow === undefined && !["Escape", "Shift", "Control"].includes(key)) this.end();
    if (event.altKey || event.metaKey) return;
    const whole = event.ctrlKey ? `Control+${key}` : key;
    if (arrow !== undefined) {
      const step = event.ctrlKey ? KEY_STEP / 10 : KEY_STEP;
      this.drag ??= this.begin(on);
      this.drag?.by([arrow[0] * step, arrow[1] * step]);
    } else if (whole === "Escape") {
      if (this.drag === null) selection.select(null);
      this.drag?.cancel();
      this.drag = null;
    } else if (whole === " ") {
      this.space = true;
      picture.stage.dataset["space"] = "";
    } else {
      const control = controlOf(whole);
      if (control === undefined) return;
      control.click();
    }
    event.preventDefault();
  }

  private up(event: KeyboardEvent): void {
    tools.held = event;
    if (event.key === " ") this.freeSpace();
    if (event.key in ARROWS) this.rest();
  }

  /** Taps that follow each other are one drag. */
  private rest(): void {
    clearTimeout(this.pause);
    this.pause = setTimeout(() => this.end(), KEY_PAUSE);
  }

  private freeSpace(): void {
    this.space = false;
    delete picture.stage.dataset["space"];
  }

  private ofCamera(handle: Tool): Drag {
    const { size: [width, height] } = picture;
    // Roll turns about the middle: one has to take hold beside of it.
    const at: Point = [handle === "roll" ? 0.75 * width : width / 2, height / 2];
    return new Drag(at, () => ({ object: null, handle, at }));
  }

  /** What an arrow key drags: the focused handle, else the selected object or the camera. */
  private begin(focused: Element): Drag | null {
    const { tool } = tools;
    const isHandle = focused.closest(".handle") !== null;
    if (!isHandle && tool !== "move") return this.ofCamera(tool);
    const held = selection.held(isHandle ? focused : null);
    if (held !== null) return new Drag(held.at, () => held);
    say("Select an object, or choose what the camera does.", "warning");
    return null;
  }
}

export const keys = new Keys();
