// Tests the packaged extension in a substitute for VS Code, with the real program.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { chmodSync, existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, symlinkSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { homedir, tmpdir } from "node:os";
import path from "node:path";
import { afterEach, beforeEach, test } from "node:test";
import { program } from "./server.mjs";
import { editor, load, Uri } from "./vscode.mjs";

const require = createRequire(import.meta.url);
const { findBinary } = require("../src/binary.js");

const SCENE = "image { width 32 height 18 }\ncamera { eye (0, 1, 5)  lookat (0, 1, 0) }\nsphere { center (0, 1, 0) }\n";

let folder;
beforeEach(() => { folder = mkdtempSync(path.join(tmpdir(), "pinhole-extension-")); });
afterEach(() => rmSync(folder, { recursive: true }));

/** Makes a document of the editor from a scene, which is written to the test's folder. */
function scene(text) {
  const file = path.join(folder, "a.scn");
  writeFileSync(file, text);
  return { uri: Uri.file(file), fileName: file, languageId: "pinhole", version: 1, isDirty: false, isClosed: false, getText: () => text, save: async () => true };
}

/** Returns the absolute path of the program. */
const whole = () => (program.includes("/") ? path.resolve(program) : findBinary("", undefined));

/** Starts the extension in an editor with these options. It is stopped when the test ends. */
async function started(t, options) {
  const { vscode, seen } = editor(options);
  const extension = load(vscode);
  t.after(() => extension.deactivate());
  const diagnosed = new Promise(resolve => { seen.onDiagnostics = resolve; });
  await extension.activate({ subscriptions: [] });
  return { vscode, seen, diagnosed };
}

const timeout = 20_000;

/** Waits until the extension has reacted to the user's answer to a message, for which it does not
 * wait itself. */
const settled = () => new Promise(resolve => setTimeout(resolve, 50));

test("a scene that is open gets its diagnostics and every answer has a provider", { timeout }, async t => {
  const document = scene(SCENE.replace("eye", "eyes"));
  const { seen, diagnosed } = await started(t, { documents: [document], setting: whole() });
  await diagnosed;
  const found = seen.diagnostics.get(document.uri.toString());
  const eyes = found.find(({ message }) => message.includes("eyes"));
  assert.ok(eyes, JSON.stringify(found));
  assert.equal(eyes.code, "unknown_field");
  for (const answer of [
    "CompletionItem", "Hover", "CodeActions", "Rename", "Reference", "Color", "DocumentFormattingEdit", "DocumentSymbol",
    "FoldingRange", "InlayHints", "DocumentSemanticTokens", "SignatureHelp", "Definition",
  ]) {
    assert.ok(seen.providers[`register${answer}Provider`], `${answer}: ${Object.keys(seen.providers)}`);
  }
  assert.deepEqual(seen.messages, []);
});

test("Pinhole: Render writes the picture and opens it beside", { timeout }, async t => {
  const document = scene(SCENE);
  const { vscode, seen } = await started(t, { documents: [document], setting: whole() });
  await seen.commands.get("pinhole.render")();
  assert.deepEqual(seen.messages, []);
  const picture = path.join(folder, "a.png");
  assert.equal(readFileSync(picture).subarray(1, 4).toString(), "PNG");
  const [[command, uri, options]] = seen.executed.filter(([command]) => command === "vscode.open");
  assert.deepEqual([command, uri.fsPath, options.viewColumn], ["vscode.open", picture, vscode.ViewColumn.Beside]);
});

test("Pinhole: Render says what is wrong with a scene, and opens nothing", { timeout }, async t => {
  const document = scene(SCENE.replace("sphere", "globe"));
  const { vscode, seen } = await started(t, { documents: [document], setting: whole() });
  await seen.commands.get("pinhole.render")();
  assert.match(seen.messages.map(({ message }) => message).join(), /^[^\n]*`globe`[^\n]*$/);
  assert.deepEqual(seen.executed.filter(([command]) => command === "vscode.open"), []);
  assert.ok(!existsSync(path.join(folder, "a.png")));
});

test("Pinhole: Render on Every Save watches in a terminal", { timeout }, async t => {
  const document = scene(SCENE);
  const { seen } = await started(t, { documents: [document], setting: whole() });
  await seen.commands.get("pinhole.watch")();
  const [{ shellPath, shellArgs }] = seen.terminals;
  assert.deepEqual([shellPath, shellArgs], [whole(), ["watch", document.uri.fsPath]]);
});

test("a program that is missing is named with what to do", { timeout }, async t => {
  const { seen } = await started(t, { setting: "/nowhere/pinhole" });
  const [{ kind, message, choices }] = seen.messages;
  assert.deepEqual([kind, choices, seen.messages.length], ["error", ["Choose File…", "How to Get It"], 1]);
  assert.match(message, /\/nowhere\/pinhole.*pinhole\.path/s);
});

test("a program that is missing can be chosen, or its page opened", { timeout }, async t => {
  const chosen = await started(t, { setting: "/nowhere/pinhole", answers: ["Choose File…"], file: "/a/pinhole" });
  await settled();
  assert.deepEqual(chosen.seen.updates, [["path", "/a/pinhole", chosen.vscode.ConfigurationTarget.Global]]);
  const asked = await started(t, { setting: "/nowhere/pinhole", answers: ["How to Get It"] });
  await settled();
  assert.deepEqual(asked.seen.executed, [["extension.open", "pinhole.pinhole"]]);
});

test("a file that another extension has taken becomes a scene, and then all with its ending", { timeout }, async t => {
  const taken = { ...scene(SCENE), languageId: "godot" };
  const { vscode, seen } = await started(t, { documents: [taken], setting: whole(), answers: ["Every *.scn"] });
  await seen.commands.get("pinhole.use")();
  assert.deepEqual(seen.languages, [[taken, "pinhole"]]);
  assert.deepEqual(seen.updates, [["associations", { "*.old": "text", "*.scn": "pinhole" }, vscode.ConfigurationTarget.Global]]);
});

test("the icon is the picture of its scene", () => {
  const folder = new URL("..", import.meta.url).pathname;
  const [file, cwd] = [path.join(folder, "icon.png"), folder];
  const icon = execFileSync(whole(), ["render", "icon.scn", "-o", "-"], { cwd, stdio: ["ignore", "pipe", "ignore"] });
  assert.ok(icon.equals(readFileSync(file)), "render icon.scn anew");
});

test("the program is the setting's, or the first on the path, or cargo's", () => {
  const place = (...names) => {
    const file = path.join(folder, ...names);
    mkdirSync(path.dirname(file), { recursive: true });
    writeFileSync(file, "");
    chmodSync(file, 0o755);
    return file;
  };
  const [first, second, cargo] = [place("first", "pinhole"), place("second", "pinhole"), place("cargo", "bin", "pinhole")];
  const own = place("own", "bin", "pinhole");
  const env = { PATH: ["relative", path.join(folder, "empty"), path.dirname(first), path.dirname(second)].join(path.delimiter), CARGO_HOME: path.join(folder, "cargo") };
  assert.equal(findBinary("", undefined, undefined, env), first);
  assert.equal(findBinary("", undefined, undefined, { ...env, PATH: "" }), cargo);
  assert.equal(findBinary("", undefined, path.join(folder, "own"), { PATH: "", CARGO_HOME: folder }), own, "as packaged");
  assert.equal(findBinary(second, undefined, undefined, env), second);
  assert.equal(findBinary(" second/pinhole ", folder, undefined, env), second);
  assert.equal(findBinary("third/pinhole", folder, undefined, env), undefined);
  assert.equal(findBinary("second", folder, undefined, env), undefined, "a folder is no program");
  chmodSync(first, 0o644);
  if (process.getuid?.() !== 0) assert.equal(findBinary("", undefined, undefined, env), second);
  symlinkSync(second, path.join(folder, "link"));
  assert.equal(findBinary(path.relative(homedir(), path.join(folder, "link")), undefined, undefined, env), path.join(folder, "link"));
});
