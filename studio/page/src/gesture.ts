// A gesture: many small changes of the text, by a drag, a slider or a colour picker, that one undo
// takes back. What it changes is marked, so that one sees which numbers move.

import { history, isolateHistory, undo } from "@codemirror/commands";
import { Annotation, EditorState, StateField, type ChangeSpec, type Extension,
  type Range } from "@codemirror/state";
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

/** The history of changes: typing is grouped by pauses, gestures as a whole. */
export function gestureHistory(): Extension {
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
    touchedField,
  ];
}

export class Gesture {
  private steps = 0;
  private over = false;

  constructor(private readonly view: EditorView) {}

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

  cancel(): void {
    if (this.over) return;
    this.end();
    if (this.steps > 0) undo(this.view);
  }
}
