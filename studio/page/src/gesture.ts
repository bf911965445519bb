// A gesture: many small changes of the text, by a drag, a slider or a colour picker, that one undo
// takes back. What it changes is marked, so that one sees which numbers move.

import { history, historyField, isolateHistory } from "@codemirror/commands";
import { Annotation, ChangeSet, Compartment, EditorState, StateField, type ChangeSpec, type
  Extension, type Range, type Text, type TransactionSpec } from "@codemirror/state";
import { Decoration, EditorView, type DecorationSet } from "@codemirror/view";

/** Marks a change that belongs to a gesture: its first one, or one that continues it. */
const step = Annotation.define<"first" | "next">();

/** A pause in typing, in milliseconds, after which an undo step begins. */
const TYPING_PAUSE = 500;
const touched = Decoration.mark({ class: "touched" });

/** What the last change of a gesture wrote, until something else changes the text. */
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

/** Where the history is kept, so that it can be put back as it was. */
const kept = new Compartment();

function grouped(past: Extension = []): Extension {
  let last = 0;
  return [
    history({
      // All is joined but what is isolated, whose time is 0: it is less than the time since 1970.
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

/** The history of changes: typing is grouped by pauses, gestures as a whole. */
export function gestureHistory(): Extension { return [kept.of(grouped()), touchedField]; }

/** Changes the text, and gives it the history that it had in the past, or a new one. */
export function rewrite(view: EditorView, change: TransactionSpec, past: Extension = []): void {
  view.dispatch({ effects: kept.reconfigure([]) });
  view.dispatch(change);
  view.dispatch({ effects: kept.reconfigure(grouped(past)) });
}

/** Depends on the text as it was at the beginning and on what was written last, but not on what was
 *  written between. Who else changes the text keeps that: then it does nothing more. */
export class Gesture {
  /** The text at the beginning, what has become of it, and by which changes. */
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

  /** Whether nobody else has changed the text. */
  get isAlone(): boolean { return this.view.state.doc === this.current; }

  /** Puts a change of the text at the beginning in the place of the last one, and shows it. */
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

  /** Ends; what has come back to where it was has not been. */
  end(): void {
    if (this.over) return;
    if (this.isAlone && this.current.eq(this.base)) return this.cancel();
    this.over = true;
    if (this.current !== this.base) this.view.dispatch({ annotations: isolateHistory.of("after") });
  }

  /** Ends as if nothing had happened: neither Undo nor Redo knows. */
  cancel(): void {
    if (this.over) return;
    if (!this.isAlone) return this.end();
    this.over = true;
    const { base, current, view, written } = this;
    if (current !== base) rewrite(view, { changes: written.invert(base) }, this.past);
  }
}
