// Tests of sliders for definitions and numbers: their limits, playing, recording, and errors in the
// text.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { andFinished, FIGURE, finished, hand, handle, host, launch, open, rendered, rested, site, tab, text, type } from "./helpers.mjs";

const number = (text, pattern) => Number(new RegExp(`${pattern}\\s*(-?[\\d.e-]+)`).exec(text)[1]);

/** Returns the figure's text with a definition before it and one field replaced. */
const scene = (definition, field, other) => `${definition}\n${FIGURE.replace(field, other)}`;

/** Returns the position of a slider's thumb on the page. */
async function thumb(page, at = 0) {
  return page.locator(".slider-row input").nth(at).evaluate(it => {
    const { x, y, width, height } = it.getBoundingClientRect();
    return [x + 8 + (width - 16) * (it.value - it.min) / (it.max - it.min), y + height / 2];
  });
}

/** Waits until the first slider has the limit `value`, where `end` is `min` or `max`. */
async function until(page, end, value) {
  await page.waitForFunction(([end, value]) => document.querySelector(".slider-row input")?.[end] === value, [end, value]);
}

test("sliders of definitions keep their ranges, undo in one step, and play to and fro", async t => {
  const scene = `let r = 1.5 // [0.5:0.25:2]\nlet turn = 30deg\nlet n = 9\n${FIGURE.replace("radius 1", "radius r").replace("roll   0deg", "roll turn").replace("per_pixel 16", "per_pixel n")}`;
  const page = await open(await launch(t), await host(t, scene));
  await page.waitForSelector(".slider-row");
  const rows = await page.locator(".slider-row").evaluateAll(all => all.map(row => {
    const { min, max, step } = row.querySelector("input");
    return [row.firstChild.textContent, min, max, step, row.querySelector("output").textContent];
  }));
  assert.deepEqual(rows[0], ["r", "0.5", "2", "0.25", "1.5"]);
  assert.equal(rows[1][4], "30deg");
  assert.equal(rows[2][1], "1", "there is no less than one sample");
  const { x, y, width, height } = await page.locator(".slider-row input").first().boundingBox();
  await hand(page, [x + width * 2 / 3, y + height / 2], [width / 4, 0]);
  await rested(page);
  assert.ok(number(await text(page), "let r =") > 1.5, await text(page));
  await page.click("#undo");
  await rested(page);
  assert.equal(await text(page), scene);
  await page.click('[aria-label="Play r"]');
  const seen = new Set();
  for (let i = 0; i < 60 && seen.size < 4; i++) {
    seen.add(number(await text(page), "let r ="));
    await page.waitForTimeout(100);
  }
  await page.click('[aria-label="Play r"][aria-pressed=true]');
  await rested(page);
  assert.ok(seen.size >= 4, [...seen].join());
  for (const it of seen) assert.ok(it >= 0.5 && it <= 2 && it % 0.25 === 0, `${it}`);
  await page.click("#undo");
  await rested(page);
  assert.equal(await text(page), scene);
});

test("a playing number stops as soon as something is dragged", async t => {
  const scene = FIGURE.replace(/^/, "let r = 1  // [0.5:0.25:2]\n").replace("radius 1", "radius r");
  const page = await open(await launch(t), await host(t, scene));
  await page.waitForSelector("#sliders:not([hidden])");
  await page.selectOption("#objects", { label: "Crate (box)" });
  await rested(page);
  await page.click('[aria-label="Play r"]');
  await page.waitForFunction(() => /let r = (?!1 )/.test(document.querySelector(".cm-line").textContent));
  await hand(page, await handle(page, "Crate: center"), [40, 0]);
  await rested(page);
  assert.equal(await page.locator("[aria-pressed=true].play").count(), 0);
  assert.notEqual(/box.*/.exec(await text(page))[0], /box.*/.exec(scene)[0], "the drag has come to its place");
  await page.click("#undo");
  await rested(page);
  assert.equal(/box.*/.exec(await text(page))[0], /box.*/.exec(scene)[0]);
  await page.click("#undo");
  await rested(page);
  assert.equal(await text(page), scene);
});

test("ranges have units and any order of ends, and invalid ones are reported", async t => {
  const lines = ["let a = 30deg // [0deg:5deg:90deg]", "let b = 2 // [5:1:0]", "let c = 1 // [1:x]", "let d = 3 // see below"];
  const page = await open(await launch(t), await host(t, `${lines.join("\n")}\n${FIGURE}`));
  await page.waitForSelector(".slider-row");
  const rows = await page.locator(".slider-row").evaluateAll(all => all.map(row => {
    const { min, max, step } = row.querySelector("input");
    return [min, max, step, row.querySelector("p").textContent];
  }));
  assert.deepEqual(rows.slice(0, 2), [["0", "90", "5", ""], ["0", "5", "1", ""]]);
  assert.match(rows[2][3], /`x` in the range is no number/);
  assert.equal(rows[3][3], "");
  for (const [at, written] of [[0, "let a = 90deg"], [1, "let b = 5"]]) {
    const { x, y, width, height } = await page.locator(".slider-row input").nth(at).boundingBox();
    const part = at === 0 ? 1 / 3 : 2 / 5;
    await hand(page, [x + 8 + (width - 16) * part, y + height / 2], [width, 0]);
    await rested(page);
    assert.ok((await text(page)).includes(written), await text(page));
  }
});

test("a slider stays under the pointer while its value is an error, below the problem", async t => {
  const browser = await launch(t);
  const started = await host(t, scene("let r = 1 // [-1:0.1:3]", "radius 1", "radius r / 2"));
  for (const [width, height] of [[1280, 800], [1280, 420], [390, 700]]) {
    const page = await open(browser, started, { viewport: { width, height } });
    await tab(page, "text");
    await page.waitForSelector(".slider-row");
    const [x, y] = await thumb(page);
    await hand(page, [x, y], [-width, 0], { hold: true });
    await page.waitForSelector("#problem-list:not([hidden])");
    assert.equal(number(await text(page), "let r ="), -1);
    assert.ok(await page.isVisible(".slider-row input"));
    await page.mouse.move(x + 40, y, { steps: 5 });
    await page.waitForSelector("#problem-list", { state: "hidden" });
    assert.ok(number(await text(page), "let r =") > 1);
    await page.mouse.move(0, y, { steps: 5 });
    await page.mouse.up();
    await page.waitForSelector("#problem-list:not([hidden])");
    // The whole slider is visible, and the problem is above it.
    await page.waitForTimeout(400);
    const [row, problem, footer] = await Promise.all([".slider-row", "#problem-list", "footer"].map(it => page.locator(it).boundingBox()));
    assert.ok(problem.y + problem.height <= row.y + 1 && row.y + row.height <= footer.y + 1, `${width} × ${height}`);
    await hand(page, await thumb(page), [width, 0]);
    await page.waitForSelector("#problem-list", { state: "hidden" });
    assert.equal(number(await text(page), "let r ="), 3);
    await page.context().close();
  }
});

test("sliders never reach values that are errors, and counts have whole steps", async t => {
  const page = await open(await launch(t), await host(t, scene("let r = 1", "radius 1", "radius r / 2")));
  await until(page, "min", "0.1");
  await hand(page, await thumb(page), [-900, 0]);
  await rested(page);
  assert.equal(number(await text(page), "let r ="), 0.1);
  assert.equal(await page.textContent("#problems"), "No problems");
  // A drag of the number in the text ends at the limit, too.
  await page.click("#undo");
  const box = await page.locator(".cm-line").first().getByText("1", { exact: true }).boundingBox();
  await page.keyboard.down("Alt");
  await hand(page, [box.x + box.width / 2, box.y + box.height / 2], [-300, 0]);
  await page.keyboard.up("Alt");
  await rested(page);
  assert.equal(number(await text(page), "let r ="), 0.1);
  for (const count of ["Ball for i < n", "Ball for i < 2 * n"]) {
    await type(page, scene("let n = 4", "Ball ", `${count} `));
    await until(page, "value", "4");
    await until(page, "step", "1");
    await finished(page);
    await page.focus(".slider-row input");
    await page.keyboard.press("ArrowRight");
    await rested(page);
    assert.equal(number(await text(page), "let n ="), 5);
    assert.doesNotMatch(await page.textContent("#problems"), /^\d+ problem/);
    // The slider in the text, and its keys, have the same limits.
    await page.locator(".cm-line").first().getByText("5", { exact: true }).click();
    await page.waitForSelector(".slider");
    assert.equal(await page.getAttribute(".slider input", "step"), "1");
    await page.click('.slider [aria-label="More"]');
    await rested(page);
    assert.equal(number(await text(page), "let n ="), 6);
  }
});

test("a playing number stays visible, and stops at an error or by Escape", async t => {
  const page = await open(await launch(t), await host(t, scene("let r = 1.4 // [0:0.1:4]", "radius 1", "radius 2 - r")));
  await page.waitForSelector(".slider-row");
  await page.click('[aria-label="Play r"]');
  assert.ok(await page.isVisible('[aria-label="Play r"][aria-pressed=true]'));
  await page.waitForSelector('[aria-label="Play r"]:not([aria-pressed])', { timeout: 20_000 });
  await rested(page);
  const last = number(await text(page), "let r =");
  assert.ok(last > 1.4 && last < 2, `${last}`);
  assert.equal(await page.textContent("#problems"), "No problems");
  await page.click("#undo");
  await rested(page);
  assert.equal(number(await text(page), "let r ="), 1.4);
  await page.click('[aria-label="Play r"]');
  await page.waitForFunction(() => /let r = 1\.[5-9]/.test(document.querySelector(".cm-line").textContent));
  await page.keyboard.press("Escape");
  await page.waitForSelector('[aria-label="Play r"]:not([aria-pressed])', { timeout: 500 });
  await rested(page);
  assert.equal(await page.textContent("#problems"), "No problems");
});

test("a slider's value has few digits and never covers its button", async t => {
  const lines = ["let tilt = 10deg // [0rad:0.1rad:1rad]", "let aNameThatIsLongerThanARowOfThePanelIsWide = 0.12345678901234567890123456789", "let far = 1 // [0:0.001:1e6]"];
  const browser = await launch(t);
  const started = await host(t, `${lines.join("\n")}\n${FIGURE}`);
  for (const width of [1280, 760, 390]) {
    const page = await open(browser, started, { viewport: { width, height: 800 } });
    await tab(page, "text");
    await until(page, "max", "57.2");
    const rows = await page.locator(".slider-row").evaluateAll(all => all.map(row => [...row.querySelectorAll("span, input, output, button")].map(it => it.getBoundingClientRect()).concat(row.getBoundingClientRect()).map(({ left, right }) => [left, right])));
    for (const [name, input, output, button, recorder, row] of rows) {
      assert.ok(name[1] <= input[0] && input[1] <= output[0] && output[1] <= button[0] && button[1] <= recorder[0] && recorder[1] <= row[1], `${width}: ${[name, input, output, button, recorder, row].join(" ")}`);
      assert.ok(input[1] - input[0] > 60, `${width}: ${input.join()}`);
    }
    assert.equal(await page.locator(".slider-row input").nth(2).getAttribute("max"), "1000000");
    await hand(page, await thumb(page), [60, 0]);
    await rested(page);
    assert.match(await text(page), /^let tilt = \d+(\.\d)?deg /);
    await page.context().close();
  }
});

test("a range behind a value that is not a number is reported", async t => {
  const page = await open(await launch(t), await host(t, scene("let r = 1 + 0 // [0:1:3]\nlet v = (1, 2, 3) // [1:2]", "radius 1", "radius r")));
  await page.waitForSelector(".slider-row p");
  const rows = await page.locator(".slider-row").evaluateAll(all => all.map(row => [row.innerText, row.querySelector("input").checkVisibility()]));
  assert.equal(rows.length, 2);
  for (const [said, has] of rows) assert.ok(!has && /^[rv]\s+a range is for a number/.test(said), said);
});

/** Decodes an animation in the browser. Returns its repetitions, and for each picture its size,
 * duration and a digest of its pixels. */
async function animation(page, bytes) {
  return page.evaluate(async base64 => {
    const data = Uint8Array.from(atob(base64), letter => letter.charCodeAt(0));
    const decoder = new ImageDecoder({ data, type: "image/png", colorSpaceConversion: "none" });
    await decoder.tracks.ready;
    const { frameCount, animated, repetitionCount } = decoder.tracks.selectedTrack;
    const frames = [];
    for (let frameIndex = 0; frameIndex < frameCount; frameIndex++) {
      const { image } = await decoder.decode({ frameIndex });
      const canvas = new OffscreenCanvas(image.displayWidth, image.displayHeight);
      const context = canvas.getContext("2d");
      context.drawImage(image, 0, 0);
      const { data: pixels } = context.getImageData(0, 0, canvas.width, canvas.height);
      const digest = new Uint8Array(await crypto.subtle.digest("SHA-256", pixels));
      frames.push({ time: image.duration / 1000, size: [canvas.width, canvas.height], digest: digest.join() });
      image.close();
    }
    return { animated, repetitionCount, frames };
  }, bytes.toString("base64"));
}

// The program renders a recording on several threads; the static page's engine renders it in
// slices. Both must give the same pictures.
for (const isStatic of [false, true]) {
  const skip = isStatic && process.env.SITE === undefined ? "SITE names no folder" : false;
  test(`a number recorded in ${isStatic ? "the static page" : "the program's page"} is an animation of its whole range, of full pictures, and the text stays`, { skip }, async t => {
    const small = scene("let r = 1 // [0.5:0.25:2]", "radius 1", "radius r").replace("width 1280  height 720", "width 320  height 180");
    const started = await host(t, small);
    const page = await open(await launch(t), isStatic ? await site(t, process.env.SITE) : started);
    if (isStatic) await andFinished(page, () => type(page, small));
    await page.waitForSelector(".slider-row");
    const [download] = await Promise.all([page.waitForEvent("download"), page.click('[aria-label="Record r"]')]);
    assert.equal(download.suggestedFilename(), "scene-r.png");
    await page.waitForFunction(() => /scene-r\.png is downloaded/.test(document.querySelector("#said").textContent));
    assert.ok(await page.isHidden("#rendering"));
    assert.equal(await page.locator(".record[aria-pressed]").count(), 0);
    const { animated, repetitionCount, frames } = await animation(page, readFileSync(await download.path()));
    assert.ok(animated && repetitionCount === Infinity, `${repetitionCount}`);
    assert.equal(frames.length, 7);
    const time = frames.reduce((sum, it) => sum + it.time, 0);
    assert.ok(Math.abs(time - 4000) < 10, `${time}`);
    // Each picture equals one that `pinhole render` makes, with the scene's own size and samples.
    for (const [i, frame] of frames.entries()) {
      const alone = await animation(page, rendered(started.folder, small.replace("let r = 1", `let r = ${0.5 + 0.25 * i}`)));
      assert.deepEqual([frame.size, frame.digest], [[320, 180], alone.frames[0].digest], `${i}`);
    }
    assert.equal(new Set(frames.map(it => it.digest)).size, 7);
    assert.equal(await text(page), small);
    if (!isStatic) assert.ok(await page.isDisabled("#undo"));
  });
}

test("a recording has at most 60 pictures, tells its progress, and ends by Escape or its button", async t => {
  const page = await open(await launch(t), await host(t, scene("let r = 1 // [0.5:0.001:2]", "radius 1", "radius r")));
  await page.waitForSelector(".slider-row");
  const downloads = [];
  page.on("download", it => downloads.push(it));
  for (const end of [() => page.keyboard.press("Escape"), () => page.click('[aria-label="Record r"]'), () => page.click("#cancel")]) {
    await page.click('[aria-label="Record r"]');
    await page.waitForSelector('[aria-label="Record r"][aria-pressed=true]');
    await page.waitForFunction(() => document.querySelector("#progress").value > 0.001, null, { timeout: 60_000 });
    assert.ok(await page.isVisible("#rendering"));
    await end();
    await page.waitForFunction(() => /scene-r\.png was cancelled/.test(document.querySelector("#said").textContent));
    assert.ok(await page.isHidden("#rendering"));
    assert.equal(await page.locator(".record[aria-pressed]").count(), 0);
  }
  assert.deepEqual(downloads, []);
  // After a cancelled recording, the host is free: it renders another one at once.
  await type(page, scene("let r = 1 // [0.5:0.001:2]", "radius 1", "radius r").replace("width 1280  height 720", "width 64  height 36"));
  await rested(page);
  const [download] = await Promise.all([page.waitForEvent("download"), page.click('[aria-label="Record r"]')]);
  assert.equal((await animation(page, readFileSync(await download.path()))).frames.length, 60);
});

test("a recording stops at a value that is an error, and says at which", async t => {
  const page = await open(await launch(t), await host(t, scene("let r = 1 // [0:0.5:4]", "radius 1", "radius 2 - r").replace("width 1280  height 720", "width 64  height 36")));
  await page.waitForSelector(".slider-row");
  await page.click('[aria-label="Record r"]');
  await page.waitForSelector("#said[data-tone=warning]");
  assert.equal(await page.textContent("#said"), "with 2 the scene has errors");
  assert.ok(await page.isHidden("#rendering"));
  assert.equal(await page.locator(".record[aria-pressed]").count(), 0);
});

test("a number has a slider with a grip that says what it does, and a named number can also be played and recorded", async t => {
  const page = await open(await launch(t), await host(t, scene("let r = 1", "radius 1", "radius r")));
  await page.waitForSelector(".slider-row");
  for (const name of ["Play r", "Record r"]) assert.ok(await page.isVisible(`[aria-label="${name}"]`));
  await page.locator(".cm-line").getByText("2.75").click();
  await page.waitForSelector(".slider .grip");
  assert.equal(await page.innerText(".slider .grip"), "↔ drag");
  await page.keyboard.press("Escape");
  await page.focus("#stage");
  await page.keyboard.press("?");
  assert.match(await page.innerText("#keys-dialog"), /▶ plays it, ● records it/);
});

test("a problem is shown as a whole, or scrolls", async t => {
  const page = await open(await launch(t), await host(t));
  await type(page, FIGURE.replace("  d ", "  dd "));
  await page.waitForSelector("#problem-list li");
  const { cut, list, high } = await page.evaluate(() => {
    const list = document.querySelector("#problem-list");
    const place = list.querySelector(".place");
    return { cut: place.scrollHeight - place.clientHeight, list: list.scrollHeight, high: list.clientHeight };
  });
  assert.ok(cut <= 1 && high > 60, `${cut} ${list} ${high}`);
});
