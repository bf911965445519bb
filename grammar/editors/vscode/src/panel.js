// The picture beside the text: a panel with the page of Pinhole Studio. The page opens a copy of
// the scene's text at the language server, so that each of its requests is about the text that it
// knows. This module carries its messages, and keeps the copy and the editor's text the same.
// docs/protocol.md describes the messages.

const { randomBytes } = require("node:crypto");
const fs = require("node:fs");
const path = require("node:path");
const vscode = require("vscode");
const { State } = require("vscode-languageclient/node");
const { changed, differences, normal } = require("./copy");

/** Kind of the panel, by which the editor restores it, and the key of the scene that it shows. */
const KIND = "pinhole.picture";

/** The page's address of its copy; its other texts are those with which drags begin. */
const COPY = "studio:///scene.scn";
const OWN = /^(?:studio:\/\/\/scene\.scn|drag:\d+)$/;

/** What the page may ask the server; nothing else is carried. */
const REQUESTS = ["frame", "pick", "objects", "overlays", "drag", "add", "samples", "glass"].map(name => `pinhole/${name}`);
const NOTIFICATIONS = ["didOpen", "didChange", "didClose"].map(name => `textDocument/${name}`);

const METHOD_NOT_FOUND = -32601;
const INTERNAL_ERROR = -32603;

const isScene = document => document?.languageId === "pinhole" && ["file", "untitled"].includes(document.uri.scheme);

/** Whether an address of the editor is that of a text of the panel's page. */
const isOfPage = ({ scheme }) => ["studio", "drag"].includes(scheme);

const isPosition = it => [it?.line, it?.character].every(number => Number.isInteger(number) && number >= 0);

/** Opens panels, one at a time, and has them follow the scene in the active editor. */
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
      // A document is opened anew when its language is chosen, so that it may become a scene.
      workspace.onDidOpenTextDocument(() => this.followActive()),
      window.onDidChangeTextEditorSelection(event => this.panel?.moved(event)),
      workspace.onDidChangeTextDocument(({ document }) => this.panel?.edited(document)),
    );
  }

  /** Uses this client from now on. It may not have started yet, and may start again. */
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

  /** Fills a panel that was open before the window was loaded anew. */
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
  /** The conversation with the page; undefined between a page's or a server's end and the next. */
  conversation;
  /** The page's texts that are open at the server. */
  open = new Set();
  /** The page's copy of the text. */
  copy = "";
  /** Number of texts that were sent to the page, and that it has not taken over yet. Until then,
   * its changes are of an older text, and are dropped. */
  sent = 0;
  /** The text that was last written into the editor; undefined after other changes there. */
  written;
  /** The drag that is under way in the page; `hasWritten` says whether it has changed the editor's
   * text. */
  drag;
  /** Messages from the page are handled one by one, and so are changes of the editor. */
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

  /** The scene's document if it is open, and else undefined. */
  get document() { return vscode.workspace.textDocuments.find(it => it.uri.toString() === this.uri); }

  /** The scene's editor if it is visible, and else undefined. */
  get editor() { return vscode.window.visibleTextEditors.find(it => it.document.uri.toString() === this.uri); }

  /** Shows another scene. The page is loaded anew, so that nothing in it is of the scene before. */
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

  /** Begins a conversation if page and server are ready. */
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

  /** Ends the conversation, and the texts of the page at the server. */
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

  /** Carries a message of the page to the server if it is one of those that the page may send. */
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

  /** Keeps account of the page's texts. While the page has the text of a drag open, its changes of
   * the copy are one step for Undo. */
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

  /** Writes the page's copy, as it is now, into the editor. `isLast` ends a step for Undo. */
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

  /** Sends the editor's text to the page, which takes it over. */
  tell(document) {
    this.sent++;
    this.post("panel/text", { text: normal(document.getText()) });
  }

  /** Handles a movement of the cursor by the user. */
  moved({ textEditor, selections, kind }) {
    if (textEditor.document.uri.toString() !== this.uri || kind === undefined || this.conversation === undefined) return;
    this.post("panel/cursor", { position: selections[0].active });
  }

  /** Makes the editor's text the given one. */
  async write({ copy, drag, isLast }) {
    const document = await this.reopened();
    if (document === undefined || this.sent > 0) return;
    const { editor } = this;
    // Only an editor can join changes to one step for Undo. If there is none, the whole drag is
    // written when it ends.
    if (editor === undefined && !isLast) return;
    const before = normal(document.getText());
    const edits = differences(before, copy);
    // A step is ended by an edit, even if the text is complete by then.
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

  /** Runs a command of the editor, which acts on the editor that has the focus. Keys that are typed
   * for the picture meanwhile are not written into the text. */
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

/** Ignores what is typed until the result is disposed of. Returns undefined if another extension
 * handles typed keys. */
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
 * Returns the page for a panel. Its policy allows the page's own files and nothing from elsewhere.
 * The keys of commands that VS Code has itself are left to it.
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
