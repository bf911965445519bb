// What is wrong with the text: the server's diagnostics in the editor, with their fixes as buttons.

import { diagnosticCount, forEachDiagnostic, setDiagnostics, setDiagnosticsEffect, type Action, type
  Diagnostic } from "@codemirror/lint";
import type { EditorView, KeyBinding, ViewUpdate } from "@codemirror/view";
import { byId, create, createButton } from "./dom";
import type { SceneEditor } from "./editor";
import type { Published, ServerDiagnostic, TextEdit } from "./protocol";
import { setText, visible } from "./visible";

interface CodeAction {
  title: string;
  kind: string;
  diagnostics?: ServerDiagnostic[];
  edit: { changes?: Record<string, TextEdit[]> };
  data?: { values: [number, number][] }; // made-up ones, in the text of the first edit
}

/** Shows diagnostics with their fixes, at once: new diagnostics would close an open tooltip. */
export async function publishDiagnostics(editor: SceneEditor, published: Published): Promise<void> {
  const file = editor.client.workspace.getFile(published.uri);
  const { doc } = editor.view.state;
  if (file === null || file.doc !== doc || (published.version !== undefined
    && published.version !== file.version)) return;
  // A drag is told of every text that nothing is wrong with it.
  if (published.diagnostics.length === 0 && diagnosticCount(editor.view.state) === 0) return;
  const isRight = published.diagnostics.length === 0;
  const actions = isRight ? [] : await editor.ask<CodeAction[]>("textDocument/codeAction",
    { range: editor.whole, context: { diagnostics: [] } });
  // Without an answer they are shown without fixes.
  if (editor.view.state.doc === doc) show(editor, published.diagnostics, actions ?? []);
}

function show(editor: SceneEditor, diagnostics: ServerDiagnostic[], actions: CodeAction[]): void {
  const mending = new Map<string, CodeAction[]>();
  for (const action of actions) for (const it of action.diagnostics ?? []) {
    mending.set(keyOf(it), [...mending.get(keyOf(it)) ?? [], action]);
  }
  const ofAll = actions.filter(action => action.diagnostics === undefined);
  const shown = diagnostics.map((diagnostic): Diagnostic => {
    const fixes = mending.get(keyOf(diagnostic)) ?? [];
    const all = fixes.length > 0 ? ofAll : [];
    return {
      from: editor.offset(diagnostic.range.start),
      to: editor.offset(diagnostic.range.end),
      severity: diagnostic.severity === 2 ? "warning" : "error",
      message: visible(diagnostic.message),
      actions: [...fixes, ...all].map(action => fix(editor, action)),
    };
  });
  editor.view.dispatch(setDiagnostics(editor.view.state, shown));
}

/** What is the same of a diagnostic and of that which an action names. */
function keyOf({ message, range: { start, end } }: ServerDiagnostic): string {
  return `${start.line} ${start.character} ${end.line} ${end.character} ${message}`;
}

function fix(editor: SceneEditor, action: CodeAction): Action {
  const { doc } = editor.view.state;
  const edits = action.edit.changes?.[editor.uri] ?? [];
  const [value] = action.data?.values ?? [];
  return {
    name: visible(action.title),
    apply(view) {
      // The edits are for the text that was judged; a newer one is being judged now.
      if (view.state.doc !== doc) return;
      // A made-up value is selected, to type over. What is made up is ASCII.
      const at = edits[0] ? editor.offset(edits[0].range.start) : 0;
      const made = value && { selection: { anchor: at + value[0], head: at + value[1] } };
      const changes = editor.changes(edits);
      view.dispatch({ changes, userEvent: "input.fix", ...made, scrollIntoView: true });
      if (made) view.focus();
    },
  };
}

/** Whether an update of the editor brings other diagnostics, or moves them. */
export function changesDiagnostics(update: ViewUpdate): boolean {
  return update.docChanged || update.transactions.some(
    it => it.effects.some(effect => effect.is(setDiagnosticsEffect)));
}

/** What is wrong: the first of it under the text, and a list of all. */
export class Problems {
  private readonly button = byId("problems");
  private readonly list = byId("problem-list");
  private readonly first = byId("first-problem");

  constructor(private readonly view: () => EditorView) {
    this.button.addEventListener("click", () => {
      this.button.setAttribute("aria-expanded", String(this.list.hidden));
      this.list.hidden = !this.list.hidden;
      this.update();
    });
  }

  update(): void {
    const view = this.view();
    const found: [Diagnostic, number, number][] = [];
    forEachDiagnostic(view.state, (...it) => found.push(it));
    const count = found.length;
    setText(this.button, count === 0 ? "No problems" : count === 1 ? "1 problem"
      : `${count} problems`);
    this.button.toggleAttribute("data-some", count > 0);
    // What is closed nobody sees: a drag changes the text many times a second.
    this.list.replaceChildren(...(this.list.hidden ? [] : found.map(it => this.item(...it))));
    const first = this.list.hidden ? found.slice(0, 1) : [];
    this.first.hidden = first.length === 0;
    this.first.replaceChildren(...first.map(it => this.item(...it)));
    // What a message helps with is in the list.
    const button = this.first.querySelector(".place");
    if (button !== null) setText(button, button.textContent?.split("\n")[0] ?? "");
  }

  /** A message, which leads to its place, with its fixes. */
  private item(diagnostic: Diagnostic, from: number, to: number): HTMLLIElement {
    const view = this.view();
    const item = create("li", diagnostic.severity);
    const jump = () => {
      view.dispatch({ selection: { anchor: from }, scrollIntoView: true });
      view.focus();
    };
    item.append(createButton(`${view.state.doc.lineAt(from).number}: ${diagnostic.message}`,
      "place", jump));
    for (const { name, apply } of diagnostic.actions ?? []) {
      item.append(createButton(name, "fix", () => apply(view, from, to)));
    }
    return item;
  }
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
