// Keyboard control of the picture. It works unless the focus is in a text field.

import { byId } from "./dom";
import { Drag } from "./drag";
import { frames } from "./frames";
import { picture } from "./picture";
import { large } from "./projector";
import type { Point } from "./protocol";
import { selection } from "./selection";
import { say } from "./status";
import { tools, type Tool } from "./tools";

/** Step of an arrow key, in pixels of the picture; with Control, a tenth for fine movements. */
const KEY_STEP = 10;
/** Time from the last release of an arrow key or turn of the wheel to the end of the drag, in ms.
 * Key presses and turns with shorter pauses belong to one drag. */
const KEY_PAUSE = 500;

export const ARROWS: Record<string, Point> =
  { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/** Elements in which keys do not control the picture, because they need all keys, e.g. to type
 * text. */
const TEXT = "input:not([type=radio],[type=checkbox],[type=range]), [contenteditable=true]";
const SAVE = ["Control+s", "Control+Shift+s"]; // keys that also work in elements of `TEXT`
/** Elements that use arrow keys, Space or Escape themselves, so these keys do not control the
 * picture there. */
const CONTROL = "input, select, button:not(.handle), summary, #divider, [open], [role=group]";

/** Returns the name of a pressed key as the attribute `data-key` spells it. */
function nameOf({ key, ctrlKey, metaKey, shiftKey }: KeyboardEvent): string {
  if (!ctrlKey && !metaKey) return key;
  return `Control+${shiftKey ? "Shift+" : ""}${key.toLowerCase()}`;
}

/** Returns the element that a key operates; undefined if the key has no function. If drags are
 * already restricted to the axis or plane that the key selects, returns the element `free` instead,
 * which removes the restriction. */
function controlOf(key: string): HTMLElement | undefined {
  const controls = [...document.querySelectorAll<HTMLElement>("[data-key]")];
  const found = controls.find(it => it.dataset["key"]?.split(" ").includes(key));
  return found?.matches("[name=along]:checked") ? byId("free") : found;
}

/** Whether the space bar is held. A drag then pans the picture. */
export let space = false;
let drag: Drag | null = null;
let pause = 0;

document.addEventListener("keydown", down);
document.addEventListener("keyup", up);
picture.onDolly = turned => {
  drag ??= ofCamera("dolly");
  drag.by([0, -turned * 60]);
  rest();
};
picture.stage.addEventListener("focusout", event => {
  // If the focus moves from one handle to another, the drag continues.
  if (event.relatedTarget instanceof Node && picture.stage.contains(event.relatedTarget)) return;
  endKeys();
  freeSpace();
});

export function endKeys(): void {
  clearTimeout(pause);
  drag?.end();
  drag = null;
}

function down(event: KeyboardEvent): void {
  const { key } = event;
  const arrow = ARROWS[key];
  const target = event.target as Element;
  const whole = nameOf(event);
  const isInDialog = document.querySelector("dialog[open]") !== null;
  const isLeaving = whole === "Escape" && large.checked && !isInDialog;
  const isElsewhere = (isInDialog || target.closest(TEXT) !== null) && !SAVE.includes(whole)
    && !isLeaving;
  if (event.defaultPrevented || isElsewhere) return;
  const isInPicture = target.closest("#stage, #outside") !== null;
  const isOfControl = target.closest(CONTROL) !== null && !isInPicture;
  if (isOfControl && !isLeaving && (arrow !== undefined || key === " " || key === "Escape")) return;
  tools.held = event;
  clearTimeout(pause);
  if (arrow === undefined && !["Escape", "Shift", "Control"].includes(key)) endKeys();
  if (event.altKey || (event.metaKey && arrow !== undefined)) return;
  if (arrow !== undefined) {
    dragByKey(event, arrow, () => begin(target));
  } else if (whole === "Escape") {
    // Escape cancels the drag that is under way. A drag that was released but still waits for the
    // server is cancelled, too.
    if (frames.dragging instanceof Drag) frames.dragging.cancel();
    else if (isLeaving) large.click();
    else selection.select(null);
    drag = null;
  } else if (whole === " ") {
    space = true;
    picture.stage.dataset["space"] = "";
  } else {
    const control = controlOf(whole);
    if (control === undefined) return;
    const part = control.closest(".of-dock");
    if (part !== null && getComputedStyle(part).display === "none") {
      say("The part below the picture needs a wider or higher window.", "warning");
    } else control.click();
  }
  event.preventDefault();
}

/** Moves the dragged handle by an arrow key. If no drag by keys has begun, `start` begins one. */
export function dragByKey(event: KeyboardEvent, [x, y]: Point, start: () => Drag | null): void {
  clearTimeout(pause);
  const step = event.ctrlKey ? KEY_STEP / 10 : KEY_STEP;
  drag ??= start();
  drag?.by([x * step, y * step]);
}

function up(event: KeyboardEvent): void {
  tools.held = event;
  if (event.key === " ") freeSpace();
  if (event.key in ARROWS) rest();
}

/** Ends the drag after `KEY_PAUSE`, so that key presses with shorter pauses belong to one drag. */
function rest(): void {
  clearTimeout(pause);
  pause = setTimeout(endKeys, KEY_PAUSE);
}

function freeSpace(): void {
  space = false;
  delete picture.stage.dataset["space"];
}

function ofCamera(handle: Tool): Drag {
  const { size: [width, height] } = picture;
  // A roll turns the camera about the centre, so its handle must be beside the centre.
  const at: Point = [handle === "roll" ? 0.75 * width : width / 2, height / 2];
  return new Drag(at, () => ({ object: null, handle, at }));
}

/** Begins a drag of the focused handle. Otherwise drags what the chosen tool moves: the camera, or
 * with the tool `move` the selected object. Returns null, with a message, if no object is
 * selected. */
function begin(focused: Element): Drag | null {
  const { tool } = tools;
  const isHandle = focused.closest(".handle") !== null;
  if (!isHandle && tool !== "move") return ofCamera(tool);
  const held = selection.held(isHandle ? focused : null);
  if (held !== null) return new Drag(held.at, () => held);
  say("Select an object, or choose what the camera does.", "warning");
  return null;
}
