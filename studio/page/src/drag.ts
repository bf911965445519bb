// A drag of an object's handle, or of the camera. What it does to the text depends on the text as
// it was at the press, and on where the hand was then and is now, but not on the way between: the
// server is asked about that text, which it has under an address of its own meanwhile.

import { ChangeSet, type Text } from "@codemirror/state";
import { byId } from "./dom";
import type { SceneEditor } from "./editor";
import type { Frames } from "./frames";
import { Gesture } from "./gesture";
import type { Picture } from "./picture";
import { isSuperseded, Refusal, type Along, type Dragged, type Point } from "./protocol";
import { setText } from "./visible";

/** What is held, and where it was seen at the press; without an object it is the camera. */
export interface Held { object: number | null; handle: string; at: Point }

/** Why a drag could not be done stays readable for so many milliseconds after it. */
const REFUSAL_STAYS = 5000;
const BROKEN = "The text has errors. Mend them, then the picture can be changed by hand.";
const OTHERWISE = "The text was changed otherwise meanwhile, so the drag has ended.";

/** The page's parts that a drag works on, and what drags of objects are held to. */
export interface Workbench {
  editor: SceneEditor;
  frames: Frames;
  picture: Picture;
  along(): Along | undefined;
  rested(): void;
}

/** What a drag says stands where the hand is, while it lasts. */
class Note {
  private readonly element = byId("drag-note");
  private timer = 0;
  private staying = new AbortController();

  say(text: string, tone: "plain" | "warning", [x, y]: Point): void {
    this.clear();
    this.element.hidden = text === "";
    this.element.dataset["tone"] = tone;
    setText(this.element, text);
    const { clientWidth, clientHeight } = this.element.parentElement as HTMLElement;
    const { offsetWidth, offsetHeight } = this.element;
    const left = Math.max(4, Math.min(x + 18, clientWidth - offsetWidth - 4));
    const above = y - offsetHeight - 14;
    const top = Math.max(4, Math.min(above > 4 ? above : y + 22, clientHeight - offsetHeight - 4));
    this.element.style.transform = `translate(${left}px, ${top}px)`;
  }

  /** A refusal stays until something else is done, or for a while. */
  end(): void {
    if (this.element.hidden || this.element.dataset["tone"] !== "warning") return this.clear();
    const { signal } = this.staying;
    for (const type of ["pointerdown", "keydown"]) {
      addEventListener(type, () => this.clear(), { capture: true, signal });
    }
    this.timer = setTimeout(() => this.clear(), REFUSAL_STAYS);
  }

  private clear(): void {
    clearTimeout(this.timer);
    this.staying.abort();
    this.staying = new AbortController();
    this.element.hidden = true;
    setText(this.element, "");
  }
}

let note: Note | null = null;
let count = 0;

/** Asks for one edit at a time, always about the newest place of the hand. */
export class Drag {
  private readonly uri = `drag:${++count}`;
  /** The text at the press, what has become of it, and by which changes. */
  private base: Text;
  private current: Text;
  private written: ChangeSet;
  /** Where the hand is, and what was asked for last. */
  private target: Point;
  private asked: Point;
  private held: Held | null = null;
  private isOpen = false;
  private busy = false;
  private ending = false;
  private over = false;
  private gesture: Gesture;
  private readonly holding: Promise<Held | null>;
  private settle: () => void = () => {};
  private readonly done = new Promise<void>(resolve => (this.settle = resolve));

  /** What is held may be found out only after the press. */
  constructor(private readonly bench: Workbench, private readonly press: Point,
    hold: () => Promise<Held | null> | Held) {
    const { frames, editor: { view } } = bench;
    this.base = this.current = view.state.doc;
    this.written = ChangeSet.empty(this.base.length);
    this.target = this.asked = press;
    this.gesture = new Gesture(view);
    const before = frames.dragging instanceof Drag ? frames.dragging : null;
    frames.dragging = this;
    note ??= new Note();
    this.holding = this.begin(before, hold);
  }

  /** The drag before this one may not have come to its end yet. */
  private async begin(before: Drag | null, hold: () => Promise<Held | null> | Held) {
    if (before !== null) {
      await before.done;
      const { view } = this.bench.editor;
      this.base = this.current = view.state.doc;
      this.written = ChangeSet.empty(this.base.length);
      this.gesture = new Gesture(view);
    }
    return hold();
  }

  to(target: Point): void {
    this.target = target;
    void this.run();
  }

  by([dx, dy]: Point): void { this.to([this.target[0] + dx, this.target[1] + dy]); }

  /** Ends when the last place of the hand has been reached. */
  end(): void {
    this.ending = true;
    void this.holding.then(() => this.busy || this.finish());
  }

  cancel(): void {
    this.back();
    this.finish();
  }

  private async run(): Promise<void> {
    if (this.busy || this.over) return;
    this.busy = true;
    this.held = await this.holding;
    while (!this.over && this.held !== null && this.target !== this.asked) {
      await this.step(this.held, this.target);
    }
    this.busy = false;
    if (this.ending) this.finish();
  }

  private async step({ object, handle, at }: Held, place: Point): Promise<void> {
    const { editor, frames, along } = this.bench;
    const { base, press, uri } = this;
    this.asked = place;
    if (!this.isOpen) editor.openAside(uri, base.toString());
    this.isOpen = true;
    // An object's handle keeps its distance from the hand. Of the camera the hand's way counts.
    const to = object === null ? place : [at[0] + place[0] - press[0], at[1] + place[1] - press[1]];
    const about = { textDocument: { uri }, object, handle, from: press, to, along: along() };
    try {
      const answer = await editor.request<Dragged | null>("pinhole/drag", about);
      if (this.over) return;
      if (answer === null) return this.say(BROKEN, "warning");
      if (editor.view.state.doc !== this.current) {
        this.say(OTHERWISE, "warning");
        return this.finish();
      }
      this.write(editor.changes(answer.edits, base));
      const also = answer.also?.length ? `; also ${answer.also.join(", ")}` : "";
      this.say(answer.values.join(", ") + also, "plain");
      await frames.coarse;
    } catch (error) {
      if (this.over || isSuperseded(error)) return;
      this.say((error as Error).message, "warning");
      // Another server knows nothing of this drag's text.
      if (!(error instanceof Refusal)) this.finish();
    }
  }

  /** Has changes of the text at the press in the place of those that stand there. */
  private write(changes: ChangeSet): void {
    const { base, current } = this;
    const text = changes.apply(base);
    if (!text.eq(current)) this.gesture.apply(this.written.invert(base).compose(changes));
    this.written = changes;
    this.current = this.bench.editor.view.state.doc;
  }

  /** Whoever has changed the text otherwise keeps it. */
  private back(): void {
    if (this.over || this.bench.editor.view.state.doc !== this.current) return;
    this.gesture.cancel(this.written.invert(this.base));
    this.current = this.bench.editor.view.state.doc;
  }

  private finish(): void {
    if (this.over) return;
    // What has come back to where it was has not been.
    if (this.current.eq(this.base)) this.back();
    this.over = true;
    this.gesture.end();
    note?.end();
    if (this.isOpen) this.bench.editor.closeAside(this.uri);
    // Another drag may have begun before this one has come to its end.
    if (this.bench.frames.dragging === this) this.bench.frames.dragging = null;
    this.settle();
    this.bench.rested();
  }

  private say(text: string, tone: "plain" | "warning"): void {
    note?.say(text, tone, this.bench.picture.toScreen(this.target));
  }
}
