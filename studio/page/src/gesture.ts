// A gesture: many small changes of the text, by a drag, a slider or a colour picker, that one undo
// takes back. What it changes is marked, so that one sees which numbers move.

import { history, historyField, isolateHistory } from "@codemirror/commands";
import { Annotation, Compartment, EditorState, StateField, type ChangeSpec, type Extension, type
  Range, type TransactionSpec } from "@codemirror/state";
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
      // The history itself joins all but what it was told to isolate, which it knows by a time of
      // 0: so this is less than the time since 1970.
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

export class Gesture {
  private steps = 0;
  private over = false;
  private readonly past: Extension;

  constructor(private readonly view: EditorView) {
    const past = view.state.field(historyField, false);
    this.past = historyField.init(() => past);
  }

  /** Changes the text, and shows the first place of it. */
  apply(spec: ChangeSpec): void {
    if (this.over) return;
    const changes = this.view.state.changes(spec);
    let place = 0;
    changes.iterChangedRanges((_fromOld, _toOld, from) => (place ||= from));
    const annotations = this.steps++ === 0 ? [step.of("first"), isolateHistory.of("before")]
      : [step.of("next")];
    this.view.dispatch({ changes, annotations,
      effects: EditorView.scrollIntoView(place, { y: "nearest" }) });
  }

  end(): void {
    if (this.over) return;
    this.over = true;
    if (this.steps > 0) this.view.dispatch({ annotations: isolateHistory.of("after") });
  }

  /** Ends as if nothing had happened, by a change that leads back: neither Undo nor Redo knows. */
  cancel(back: ChangeSpec): void {
    if (this.over) return;
    this.over = true;
    if (this.steps > 0) rewrite(this.view, { changes: back }, this.past);
  }
}
