// Tests of the page that `grade -o` writes, opened as a local file.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { test } from "node:test";
import { FIGURE, launch } from "./helpers.mjs";

const PINHOLE = process.env.PINHOLE ?? "pinhole";
const HOSTILE = "<img src=x onerror=alert(1)>" + "x".repeat(70);

/** Makes a folder with a graded class. */
function graded(t) {
  const folder = mkdtempSync(path.join(tmpdir(), "pinhole-grade-"));
  t.after(() => rmSync(folder, { recursive: true, force: true }));
  const run = (...args) => spawnSync(PINHOLE, args, { cwd: folder });
  writeFileSync(path.join(folder, "a.scn"), FIGURE);
  const size = ["--set", "image.width=64", "--set", "image.height=36"];
  for (const [name, ...sets] of [["anna"], ["ben", "--set", "image.background=red"], ["cy", "--set", "image.background=red"], [HOSTILE, "--set", "Ball.radius=1.3"]]) {
    mkdirSync(path.join(folder, "class", name), { recursive: true });
    run("render", "a.scn", "-o", path.join("class", name, "r.png"), ...size, ...sets);
  }
  mkdirSync(path.join(folder, "class", "dora"));
  writeFileSync(path.join(folder, "points.json"), '{"total": 10, "mistakes": {"*": 3}}');
  assert.equal(run("grade", "a.scn", "class", ...size, "-o", "out", "--points", "points.json").status, 1);
  return `file://${folder}/out/index.html`;
}

test("the grading page sorts by keyboard, opens pictures, fits a phone and prints", async t => {
  const address = graded(t);
  const browser = await launch(t);
  const page = await browser.newPage({ viewport: { width: 1200, height: 900 } });
  const complaints = [];
  page.on("pageerror", error => complaints.push(String(error)));
  page.on("dialog", dialog => (complaints.push(dialog.message()), dialog.dismiss()));
  page.on("requestfailed", request => complaints.push(request.url()));
  await page.goto(address);
  const students = () => page.$$eval("tbody th b", all => all.map(one => one.textContent));
  const sorted = () => page.$$eval("thead [aria-sort]", all => all.map(one => one.getAttribute("aria-sort")));
  assert.deepEqual(await students(), [HOSTILE, "anna", "ben", "cy", "dora"]);
  assert.match(await page.textContent(".mistakes"), /2 students: background/);
  assert.match(await page.textContent("tr:has-text('ben')"), /the same in every pixel as that of cy/);

  // The table is sorted by keyboard alone. In both orders, rows with an empty cell are last.
  await page.focus("thead th:last-child button");
  await page.keyboard.press("Enter");
  assert.deepEqual(await sorted(), ["none", "none", "none", "none", "ascending"]);
  const points = () => page.$$eval("tbody td:last-child", all => all.map(one => one.textContent));
  assert.deepEqual(await points(), ["7", "7", "7", "10", ""]);
  await page.keyboard.press("Space");
  assert.deepEqual(await sorted(), ["none", "none", "none", "none", "descending"]);
  assert.deepEqual(await points(), ["10", "7", "7", "7", ""]);

  await page.focus("tr:has-text('anna') .open");
  await page.keyboard.press("Enter");
  const sizes = () => page.$$eval("dialog figure img", all => Promise.all(all.map(async one => (await one.decode(), one.naturalWidth))));
  assert.deepEqual(await sizes(), [64, 64, 64]);
  assert.equal(await page.textContent("dialog h2"), "anna");
  await page.keyboard.press("Escape");
  assert.equal(await page.isVisible("dialog"), false);

  await page.click("tr:has-text('ben') .comment summary");
  await page.click("tr:has-text('ben') .copy");
  // Copying may take a while, so the test waits for it.
  await page.waitForSelector("tr:has-text('ben') .copy:text-is('copied')");

  await page.setViewportSize({ width: 400, height: 800 });
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(wide <= 400, `${wide} pixels`);
  await page.emulateMedia({ media: "print" });
  await page.evaluate(() => dispatchEvent(new Event("beforeprint")));
  assert.equal(await page.isVisible("tr:has-text('cy') pre"), true);
  assert.equal(await page.isVisible(".hint"), false);
  assert.deepEqual(complaints, []);
});
