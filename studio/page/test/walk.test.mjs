// A random sequence of actions, after which the picture must show the text, and Undo must restore
// the first text. STEPS is the number of actions; SEED selects the sequence.

import assert from "node:assert/strict";
import { test } from "node:test";
import { choose, comparing, decoded, FIGURE, hand, host, launch, onPage, open, pixels, rendered, rested, text } from "./helpers.mjs";

const SCENE = `let r = 1 // [0.5:0.1:2]\n${FIGURE.replace("radius 1", "radius r")}`;
const STEPS = Number(process.env.STEPS ?? 60);
const SEED = Number(process.env.SEED ?? 1);

test(`a random walk of ${STEPS} steps from ${SEED}`, async t => {
  let state = SEED;
  const random = () => (state = (state * 1_103_515_245 + 12_345) % 2 ** 31) / 2 ** 31;
  const one = all => all[Math.floor(random() * all.length)];
  const started = await host(t, SCENE);
  const page = await open(await launch(t), started);
  const place = () => onPage(page, [100 + 1080 * random(), 60 + 600 * random()]);
  const way = () => [Math.round(160 * random() - 80), Math.round(120 * random() - 60)];
  const steps = {
    drag: async () => hand(page, await place(), way()),
    async handle() {
      const handles = await page.locator("#handles .handle").all();
      const box = handles.length === 0 ? null : await one(handles).boundingBox();
      if (box !== null) await hand(page, [box.x + box.width / 2, box.y + box.height / 2], way());
    },
    async escape() {
      await rested(page);
      const before = await text(page);
      await hand(page, await place(), way(), { hold: true });
      await page.keyboard.press("Escape");
      await page.mouse.up();
      await rested(page);
      assert.equal(await text(page), before);
    },
    async slider() {
      await rested(page);
      const before = await text(page);
      // If the definition was removed, there is no slider.
      if (await page.isHidden(".slider-row input")) return;
      const { x, y, width, height } = await page.locator(".slider-row input").boundingBox();
      const isTaken = random() < 0.5;
      await hand(page, [x + width * random(), y + height / 2], [way()[0] / 2, 0], { hold: isTaken });
      if (!isTaken) return;
      await page.keyboard.press("Escape");
      await page.mouse.up();
      await rested(page);
      assert.equal(await text(page), before);
    },
    undo: async () => (await page.isEnabled("#undo")) && page.click("#undo"),
    redo: async () => (await page.isEnabled("#redo")) && page.click("#redo"),
    tool: () => choose(page, one(["move", "move", "orbit", "pan", "dolly", "roll", "view_distance", "look"])),
    select: async () => page.selectOption("#objects", { index: Math.floor(random() * (await page.locator("#objects option").count())) }),
    async key() {
      await page.focus("#stage");
      for (let i = 0; i < 3; i++) await page.keyboard.press(one(["ArrowLeft", "ArrowUp", "ArrowRight", "ArrowDown"]));
    },
    async type() {
      await page.locator(".cm-line").last().click();
      await page.keyboard.press("Control+End");
      await page.keyboard.type("\n// a");
    },
  };
  const names = [...Object.keys(steps), "drag", "drag", "handle"];
  const done = [];
  for (let i = 0; i < STEPS; i++) {
    done.push(one(names));
    await steps[done.at(-1)]();
    // Some actions begin before the picture of the previous one is finished.
    if (random() < 0.6) await rested(page);
    else await page.waitForTimeout(150);
  }
  // A drag by keys ends only after a pause.
  await page.waitForTimeout(800);
  await rested(page);
  const end = await text(page);
  await comparing(page);
  assert.equal(await pixels(page), await decoded(page, rendered(started.folder, end)), `${done}`);
  while (await page.isEnabled("#undo")) await page.click("#undo");
  await rested(page);
  assert.equal(await text(page), SCENE, `${done}`);
});
