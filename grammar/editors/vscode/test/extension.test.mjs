// The extension as it is packaged, in a stand-in for VS Code, with the real program.

import assert from "node:assert/strict";
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

/** A document of the editor: a scene in the test's folder. */
function scene(text) {
  const file = path.join(folder, "a.scn");
  writeFileSync(file, text);
  return { uri: Uri.file(file), fileName: file, languageId: "pinhole", version: 1, isDirty: false, isClosed: false, getText: () => text, save: async () => true };
}

/** The whole path of the program. */
const whole = () => (program.includes("/") ? path.resolve(program) : findBinary("", undefined));

/** The extension in an editor like this, until the test is over. */
async function started(t, options) {
  const { vscode, seen } = editor(options);
  const extension = load(vscode);
  t.after(() => extension.deactivate());
  const diagnosed = new Promise(resolve => { seen.onDiagnostics = resolve; });
  await extension.activate({ subscriptions: [] });
  return { vscode, seen, diagnosed };
}

const timeout = 20_000;

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
  assert.deepEqual([kind, choices, seen.messages.length], ["error", ["Open Setting"], 1]);
  assert.match(message, /\/nowhere\/pinhole.*pinhole\.path.*cargo install/s);
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
  const env = { PATH: ["relative", path.join(folder, "empty"), path.dirname(first), path.dirname(second)].join(path.delimiter), CARGO_HOME: path.join(folder, "cargo") };
  assert.equal(findBinary("", undefined, env), first);
  assert.equal(findBinary("", undefined, { ...env, PATH: "" }), cargo);
  assert.equal(findBinary(second, undefined, env), second);
  assert.equal(findBinary(" second/pinhole ", folder, env), second);
  assert.equal(findBinary("third/pinhole", folder, env), undefined);
  assert.equal(findBinary("second", folder, env), undefined, "a folder is no program");
  chmodSync(first, 0o644);
  if (process.getuid?.() !== 0) assert.equal(findBinary("", undefined, env), second);
  symlinkSync(second, path.join(folder, "link"));
  assert.equal(findBinary(path.relative(homedir(), path.join(folder, "link")), undefined, env), path.join(folder, "link"));
});
