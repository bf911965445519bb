// Tests of how the scene of a lesson and the user's own scene replace each other, and what is kept.

import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { andFinished, FIGURE, host, launch, link, menu, open, openFile, text, type } from "./helpers.mjs";
import { choose, names, read } from "./lessons.mjs";

/** Presses the key for Undo in the text. */
async function undo(page) {
  await page.focus(".cm-content");
  await andFinished(page, () => page.keyboard.press("Control+z"));
}

const SMALLER = FIGURE.replace("radius 1", "radius 0.5");
const WAYS = {
  New: page => menu(page, "File", "#new"),
  "an example": async page => {
    await page.click('summary:text("File")');
    await page.click('#examples button:text-is("piercing")');
  },
  Open: (page, { other }) => openFile(page, other),
  "a pasted link": (page, { address }) => page.goto(address),
};
for (const [way, act] of Object.entries(WAYS)) {
  test(`another scene leaves the lesson, and Undo leads to the user's own scene: ${way}`, async t => {
    const started = await host(t);
    const other = path.join(started.folder, "other.scn");
    writeFileSync(other, SMALLER);
    const page = await open(await launch(t), started);
    const mine = FIGURE.replace("radius 1", "radius 1.5");
    await andFinished(page, () => type(page, SMALLER));
    const address = await link(page);
    await page.click("#share-dialog >> text=Close");
    await undo(page);
    await andFinished(page, () => type(page, mine));
    await choose(page, 1);
    const changed = `${read(names[0], "scn")}// changed\n`;
    await andFinished(page, () => type(page, changed));
    await andFinished(page, () => act(page, { other, address }));
    const shown = await text(page);
    assert.ok(![mine, changed, FIGURE].includes(shown), shown);
    assert.ok(await page.isHidden("#lesson"));
    assert.doesNotMatch(page.url(), /lesson/);
    assert.equal(await page.locator("#draft-choices li").count(), 1);
    // When the lesson is opened again, it has its changed text. When it is closed, the scene that
    // was opened after it is shown again.
    await choose(page, 1);
    assert.equal(await text(page), changed);
    await andFinished(page, () => page.click("#lesson-close"));
    assert.equal(await text(page), shown);
    await undo(page);
    assert.equal(await text(page), mine);
    assert.equal(await page.textContent("#file-name"), "scene.scn");
    await undo(page);
    assert.equal(await text(page), FIGURE);
    assert.equal(await page.textContent("#file-state"), "");
    assert.deepEqual(page.complaints, []);
  });
}

test("the host's file that was saved elsewhere meanwhile is shown after a lesson and after Undo", async t => {
  const started = await host(t);
  const page = await open(await launch(t), started);
  const says = words => page.waitForFunction(words => document.querySelector("#said").textContent.includes(words), words);
  const nearer = FIGURE.replace("(3, 3.5, 8)", "(3, 3.5, 6)");
  await choose(page, 1);
  started.write(SMALLER);
  await page.waitForTimeout(1000);
  assert.equal(await text(page), read(names[0], "scn"));
  await andFinished(page, () => page.click("#lesson-close"));
  await says("the page follows");
  assert.equal(await text(page), SMALLER);
  assert.equal(await page.textContent("#file-state"), "");
  await andFinished(page, () => menu(page, "File", "#new"));
  started.write(nearer);
  await page.waitForTimeout(1000);
  await undo(page);
  await says("the page follows");
  assert.equal(await text(page), nearer);
  // If the user's own text is unsaved, the page asks whether to keep it or the file's text.
  await andFinished(page, () => type(page, `${nearer}// mine\n`));
  await choose(page, 1);
  started.write(FIGURE);
  await page.waitForTimeout(1000);
  await page.click("#lesson-close");
  await page.waitForSelector("#conflict-dialog[open]");
  assert.equal(await text(page), `${nearer}// mine\n`);
});

test("Save as in a lesson does not hide the user's own scene", async t => {
  const started = await host(t);
  const page = await open(await launch(t), started);
  await choose(page, 1);
  await menu(page, "File", "#save-as");
  await page.fill("#name-field", "done");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => document.querySelector("#file-name").textContent === "done.scn");
  assert.equal(readFileSync(path.join(started.folder, "done.scn"), "utf8"), read(names[0], "scn"));
  await andFinished(page, () => page.click("#lesson-close"));
  assert.equal(await text(page), FIGURE);
  assert.equal(await page.textContent("#file-name"), "scene.scn");
});
