// Tests of the glass: one pixel enlarged, its samples, its exact colour, and its errors.

import assert from "node:assert/strict";
import { test } from "node:test";
import { host, launch, onPage, open, rested } from "./helpers.mjs";

const SCENE = `image { width 320 height 180 }
camera { eye (0, 1, 6) lookat (0, 0.8, 0) }
sphere Ball { center (0, 1, 0) radius 1 color olive }
checkerboard {}
`;
/** A pixel at the left edge of the sphere. */
const EDGE = [129.5, 85.5];

const pin = async (page, at) => {
  await page.mouse.move(...(await onPage(page, at)));
  await page.keyboard.press("g");
};
const points = page => page.locator("#glass-points circle").count();
const rows = page => page.locator("#glass-table tr").allTextContents();

test("g puts the pixel under the pointer under the glass, and takes it away", async t => {
  const page = await open(await launch(t), await host(t, SCENE));
  await page.locator("#stage").focus();
  await pin(page, EDGE);
  await page.waitForSelector("#glass-points circle");
  assert.equal(await page.textContent("#glass-pixel"), "129, 85");
  assert.equal(await points(page), 16);
  assert.match((await rows(page)).join("\n"), /Ball\d/);
  // The exact fractions of the pixel in the table add up to 100 %.
  const shares = (await rows(page)).map(row => /([\d.]+) %$/.exec(row)?.[1]).filter(it => it !== undefined);
  assert.ok(Math.abs(shares.reduce((sum, it) => sum + Number(it), 0) - 100) < 0.3, String(shares));
  // The pixel is marked in the picture, and a click still selects.
  await page.waitForSelector("#lines .pinned", { state: "attached" });
  await page.mouse.click(...(await onPage(page, [160, 80])));
  await page.waitForFunction(() => document.querySelector("#objects").selectedOptions[0].textContent.includes("Ball"));
  assert.equal(await page.textContent("#glass-pixel"), "129, 85");
  // With the pointer on another pixel, the key shows that pixel. With the pointer on the same pixel
  // again, it hides the glass.
  await pin(page, [200.5, 81.5]);
  await page.waitForFunction(() => document.querySelector("#glass-pixel").textContent === "200, 81");
  await page.keyboard.press("g");
  await page.waitForSelector("#glass", { state: "hidden" });
  assert.equal(await page.locator("#lines .pinned").count(), 0);
});

test("the glass and its buttons are within the page, also on a projector", async t => {
  const page = await open(await launch(t), await host(t), { viewport: { width: 1280, height: 720 } });
  await page.mouse.move(900, 300);
  await page.keyboard.press("g");
  await page.waitForSelector("#glass-points circle");
  for (const key of ["", "b"]) {
    if (key) await page.keyboard.press(key);
    const [scrolled, width] = await page.locator("#glass").evaluate(it => [it.scrollWidth, it.clientWidth]);
    assert.ok(scrolled <= width, `${key}: ${scrolled} of ${width}`);
    const { x, width: own } = await page.locator("#glass button").first().boundingBox();
    assert.ok(x + own <= 1280, key);
  }
});

test("the glass begins with the scene's own method and number of samples", async t => {
  const served = await host(t, `${SCENE}sampler { method random per_pixel 5 }\n`);
  const page = await open(await launch(t), served);
  await page.locator("#stage").focus();
  await pin(page, EDGE);
  await page.waitForSelector("#glass-points circle");
  assert.equal(await points(page), 5);
  assert.equal(await page.textContent("#glass-chart text.chosen"), "random");
  // The scene has five samples per pixel. In the list, the next larger number is 16, and the next
  // smaller one is 4.
  await page.keyboard.press(".");
  await page.waitForFunction(() => document.querySelectorAll("#glass-points circle").length === 16);
  await page.selectOption("#glass-count", "as the scene");
  await page.waitForFunction(() => document.querySelectorAll("#glass-points circle").length === 5);
  await page.keyboard.press("Escape");
  await page.locator("#stage").focus();
  await page.keyboard.press(",");
  await page.waitForFunction(() => document.querySelectorAll("#glass-points circle").length === 4);
});

test("a key changes the method, and another the number of samples", async t => {
  const page = await open(await launch(t), await host(t, SCENE));
  await page.locator("#stage").focus();
  await pin(page, EDGE);
  await page.waitForSelector("#glass-points circle");
  const chosen = () => page.textContent("#glass-chart text.chosen");
  const before = await chosen();
  await page.keyboard.press("n");
  await page.waitForFunction(before => document.querySelector("#glass-chart text.chosen").textContent !== before, before);
  assert.equal(await page.inputValue("#glass-method"), await chosen());
  await page.keyboard.press(".");
  await page.waitForFunction(() => document.querySelectorAll("#glass-points circle").length === 64);
  for (let i = 0; i < 5; i++) await page.keyboard.press(",");
  await page.waitForFunction(() => document.querySelectorAll("#glass-points circle").length === 1);
  // For each of the five numbers of samples, a dot in the chart shows the error with the scene's
  // seed.
  assert.equal(await page.locator("#glass-chart .own").count(), 5);
});

test("the glass follows the text, and says when it has errors", async t => {
  const served = await host(t, SCENE);
  const page = await open(await launch(t), served);
  await page.locator("#stage").focus();
  await pin(page, EDGE);
  await page.waitForSelector("#glass-points circle");
  served.write(SCENE.replace("olive", "red"));
  await page.waitForFunction(() => document.querySelector("#glass-points circle[fill='#ff0000']") !== null);
  served.write(SCENE.replace("sphere", "spheer"));
  await page.waitForFunction(() => document.querySelector("#glass-note").textContent === "The text has errors.");
});

test("layers of earlier versions open the glass instead", async t => {
  const browser = await launch(t);
  const page = await open(browser, await host(t, SCENE));
  for (const layers of ["samples", "vanishing grid"]) {
    await page.evaluate(layers => localStorage.setItem("pinhole-layers", layers), layers);
    await page.reload();
    await page.waitForSelector("#glass-points circle");
    assert.equal(await page.textContent("#glass-pixel"), "160, 90");
    // The old setting opens the glass only once. It is removed then.
    await page.reload();
    await page.waitForSelector("#canvas[data-fineness=final]");
    assert.ok(await page.locator("#glass").isHidden());
  }
});

test("the keys of the glass do nothing while it is closed, and a message about it goes", async t => {
  const page = await open(await launch(t), await host(t, SCENE));
  await page.locator("#stage").focus();
  await pin(page, [-3, 60]);
  await page.waitForFunction(() => /Point at a pixel/.test(document.querySelector("#said").textContent));
  await pin(page, EDGE);
  await page.waitForSelector("#glass-points circle");
  assert.equal(await page.textContent("#said"), "");
  // Now the lists of the closed glass have entries. Even so, its keys do nothing.
  await page.keyboard.press("g");
  await page.waitForSelector("#glass", { state: "hidden" });
  for (const key of ["n", "n", ".", "."]) await page.keyboard.press(key);
  await pin(page, EDGE);
  await page.waitForSelector("#glass-points circle");
  for (const id of ["#glass-method", "#glass-count"]) assert.equal(await page.locator(id).inputValue(), "as the scene");
});

test("at 1280 × 720, the table of the glass is seen as a whole", async t => {
  const page = await open(await launch(t), await host(t, SCENE), { viewport: { width: 1280, height: 720 } });
  await page.locator("#stage").focus();
  await pin(page, EDGE);
  await page.waitForSelector("#glass-points circle");
  await rested(page);
  const { bottom, error } = await page.evaluate(() => ({ bottom: document.querySelector("#glass").getBoundingClientRect().bottom, error: document.querySelector("#glass-error").getBoundingClientRect() }));
  assert.ok(error.height > 0 && error.bottom <= bottom, `${error.bottom} of ${bottom}`);
});

test("the glass tells why it has no answer, and keeps no verdict of another text", async t => {
  const served = await host(t, `image { width 1 height 1 }\ncamera { eye (0, 1, 6) lookat (0, 0.8, 0) }\nsampler { per_pixel 4 }\ncheckerboard {}\n`);
  const page = await open(await launch(t), served);
  await page.locator("#stage").focus();
  await pin(page, [0.5, 0.5]);
  await page.waitForSelector("#glass-points circle");
  assert.ok(await page.isVisible("#glass-error"));
  const says = note => page.waitForFunction(note => new RegExp(note).test(document.querySelector("#glass-note").textContent), note);
  served.write(served.text().replace("camera", "camra"));
  await says("The text has errors");
  assert.ok(await page.isHidden("#glass-error"));
  served.write(served.text().replace("camra", "camera").replace("per_pixel 4", "per_pixel 1048577"));
  await says("1048577 samples of a pixel would take too long");
  served.write(served.text().replace("1048577", "9"));
  await says("^$");
  assert.ok(await page.isVisible("#glass-error"));
  await served.stop();
  await says("without a connection");
});

test("colours beyond those of the table are one row, and the rows add up", async t => {
  const colors = ["red", "lime", "blue", "yellow", "aqua", "fuchsia"];
  const stripes = colors.map((color, i) => `box { min (${-3 + i}, -9, -1) max (${-2 + i}, 9, 0) color ${color} }`).join("\n");
  const page = await open(await launch(t), await host(t, `image { width 1 height 1 }\ncamera { eye (0, 0, 6) lookat (0, 0, 0) }\n${stripes}\n`));
  await page.locator("#stage").focus();
  await pin(page, [0.5, 0.5]);
  await page.waitForSelector("#glass-points circle");
  const found = (await rows(page)).slice(0, -1);
  assert.equal(found.length, 4);
  assert.match(found[3], /^[3-9] others/);
  for (const column of [0, 1]) {
    const sum = found.reduce((sum, row) => sum + Number(row.match(/\d+\.\d(?= %)/g)[column]), 0);
    assert.ok(Math.abs(sum - 100) < 0.3, `${sum} of ${found}`);
  }
});

for (const [width, height] of [[1280, 720], [1024, 768]]) {
  test(`on the large page of ${width} × ${height}, nothing of the glass is cut off, and its lists are told apart`, async t => {
    const page = await open(await launch(t), await host(t), { viewport: { width, height } });
    await page.locator("#stage").focus();
    await page.keyboard.press("b");
    await rested(page);
    await pin(page, [455, 370]);
    await page.waitForSelector("#glass-points circle");
    await rested(page);
    const found = await page.evaluate(() => ({
      glass: document.querySelector("#glass").getBoundingClientRect().toJSON(),
      parts: ["#glass table", "#glass-error", "#glass-chart"].map(it => document.querySelector(it).getBoundingClientRect().toJSON()),
      lists: ["#glass-method", "#glass-count"].map(it => document.querySelector(it).selectedOptions[0].text),
    }));
    for (const { right, bottom } of found.parts) assert.ok(right <= found.glass.right && bottom <= Math.min(height, found.glass.bottom) + 1, JSON.stringify(found));
    assert.deepEqual(found.lists, ["method: scene's", "samples: scene's"]);
    const title = page.locator("#outside-part .dock-tools span");
    assert.ok(await title.isHidden() || await title.evaluate(it => it.scrollWidth <= it.clientWidth), "the title is whole, or not there");
  });
}
