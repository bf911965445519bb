// A drag of an object's handle, or of the camera. What it does to the text depends on the text as
// it was at the press, and on where the hand was then and is now, but not on the way between: the
// server is asked about that text, which it has under an address of its own meanwhile.

import { ChangeSet, type Text } from "@codemirror/state";
import { byId } from "./dom";
import { editor } from "./editor";
import { frames } from "./frames";
import { Gesture } from "./gesture";
import { picture } from "./picture";
import { isSuperseded, Refusal, type Dragged, type Point } from "./protocol";
import { tools } from "./tools";
import { setText } from "./visible";

/** What is held, and where it was seen at the press; without an object it is the camera. */
export interface Held { object: number | null; handle: string; at: Point }

/** Why a drag could not be done stays readable for so many milliseconds after it. */
const REFUSAL_STAYS = 5000;
const BROKEN = "The text has errors. Mend them, then the picture can be changed by hand.";
const OTHERWISE = "The text was changed otherwise meanwhile, so the drag has ended.";

// What a drag says stands where the hand is, while it lasts.
const note = byId("drag-note");
let staying = new AbortController();

function showNote(text: string, tone: "plain" | "warning", [x, y]: Point): void {
  staying.abort();
  note.hidden = text === "";
  note.dataset["tone"] = tone;
  setText(note, text);
  const { style } = byId("drag-place");
  style.setProperty("--x", `${x}px`);
  style.setProperty("--y", `${y}px`);
}

/** A refusal stays until something else is done, or for a while. */
function endNote(): void {
  const clear = () => showNote("", "plain", [0, 0]);
  if (note.hidden || note.dataset["tone"] !== "warning") return clear();
  const { signal } = (staying = new AbortController());
  for (const type of ["pointerdown", "keydown"]) {
    addEventListener(type, clear, { capture: true, signal });
  }
  const timer = setTimeout(clear, REFUSAL_STAYS);
  signal.addEventListener("abort", () => clearTimeout(timer));
}

let count = 0;

/** Asks for one edit at a time, always about the newest place of the hand. */
export class Drag {
  private readonly uri = `drag:${++count}`;
  /** The text at the press, what has become of it, and by which changes. */
  private base!: Text;
  private current!: Text;
  private written!: ChangeSet;
  /** Where the hand is, and what was asked for last. */
  private target: Point;
  private asked: Point;
  private held: Held | null = null;
  private isOpen = false;
  private busy = false;
  private ending = false;
  private over = false;
  private gesture!: Gesture;
  private readonly holding: Promise<Held | null>;
  private settle: () => void = () => {};
  private readonly done = new Promise<void>(resolve => (this.settle = resolve));

  /** What is held may be found out only after the press. */
  constructor(private readonly press: Point, hold: () => Promise<Held | null> | Held) {
    this.target = this.asked = press;
    const before = frames.dragging instanceof Drag ? frames.dragging : null;
    frames.dragging = this;
    this.holding = this.begin(before, hold);
  }

  /** The drag before this one may not have come to its end yet. */
  private async begin(before: Drag | null, hold: () => Promise<Held | null> | Held) {
    this.take();
    if (before !== null) {
      await before.done;
      this.take();
    }
    return hold();
  }

  private take(): void {
    this.base = this.current = editor.view.state.doc;
    this.written = ChangeSet.empty(this.base.length);
    this.gesture = new Gesture(editor.view);
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
    const { base, press, uri } = this;
    this.asked = place;
    if (!this.isOpen) editor.openAside(uri, base);
    this.isOpen = true;
    // An object's handle keeps its distance from the hand. Of the camera the hand's way counts.
    const to = object === null ? place : [at[0] + place[0] - press[0], at[1] + place[1] - press[1]];
    const about = { textDocument: { uri }, object, handle, from: press, to, along: tools.along,
      step: tools.step };
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
    this.current = editor.view.state.doc;
  }

  /** Whoever has changed the text otherwise keeps it. */
  private back(): void {
    if (this.over || editor.view.state.doc !== this.current) return;
    this.gesture.cancel(this.written.invert(this.base));
    this.current = editor.view.state.doc;
  }

  private finish(): void {
    if (this.over) return;
    // What has come back to where it was has not been.
    if (this.current.eq(this.base)) this.back();
    this.over = true;
    this.gesture.end();
    endNote();
    if (this.isOpen) editor.closeAside(this.uri);
    this.settle();
    frames.released(this);
  }

  private say(text: string, tone: "plain" | "warning"): void {
    showNote(text, tone, picture.toScreen(this.target));
  }
}
