// Asks for what is drawn over the picture: of the newest text, and no more than is shown.

import type { Connection } from "./connection";
import { byId } from "./dom";
import type { SceneEditor } from "./editor";
import type { Frames } from "./frames";
import type { OverlayLayer } from "./overlays";
import type { Overlays, SceneObject } from "./protocol";
import { nameOf, type Selection } from "./selection";
import { setText } from "./visible";

/** So many objects are described to those who do not see the picture. */
const DESCRIBED = 6;

/** Says what is seen, and where; changes of it are announced. */
function describe({ size, objects }: Overlays, count: number): void {
  const third = (part: number, words: string[]) => words[Math.floor(3 * part)];
  const places = objects.map(object => {
    const [x, y] = object.handles[0]?.at ?? [NaN, NaN];
    const down = third(y / size[1], ["top", "middle", "bottom"]);
    const across = third(x / size[0], ["left", "centre", "right"]);
    return `${nameOf(object)}: ${down && across ? `${down} ${across}` : "not in the picture"}`;
  });
  if (count > objects.length) places.push(`${count - objects.length} more`);
  const text = places.length === 0 ? "A scene without objects" : places.join("; ");
  const canvas = document.querySelector("canvas");
  // At first nothing has changed.
  const isNew = canvas?.dataset["seen"] !== undefined && canvas.ariaLabel !== text;
  if (isNew) setText(byId("seen"), text);
  canvas?.setAttribute("aria-label", text);
  canvas?.setAttribute("data-seen", "");
}

export class Outlines {
  onRest: () => void = () => {};
  private asking = false;
  private outdated = false;

  constructor(private readonly editor: SceneEditor, private readonly connection: Connection,
    private readonly frames: Frames, private readonly overlays: OverlayLayer,
    private readonly selection: Selection) {}

  /** The text has changed, or the server. The coarse picture comes first. */
  changed(): void { void this.frames.coarse.then(() => this.refresh()); }

  /** The names and places of the objects, once nothing moves any more. */
  async rested(): Promise<void> {
    const { editor, frames, selection } = this;
    if (frames.dragging !== null || this.connection.state !== "open") return;
    this.onRest();
    const about = { object: selection.index };
    const objects = await editor.askCurrent<SceneObject[]>("pinhole/objects", about);
    if (objects === null) return;
    selection.list(objects);
    const only = objects.slice(0, DESCRIBED).map(it => it.index);
    const seen = await editor.askCurrent<Overlays>("pinhole/overlays", { only });
    if (seen !== null) describe(seen, objects.length);
  }

  async refresh(): Promise<void> {
    const { connection, editor, frames, overlays, selection } = this;
    this.outdated = true;
    if (this.asking) return;
    this.asking = true;
    while (this.outdated && connection.state === "open") {
      this.outdated = false;
      const { doc } = editor.view.state;
      const shown = [selection.index, overlays.hovered].filter(it => it !== null);
      const needsNone = shown.length === 0 && !overlays.needsAny;
      if (frames.dragging !== null && needsNone) continue;
      const only = overlays.needsAll ? null : shown;
      const about = { object: selection.index, only };
      const answer = await editor.ask<Overlays>("pinhole/overlays", about);
      // A text with errors has the last good picture, which nothing can be taken hold of in.
      overlays.isTrue = answer !== null;
      if (answer !== null && editor.view.state.doc === doc) {
        overlays.data = answer;
        frames.resized(answer.size);
      }
      overlays.draw();
      selection.draw();
    }
    this.asking = false;
  }
}
