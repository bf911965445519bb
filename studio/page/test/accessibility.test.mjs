// The page as people of all kinds meet it: an audit of WCAG AA by axe, in both themes, on a telephone and a desk.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { test } from "node:test";
import { FIGURE, host, launch, open, type } from "./helpers.mjs";

const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const TAGS = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"];

async function audit(page, where) {
  const violations = await page.evaluate(async tags => {
    const { violations } = await window.axe.run(document, { runOnly: { type: "tag", values: tags } });
    return violations.map(({ id, nodes }) => `${id}: ${nodes.map(node => `${node.html.slice(0, 160)} (${node.failureSummary})`).join("\n")}`);
  }, TAGS);
  assert.deepEqual(violations, [], where);
}

for (const colorScheme of ["dark", "light"]) {
  for (const width of [380, 1280]) {
    test(`no violations: ${colorScheme}, ${width} px`, async t => {
      const page = await open(await launch(t), await host(t), { colorScheme, viewport: { width, height: 760 }, reducedMotion: "reduce" });
      // The policy of the page keeps scripts of others out: this one comes by the debugger.
      await page.evaluate(axe);
      await page.waitForSelector(".hint");
      await audit(page, "at first");
      assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "nothing is wider than the page");
      for (const label of ["Sail (triangle)", "Crate (box)", "checkerboard (19)", "Ball (sphere)"]) {
        await page.selectOption("#objects", { label });
        await page.waitForSelector(`.handle[aria-label^="${label.split(" ")[0]}"]`);
        await audit(page, `with ${label} selected`);
      }
      await page.click("summary:text('Show')");
      await audit(page, "with handles and a menu");
      await page.keyboard.press("Escape");
      await page.click("#share");
      await audit(page, "with the share dialog");
      await page.click("#share-dialog >> text=Close");
      // A telephone has no keys.
      if (width > 760) {
        await page.click("#keys");
        await audit(page, "with the list of keys");
        await page.click("#keys-dialog >> text=Close");
      }
      await type(page, FIGURE.replace("radius 1", "radios 1"));
      await page.waitForSelector("#stale:not([hidden])");
      await page.click("#problems");
      await page.waitForSelector("#problem-list li");
      await audit(page, "with an error");
    });
  }
}
