// Compares the TextMate grammar with the server's semantic tokens, and tests the extension's client
// library against the server.

import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { colors, functions } from "../syntaxes/grammar.mjs";
import { scoped } from "./scoped.mjs";
import { classified, start } from "./server.mjs";

const root = new URL("../../../../", import.meta.url).pathname;

/** All scenes without mistakes: the examples, and the texts of the parser's tests. */
const scenes = ["examples", "tests"]
  .flatMap(folder => readdirSync(root + folder, { recursive: true }).map(file => `${folder}/${file}`))
  .filter(file => file.endsWith(".scn") && (file.startsWith("examples/") || file.includes("/ok/")));

let server;
before(async () => { server = await start(); });
after(async () => assert.equal(await server.stop(), 0));

for (const scene of scenes) {
  test(`${scene} is scoped as its semantic tokens are`, { timeout: 30_000 }, async () => {
    const source = readFileSync(root + scene, "utf8");
    const uri = pathToFileURL(root + scene).href;
    await server.open(uri, source);
    assert.deepEqual(scoped(source), await classified(server, uri, source));
  });
}

test("there are scenes to compare", () => assert.ok(scenes.length > 20));

test("the grammar knows the colours and functions that the language knows", { timeout: 30_000 }, async () => {
  const textDocument = { uri: "file:///words.scn" };
  await server.open(textDocument.uri, "sphere { color  center  }");
  const offered = async (character, kind) => {
    const answer = await server.ask("textDocument/completion", { textDocument, position: { line: 0, character } });
    return (answer.items ?? answer).filter(item => item.kind === kind).map(({ label }) => label);
  };
  const [FUNCTION, COLOR] = [3, 16];
  assert.deepEqual((await offered(15, COLOR)).sort(), colors);
  // Completion offers only functions of the expected type, so it is asked for a colour and for a
  // point.
  const found = new Set([...await offered(15, FUNCTION), ...await offered(23, FUNCTION)]);
  assert.deepEqual([...found].sort(), [...functions].sort());
});

test("a scene is diagnosed, mended, explained and completed", { timeout: 30_000 }, async () => {
  const uri = "file:///broken.scn";
  const textDocument = { uri };
  const text = "camera { eye (0, 1, 5)  lookat (0, 1, 0)  roll 30 }\nsphere { center (0, 1, 0)   }\n";
  const diagnostics = await server.open(uri, text);
  assert.deepEqual(diagnostics.map(({ code }) => code), ["bare_angle"]);
  const [{ range }] = diagnostics;
  assert.deepEqual(range, { start: { line: 0, character: 47 }, end: { line: 0, character: 49 } });

  const fixes = await server.ask("textDocument/codeAction", { textDocument, range, context: { diagnostics } });
  const texts = fixes.flatMap(({ edit }) => edit.changes?.[uri] ?? edit.documentChanges[0].edits).map(({ newText }) => newText);
  assert.ok(texts.some(text => text.includes("deg")), JSON.stringify(fixes));

  const { contents } = await server.ask("textDocument/hover", { textDocument, position: { line: 1, character: 10 } });
  assert.match(contents.value, /center/);

  const answer = await server.ask("textDocument/completion", { textDocument, position: { line: 1, character: 27 } });
  const labels = (answer.items ?? answer).map(({ label }) => label);
  assert.ok(labels.includes("radius") && labels.includes("color") && !labels.includes("center"), labels.join(" "));
});
