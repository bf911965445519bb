// Blocks of objects that come and go: Add, Duplicate, Delete. What is added the server writes.

import { isolateHistory } from "@codemirror/commands";
import { byId } from "./dom";
import { editor } from "./editor";
import type { Added } from "./protocol";
import { selection } from "./selection";
import { say } from "./status";

for (const button of document.querySelectorAll<HTMLElement>("[data-kind]")) {
  button.addEventListener("click", () => void add({ kind: button.dataset["kind"] }));
}
byId("duplicate").addEventListener("click", () => void duplicate());
byId("delete").addEventListener("click", removeBlock);

export async function duplicate(): Promise<void> {
  if (selection.index !== null) await add({ object: selection.index });
}

async function add(about: object): Promise<void> {
  const added = await editor.askCurrent<Added>("pinhole/add", about);
  if (added === null) return;
  // The cursor in it has it selected, as soon as it is known as an object.
  editor.view.dispatch({ changes: editor.changes(added.edits), scrollIntoView: true,
    selection: { anchor: added.cursor }, annotations: isolateHistory.of("full") });
  say(`${added.name ?? "A copy"} is added.`);
}

/** Takes the selected block away, with its line if nothing else is there. */
export function removeBlock(): void {
  const { view, view: { state: { doc } } } = editor;
  const found = selection.block;
  if (found === undefined) return;
  const [first, last] = [doc.lineAt(found.from), doc.lineAt(found.to)];
  const rest = doc.sliceString(first.from, found.from) + doc.sliceString(found.to, last.to);
  view.dispatch({ annotations: isolateHistory.of("full"), changes: rest.trim() === ""
    ? { from: first.from, to: Math.min(last.to + 1, doc.length) } : found });
}
