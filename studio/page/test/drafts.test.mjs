// What is written and not saved is not lost: by a reload, a crash of the host, another port,
// another program that saves the file.

import assert from "node:assert/strict";
import { readdirSync } from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { andFinished, FIGURE, finished, host, launch, open, rested, serve, STATE, text, type } from "./helpers.mjs";

const LARGER = FIGURE.replace("radius 1", "radius 1.5");
const NEARER = FIGURE.replace("eye    (3, 3.5, 8)", "eye    (3, 3.5, 6)");

const offered = page => page.waitForSelector("#draft-bar:not([hidden])");
const choose = (page, name) => page.click(`#draft-choices >> text=${name}`);
/** Longer than a draft is behind the keys. */
const kept = page => page.waitForTimeout(900);

/** Leaves a page as a browser that is closed does. */
async function leave(page) {
  page.on("dialog", dialog => dialog.accept());
  await page.context().close();
}

test("a host that is killed and another one at another port: the draft is offered, restored, and gone when it is saved", async t => {
  const started = await host(t);
  const browser = await launch(t);
  const page = await open(browser, started);
  await andFinished(page, () => type(page, LARGER));
  await kept(page);
  await started.stop("SIGKILL");
  await leave(page);
  const again = await serve(started.file);
  t.after(() => again.stop());
  const other = await open(browser, again);
  await offered(other);
  assert.equal(await text(other), FIGURE);
  await andFinished(other, () => choose(other, "Restore"));
  assert.equal(await text(other), LARGER);
  assert.equal(await other.textContent("#file-state"), "not saved");
  assert.equal(started.text(), FIGURE);
  await other.keyboard.press("Control+s");
  await other.waitForFunction(() => document.querySelector("#file-state").textContent === "");
  assert.equal(started.text(), LARGER);
  await other.reload();
  await finished(other);
  await other.waitForTimeout(300);
  assert.ok(await other.isHidden("#draft-bar"));
});

test("what is written while an offer stands unanswered is kept beside it, and so is what was there when one is restored", async t => {
  const started = await host(t);
  const browser = await launch(t);
  const SMALLER = FIGURE.replace("radius 1", "radius 0.5");
  const offers = page => page.locator("#draft-choices li").allTextContents();
  let page = await open(browser, started);
  await andFinished(page, () => type(page, LARGER));
  await kept(page);
  await started.stop("SIGKILL");
  await leave(page);
  // Not answered, and written on.
  const second = await serve(started.file);
  page = await open(browser, second);
  await offered(page);
  await andFinished(page, () => type(page, SMALLER));
  await kept(page);
  assert.equal((await offers(page)).length, 1);
  await second.stop("SIGKILL");
  await leave(page);
  const third = await serve(started.file);
  t.after(() => third.stop());
  page = await open(browser, third);
  await offered(page);
  assert.equal((await offers(page)).length, 2);
  assert.match(await page.textContent("#draft"), /2 texts were not saved/);
  // Another one is written before one is restored.
  await andFinished(page, () => type(page, NEARER));
  await andFinished(page, () => choose(page, "Restore"));
  assert.equal(await text(page), SMALLER);
  assert.equal((await offers(page)).length, 2);
  await andFinished(page, () => choose(page, "Restore"));
  assert.equal(await text(page), NEARER);
  // Saving is no answer to those that are left.
  await page.keyboard.press("Control+s");
  await page.waitForFunction(() => document.querySelector("#file-state").textContent === "");
  await page.reload();
  await finished(page);
  await offered(page);
  const left = [];
  for (let i = 0; i < 2; i++) {
    await andFinished(page, () => choose(page, "Restore"));
    left.push(await text(page));
    await andFinished(page, () => page.keyboard.press("Control+z"));
  }
  assert.deepEqual(left.sort(), [SMALLER, LARGER].sort());
  assert.ok(await page.isHidden("#draft-bar"));
});

test("reloading offers the draft; Forget forgets it, and Undo back to the file does", async t => {
  const page = await open(await launch(t), await host(t));
  page.on("dialog", dialog => dialog.accept());
  await andFinished(page, () => type(page, LARGER));
  await page.reload();
  await finished(page);
  await offered(page);
  await choose(page, "Forget");
  await page.reload();
  await finished(page);
  await page.waitForTimeout(300);
  assert.ok(await page.isHidden("#draft-bar"));
  await andFinished(page, () => type(page, LARGER));
  await kept(page);
  await andFinished(page, () => page.keyboard.press("Control+z"));
  assert.equal(await text(page), FIGURE);
  await kept(page);
  await page.reload();
  await finished(page);
  await page.waitForTimeout(300);
  assert.ok(await page.isHidden("#draft-bar"));
});

test("a draft is not written over a file that is newer without a question", async t => {
  const started = await host(t);
  const browser = await launch(t);
  const page = await open(browser, started);
  await andFinished(page, () => type(page, LARGER));
  await kept(page);
  await leave(page);
  started.write(NEARER);
  await new Promise(resolve => setTimeout(resolve, 300));
  const other = await open(browser, started);
  await offered(other);
  assert.match(await other.textContent("#draft-choices"), /file has changed since/);
  await andFinished(other, () => choose(other, "Restore"));
  await other.keyboard.press("Control+s");
  await other.waitForSelector("#conflict-dialog[open]");
  assert.equal(started.text(), NEARER);
});

test("drafts are for the user alone", async t => {
  const page = await open(await launch(t), await host(t));
  await andFinished(page, () => type(page, LARGER));
  await kept(page);
  const folder = path.join(STATE, "pinhole", "drafts");
  assert.ok(readdirSync(folder).length > 0);
  const { statSync } = await import("node:fs");
  assert.equal(statSync(folder).mode & 0o77, 0);
});

test("a host that stops is told after two seconds, and Save says that nothing is saved", async t => {
  const started = await host(t);
  const page = await open(await launch(t), started);
  await rested(page);
  process.kill(started.pid, "SIGSTOP");
  const begin = Date.now();
  await page.waitForFunction(() => /Nothing has come back/.test(document.querySelector("#connection").textContent), null, { timeout: 5000 });
  assert.ok(Date.now() - begin < 3000, `${Date.now() - begin} ms`);
  await page.keyboard.press("Control+s");
  await page.waitForFunction(() => /Nothing is saved yet/.test(document.querySelector("#said").textContent), null, { timeout: 1000 });
  process.kill(started.pid, "SIGCONT");
  await page.waitForSelector("#connection-bar", { state: "hidden", timeout: 3000 });
});
