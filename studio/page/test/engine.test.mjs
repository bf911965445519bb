// Tests of the WebAssembly engine without a page: its pictures have the same pixels as those of
// `pinhole render`.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { before, test } from "node:test";
import { fileURLToPath } from "node:url";

const here = path.dirname(fileURLToPath(import.meta.url));
const generated = path.join(here, "../engine");
const figure = readFileSync(path.join(here, "../../../examples/figure_9_9.scn"), "utf8");
const program = process.env.PINHOLE;
const skip = process.env.SITE === undefined || program === undefined ? "SITE names no folder, or PINHOLE no program" : false;
const uri = "studio:///scene.scn";

let Engine;
before(async () => {
  if (skip) return;
  const module = await import(path.join(generated, "pinhole.js"));
  module.initSync({ module: readFileSync(path.join(process.env.SITE, "pinhole_bg.wasm")) });
  ({ Engine } = module);
});

let requests = 0;

/** Sends a request, lets the engine do all the work for it, and returns the response. */
function ask(engine, method, params) {
  const id = ++requests;
  const said = engine.handle(JSON.stringify({ jsonrpc: "2.0", id, method, params }));
  while (engine.isBusy()) said.push(...engine.advance());
  return said.map(text => JSON.parse(text)).find(message => message.id === id);
}

function opened(text) {
  const engine = new Engine();
  ask(engine, "initialize", { capabilities: {} });
  const textDocument = { uri, languageId: "scn", version: 1, text };
  engine.handle(JSON.stringify({ jsonrpc: "2.0", method: "textDocument/didOpen", params: { textDocument } }));
  return engine;
}

/** Returns the picture file that `pinhole` renders from a text. */
function rendered(text, ending = "png", ...args) {
  const folder = mkdtempSync(path.join(tmpdir(), "pinhole-engine-"));
  try {
    const output = path.join(folder, `a.${ending}`);
    writeFileSync(path.join(folder, "a.scn"), text);
    execFileSync(program, ["render", path.join(folder, "a.scn"), "-o", output, ...args]);
    return readFileSync(output);
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}

/** Returns the bytes of a PNG from the pixels on. The bytes before contain the scene's text, which
 * is not compared. */
const pixels = png => png.subarray(png.indexOf("IDAT"));

test("a frame has the pixels that the program renders", { skip }, () => {
  const engine = opened(figure);
  for (const [params, args] of [
    [{}, []],
    [{ scale: 4 }, ["--set", "image.width=320", "--set", "image.height=180"]],
    [{ scale: 8, samples: 1 }, ["--set", "image.width=160", "--set", "image.height=90", "--set", "sampler.method=regular", "--set", "sampler.per_pixel=1"]],
  ]) {
    const { result } = ask(engine, "pinhole/frame", { textDocument: { uri }, ...params });
    assert.deepEqual(result.size, [1280, 720]);
    assert.ok(pixels(Buffer.from(result.png, "base64")).equals(pixels(rendered(figure, "png", ...args))), JSON.stringify(params));
  }
});

test("the engine's picture file equals the program's", { skip }, () => {
  const engine = new Engine();
  const greeting = JSON.parse(engine.greeting());
  assert.equal(greeting.method, "studio/file");
  for (const text of [greeting.params.text, `${greeting.params.text}\nimage { width 60  height 40 }\nsampler { method exact }\n`]) {
    const { result } = ask(engine, "studio/png", { text });
    assert.ok(Buffer.from(result.png, "base64").equals(rendered(text, "png")));
  }
  assert.match(ask(engine, "studio/png", { text: "sphere {" }).error.message, /errors/);
  assert.match(ask(engine, "studio/exr", { text: figure }).error.message, /no EXR/);
});

test("the engine's frames are fast enough", { skip }, t => {
  const engine = opened(figure);
  const median = params => {
    const times = Array.from({ length: 9 }, () => {
      const start = performance.now();
      ask(engine, "pinhole/frame", { textDocument: { uri }, ...params });
      return performance.now() - start;
    });
    return times.sort((a, b) => a - b)[4];
  };
  t.diagnostic(`1280 × 720 with 16 samples: ${median({}).toFixed(0)} ms; coarse, by 8 with 1 sample: ${median({ scale: 8, samples: 1 }).toFixed(1)} ms`);
});
