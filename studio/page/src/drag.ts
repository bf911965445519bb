// A drag of an object's handle or of the camera. The server computes each edit from the text before
// the drag, the point where the pointer was pressed, and the pointer's newest point. Since the
// editor's text changes during the drag, the page opens the text before the drag as a separate
// document at the server.

import { byId, followPointer, newestOf } from "./dom";
import { editor } from "./editor";
import { frames } from "./frames";
import { Gesture } from "./gesture";
import { picture, type Picture } from "./picture";
import { isSuperseded, Refusal, type Dragged, type Point, type View } from "./protocol";
import { tools } from "./tools";
import { setText } from "./visible";

/** A handle that the user drags. `at` is the handle's point in the picture before the drag.
 * `object` is null for a handle of the camera. */
export interface Held { object: number | null; handle: string; at: Point }

/** A picture in which drags take place. `view` is the camera of the picture; null stands for the
 * scene's own camera. */
export interface Surface { readonly picture: Picture; readonly view: View | null }
const own: Surface = { picture, view: null };

/** Maximum movement of the pointer in a click, in screen pixels. A hand is never quite still, so
 * only a larger movement begins a drag. */
export const CLICK = 4;

const BROKEN = "The text has errors. Mend them, then the picture can be changed by hand.";
const WAITING = "Waiting for Studio…";
const SLOW = 400; // delay after which a note says that the answer is late, in ms
const CHANGED_BY_OTHER = "The text was changed otherwise meanwhile, so the drag has ended.";

// While a drag lasts, a note about it is shown beside the pointer.
const note = byId("drag-note");

function showNote(text: string, tone: "plain" | "warning", [x, y]: Point): void {
  note.hidden = text === "";
  note.dataset["tone"] = tone;
  setText(note, text);
  const { style } = byId("drag-place");
  style.setProperty("--x", `${x}px`);
  style.setProperty("--y", `${y}px`);
}

const clearNote = () => showNote("", "plain", [0, 0]);
// The reason why a drag was refused stays visible until the next press of a button or key.
for (const type of ["pointerdown", "keydown"]) addEventListener(type, () => {
  if (!(frames.dragging instanceof Drag)) clearNote();
}, { capture: true });

let count = 0;
/** Promise that settles when all earlier drags have finished. */
let ended: Promise<unknown> = Promise.resolve();

/** A drag. It requests one edit at a time, always for the newest point of the pointer. */
export class Drag {
  private readonly uri = `drag:${++count}`;
  /** Newest point of the pointer, in pixels of the picture. */
  private target: Point;
  private isOpen = false;
  private slow = 0;
  private over = false;
  private gesture = new Gesture(editor.view);
  /** The dragged handle; null until it is known. */
  held: Held | null = null;
  private readonly holding: Promise<Held | null>;
  /** Promise that settles when the edit for the last point has been made. */
  private work: Promise<unknown>;
  private settle: () => void = () => {};
  private release: () => void = () => {};
  private readonly released = new Promise<void>(resolve => (this.release = resolve));
  private readonly done = new Promise<void>(resolve => (this.settle = resolve));

  /** Begins a drag at the point `press`. `hold` returns the dragged handle, or a promise of it if
   * the server must first find it. */
  constructor(private readonly press: Point, hold: () => Promise<Held | null> | Held,
    private readonly surface = own) {
    this.target = press;
    surface.picture.stage.append(byId("drag-place"));
    frames.dragging = this;
    this.work = this.holding = this.begin(ended, hold);
    ended = Promise.all([ended, this.done]);
  }

  private async begin(before: Promise<unknown>, hold: () => Promise<Held | null> | Held) {
    await before;
    if (this.over) return null;
    this.gesture = new Gesture(editor.view);
    return (this.held = await hold());
  }

  to(target: Point): void {
    this.target = target;
    this.slow ||= setTimeout(() => { if (!this.over) this.say(WAITING, "plain"); }, SLOW);
    this.work = this.go(target);
  }

  by([dx, dy]: Point): void { this.to([this.target[0] + dx, this.target[1] + dy]); }

  /** Finishes the drag after the edit for the last point. Does not wait until the new picture is
   * rendered. */
  end(): void {
    this.release();
    void this.work.then(() => this.finish());
  }

  cancel(): void {
    this.gesture.cancel();
    this.finish();
  }

  private readonly go = newestOf(async (place: Point) => {
    const held = await this.holding;
    if (held === null) this.say("", "plain");
    else if (!this.over && place === this.target) await this.step(held, place);
  });

  private async step({ object, handle, at }: Held, place: Point): Promise<void> {
    const { gesture, gesture: { base }, press, uri } = this;
    if (!this.isOpen) editor.openAside(uri, base);
    this.isOpen = true;
    // A handle that was pressed beside its centre must not jump to the pointer, so it is moved by
    // the same vector as the pointer. For a drag of the camera, the server gets the point where the
    // pointer was pressed and its newest point.
    const to = object === null ? place : [at[0] + place[0] - press[0], at[1] + place[1] - press[1]];
    const { picture, view } = this.surface;
    const about = { textDocument: { uri }, object, handle, from: press, to, view,
      along: tools.along(object !== null), step: tools.step(picture) };
    try {
      const answer = await editor.request<Dragged | null>("pinhole/drag", about);
      if (this.over) return;
      if (answer === null) return this.say(BROKEN, "warning");
      if (!gesture.isAlone) {
        this.say(CHANGED_BY_OTHER, "warning");
        return this.finish();
      }
      gesture.write(editor.changes(answer.edits, base));
      const also = answer.also?.length ? `; also ${answer.also.join(", ")}` : "";
      this.say(answer.values.join(", ") + also, "plain");
      await Promise.race([frames.coarse, this.released]);
    } catch (error) {
      if (this.over || isSuperseded(error)) return;
      this.say((error as Error).message, "warning");
      if (!(error instanceof Refusal)) this.finish(); // a new server does not have the drag's text
    }
  }

  private finish(): void {
    if (this.over) return;
    this.over = true;
    clearTimeout(this.slow);
    this.gesture.end();
    if (note.dataset["tone"] !== "warning") clearNote();
    if (this.isOpen) editor.closeAside(this.uri);
    this.settle();
    frames.released(this);
  }

  private say(text: string, tone: "plain" | "warning"): void {
    clearTimeout(this.slow);
    this.slow = 0;
    showNote(text, tone, this.surface.picture.toScreen(this.target));
  }
}

/** Begins a drag that follows a pressed pointer. Returns a function that cancels it. */
export function dragWith(event: PointerEvent, start: Point,
  hold: () => Promise<Held | null> | Held, surface = own): () => void {
  const drag = new Drag(start, hold, surface);
  let moved = false;
  const { zoom } = surface.picture;
  const move = (next: PointerEvent) => {
    tools.held = next;
    // The movement is measured in screen pixels, because the picture itself may be moved during the
    // drag.
    const [dx, dy] = [next.clientX - event.clientX, next.clientY - event.clientY];
    moved ||= Math.hypot(dx, dy) > CLICK;
    if (moved) drag.to([start[0] + dx / zoom, start[1] + dy / zoom]);
  };
  return followPointer(event, move, () => drag.end(), () => drag.cancel());
}
