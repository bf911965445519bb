// Tests of the page in a panel of VS Code. Chromium shows the page of the packaged extension, whose
// server is the real program. VS Code itself is replaced by a substitute.

import assert from "node:assert/strict";
import { before, test } from "node:test";
import { until } from "../../../grammar/editors/vscode/test/vscode.mjs";
import { FIGURE, hand, handle, launch, onPage } from "./helpers.mjs";
import { opened, packed, paint } from "./panel.mjs";

before(packed);

const timeout = 60_000;

/** Waits for a finished picture of this size. */
const sized = (page, size) => page.waitForFunction(size => document.querySelector("#frame-state").textContent === `${size}, finished`, size, { timeout: 20_000 });

/** Waits until the document and the page have stopped changing. */
async function rested(page, document) {
  let before = null;
  for (let same = 0; same < 5; ) {
    await page.waitForTimeout(60);
    const now = `${await page.evaluate(() => document.querySelector("canvas").dataset.version)} ${document.getText()} ${document.isInStep}`;
    same = now === before ? same + 1 : 0;
    before = now;
  }
}

const ball = text => /let ball\s*=\s*\(([^)]*)\)/.exec(text)[1].split(",").map(Number);
/** A point of the picture that shows the ball. */
const BALL = [455.5, 320.5];

test("the picture follows the text as it is typed, and says when it has errors", { timeout }, async t => {
  const { page, document, panel } = await opened(t, await launch(t), { a: FIGURE });
  await sized(page, "1280 × 720");
  const ends = new RegExp("\\bwidth\\s+1280");
  const [width] = ends.exec(FIGURE);
  document.type(width, "width 640");
  await sized(page, "640 × 720");
  assert.equal(document.saves, 0);
  document.type("sphere", "spher");
  await page.waitForSelector("#stale:not([hidden])");
  assert.equal(await page.textContent("#stale"), "The text has errors. This is its last good picture.");
  document.type("spher", "sphere");
  await page.waitForSelector("#stale", { state: "hidden" });
  // VS Code shows the text and its problems, so the page hides its own editor and their controls.
  for (const hidden of ["header", "#editor", "#tabs", "#divider", "#problems", "#draft-bar", "#connection-bar"]) assert.ok(await page.isHidden(hidden), hidden);
  assert.equal(panel.page.html.length, 1);
  assert.deepEqual(page.complaints, []);
});

test("a drag by a real pointer changes the text, as one step for Undo", { timeout }, async t => {
  const { page, document, textEditor, run } = await opened(t, await launch(t), { a: FIGURE });
  const [x, y] = await onPage(page, BALL);
  await hand(page, [x, y], [40, 0], { hold: true });
  // The text changes while the button is held.
  await until(() => document.getText() !== FIGURE);
  await page.waitForFunction(() => /Ball\.center = /.test(document.querySelector("#drag-note").textContent));
  await page.mouse.up();
  await rested(page, document);
  const [before, after] = [ball(FIGURE), ball(document.getText())];
  assert.ok(after[0] > before[0] + 0.3 && after[1] === before[1], `${before} to ${after}`);
  assert.equal(document.getText().split("\n").length, FIGURE.split("\n").length);
  assert.ok(textEditor.revealed.length > 0);
  assert.equal(document.steps.length, 1);
  await run("pinhole.picture.undo");
  assert.equal(document.getText(), FIGURE);
  // The page follows Undo: the ball is at its old place again.
  await rested(page, document);
  await page.mouse.move(...(await onPage(page, BALL)));
  await page.waitForFunction(() => document.querySelector("#pointed").textContent.startsWith("Ball"));
  // Escape takes back a drag.
  await hand(page, [x, y], [-30, 10], { hold: true });
  await until(() => document.getText() !== FIGURE);
  await page.keyboard.press("Escape");
  await page.mouse.up();
  await until(() => document.getText() === FIGURE);
  // A key moves the selected object, too.
  await page.keyboard.press("ArrowRight");
  await until(() => document.getText() !== FIGURE);
  assert.deepEqual(page.complaints, []);
});

test("pointing says what is hit, a click selects its source, and a cursor in the text selects the object", { timeout }, async t => {
  const { page, document, textEditor, seen } = await opened(t, await launch(t), { a: FIGURE });
  const [x, y] = await onPage(page, BALL);
  await page.mouse.move(x, y);
  await page.waitForFunction(() => document.querySelector("#pointed").textContent.startsWith("Ball"));
  assert.ok(await page.isVisible("#pointed"));
  await page.mouse.click(x, y);
  const { start, end } = await until(() => textEditor.selection);
  assert.equal(document.getText({ start, end }), "Ball");
  assert.equal(document.getText(), FIGURE);
  await page.waitForSelector(".handle[aria-label='Ball: center']");
  const active = document.positionAt(FIGURE.indexOf("Crate"));
  seen.fire("selection", { textEditor, kind: 2, selections: [{ active }] });
  await page.waitForSelector(".handle[aria-label='Crate: center']");
  // The page does not report a cursor back that VS Code has sent. Otherwise, a selection of several
  // words in VS Code would be lost.
  assert.deepEqual(textEditor.selection.start, start);
  await page.keyboard.press("Delete");
  await until(() => !document.getText().includes("Crate"));
  assert.deepEqual(page.complaints, []);
});

test("the view from outside is there, and its drags change the text", { timeout }, async t => {
  const { page, document } = await opened(t, await launch(t), { a: FIGURE });
  await page.waitForFunction(() => document.querySelector("#outside-canvas").dataset.fineness === "final");
  const d = text => Number(/\bd\s+([\d.]+)/.exec(text)[1]);
  const { x, y, width, height } = await page.locator("#outside-handles .handle[data-object=null][data-handle=d]").boundingBox();
  await hand(page, [x + width / 2, y + height / 2], [30, 3]);
  await rested(page, document);
  assert.ok(d(document.getText()) > d(FIGURE) + 0.2, document.getText());
  assert.equal(document.steps.length, 1);
  // A drag beside objects turns the view and does not change the text.
  const turned = document.getText();
  const eye = await page.locator("#outside-handles .handle[data-handle=eye]").boundingBox();
  const stage = await page.locator("#outside").boundingBox();
  await hand(page, [stage.x + stage.width / 2, stage.y + stage.height - 12], [60, 0]);
  await until(async () => (await page.locator("#outside-handles .handle[data-handle=eye]").boundingBox()).x !== eye.x);
  assert.equal(document.getText(), turned);
  assert.deepEqual(page.complaints, []);
});

test("the glass opens, layers are drawn, and both narrow and low panels have room", { timeout: 2 * timeout }, async t => {
  const browser = await launch(t);
  for (const [width, height] of [[700, 800], [571, 800], [400, 800], [300, 560], [700, 480]]) {
    const { page, document } = await opened(t, browser, { a: FIGURE }, { width, height });
    await page.click('summary:text("Show")');
    await page.check("#layers [name=vanishing]");
    await page.waitForSelector("#lines .axis-x", { state: "attached" });
    await page.click('summary:text("Show")');
    const hasDock = height >= 520;
    assert.equal(await page.isVisible("#outside"), hasDock, `${width} × ${height}`);
    if (hasDock) {
      await page.mouse.move(...(await onPage(page, BALL)));
      await page.keyboard.press("g");
      await page.waitForSelector("#glass-points circle");
      assert.equal(await page.textContent("#glass-pixel"), "455, 320");
      // The view from outside has less room now, and still shows the eye.
      await until(() => page.evaluate(() => {
        const [stage, eye] = ["#outside", "#outside-handles [data-handle=eye]"].map(it => document.querySelector(it)?.getBoundingClientRect());
        return eye && eye.left >= stage.left && eye.right <= stage.right && eye.top >= stage.top && eye.bottom <= stage.bottom;
      }));
    }
    // A selected object adds tools. Their space is reserved, so the picture does not move.
    const before = await page.locator("#stage").boundingBox();
    await page.mouse.click(...(await onPage(page, BALL)));
    await page.waitForSelector("#handles [data-handle]", { state: "attached" });
    const after = await page.locator("#stage").boundingBox();
    assert.deepEqual([after.y, after.height], [before.y, before.height], `the picture at ${width} × ${height}`);
    const beyond = await page.evaluate(() => [...document.querySelectorAll(".tools > *, .dock-tools > *")]
      .filter(it => it.checkVisibility() && it.getBoundingClientRect().width > 0)
      .filter(it => it.getBoundingClientRect().left < 0 || it.getBoundingClientRect().right > innerWidth)
      .map(it => it.id || it.textContent));
    assert.deepEqual(beyond, [], `all tools are within ${width} × ${height}`);
    const outer = await page.evaluate(() => [document.documentElement.scrollWidth - innerWidth, document.documentElement.scrollHeight - innerHeight]);
    assert.deepEqual(outer, [0, 0], `${width} × ${height} does not scroll`);
    for (const [name, ...others] of [["#stage", "#dock", "footer"], [".tools", "#stage"]]) {
      const inner = await page.locator(name).boundingBox();
      assert.ok(inner.width > width - 2 && inner.height > 30, `${name} at ${width} × ${height}: ${JSON.stringify(inner)}`);
      for (const other of others) {
        const box = await page.locator(other).boundingBox();
        assert.ok(box === null || box.y >= inner.y + inner.height - 1, `${other} is over ${name} at ${width} × ${height}`);
      }
    }
    assert.equal(document.getText(), FIGURE);
    assert.deepEqual(page.complaints, []);
  }
});

test("layers and the dock are as they were after a reload, and so is the text", { timeout }, async t => {
  const { page, document } = await opened(t, await launch(t), { a: FIGURE });
  await page.click('summary:text("Show")');
  await page.check("#layers [name=horizon]");
  await page.uncheck("#outside-shown");
  document.type("Ball", "Globe");
  await page.reload();
  await sized(page, "1280 × 720");
  await page.waitForSelector("#lines .horizon", { state: "attached" });
  assert.ok(await page.isHidden("#outside"));
  await page.mouse.move(...(await onPage(page, BALL)));
  await page.waitForFunction(() => document.querySelector("#pointed").textContent.startsWith("Globe"));
  assert.deepEqual(page.complaints, []);
});

test("the panel follows the active scene, and shows nothing of the one before", { timeout }, async t => {
  const broken = FIGURE.replace("sphere", "spher");
  const { page, documents: [, other, third], vscode } = await opened(t, await launch(t), { a: FIGURE, b: FIGURE.replace(/\bwidth\s+1280/, "width 320"), c: broken });
  await vscode.window.showTextDocument(other, { viewColumn: 1 });
  await sized(page, "320 × 720");
  await vscode.window.showTextDocument(third, { viewColumn: 1 });
  await page.waitForSelector("#stale:not([hidden])");
  assert.equal(await page.textContent("#stale"), "The text has errors, so there is no picture yet.");
  assert.equal(await page.getAttribute("canvas", "data-fineness"), null);
});

test("after a restart of the server the picture is of the newest text", { timeout }, async t => {
  const { page, document, run } = await opened(t, await launch(t), { a: FIGURE });
  await page.evaluate(() => {
    window.said = new Set();
    const note = () => window.said.add(document.querySelector("#connection").textContent);
    new MutationObserver(note).observe(document.querySelector("#connection"), { childList: true, characterData: true, subtree: true });
  });
  const restarted = run("pinhole.restart");
  await page.waitForFunction(() => [...window.said].some(it => it.includes("engine has stopped")));
  document.type("Ball", "Globe");
  await restarted;
  await page.waitForSelector("#connection-bar", { state: "hidden" });
  await until(async () => {
    await page.mouse.move(...(await onPage(page, [BALL[0] + Math.random(), BALL[1]])));
    return (await page.textContent("#pointed")).startsWith("Globe");
  });
  await hand(page, await onPage(page, BALL), [30, 0]);
  await until(() => ball(document.getText())[0] !== ball(FIGURE)[0]);
});

test("the colours are those of VS Code's theme, and change with it", { timeout }, async t => {
  const { page } = await opened(t, await launch(t), { a: FIGURE }, { theme: "light" });
  const colors = () => page.evaluate(() => [document.documentElement.dataset.theme, getComputedStyle(document.querySelector("footer")).backgroundColor, getComputedStyle(document.body).padding]);
  assert.deepEqual(await colors(), ["light", "rgb(255, 255, 255)", "0px"]);
  await paint(page, "dark");
  await page.waitForFunction(() => document.documentElement.dataset.theme === "dark");
  assert.deepEqual(await colors(), ["dark", "rgb(31, 31, 31)", "0px"]);
  await paint(page, "light");
  await page.waitForFunction(() => document.documentElement.dataset.theme === "light");
});

test("the page's own keys for Undo and Save leave these to VS Code", { timeout }, async t => {
  const { page, document } = await opened(t, await launch(t), { a: FIGURE });
  await hand(page, await onPage(page, BALL), [40, 0]);
  await rested(page, document);
  const changed = document.getText();
  assert.notEqual(changed, FIGURE);
  const prevented = await page.evaluate(() => {
    const keys = [["z"], ["y"], ["z", true], ["s"], ["s", true]];
    return keys.filter(([key, shiftKey]) => !document.querySelector("#stage").dispatchEvent(new KeyboardEvent("keydown", { key, ctrlKey: true, shiftKey, bubbles: true, cancelable: true })));
  });
  assert.deepEqual(prevented, []);
  await page.waitForTimeout(100);
  assert.equal(document.getText(), changed);
  assert.ok(await handle(page, "Ball: center"));
  assert.equal(await page.locator("dialog[open]").count(), 0);
});
