// Blocks of objects that come and go: Add, Duplicate, Delete. What is added the server writes.

import { isolateHistory } from "@codemirror/commands";
import { byId } from "./dom";
import type { SceneEditor } from "./editor";
import type { Added } from "./protocol";
import type { Selection } from "./selection";
import { say } from "./status";

export class Blocks {
  constructor(private readonly editor: SceneEditor, private readonly selection: Selection) {
    for (const button of document.querySelectorAll<HTMLElement>("[data-kind]")) {
      button.addEventListener("click", () => void this.add({ kind: button.dataset["kind"] }));
    }
    byId("duplicate").addEventListener("click", () => void this.duplicate());
    byId("delete").addEventListener("click", () => this.remove());
  }

  async duplicate(): Promise<void> {
    const { index } = this.selection;
    if (index !== null) await this.add({ object: index });
  }

  private async add(about: object): Promise<void> {
    const { editor, editor: { view } } = this;
    const added = await editor.askCurrent<Added>("pinhole/add", about);
    if (added === null) return;
    // The cursor in it has it selected, as soon as it is known as an object.
    view.dispatch({ changes: editor.changes(added.edits), scrollIntoView: true,
      selection: { anchor: added.cursor }, annotations: isolateHistory.of("full") });
    say(`${added.name ?? "A copy"} is added.`);
  }

  /** Takes the selected block away, with its line if nothing else is there. */
  remove(): void {
    const { view } = this.editor;
    const found = this.selection.block;
    if (found === undefined) return;
    const { doc } = view.state;
    const [first, last] = [doc.lineAt(found.from), doc.lineAt(found.to)];
    const rest = doc.sliceString(first.from, found.from) + doc.sliceString(found.to, last.to);
    const isAlone = rest.trim() === "";
    view.dispatch({ annotations: isolateHistory.of("full"), changes: isAlone
      ? { from: first.from, to: Math.min(last.to + 1, doc.length) } : found });
  }
}
