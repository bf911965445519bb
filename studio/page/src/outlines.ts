// Asks for what is drawn over the picture: of the newest text, and no more than is shown.

import { connection } from "./connection";
import { byId, newestOf } from "./dom";
import { editor } from "./editor";
import { frames } from "./frames";
import { overlays } from "./overlays";
import { picture } from "./picture";
import type { Overlays, SceneObject } from "./protocol";
import { nameOf, selection } from "./selection";
import { setText } from "./visible";

/** So many objects are described to those who do not see the picture. */
const DESCRIBED = 6;

let described = "";

/** Says what is seen, and where; changes of it are announced. */
function describe({ size, objects }: Overlays, count: number): void {
  const third = (part: number, words: string[]) => words[Math.floor(3 * part)];
  const places = objects.map(object => {
    const [x, y] = object.handles[0]?.at ?? [NaN, NaN];
    const down = third(y / size[1], ["top", "middle", "bottom"]);
    const across = third(x / size[0], ["left", "centre", "right"]);
    const beside = object.outline.length > 0 ? "middle beside the picture" : "not in the picture";
    return `${nameOf(object)}: ${down && across ? `${down} ${across}` : beside}`;
  });
  if (count > objects.length) places.push(`${count - objects.length} more`);
  const text = places.length === 0 ? "A scene without objects" : places.join("; ");
  // At first nothing has changed.
  if (described !== "" && described !== text) setText(byId("seen"), text);
  described = text;
  picture.canvas.setAttribute("aria-label", text);
}

/** The text has come to rest: its objects are listed, with their names and places. */
export async function listObjects(): Promise<void> {
  if (frames.dragging !== null || connection.state !== "open") return;
  const about = { object: selection.index };
  const objects = await editor.askCurrent<SceneObject[]>("pinhole/objects", about);
  if (objects === null) return;
  selection.list(objects);
  const only = objects.slice(0, DESCRIBED).map(it => it.index);
  const seen = await editor.askCurrent<Overlays>("pinhole/overlays", { only });
  if (seen !== null) describe(seen, objects.length);
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
