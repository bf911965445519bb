// Tests of the static page, whose engine runs in a web worker, without a host or a file. The
// environment variable SITE names the page's folder.

import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { test } from "node:test";
import { andFinished, comparing, decoded, drag, FIGURE, finished, launch, link, open, pixels, rendered, site, text, type } from "./helpers.mjs";

const skip = process.env.SITE === undefined ? "SITE names no folder" : false;

test("the static page renders, drags, downloads and links without a request", { skip }, async t => {
  const folder = mkdtempSync(path.join(tmpdir(), "pinhole-site-"));
  t.after(() => rmSync(folder, { recursive: true, force: true }));
  const host = await site(t, process.env.SITE);
  const page = await open(await launch(t), host);
  assert.equal(await text(page), FIGURE);
  const requests = host.requests.length;
  await comparing(page);
  assert.equal(await pixels(page), await decoded(page, rendered(folder, FIGURE)));
  await andFinished(page, () => drag(page, [455, 320], [600, 320]));
  const moved = await text(page);
  assert.notEqual(moved, FIGURE);
  assert.equal(await pixels(page), await decoded(page, rendered(folder, moved)));
  for (const [kind, id] of [["png", "#download-png"], ["scn", "#download-scene"]]) {
    await page.click("text=Download");
    const [download] = await Promise.all([page.waitForEvent("download"), page.click(id)]);
    const expected = kind === "scn" ? Buffer.from(moved) : rendered(folder, moved, kind);
    assert.ok(readFileSync(await download.path()).equals(expected), kind);
  }
  const address = await link(page);
  assert.deepEqual(host.requests.slice(requests), []);
  assert.deepEqual(page.complaints, []);
  const other = await page.context().newPage();
  await other.goto(address);
  await other.waitForFunction(() => document.querySelector("canvas").dataset.fineness === "final", null, { timeout: 60_000 });
  assert.equal(await text(other), moved);
});

test("the static page opens a local file", { skip }, async t => {
  const page = await open(await launch(t), await site(t, process.env.SITE));
  // Without this function, the page acts as in a browser without file pickers.
  await page.evaluate(() => (window.showOpenFilePicker = undefined));
  const scene = FIGURE.replace("radius 1", "radius 1.5");
  const [chooser] = await Promise.all([page.waitForEvent("filechooser"), page.click("summary:text('File')").then(() => page.click("#open"))]);
  await andFinished(page, () => chooser.setFiles({ name: "other.scn", mimeType: "text/plain", buffer: Buffer.from(scene) }));
  assert.equal(await text(page), scene);
  assert.equal(await page.textContent("#file-name"), "other.scn");
  assert.equal(await page.textContent("#file-state"), "");
  // Undo restores the earlier text together with its file.
  await page.click(".cm-content");
  await page.keyboard.press("Control+z");
  assert.equal(await text(page), FIGURE);
  assert.equal(await page.textContent("#file-name"), "scene.scn");
  await page.keyboard.press("Control+y");
  assert.equal(await text(page), scene);
  assert.equal(await page.textContent("#file-name"), "other.scn");
  await type(page, FIGURE);
  assert.equal(await page.textContent("#file-state"), "not saved");
  // A file in another encoding is not opened.
  const [again] = await Promise.all([page.waitForEvent("filechooser"), page.click("summary:text('File')").then(() => page.click("#open"))]);
  await again.setFiles({ name: "latin1.scn", mimeType: "text/plain", buffer: Buffer.from("// caf\xe9\n", "latin1") });
  await page.waitForFunction(() => /no text in UTF-8/.test(document.querySelector("#said").textContent));
  assert.equal(await page.textContent("#file-name"), "other.scn");
});

test("the static page waits for an engine that loads slowly", { skip }, async t => {
  const page = await (await launch(t)).newPage();
  await page.route("**/*.wasm", async route => {
    await new Promise(resolve => setTimeout(resolve, 5000));
    await route.continue();
  });
  await page.goto((await site(t, process.env.SITE)).address);
  assert.equal(await page.textContent("#connection"), "Connecting…");
  await page.waitForFunction(() => document.querySelector("canvas").dataset.fineness === "final", null, { timeout: 30_000 });
});

test("the static page stores drafts in the browser and offers them after a reload", { skip }, async t => {
  const host = await site(t, process.env.SITE);
  const page = await open(await launch(t), host);
  page.on("dialog", dialog => dialog.accept());
  const scene = FIGURE.replace("radius 1", "radius 1.5");
  await andFinished(page, () => type(page, scene));
  await page.waitForTimeout(900);
  await page.reload();
  await page.waitForSelector("#draft-bar:not([hidden])");
  assert.equal(await text(page), FIGURE);
  await andFinished(page, () => page.click("#draft-choices >> text=Restore"));
  assert.equal(await text(page), scene);
  // The restored text is stored under the key of the old draft, so only one draft is offered.
  await page.waitForTimeout(900);
  await page.reload();
  await page.waitForSelector("#draft-bar:not([hidden])");
  // While a draft is offered, the user changes the text. The changed text becomes a second draft.
  const other = FIGURE.replace("radius 1", "radius 0.5");
  await andFinished(page, () => type(page, other));
  await page.waitForTimeout(900);
  await page.reload();
  await finished(page);
  for (const kept of [other, scene]) {
    await andFinished(page, () => page.click("#draft-choices >> text=Restore"));
    assert.equal(await text(page), kept);
    await andFinished(page, () => page.keyboard.press("Control+z"));
  }
  assert.ok(await page.isHidden("#draft-bar"));
  await page.waitForTimeout(900);
  await page.reload();
  await finished(page);
  // Both drafts were restored and undone, so both are still offered, until they are deleted.
  await page.waitForSelector("#draft-bar:not([hidden])");
  for (let left = 2; left > 0; left--) {
    assert.equal(await page.locator("#draft-choices li").count(), left);
    await page.click("#draft-choices >> text=Forget");
  }
  await page.waitForTimeout(900);
  await page.reload();
  await finished(page);
  await page.waitForTimeout(900);
  assert.ok(await page.isHidden("#draft-bar"));
});
