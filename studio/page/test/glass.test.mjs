// Tests of the glass: one pixel enlarged, its samples, its exact colour, and its errors.

import assert from "node:assert/strict";
import { test } from "node:test";
import { host, launch, onPage, open } from "./helpers.mjs";

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
  // What stands in the table for the exact picture adds up.
  const shares = (await rows(page)).map(row => /([\d.]+) %$/.exec(row)?.[1]).filter(it => it !== undefined);
  assert.ok(Math.abs(shares.reduce((sum, it) => sum + Number(it), 0) - 100) < 0.3, String(shares));
  // The pixel is marked in the picture, and a click still selects.
  await page.waitForSelector("#lines .pinned", { state: "attached" });
  await page.mouse.click(...(await onPage(page, [160, 80])));
  await page.waitForFunction(() => document.querySelector("#objects").selectedOptions[0].textContent.includes("Ball"));
  assert.equal(await page.textContent("#glass-pixel"), "129, 85");
  // Another pixel takes its place; the same one, a second time, hides the glass.
  await pin(page, [200.5, 81.5]);
  await page.waitForFunction(() => document.querySelector("#glass-pixel").textContent === "200, 81");
  await page.keyboard.press("g");
  await page.waitForSelector("#glass", { state: "hidden" });
  assert.equal(await page.locator("#lines .pinned").count(), 0);
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
  // Five numbers of samples have a dot each, of this seed.
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
    // Only once: the setting is forgotten.
    await page.reload();
    await page.waitForSelector("#canvas[data-fineness=final]");
    assert.ok(await page.locator("#glass").isHidden());
  }
});
