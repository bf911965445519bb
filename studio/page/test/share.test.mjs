// Tests of links that contain a scene, and of downloads.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { andFinished, FIGURE, finished, host, launch, link, open, rendered, text, type } from "./helpers.mjs";

test("a link contains the scene and causes no other request", async t => {
  const browser = await launch(t);
  const started = await host(t);
  const page = await open(browser, started);
  const scene = FIGURE.replace("A ball", "Ein Bällchen 🎱");
  await andFinished(page, () => type(page, scene));
  const requests = [];
  page.on("request", request => requests.push(request.url()));
  const address = await link(page);
  assert.deepEqual(requests, []);
  assert.ok(address.startsWith(`${new URL(started.address).origin}/#scene=`), address);
  const other = await page.context().newPage();
  const { hash } = new URL(started.address);
  await other.goto(`${address}&${hash.slice(1)}`);
  await other.waitForFunction(() => document.querySelector("canvas").dataset.fineness === "final");
  assert.equal(await text(other), scene);
  // The file is not changed, and Undo restores its text.
  assert.equal(started.text(), FIGURE);
  await other.click(".cm-content");
  await other.keyboard.press("Control+z");
  assert.equal(await text(other), FIGURE);
  // Save asks for a name instead of writing to the host's file.
  await other.keyboard.press("Control+y");
  await other.click("#save");
  await other.waitForSelector("#name-dialog[open]");
  await other.keyboard.press("Escape");
  assert.equal(started.text(), FIGURE);
  // The link stays in the address, and reloading opens it again.
  assert.equal(other.url(), address);
  await other.reload();
  await finished(other);
  assert.equal(await text(other), scene);
});

test("a link opened without a connection shows its scene and continues with the printed address", async t => {
  const browser = await launch(t);
  const started = await host(t);
  const page = await open(browser, started);
  const scene = FIGURE.replace("radius 1", "radius 1.5");
  await andFinished(page, () => type(page, scene));
  const address = await link(page);
  const other = await page.context().newPage();
  await other.goto(address);
  await other.waitForFunction(() => /no token/.test(document.querySelector("#connection").textContent));
  await other.waitForSelector("#stale:not([hidden])");
  assert.equal(await text(other), scene);
  assert.match(await other.textContent("#stale"), /no picture/);
  assert.ok(await other.isVisible("#connection-download"));
  await other.goto(started.address);
  await finished(other);
  assert.equal(await text(other), scene);
  assert.ok(await other.isHidden("#stale"));
  assert.equal(started.text(), FIGURE);
});

test("a link pasted into an open page loads its scene", async t => {
  const page = await open(await launch(t), await host(t));
  const scene = FIGURE.replace("radius 1", "radius 1.5");
  await type(page, scene);
  const address = await link(page);
  await page.click("#share-dialog >> text=Close");
  await page.keyboard.press("Control+z");
  assert.equal(await text(page), FIGURE);
  await andFinished(page, () => page.goto(address));
  assert.equal(await text(page), scene);
});

test("a damaged link is reported", async t => {
  const started = await host(t);
  const page = await open(await launch(t), started);
  await page.goto("about:blank");
  await page.goto(`${new URL(started.address).origin}/#scene=!!`);
  await page.waitForFunction(() => /damaged/.test(document.querySelector("#said").textContent));
  await finished(page);
  assert.equal(await text(page), FIGURE);
});

for (const [kind, id] of [["png", "#download-png"], ["exr", "#download-exr"], ["scn", "#download-scene"]]) {
  test(`the download as ${kind} equals the program's file`, async t => {
    const started = await host(t);
    const page = await open(await launch(t), started);
    await page.click("text=Download");
    const [download] = await Promise.all([page.waitForEvent("download"), page.click(id)]);
    assert.equal(download.suggestedFilename(), `scene.${kind}`);
    const bytes = readFileSync(await download.path());
    const expected = kind === "scn" ? Buffer.from(FIGURE) : rendered(started.folder, FIGURE, kind);
    assert.ok(bytes.equals(expected), `${bytes.length} bytes instead of ${expected.length}, or others`);
  });
}
