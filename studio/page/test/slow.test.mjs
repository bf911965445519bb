// Tests with a slow host: drags still change the text, a note says that the page waits, and the
// last picture is finished.

import assert from "node:assert/strict";
import { test } from "node:test";
import { comparing, decoded, FIGURE, hand, handle, host, launch, onPage, open, pixels, rendered, rested, text } from "./helpers.mjs";

const LATE = 1500;
/**
 * Maximum time until the text has followed the pointer, in milliseconds. In this time, the host
 * answers two requests for edits, and the page has 1200 ms for its own work.
 */
const BEHIND = 2 * LATE + 1200;
const BALL = [455, 320];

/** Drags: each has the tool or the handle, the start, and the distance. */
const DRAGS = {
  object: { from: page => onPage(page, BALL), way: [90, -40] },
  handle: { from: page => handle(page, "Ball: center"), way: [70, 30] },
  camera: { from: page => onPage(page, [640, 100]), way: [80, 30], tool: "orbit" },
};

async function dragged(page, { from, way, tool }) {
  await page.evaluate(tool => document.querySelector(`input[name=tool][value=${tool}]`).click(), tool ?? "move");
  await hand(page, await from(page), way);
}

test("a handle arrives where it was released, however late the host answers", async t => {
  const browser = await launch(t);
  const started = await host(t);
  const late = {};
  const page = await open(browser, started, { late });
  await page.selectOption("#objects", { label: "Ball (sphere)" });
  await rested(page);
  const expected = {};
  for (const [name, drag] of Object.entries(DRAGS)) {
    await dragged(page, drag);
    await rested(page);
    expected[name] = await text(page);
    assert.notEqual(expected[name], FIGURE);
    await page.click("#undo");
    await rested(page);
  }
  for (const [name, drag] of Object.entries(DRAGS)) for (const slow of ["pinhole/drag", "pinhole/frame", "pinhole/pick"]) {
    // A drag of the ball itself, not of its handle, must select the ball, so another object is
    // selected before.
    await page.selectOption("#objects", { label: name === "object" ? "Crate (box)" : "Ball (sphere)" });
    await rested(page);
    // The text must follow in time even if pictures take much longer.
    late[slow] = slow === "pinhole/frame" ? 4 * BEHIND : LATE;
    await dragged(page, drag);
    const begin = Date.now();
    const isWaited = slow === "pinhole/drag" || (slow === "pinhole/pick" && name === "object");
    if (isWaited) await page.waitForFunction(() => document.querySelector("#drag-note").textContent === "Waiting for Studio…", null, { timeout: LATE });
    const limit = isWaited ? BEHIND : 1000;
    while ((await text(page)) !== expected[name] && Date.now() - begin < limit) await page.waitForTimeout(20);
    assert.equal(await text(page), expected[name], `${name}, late ${slow}`);
    delete late[slow];
    await page.waitForFunction(() => document.querySelector("#drag-note").hidden);
    await page.click("#undo");
    await rested(page);
    assert.equal(await text(page), FIGURE);
  }
});

test("a drag waits for earlier ones, and Escape cancels a waiting one", async t => {
  const late = {};
  const page = await open(await launch(t), await host(t), { late });
  await page.selectOption("#objects", { label: "Ball (sphere)" });
  await rested(page);
  await dragged(page, DRAGS.handle);
  await rested(page);
  await dragged(page, DRAGS.camera);
  await rested(page);
  const both = await text(page);
  for (let i = 0; i < 2; i++) await page.click("#undo");
  await rested(page);
  assert.equal(await text(page), FIGURE);
  late["pinhole/drag"] = LATE;
  // One drag is released, the next one is cancelled, and a third one follows at once.
  await dragged(page, DRAGS.handle);
  const given = await onPage(page, BALL);
  await hand(page, given, [50, 20], { hold: true });
  await page.keyboard.press("Escape");
  await page.mouse.up();
  await dragged(page, DRAGS.camera);
  const begin = Date.now();
  while ((await text(page)) !== both && Date.now() - begin < 3 * BEHIND) await page.waitForTimeout(20);
  assert.equal(await text(page), both);
  await page.waitForFunction(() => document.querySelector("#drag-note").hidden);
  for (let i = 0; i < 2; i++) await page.click("#undo");
  assert.equal(await text(page), FIGURE);
  late["pinhole/drag"] = LATE;
  await page.evaluate(() => document.querySelector("input[name=tool][value=move]").click());
  await hand(page, await handle(page, "Ball: center"), [70, 30]);
  await page.keyboard.press("Escape");
  await page.waitForTimeout(BEHIND);
  assert.equal(await text(page), FIGURE);
});

test("the last good picture of a text with errors is finished", async t => {
  const scene = FIGURE.replace(/per_pixel\s+\d+/, "per_pixel 800");
  assert.notEqual(scene, FIGURE);
  const started = await host(t, FIGURE);
  const page = await open(await launch(t), started);
  await comparing(page);
  const expected = await decoded(page, rendered(started.folder, scene));
  // After the coarse picture has arrived, the text gets an error.
  await page.evaluate(() => addEventListener("pinhole-frame", ({ target }) => (window.isBegun ||= target.id === "canvas")));
  await page.click(".cm-content", { position: { x: 2, y: 5 } });
  await page.keyboard.press("Control+a");
  await page.keyboard.insertText(scene);
  await page.waitForFunction(() => window.isBegun);
  await page.keyboard.type("x");
  await page.waitForFunction(() => /errors/.test(document.querySelector("#stale").textContent));
  assert.notEqual(await page.evaluate(() => document.querySelector("canvas").dataset.fineness), "final");
  // Further errors neither restart nor prevent the final picture of the last good text.
  await page.keyboard.type("y z", { delay: 100 });
  await page.waitForFunction(() => document.querySelector("canvas").dataset.fineness === "final", null, { timeout: 60_000 });
  assert.equal(await pixels(page), expected);
  assert.match(await page.textContent("#stale"), /last good picture/);
  await page.keyboard.press("Control+z");
  await rested(page);
  assert.ok(await page.isHidden("#stale"));
});

test("among very many objects the menu shows the selected one at once, and places once", async t => {
  const scene = "camera { eye (3, 3.5, 8)  lookat (0.2, 0.8, 0) }\nsphere Ball for j < 40, i < 40 { center (40 - i, 0.2*j - 8.8, j - 34)  radius 0.4 }\n";
  const page = await open(await launch(t), await host(t, scene), { late: { "pinhole/objects": LATE } });
  await page.waitForFunction(() => document.querySelector("#objects").options.length === 1001);
  await page.waitForTimeout(300);
  const said = await page.evaluate(() => document.querySelector("canvas").ariaLabel);
  assert.equal(said.split("in the picture").length, 2, said);
  assert.match(said, /^Ball\[0, 0\], Ball\[0, 1\].*: not in the picture; many more$/);
  await page.evaluate(() => {
    window.named = [];
    new MutationObserver(() => window.named.push(document.querySelector("#objects").selectedOptions[0]?.text)).observe(document.querySelector("#objects"), { childList: true });
  });
  await page.mouse.click(...(await onPage(page, [640, 364])));
  await page.waitForSelector("#handles .handle");
  const name = await page.evaluate(() => document.querySelector("#objects").selectedOptions[0]?.text);
  assert.match(name ?? "", /^Ball\[\d+, \d+\] \(sphere\)$/);
  assert.ok(Number(/\d+/.exec(name)[0]) >= 25, `${name} is none of the first thousand`);
  await hand(page, await onPage(page, [640, 364]), [60, 0]);
  await rested(page);
  await page.waitForTimeout(LATE + 500);
  assert.deepEqual((await page.evaluate(() => window.named)).filter(it => it === undefined), []);
});
