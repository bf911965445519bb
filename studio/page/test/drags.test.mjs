// Tests of drags by a real pointer: a press, twelve moves at the pace of a hand, and a release.

import assert from "node:assert/strict";
import { test } from "node:test";
import { choose, FIGURE, finished, hand, handle, host, launch, onPage, open, rested, text, type } from "./helpers.mjs";

const BALL = [455, 320];

/** A scene in which the ball's centre and the camera's `lookat` are the same definition. */
const WATCHED = "let ball = (0, 1, 0)\nimage { width 640  height 360 }\ncamera { eye (0, 2, 8)  lookat ball }\nsampler { per_pixel 4 }\nsphere Ball { center ball }\n";

const select = async (page, label) => {
  await page.selectOption("#objects", { label });
  await page.waitForSelector("#handles .handle");
};

const number = (text, pattern) => Number(new RegExp(`${pattern}\\s*(-?[\\d.]+)`).exec(text)[1]);

test("consecutive drags of handles and the camera each change their own values", async t => {
  const page = await open(await launch(t), await host(t));
  await select(page, "Crate (box)");
  const drags = [["Crate: max y", [0, -40]], ["Crate: max x", [40, 0]], ["Crate: max y", [0, 30]], ["Crate: min x", [-30, 0]], ["Crate: center", [30, 0]]];
  for (const [label, by] of drags) {
    const before = await text(page);
    await hand(page, await handle(page, label), by);
    await rested(page);
    assert.notEqual(await text(page), before, `the drag of ${label} does nothing`);
  }
  for (const tool of ["orbit", "pan", "move", "orbit", "look"]) {
    await choose(page, tool);
    const before = await text(page);
    const at = tool === "move" ? await handle(page, "Crate: center") : await onPage(page, [640, 600]);
    await hand(page, at, [25, 10]);
    await rested(page);
    assert.notEqual(await text(page), before, `the drag by ${tool} does nothing`);
  }
  // Undo reverts one whole drag at a time.
  for (let i = 0; i < drags.length + 5; i++) await page.keyboard.press("Control+z");
  assert.equal(await text(page), FIGURE);
});

test("a drag depends only on its first and last point, and lists what else moves", async t => {
  const ends = new Set();
  const started = await host(t, WATCHED);
  const browser = await launch(t);
  for (const steps of [1, 6, 12, 30]) {
    const page = await open(browser, started);
    await page.waitForFunction(() => document.querySelector("#objects").options.length > 1);
    const from = await onPage(page, [320, 180]);
    await hand(page, from, [90, 0], { steps, hold: true });
    await page.waitForFunction(() => /ball|Ball/.test(document.querySelector("#drag-note").textContent));
    assert.match(await page.textContent("#drag-note"), /Ball\.center = .*also camera\.lookat/);
    await rested(page);
    await page.mouse.up();
    await page.waitForSelector("#drag-note", { state: "hidden" });
    ends.add(await text(page));
    await page.context().close();
  }
  assert.equal(ends.size, 1, [...ends].join("\n---\n"));
  assert.ok(number([...ends][0], "let ball = \\(") > 1, [...ends][0]);
});

for (const [tool, by] of [["orbit", [90, 60]], ["orbit", [0, -400]], ["look", [0, -200]], ["look", [60, 300]], ["pan", [70, 30]], ["dolly", [0, 80]], ["roll", [50, 90]], ["view_distance", [0, -90]], ["move", [80, 40]]]) {
  test(`a drag out and back leaves the text unchanged: ${tool} ${by}`, async t => {
    const page = await open(await launch(t), await host(t));
    await choose(page, tool);
    const from = await onPage(page, tool === "move" ? BALL : [900, 380]);
    await hand(page, from, by.map(it => it / 2), { steps: 6, hold: true });
    await rested(page);
    assert.notEqual(await text(page), FIGURE);
    await page.mouse.move(from[0] + by[0], from[1] + by[1], { steps: 12 });
    await page.mouse.move(...from, { steps: 12 });
    await rested(page);
    await page.mouse.up();
    await rested(page);
    assert.equal(await text(page), FIGURE);
    assert.equal(await page.textContent("#file-state"), "");
    assert.ok(await page.isDisabled("#undo"), "nothing has happened that could be undone");
  });
}

test("Escape in a drag adds nothing to Redo and keeps what was there", async t => {
  const page = await open(await launch(t), await host(t));
  assert.ok(await page.isDisabled("#undo") && (await page.isDisabled("#redo")));
  await hand(page, await onPage(page, BALL), [50, 0]);
  await rested(page);
  const first = await text(page);
  await page.click("#undo");
  assert.equal(await text(page), FIGURE);
  assert.ok(await page.isDisabled("#undo"));
  await hand(page, await onPage(page, BALL), [0, -60], { hold: true });
  await rested(page);
  await page.keyboard.press("Escape");
  await page.mouse.up();
  await rested(page);
  assert.equal(await text(page), FIGURE);
  await page.keyboard.press("Control+y");
  assert.equal(await text(page), first);
  assert.ok(await page.isDisabled("#redo"));
});

test("Escape reverts a pointer's change of a slider, a number or the divider", async t => {
  const scene = `let r = 1 // [0.5:0.25:2]\n${FIGURE.replace("radius 1", "radius r")}`;
  const page = await open(await launch(t), await host(t, scene));
  await page.waitForSelector(".slider-row");
  const middle = async selector => {
    const { x, y, width, height } = await page.locator(selector).first().boundingBox();
    return [x + width / 2, y + height / 2];
  };
  const thumb = async selector => {
    const { x, y, width, height } = await page.locator(selector).first().boundingBox();
    const part = await page.locator(selector).first().evaluate(it => (it.value - it.min) / (it.max - it.min));
    return [x + 8 + (width - 16) * part, y + height / 2];
  };
  const number = () => page.locator(".cm-line", { hasText: "eye" }).getByText("3.5");
  const around = { before: () => {}, after: () => {}, share: () => page.getAttribute("#divider", "aria-valuenow") };
  const ways = {
    "the slider of a definition": { from: () => thumb(".slider-row input") },
    "the slider of a number": { before: () => number().click(), from: () => thumb(".slider input") },
    "its grip": { before: () => number().click(), from: () => middle(".slider .grip") },
    "a number with Alt": { before: () => page.keyboard.down("Alt"), from: async () => {
      const { x, y, width, height } = await number().boundingBox();
      return [x + width / 2, y + height / 2];
    }, after: () => page.keyboard.up("Alt") },
  };
  for (const [name, given] of Object.entries(ways)) {
    const { before, from, after } = { ...around, ...given };
    await before();
    // The server may still shorten the range of the slider to valid values, which would move the
    // thumb.
    await rested(page);
    await hand(page, await from(), [40, 0], { hold: true });
    await rested(page);
    assert.notEqual(await text(page), scene, `${name} turns nothing`);
    await page.keyboard.press("Escape");
    // The pointer is moved once more before it is released, which must change nothing.
    await page.mouse.move(500, 300, { steps: 4 });
    await page.mouse.up();
    await after();
    await rested(page);
    assert.equal(await text(page), scene, name);
    assert.ok(await page.isDisabled("#undo") && (await page.isDisabled("#redo")), name);
    await page.keyboard.press("Escape");
    assert.equal(await page.inputValue(".slider-row input"), "1", name);
  }
  // After the cancelled drags, the slider can be moved again.
  await hand(page, await thumb(".slider-row input"), [60, 0]);
  await rested(page);
  assert.notEqual(await text(page), scene);
  const share = await around.share();
  await hand(page, await middle("#divider"), [80, 0], { hold: true });
  assert.notEqual(await around.share(), share);
  await page.keyboard.press("Escape");
  await page.mouse.up();
  assert.equal(await around.share(), share);
});

test("a drag's note stands at the pointer while it lasts, and the footer shows no outdated object", async t => {
  const page = await open(await launch(t), await host(t));
  const from = await onPage(page, BALL);
  await hand(page, from, [110, 0], { hold: true });
  await page.waitForSelector("#drag-note:not([hidden])");
  const { x, y } = await page.locator("#drag-note").boundingBox();
  assert.ok(Math.hypot(x - from[0] - 110, y - from[1]) < 80, `${x} ${y}`);
  assert.equal(await page.textContent("#pointed"), "");
  await page.mouse.up();
  await page.waitForSelector("#drag-note", { state: "hidden" });
  // After the drag, the footer names the object under the pointer, although the pointer rests.
  await page.waitForFunction(() => /^Ball at /.test(document.querySelector("#pointed").textContent));
  await page.keyboard.press("Control+z");
  await page.waitForFunction(() => !/^Ball at /.test(document.querySelector("#pointed").textContent));
  assert.equal(await page.textContent("#said"), "");
  await page.keyboard.press("Control+s");
  await page.waitForFunction(() => /is saved/.test(document.querySelector("#said").textContent));
  await page.click("#redo");
  assert.equal(await page.textContent("#said"), "");
});

test("a text with errors has no handles", async t => {
  const page = await open(await launch(t), await host(t));
  await select(page, "Ball (sphere)");
  await page.locator(".cm-line", { hasText: "sphere" }).click();
  await page.keyboard.press("Home");
  await page.keyboard.insertText("sphere { }\n");
  await page.waitForSelector("#stale:not([hidden])");
  await page.waitForSelector("#handles .handle", { state: "detached" });
  await page.keyboard.press("Control+z");
  await page.waitForSelector("#handles .handle");
});

test("handles at the same point are placed side by side, and each can be dragged", async t => {
  const scene = "image { width 640  height 360 }\ncamera { eye (0, 0, 6)  direction (0, 0, -1) }\nsampler { per_pixel 1 }\nbox Crate { center (0, 0, 0)  size (1, 1, 1) }\n";
  const page = await open(await launch(t), await host(t, scene));
  await page.waitForFunction(() => document.querySelector("#objects").options.length > 1);
  await select(page, "Crate (box)");
  const places = await page.locator("#handles .handle").evaluateAll(all => all.map(it => [it.dataset.handle, it.getBoundingClientRect()]));
  assert.equal(places.length, 7);
  for (const [i, [, a]] of places.entries()) {
    assert.ok(a.width >= 24 && a.height >= 24);
    for (const [, b] of places.slice(0, i)) assert.ok(Math.max(Math.abs(a.x - b.x), Math.abs(a.y - b.y)) >= 24);
  }
  // The camera looks along z, so moving a face along z would not be visible.
  for (const label of ["min x", "max x", "min y", "max y"]) {
    const before = await text(page);
    await hand(page, await handle(page, `Crate: ${label}`), [label.endsWith("x") ? 12 : 0, label.endsWith("y") ? 12 : 0]);
    await rested(page);
    assert.notEqual(await text(page), before, label);
  }
});

test("dragging a vertex onto another one is refused with a reason", async t => {
  const scene = "image { width 640  height 360 }\ncamera { eye (0, 0, 6)  direction (0, 0, -1) }\nsampler { per_pixel 1 }\ntriangle Sail { v0 (-1, -1, 0)  v1 (1, -1, 0)  v2 (0.6, 1, 0) }\n";
  const page = await open(await launch(t), await host(t, scene));
  await page.waitForFunction(() => document.querySelector("#objects").options.length > 1);
  await select(page, "Sail (triangle)");
  const [from, to] = [await handle(page, "Sail: v2"), await handle(page, "Sail: v0")];
  await hand(page, from, [to[0] - from[0], to[1] - from[1]], { hold: true });
  await page.waitForFunction(() => /line/.test(document.querySelector("#drag-note").textContent));
  await page.mouse.up();
  await rested(page);
  const [, x, y] = /v2 \((\S+), (\S+), 0\)/.exec(await text(page));
  for (const number of [x, y]) assert.ok(number.length < 9, number);
  // The note stays until the next action.
  await page.waitForTimeout(300);
  assert.ok(await page.isVisible("#drag-note"));
  await page.click("#undo");
  assert.ok(await page.isHidden("#drag-note"));
  assert.equal(await page.textContent("#drag-note"), "");
});

test("a drag faster than the server's answers still arrives", async t => {
  const page = await open(await launch(t), await host(t));
  const [x, y] = await onPage(page, BALL);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 60, y, { steps: 2 });
  await page.mouse.up();
  await rested(page);
  assert.notEqual(await text(page), FIGURE);
  await finished(page);
  // Late answers to the drag do not change a text that is typed after it.
  await type(page, WATCHED);
  await rested(page);
  assert.equal(await text(page), WATCHED);
});

test("at every window size selecting moves nothing, and objects follow the pointer", async t => {
  // The objects' blocks are far below the first lines, so selecting an object scrolls the text.
  const started = await host(t, `${"// a line\n".repeat(60)}${FIGURE}`);
  const browser = await launch(t);
  const first = await open(browser, started, { viewport: { width: 1280, height: 720 } });
  await select(first, "Ball (sphere)");
  const middle = await first.evaluate(([x, y]) => {
    const { left, top, width } = document.querySelector("canvas").getBoundingClientRect();
    return [(x - left) * 1280 / width, (y - top) * 1280 / width];
  }, await handle(first, "Ball: center"));
  const sizes = [[640, 360], [667, 375], [700, 500], [740, 360], [820, 1180], [900, 700], [1024, 600], [1024, 768], [1100, 700], [1180, 820], [1280, 720], [390, 844]];
  for (const hasTouch of [false, true]) for (const [width, height] of sizes) {
    const page = await open(browser, started, { viewport: { width, height }, hasTouch });
    const where = () => page.evaluate(() => {
      const { x, y, width, height } = document.querySelector("canvas").getBoundingClientRect();
      return [scrollX, scrollY, x, y, width, height].map(Math.round).join(" ");
    });
    const [before, at] = [await where(), await onPage(page, BALL)];
    const [dx, dy] = [27, 7];
    await hand(page, at, [dx, dy], { hold: true });
    assert.equal(await where(), before, `${width} × ${height} while it is held`);
    await page.mouse.up();
    await rested(page);
    assert.equal(await where(), before, `${width} × ${height}`);
    const [x, y] = await handle(page, "Ball: center");
    const begin = await onPage(page, middle);
    // A drag moves in steps of 8 pixels, so the object ends near the pointer, not exactly at it.
    assert.ok(Math.hypot(x - begin[0] - dx, y - begin[1] - dy) < 12, `${width} × ${height}: ${x - begin[0]}, ${y - begin[1]}`);
    // Undo removes the draft, which would otherwise be offered to the next page.
    await page.keyboard.press("Control+z");
    await rested(page);
    await page.waitForTimeout(600);
    await page.context().close();
  }
});
