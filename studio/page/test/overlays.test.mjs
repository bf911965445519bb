// Tests of the drawings over the picture: outlines, vanishing points and other layers.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { andFinished, choose, drag, FIGURE, host, launch, onPage, open } from "./helpers.mjs";

const BOXES = readFileSync(new URL("../../../examples/three_vanishing_points.scn", import.meta.url), "utf8");

const show = async (page, layer) => {
  await page.click("summary:text('Show')");
  await page.check(`input[name=${layer}]`);
  await page.keyboard.press("Escape");
};

/** Returns the labels of the vanishing points. */
const marked = page => page.locator("#lines text").allTextContents();

test("lines of boxes meet at the vanishing points, which follow the camera", async t => {
  const page = await open(await launch(t), await host(t, BOXES));
  await show(page, "vanishing");
  await page.waitForSelector("#lines .axis-x");
  const marks = (await marked(page)).map(it => /^([xyz]) \(-?\d+, -?\d+\)$/.exec(it)?.[1] ?? it);
  assert.deepEqual(marks.sort(), ["x", "y", "z"]);
  const place = () => page.getAttribute("#lines text.axis-z", "x");
  const before = await place();
  await choose(page, "orbit");
  await andFinished(page, () => drag(page, [400, 300], [450, 300]));
  assert.notEqual(await place(), before);
  // The chosen layers are remembered.
  await page.reload();
  await page.waitForSelector("#lines .axis-x");
});

test("horizon, view axis, near and far are drawn at their positions", async t => {
  const page = await open(await launch(t), await host(t, FIGURE.replace("d      2.75", "d      2.75\n  near   6\n  far    30")));
  for (const layer of ["horizon", "axis", "near"]) await show(page, layer);
  for (const line of ["horizon", "view-axis", "near", "far"]) await page.waitForSelector(`#lines path.${line}`, { state: "attached" });
  const middle = await onPage(page, [640, 360]);
  const box = await page.locator("#lines path.view-axis").last().boundingBox();
  assert.ok(Math.hypot(box.x + box.width / 2 - middle[0], box.y + box.height / 2 - middle[1]) < 1);
});

test("zooming in shows pixels as squares", async t => {
  const page = await open(await launch(t), await host(t));
  await page.mouse.move(...(await onPage(page, [640, 360])));
  for (let i = 0; i < 12; i++) await page.mouse.wheel(0, -150);
  await page.waitForFunction(() => document.querySelector("#canvas").style.imageRendering === "pixelated");
});
