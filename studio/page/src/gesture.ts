// A gesture: many small changes of the text (by a drag, a slider or a colour picker) that a single
// Undo reverts. The changed numbers are highlighted.

import { history, historyField, isolateHistory } from "@codemirror/commands";
import { Annotation, ChangeSet, Compartment, EditorState, StateField, type ChangeSpec, type
  Extension, type Range, type Text, type TransactionSpec } from "@codemirror/state";
import { Decoration, EditorView, type DecorationSet } from "@codemirror/view";

/** Marks a change of a gesture as the gesture's `first`, or as one of the `next`. */
const step = Annotation.define<"first" | "next">();

/** Pause in typing that begins a new undo step, in milliseconds. */
const TYPING_PAUSE = 500;
const touched = Decoration.mark({ class: "touched" });

/** Highlights what a gesture changed last, until the text changes again. */
const touchedField = StateField.define<DecorationSet>({
  create: () => Decoration.none,
  update(marks, transaction) {
    if (!transaction.docChanged) return marks;
    if (transaction.annotation(step) === undefined) return Decoration.none;
    const ranges: Range<Decoration>[] = [];
    transaction.changes.iterChanges((_fromOld, _toOld, from, to) => {
      if (from < to) ranges.push(touched.range(from, to));
    });
    return Decoration.set(ranges);
  },
  provide: field => EditorView.decorations.from(field),
});

/** Compartment of the history, by which `rewrite` replaces the history. */
const kept = new Compartment();

function grouped(past: Extension = []): Extension {
  let last = 0;
  return [
    history({
      // This delay joins all changes except isolated ones, whose time counts as 0.
      newGroupDelay: 1e11,
      joinToEvent: (transaction, isAdjacent) => transaction.annotation(step) === "next"
        || (isAdjacent && Date.now() - last < TYPING_PAUSE),
    }),
    EditorState.transactionExtender.of(transaction => {
      if (transaction.docChanged) queueMicrotask(() => (last = Date.now()));
      return null;
    }),
    past,
  ];
}

/** Returns a history that groups typing by pauses and makes each gesture one undo step. */
export function gestureHistory(): Extension { return [kept.of(grouped()), touchedField]; }

/** Changes the text and replaces its history by `past`, or by an empty one. */
export function rewrite(view: EditorView, change: TransactionSpec, past: Extension = []): void {
  view.dispatch({ effects: kept.reconfigure([]) });
  view.dispatch(change);
  view.dispatch({ effects: kept.reconfigure(grouped(past)) });
}

/** A gesture. Its result depends only on the text at its start and on its last change. After a
 *  change of the text by something else, it changes nothing more. */
export class Gesture {
  /** Text at the start, text now, and (`written`) the changes from one to the other. */
  readonly base: Text;
  private current: Text;
  private written: ChangeSet;
  private over = false;
  private readonly past: Extension;

  constructor(private readonly view: EditorView) {
    const past = view.state.field(historyField, false);
    this.past = historyField.init(() => past);
    this.base = this.current = view.state.doc;
    this.written = ChangeSet.empty(this.base.length);
  }

  /** Whether the text has changed only by this gesture. */
  get isAlone(): boolean { return this.view.state.doc === this.current; }

  /** Replaces the last change by another change of the initial text, and scrolls to it. */
  write(spec: ChangeSpec): void {
    if (this.over || !this.isAlone) return;
    const { base, current, view, written } = this;
    this.written = ChangeSet.of(spec, base.length, "\n");
    if (this.written.apply(base).eq(current)) return;
    const changes = written.invert(base).compose(this.written);
    let place = 0;
    changes.iterChangedRanges((_fromOld, _toOld, from) => (place ||= from));
    const annotations = current === base ? [step.of("first"), isolateHistory.of("before")]
      : [step.of("next")];
    view.dispatch({ changes, annotations,
      effects: EditorView.scrollIntoView(place, { y: "nearest" }) });
    this.current = view.state.doc;
  }

  /** Ends the gesture. If the text is the initial one again, the history forgets the gesture. */
  end(): void {
    if (this.over) return;
    if (this.isAlone && this.current.eq(this.base)) return this.cancel();
    this.over = true;
    if (this.current !== this.base) this.view.dispatch({ annotations: isolateHistory.of("after") });
  }

  /** Reverts the gesture without a trace in Undo or Redo; after foreign changes, only ends it. */
  cancel(): void {
    if (this.over) return;
    if (!this.isAlone) return this.end();
    this.over = true;
    const { base, current, view, written } = this;
    if (current !== base) rewrite(view, { changes: written.invert(base) }, this.past);
  }
}
