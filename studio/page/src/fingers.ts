// Pointers pressed on a picture. Two of them, which are fingers, shift and zoom it together.

import { CLICK } from "./drag";
import { endKeys } from "./keys";
import type { Picture } from "./picture";
import type { Point } from "./protocol";

/** Returns the distance of two points, or 1 if they are nearer, since it is a divisor. */
const distance = (a: Point, b: Point) => Math.max(1, Math.hypot(a[0] - b[0], a[1] - b[1]));

export class Fingers {
  /** Cancels what the first pointer has begun. */
  giveUp = (): void => {};
  /** Called when a pressed pointer moves by screen pixels while no other one is pressed. */
  onAlone: (by: Point, event: PointerEvent) => void = () => {};
  /** Last position of each pressed pointer, by its id. */
  private readonly places = new Map<number, Point>();
  /** Resolves to whether the pressed pointer acts alone. For a finger, this is known when it has
   * moved or been released, or when a second finger is pressed. */
  isAlone = Promise.resolve(true);
  private decide: (isAlone: boolean) => void = () => {};

  /** Distance of two fingers when the second one was pressed. */
  private spread = 1;
  /** Length of the way of the pointers since the last press. */
  private way = 0;

  /** `zoom` zooms by a factor, about a point of the stage. It also gets the product of all factors
   * since the second finger was pressed. `pan` shifts by screen pixels. */
  constructor(private readonly picture: Picture,
    private readonly zoom: (factor: number, about: Point, total: number) => void,
    private readonly pan: (by: Point) => void) {
    const { stage } = picture;
    stage.addEventListener("pointermove", event => this.move(event));
    for (const end of ["pointerup", "pointercancel"] as const) stage.addEventListener(end,
      ({ pointerId }) => this.decide(this.places.delete(pointerId) && end === "pointerup"));
    stage.addEventListener("contextmenu", event => event.preventDefault());
  }

  /** Follows a pressed pointer. Returns whether it is the first one. A second one cancels what the
   * first has begun. */
  press(event: PointerEvent): boolean {
    const { picture, picture: { stage }, places } = this;
    const at = picture.local(event);
    const [first] = places.values();
    places.set(event.pointerId, at);
    [this.spread, this.way] = [distance(at, first ?? at), 0];
    if (!first) this.isAlone = new Promise(resolve => (this.decide = resolve));
    if (first || event.pointerType !== "touch") this.decide(!first);
    stage.setPointerCapture(event.pointerId);
    stage.focus({ preventScroll: true }); // touch would leave the focus in the text
    endKeys();
    if (first) this.giveUp();
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
    this.way += Math.hypot(...by);
    if (this.way > CLICK) this.decide(true);
    if (other === undefined) return this.onAlone(by, event);
    // The browser reports the fingers one after the other. The picture is zoomed about their middle
    // and shifted with it, so that the two zooms of a shift cancel each other.
    const middle: Point = [(before[0] + other[0]) / 2, (before[1] + other[1]) / 2];
    const now = distance(at, other);
    this.zoom(now / distance(before, other), middle, now / this.spread);
    this.pan([by[0] / 2, by[1] / 2]);
  }
}
