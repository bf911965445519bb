// Pointers that are pressed on a picture. Two fingers together shift and zoom the picture.

import { CLICK } from "./drag";
import { endKeys } from "./keys";
import type { Picture } from "./picture";
import type { Point } from "./protocol";

/** Returns the distance of two points, but at least 1, because callers divide by it. */
const distance = (a: Point, b: Point) => Math.max(1, Math.hypot(a[0] - b[0], a[1] - b[1]));

export class Fingers {
  /** Cancels the action that the first pointer has begun, such as a drag. */
  cancelFirst = (): void => {};
  /** Called with the movement, in screen pixels, of a pointer that is pressed alone. */
  onAlone: (by: Point, event: PointerEvent) => void = () => {};
  /** Last position of each pressed pointer, by its id. */
  private readonly places = new Map<number, Point>();
  /** Resolves to whether the pressed pointer acts alone. For a finger, this is known when it has
   * moved or been released, or when a second finger is pressed. */
  isAlone = Promise.resolve(true);
  private resolveAlone: (isAlone: boolean) => void = () => {};

  /** Distance of the two fingers, in screen pixels, when the second one was pressed. */
  private startDistance = 1;
  /** Total length of all movements since the last press, in screen pixels. */
  private moved = 0;

  /** `zoom` zooms by a factor, about a point of the stage. Its last argument is the product of all
   * factors since the second finger was pressed. `pan` shifts the picture by screen pixels. */
  constructor(private readonly picture: Picture,
    private readonly zoom: (factor: number, about: Point, total: number) => void,
    private readonly pan: (by: Point) => void) {
    const { stage } = picture;
    stage.addEventListener("pointermove", event => this.move(event));
    for (const end of ["pointerup", "pointercancel"] as const) stage.addEventListener(end,
      ({ pointerId }) => this.resolveAlone(this.places.delete(pointerId) && end === "pointerup"));
    stage.addEventListener("contextmenu", event => event.preventDefault());
  }

  /** Follows a pressed pointer. Returns whether it is the only pressed pointer. A second pointer
   * cancels the action of the first one. */
  press(event: PointerEvent): boolean {
    const { picture, picture: { stage }, places } = this;
    const at = picture.local(event);
    const [first] = places.values();
    places.set(event.pointerId, at);
    [this.startDistance, this.moved] = [distance(at, first ?? at), 0];
    if (!first) this.isAlone = new Promise(resolve => (this.resolveAlone = resolve));
    if (first || event.pointerType !== "touch") this.resolveAlone(!first);
    stage.setPointerCapture(event.pointerId);
    stage.focus({ preventScroll: true }); // touch would leave the focus in the text
    endKeys();
    if (first) this.cancelFirst();
    return !first;
  }

  private move(event: PointerEvent): void {
    const { places } = this;
    const before = places.get(event.pointerId);
    if (before === undefined) return;
    const at = this.picture.local(event);
    places.set(event.pointerId, at);
    const other = [...places].find(([id]) => id !== event.pointerId)?.[1];
    const by: Point = [at[0] - before[0], at[1] - before[1]];
    this.moved += Math.hypot(...by);
    if (this.moved > CLICK) this.resolveAlone(true);
    if (other === undefined) return this.onAlone(by, event);
    // The browser reports the movements of the two fingers one after the other. Each movement zooms
    // the picture about the middle between the fingers, and shifts it by half the movement. If both
    // fingers move in the same direction, the two zooms cancel each other.
    const middle: Point = [(before[0] + other[0]) / 2, (before[1] + other[1]) / 2];
    const now = distance(at, other);
    this.zoom(now / distance(before, other), middle, now / this.startDistance);
    this.pan([by[0] / 2, by[1] / 2]);
  }
}
