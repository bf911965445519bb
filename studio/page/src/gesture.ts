// A gesture: many small changes of the text, by a drag, a slider or a colour picker, that one Undo
// reverts. The changed numbers are highlighted.

import { history, historyField, isolateHistory } from "@codemirror/commands";
import { Annotation, ChangeSet, Compartment, EditorState, StateField, type ChangeSpec, type
  Extension, type Range, type Text, type TransactionSpec } from "@codemirror/state";
import { Decoration, EditorView, type DecorationSet } from "@codemirror/view";

/** Marks a change that belongs to a gesture: its first one, or one that continues it. */
const step = Annotation.define<"first" | "next">();

/** Pause in typing after which a new undo step begins, in milliseconds. */
const TYPING_PAUSE = 500;
const touched = Decoration.mark({ class: "touched" });

/** Highlights the last change of a gesture until another change of the text. */
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

/** Compartment of the history, so that it can be restored. */
const kept = new Compartment();

function grouped(past: Extension = []): Extension {
  let last = 0;
  return [
    history({
      // Joins all changes except isolated ones, which have the time 0: longer ago than this.
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

/** History of changes, which groups typing by pauses and a gesture as a whole. */
export function gestureHistory(): Extension { return [kept.of(grouped()), touchedField]; }

/** Changes the text and sets its history to a past one, or to a new one. */
export function rewrite(view: EditorView, change: TransactionSpec, past: Extension = []): void {
  view.dispatch({ effects: kept.reconfigure([]) });
  view.dispatch(change);
  view.dispatch({ effects: kept.reconfigure(grouped(past)) });
}

/** Depends on the text at the start and the last change, but not on the changes in between. After
 *  a foreign change of the text, a gesture changes nothing more. */
export class Gesture {
  /** The text at the start, the current text, and the changes between them. */
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

  /** Whether nothing else has changed the text. */
  get isAlone(): boolean { return this.view.state.doc === this.current; }

  /** Replaces the last change by another change of the original text, and scrolls to it. */
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

  /** Ends the gesture. One that has restored the original text leaves no history. */
  end(): void {
    if (this.over) return;
    if (this.isAlone && this.current.eq(this.base)) return this.cancel();
    this.over = true;
    if (this.current !== this.base) this.view.dispatch({ annotations: isolateHistory.of("after") });
  }

  /** Reverts the gesture, without a trace in Undo or Redo. */
  cancel(): void {
    if (this.over) return;
    if (!this.isAlone) return this.end();
    this.over = true;
    const { base, current, view, written } = this;
    if (current !== base) rewrite(view, { changes: written.invert(base) }, this.past);
  }
}
