// Mouse, pen and touch on the picture: a press begins a drag, and two fingers pan and zoom the
// picture. While the space bar is held, a drag pans the picture.

import { dragWith, type Held, type Surface } from "./drag";
import { editor } from "./editor";
import { Fingers } from "./fingers";
import { space } from "./keys";
import { picture } from "./picture";
import type { Overlays, Pick, Point, SceneObject } from "./protocol";
import { selection } from "./selection";
import { tools, type Tool } from "./tools";

/** Tools that the middle (1) and the right (2) mouse button use, whichever tool is chosen. */
const BUTTONS: Record<number, Tool> = { 1: "pan", 2: "orbit" };

/** Zoom of the picture when the second of two fingers was pressed. */
let before = 1;
// Fingers can shrink the picture only until all of it is visible. The new zoom is computed from
// `before` and the total factor, not from the last zoom. Thus fingers that have gone beyond the
// limit must come back to it before the picture grows again.
const fingers = new Fingers(picture, (factor, about, total) => {
  if (total === factor) before = picture.zoom;
  const zoom = Math.max(before * total, Math.min(before, picture.fitting));
  picture.zoomBy(zoom / picture.zoom, about);
}, by => picture.panBy(...by));
picture.stage.addEventListener("pointerdown", press);
fingers.onAlone = (by, { buttons }) => { if (space && buttons === 1) picture.panBy(...by); };

function press(event: PointerEvent): void {
  if (!fingers.press(event) || space) return;
  tools.held = event;
  const start = picture.toPicture(picture.local(event));
  const tool = BUTTONS[event.button] ?? tools.tool;
  const button = (event.target as Element).closest(".handle");
  const held = button === null ? null : selection.held(button);
  const isOfHandle = held !== null && event.button === 0;
  const take = async () => await fingers.isAlone ? grab(start) : null;
  fingers.cancelFirst = dragWith(event, start, isOfHandle ? () => held : tool === "move" ? take
    : () => ({ object: null, handle: tool, at: start }));
}

/** Selects the object at `point` and returns its centre as a handle. Returns null if there is no
 * object, if its centre is not visible in the picture, or if `isMeant` is false for it. */
export async function grab(point: Point, view: Surface["view"] = null,
  isMeant: (object: SceneObject | null) => boolean = () => true): Promise<Held | null> {
  const { selectionCount: choices } = selection;
  const pick = await editor.ask<Pick>("pinhole/pick", { point, view });
  const object = pick?.object ?? null;
  if (!isMeant(object)) return null;
  // If the user selects something else before the server answers, that selection stays.
  if (choices === selection.selectionCount) selection.select(object);
  if (object === null) return null;
  const only = [object.index];
  const overlays = await editor.ask<Overlays>("pinhole/overlays", { only, view });
  const handles = overlays?.objects[0]?.handles;
  const middle = handles?.find(it => it.handle === "center" || it.handle === "centroid");
  if (!middle?.at) return null;
  return { object: object.index, handle: middle.handle, at: middle.at };
}
