// Mouse, pen and touch on the picture: a press begins a drag, two fingers pan and zoom, and a drag
// with the space bar held pans.

import { followPointer } from "./dom";
import { Drag, type Held } from "./drag";
import { editor } from "./editor";
import { endKeys, space } from "./keys";
import { picture } from "./picture";
import type { Overlays, Pick, Point } from "./protocol";
import { selection } from "./selection";
import { tools, type Tool } from "./tools";

/** Maximum movement of a click, in screen pixels; a larger movement is a drag. */
const CLICK = 4;

/** Tools of the middle (1) and the right (2) mouse button. */
const BUTTONS: Record<number, Tool> = { 1: "pan", 2: "orbit" };

/** Cancels the current drag by a mouse button or a finger. */
let giveUp = (): void => {};
/** Last position of each pressed pointer, by its id. */
const places = new Map<number, Point>();
const { stage } = picture;

stage.addEventListener("pointerdown", press);
stage.addEventListener("pointermove", shift);
for (const end of ["pointerup", "pointercancel"] as const) stage.addEventListener(end, event =>
  places.delete(event.pointerId));
stage.addEventListener("contextmenu", event => event.preventDefault());

function press(event: PointerEvent): void {
  const at = picture.local(event);
  places.set(event.pointerId, at);
  stage.setPointerCapture(event.pointerId);
  stage.focus({ preventScroll: true }); // touch would leave the focus in the text
  endKeys();
  // A second finger cancels the drag of the first; both together zoom.
  if (places.size > 1) return giveUp();
  if (space) return;
  tools.held = event;
  const start = picture.toPicture(at);
  const tool = BUTTONS[event.button] ?? tools.tool;
  const button = (event.target as Element).closest(".handle");
  const held = button === null ? null : selection.held(button);
  if (held !== null && event.button === 0) follow(event, start, () => held);
  else if (tool === "move") follow(event, start, () => grab(start));
  else follow(event, start, () => ({ object: null, handle: tool, at: start }));
}

function follow(event: PointerEvent, start: Point, hold: () => Promise<Held | null> | Held): void {
  const drag = new Drag(start, hold);
  let moved = false;
  const { zoom } = picture;
  const move = (next: PointerEvent) => {
    tools.held = next;
    // Use the pointer's screen movement, because the page may have moved the picture meanwhile.
    const [dx, dy] = [next.clientX - event.clientX, next.clientY - event.clientY];
    moved ||= Math.hypot(dx, dy) > CLICK;
    if (moved) drag.to([start[0] + dx / zoom, start[1] + dy / zoom]);
  };
  giveUp = followPointer(event, move, () => drag.end(), () => drag.cancel());
}

/** Selects the object at `point` and returns its centre handle, or null without an object. */
async function grab(point: Point): Promise<Held | null> {
  const { choices } = selection;
  const pick = await editor.ask<Pick>("pinhole/pick", { point });
  const object = pick?.object ?? null;
  // If the user selected something before the answer came, that selection is kept.
  if (choices === selection.choices) selection.select(object);
  if (object === null) return null;
  const only = [object.index];
  const overlays = await editor.ask<Overlays>("pinhole/overlays", { only });
  const handles = overlays?.objects[0]?.handles;
  const middle = handles?.find(it => it.handle === "center" || it.handle === "centroid");
  if (!middle?.at) return null;
  return { object: object.index, handle: middle.handle, at: middle.at };
}

/** Pans the picture with one pressed pointer, or pans and zooms it with two. */
function shift(event: PointerEvent): void {
  const before = places.get(event.pointerId);
  if (before === undefined) return;
  const at = picture.local(event);
  const other = [...places].find(([id]) => id !== event.pointerId)?.[1];
  if (other !== undefined) {
    const distance = ([x, y]: Point) => Math.max(1, Math.hypot(x - other[0], y - other[1]));
    picture.zoomBy(distance(at) / distance(before), other);
    picture.panBy((at[0] - before[0]) / 2, (at[1] - before[1]) / 2);
  } else if (space && event.buttons === 1) {
    picture.panBy(at[0] - before[0], at[1] - before[1]);
  }
  places.set(event.pointerId, at);
}
