// The page of the screenshots: Monaco, the editor of VS Code, which gets all answers from Pinhole's
// language server.
//
// `window.ask` sends a request to the server, and `window.tell` a notification. `window.told` gets
// the server's notifications. This file converts the JSON of these messages to Monaco's types.

import * as monaco from "monaco-editor";
import { colors, types } from "./theme.js";

const LANGUAGE = "pinhole";
const URI = "file:///scene.scn";
const document = { uri: URI };

const position = ({ lineNumber, column }) => ({ line: lineNumber - 1, character: column - 1 });
const fromPosition = ({ line, character }) => ({ lineNumber: line + 1, column: character + 1 });
const range = r => ({
  start: { line: r.startLineNumber - 1, character: r.startColumn - 1 },
  end: { line: r.endLineNumber - 1, character: r.endColumn - 1 },
});
const fromRange = ({ start, end }) => ({
  startLineNumber: start.line + 1, startColumn: start.character + 1,
  endLineNumber: end.line + 1, endColumn: end.character + 1,
});
const markdown = content => (typeof content === "string" ? { value: content } : { value: content.value });
const severities = [undefined, monaco.MarkerSeverity.Error, monaco.MarkerSeverity.Warning, monaco.MarkerSeverity.Info, monaco.MarkerSeverity.Hint];
/** Kinds of completions, in the order of the protocol's numbers, which begin with 1. Monaco has
 * other numbers for them. */
const kinds = [
  "Text", "Method", "Function", "Constructor", "Field", "Variable", "Class", "Interface", "Module", "Property", "Unit", "Value",
  "Enum", "Keyword", "Snippet", "Color", "File", "Reference", "Folder", "EnumMember", "Constant", "Struct", "Event", "Operator",
  "TypeParameter",
];

/** The newest diagnostics from the server. */
let diagnostics = [];

function provide(capabilities, model) {
  const on = { language: LANGUAGE };
  monaco.languages.registerCompletionItemProvider(on, {
    triggerCharacters: capabilities.completionProvider?.triggerCharacters,
    async provideCompletionItems(_, at) {
      const answer = await ask("textDocument/completion", { textDocument: document, position: position(at) });
      const items = Array.isArray(answer) ? answer : (answer?.items ?? []);
      const word = model.getWordUntilPosition(at);
      const here = { startLineNumber: at.lineNumber, endLineNumber: at.lineNumber, startColumn: word.startColumn, endColumn: word.endColumn };
      return {
        suggestions: items.map(item => ({
          ...item,
          label: item.labelDetails ? { label: item.label, ...item.labelDetails } : item.label,
          kind: monaco.languages.CompletionItemKind[kinds[item.kind - 1]],
          documentation: item.documentation && markdown(item.documentation),
          insertText: item.textEdit?.newText ?? item.insertText ?? item.label,
          insertTextRules: item.insertTextFormat === 2 ? monaco.languages.CompletionItemInsertTextRule.InsertAsSnippet : undefined,
          range: item.textEdit ? fromRange(item.textEdit.range ?? item.textEdit.replace) : here,
        })),
      };
    },
  });
  monaco.languages.registerHoverProvider(on, {
    async provideHover(_, at) {
      const answer = await ask("textDocument/hover", { textDocument: document, position: position(at) });
      return answer && { contents: [answer.contents].flat().map(markdown), range: answer.range && fromRange(answer.range) };
    },
  });
  monaco.languages.registerCodeActionProvider(on, {
    async provideCodeActions(_, at) {
      const touched = diagnostics.filter(({ range: r }) => monaco.Range.areIntersectingOrTouching(fromRange(r), at));
      const answer = await ask("textDocument/codeAction", { textDocument: document, range: range(at), context: { diagnostics: touched } });
      return {
        actions: (answer ?? []).map(action => ({ title: action.title, kind: action.kind, isPreferred: action.isPreferred, diagnostics: [] })),
        dispose() {},
      };
    },
  });
  monaco.languages.registerColorProvider(on, {
    async provideDocumentColors() {
      const answer = await ask("textDocument/documentColor", { textDocument: document });
      return (answer ?? []).map(({ range, color }) => ({ range: fromRange(range), color }));
    },
    provideColorPresentations: () => [],
  });
  monaco.languages.registerInlayHintsProvider(on, {
    async provideInlayHints(_, within) {
      const answer = await ask("textDocument/inlayHint", { textDocument: document, range: range(within) });
      return { hints: (answer ?? []).map(hint => ({ ...hint, position: fromPosition(hint.position) })), dispose() {} };
    },
  });
  const { legend } = capabilities.semanticTokensProvider;
  monaco.languages.registerDocumentSemanticTokensProvider(on, {
    getLegend: () => legend,
    async provideDocumentSemanticTokens() {
      const answer = await ask("textDocument/semanticTokens/full", { textDocument: document });
      return { data: new Uint32Array(answer.data) };
    },
    releaseDocumentSemanticTokens() {},
  });
}

window.told = (method, { diagnostics: list }) => {
  if (method !== "textDocument/publishDiagnostics") return;
  diagnostics = list;
  monaco.editor.setModelMarkers(window.model, "pinhole", list.map(({ range, message, severity, code, source, codeDescription }) => ({
    ...fromRange(range),
    message,
    source,
    severity: severities[severity ?? 1],
    code: codeDescription ? { value: String(code), target: monaco.Uri.parse(codeDescription.href) } : code && String(code),
  })));
};

/** Opens the scene in an editor, for a server with these capabilities. */
window.open_scene = async (text, capabilities) => {
  monaco.languages.register({ id: LANGUAGE, extensions: [".scn"] });
  monaco.languages.setLanguageConfiguration(LANGUAGE, { wordPattern: /[A-Za-z_][A-Za-z0-9_]*|#[0-9A-Fa-f]+|[\d.][\w.]*/, brackets: [["{", "}"], ["(", ")"]] });
  monaco.editor.defineTheme("shot", {
    base: "vs-dark",
    inherit: true,
    rules: Object.entries(types).map(([token, foreground]) => ({ token, foreground })),
    colors,
  });
  const model = monaco.editor.createModel(text, LANGUAGE, monaco.Uri.parse(URI));
  window.model = model;
  provide(capabilities, model);
  await tell("textDocument/didOpen", { textDocument: { uri: URI, languageId: LANGUAGE, version: 1, text } });
  let version = 1;
  model.onDidChangeContent(() =>
    tell("textDocument/didChange", { textDocument: { uri: URI, version: ++version }, contentChanges: [{ text: model.getValue() }] }),
  );
  window.editor = monaco.editor.create(window.document.getElementById("editor"), {
    model,
    theme: "shot",
    fontFamily: "DejaVu Sans Mono",
    fontSize: 14,
    lineHeight: 22,
    fixedOverflowWidgets: true,
    minimap: { enabled: false },
    scrollBeyondLastLine: false,
    overviewRulerLanes: 0,
    scrollbar: { vertical: "hidden", horizontal: "hidden" },
    renderLineHighlight: "none",
    "semanticHighlighting.enabled": true,
    "bracketPairColorization.enabled": false,
    matchBrackets: "never",
    occurrencesHighlight: "off",
    cursorBlinking: "solid",
    wordBasedSuggestions: "off",
    lightbulb: { enabled: "on" },
    inlayHints: { fontSize: 12 },
    suggest: { showStatusBar: false, preview: false },
    padding: { top: 10 },
    lineNumbersMinChars: 3,
    folding: false,
    colorDecoratorsActivatedOn: "click",
  });
};
