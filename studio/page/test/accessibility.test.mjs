// Tests of accessibility: axe checks the rules of WCAG AA in both themes, on a phone and on a
// desktop. Other tests check the keyboard, screen readers, printing, and small screens.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { test } from "node:test";
import { andFinished, FIGURE, host, launch, open, rested, tab, type } from "./helpers.mjs";

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
    test(`axe finds no violations: ${colorScheme}, ${width} px`, async t => {
      const page = await open(await launch(t), await host(t), { colorScheme, viewport: { width, height: 760 }, reducedMotion: "reduce" });
      // The page's content security policy forbids other scripts, so axe is run through the
      // debugger.
      await page.evaluate(axe);
      await tab(page, "text");
      await page.waitForSelector(".hint");
      await audit(page, "with the text");
      await tab(page, "picture");
      await audit(page, "with the picture");
      assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "nothing is wider than the page");
      for (const label of ["Sail (triangle)", "Crate (box)", "checkerboard (19)", "Ball (sphere)"]) {
        await page.selectOption("#objects", { label });
        await page.waitForSelector(`.handle[aria-label^="${label.split(" ")[0]}"]`);
        await audit(page, `with ${label} selected`);
      }
      await page.click("summary:text('Show')");
      await audit(page, "with handles and a menu");
      await page.keyboard.press("Escape");
      await page.focus("#stage");
      await page.keyboard.press("b");
      await page.waitForSelector("#undo", { state: "hidden" });
      await audit(page, "with the large page");
      await page.keyboard.press("b");
      await page.click("#share");
      await audit(page, "with the share dialog");
      await page.click("#share-dialog >> text=Close");
      {
        await page.click("summary:text('Help')");
        await page.click("#keys");
        await audit(page, "with the list of keys");
        await page.click("#keys-dialog >> text=Close");
      }
      await page.click("#lessons");
      await tab(page, "text");
      await audit(page, "with the list of lessons");
      await page.click("#lesson-body li:nth-child(2) button");
      for (let i = 0; i < 3; i++) await page.click("#lesson-next");
      await page.waitForSelector(".conditions .holds");
      await audit(page, "with a lesson");
      await page.click("#lesson-close");
      await type(page, FIGURE.replace("radius 1", "radios 1"));
      await tab(page, "picture");
      await page.waitForSelector("#stale:not([hidden])");
      await page.click("#problems");
      await page.waitForSelector("#problem-list li");
      await audit(page, "with an error");
    });
  }
}

test("Tab reaches the picture from the text in three stops, and Alt-Enter opens the colour picker", async t => {
  const page = await open(await launch(t), await host(t));
  await page.waitForSelector(".swatch");
  const line = page.locator(".cm-line", { hasText: "sphere" });
  await line.click();
  let stops = 0;
  while ((await page.evaluate(() => document.activeElement.id)) !== "stage") {
    await page.keyboard.press("Tab");
    assert.ok(++stops <= 3, `${stops} stops`);
  }
  await line.click();
  for (let i = 0; i < 2; i++) await page.keyboard.press("End");
  for (let i = 0; i < 4; i++) await page.keyboard.press("ArrowLeft");
  await page.keyboard.press("Alt+Enter");
  assert.equal(await page.evaluate(() => document.activeElement.ariaLabel), "Colour olive");
});

test("screen readers get a description of the picture and of its changes", async t => {
  const page = await open(await launch(t), await host(t));
  const seen = pattern => page.waitForFunction(pattern => new RegExp(pattern).test(document.querySelector("canvas").ariaLabel), pattern);
  await seen("^Ball, Sail, Crate, checkerboard: middle centre$");
  assert.equal(await page.textContent("#seen"), "");
  await andFinished(page, () => type(page, FIGURE.replace("(-1.6, 1, 0)", "(-3.6, 1, 0)")));
  await seen("^Ball: middle left");
  assert.match(await page.textContent("#seen"), /^Ball: middle left/);
});

test("the printed page has the picture and the whole text", async t => {
  const long = `${FIGURE}${Array.from({ length: 200 }, (_, i) => `// line ${i}`).join("\n")}`;
  const page = await open(await launch(t), await host(t, long));
  await page.evaluate(() => dispatchEvent(new Event("beforeprint")));
  await page.emulateMedia({ media: "print" });
  await rested(page);
  for (const hidden of ["header", "footer", ".tools", "#text-pane"]) assert.ok(await page.isHidden(hidden), hidden);
  for (const shown of ["canvas", "#print-text"]) assert.ok(await page.isVisible(shown), shown);
  const printed = await page.textContent("#print-text");
  assert.match(printed, /^scene\.scn, .*\d/);
  assert.ok(printed.includes(FIGURE) && printed.endsWith("// line 199"));
  const pdf = await page.pdf();
  assert.ok((pdf.toString("latin1").match(/\/Type\s*\/Page\b/g) ?? []).length >= 3, "several pages");
});

for (const [width, height, least] of [[640, 400, 0.4], [390, 844, 0.9], [844, 390, 0.3], [820, 1180, 0.9]]) {
  test(`every control is reachable at ${width} × ${height}, and the picture is large`, async t => {
    const page = await open(await launch(t), await host(t), { viewport: { width, height } });
    await page.selectOption("#objects", { label: "Ball (sphere)" });
    for (const id of ["#undo", "#save", "#share", "summary:text('Help')", "#objects", "#along", "#zoom-in", "#zoom-actual", "#problems", "#theme"]) {
      const { x, y, width: wide, height: high } = await page.locator(id).evaluate(it => {
        it.scrollIntoView({ block: "nearest", inline: "nearest" });
        const box = it.getBoundingClientRect();
        const found = document.elementFromPoint(box.x + box.width / 2, box.y + box.height / 2);
        return { ...box.toJSON(), width: it.contains(found) ? box.width : 0 };
      });
      assert.ok(wide > 0 && x >= 0 && y >= 0 && x + wide <= width + 1 && y + high <= height + 1, id);
    }
    await page.click("#zoom-fit");
    const shown = await page.evaluate(() => document.querySelector("canvas").getBoundingClientRect().width);
    assert.ok(shown >= least * width, `${shown}`);
    await type(page, FIGURE.replace("radius 1", "radios 1"));
    await tab(page, "picture");
    await page.waitForSelector("#stale:not([hidden])");
    const [note, stage] = await page.evaluate(() => ["#stale", "#stage"].map(it => document.querySelector(it).getBoundingClientRect().height));
    assert.ok(note <= 0.26 * stage + 2, `${note} of ${stage}`);
  });
}
