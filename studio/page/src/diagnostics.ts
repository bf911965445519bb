// The server's diagnostics, in the editor and in a list below the text, with buttons for fixes.

import { forEachDiagnostic, setDiagnostics, setDiagnosticsEffect, type Action, type
  Diagnostic } from "@codemirror/lint";
import { EditorView, type KeyBinding } from "@codemirror/view";
import type { CodeAction, Diagnostic as ServerDiagnostic, PublishDiagnosticsParams } from
  "vscode-languageserver-protocol";
import { byId, create, createButton } from "./dom";
import { editor } from "./editor";
import { setText, visible } from "./visible";

/** Shows the diagnostics of the current text together with their fixes. A separate update for the
 * fixes would close an open tooltip. Diagnostics of an older text are ignored. */
export async function publishDiagnostics(published: PublishDiagnosticsParams): Promise<void> {
  const file = editor.client.workspace.getFile(published.uri);
  const { doc } = editor.view.state;
  if (file === null || file.doc !== doc || (published.version !== undefined
    && published.version !== file.version)) return;
  // If there are no diagnostics, and none were shown before, there is nothing to update, so the
  // fixes are not requested. This is the usual case during a drag.
  const isRight = published.diagnostics.length === 0;
  if (isRight && !hasMarks) return;
  const actions = isRight ? [] : await editor.ask<CodeAction[]>("textDocument/codeAction",
    { range: editor.range(), context: { diagnostics: [] } });
  // If the server does not answer, the diagnostics are shown without fixes.
  if (editor.view.state.doc === doc) show(published.diagnostics, actions ?? []);
}

/** Whether the editor shows marks of diagnostics. They must be removed when there are no
 * diagnostics any more. */
let hasMarks = false;

function show(diagnostics: ServerDiagnostic[], actions: CodeAction[]): void {
  hasMarks = diagnostics.length > 0;
  const mending = new Map<string, CodeAction[]>();
  for (const action of actions) for (const it of action.diagnostics ?? []) {
    mending.set(keyOf(it), [...mending.get(keyOf(it)) ?? [], action]);
  }
  const ofAll = actions.filter(action => action.diagnostics === undefined);
  const shown = diagnostics.map((diagnostic): Diagnostic => {
    const fixes = mending.get(keyOf(diagnostic)) ?? [];
    // A fix without `diagnostics` mends several problems at once. Such fixes are listed only once,
    // at the first problem that also has a fix of its own.
    const all = fixes.length > 0 ? ofAll.splice(0) : [];
    return {
      from: editor.offset(diagnostic.range.start),
      to: editor.offset(diagnostic.range.end),
      severity: diagnostic.severity === 2 ? "warning" : "error",
      message: visible(String(diagnostic.message)),
      actions: [...fixes, ...all].map(action => fix(action)),
    };
  });
  editor.view.dispatch(setDiagnostics(editor.view.state, shown));
}

/** Returns a key by which a code action finds the diagnostic that it fixes: the diagnostic's
 * message and range. */
const keyOf = ({ message, range }: ServerDiagnostic) => JSON.stringify([message, range]);

function fix(action: CodeAction): Action {
  const { doc } = editor.view.state;
  const edits = action.edit?.changes?.[editor.uri] ?? [];
  // Range of the example value that the fix inserts, if any. The offsets are relative to the start
  // of the first edit's text.
  const [value]: [number, number][] = action.data?.values ?? [];
  return {
    name: visible(action.title),
    apply(view) {
      // The edits fit only the text that was checked. If the text has changed since, they are not
      // applied; diagnostics of the new text will arrive.
      if (view.state.doc !== doc) return;
      // If the fix inserts an example value, the value is selected, so that typing replaces it. The
      // server gives the value's range in bytes. Here, a byte is a character, because a fix with an
      // example value inserts only ASCII.
      const at = edits[0] ? editor.offset(edits[0].range.start) : 0;
      const made = value && { selection: { anchor: at + value[0], head: at + value[1] } };
      const changes = editor.changes(edits);
      view.dispatch({ changes, userEvent: "input.fix", ...made, scrollIntoView: true });
      if (made) view.focus();
    },
  };
}

/** Updates the list of problems when the editor's text or diagnostics change. */
export const problemsFollow = EditorView.updateListener.of(({ docChanged, transactions }) => {
  const areOther = transactions.some(it => it.effects.some(it => it.is(setDiagnosticsEffect)));
  if (docChanged || areOther) showProblems();
});

const button = byId("problems");
const isOpen = () => button.getAttribute("aria-expanded") === "true";
button.addEventListener("click", () => {
  button.setAttribute("aria-expanded", String(!isOpen()));
  showProblems();
});

/** Returns the editor's diagnostics, each with its current range. */
function diagnosed(): [Diagnostic, number, number][] {
  const found: [Diagnostic, number, number][] = [];
  forEachDiagnostic(editor.view.state, (...it) => found.push(it));
  return found;
}

const told = (message: string, from: number) =>
  `${editor.view.state.doc.lineAt(from).number}: ${message}`;

/** Returns the first error with its line, if there is one. */
export const firstError = () => diagnosed().filter(([it]) => it.severity === "error").slice(0, 1)
  .map(([{ message }, from]) => `Line ${told(message, from)}`);

/** Lists the problems below the text: all if the list is open, and otherwise only the first error,
 * or the first warning if there is no error. */
export function showProblems(): void {
  const found = diagnosed();
  const { length } = found;
  const error = found.find(([it]) => it.severity === "error");
  const worst = error ? "problem" : "warning";
  button.dataset["worst"] = length === 0 ? "" : worst;
  setText(button, length === 0 ? "No problems" : `${length} ${worst}${length === 1 ? "" : "s"}`);
  const list = byId("problem-list");
  const isWhole = isOpen();
  list.hidden = length === 0;
  list.toggleAttribute("data-all", isWhole);
  // Hidden items are not created, because a drag updates the list many times a second.
  const listed = isWhole || !error ? found.slice(0, isWhole ? length : 1) : [error];
  list.replaceChildren(...listed.map(it => item(...it)));
}

/** Creates the list item of a problem: a button that moves the cursor there, and its fixes. */
function item({ severity, message, actions }: Diagnostic, from: number, to: number): HTMLElement {
  const { view } = editor;
  const item = create("li", severity);
  item.append(createButton(told(message, from), "place", () => {
    view.dispatch({ selection: { anchor: from }, scrollIntoView: true });
    view.focus();
  }));
  for (const { name, apply } of actions ?? []) item.append(
    createButton(name, "fix", () => apply(view, from, to)));
  return item;
}

/** Applies the first fix of the problem at the cursor. If this problem has no fix, applies the
 * first fix in the text. */
export const fixKey: KeyBinding = {
  key: "Mod-.",
  run(view) {
    const { head } = view.state.selection.main;
    const fixable = diagnosed().filter(([{ actions }]) => actions?.length);
    const chosen = fixable.find(([, from, to]) => from <= head && head <= to) ?? fixable[0];
    chosen?.[0].actions?.[0]?.apply(view, chosen[1], chosen[2]);
    return chosen !== undefined;
  },
};
