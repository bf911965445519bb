// Asks for what is drawn over the picture: of the newest text, and no more than is shown.

import { connection } from "./connection";
import { byId, newestOf } from "./dom";
import { editor } from "./editor";
import { frames } from "./frames";
import { overlays } from "./overlays";
import { picture } from "./picture";
import type { ListedObject, Overlays } from "./protocol";
import { selection } from "./selection";
import { setText } from "./visible";

/** So many objects are described to those who do not see the picture. */
const DESCRIBED = 6;

let described = "";

/** Says what is seen, and where; changes of it are announced. */
function describe(objects: readonly ListedObject[]): void {
  // What is in the same place is named together.
  const there: Record<string, string[]> = {};
  for (const { label, place } of objects.slice(0, DESCRIBED)) {
    (there[place ?? ""] ??= []).push(label);
  }
  const places = Object.entries(there)
    .map(([place, names]) => names.join(", ") + (place && `: ${place}`));
  // A list ends after the first thousand.
  const more = objects.length < 1000 ? objects.length - DESCRIBED : "many";
  if (objects.length > DESCRIBED) places.push(`${more} more`);
  const text = places.join("; ") || "A scene without objects";
  // At first nothing has changed.
  if (described !== "" && described !== text) setText(byId("seen"), text);
  described = text;
  picture.canvas.setAttribute("aria-label", text);
}

/** The text has come to rest: its objects are listed, with their names and places. */
export async function listObjects(): Promise<void> {
  if (frames.dragging !== null || connection.state !== "open") return;
  const about = { object: selection.index };
  const objects = await editor.askCurrent<ListedObject[]>("pinhole/objects", about);
  if (objects === null) return;
  selection.list(objects);
  describe(objects);
}

/** Asks for what is shown, one question after the other: the coarse picture comes first. */
export const refreshOutlines = newestOf<void>(async () => {
  for (let its; its !== frames.coarse; await its) its = frames.coarse;
  const shown = [selection.index, overlays.hovered].filter(it => it !== null);
  const needsNone = shown.length === 0 && !overlays.needsAny;
  if (connection.state !== "open" || (frames.dragging !== null && needsNone)) return;
  const { doc } = editor.view.state;
  const about = { object: selection.index, only: overlays.needsAll ? null : shown };
  const answer = await editor.ask<Overlays>("pinhole/overlays", about);
  // A text with errors has the last good picture, which nothing can be taken hold of in.
  overlays.isTrue = answer !== null;
  if (answer !== null && editor.view.state.doc === doc) overlays.data = answer;
  overlays.draw();
  selection.draw();
});
