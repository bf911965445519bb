// Tests the messages of the panel with the picture. The test itself acts as the panel's page. VS
// Code is replaced by a substitute, and the server is the real one. The tests of the panel with the
// real page are in studio/page/test/panel.test.mjs.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import path from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { Document } from "./documents.mjs";
import { program } from "./server.mjs";
import { editor, load, RESOURCES, until, Uri } from "./vscode.mjs";

const require = createRequire(import.meta.url);
const { changed, differences, normal } = require("../src/copy.js");
const { findBinary } = require("../src/binary.js");

const SCENE = "image { width 32 height 18 }\ncamera { eye (0, 1, 5)  lookat (0, 1, 0) }\nsphere Ball { center (0, 1, 0) }\n";
const COPY = "studio:///scene.scn";
const timeout = 20_000;
const home = fileURLToPath(new URL("..", import.meta.url));
const setting = program.includes("/") ? path.resolve(program) : findBinary("", undefined);

const memory = () => {
  const kept = new Map();
  return { get: key => kept.get(key), update: (key, value) => kept.set(key, value) };
};

/** Starts the extension in an editor with the scenes `texts`, the first of which is shown. */
async function started(t, texts = { a: SCENE }, workspaceState = memory(), server = setting) {
  const folder = mkdtempSync(path.join(tmpdir(), "pinhole-panel-"));
  const documents = Object.entries(texts).map(([name, text]) => new Document(Uri.file(path.join(folder, `${name}.scn`)), text));
  const { vscode, seen } = editor({ documents, setting: server });
  const extension = load(vscode);
  t.after(async () => {
    await extension.deactivate();
    rmSync(folder, { recursive: true });
  });
  await extension.activate({ subscriptions: [], extensionPath: home, extensionUri: Uri.file(home), workspaceState });
  return { vscode, seen, documents, extension, run: name => seen.commands.get(name)() };
}

/** Makes a server that records all bytes that it receives. Returns its path, and a function that
 * returns these bytes as a text. */
function recorded(t) {
  const folder = mkdtempSync(path.join(tmpdir(), "pinhole-server-"));
  t.after(() => rmSync(folder, { recursive: true }));
  const [server, sent] = ["server", "sent"].map(name => path.join(folder, name));
  writeFileSync(server, `#!/bin/sh\ntee '${sent}' | '${setting}' "$@"\n`, { mode: 0o755 });
  return [server, () => readFileSync(sent, "utf8")];
}

/** Sends and receives messages as the page of a panel does. */
class Page {
  ids = 0;
  version = 0;

  constructor(panel) { this.panel = panel; }

  get told() { return this.panel.page.told.map(it => (it === "ended" ? it : JSON.parse(it))); }

  say(message) { this.panel.page.say(JSON.stringify({ jsonrpc: "2.0", ...message })); }

  async ask(method, params) {
    const id = `page-${++this.ids}`;
    this.say({ id, method, params });
    return until(() => this.told.find(it => it?.id === id));
  }

  /** Begins a conversation, and opens the editor's text as the page's copy. */
  async begin() {
    this.panel.page.told.length = 0;
    this.panel.page.say("waiting");
    const { params: { text } } = await this.hears("panel/text");
    await this.ask("initialize", {});
    this.say({ method: "textDocument/didOpen", params: { textDocument: { uri: COPY, languageId: "pinhole", version: 0, text } } });
    this.say({ method: "panel/followed", params: {} });
    return text;
  }

  hears(method) { return until(() => this.told.findLast(it => it?.method === method)); }

  change(text) { this.say({ method: "textDocument/didChange", params: { textDocument: { uri: COPY, version: ++this.version }, contentChanges: [{ text }] } }); }

  frame() { return this.ask("pinhole/frame", { textDocument: { uri: COPY }, samples: 1 }); }
}

async function shown(t, texts, server) {
  const it = await started(t, texts, undefined, server);
  it.run("pinhole.picture");
  const [panel] = it.seen.panels;
  const page = new Page(panel);
  await page.begin();
  return { ...it, panel, page, document: it.documents[0] };
}

test("the panel opens beside, with a page that loads nothing from elsewhere", { timeout }, async t => {
  const { seen, run } = await started(t);
  run("pinhole.picture");
  run("pinhole.picture");
  const [{ kind, title, where, webview }, ...more] = seen.panels;
  assert.deepEqual([kind, title, where, more], ["pinhole.picture", "Picture of a.scn", { viewColumn: -2, preserveFocus: true }, []]);
  assert.equal(webview.options.enableScripts, true);
  assert.deepEqual(webview.options.localResourceRoots.map(it => it.fsPath), [path.join(home, "dist", "page")]);
  const { html } = webview;
  const policy = /http-equiv="Content-Security-Policy" content="([^"]+)"/.exec(html)[1];
  const nonce = /script-src 'nonce-([^']+)'/.exec(policy)[1];
  assert.ok(nonce.length >= 22);
  assert.match(policy, /^default-src 'none';/);
  assert.doesNotMatch(policy.replace(RESOURCES, ""), /unsafe|https?:|\*/);
  const scripts = html.match(/<script[^>]*>/g);
  assert.deepEqual(scripts, [`<script type="module" nonce="${nonce}" src="${RESOURCES}${path.join(home, "dist", "page", "studio.js")}">`]);
  assert.equal(html.match(/<link rel="stylesheet"/g).length, 2);
  assert.doesNotMatch(html, /__NONCE__|data-key="Control\+(s|z|y)|\son[a-z]+="/);
});

test("the page gets the unsaved text, and pictures of its copy", { timeout }, async t => {
  const { document, page, seen } = await shown(t);
  const { result } = await page.frame();
  assert.deepEqual(result.size, [32, 18]);
  document.type("width 32", "width 64");
  const { params: { text } } = await until(() => page.told.find(it => it.params?.text?.includes("width 64")));
  assert.equal(text, document.getText());
  page.change(text);
  page.say({ method: "panel/followed", params: {} });
  assert.deepEqual((await page.frame()).result.size, [64, 18]);
  // The editor shows the mistakes of its own text only, not those of the page's copy again.
  document.type("center", "centre");
  page.change(document.getText());
  await until(() => seen.diagnostics.get(document.uri.toString())?.length > 0);
  assert.equal((await page.frame()).result, null);
  assert.deepEqual([...seen.diagnostics.keys()], [document.uri.toString()]);
});

test("only what the page needs is carried to the server", { timeout }, async t => {
  const [server, sent] = recorded(t);
  const { document, page, panel } = await shown(t, undefined, server);
  const about = { textDocument: { uri: COPY } };
  for (const [method, params] of [
    ["textDocument/hover", { ...about, position: { line: 0, character: 0 } }], ["shutdown", {}], ["workspace/executeCommand", {}],
    ["studio/save", { text: "" }], ["pinhole/frame", { textDocument: { uri: document.uri.toString() } }], ["pinhole/frame", {}], ["pinhole/lesson", about],
  ]) {
    const { error, result } = await page.ask(method, params);
    assert.deepEqual([error?.code, result], [-32601, undefined], method);
  }
  // The page cannot change the editor's texts at the server, and malformed messages are ignored.
  page.say({ method: "textDocument/didChange", params: { textDocument: { uri: document.uri.toString(), version: 9 }, contentChanges: [{ text: "of the page" }] } });
  page.say({ method: "exit", params: {} });
  for (const odd of [undefined, null, 7, "{", "null", "[]", { method: "exit" }]) page.panel.page.say(odd);
  assert.ok((await page.frame()).result.png);
  assert.equal(document.getText(), SCENE);
  const isSent = words => sent().includes(words);
  assert.ok(isSent('"pinhole/frame"'));
  assert.deepEqual(["of the page", '"exit"', '"pinhole/lesson"', "workspace/executeCommand"].filter(isSent), []);
  panel.dispose();
  await until(() => isSent("textDocument/didClose"));
});

test("a drag of the page is one step for Undo, and the editor keeps its other text", { timeout }, async t => {
  const { document, page, vscode } = await shown(t);
  const [shownEditor] = vscode.window.visibleTextEditors;
  const center = x => SCENE.replace("center (0", `center (${x}`);
  const drag = { textDocument: { uri: "drag:1", languageId: "pinhole", version: 0, text: SCENE } };
  page.say({ method: "textDocument/didOpen", params: drag });
  for (const x of [1, 2, 3]) {
    page.change(center(x));
    await until(() => document.getText() === center(x));
  }
  assert.deepEqual(shownEditor.revealed.map(({ start, end }) => [start.line, start.character, end.character]), [[2, 22, 23], [2, 22, 23], [2, 22, 23]]);
  page.say({ method: "textDocument/didClose", params: { textDocument: { uri: "drag:1" } } });
  await until(() => !document.isInStep);
  document.type("Ball", "Globe");
  assert.equal(document.steps.length, 2);
  document.undo();
  assert.equal(document.getText(), center(3));
  document.undo();
  assert.equal(document.getText(), SCENE);
  assert.equal((await page.hears("panel/text")).params.text, SCENE);
});

test("a drag without a visible editor is written once, when it ends", { timeout }, async t => {
  const { document, page, vscode } = await shown(t);
  vscode.window.visibleTextEditors = [];
  page.say({ method: "textDocument/didOpen", params: { textDocument: { uri: "drag:1", languageId: "pinhole", version: 0, text: SCENE } } });
  for (const x of [1, 2]) page.change(SCENE.replace("center (0", `center (${x}`));
  await page.frame();
  assert.equal(document.getText(), SCENE);
  page.say({ method: "textDocument/didClose", params: { textDocument: { uri: "drag:1" } } });
  await until(() => document.getText() === SCENE.replace("center (0", "center (2"));
  document.undo();
  assert.equal(document.getText(), SCENE);
});

test("if editor and page change the text at once, the editor's text stays", { timeout }, async t => {
  const { document, page } = await shown(t);
  document.type("32", "48");
  page.change(SCENE.replace("(0, 1, 5)", "(0, 1, 6)"));
  const wanted = document.getText();
  assert.equal((await page.hears("panel/text")).params.text, wanted);
  await page.frame();
  assert.equal(document.getText(), wanted);
  page.change(wanted);
  page.say({ method: "panel/followed", params: {} });
  page.change(wanted.replace("Ball", "Globe"));
  await until(() => document.getText() === wanted.replace("Ball", "Globe"));
});

test("line ends of Windows stay", { timeout }, async t => {
  const { document, page } = await shown(t, { a: SCENE.replaceAll("\n", "\r\n") });
  page.change(`${SCENE.replace("Ball", "Globe")}checkerboard {}\n`);
  await until(() => document.getText() === `${SCENE.replace("Ball", "Globe")}checkerboard {}\n`.replaceAll("\n", "\r\n"));
});

test("what is selected in the picture is selected in the text, and the reverse", { timeout }, async t => {
  const { document, page, vscode, seen } = await shown(t);
  const [shownEditor] = vscode.window.visibleTextEditors;
  page.say({ method: "panel/cursor", params: { position: { line: 2, character: 7 } } });
  const { start, end } = await until(() => shownEditor.selection);
  assert.equal(document.getText({ start, end }), "Ball");
  const moved = (kind, line) => seen.fire("selection", { textEditor: shownEditor, kind, selections: [{ active: { line, character: 3 } }] });
  // Only a selection by the user (its `kind` is defined) is reported to the page.
  moved(undefined, 1);
  moved(2, 2);
  assert.deepEqual((await page.hears("panel/cursor")).params.position, { line: 2, character: 3 });
  assert.equal(page.told.filter(it => it.method === "panel/cursor").length, 1);
});

test("the panel follows the active scene, by a page that is loaded anew", { timeout }, async t => {
  const { documents: [, b], page, panel, seen, vscode } = await shown(t, { a: SCENE, b: SCENE.replace("32", "40") });
  page.say({ id: "late", method: "pinhole/frame", params: { textDocument: { uri: COPY }, samples: 1 } });
  await vscode.window.showTextDocument(b, { viewColumn: 1 });
  assert.equal(panel.title, "Picture of b.scn");
  assert.equal(panel.page.html.length, 2);
  // An answer to the previous page does not reach the new page.
  assert.equal(await page.begin(), b.getText());
  assert.deepEqual((await page.frame()).result.size, [40, 18]);
  assert.ok(!page.told.some(({ id }) => id === "late"));
  // The panel also follows a document whose language the user has just set to Pinhole.
  const fresh = new Document(Uri.parse("untitled:Untitled-1"), SCENE.replace("32", "44"));
  vscode.window.activeTextEditor = { document: fresh, viewColumn: 1 };
  seen.fire("open", fresh);
  assert.equal(panel.title, "Picture of Untitled-1");
  assert.equal(panel.page.html.length, 3);
  // If no editor is active, the panel still shows the last scene.
  vscode.window.activeTextEditor = undefined;
  page.say({ method: "panel/cursor", params: { position: { line: 2, character: 7 } } });
  assert.equal(panel.page.html.length, 3);
});

test("Undo, Redo and Save act on the scene's text", { timeout }, async t => {
  const { document, page, panel, run, seen, vscode } = await shown(t);
  page.change(SCENE.replace("Ball", "Globe"));
  await until(() => document.getText() !== SCENE);
  vscode.window.activeTextEditor = undefined;
  const isUndone = run("pinhole.picture.undo");
  assert.equal(typeof seen.commands.get("type"), "function", "keys are kept from the text while it has the focus");
  await isUndone;
  assert.equal(seen.commands.get("type"), undefined);
  assert.equal(document.getText(), SCENE);
  assert.equal(panel.revealed, 1, "the panel has the focus again");
  await run("pinhole.picture.redo");
  await run("pinhole.picture.save");
  assert.deepEqual(seen.executed.map(([name]) => name), ["undo", "redo"]);
  assert.equal(document.saves, 1);
});

test("the conversation ends with the server, and begins again with the next", { timeout }, async t => {
  const { document, page, run } = await shown(t);
  await run("pinhole.restart");
  await until(() => page.told.some(it => it === "ended"));
  document.type("32", "50");
  assert.equal(await page.begin(), document.getText());
  assert.deepEqual((await page.frame()).result.size, [50, 18]);
});

for (const isBusy of [false, true]) {
  test(`a server that crashes ${isBusy ? "while messages are sent to it " : ""}is started again, and the picture comes back`, { timeout }, async t => {
    const { document, page } = await shown(t);
    const [server] = execFileSync("pgrep", ["-P", String(process.pid), "-f", "lsp"], { encoding: "utf8" }).trim().split("\n").slice(-1);
    process.kill(Number(server), "SIGKILL");
    // While the user types, messages to the crashed server fail before the client notices that the
    // connection is closed.
    if (isBusy) for (let width = 32; width < 42; width++) document.type(`width ${width}`, `width ${width + 1}`);
    await until(() => page.told.some(it => it === "ended"));
    assert.equal(await page.begin(), document.getText());
    assert.ok((await page.frame()).result.png);
  });
}

test("a panel that was open is filled again after a reload of the window", { timeout }, async t => {
  const kept = memory();
  const first = await started(t, { a: SCENE }, kept);
  first.run("pinhole.picture");
  const { vscode, seen, documents: [document] } = await started(t, { a: SCENE }, kept);
  kept.update("pinhole.picture", document.uri.toString());
  vscode.window.visibleTextEditors = [];
  vscode.window.activeTextEditor = undefined;
  const panel = vscode.window.createWebviewPanel("pinhole.picture", "Picture of a.scn", {});
  await seen.serializers["pinhole.picture"].deserializeWebviewPanel(panel);
  const page = new Page(panel);
  assert.equal(await page.begin(), SCENE);
  assert.ok((await page.frame()).result.png);
  // A restored panel is closed if its scene's file no longer exists.
  const orphan = vscode.window.createWebviewPanel("pinhole.picture", "Picture of a.scn", {});
  panel.dispose();
  kept.update("pinhole.picture", "file:///gone.scn");
  await seen.serializers["pinhole.picture"].deserializeWebviewPanel(orphan);
  assert.equal(orphan.isOpen, false);
});

test("a closed panel leaves no text at the server, and another can be opened", { timeout }, async t => {
  const { document, page, panel, run, seen } = await shown(t);
  panel.dispose();
  document.type("32", "50");
  await new Promise(resolve => setTimeout(resolve, 50));
  page.say({ method: "panel/cursor", params: { position: { line: 2, character: 7 } } });
  run("pinhole.picture");
  const next = new Page(seen.panels[1]);
  assert.equal(await next.begin(), document.getText());
  assert.deepEqual((await next.frame()).result.size, [50, 18]);
  assert.deepEqual(seen.messages, []);
});

test("without a scene the command says what to do", { timeout }, async t => {
  const { run, seen, vscode } = await started(t);
  vscode.window.activeTextEditor = undefined;
  run("pinhole.picture");
  assert.match(seen.messages.map(({ message }) => message).join(), /^Open a scene/);
  assert.deepEqual(seen.panels, []);
});

test("changes of the copy are those of the protocol", () => {
  const text = "one\ntwo\nthree";
  const range = (line, character, lastLine, last) => ({ start: { line, character }, end: { line: lastLine, character: last } });
  assert.equal(changed(text, [{ range: range(2, 1, 2, 5), text: "" }, { range: range(0, 3, 1, 1), text: "-" }]), "one-wo\nt");
  assert.equal(changed(text, [{ text: "four" }]), "four");
  assert.equal(normal("a\r\nb\rc\ud800"), "a\nb\nc\ufffd");
});

test("differences are small edits that make the other text", () => {
  const made = (before, edits) => changed(before, [...edits].reverse()
    .map(({ line, from, lastLine, to, text }) => ({ range: { start: { line, character: from }, end: { line: lastLine, character: to } }, text })));
  const pairs = [
    ["", "a\nb"], ["a\nb", ""], ["a\nb\nc", "a\nb2\nc"], ["aaa", "aa"], ["aa\naa", "aa\naa\naa"], ["x 1 y\nz\nx 2 y", "x 10 y\nz\nx 3 y"], ["a\n\nb\n", "a\nb\n"],
  ];
  for (const [before, after] of pairs) assert.equal(made(before, differences(before, after)), after, JSON.stringify([before, after]));
  assert.deepEqual(differences(SCENE, SCENE), []);
  const moved = differences(SCENE, SCENE.replace("(0, 1, 5)", "(0.5, 1, 5)").replace("center (0", "center (3"));
  assert.deepEqual(moved, [{ line: 1, from: 15, lastLine: 1, to: 15, text: ".5" }, { line: 2, from: 22, lastLine: 2, to: 23, text: "3" }]);
});
