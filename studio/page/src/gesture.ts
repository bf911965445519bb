// A gesture: many small changes of the text, by a drag, a slider or a colour picker, that one undo takes back.

import { history, isolateHistory, undo } from "@codemirror/commands";
import { Annotation, EditorState, type ChangeSpec, type Extension } from "@codemirror/state";
import { EditorView } from "@codemirror/view";

/** Marks a change that continues a gesture. */
const continues = Annotation.define<boolean>();

/** A pause in typing, in milliseconds, after which an undo step begins. */
const TYPING_PAUSE = 500;

/** The history of changes: typing is grouped by pauses, gestures as a whole. */
export function gestureHistory(): Extension {
  let last = 0;
  return [
    history({
      // The history itself joins all but what it was told to isolate, which it knows by a time of 0: so this is less than the time since 1970.
      newGroupDelay: 1e11,
      joinToEvent: (transaction, isAdjacent) => transaction.annotation(continues) === true || (isAdjacent && Date.now() - last < TYPING_PAUSE),
    }),
    EditorState.transactionExtender.of(transaction => {
      if (transaction.docChanged) queueMicrotask(() => (last = Date.now()));
      return null;
    }),
  ];
}

export class Gesture {
  private steps = 0;
  private over = false;

  constructor(private readonly view: EditorView) {}

  /** Whether the gesture has changed anything. */
  get changed(): boolean {
    return this.steps > 0;
  }

  apply(changes: ChangeSpec): void {
    if (this.over) return;
    const first = this.steps++ === 0;
    this.view.dispatch({ changes, annotations: first ? isolateHistory.of("before") : continues.of(true) });
  }

  end(): void {
    if (this.over) return;
    this.over = true;
    if (this.changed) this.view.dispatch({ annotations: isolateHistory.of("after") });
  }

  cancel(): void {
    if (this.over) return;
    this.end();
    if (this.changed) undo(this.view);
  }
}
