// Substitute for the parts of VS Code that the extension and its client library use. It records
// what the extension registers and shows, for the tests.

import { createRequire } from "node:module";
import { fileURLToPath, pathToFileURL } from "node:url";

const disposable = () => ({ dispose() {} });

export class Uri {
  constructor(href) {
    this.href = href;
    const { protocol, host, pathname } = new URL(href);
    Object.assign(this, { scheme: protocol.slice(0, -1), authority: host, path: decodeURIComponent(pathname), fsPath: decodeURIComponent(pathname) });
  }
  static file(file) { return new Uri(pathToFileURL(file).href); }
  static parse(href) { return new Uri(href); }
  toString() { return this.href; }
}

class Position {
  constructor(line, character) { Object.assign(this, { line, character }); }
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
 * A namespace with these members; all others are functions that return something to dispose of.
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

/** An enumeration or class that only has to exist. */
const anything = () => new Proxy(class {}, { get: (target, name) => (typeof name === "symbol" || name in target ? target[name] : 0) });

/**
 * Makes an editor with these documents. `setting` is the value of `pinhole.path`; `answers` are the
 * user's choices in messages, and `file` the choice in a dialog.
 */
export function editor({ documents = [], setting = "", answers = [], file } = {}) {
  const seen = { messages: [], executed: [], terminals: [], updates: [], languages: [], providers: {}, diagnostics: new Map(), commands: new Map() };
  const show = kind => async (message, ...choices) => {
    seen.messages.push({ kind, message, choices });
    return choices.find(choice => answers.includes(choice));
  };
  const members = {
    Uri, Position, Range, Diagnostic, TabInputText, CodeActionKind,
    version: "1.91.0",
    env: { appName: "test", language: "en", machineId: "test" },
    ViewColumn: { Beside: -2 },
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
      registerCommand(name, run) { seen.commands.set(name, run); return disposable(); },
      async executeCommand(...call) { seen.executed.push(call); },
    }),
    window: partly({
      activeTextEditor: documents[0] && { document: documents[0] },
      tabGroups: { all: [{ tabs: documents.map(({ uri }) => ({ input: new TabInputText(uri) })) }], onDidChangeTabs: disposable, onDidChangeTabGroups: disposable },
      visibleTextEditors: [], visibleNotebookEditors: [], terminals: seen.terminals,
      showErrorMessage: show("error"), showInformationMessage: show("information"), showWarningMessage: show("warning"),
      showOpenDialog: async () => file && [Uri.file(file)],
      withProgress: (_, run) => run({ report() {} }, { isCancellationRequested: false, onCancellationRequested: disposable }),
      createTerminal(options) { const terminal = { ...options, show() {}, dispose() {} }; seen.terminals.push(terminal); return terminal; },
      createOutputChannel: () => partly({ onDidChangeLogLevel: disposable, logLevel: 0 }),
    }),
    workspace: partly({
      textDocuments: documents, notebookDocuments: [], workspaceFolders: undefined,
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

/** Loads the built extension into this editor. */
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
