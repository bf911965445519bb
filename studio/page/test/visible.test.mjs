// Tests that invisible characters in names and messages are shown as codes everywhere.

import assert from "node:assert/strict";
import { mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { test } from "node:test";
import { FIGURE, launch, open, serve, type } from "./helpers.mjs";

const ALL = ["\u202e", "\u2066", "\u200f", "\u061c", "\u0085", "\u001b", "\u200b", "\u00ad", "\ufeff", "\u{e0041}", "\n", "\t", "\u2028"];
const code = character => `\\u{${character.codePointAt(0).toString(16)}}`;

test("invisible characters of a name are shown as codes everywhere", async t => {
  const browser = await launch(t);
  for (const character of ALL) {
    const folder = mkdtempSync(path.join(tmpdir(), "pinhole-studio-"));
    const file = path.join(folder, `gnp${character}.scn`);
    writeFileSync(file, FIGURE);
    const started = await serve(file);
    t.after(() => (started.stop(), rmSync(folder, { recursive: true, force: true })));
    const page = await open(browser, started);
    const shown = `gnp${code(character)}.scn`;
    assert.equal(await page.textContent("#file-name"), shown);
    assert.equal(await page.title(), `${shown} – Pinhole Studio`);
    rmSync(file);
    await page.waitForFunction(() => /is gone/.test(document.querySelector("#said").textContent));
    assert.equal(await page.textContent("#said"), `${shown} is gone; Save writes it anew.`);
    await page.keyboard.press("Control+s");
    await page.waitForFunction(() => /is saved/.test(document.querySelector("#said").textContent));
    assert.equal(await page.textContent("#said"), `${shown} is saved.`);
    await type(page, FIGURE.replace("radius 1", "radius 2"));
    writeFileSync(file, FIGURE.replace("radius 1", "radius 3"));
    await page.waitForSelector("#conflict-dialog[open]");
    assert.equal(await page.textContent("#conflict-name"), shown);
    await page.context().close();
  }
});

test("messages show invisible characters as codes", async t => {
  const folder = mkdtempSync(path.join(tmpdir(), "pinhole-studio-"));
  const file = path.join(folder, "scene.scn");
  writeFileSync(file, FIGURE);
  const started = await serve(file);
  t.after(() => (started.stop(), rmSync(folder, { recursive: true, force: true })));
  const page = await open(await launch(t), started);
  await page.click("#problems");
  for (const character of ALL.slice(0, 10)) {
    // In these texts, the character is an error itself, or is quoted in a message or in the text of
    // a fix.
    for (const wrong of [`${character} camera`, `sphere { radius "a${character}b" }`, `let a = (1, 2, "${character}`, `sphere { center [1, 2, /*${character}*/ 3] }`]) {
      const before = await page.textContent("#problem-list");
      await type(page, wrong);
      await page.waitForFunction(before => document.querySelector("#problem-list").textContent !== before, before);
      const said = await page.evaluate(() => document.querySelector("#problem-list").textContent);
      assert.ok(!said.includes(character), JSON.stringify(said));
    }
  }
});

test("the page's sources set every text through setText", () => {
  const folder = new URL("../src/", import.meta.url);
  const sources = readdirSync(folder).filter(name => name.endsWith(".ts") && name !== "visible.ts");
  const wrong = sources.filter(name => /(textContent|innerText) =(?!=)|createTextNode\((?!visible\()|message: diagnostic\.message/.test(readFileSync(new URL(name, folder), "utf8")));
  assert.deepEqual(wrong, []);
});
