// Tests of the large page, for a projector: its key, its handles by a real pointer, and its sizes.

import assert from "node:assert/strict";
import { test } from "node:test";
import { FIGURE, finished, hand, handle, host, launch, menu, open, rested, text, type } from "./helpers.mjs";

const isLarge = page => page.evaluate(() => !document.querySelector("#undo").checkVisibility());

/** Makes the page large by the key b. */
async function enlarge(page) {
  await page.focus("#stage");
  await page.keyboard.press("b");
  await page.waitForSelector("#undo", { state: "hidden" });
  await rested(page);
}

test("b and the menu make the page large, b and Escape end it, and only a reload keeps it", async t => {
  const browser = await launch(t);
  const started = await host(t);
  const page = await open(browser, started);
  const sizes = () => page.evaluate(() => [".cm-content", "#slot", ".tools", "body"].map(it => parseFloat(getComputedStyle(document.querySelector(it)).fontSize)));
  const usual = await sizes();
  await enlarge(page);
  assert.ok(await page.isHidden("footer"));
  (await sizes()).forEach((size, i) => assert.ok(size > 1.05 * usual[i], `${size} of ${usual[i]}`));
  assert.ok(await page.isVisible("#outside-canvas"));
  await page.keyboard.press("b");
  assert.ok(!(await isLarge(page)));
  await menu(page, "Show", "#large");
  assert.ok(await isLarge(page));
  // The first Escape closes the menu, and the second one makes the page small again.
  await page.keyboard.press("Escape");
  assert.ok(await isLarge(page) && await page.isHidden("#layers"));
  await page.keyboard.press("Escape");
  assert.ok(!(await isLarge(page)));
  // Escape also makes the page small if the focus is in the text.
  await enlarge(page);
  await page.click(".cm-content", { position: { x: 2, y: 5 } });
  await page.keyboard.press("b");
  assert.deepEqual([await isLarge(page), await text(page)], [true, `b${FIGURE}`], "in the text, b is a letter");
  await page.keyboard.press("Backspace");
  // The first Escape may close the list of completions.
  for (let i = 0; i < 2; i++) await page.keyboard.press("Escape");
  assert.ok(!(await isLarge(page)));
  await enlarge(page);
  await page.selectOption("#objects", { label: "Ball (sphere)" });
  await hand(page, await handle(page, "Ball: center"), [60, 0], { hold: true });
  await page.waitForFunction(() => !document.querySelector(".cm-content").textContent.includes("let ball = (-1.6, 1, 0)"));
  await page.keyboard.press("Escape");
  await page.mouse.up();
  await rested(page);
  assert.equal(await text(page), FIGURE);
  assert.ok(await isLarge(page), "Escape has taken the drag back, and no more");
  page.on("dialog", dialog => dialog.accept());
  await page.reload();
  await finished(page);
  assert.ok(await isLarge(page));
  const other = await open(browser, started);
  assert.ok(!(await isLarge(other)));
});

test("handles are hit at the size at which they are drawn, in both pictures, and do not overlap", async t => {
  const page = await open(await launch(t), await host(t));
  await page.selectOption("#objects", { label: "Crate (box)" });
  await page.waitForSelector("#outside-handles .handle[data-handle=d]");
  await rested(page);
  const hits = async (at, [dx, dy]) => page.evaluate(([x, y]) => document.elementFromPoint(x, y).closest(".handle")?.ariaLabel ?? null, [at[0] + dx, at[1] + dy]);
  const lowest = () => page.evaluate(() => {
    const all = [...document.querySelectorAll("#outside-handles .handle")].map(it => it.getBoundingClientRect());
    const distances = all.flatMap((a, i) => all.slice(i + 1).map(b => Math.max(Math.abs(a.x - b.x), Math.abs(a.y - b.y))));
    return Math.min(...distances);
  });
  const name = "Crate: center";
  assert.equal(await hits(await handle(page, name), [12, 0]), null, "12 pixels beside it, a small handle is not hit");
  assert.ok(await lowest() >= 25);
  await enlarge(page);
  assert.equal(await hits(await handle(page, name), [12, 0]), name);
  assert.notEqual(await hits(await handle(page, name), [16, 0]), name, "beyond what is drawn, it is not hit");
  assert.ok(await lowest() >= 41, `${await lowest()}`);
  for (const line of ["#outside-lines .line.window:not(.under)", "#lines .line.selected:not(.under)"])
    assert.equal(await page.locator(line).first().evaluate(it => getComputedStyle(it).strokeWidth), "3px", line);
  // A press at the edge of a handle drags it, both in the picture and in the view from outside.
  const [x, y] = await handle(page, name);
  await hand(page, [x + 11, y + 4], [30, 0]);
  await rested(page);
  assert.notEqual(/box.*/.exec(await text(page))[0], /box.*/.exec(FIGURE)[0]);
  const d = page.locator('#outside-handles .handle[data-handle="d"]');
  const box = await d.boundingBox();
  assert.equal(box.width, 40);
  await hand(page, [box.x + 20 - 10, box.y + 20 + 5], [40, 4]);
  await rested(page);
  assert.ok(Number(/ d +([\d.]+)/.exec(await text(page))[1]) > 2.9, await text(page));
});

test("the window with the picture alone follows the large page", async t => {
  const page = await open(await launch(t), await host(t));
  const [popup] = await Promise.all([page.waitForEvent("popup"), menu(page, "Help", "#projector")]);
  await finished(popup);
  await enlarge(page);
  const pixel = page => page.evaluate(() => [...document.querySelector("canvas").getContext("2d").getImageData(640, 360, 1, 1).data].join());
  const before = await pixel(popup);
  await type(page, FIGURE.replace("let ball = (-1.6, 1, 0)", "let ball = (0.2, 1, 2)"));
  await rested(page);
  await popup.waitForFunction(before => [...document.querySelector("canvas").getContext("2d").getImageData(640, 360, 1, 1).data].join() !== before, before);
  assert.equal(await pixel(popup), await pixel(page));
  // The projector window still shows nothing but the picture.
  assert.deepEqual(await popup.evaluate(() => [...document.querySelectorAll("body *")].filter(it => it.checkVisibility() && !["MAIN", "SECTION", "DIV"].includes(it.tagName)).map(it => it.tagName)), ["CANVAS"]);
});

test("warnings and the progress of a picture are shown without the footer", async t => {
  const page = await open(await launch(t), await host(t));
  await type(page, FIGURE.replace(/sampler\s*{[^}]*}/, "sampler { method regular  per_pixel 65536 }"));
  await menu(page, "Download", "#download-png");
  await page.waitForSelector("#rendering:not([hidden])");
  await type(page, FIGURE);
  await enlarge(page);
  for (const shown of ["#progress", "#percent", "#cancel"]) assert.ok(await page.isVisible(shown), shown);
  assert.ok(await page.isHidden("#problems"));
  await page.click("#cancel");
  await page.waitForSelector("#rendering", { state: "hidden" });
  await page.keyboard.press("ArrowLeft"); // no object is selected
  await page.waitForSelector("#said[data-tone=warning]");
  assert.ok(await page.isVisible("#said") && await page.isHidden("#problems") && await page.isHidden("#frame-state"));
});

for (const [width, height] of [[1280, 720], [1920, 1080], [820, 1180], [400, 800], [640, 400]]) {
  test(`at ${width} × ${height} the large page is no wider than the window, with glass and view`, async t => {
    const page = await open(await launch(t), await host(t), { viewport: { width, height } });
    await enlarge(page);
    const isDocked = width > 760 && height > 640;
    if (isDocked) {
      await page.keyboard.press("g");
      await page.waitForFunction(() => document.querySelector("#glass-points circle") !== null);
    }
    await page.selectOption("#objects", { label: "Crate (box)" });
    await rested(page);
    const found = await page.evaluate(() => {
      const box = it => document.querySelector(it).getBoundingClientRect().toJSON();
      const eye = document.querySelector("#outside-handles .handle[data-handle=eye]")?.getBoundingClientRect().toJSON();
      return { wide: document.documentElement.scrollWidth, tall: document.documentElement.scrollHeight, tools: box(".tools"), canvas: box("#canvas"), dock: box("#outside"), eye,
        cut: [...document.querySelectorAll(".tools :is(summary, button), .dock-tools > button")].filter(it => it.checkVisibility()).filter(it => it.getBoundingClientRect().right > innerWidth + 1 || it.scrollWidth > it.clientWidth + 1).map(it => it.textContent) };
    });
    assert.ok(found.wide <= width, `${found.wide}`);
    if (width > 760) {
      assert.deepEqual(found.cut, []);
      assert.ok(found.tools.height < 60 && found.tall <= height, JSON.stringify(found.tools));
    }
    assert.ok(found.canvas.width > 0.4 * width, `${found.canvas.width}`);
    // Although the glass is beside it, the view from outside shows the eye.
    if (isDocked) assert.ok(found.eye.left >= found.dock.left && found.eye.right <= found.dock.right && found.dock.height >= 190, JSON.stringify(found));
  });
}

test("? shows the keys, Escape then closes only them, and × leaves the large page", async t => {
  const page = await open(await launch(t), await host(t));
  await page.click(".cm-content", { position: { x: 2, y: 5 } });
  await page.keyboard.press("?");
  assert.deepEqual([await text(page), await page.isVisible("#keys-dialog")], [`?${FIGURE}`, false], "in the text, ? is a character");
  await page.keyboard.press("Backspace");
  await enlarge(page);
  for (const at of ["#stage", "#objects", "#outside"]) {
    await page.focus(at);
    await page.keyboard.press("?");
    await page.waitForSelector("#keys-dialog[open]");
    assert.match(await page.innerText("#keys-dialog"), /b or Escape ends it/);
    // After a click on the dialog's text, no control has the focus.
    await page.click("#keys-dialog dt >> nth=1");
    await page.keyboard.press("b");
    await page.keyboard.press("Escape");
    await page.waitForSelector("#keys-dialog", { state: "hidden" });
    assert.ok(await isLarge(page), at);
  }
  await page.click("#large-end");
  assert.ok(!(await isLarge(page)));
  assert.ok(await page.isHidden("#large-end"));
});

test("tabs and projector windows answer only what is asked of them, and a copied tab has its own windows", async t => {
  const page = await open(await launch(t), await host(t));
  const windows = [];
  for (let i = 0; i < 2; i++) {
    const [popup] = await Promise.all([page.waitForEvent("popup"), menu(page, "Help", "#projector")]);
    popup.complaints = [];
    popup.on("pageerror", error => popup.complaints.push(error.message));
    await finished(popup);
    windows.push(popup);
  }
  const name = await page.evaluate(() => sessionStorage.getItem("pinhole-projector"));
  const copy = await page.context().newPage();
  await copy.addInitScript(name => sessionStorage.setItem("pinhole-projector", name), name);
  await page.evaluate(name => {
    window.heard = [];
    new BroadcastChannel(`pinhole-${name}`).onmessage = ({ data }) => window.heard.push(data?.kind ?? "?");
  }, name);
  const heard = () => page.evaluate(() => window.heard.splice(0));
  await copy.goto(page.url());
  await copy.waitForSelector("#stage");
  await page.waitForTimeout(1000);
  const kinds = await heard();
  assert.ok(kinds.includes("there") && kinds.length < 12, kinds.join());
  // Messages of other senders are ignored.
  await page.evaluate(name => new BroadcastChannel(`pinhole-${name}`).postMessage("ready"), name);
  const [own] = await Promise.all([copy.waitForEvent("popup"), copy.click("summary:text('Help')").then(() => copy.click("#projector"))]);
  await own.waitForSelector("#stage");
  assert.notEqual(new URL(own.url()).hash, new URL(windows[0].url()).hash);
  // After the projector windows are closed, no pictures are sent.
  for (const popup of windows) {
    assert.deepEqual(popup.complaints, []);
    await popup.close({ runBeforeUnload: true });
  }
  await page.waitForTimeout(500);
  await heard();
  await type(page, FIGURE.replace("let ball = (-1.6, 1, 0)", "let ball = (0.2, 1, 2)"));
  await rested(page);
  assert.deepEqual(await heard(), []);
});
