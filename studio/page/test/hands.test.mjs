// Tests of editing in the picture: moving objects and the camera changes the text.

import assert from "node:assert/strict";
import { test } from "node:test";
import { andFinished, choose, comparing, decoded, drag, FIGURE, finished, hand, handle, host, launch, onPage, open, pixels, rendered, rested, text } from "./helpers.mjs";

/** Point in the picture well inside the ball of figure 9.9. */
const BALL = [455, 320];

const vector = (text, before) => {
  const found = new RegExp(`${before}\\s*\\(([^)]*)\\)`).exec(text);
  assert.ok(found, `no vector after ${before} in\n${text}`);
  return found[1].split(",").map(Number);
};

test("dragging a ball defined by let changes only its numbers, in one undo step", async t => {
  const started = await host(t);
  const page = await open(await launch(t), started);
  await andFinished(page, () => drag(page, BALL, [BALL[0] + 200, BALL[1]]));
  const moved = await text(page);
  const [x, y] = vector(moved, "let ball =");
  assert.ok(x > -0.5 && Math.abs(y - 1) < 0.2, moved);
  assert.equal(moved.replace(/let ball = .*/, ""), FIGURE.replace(/let ball = .*/, ""));
  await comparing(page);
  assert.equal(await pixels(page), await decoded(page, rendered(started.folder, moved)));
  await page.keyboard.press("Control+z");
  assert.equal(await text(page), FIGURE);
});

test("Escape reverts a drag in progress", async t => {
  const page = await open(await launch(t), await host(t));
  await page.mouse.move(...(await onPage(page, BALL)));
  await page.mouse.down();
  await page.waitForSelector('.handle[aria-label="Ball: center"]');
  await page.waitForTimeout(200);
  await andFinished(page, async () => page.mouse.move(...(await onPage(page, [BALL[0] + 150, BALL[1]])), { steps: 4 }));
  assert.notEqual(await text(page), FIGURE);
  await andFinished(page, () => page.keyboard.press("Escape"));
  await page.mouse.up();
  assert.equal(await text(page), FIGURE);
});

test("a click selects the object under it and shows its line; the cursor selects, too", async t => {
  const page = await open(await launch(t), await host(t));
  await page.mouse.move(...(await onPage(page, BALL)));
  await page.waitForFunction(() => /^Ball at \(.*away/.test(document.querySelector("#pointed").textContent));
  await page.mouse.click(...(await onPage(page, BALL)));
  await page.waitForSelector('.handle[aria-label="Ball: center"]');
  assert.match(await page.textContent(".cm-activeLine"), /^sphere/);
  assert.equal(await text(page), FIGURE);
  await page.locator(".cm-line", { hasText: "box" }).getByText("Crate").click();
  await page.waitForSelector('.handle[aria-label="Crate: center"]');
  assert.equal(await page.locator("#objects option:checked").textContent(), "Crate (box)");
});

test("a click selects the clicked object of a repetition, and the cursor the first one", async t => {
  for (const name of ["Pearl", ""]) {
    const scene = `camera { eye (0, 0, 12)  lookat (0, 0, 0) }\nsampler { per_pixel 1 }\nsphere { center (0, -3, 0) }\nsphere ${name} for i < 5 { center (2 * i - 4, 0, 0)  radius 0.6 }\n`;
    const page = await open(await launch(t), await host(t, scene));
    await rested(page);
    const chosen = () => page.locator("#objects").evaluate(it => it.value);
    const at = i => [400 + 225 * (2 * i - 4) / 6, 225];
    for (const i of [3, 1, 4, 0]) {
      await page.mouse.click(...(await onPage(page, at(i))));
      await rested(page);
      assert.equal(await chosen(), String(i + 1), name);
      const [x, y] = await onPage(page, at(i));
      const [hx, hy] = await handle(page, await page.locator("#handles .handle").first().getAttribute("aria-label"));
      assert.ok(Math.hypot(hx - x, hy - y) < 3, `${i}: ${hx - x} ${hy - y}`);
    }
    // The dragged object stays selected, even if a block is inserted before it.
    const before = await text(page);
    await hand(page, await onPage(page, at(3)), [0, 40]);
    await rested(page);
    assert.notEqual(await text(page), before);
    assert.equal(await chosen(), "4");
    await page.click("#undo");
    await rested(page);
    assert.equal(await chosen(), "4");
    await page.locator(".cm-line").getByText("sampler").click();
    await rested(page);
    assert.equal(await chosen(), "");
    for (const key of ["Control+End", "ArrowUp"]) await page.keyboard.press(key);
    await rested(page);
    assert.equal(await chosen(), "1");
    await page.context().close();
  }
});

test("a choice made before a click is answered is kept", async t => {
  const started = await host(t);
  const page = await open(await launch(t), started);
  await rested(page);
  process.kill(started.pid, "SIGSTOP");
  await page.mouse.click(...(await onPage(page, [455, 320])));
  await page.selectOption("#objects", { label: "Crate (box)" });
  process.kill(started.pid, "SIGCONT");
  await page.waitForSelector('.handle[aria-label="Crate: center"]');
  await rested(page);
  assert.ok(await page.isVisible('.handle[aria-label="Crate: center"]'));
  await page.mouse.click(...(await onPage(page, [455, 320])));
  await page.waitForSelector('.handle[aria-label="Ball: center"]');
});

test("a press beside a handle drags the object", async t => {
  const browser = await launch(t);
  const started = await host(t, FIGURE.replace("d      2.75", "d      5.5"));
  const page = await open(browser, started);
  await page.selectOption("#objects", { label: "Crate (box)" });
  await page.waitForSelector("#handles .handle");
  const box = /^box.*$/m;
  const places = await page.locator("#handles .handle").evaluateAll(all => all.map(it => {
    const { x, y, width, height } = it.getBoundingClientRect();
    return [it.ariaLabel, x + width / 2, y + height / 2];
  }));
  for (const [label, x, y] of places) {
    const isFace = !label.endsWith("center");
    // The drag goes towards the centre of the box, so that the pointer stays over the box.
    const [, mx, my] = places.find(([label]) => label.endsWith("center"));
    const far = Math.hypot(mx - x, my - y);
    const part = isFace ? 11 / far : 0;
    const from = [x + (mx - x) * part, y + (my - y) * part];
    await hand(page, from, [24, 0]);
    await rested(page);
    const line = box.exec(await text(page))[0];
    assert.match(line, /size \(0\.5, 1\.5, 2\)/, `beside ${label}`);
    assert.notEqual(line, box.exec(started.text())[0], `beside ${label}`);
    await page.click("#undo");
    await rested(page);
    if (!isFace) continue;
    await hand(page, [x + 3, y - 3], [24, -20]);
    await rested(page);
    assert.doesNotMatch(box.exec(await text(page))[0], /size \(0\.5, 1\.5, 2\)/, label);
    await page.click("#undo");
    await rested(page);
  }
});

test("a drag constrained to an axis stays on it", async t => {
  const page = await open(await launch(t), await host(t));
  await page.focus("#stage");
  await page.keyboard.press("y");
  await andFinished(page, () => drag(page, BALL, [BALL[0] + 30, BALL[1] - 120]));
  const [x, y, z] = vector(await text(page), "let ball =");
  assert.deepEqual([x, z], [-1.6, 0]);
  assert.ok(y > 1.3);
});

test("the camera orbits about its lookat point", async t => {
  const page = await open(await launch(t), await host(t));
  await choose(page, "orbit");
  await andFinished(page, () => drag(page, [640, 500], [840, 460]));
  const moved = await text(page);
  const eye = vector(moved, "eye");
  const distance = ([x, y, z]) => Math.hypot(x - 0.2, y - 0.8, z);
  assert.deepEqual(vector(moved, "lookat"), [0.2, 0.8, 0]);
  assert.notDeepEqual(eye, [3, 3.5, 8]);
  // The eye keeps its distance from the centre, except for rounding to the digits in the text.
  assert.ok(Math.abs(distance(eye) / distance([3, 3.5, 8]) - 1) < 0.01, String(eye));
});

test("objects and camera can be moved by keyboard alone", async t => {
  const page = await open(await launch(t), await host(t));
  // The Tab key alone leads from the top of the page to the list of objects.
  for (let i = 0; i < 60; i++) {
    await page.keyboard.press("Tab");
    if (await page.evaluate(() => document.activeElement.id === "objects")) break;
  }
  assert.equal(await page.evaluate(() => document.activeElement.id), "objects");
  await page.keyboard.press("ArrowDown");
  await page.waitForSelector('.handle[aria-label="Ball: center"]');
  // Shift-Tab leads from the tools back to the handles in the picture.
  for (let i = 0; i < 20; i++) {
    await page.keyboard.press("Shift+Tab");
    if (await page.evaluate(() => document.activeElement.ariaLabel === "Ball: center")) break;
  }
  await page.keyboard.press("x");
  await andFinished(page, () => page.keyboard.press("ArrowRight"));
  const [x, y, z] = vector(await text(page), "let ball =");
  assert.deepEqual([y, z], [1, 0]);
  assert.ok(x > -1.6 && x < -1.3, String(x));
  await page.keyboard.press("o");
  await page.focus("#stage");
  await andFinished(page, () => page.keyboard.press("ArrowRight"));
  assert.notDeepEqual(vector(await text(page), "eye"), [3, 3.5, 8]);
  await page.keyboard.press("Control+z");
  await andFinished(page, () => page.keyboard.press("Control+z"));
  assert.equal(await text(page), FIGURE);
});

test("an object after a thousand others can be selected", async t => {
  const others = Array.from({ length: 1000 }, (_, i) => `sphere { center (0, ${i + 10}, 20)  radius 0.1 }`).join("\n");
  const page = await open(await launch(t), await host(t, `camera { eye (0, 0, 5)  direction (0, 0, -1) }\n${others}\nsphere Last { center (0, 0, 0) }\n`));
  await page.mouse.click(...(await onPage(page, [400, 225])));
  await page.waitForSelector('.handle[aria-label="Last: center"]');
});

test("repeated taps of a key are one drag, and every tap counts", async t => {
  const page = await open(await launch(t), await host(t));
  await page.selectOption("#objects", { label: "Ball (sphere)" });
  await page.focus('.handle[aria-label="Ball: center"]');
  const place = async () => {
    const { x, y } = await page.locator('.handle[aria-label="Ball: center"]').boundingBox();
    const zoom = await page.evaluate(() => document.querySelector("canvas").getBoundingClientRect().width / 1280);
    return [x / zoom, y / zoom];
  };
  const [x, y] = await place();
  for (let i = 0; i < 6; i++) await page.keyboard.press("ArrowRight");
  await page.waitForTimeout(800);
  await finished(page);
  const [now, level] = await place();
  // The numbers in the text are rounded, so the object is not exactly at the expected point.
  assert.ok(Math.abs(now - x - 60) <= 8 && Math.abs(level - y) <= 8, `${now - x}`);
  await andFinished(page, () => page.keyboard.press("Control+z"));
  assert.equal(await text(page), FIGURE);
});

test("every handle moves only its object, and every tool only the camera", async t => {
  const page = await open(await launch(t), await host(t));
  const handles = {
    Ball: ["center", "radius"],
    Sail: ["centroid", "normal", "spin"],
    Crate: ["center", "min_x", "max_x", "min_y", "max_y", "min_z", "max_z"],
    checkerboard: ["y"],
  };
  const kinds = { Ball: /let ball = .*|sphere .*/g, Sail: /triangle .*/g, Crate: /box .*/g, checkerboard: /checkerboard .*/g };
  for (const [object, names] of Object.entries(handles)) {
    const option = await page.locator("#objects option", { hasText: object }).getAttribute("value");
    await page.selectOption("#objects", option);
    await page.waitForSelector(`.handle[data-handle=${names[0]}][data-object="${option}"]`);
    assert.deepEqual(await page.locator("#handles .handle").evaluateAll(all => all.map(handle => handle.dataset.handle)), names);
    for (const name of names) {
      await page.focus(`.handle[data-handle=${name}]`);
      // Every handle can be moved upwards or to the right.
      for (const key of ["ArrowUp", "ArrowRight"]) await page.keyboard.press(key);
      await page.waitForFunction(() => document.querySelector("#file-state").textContent === "not saved", null, { timeout: 5000 }).catch(() => assert.fail(`${object}: ${name} does nothing`));
      await finished(page);
      const moved = await text(page);
      assert.equal(moved.replace(kinds[object], ""), FIGURE.replace(kinds[object], ""), `${object}: ${name}`);
      while ((await page.textContent("#file-state")) !== "") await page.keyboard.press("Control+z");
    }
  }
  await page.focus("#stage");
  for (const key of ["o", "p", "d", "r", "v", "l"]) {
    await page.keyboard.press(key);
    await andFinished(page, () => page.keyboard.press("ArrowDown"));
    if (key === "p" || key === "l" || key === "o" || key === "r") await page.keyboard.press("ArrowRight");
    await finished(page);
    const moved = await text(page);
    assert.notEqual(moved, FIGURE, key);
    const camera = /camera {2}\{[^}]*\}/;
    assert.equal(moved.replace(camera, ""), FIGURE.replace(camera, ""), key);
    while ((await page.textContent("#file-state")) !== "") await page.keyboard.press("Control+z");
  }
});

test("one finger drags, and two fingers zoom without changing the text", async t => {
  const browser = await launch(t);
  const page = await open(browser, await host(t), { viewport: { width: 380, height: 700 }, hasTouch: true, isMobile: true });
  const session = await page.context().newCDPSession(page);
  const touch = (type, ...points) => session.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
  const place = () => page.evaluate(() => document.querySelector("canvas").getBoundingClientRect().toJSON());
  const start = await place();
  const before = start.width;
  const [x, y] = await onPage(page, BALL);
  // A tap selects the object and does not move it.
  await page.touchscreen.tap(x, y);
  await page.waitForSelector("#handles .handle");
  assert.deepEqual(await place(), start);
  await touch("touchStart", [x, y]);
  await touch("touchStart", [x, y], [x + 40, y]);
  for (let i = 1; i <= 5; i++) await touch("touchMove", [x, y], [x + 40 + 8 * i, y]);
  await touch("touchEnd");
  const after = (await place()).width;
  assert.ok(after > 1.7 * before, `${before} to ${after}`);
  assert.equal(await text(page), FIGURE);
  await page.click("#zoom-fit");
  assert.deepEqual(await place(), start);
  await touch("touchStart", [x, y]);
  await page.waitForTimeout(300);
  for (let i = 1; i <= 5; i++) await touch("touchMove", [x + 8 * i, y]);
  await andFinished(page, () => touch("touchEnd"));
  await finished(page);
  assert.ok(vector(await text(page), "let ball =")[0] > -1.4);
});

test("a phone has tabs for picture and text, and targets of 44 pixels", async t => {
  const page = await open(await launch(t), await host(t), { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });
  // A tall phone has room for the text below the picture.
  const [editor, stage] = [await page.locator("#editor").boundingBox(), await page.locator("#stage").boundingBox()];
  assert.ok(await page.isVisible("#editor") && editor.y >= stage.y + stage.height && editor.height > 150);
  await page.setViewportSize({ width: 390, height: 640 });
  assert.ok(await page.isVisible("#stage") && await page.isHidden("#editor"));
  await page.setViewportSize({ width: 390, height: 844 });
  await page.selectOption("#objects", { label: "Crate (box)" });
  await page.waitForSelector("#handles .handle");
  const targets = "header button, header summary, #tabs button, .tools select, .tools button, .tools summary, .tools label span, footer button, #handles .handle, .dock-tools button";
  const measured = await page.locator(targets).evaluateAll(all => all.map(it => [it.textContent, it.getBoundingClientRect()]).filter(([, { width }]) => width > 0));
  assert.ok(measured.length > 20);
  for (const [name, { width, height }] of measured) assert.ok(width >= 43.9 && height >= 43.9, `${name}: ${width} × ${height}`);
  const handles = await page.locator("#handles .handle").evaluateAll(all => all.map(it => it.getBoundingClientRect()));
  for (const [i, a] of handles.entries()) for (const b of handles.slice(0, i)) assert.ok(Math.max(Math.abs(a.x - b.x), Math.abs(a.y - b.y)) >= 43.9);
  await page.tap("#tabs [data-tab=text]");
  assert.ok(await page.isHidden("#stage") && await page.isVisible("#editor"));
  await page.tap("#tabs [data-tab=picture]");
  assert.ok(await page.isVisible("#stage"));
  // Problems are shown with the text.
  await page.tap("#problems");
  assert.ok(await page.isVisible("#editor"));
});

test("unnamed objects of a repetition are labelled by their indices", async t => {
  const scene = `${FIGURE}\nsphere for i < 2, j < 2 { center (i - 3, 3 + j, 0)  radius 0.3 }\nsphere { center (2, 3, 0)  radius 0.3 }\n`;
  const page = await open(await launch(t), await host(t, scene));
  const names = () => page.locator("#objects option").allTextContents();
  await page.waitForFunction(() => document.querySelector("#objects").options.length === 10);
  const line = scene.split("\n").findIndex(it => it.startsWith("sphere for")) + 1;
  assert.deepEqual((await names()).slice(-5), ["[0, 0]", "[0, 1]", "[1, 0]", "[1, 1]"].map(it => `sphere ${it} (${line})`).concat(`sphere (${line + 1})`));
  await page.selectOption("#objects", { index: 7 });
  await page.waitForSelector('.handle[aria-label^="sphere [1, 0]: "]');
});

test("a selected board is not outlined across objects in front of it", async t => {
  const scene = "camera { eye (0, 1, 5)  lookat (0, 0, 0) }\ncheckerboard Floor { square 2 }\nsphere Ball { center (0.5, 0.5, 3)  radius 1 }\n";
  const page = await open(await launch(t), await host(t, scene));
  await page.waitForFunction(() => document.querySelector("#objects").options.length === 3);
  await page.selectOption("#objects", { label: "Floor (checkerboard)" });
  await rested(page);
  await page.mouse.move(...(await onPage(page, [100, -30])));
  await page.waitForTimeout(300);
  assert.equal(await page.locator("#lines .line.selected").count(), 0);
  // The ball's block becomes a comment. Without the ball, the outline of the square is visible.
  await page.locator(".cm-line").last().click();
  await page.keyboard.type("// ", { delay: 30 });
  await page.keyboard.press("ArrowUp");
  await page.keyboard.press("Home");
  await page.keyboard.type("// ", { delay: 30 });
  await page.click(".cm-line:nth-child(2)");
  await page.waitForSelector("#lines .line.selected", { state: "attached", timeout: 5000 });
});

test("the selection stays when another program inserts text before it", async t => {
  // The page applies another program's change as a minimal difference, which may begin in the
  // middle of a block.
  const blocks = ["sphere for i < 3 { center (2*i - 2, 1, 0)  radius 0.6 }", "box { min (-3, 0, -1)  max (-2.4, 2, 0) }"];
  const board = "checkerboard { y 0 }";
  const camera = "camera { eye (0, 3, 9)  lookat (0, 1, 0) }";
  for (const [selected, added] of [["sphere [2] (3)", "sphere { center (0, 3, 0)  radius 0.3 }"], ["box (4)", "box { min (3, 0, 0)  max (4, 1, 1) }"]]) {
    const started = await host(t, [camera, board, ...blocks, ""].join("\n"));
    const page = await open(await launch(t), started);
    await page.waitForFunction(() => document.querySelector("#objects").options.length === 6);
    await page.selectOption("#objects", { label: selected });
    await page.waitForSelector("#handles .handle");
    const shown = () => page.evaluate(() => [document.querySelector("#objects").selectedOptions[0]?.text, document.querySelector("#handles .handle")?.ariaLabel]);
    const [, label] = await shown();
    const at = selected.startsWith("box") ? 3 : 2;
    const lines = [camera, board, ...blocks, ""];
    started.write([...lines.slice(0, at), added, added.replace("3", "2.5"), ...lines.slice(at)].join("\n"));
    await page.waitForFunction(() => document.querySelector("#objects").options.length === 8);
    await rested(page);
    const line = Number(/\d+(?=\)$)/.exec(selected)[0]) + 2;
    assert.deepEqual(await shown(), [selected.replace(/\d+\)$/, `${line})`), label]);
    // When the inserted text is removed again, the selection stays, too.
    started.write(lines.join("\n"));
    await page.waitForFunction(() => document.querySelector("#objects").options.length === 6);
    await rested(page);
    assert.deepEqual(await shown(), [selected, label]);
    started.write([...lines.slice(0, at), added, added.replace("3", "2.5"), ...lines.slice(at)].join("\n"));
    await page.waitForFunction(() => document.querySelector("#objects").options.length === 8);
    await rested(page);
    // A drag of the handle changes only the block of the selected object.
    await hand(page, await handle(page, label), [40, 0]);
    await rested(page);
    const now = (await text(page)).split("\n");
    assert.deepEqual(now.filter((_, i) => i !== line - 1), started.text().split("\n").filter((_, i) => i !== line - 1));
    assert.notEqual(now[line - 1], lines[at]);
  }
});

test("two fingers shift the picture as far as they move, shrink it at most to its whole, and select nothing", async t => {
  const page = await open(await launch(t), await host(t), { viewport: { width: 1280, height: 720 }, hasTouch: true });
  const session = await page.context().newCDPSession(page);
  const touch = (type, ...points) => session.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
  const place = () => page.evaluate(() => document.querySelector("canvas").getBoundingClientRect().toJSON());
  const line = () => page.textContent(".cm-activeLine");
  /** Moves two fingers. The second one is pressed a moment after the first. */
  const fingers = async (from, to) => {
    const at = part => from.map((it, i) => it.map((_, axis) => it[axis] + (to[i][axis] - it[axis]) * part));
    await touch("touchStart", from[0]);
    await page.waitForTimeout(200);
    await touch("touchStart", ...from);
    for (let i = 1; i <= 10; i++) await touch("touchMove", ...at(i / 10));
    await touch("touchEnd");
    await page.waitForTimeout(200);
  };
  const before = await line();
  const whole = (await place()).width;
  const [x, y] = await onPage(page, BALL);
  await fingers([[x, y], [x + 60, y]], [[x - 30, y], [x + 110, y]]);
  const near = await place();
  assert.ok(near.width > 1.8 * whole, `${near.width}`);
  // Both fingers move by 60 and 50 pixels, so the picture is shifted without a zoom.
  await fingers([[860, 170], [960, 170]], [[920, 220], [1020, 220]]);
  const shifted = await place();
  assert.ok(Math.abs(shifted.left - near.left - 60) < 6 && Math.abs(shifted.top - near.top - 50) < 6, JSON.stringify([near, shifted]));
  assert.ok(Math.abs(shifted.width - near.width) < 6);
  for (let i = 0; i < 4; i++) await fingers([[760, 200], [1060, 200]], [[900, 200], [920, 200]]);
  assert.ok(Math.abs((await place()).width - whole) < 2, `${(await place()).width} of ${whole}`);
  // Fingers that move together do not zoom the smallest picture either.
  await fingers([[860, 170], [960, 170]], [[920, 170], [1020, 170]]);
  assert.ok(Math.abs((await place()).width - whole) < 2, `${(await place()).width} of ${whole}`);
  assert.equal(await page.locator("#handles .handle").count(), 0);
  assert.equal(await line(), before);
  assert.equal(await text(page), FIGURE);
});
