// Tests of drafts: unsaved text survives a reload, a crash of the host, another port, and a save by
// another program.

import assert from "node:assert/strict";
import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { andFinished, FIGURE, finished, host, launch, menu, open, openFile, rested, serve, STATE, text, type } from "./helpers.mjs";

const LARGER = FIGURE.replace("radius 1", "radius 1.5");
const NEARER = FIGURE.replace("eye    (3, 3.5, 8)", "eye    (3, 3.5, 6)");

const offered = page => page.waitForSelector("#draft-bar:not([hidden])");
const choose = (page, name) => page.click(`#draft-choices >> text=${name}`);
/** Waits until a draft is certainly stored. */
const kept = page => page.waitForTimeout(900);

/** Closes a page's browser context, as if the user closed the browser. */
async function leave(page) {
  page.on("dialog", dialog => dialog.accept());
  await page.context().close();
}

/** Restores `count` offered drafts in turn, each followed by Undo. Returns the drafts' texts. */
async function restoredInTurn(page, count) {
  const texts = [];
  for (let i = 0; i < count; i++) {
    await andFinished(page, () => choose(page, "Restore"));
    texts.push(await text(page));
    await andFinished(page, () => page.keyboard.press("Control+z"));
  }
  return texts;
}

test("after a killed host, one at another port offers the draft until it is saved", async t => {
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

test("restoring a draft keeps other offers and the text it replaces as drafts", async t => {
  const started = await host(t);
  const browser = await launch(t);
  const SMALLER = FIGURE.replace("radius 1", "radius 0.5");
  const offers = page => page.locator("#draft-choices li").allTextContents();
  let page = await open(browser, started);
  await andFinished(page, () => type(page, LARGER));
  await kept(page);
  await started.stop("SIGKILL");
  await leave(page);
  // The offered draft is neither restored nor forgotten before the text is changed.
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
  // The text is changed again before a draft is restored.
  await andFinished(page, () => type(page, NEARER));
  await andFinished(page, () => choose(page, "Restore"));
  assert.equal(await text(page), SMALLER);
  assert.equal((await offers(page)).length, 2);
  await andFinished(page, () => choose(page, "Restore"));
  assert.equal(await text(page), NEARER);
  // After Save, the remaining drafts are still offered.
  await page.keyboard.press("Control+s");
  await page.waitForFunction(() => document.querySelector("#file-state").textContent === "");
  await page.reload();
  await finished(page);
  await offered(page);
  const left = await restoredInTurn(page, 2);
  assert.deepEqual(left.sort(), [SMALLER, LARGER].sort());
  assert.ok(await page.isHidden("#draft-bar"));
});

for (const way of ["a reload of its tab, and its address there", "its address in another tab"]) {
  test(`text typed without a host is back when one starts at the same port: ${way}`, async t => {
    const started = await host(t, FIGURE, "own.scn");
    const browser = await launch(t);
    const page = await open(browser, started);
    page.on("dialog", dialog => dialog.accept());
    // The first text is stored by the host; the second one, typed later, is not.
    await andFinished(page, () => type(page, LARGER));
    await kept(page);
    await started.stop("SIGKILL");
    await page.waitForSelector("#connection-bar:not([hidden])");
    await page.locator(".cm-line").last().click();
    await page.keyboard.type("// typed", { delay: 20 });
    let typed = await text(page);
    assert.match(typed, /radius 1\.5[^]*\/\/ typed$/);
    await kept(page);
    const { port } = new URL(started.address);
    assert.match(await page.innerText("#connection-kept"), new RegExp(`kept in this browser.*--port ${port}`));
    const again = await serve(started.file, { port });
    t.after(() => again.stop());
    let next = page;
    if (way.startsWith("a reload")) {
      await page.reload();
      await offered(page);
      assert.match(await page.textContent("#connection"), /Studio was started anew/);
      assert.equal(await page.locator("#draft-choices li").count(), 1);
      // After the draft is restored, the page can be used at once, with the same file.
      await choose(page, "Restore");
      assert.equal(await text(page), typed);
      assert.ok(await page.isHidden("#draft-bar"));
      assert.equal(await page.textContent("#file-name"), path.basename(started.file));
      await page.locator(".cm-line").last().click();
      await page.keyboard.type(" on", { delay: 20 });
      typed += " on";
      assert.equal(await text(page), typed);
      await kept(page);
      assert.match(await page.innerText("#connection-kept"), /^What is written now is kept in this browser/);
      const [download] = await Promise.all([page.waitForEvent("download"), page.click("#connection-download")]);
      assert.equal(readFileSync(await download.path(), "utf8"), typed);
      await page.reload();
      await offered(page);
      await page.goto(again.address);
      await finished(page);
    } else {
      next = await page.context().newPage();
      await page.close();
      await next.goto(again.address);
      await finished(next);
    }
    await offered(next);
    assert.equal(await next.locator("#draft-choices li").count(), 1);
    await andFinished(next, () => choose(next, "Restore"));
    assert.equal(await text(next), typed);
    assert.equal(started.text(), FIGURE);
    await next.keyboard.press("Control+s");
    await next.waitForFunction(() => document.querySelector("#file-state").textContent === "");
    assert.equal(started.text(), typed);
    if (next === page) {
      await page.reload();
      await finished(page);
      await page.waitForTimeout(300);
      assert.ok(await page.isHidden("#draft-bar"));
    }
    // The browser's copy is deleted when the host has stored the draft.
    await kept(next);
    const left = await next.evaluate(() => new Promise(resolve => {
      indexedDB.open("pinhole-drafts").onsuccess = ({ target: { result } }) => {
        result.transaction("drafts").objectStore("drafts").count().onsuccess = ({ target }) => resolve(target.result);
      };
    }));
    assert.equal(left, 0);
  });
}

test("a draft restored without a connection stays a draft, and Save asks about a newer file", async t => {
  const started = await host(t);
  const page = await open(await launch(t), started);
  page.on("dialog", dialog => dialog.accept());
  await started.stop("SIGKILL");
  await type(page, LARGER);
  await kept(page);
  started.write(NEARER);
  const again = await serve(started.file, { port: new URL(started.address).port });
  t.after(() => again.stop());
  await page.reload();
  await offered(page);
  await choose(page, "Restore");
  await page.goto(again.address);
  await finished(page);
  assert.equal(await text(page), LARGER);
  assert.equal(await page.textContent("#file-state"), "not saved");
  assert.ok(await page.isHidden("#draft-bar"));
  await page.keyboard.press("Control+s");
  await page.waitForSelector("#conflict-dialog[open]");
  assert.equal(started.text(), NEARER);
});

test("reloading offers the draft; Forget deletes it, and so does Undo back to the file", async t => {
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

for (const [name, go] of [
  ["New", page => menu(page, "File", "#new")],
  ["an example", page => menu(page, "File", "text='farther is smaller'")],
  ["a file of this computer", (page, { folder }) => {
    writeFileSync(path.join(folder, "other.scn"), NEARER);
    return openFile(page, path.join(folder, "other.scn"));
  }],
]) {
  test(`an unsaved text is offered when ${name} replaces it, also after a reload`, async t => {
    const started = await host(t);
    const page = await open(await launch(t), started);
    page.on("dialog", dialog => dialog.accept());
    await andFinished(page, () => type(page, LARGER));
    await andFinished(page, () => go(page, started));
    await offered(page);
    // The new scene is changed, so that it has a draft, too.
    await type(page, `${NEARER}// on\n`);
    await kept(page);
    await page.reload();
    await finished(page);
    await offered(page);
    const texts = [];
    for (let i = 0; i < 2; i++) {
      await andFinished(page, () => choose(page, "Restore"));
      texts.push(await text(page));
      await andFinished(page, () => page.keyboard.press("Control+z"));
    }
    assert.deepEqual(texts.sort(), [LARGER, `${NEARER}// on\n`].sort());
    // Both drafts were restored and undone, so both are still offered.
    await kept(page);
    await page.reload();
    await finished(page);
    await offered(page);
    assert.equal(await page.locator("#draft-choices li").count(), 2);
    assert.equal(started.text(), FIGURE);
  });
}

test("drafts are stored while a number is playing", async t => {
  const started = await host(t, FIGURE.replace(/^/, "let r = 1  // [0.5:0.25:2]\n").replace("radius 1", "radius r"));
  const page = await open(await launch(t), started);
  page.on("dialog", dialog => dialog.accept());
  await type(page, `${started.text()}// mine\n`);
  await page.waitForSelector("#sliders:not([hidden])");
  await page.click('[aria-label="Play r"]');
  await kept(page);
  await started.stop("SIGKILL");
  await leave(page);
  const again = await serve(started.file);
  t.after(() => again.stop());
  const other = await open(await launch(t), again);
  await offered(other);
  await andFinished(other, () => choose(other, "Restore"));
  assert.match(await text(other), /\/\/ mine/);
});

test("saving a draft over a newer file asks first", async t => {
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
  assert.match(await other.textContent("#draft-choices"), /^scene\.scn, of .*, \d+ lines.*The file holds something else/);
  await andFinished(other, () => choose(other, "Restore"));
  await other.keyboard.press("Control+s");
  await other.waitForSelector("#conflict-dialog[open]");
  assert.equal(started.text(), NEARER);
});

test("Restore in a lesson restores the user's own scene, and leaving the page in a lesson asks about it", async t => {
  const started = await host(t);
  const page = await open(await launch(t), started);
  const lesson = () => andFinished(page, async () => {
    await page.click("#lessons");
    await page.click("#lesson-body li:nth-child(1) button");
  });
  await andFinished(page, () => type(page, LARGER));
  await lesson();
  await kept(page);
  // The lesson's scene is unchanged, but the user's own text is unsaved.
  const [asked] = await Promise.all([page.waitForEvent("dialog", { timeout: 5000 }), page.reload({ timeout: 5000 }).catch(() => {})]);
  assert.equal(asked.type(), "beforeunload");
  await asked.accept();
  await page.goto(new URL(page.url()).origin);
  await finished(page);
  await offered(page);
  assert.equal(await text(page), FIGURE);
  await lesson();
  await andFinished(page, () => choose(page, "Restore"));
  assert.ok(await page.isHidden("#lesson"));
  assert.equal(await text(page), LARGER);
  assert.equal(await page.textContent("#file-name"), "scene.scn");
  await page.keyboard.press("Control+s");
  await page.waitForFunction(() => document.querySelector("#file-state").textContent === "");
  assert.equal(started.text(), LARGER);
});

test("drafts are readable only by their user", async t => {
  const page = await open(await launch(t), await host(t));
  await andFinished(page, () => type(page, LARGER));
  await kept(page);
  const folder = path.join(STATE, "pinhole", "drafts");
  assert.ok(readdirSync(folder).length > 0);
  const { statSync } = await import("node:fs");
  assert.equal(statSync(folder).mode & 0o77, 0);
});

test("a stopped host is reported after two seconds, and Save says that nothing is saved", async t => {
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

test("the message of a failed save disappears when the host is back", async t => {
  const started = await host(t);
  const page = await open(await launch(t), started);
  await started.stop();
  await page.waitForSelector("#connection-bar:not([hidden])");
  await page.keyboard.press("Control+s");
  await page.waitForFunction(() => /Nothing was saved/.test(document.querySelector("#said").textContent));
  const again = await serve(started.file, { port: new URL(started.address).port });
  t.after(() => again.stop());
  await page.evaluate(address => (location.hash = new URL(address).hash), again.address);
  await page.waitForSelector("#connection-bar", { state: "hidden" });
  await page.waitForFunction(() => document.querySelector("#said").textContent === "");
});

test("without an answering host, the page makes no claim about problems", async t => {
  const started = await host(t);
  const page = await open(await launch(t), started);
  const foot = () => page.locator("footer").innerText();
  for (const [found, act] of [[/No problems/, () => {}], [/1 problem/, () => type(page, FIGURE.replace("radius 1", "radios 1"))]]) {
    await act();
    await page.waitForFunction(found => new RegExp(found).test(document.querySelector("footer").innerText), found.source);
    process.kill(started.pid, "SIGSTOP");
    await page.waitForSelector("#unjudged", { state: "visible", timeout: 4000 });
    assert.doesNotMatch(await foot(), found);
    assert.ok(await page.isHidden("#problem-list"));
    process.kill(started.pid, "SIGCONT");
    await page.waitForSelector("#unjudged", { state: "hidden", timeout: 4000 });
    assert.match(await foot(), found);
  }
  await started.stop("SIGKILL");
  await page.waitForSelector("#unjudged", { state: "visible" });
  assert.ok(await page.isHidden("#problem-list"));
});

test("two pages of a host store a draft each, and both are offered", async t => {
  const started = await host(t);
  const browser = await launch(t);
  const pages = [await open(browser, started), await open(browser, started)];
  await andFinished(pages[0], () => type(pages[0], LARGER));
  await andFinished(pages[1], () => type(pages[1], NEARER));
  await kept(pages[1]);
  await andFinished(pages[0], () => type(pages[0], `${LARGER}// on\n`));
  await kept(pages[0]);
  await started.stop("SIGKILL");
  for (const page of pages) await leave(page);
  const again = await serve(started.file);
  t.after(() => again.stop());
  const page = await open(browser, again);
  await offered(page);
  const texts = await restoredInTurn(page, 2);
  assert.deepEqual(texts, [`${LARGER}// on\n`, NEARER]);
});

test("a text saved while it is replaced, or restored by Undo, is not offered", async t => {
  const started = await host(t);
  const page = await open(await launch(t), started);
  await andFinished(page, () => type(page, LARGER));
  // The answer to Save arrives after the scene is replaced.
  process.kill(started.pid, "SIGSTOP");
  await page.keyboard.press("Control+s");
  await menu(page, "File", "#new");
  await offered(page);
  process.kill(started.pid, "SIGCONT");
  await page.waitForFunction(() => document.querySelector("#draft-bar").hidden);
  assert.equal(started.text(), LARGER);
  await andFinished(page, () => page.keyboard.press("Control+z"));
  assert.equal(await text(page), LARGER);
  await andFinished(page, () => type(page, NEARER));
  await menu(page, "File", "#new");
  await offered(page);
  await andFinished(page, () => page.keyboard.press("Control+z"));
  assert.equal(await text(page), NEARER);
  await page.waitForFunction(() => document.querySelector("#draft-bar").hidden);
  // The text is still stored as a draft of the scene that it belongs to.
  await kept(page);
  page.on("dialog", dialog => dialog.accept());
  await page.reload();
  await offered(page);
  assert.equal(await page.locator("#draft-choices li").count(), 1);
});
