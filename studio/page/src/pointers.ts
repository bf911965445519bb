// Mouse, pen and touch on the picture: a press begins a drag, and two fingers pan and zoom the
// picture. While the space bar is held, a drag pans the picture.

import { dragWith, type Held, type Surface } from "./drag";
import { editor } from "./editor";
import { endKeys, space } from "./keys";
import { picture } from "./picture";
import type { Overlays, Pick, Point, SceneObject } from "./protocol";
import { selection } from "./selection";
import { tools, type Tool } from "./tools";

/** Tools that the middle (1) and the right (2) mouse button use, whichever tool is chosen. */
const BUTTONS: Record<number, Tool> = { 1: "pan", 2: "orbit" };

/** Cancels the drag that is under way with a mouse button or a finger. */
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
  // A second finger cancels the drag of the first. Both fingers together zoom.
  if (places.size > 1) return giveUp();
  if (space) return;
  tools.held = event;
  const start = picture.toPicture(at);
  const tool = BUTTONS[event.button] ?? tools.tool;
  const button = (event.target as Element).closest(".handle");
  const held = button === null ? null : selection.held(button);
  if (held !== null && event.button === 0) giveUp = dragWith(event, start, () => held);
  else if (tool === "move") giveUp = dragWith(event, start, () => grab(start));
  else giveUp = dragWith(event, start, () => ({ object: null, handle: tool, at: start }));
}

/** Selects the object at `point` and returns its centre as a handle. Returns null if there is no
 * object, if its centre is not visible in the picture, or if `isMeant` is false for it. */
export async function grab(point: Point, view: Surface["view"] = null,
  isMeant: (object: SceneObject | null) => boolean = () => true): Promise<Held | null> {
  const { choices } = selection;
  const pick = await editor.ask<Pick>("pinhole/pick", { point, view });
  const object = pick?.object ?? null;
  if (!isMeant(object)) return null;
  // If the user has selected something before the answer came, that selection stays.
  if (choices === selection.choices) selection.select(object);
  if (object === null) return null;
  const only = [object.index];
  const overlays = await editor.ask<Overlays>("pinhole/overlays", { only, view });
  const handles = overlays?.objects[0]?.handles;
  const middle = handles?.find(it => it.handle === "center" || it.handle === "centroid");
  if (!middle?.at) return null;
  return { object: object.index, handle: middle.handle, at: middle.at };
}

/** Pans the picture with one pressed pointer; pans and zooms it with two. */
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
