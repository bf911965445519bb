// Requests the overlays (outlines, handles and layers) that are shown, for the newest text.

import { connection } from "./connection";
import { byId, newestOf } from "./dom";
import { editor } from "./editor";
import { frames } from "./frames";
import { overlays } from "./overlays";
import { picture } from "./picture";
import type { ListedObject, Overlays } from "./protocol";
import { selection } from "./selection";
import { setText } from "./visible";

/** Maximum number of objects in the picture's description for screen readers. Hearing a longer list
 * would take too long. */
const DESCRIBED = 6;

let described = "";

/** Describes the visible objects and their places for screen readers. Announces changes. */
function describe(objects: readonly ListedObject[]): void {
  // Objects at the same place are listed together.
  const there: Record<string, string[]> = {};
  for (const { label, place } of objects.slice(0, DESCRIBED)) {
    (there[place ?? ""] ??= []).push(label);
  }
  const places = Object.entries(there)
    .map(([place, names]) => names.join(", ") + (place && `: ${place}`));
  // The server lists at most 1000 objects. If the list has this length, the scene may contain more,
  // so their number is unknown.
  const more = objects.length < 1000 ? objects.length - DESCRIBED : "many";
  if (objects.length > DESCRIBED) places.push(`${more} more`);
  const text = places.join("; ") || "A scene without objects";
  // The first description is not announced, since it does not describe a change.
  if (described !== "" && described !== text) setText(byId("seen"), text);
  described = text;
  picture.canvas.setAttribute("aria-label", text);
}

/** Lists the objects of the current text with names and places, unless a drag is under way. */
export async function listObjects(): Promise<void> {
  if (frames.dragging !== null || connection.state !== "open") return;
  const about = { object: selection.index };
  const objects = await editor.askCurrent<ListedObject[]>("pinhole/objects", about);
  if (objects === null) return;
  selection.list(objects);
  describe(objects);
}

/** Requests the shown overlays after the coarse picture has arrived, one request at a time. */
export const refreshOutlines = newestOf<void>(async () => {
  for (let its; its !== frames.coarse; await its) its = frames.coarse;
  const shown = [selection.index, overlays.hovered].filter(it => it !== null);
  const needsNone = shown.length === 0 && !overlays.needsAny;
  if (connection.state !== "open" || (frames.dragging !== null && needsNone)) return;
  const { doc } = editor.view.state;
  const about = { object: selection.index, only: overlays.needsAll ? null : shown };
  const answer = await editor.ask<Overlays>("pinhole/overlays", about);
  // If the text has errors, the overlays belong to an older text, so no object can be selected or
  // dragged by its overlay.
  overlays.isCurrent = answer !== null;
  if (answer !== null && editor.view.state.doc === doc) overlays.data = answer;
  overlays.draw();
  selection.draw();
});
