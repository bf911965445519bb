// The picture beside the text: a panel with the page of Pinhole Studio. The page opens its own copy
// of the scene's text at the language server, so that its requests are about the text that it
// knows. This module passes messages between page and server, and keeps the copy equal to the
// editor's text. docs/protocol.md describes the messages.

const { randomBytes } = require("node:crypto");
const fs = require("node:fs");
const path = require("node:path");
const vscode = require("vscode");
const { State } = require("vscode-languageclient/node");
const { changed, differences, normal } = require("./copy");

/** Type of the panel, by which the editor restores it. Also the key under which the address of the
 * shown scene is stored. */
const KIND = "pinhole.picture";

/** Address of the page's copy at the server. The page's other texts, `drag:…`, are the texts before
 * drags. */
const COPY = "studio:///scene.scn";
const OWN = /^(?:studio:\/\/\/scene\.scn|drag:\d+)$/;

/** Requests and notifications of the page that are passed on to the server. No others are. */
const REQUESTS = ["frame", "pick", "objects", "overlays", "drag", "add", "samples", "glass"].map(name => `pinhole/${name}`);
const NOTIFICATIONS = ["didOpen", "didChange", "didClose"].map(name => `textDocument/${name}`);

const METHOD_NOT_FOUND = -32601;
const INTERNAL_ERROR = -32603;

const isScene = document => document?.languageId === "pinhole" && ["file", "untitled"].includes(document.uri.scheme);

/** Returns whether a URI belongs to a text of the panel's page, not to a file. */
const isOfPage = ({ scheme }) => ["studio", "drag"].includes(scheme);

const isPosition = it => [it?.line, it?.character].every(number => Number.isInteger(number) && number >= 0);

/** Opens the panel with the picture. At most one panel is open; it shows the scene in the active
 * editor. */
class Pictures {
  panel;
  client;

  constructor(context) {
    this.context = context;
    const { commands, window, workspace } = vscode;
    context.subscriptions.push(
      commands.registerCommand("pinhole.picture", () => this.show()),
      ...["undo", "redo"].map(name => commands.registerCommand(`pinhole.picture.${name}`, () => this.panel?.inEditor(name))),
      commands.registerCommand("pinhole.picture.save", () => this.panel?.save()),
      window.registerWebviewPanelSerializer(KIND, { deserializeWebviewPanel: panel => this.restore(panel) }),
      window.onDidChangeActiveTextEditor(() => this.followActive()),
      // When the user chooses the language of a document, the editor opens it again. It may then be
      // a scene.
      workspace.onDidOpenTextDocument(() => this.followActive()),
      window.onDidChangeTextEditorSelection(event => this.panel?.moved(event)),
      workspace.onDidChangeTextDocument(({ document }) => this.panel?.edited(document)),
    );
  }

  /** Uses this client of the language server from now on. The server may start later, and may be
   * started again after a crash. */
  serve(client) {
    this.client = client;
    client.onDidChangeState(({ newState }) => {
      if (client !== this.client) return;
      if (newState === State.Running) this.panel?.begin();
      else this.panel?.lose();
    });
  }

  followActive() {
    const editor = vscode.window.activeTextEditor;
    if (isScene(editor?.document)) this.panel?.follow(editor.document, editor.viewColumn);
  }

  show() {
    const editor = vscode.window.activeTextEditor;
    if (!isScene(editor?.document)) {
      vscode.window.showInformationMessage("Open a scene to show its picture. If another extension has its ending, run “Pinhole: Use Pinhole for This File” first.");
      return;
    }
    const where = { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true };
    if (this.panel === undefined) this.adopt(vscode.window.createWebviewPanel(KIND, "Picture", where));
    else this.panel.webviewPanel.reveal(undefined, true);
    this.panel.follow(editor.document, editor.viewColumn);
  }

  /** Restores the content of a panel that was open before the window was reloaded. */
  async restore(webviewPanel) {
    const { activeTextEditor, visibleTextEditors } = vscode.window;
    const editor = [activeTextEditor, ...visibleTextEditors].find(it => isScene(it?.document));
    const known = this.context.workspaceState.get(KIND);
    const document = editor?.document
      ?? (known && await vscode.workspace.openTextDocument(vscode.Uri.parse(known)).then(it => it, () => undefined));
    if (document === undefined || this.panel !== undefined) return webviewPanel.dispose();
    this.adopt(webviewPanel);
    this.panel.follow(document, editor?.viewColumn);
  }

  adopt(webviewPanel) {
    const panel = new Panel(webviewPanel, this);
    this.panel = panel;
    webviewPanel.onDidDispose(() => {
      panel.forget();
      this.panel = undefined;
    });
  }
}

class Panel {
  /** Address of the scene that is shown. The editor may close its document and open it anew. */
  uri;
  /** Column of the scene's editor. */
  column = vscode.ViewColumn.One;
  /** Whether the page waits for the first message of a conversation. */
  isReady = false;
  /** The conversation (exchange of messages) with the loaded page and the running server; undefined
   * if there is none. Its identity shows whether a late answer still belongs to it. */
  conversation;
  /** The page's texts that are open at the server. */
  open = new Set();
  /** The page's copy of the text. */
  copy = "";
  /** Number of texts that were sent to the page and not confirmed by `panel/followed` yet. Until
   * then, the page's changes are changes of an older text, and are dropped. */
  sent = 0;
  /** Text that the panel has last written into the editor; undefined if something else has changed
   * the editor's text since. */
  written;
  /** The drag that is under way in the page; `hasWritten` says whether it has changed the editor's
   * text. */
  drag;
  /** Promises that settle when all earlier messages of the page (`messages`) and all earlier
   * changes of the editor (`work`) are done. The next message or change waits for them. */
  messages = Promise.resolve();
  work = Promise.resolve();

  constructor(webviewPanel, pictures) {
    this.webviewPanel = webviewPanel;
    this.pictures = pictures;
    this.folder = vscode.Uri.joinPath(pictures.context.extensionUri, "dist", "page");
    const { webview } = webviewPanel;
    webviewPanel.iconPath = vscode.Uri.joinPath(pictures.context.extensionUri, "icon.png");
    webview.options = { enableScripts: true, localResourceRoots: [this.folder] };
    webview.onDidReceiveMessage(message => this.receive(message));
  }

  get client() { return this.pictures.client; }

  get isServed() { return this.client?.state === State.Running; }

  /** The scene's document; undefined if it is not open. */
  get document() { return vscode.workspace.textDocuments.find(it => it.uri.toString() === this.uri); }

  /** The scene's editor; undefined if it is not visible. */
  get editor() { return vscode.window.visibleTextEditors.find(it => it.document.uri.toString() === this.uri); }

  /** Shows another scene. Reloads the page, so that nothing of the previous scene stays in it. */
  follow(document, column) {
    this.column = column ?? this.column;
    const uri = document.uri.toString();
    if (uri === this.uri) return;
    this.uri = uri;
    this.pictures.context.workspaceState.update(KIND, uri);
    this.webviewPanel.title = `Picture of ${path.posix.basename(document.uri.path)}`;
    this.forget();
    this.webviewPanel.webview.html = html(this.webviewPanel.webview, this.folder);
  }

  /** Begins a conversation if the page and the server are ready. */
  begin() {
    const { document } = this;
    if (!this.isReady || !this.isServed || document === undefined) return;
    this.isReady = false;
    this.conversation = {};
    this.sent = 0;
    this.tell(document);
    const cursor = this.editor?.selection?.active;
    if (cursor !== undefined) this.post("panel/cursor", { position: cursor });
  }

  /** Ends the conversation, and closes the page's texts at the server. */
  forget() {
    this.conversation = undefined;
    this.isReady = false;
    for (const uri of this.open) if (this.isServed) this.client.sendNotification("textDocument/didClose", { textDocument: { uri } }).catch(() => {});
    this.open.clear();
    this.drag = undefined;
  }

  /** Tells the page that the server has ended. The page then waits for another one. */
  lose() {
    if (this.conversation === undefined) return;
    this.forget();
    this.webviewPanel.webview.postMessage("ended");
  }

  post(method, params) { this.send({ jsonrpc: "2.0", method, params }); }

  send(message) { this.webviewPanel.webview.postMessage(JSON.stringify(message)); }

  receive(message) {
    if (message === "waiting") {
      this.forget();
      this.isReady = true;
      return this.reopened().then(() => this.begin());
    }
    const { conversation } = this;
    const isCurrent = () => conversation !== undefined && conversation === this.conversation;
    this.messages = this.messages.then(() => isCurrent() && this.handle(JSON.parse(message), isCurrent)).catch(() => {});
  }

  /** Opens the scene's document if it is closed. A scene that has no file any more stays closed. */
  async reopened() {
    return this.document ?? await vscode.workspace.openTextDocument(vscode.Uri.parse(this.uri)).then(it => it, () => undefined);
  }

  /** Handles a message from the page. Passes it on to the server only if it is in `REQUESTS` or
   * `NOTIFICATIONS` and about a text of the page. */
  async handle({ id, method, params }, isCurrent) {
    if (method === "panel/followed") this.sent = Math.max(0, this.sent - 1);
    else if (method === "panel/cursor" && isPosition(params?.position)) this.queue(() => this.select(params.position));
    else if (method === "initialize") this.send({ jsonrpc: "2.0", id, result: this.client.initializeResult });
    else if (method === "studio/alive") this.send({ jsonrpc: "2.0", id, result: null });
    else {
      const isOwn = OWN.test(params?.textDocument?.uri);
      if (id === undefined && isOwn && NOTIFICATIONS.includes(method)) {
        await this.client.sendNotification(method, params);
        this.note(method, params);
      } else if (id !== undefined && isOwn && REQUESTS.includes(method)) this.ask(id, method, params, isCurrent);
      else if (id !== undefined) this.send({ jsonrpc: "2.0", id, error: { code: METHOD_NOT_FOUND, message: `the panel does not ask ${method}` } });
    }
  }

  async ask(id, method, params, isCurrent) {
    const answer = await this.client.sendRequest(method, params)
      .then(result => ({ result }), ({ code, message }) => ({ error: { code: code ?? INTERNAL_ERROR, message } }));
    if (isCurrent()) this.send({ jsonrpc: "2.0", id, ...answer });
  }

  /** Follows which texts the page opens, changes and closes. While a text `drag:…` is open, a drag
   * is under way, and all changes of the copy are one step for Undo. */
  note(method, { textDocument: { uri, text }, contentChanges }) {
    const isClosed = method === "textDocument/didClose";
    if (isClosed) this.open.delete(uri);
    else this.open.add(uri);
    const { drag } = this;
    if (uri !== COPY) {
      this.drag = isClosed ? undefined : { hasWritten: false };
      if (isClosed) this.change({ drag, isLast: true });
    } else if (contentChanges === undefined) this.copy = text ?? "";
    else {
      this.copy = changed(this.copy, contentChanges);
      this.change({ drag, isLast: drag === undefined });
    }
  }

  /** Writes the page's present copy into the editor. `isLast` ends a step for Undo. */
  change({ drag = { hasWritten: false }, isLast }) {
    const { copy } = this;
    if (this.sent === 0) this.queue(() => this.write({ copy, drag, isLast }));
  }

  queue(act) { this.work = this.work.then(act).catch(error => void vscode.window.showErrorMessage(`Pinhole: ${error.message ?? error}`)); }

  /** Handles a change of the editor's text. */
  edited(document) {
    if (document.uri.toString() !== this.uri || this.conversation === undefined) return;
    const text = normal(document.getText());
    if (text === this.written || (this.sent === 0 && text === this.copy)) return;
    this.written = undefined;
    this.tell(document);
  }

  /** Sends the editor's text to the page, where it replaces the copy. */
  tell(document) {
    this.sent++;
    this.post("panel/text", { text: normal(document.getText()) });
  }

  /** Handles a movement of the cursor by the user. */
  moved({ textEditor, selections, kind }) {
    if (textEditor.document.uri.toString() !== this.uri || kind === undefined || this.conversation === undefined) return;
    this.post("panel/cursor", { position: selections[0].active });
  }

  /** Changes the editor's text to `copy`. */
  async write({ copy, drag, isLast }) {
    const document = await this.reopened();
    if (document === undefined || this.sent > 0) return;
    const { editor } = this;
    // Only a visible editor can join changes to one step for Undo. Without it, the result of a drag
    // is written when the drag ends.
    if (editor === undefined && !isLast) return;
    const before = normal(document.getText());
    const edits = differences(before, copy);
    // Only an edit can end a step for Undo. If nothing is left to change, an empty edit is made.
    if (edits.length === 0 && drag.hasWritten && isLast) edits.push({ line: 0, from: 0, lastLine: 0, to: 0, text: "" });
    if (edits.length === 0) return;
    const undo = { undoStopBefore: !drag.hasWritten, undoStopAfter: isLast };
    drag.hasWritten = true;
    this.written = copy;
    const placed = edits.map(({ line, from, lastLine, to, text }) => ({ range: new vscode.Range(line, from, lastLine, to), text }));
    const isDone = editor === undefined ? await apply(document, placed) : await editor.edit(it => placed.forEach(({ range, text }) => it.replace(range, text)), undo);
    if (!isDone) this.tell(document);
    else if (before !== copy) editor?.revealRange(placed[0].range, vscode.TextEditorRevealType.InCenterIfOutsideViewport);
  }

  /** Selects the word at a position of the text, which is an object's name or kind. */
  async select({ line, character }) {
    const document = await this.reopened();
    if (document === undefined) return;
    const at = new vscode.Position(line, character);
    const { start, end } = document.getWordRangeAtPosition(at) ?? { start: at, end: at };
    const editor = this.editor ?? await vscode.window.showTextDocument(document, { viewColumn: this.column, preserveFocus: true });
    editor.selection = new vscode.Selection(start, end);
    editor.revealRange(new vscode.Range(start, end), vscode.TextEditorRevealType.InCenterIfOutsideViewport);
  }

  /** Runs a command that acts on the focused editor, so the scene's editor gets the focus for this
   * time. Keys that the user types meanwhile are meant for the picture, and are ignored. */
  async inEditor(command) {
    const ignored = ignoreKeys();
    try {
      const document = await this.reopened();
      if (document === undefined) return;
      await vscode.window.showTextDocument(document, { viewColumn: this.editor?.viewColumn ?? this.column, preserveFocus: false });
      await vscode.commands.executeCommand(command);
      this.webviewPanel.reveal(undefined, false);
    } finally {
      ignored?.dispose();
    }
  }

  async save() { await this.document?.save(); }
}

/** Ignores typed keys until the returned object is disposed of. Returns undefined if another
 * extension handles typed keys. */
function ignoreKeys() {
  try {
    return vscode.commands.registerCommand("type", () => {});
  } catch {
    return undefined;
  }
}

async function apply(document, edits) {
  const edit = new vscode.WorkspaceEdit();
  edit.set(document.uri, edits.map(({ range, text }) => vscode.TextEdit.replace(range, text)));
  return vscode.workspace.applyEdit(edit);
}

/**
 * Returns the page's HTML for a panel. The content security policy allows only the page's own
 * files. The keys in the page's header are removed, because VS Code has commands of its own for
 * them.
 */
function html(webview, folder) {
  const nonce = randomBytes(16).toString("base64");
  const at = file => webview.asWebviewUri(vscode.Uri.joinPath(folder, file)).toString();
  const policy = [
    "default-src 'none'",
    `script-src 'nonce-${nonce}'`,
    `style-src ${webview.cspSource} 'nonce-${nonce}'`,
    "img-src blob: data:",
    "base-uri 'none'",
    "form-action 'none'",
  ].join("; ");
  return fs.readFileSync(path.join(folder.fsPath, "index.html"), "utf8")
    .replace('<meta charset="utf-8">', `$&\n    <meta http-equiv="Content-Security-Policy" content="${policy}">`)
    .replace("__NONCE__", nonce)
    .replace(' href="studio.css">', ` href="${at("studio.css")}">\n    <link rel="stylesheet" href="${at("panel.css")}">`)
    .replace(' src="studio.js">', ` nonce="${nonce}" src="${at("studio.js")}">`)
    .replace("Connecting…</li>", "Waiting for the language server…</li>")
    .replace(/<header>.*?<\/header>/s, header => header.replace(/ data-key="[^"]*"/g, ""));
}

module.exports = { Pictures, isOfPage };
