// Substitute for the parts of VS Code that the extension and its client library use. It records
// what the extension registers and shows, for the tests.

import { createRequire } from "node:module";
import { fileURLToPath, pathToFileURL } from "node:url";
import { Document, TextEditor } from "./documents.mjs";

const disposable = () => ({ dispose() {} });

export class Uri {
  constructor(href) {
    this.href = href;
    const { protocol, host, pathname } = new URL(href);
    Object.assign(this, { scheme: protocol.slice(0, -1), authority: host, path: decodeURIComponent(pathname), fsPath: decodeURIComponent(pathname) });
  }
  static file(file) { return new Uri(pathToFileURL(file).href); }
  static parse(href) { return new Uri(href); }
  static joinPath(uri, ...parts) { return new Uri(`${uri.href.replace(/\/$/, "")}/${parts.join("/")}`); }
  toString() { return this.href; }
}

class Position {
  constructor(line, character) { Object.assign(this, { line, character }); }
}

class Selection {
  constructor(anchor, active) { Object.assign(this, { anchor, active, start: anchor, end: active }); }
}

class WorkspaceEdit {
  edits = [];
  set(uri, edits) { this.edits.push({ uri, edits }); }
}

class Range {
  constructor(start, startCharacter, endLine, endCharacter) {
    const isPair = typeof start !== "number";
    this.start = isPair ? start : new Position(start, startCharacter);
    this.end = isPair ? startCharacter : new Position(endLine, endCharacter);
  }
}

class Diagnostic {
  constructor(range, message, severity) { Object.assign(this, { range, message, severity }); }
}

/**
 * Returns a namespace with these members. Every other member is a function that returns a
 * disposable object.
 */
const partly = members => new Proxy(members, { get: (target, name) => (name in target ? target[name] : disposable) });

class CodeActionKind {
  constructor(value) { this.value = value; }
  append(part) { return new CodeActionKind(this.value === "" ? part : `${this.value}.${part}`); }
}
for (const [name, value] of [["Empty", ""], ["QuickFix", "quickfix"], ["Refactor", "refactor"], ["Source", "source"]]) {
  CodeActionKind[name] = new CodeActionKind(value);
}

class TabInputText {
  constructor(uri) { this.uri = uri; }
}

/** Returns a substitute for an enumeration or class whose members the tests do not use. */
const anything = () => new Proxy(class {}, { get: (target, name) => (typeof name === "symbol" || name in target ? target[name] : 0) });

/** Origin of the files that a page may load. */
export const RESOURCES = "https://resources.test";

/**
 * A panel for a page. Tests use `page`: `told` has the messages to the page, `say` sends a message
 * of the page, and `load` is called when the page is replaced.
 */
class WebviewPanel {
  page = { told: [], html: [], hear: message => this.page.told.push(message), say: message => this.receive(message), load() {} };
  isOpen = true;
  revealed = 0;

  constructor(kind, title, where) {
    const { page } = this;
    Object.assign(this, { kind, title, where });
    const panel = this;
    this.webview = {
      cspSource: RESOURCES,
      options: {},
      get html() { return page.html.at(-1); },
      set html(text) {
        page.html.push(text);
        page.load();
      },
      asWebviewUri: uri => ({ toString: () => `${RESOURCES}${uri.path}` }),
      onDidReceiveMessage(receive) { panel.receive = receive; return disposable(); },
      async postMessage(message) {
        if (!panel.isOpen) throw new Error("Webview is disposed");
        page.hear(message);
      },
    };
  }
  reveal() { this.revealed++; }
  onDidDispose(ended) { this.ended = ended; return disposable(); }
  dispose() { this.isOpen = false; this.ended?.(); }
}

/**
 * Makes a substitute for VS Code with these documents, the first of which is shown. `setting` is
 * the value of `pinhole.path`. `answers` are the buttons that the user chooses in messages, and
 * `file` is the file that the user chooses in a dialog.
 */
export function editor({ documents = [], setting = "", answers = [], file } = {}) {
  const listeners = {};
  const event = name => (listener, self) => {
    const all = listeners[name] ??= new Set();
    const bound = listener.bind(self);
    all.add(bound);
    return { dispose: () => all.delete(bound) };
  };
  // If a listener's promise is rejected, VS Code only logs the error, so it is ignored here.
  const fire = (name, value) => listeners[name]?.forEach(listener => Promise.resolve(listener(value)).catch(() => {}));
  const seen = { panels: [], serializers: {}, fire, messages: [], executed: [], terminals: [], updates: [], languages: [], providers: {}, diagnostics: new Map(), commands: new Map() };
  const whole = documents.filter(it => it instanceof Document);
  for (const it of whole) it.tell = change => fire("change", change);
  const shown = whole.slice(0, 1).map(it => new TextEditor(it, 1));
  const show = kind => async (message, ...choices) => {
    seen.messages.push({ kind, message, choices });
    return choices.find(choice => answers.includes(choice));
  };
  const members = {
    Uri, Position, Range, Selection, WorkspaceEdit, Diagnostic, TabInputText, CodeActionKind,
    version: "1.91.0",
    env: { appName: "test", language: "en", machineId: "test" },
    ViewColumn: { Beside: -2, One: 1 },
    TextEdit: { replace: (range, newText) => ({ range, newText }) },
    TextEditorRevealType: { InCenterIfOutsideViewport: 2 },
    ConfigurationTarget: { Global: 1 },
    ProgressLocation: { Notification: 15, Window: 10 },
    Disposable: class { constructor(end) { this.dispose = end; } static from() { return disposable(); } },
    EventEmitter: class {
      listeners = [];
      event = listener => { this.listeners.push(listener); return disposable(); };
      fire(event) { this.listeners.forEach(listener => listener(event)); }
      dispose() {}
    },
    CancellationTokenSource: class { token = { isCancellationRequested: false, onCancellationRequested: disposable }; cancel() {} dispose() {} },
    CancellationError: Error,
    commands: partly({
      registerCommand(name, run) { seen.commands.set(name, run); return { dispose: () => seen.commands.delete(name) }; },
      async executeCommand(...call) {
        seen.executed.push(call);
        if (call[0] === "undo") vscode.window.activeTextEditor?.document.undo();
      },
    }),
    window: partly({
      activeTextEditor: shown[0] ?? (documents[0] && { document: documents[0] }),
      tabGroups: { all: [{ tabs: documents.map(({ uri }) => ({ input: new TabInputText(uri) })) }], onDidChangeTabs: disposable, onDidChangeTabGroups: disposable },
      visibleTextEditors: shown, visibleNotebookEditors: [], terminals: seen.terminals,
      onDidChangeActiveTextEditor: event("active"), onDidChangeTextEditorSelection: event("selection"),
      async showTextDocument(document, { viewColumn, preserveFocus }) {
        const { window } = vscode;
        let shown = window.visibleTextEditors.find(it => it.document === document);
        if (shown === undefined) {
          shown = new TextEditor(document, viewColumn);
          window.visibleTextEditors = [...window.visibleTextEditors.filter(it => it.viewColumn !== viewColumn), shown];
        }
        if (preserveFocus || window.activeTextEditor === shown) return shown;
        window.activeTextEditor = shown;
        fire("active", shown);
        return shown;
      },
      createWebviewPanel(...how) { const panel = new WebviewPanel(...how); seen.panels.push(panel); return panel; },
      registerWebviewPanelSerializer(kind, serializer) { seen.serializers[kind] = serializer; return disposable(); },
      showErrorMessage: show("error"), showInformationMessage: show("information"), showWarningMessage: show("warning"),
      showOpenDialog: async () => file && [Uri.file(file)],
      withProgress: (_, run) => run({ report() {} }, { isCancellationRequested: false, onCancellationRequested: disposable }),
      createTerminal(options) { const terminal = { ...options, show() {}, dispose() {} }; seen.terminals.push(terminal); return terminal; },
      createOutputChannel: () => partly({ onDidChangeLogLevel: disposable, logLevel: 0 }),
    }),
    workspace: partly({
      textDocuments: documents, onDidChangeTextDocument: event("change"), onDidOpenTextDocument: event("open"),
      async openTextDocument(uri) {
        const found = documents.find(it => it.uri.toString() === uri.toString());
        if (found === undefined) throw new Error(`${uri} cannot be opened`);
        return found;
      },
      async applyEdit({ edits }) {
        for (const { uri, edits: those } of edits) {
          documents.find(it => it.uri.toString() === uri.toString()).apply(those.map(({ range, newText }) => ({ range, text: newText })));
        }
        return true;
      },
      notebookDocuments: [], workspaceFolders: undefined,
      getConfiguration: () => ({
        get: (name, preset) => (name === "path" ? setting : preset),
        inspect: name => (name === "associations" ? { globalValue: { "*.old": "text" } } : undefined),
        async update(...change) { seen.updates.push(change); },
      }),
      fs: { async stat() {} },
    }),
    languages: new Proxy({}, {
      get: (_, name) => name === "setTextDocumentLanguage"
        ? async (...change) => { seen.languages.push(change); }
        : name === "match"
        ? ((selector, document) => [selector].flat().some(({ language }) => language === document.languageId) ? 10 : 0)
        : name === "createDiagnosticCollection"
        ? () => partly({ set: (uri, list) => { seen.diagnostics.set(uri.toString(), list); seen.onDiagnostics?.(); } })
        : (...call) => { (seen.providers[name] ??= []).push(call); return disposable(); },
    }),
  };
  const vscode = new Proxy(members, { get: (target, name) => (target[name] ??= anything()) });
  return { vscode, seen };
}

/** Loads the built extension. It gets `vscode` as its module `vscode`. */
export function load(vscode) {
  const require = createRequire(import.meta.url);
  const Module = require("node:module");
  const whole = Module._load;
  const bundle = fileURLToPath(new URL("../dist/extension.js", import.meta.url));
  delete require.cache[bundle];
  Module._load = (name, ...rest) => (name === "vscode" ? vscode : whole(name, ...rest));
  try {
    return require(bundle);
  } finally {
    Module._load = whole;
  }
}

/** Calls `is` until it returns a true value, and returns this value. */
export async function until(is) {
  for (let tries = 0; tries < 1200; tries++) {
    const found = await is();
    if (found) return found;
    await new Promise(resolve => setTimeout(resolve, 10));
  }
  throw new Error(`waited in vain for ${is}`);
}
