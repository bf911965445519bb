// A gesture: many small changes of the text, by a drag, a slider or a colour picker, that a single
// Undo reverts. The changed numbers are highlighted.

import { history, historyField, isolateHistory } from "@codemirror/commands";
import { Annotation, ChangeSet, Compartment, EditorState, StateField, type ChangeSpec, type
  Extension, type Range, type Text, type TransactionSpec } from "@codemirror/state";
import { Decoration, EditorView, type DecorationSet } from "@codemirror/view";

/** Marks a change of the text as the first change of a gesture, or as a later one. */
const step = Annotation.define<"first" | "next">();

/** Maximum pause in typing, in ms, after which the text before and after the pause is still undone
 * together. The value is CodeMirror's default. */
const TYPING_PAUSE = 500;
const touched = Decoration.mark({ class: "touched" });

/** Highlights what a drag or slider changed last, until the text changes in another way. */
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

/** Part of the editor's configuration that contains the undo history. With it, `rewrite` replaces
 * the history. */
const kept = new Compartment();

function grouped(past: Extension = []): Extension {
  let last = 0;
  return [
    history({
      // CodeMirror undoes two changes separately if the time between them, in ms, is longer than
      // this value. The value is longer than any session, so `joinToEvent` decides instead, except
      // for changes that are marked by `isolateHistory`.
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

/** Returns the extension for Undo. One Undo reverts a whole gesture, or all that was typed without
 * a pause. */
export function gestureHistory(): Extension { return [kept.of(grouped()), touchedField]; }

/** Changes the text, and replaces the undo history by `past` or by an empty one. */
export function rewrite(view: EditorView, change: TransactionSpec, past: Extension = []): void {
  view.dispatch({ effects: kept.reconfigure([]) });
  view.dispatch(change);
  view.dispatch({ effects: kept.reconfigure(grouped(past)) });
}

/** Returns the undo history, to be restored by `rewrite` when the text is the same again. */
export function pastOf(view: EditorView): Extension {
  const past = view.state.field(historyField, false);
  return historyField.init(() => past);
}

/** Changes of the text by a drag or slider. The result depends only on the text at the start and on
 * the last change. If something else changes the text, no further change is made. */
export class Gesture {
  /** Text of the scene when the gesture began. */
  readonly base: Text;
  /** Text after the last change that the gesture has made. */
  private current: Text;
  /** Changes that the gesture has made to the text so far. */
  private written: ChangeSet;
  private over = false;
  private readonly past: Extension;

  constructor(private readonly view: EditorView) {
    this.past = pastOf(view);
    this.base = this.current = view.state.doc;
    this.written = ChangeSet.empty(this.base.length);
  }

  /** Whether the text has changed only by this gesture. */
  get isAlone(): boolean { return this.view.state.doc === this.current; }

  /** Replaces the gesture's last change by another one, and scrolls to it. `spec` is a change of
   * the text before the gesture. */
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

  /** Ends the gesture. If the text is the same as before the gesture, the gesture leaves no entry
   * in the undo history. */
  end(): void {
    if (this.over) return;
    if (this.isAlone && this.current.eq(this.base)) return this.cancel();
    this.over = true;
    if (this.current !== this.base) this.view.dispatch({ annotations: isolateHistory.of("after") });
  }

  /** Reverts the gesture, and leaves no entry in the undo history. If something else has changed
   * the text, only ends the gesture. */
  cancel(): void {
    if (this.over) return;
    if (!this.isAlone) return this.end();
    this.over = true;
    const { base, current, view, written } = this;
    if (current !== base) rewrite(view, { changes: written.invert(base) }, this.past);
  }
}
