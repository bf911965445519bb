// Tests of the text editor: problems and fixes, completion, hints, sliders, and unsafe texts.

import assert from "node:assert/strict";
import { test } from "node:test";
import { andFinished, comparing, decoded, FIGURE, finished, hand, host, launch, menu, open, pixels, rendered, rested, tab, text, type } from "./helpers.mjs";

/** Waits until the editor has the text `expected`. */
async function until(page, expected) {
  for (let i = 0; i < 40 && (await text(page)) !== expected; i++) await page.waitForTimeout(25);
  assert.equal(await text(page), expected);
}

test("the picture equals that of `pinhole render` pixel by pixel", async t => {
  const { address, folder } = await host(t);
  const page = await open(await launch(t), { address });
  await comparing(page);
  assert.equal(await pixels(page), await decoded(page, rendered(folder, FIGURE)));
  const other = FIGURE.replace("d      2.75", "d      1.5").replace("per_pixel 16", "per_pixel 3");
  await andFinished(page, () => type(page, other));
  assert.equal(await pixels(page), await decoded(page, rendered(folder, other)));
});

test("the page works within its content security policy", async t => {
  const page = await open(await launch(t), await host(t));
  await page.waitForSelector(".swatch");
  await page.selectOption("#objects", { label: "Ball (sphere)" });
  await page.waitForSelector("#handles .handle");
  await page.click("text=Share");
  assert.deepEqual(page.complaints, []);
});

test("a fix is applied by mouse and by key", async t => {
  const page = await open(await launch(t), await host(t));
  const slip = FIGURE.replace("radius 1", "radios 1");
  await type(page, slip);
  await page.waitForSelector(".cm-lintRange-error");
  assert.equal(await page.textContent("#problems"), "1 problem");
  // Hints appear a little later and may move the line, so the test waits for them.
  await page.waitForTimeout(500);
  await page.hover(".cm-lintRange-error");
  await andFinished(page, () => page.click(".cm-tooltip-lint .cm-diagnosticAction"));
  assert.equal(await text(page), FIGURE);
  await type(page, slip);
  await page.waitForSelector(".cm-lintRange-error");
  await andFinished(page, () => page.keyboard.press("Control+."));
  assert.equal(await text(page), FIGURE);
});

test("while the text has errors the last good picture stays and is marked", async t => {
  const page = await open(await launch(t), await host(t));
  await comparing(page);
  const before = await pixels(page);
  await type(page, FIGURE.replace("camera  {", "camera  "));
  await page.waitForSelector("#stale:not([hidden])");
  assert.equal(await pixels(page), before);
  assert.match(await page.textContent("#stale"), /last good picture/);
  await andFinished(page, () => type(page, FIGURE));
  assert.ok(await page.isHidden("#stale"));
});

test("a text with errors from the start is reported and can be fixed in the page", async t => {
  const { address } = await host(t, FIGURE.replace("radius 1", "radios 1"));
  const page = await (await launch(t)).newPage();
  await page.goto(address);
  await page.waitForSelector("#stale:not([hidden])");
  assert.match(await page.textContent("#stale"), /no picture yet/);
  await page.click("#problems");
  await page.click("#problem-list >> text=write `radius`");
  await finished(page);
  assert.equal(await text(page), FIGURE);
});

test("a picture that is too large to show is shown smaller", async t => {
  const page = await open(await launch(t), await host(t));
  await type(page, FIGURE.replace("width 1280  height 720", "width 60000  height 60000").replace("per_pixel 16", "per_pixel 1"));
  await page.waitForFunction(() => /^60000 × 60000/.test(document.querySelector("#frame-state").textContent), null, { timeout: 60_000 });
  assert.ok(await page.isHidden("#stale"));
});

test("completion, hints, swatches and format come from the server", async t => {
  const page = await open(await launch(t), await host(t));
  await page.waitForSelector(".hint");
  assert.ok((await page.locator(".hint").allTextContents()).includes("fov 39.9662deg"));
  const swatch = page.getByLabel("Colour olive");
  await andFinished(page, () => swatch.fill("#102030"));
  assert.match(await text(page), /radius 1 {2}color #102030/);
  await page.click(".cm-content");
  await page.keyboard.press("Control+z");
  assert.equal(await text(page), FIGURE);
  await type(page, "camera { eye (0, 1, 5) lookat (0, 0, 0) }\nsphere { center (0, 0, 0) ra");
  await page.waitForSelector(".cm-tooltip-autocomplete");
  // Completion ignores keys for a short time after it has opened.
  await page.waitForTimeout(200);
  await page.keyboard.press("Enter");
  assert.match(await text(page), /center \(0, 0, 0\) radius 1$/);
  // The placeholder is selected, so that typing replaces it.
  await andFinished(page, () => page.keyboard.insertText("2 }"));
  await page.keyboard.press("Shift+Alt+f");
  await page.waitForFunction(() => /sphere \{ center \(0, 0, 0\) {2}radius 2 \}/.test(document.querySelector(".cm-content").innerText));
});

test("numbers change by slider, keys and Alt-drag, each in one undo step", async t => {
  const page = await open(await launch(t), await host(t));
  const radius = page.locator(".cm-line", { hasText: "sphere" }).getByText("1", { exact: true });
  await radius.click();
  const slider = page.locator(".slider input");
  await slider.focus();
  await andFinished(page, () => page.keyboard.press("ArrowRight"));
  assert.match(await text(page), /radius 1\.1 /);
  await page.keyboard.press("Escape");
  await andFinished(page, () => page.keyboard.press("Alt+ArrowDown"));
  await until(page, FIGURE);
  const box = await radius.boundingBox();
  await page.keyboard.down("Alt");
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2 + 40, box.y + box.height / 2, { steps: 10 });
  await page.mouse.up();
  await page.keyboard.up("Alt");
  await page.waitForFunction(() => /radius 2 /.test(document.querySelector(".cm-content").innerText));
  await page.keyboard.press("Control+z");
  assert.equal(await text(page), FIGURE);
  for (const [before, after] of [["1e-3", "0.002"], ["-0.05", "-0.04"], ["2.75", "2.76"], ["1_000", "1100"], ["1e6", "1100000"], ["0", "0.1"], ["30", "31"]]) {
    await type(page, `let a = (${before}, 1, 1)`);
    await page.keyboard.press("Home");
    for (let i = 0; i < "let a = (".length + 1; i++) await page.keyboard.press("ArrowRight");
    await page.keyboard.press("Alt+ArrowUp");
    await until(page, `let a = (${after}, 1, 1)`);
  }
});

test("a slider, a key and a drag keep a number within its limits", async t => {
  const page = await open(await launch(t), await host(t));
  for (const [line, number, least] of [["sphere", "1", "0.1"], ["sampler", "16", "1"], ["camera", "2.75", "0.01"]]) {
    const written = page.locator(".cm-line", { hasText: line === "camera" ? "2.75" : line }).getByText(number, { exact: true }).first();
    await written.click();
    const slider = page.locator(".slider input");
    await page.waitForFunction(least => document.querySelector(".slider input")?.min === least, least);
    const { x, y, width, height } = await slider.boundingBox();
    // The thumb is dragged beyond the left end of the slider, so the number gets its least value.
    await hand(page, [x + width / 2, y + height / 2], [-width, 0]);
    await rested(page);
    assert.ok(await page.isHidden("#stale"), await text(page));
    assert.equal(await page.textContent("#problems"), "No problems");
    await page.keyboard.press("Escape");
    await page.click("#undo");
    assert.equal(await text(page), FIGURE);
    const at = await written.boundingBox();
    await page.keyboard.down("Alt");
    await hand(page, [at.x + at.width / 2, at.y + at.height / 2], [-400, 0]);
    await page.keyboard.up("Alt");
    await rested(page);
    assert.equal(await page.textContent("#problems"), "No problems", await text(page));
    await page.click("#undo");
    assert.equal(await text(page), FIGURE);
  }
});

test("typed braces replace the closing ones, and the text between them is indented", async t => {
  const page = await open(await launch(t), await host(t));
  const typed = async (keys, expected) => {
    await type(page, "");
    for (const part of keys.split("\n")) {
      if (part !== keys.split("\n")[0]) await page.keyboard.press("Enter");
      await page.keyboard.type(part, { delay: 15 });
      await page.keyboard.press("Escape");
    }
    assert.equal(await text(page), expected);
  };
  const block = "camera {\n  eye (0, 1, 5)\n  lookat (0, 0, 0)\n}";
  await typed("camera {\neye (0, 1, 5)\nlookat (0, 0, 0)\n}", block);
  await typed("camera {\neye (0, 1, 5)\nlookat (0, 0, 0)\n}\nsphere { radius 1 }\n", `${block}\nsphere { radius 1 }\n`);
  await typed("sphere {\nradius 1 }", "sphere {\n  radius 1 }");
});

test("texts and names of a scene are never interpreted as HTML", async t => {
  const evil = `<img src=x onerror="window.hit=1"><script>window.hit=1</script>`;
  const scene = `// ${evil}\n${FIGURE.replace("let ball", `// ${evil}\nlet ball`)}`;
  const page = await open(await launch(t), await host(t, scene));
  // Comments, unknown words and invalid names appear in hovers and messages.
  await type(page, `${scene}\nsphere ${evil} { center (0, 0, 0) colour '${evil}' }\nlet a = b${evil}`);
  await page.waitForSelector(".cm-lintRange-error");
  await page.click("#problems");
  await page.waitForSelector("#problem-list li");
  for (const word of ["ball", "sphere", "Ball"]) {
    await page.locator(".cm-line").getByText(word, { exact: true }).first().hover();
    await page.waitForTimeout(500);
  }
  assert.equal(await page.evaluate(() => window.hit), undefined);
  // The HTML in the texts must not become pictures or scripts. The only pictures of the page are
  // the figures in the language reference.
  assert.equal(await page.locator("img:not(.cm-widgetBuffer, #language-dialog img), body script").count(), 0);
});

test("a key press requests its picture first, also if it selects another object", async t => {
  const started = await host(t);
  const page = await (await launch(t)).newPage();
  const asked = [];
  page.on("websocket", socket => socket.on("framesent", ({ payload }) => asked.push(/"method":"([^"]+)"/.exec(payload)?.[1])));
  await page.goto(started.address);
  await finished(page);
  await page.locator(".cm-line").filter({ hasText: /^sphere/ }).click();
  // The line is wrapped into rows. The first press of End goes to the end of the row, the second to
  // the end of the line.
  for (let i = 0; i < 2; i++) await page.keyboard.press("End");
  await rested(page);
  // A space after the block separates the cursor from it, so the object is no longer selected. When
  // the space is deleted, the object is selected again.
  for (const key of ["Space", "Backspace"]) {
    asked.length = 0;
    await andFinished(page, () => page.keyboard.press(key));
    await rested(page);
    assert.deepEqual(asked.filter(it => it !== "studio/alive").slice(0, 2), ["textDocument/didChange", "pinhole/frame"], asked.join());
    assert.ok(asked.includes("pinhole/overlays"));
  }
});

test("a tooltip of a word never covers the tools above the text", async t => {
  const browser = await launch(t);
  const started = await host(t);
  for (const [width, height] of [[380, 760], [1280, 760], [1280, 330], [390, 560]]) {
    const page = await open(browser, started, { viewport: { width, height } });
    await tab(page, "text");
    await page.waitForSelector(".hint");
    for (const word of ["let", "camera", "image"]) {
      await page.mouse.move(width - 20, height - 8);
      const { x, y } = await page.locator(".cm-line .tok-keyword", { hasText: word }).first().boundingBox();
      await page.mouse.move(x + 5, y + 8, { steps: 3 });
      const tooltip = page.locator(".cm-tooltip-hover");
      await tooltip.waitFor();
      const [said, edge] = [await tooltip.boundingBox(), (await page.locator("#editor").boundingBox()).y];
      assert.ok(said.y >= edge && said.y + said.height <= height, `${word} at ${width} × ${height}: ${said.y}, ${said.height}`);
      // The tooltip shows its whole text, or scrolls.
      assert.ok(await tooltip.evaluate(it => it.scrollHeight <= it.clientHeight + 1 || getComputedStyle(it).overflowY === "auto"));
    }
    await page.context().close();
  }
});

test("a hover answer for a word that is gone is not shown", async t => {
  const started = await host(t);
  const page = await open(await launch(t), started);
  await page.waitForSelector(".hint");
  for (const act of [() => menu(page, "File", "#new"), () => type(page, "let a = 1\n")]) {
    const word = await page.locator(".cm-line .tok-propertyName").last().boundingBox({ timeout: 5000 });
    process.kill(started.pid, "SIGSTOP");
    await page.mouse.move(word.x + 5, word.y + 8, { steps: 3 });
    await page.waitForTimeout(700);
    await act();
    process.kill(started.pid, "SIGCONT");
    await rested(page);
  }
  assert.deepEqual(page.complaints, []);
});

test("a click on a hint moves the cursor to its position", async t => {
  const page = await open(await launch(t), await host(t));
  await page.waitForSelector(".hint");
  await page.click(".cm-content", { position: { x: 2, y: 5 } });
  const hint = page.locator(".hint", { hasText: "fov" });
  await hint.click();
  await page.keyboard.type("1");
  assert.match(await text(page), /d +2\.751/);
});
