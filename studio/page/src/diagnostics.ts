// What is wrong with the text: the server's diagnostics in the editor, with their fixes as buttons.

import { setDiagnostics, type Action, type Diagnostic } from "@codemirror/lint";
import type { EditorView, KeyBinding } from "@codemirror/view";
import { forEachDiagnostic } from "@codemirror/lint";
import type { Connection } from "./connection";
import type { SceneEditor } from "./editor";
import { isSuperseded, type Range, type TextEdit } from "./protocol";

interface ServerDiagnostic {
  range: Range;
  severity?: number;
  message: string;
}

interface CodeAction {
  title: string;
  kind: string;
  diagnostics?: ServerDiagnostic[];
  edit: { changes?: Record<string, TextEdit[]> };
}

interface Published {
  uri: string;
  version?: number;
  diagnostics: ServerDiagnostic[];
}

/** Shows diagnostics of the newest text at once, and again with their fixes when the server has answered what these are. */
export async function publishDiagnostics(editor: SceneEditor, connection: Connection, published: Published): Promise<void> {
  const file = editor.client.workspace.getFile(published.uri);
  const { doc } = editor.view.state;
  if (file === null || file.doc !== doc || (published.version !== undefined && published.version !== file.version)) return;
  show(editor, published.diagnostics, []);
  if (published.diagnostics.length === 0) return;
  const range = { start: { line: 0, character: 0 }, end: { line: doc.lines, character: 0 } };
  try {
    const actions = await connection.request<CodeAction[] | null>("textDocument/codeAction", editor.about({ range, context: { diagnostics: [] } }));
    if (editor.view.state.doc === doc) show(editor, published.diagnostics, actions ?? []);
  } catch (error) {
    // Without an answer the diagnostics stay as they are.
    if (!isSuperseded(error)) console.warn(error);
  }
}

function show(editor: SceneEditor, diagnostics: ServerDiagnostic[], actions: CodeAction[]): void {
  const shown = diagnostics.map((diagnostic): Diagnostic => {
    const fixes = actions.filter(action => action.diagnostics?.some(it => isSame(it, diagnostic)));
    const all = fixes.length > 0 ? actions.filter(action => action.diagnostics === undefined) : [];
    return {
      from: editor.offset(diagnostic.range.start),
      to: editor.offset(diagnostic.range.end),
      severity: diagnostic.severity === 2 ? "warning" : "error",
      message: diagnostic.message,
      actions: [...fixes, ...all].map(action => fix(editor, action)),
    };
  });
  editor.view.dispatch(setDiagnostics(editor.view.state, shown));
}

function isSame(one: ServerDiagnostic, other: ServerDiagnostic): boolean {
  return one.message === other.message && JSON.stringify(one.range) === JSON.stringify(other.range);
}

function fix(editor: SceneEditor, action: CodeAction): Action {
  const { doc } = editor.view.state;
  const edits = action.edit.changes?.[editor.uri] ?? [];
  return {
    name: action.title,
    apply(view) {
      // The edits are for the text that was judged; a newer one is being judged now.
      if (view.state.doc === doc) view.dispatch({ changes: editor.changes(edits), userEvent: "input.fix" });
    },
  };
}

/** How many diagnostics there are. */
export function countDiagnostics(view: EditorView): number {
  let count = 0;
  forEachDiagnostic(view.state, () => count++);
  return count;
}

/** Applies the first fix of the diagnostic at the cursor, or else of the first one that has any. */
export const fixKey: KeyBinding = {
  key: "Mod-.",
  run(view) {
    const { head } = view.state.selection.main;
    const fixable: { diagnostic: Diagnostic; from: number; to: number }[] = [];
    forEachDiagnostic(view.state, (diagnostic, from, to) => {
      if (diagnostic.actions?.length) fixable.push({ diagnostic, from, to });
    });
    const chosen = fixable.find(({ from, to }) => from <= head && head <= to) ?? fixable[0];
    chosen?.diagnostic.actions?.[0]?.apply(view, chosen.from, chosen.to);
    return chosen !== undefined;
  },
};
