// Measures how fast the page shows pictures of figure 9.9 at 1280 × 720 pixels. For a key, and for
// a step of a drag, prints the times to the coarse and to the finished picture. Each time is the
// median of 100. Also prints how many coarse pictures a drag shows per second. Fails if memory
// grows.
//
// Call: `node test/bench.mjs [drags of 100 steps]`. With SITE, it measures the static page in that
// folder; with OUTSIDE=hidden, the page without the view from outside.

import { chromium } from "playwright-core";
import { readFileSync } from "node:fs";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { FIGURE, finished, onPage, open, serve, site } from "./helpers.mjs";

const TIMES = 100;
const DRAGS = Number(process.argv[2] ?? 100);
const median = numbers => numbers.toSorted((a, b) => a - b)[Math.floor(numbers.length / 2)];
const round = number => Number(number.toFixed(1));

const folder = mkdtempSync(path.join(tmpdir(), "pinhole-bench-"));
const file = path.join(folder, "scene.scn");
writeFileSync(file, FIGURE);
const ending = [];
const host = process.env.SITE === undefined ? await serve(file) : await site({ after: end => ending.push(end) }, process.env.SITE);
ending.push(() => host.stop?.());
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox", "--enable-precise-memory-info", "--js-flags=--expose-gc"] });
try {
  const page = await open(browser, host);
  if (process.env.OUTSIDE === "hidden") await page.click("#outside-hide");
  // Times are measured from the browser's event until the picture is on the canvas.
  await page.evaluate(() => {
    window.begin = 0;
    window.frames = [];
    for (const type of ["keydown", "pointermove"]) addEventListener(type, event => (window.begin = event.timeStamp), true);
    addEventListener("pinhole-frame", ({ target, detail: { fineness, version } }) => target.id === "canvas" && window.frames.push({ fineness, version, at: performance.now(), after: performance.now() - window.begin }));
  });
  const measure = async act => {
    const times = { coarse: [], final: [] };
    for (let i = 0; i < TIMES; i++) {
      await page.evaluate(() => (window.frames = []));
      await act(i);
      await page.waitForFunction(() => window.frames.some(frame => frame.fineness === "final"), null, { polling: 20 });
      const frames = await page.evaluate(() => window.frames);
      for (const fineness of ["coarse", "final"]) times[fineness].push(frames.find(frame => frame.fineness === fineness).after);
    }
    return `first coarse picture ${round(median(times.coarse))} ms, finished ${round(median(times.final))} ms (medians of ${TIMES})`;
  };

  await page.locator(".cm-line").getByText("2.75", { exact: true }).click();
  await page.keyboard.press("End");
  await finished(page);
  console.log("key: ", await measure(i => page.keyboard.press(i % 2 === 0 ? "Backspace" : "5")));

  const [x, y] = await onPage(page, [455, 320]);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.waitForTimeout(500);
  await page.mouse.move(x + 20, y, { steps: 3 });
  console.log("drag:", await measure(i => page.mouse.move(x + 20 + (i % 2 === 0 ? 15 : 0), y)));

  // Drags without pauses: the pointer moves once per frame of the browser.
  const moving = steps =>
    page.evaluate(
      async ([x, y, steps]) => {
        const stage = document.querySelector("#stage");
        window.frames = [];
        const begin = performance.now();
        for (let i = 0; i < steps; i++) {
          await new Promise(requestAnimationFrame);
          // A move must be large enough to change the numbers in the text; otherwise, no picture is
          // drawn.
          const at = { clientX: x + 2 * Math.abs((i % 80) - 40) - 40, clientY: y, pointerId: 1, pointerType: "mouse", isPrimary: true, buttons: 1, bubbles: true };
          stage.dispatchEvent(new PointerEvent("pointermove", at));
        }
        const coarse = window.frames.filter(frame => frame.fineness === "coarse").length;
        return { coarse, seconds: (performance.now() - begin) / 1000 };
      },
      [x, y, steps],
    );
  const { coarse, seconds } = await moving(300);
  console.log(`rate: ${round(coarse / seconds)} coarse pictures a second while dragging (${coarse} in ${round(seconds)} s)`);

  const session = await page.context().newCDPSession(page);
  const all = await browser.newBrowserCDPSession();
  const resident = pid => Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${pid}/status`, "utf8"))[1]) / 1024;
  const memory = async () => {
    await session.send("HeapProfiler.collectGarbage");
    const heap = await page.evaluate(() => performance.memory.usedJSHeapSize);
    // The heap does not contain the browser's pictures, so the memory of the process is read, too.
    const { processInfo } = await all.send("SystemInfo.getProcessInfo");
    const whole = Math.max(...processInfo.filter(({ type }) => type === "renderer").map(({ id }) => resident(id)));
    return { heap: round(heap / 2 ** 20), host: host.pid ? round(resident(host.pid)) : NaN, whole: round(whole) };
  };
  await moving(100);
  const before = await memory();
  let pictures = 0;
  for (let i = 0; i < DRAGS; i++) {
    pictures += (await moving(100)).coarse;
    if (i % 25 === 24) {
      const now = await memory();
      console.log(`memory after ${pictures} pictures: page ${now.heap} MiB (${before.heap} at first) of ${now.whole} (${before.whole}), host ${now.host} MiB (${before.host})`);
    }
  }
  await page.mouse.up();
  // The limit is 2 MiB, i.e. about 200 bytes for each of 10 000 pictures.
  const after = await memory();
  for (const of of ["heap", "host"]) if (after[of] - before[of] > 2) throw new Error(`memory grows: ${JSON.stringify(before)} before, ${JSON.stringify(after)} after ${pictures} pictures`);

  // Measures the time from a movement or a key to the coarse picture in a scene of a thousand
  // spheres. A key is pressed every 120 ms. Also prints for how many keys the picture arrives
  // before the next key.
  if (process.env.SITE === undefined) {
    const spheres = Array.from({ length: 1000 }, (_, i) => `sphere { center (${(i % 40) - 20}, ${Math.floor(i / 40) - 12}, ${-(i % 7)})  radius 0.4 }\n`);
    writeFileSync(file, `image { width 1280  height 720 }\ncamera { eye (0, 2, 30)  lookat (0, 0, 0) }\nsphere Ball { center (0, 0, 3)  radius 2 }\n${spheres.join("")}`);
    const many = await serve(file);
    ending.push(() => many.stop());
    const page = await open(browser, many);
    await page.waitForTimeout(1000);
    await page.evaluate(() => {
      for (const type of ["keydown", "pointermove"]) addEventListener(type, event => (window.begin = event.timeStamp), true);
      addEventListener("pinhole-frame", ({ target, detail: { fineness } }) => target.id === "canvas" && fineness === "coarse" && window.coarse.push(performance.now() - window.begin));
    });
    const coarse = async act => {
      await page.evaluate(() => (window.coarse = []));
      await act();
      await page.waitForTimeout(120);
      return page.evaluate(() => window.coarse[0] ?? Infinity);
    };
    const [x, y] = await onPage(page, [640, 310]);
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.waitForTimeout(300);
    const drags = [];
    for (let i = 0; i < TIMES; i++) drags.push(await coarse(() => page.mouse.move(x + 20 + (i % 2 === 0 ? 15 : 0), y)));
    await page.mouse.up();
    await page.locator(".cm-line").nth(2).click();
    await page.keyboard.press("End");
    const keys = [];
    for (let i = 0; i < TIMES; i++) keys.push(await coarse(() => page.keyboard.press(i % 2 === 0 ? "Space" : "Backspace")));
    console.log(`1000 spheres: drag ${round(median(drags))} ms, key ${round(median(keys))} ms; ${keys.filter(Number.isFinite).length} of ${TIMES} keys have a coarse picture within 120 ms`);
  }
} finally {
  await browser.close();
  for (const end of ending) end();
  rmSync(folder, { recursive: true, force: true });
}
