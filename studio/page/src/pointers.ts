// Hands on the picture by mouse, pen and fingers: a press begins a drag, two fingers zoom, and with
// the space bar a drag shifts the picture.

import { followPointer } from "./dom";
import { Drag, type Held, type Workbench } from "./drag";
import type { Keys } from "./keys";
import type { Overlays, Pick, Point } from "./protocol";
import type { Selection } from "./selection";
import type { Tool, Tools } from "./tools";

/** So many screen pixels a pointer may wander before it is a drag. */
const CLICK = 4;

/** What other buttons than the left one do. */
const BUTTONS: Record<number, Tool> = { 1: "pan", 2: "orbit" };

export class Pointers {
  private drag: Drag | null = null;
  private readonly places = new Map<number, Point>();
  private readonly tools: Tools;

  constructor(private readonly bench: Workbench, private readonly selection: Selection,
    private readonly keys: Keys) {
    this.tools = bench.tools;
    const { stage } = bench.picture;
    stage.addEventListener("pointerdown", event => this.press(event));
    stage.addEventListener("pointermove", event => this.shift(event));
    for (const end of ["pointerup", "pointercancel"] as const) {
      stage.addEventListener(end, event => this.places.delete(event.pointerId));
    }
    stage.addEventListener("contextmenu", event => event.preventDefault());
    // In the capture phase, so that the key is not taken for a command as well.
    stage.addEventListener("keydown", event => {
      if (event.key !== "Escape" || this.drag === null) return;
      this.giveUp();
      event.stopImmediatePropagation();
      event.preventDefault();
    }, { capture: true });
  }

  private giveUp(): void {
    this.drag?.cancel();
    this.drag = null;
  }

  private press(event: PointerEvent): void {
    const { picture } = this.bench;
    const at = picture.local(event);
    this.places.set(event.pointerId, at);
    picture.stage.setPointerCapture(event.pointerId);
    this.keys.end();
    // A second finger zooms: what the first one has begun does not count.
    if (this.places.size > 1) return this.giveUp();
    if (this.keys.space) return;
    this.tools.held = event;
    const start = picture.toPicture(at);
    const tool = BUTTONS[event.button] ?? this.tools.tool;
    const button = (event.target as Element).closest(".handle");
    const held = button === null ? null : this.selection.held(button);
    if (held !== null && event.button === 0) this.follow(event, start, () => held);
    else if (tool === "move") this.follow(event, start, () => this.grab(start));
    else this.follow(event, start, () => ({ object: null, handle: tool, at: start }));
  }

  private follow(event: PointerEvent, start: Point,
    hold: () => Promise<Held | null> | Held): void {
    const { picture } = this.bench;
    const drag = new Drag(this.bench, start, hold);
    this.drag = drag;
    let moved = false;
    const move = (next: PointerEvent) => {
      if (this.drag !== drag) return;
      this.tools.held = next;
      const [x, y] = picture.toPicture(picture.local(next));
      moved ||= Math.hypot(x - start[0], y - start[1]) * picture.zoom > CLICK;
      if (moved) drag.to([x, y]);
    };
    followPointer(event, move, () => {
      if (this.drag !== drag) return;
      drag.end();
      this.drag = null;
    });
  }

  /** Selects what is under the pointer, and holds it by its centre. */
  private async grab(point: Point): Promise<Held | null> {
    const { editor } = this.bench;
    const pick = await editor.ask<Pick>("pinhole/pick", { point });
    const object = pick?.object ?? null;
    this.selection.select(object);
    if (object === null) return null;
    const only = [object.index];
    const overlays = await editor.ask<Overlays>("pinhole/overlays", { only });
    const handles = overlays?.objects[0]?.handles;
    const middle = handles?.find(it => it.handle === "center" || it.handle === "centroid");
    if (!middle?.at) return null;
    return { object: object.index, handle: middle.handle, at: middle.at };
  }

  /** Shifts and zooms the picture. */
  private shift(event: PointerEvent): void {
    const { picture } = this.bench;
    const before = this.places.get(event.pointerId);
    if (before === undefined) return;
    const at = picture.local(event);
    const other = [...this.places].find(([id]) => id !== event.pointerId)?.[1];
    if (other !== undefined) {
      const distance = ([x, y]: Point) => Math.max(1, Math.hypot(x - other[0], y - other[1]));
      picture.zoomBy(distance(at) / distance(before), other);
      picture.panBy((at[0] - before[0]) / 2, (at[1] - before[1]) / 2);
    } else if (this.keys.space && event.buttons === 1) {
      picture.panBy(at[0] - before[0], at[1] - before[1]);
    }
    this.places.set(event.pointerId, at);
  }
}
