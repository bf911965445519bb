// Tests of the page's menus, tools and dialogs: scenes from the menu, new objects, the first
// problem, and the projector window.

import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { andFinished, FIGURE, finished, hand, handle, host, launch, menu, onPage, open, openFile, rested, site, tab, text, type } from "./helpers.mjs";

const { SITE } = process.env;

/** The page served by `pinhole studio` and, if SITE names its folder, the static page. */
const HOSTS = [["served", t => host(t)], ...(SITE === undefined ? [] : [["static", t => site(t, SITE)]])];

for (const [name, start] of HOSTS) {
  test(`an example opens, Undo reverts it, and Save asks for a name: ${name}`, async t => {
    const started = await start(t);
    const page = await open(await launch(t), started);
    await menu(page, "File", "text='farther is smaller'");
    await rested(page);
    const example = readFileSync(new URL("../../../examples/farther_is_smaller.scn", import.meta.url), "utf8");
    assert.equal(await text(page), example);
    assert.equal(await page.textContent("#file-name"), "farther_is_smaller.scn");
    assert.equal(await page.textContent("#file-state"), "");
    if (name === "served") {
      await page.click("#save");
      await page.fill("#name-field", "mine");
      await page.keyboard.press("Enter");
      await page.waitForFunction(() => /mine\.scn is saved/.test(document.querySelector("#said").textContent));
      assert.equal(readFileSync(path.join(started.folder, "mine.scn"), "utf8"), example);
      // Save writes only the new scene's file, and does not change the earlier file.
      await type(page, "camera { eye (0, 1, 9)  lookat (0, 1, 0) }\nsphere { center (0, 1, 0) }\n");
      await page.keyboard.press("Control+s");
      await page.waitForFunction(() => document.querySelector("#file-state").textContent === "");
      assert.match(readFileSync(path.join(started.folder, "mine.scn"), "utf8"), /9/);
      assert.equal(started.text(), FIGURE);
      await page.keyboard.press("Control+z");
    }
    await page.click("#undo");
    await rested(page);
    assert.equal(await text(page), FIGURE);
    assert.equal(await page.textContent("#file-name"), "scene.scn");
    if (name === "served") {
      await type(page, `${FIGURE}// more\n`);
      await page.keyboard.press("Control+s");
      await page.waitForFunction(() => /scene\.scn is saved/.test(document.querySelector("#said").textContent));
      assert.equal(started.text(), `${FIGURE}// more\n`);
    }
    assert.deepEqual(page.complaints, []);
  });

  test(`from an empty scene, objects are added, dragged, duplicated and deleted: ${name}`, async t => {
    const page = await open(await launch(t), await start(t));
    await menu(page, "File", "#new");
    await page.waitForFunction(() => !document.querySelector(".cm-content").textContent.includes("sphere"));
    const added = [["checkerboard", /^checkerboard Checkerboard1 \{ y 0 \}$/m], ["sphere", /^sphere Sphere1 \{/m], ["triangle", /^triangle Triangle1 \{/m], ["box", /^box Box1 \{/m]];
    for (const [kind, written] of added) {
      await menu(page, "+ Add", `[data-kind=${kind}]`);
      await rested(page);
      assert.match(await text(page), written);
      assert.match(await page.evaluate(() => document.querySelector("#objects").selectedOptions[0].text), new RegExp(kind));
      assert.equal(await page.textContent("#problems"), "No problems");
    }
    // A new object is visible and can be dragged at once.
    for (const label of ["Box1: center", "Box1: max y"]) {
      const before = await text(page);
      await hand(page, await handle(page, label), [30, -20]);
      await rested(page);
      assert.notEqual(await text(page), before, label);
    }
    assert.equal(await page.isChecked('input[name=along][value="floor"]'), true);
    await page.keyboard.press("Control+d");
    await rested(page);
    assert.match(await text(page), /^box Box2 \{/m);
    assert.match(await page.evaluate(() => document.querySelector("#objects").selectedOptions[0].text), /^Box2/);
    const two = /^box.*$/gm;
    const [one, other] = (await text(page)).match(two).map(it => it.replace(/Box\d/, ""));
    assert.notEqual(one, other, "the copy lies beside");
    await page.click("#stage", { position: { x: 5, y: 5 } });
    await page.selectOption("#objects", { label: "Box2 (box)" });
    await menu(page, "+ Add", "#delete");
    await rested(page);
    assert.doesNotMatch(await text(page), /Box2/);
    await page.click("#undo");
    await rested(page);
    assert.match(await text(page), /Box2/);
    assert.deepEqual(page.complaints, []);
  });
}

test("objects added while the text has errors get distinct positions and appear after the fix", async t => {
  const slip = "sphere Slip { center (0, 1, 0)  radios 1 }\n";
  const page = await open(await launch(t), await host(t));
  await type(page, `${FIGURE}${slip}`);
  await page.waitForSelector("#stale:not([hidden])");
  for (const kind of ["sphere", "sphere", "box", "triangle"]) {
    await menu(page, "+ Add", `[data-kind=${kind}]`);
    await rested(page);
  }
  const added = (await text(page)).split(slip)[1];
  const places = [...added.matchAll(/(?:center|centroid) (\([^)]*\))/g)].map(([, place]) => place);
  assert.equal(new Set(places).size, 4, added);
  await page.click("#problem-list .fix");
  await finished(page);
  await page.waitForFunction(() => document.querySelector("#problems").textContent === "No problems");
  for (const name of ["Sphere1", "Sphere2", "Box1", "Triangle1"]) {
    await page.locator("#objects").selectOption(await page.locator("#objects option", { hasText: name }).getAttribute("value"));
    await page.waitForSelector(`.handle[aria-label^="${name}: "]`);
    assert.ok(await page.locator("#handles .handle").first().isVisible(), name);
  }
});

test("an opened local file is a new scene, also with a host", async t => {
  const started = await host(t);
  const page = await open(await launch(t), started);
  const other = path.join(started.folder, "other.scn");
  // The file has Windows line ends.
  const scene = "camera { eye (0, 0, 5)  lookat (0, 0, 0) }\r\nsphere { center (0, 0, 0) }\r\n";
  writeFileSync(other, scene);
  await openFile(page, other);
  await page.waitForFunction(() => document.querySelector("#file-name").textContent === "other.scn");
  await page.click("#save");
  await page.waitForSelector("#name-dialog[open]");
  await page.keyboard.press("Enter");
  // A file of this name exists, so the name is refused.
  await page.waitForFunction(() => document.querySelector("#name-problem").textContent !== "");
  await page.fill("#name-field", "third");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => /third\.scn is saved/.test(document.querySelector("#said").textContent));
  assert.equal(readFileSync(path.join(started.folder, "third.scn"), "utf8"), scene);
  assert.equal(started.text(), FIGURE);
});

test("on a floor drags keep the height unless Shift is held, and snap unless Control is", async t => {
  const page = await open(await launch(t), await host(t));
  const drag = async keys => {
    for (const key of keys) await page.keyboard.down(key);
    await hand(page, await onPage(page, [455, 320]), [47, -31]);
    await rested(page);
    for (const key of keys) await page.keyboard.up(key);
    const found = /let ball = \((\S+), (\S+), (\S+)\)/.exec(await text(page)).slice(1);
    await page.click("#undo");
    await rested(page);
    assert.equal(await text(page), FIGURE);
    return found;
  };
  const decimals = number => (/\.(\d+)/.exec(number)?.[1] ?? "").length;
  const [x, y, z] = await drag([]);
  assert.equal(y, "1");
  assert.ok(x !== "-1.6" && z !== "0", `${x} ${z}`);
  for (const it of [x, z]) assert.ok(decimals(it) <= 1, it);
  assert.notEqual((await drag(["Shift"]))[1], "1");
  const free = await drag(["Control"]);
  assert.equal(free[1], "1");
  assert.ok(Math.max(...free.map(decimals)) > 1, String(free));
});

test("a snapping handle stays near the pointer and returns to its starting point", async t => {
  const page = await open(await launch(t), await host(t));
  await page.selectOption("#objects", { label: "Crate (box)" });
  await page.waitForSelector("#handles .handle");
  for (const label of ["Crate: max y", "Crate: max x", "Crate: center"]) {
    const from = await handle(page, label);
    await hand(page, from, [24, -37], { back: true, steps: 24 });
    await rested(page);
    assert.equal(await text(page), FIGURE, label);
  }
});

test("the right button orbits, the middle one pans, Shift and the wheel dolly, and fov shows d", async t => {
  const page = await open(await launch(t), await host(t));
  const [x, y] = await onPage(page, [900, 600]);
  for (const [button, changed] of [["right", /eye/], ["middle", /lookat/]]) {
    const before = await text(page);
    await page.mouse.move(x, y);
    await page.mouse.down({ button });
    for (let i = 1; i <= 12; i++) {
      await page.mouse.move(x + 5 * i, y + 2 * i);
      await page.waitForTimeout(16);
    }
    await page.mouse.up({ button });
    await rested(page);
    const line = pattern => text => text.split("\n").find(it => pattern.test(it));
    assert.notEqual(line(changed)(await text(page)), line(changed)(before), button);
    await page.click("#undo");
    await rested(page);
    assert.equal(await text(page), before, button);
  }
  await page.mouse.move(x, y);
  await page.keyboard.down("Shift");
  for (let i = 0; i < 4; i++) await page.mouse.wheel(0, 120);
  await page.keyboard.up("Shift");
  await page.waitForFunction(() => !document.querySelector(".cm-content").textContent.includes("(3, 3.5, 8)"));
  await page.waitForTimeout(700);
  await page.click("#undo");
  await rested(page);
  assert.equal(await text(page), FIGURE);
  // Keys for tools work unless the focus is in a text field.
  await page.focus("#save");
  await page.keyboard.press("v");
  assert.match(await page.textContent("#camera-menu summary"), /view distance/);
  await hand(page, [x, y], [0, 60], { hold: true });
  await page.waitForFunction(() => /camera\.d = .*d [\d.]+ = fov [\d.]+° of a window 2 high/.test(document.querySelector("#drag-note").textContent));
  await page.mouse.up();
});

test("a text pasted over one with errors has no error marks", async t => {
  const page = await open(await launch(t), await host(t));
  await type(page, FIGURE.replace("radius 1", "radios 1"));
  await page.waitForSelector(".cm-lint-marker");
  await andFinished(page, () => type(page, FIGURE));
  await rested(page);
  assert.equal(await page.textContent("#problems"), "No problems");
  assert.equal(await page.locator(".cm-lint-marker, .cm-lintRange").count(), 0);
});

test("the first problem is shown with its fix above the sliders, and the list holds a thousand", async t => {
  const page = await open(await launch(t), await host(t, `let r = 1\n${FIGURE.replace("radius 1", "radius r")}`));
  await page.waitForSelector("#sliders:not([hidden])");
  await type(page, `let r = 1\n${FIGURE.replace("radius 1", "radios r")}`);
  await page.waitForSelector("#problem-list .fix");
  assert.ok(await page.isVisible("#sliders"));
  assert.ok((await page.locator("#problem-list").boundingBox()).height < 120);
  await page.click("#problem-list .fix");
  await page.waitForSelector("#problem-list", { state: "hidden" });
  assert.match(await text(page), /radius r/);
  await page.waitForSelector("#sliders:not([hidden])");
  await type(page, "sphere { radios 1 }\n".repeat(1000));
  await page.waitForFunction(() => /^2001 problems/.test(document.querySelector("#problems").textContent));
  await page.click("#problems");
  await page.waitForFunction(() => document.querySelectorAll("#problem-list li").length >= 2001);
  const [list, scrolled] = await page.locator("#problem-list").evaluate(it => [it.clientHeight, it.scrollHeight]);
  assert.ok(list < 300 && scrolled > 10_000, `${list} ${scrolled}`);
});

test("beside a long fix, the first error has half of the width, and comes before warnings", async t => {
  const page = await open(await launch(t), await host(t));
  for (const text of ["", "camera {}"]) {
    await type(page, text);
    await page.waitForSelector("#problem-list .error .fix");
    const [place, list] = await Promise.all([".error .place", ""].map(it => page.locator(`#problem-list ${it}`).boundingBox()));
    assert.ok(place.width > 0.4 * list.width, `${text}: ${place.width} of ${list.width}`);
  }
});

test("vanishing points outside the page are arrows, and an empty layer gives a reason", async t => {
  const page = await open(await launch(t), await host(t));
  await page.click("summary:text('Show')");
  for (const name of ["vanishing", "near"]) await page.check(`input[name=${name}]`);
  await page.keyboard.press("Escape");
  await page.waitForFunction(() => document.querySelectorAll("#lines text.mark").length === 3);
  const marks = await page.locator("#lines text.mark").evaluateAll(all => all.map(it => [it.textContent, it.getBoundingClientRect().toJSON()]));
  const stage = await page.locator("#stage").boundingBox();
  for (const [label, { x, y, width, height }] of marks) {
    assert.match(label, /^[xyz] \(-?\d+, -?\d+\)$/);
    assert.ok(x >= stage.x && y >= stage.y && x + width <= stage.x + stage.width && y + height <= stage.y + stage.height, label);
  }
  assert.match(await page.textContent("#unseen"), /Near and far cut no checkerboard/);
  // At a smaller zoom, the point itself is visible, so no arrow points to it.
  for (let i = 0; i < 4; i++) await page.click("#zoom-out");
  assert.equal(await page.locator("path.line.axis-y[transform^=translate]").count(), 0);
});

test("the tools fit one row at 1280, and the projector window needs no server", async t => {
  const page = await open(await launch(t), await host(t));
  await page.selectOption("#objects", { label: "Ball (sphere)" });
  await page.waitForSelector("#along:not([hidden])");
  assert.ok((await page.locator(".tools").boundingBox()).height < 50);
  const [popup] = await Promise.all([page.waitForEvent("popup"), menu(page, "Help", "#projector")]);
  let sockets = 0;
  popup.on("websocket", () => sockets++);
  await finished(popup);
  assert.deepEqual(await popup.evaluate(() => [...document.querySelectorAll("body *")].filter(it => it.checkVisibility() && !["MAIN", "SECTION", "DIV"].includes(it.tagName)).map(it => it.tagName)), ["CANVAS"]);
  const pixel = page => page.evaluate(() => [...document.querySelector("canvas").getContext("2d").getImageData(640, 360, 1, 1).data].join());
  const before = await pixel(popup);
  assert.equal(before, await pixel(page));
  await type(page, FIGURE.replace("let ball = (-1.6, 1, 0)", "let ball = (0.2, 1, 2)"));
  await rested(page);
  await popup.waitForFunction(before => [...document.querySelector("canvas").getContext("2d").getImageData(640, 360, 1, 1).data].join() !== before, before);
  // A reloaded page still sends its pictures to the projector window.
  page.on("dialog", dialog => dialog.accept());
  await page.reload();
  await finished(page);
  await page.waitForTimeout(300);
  await popup.waitForFunction(before => [...document.querySelector("canvas").getContext("2d").getImageData(640, 360, 1, 1).data].join() === before, before);
  await type(page, FIGURE.replace("let ball = (-1.6, 1, 0)", "let ball = (0.2, 1, 2)"));
  await popup.waitForFunction(before => [...document.querySelector("canvas").getContext("2d").getImageData(640, 360, 1, 1).data].join() !== before, before);
  assert.equal(sockets, 0);
});

test("the reference of the language is in the page", async t => {
  const page = await open(await launch(t), await host(t));
  await menu(page, "Help", "#language");
  const said = await page.textContent("#language-dialog");
  for (const word of ["checkerboard", "centroid", "fov"]) assert.ok(said.includes(word), word);
  // The figures of the reference are shown, each with a text for screen readers.
  const figures = await page.$$eval("#language-dialog img", all => all.map(it => [it.naturalWidth > 0, it.alt.length > 20, it.getBoundingClientRect().right < innerWidth]));
  assert.ok(figures.length > 2 && figures.flat().every(Boolean), String(figures));
  await page.keyboard.press("Escape");
  await page.waitForSelector("#language-dialog", { state: "hidden" });
});

test("at each window size the picture fills its space", async t => {
  const [started, browser] = [await host(t), await launch(t)];
  for (const [width, height, least] of [[1280, 800, 700], [1920, 1080, 1060], [820, 1180, 760]]) {
    const page = await open(browser, started, { viewport: { width, height } });
    assert.ok((await page.locator("#canvas").boundingBox()).width >= least, `${width}`);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
    await page.context().close();
  }
});

test("a phone has two rows of header and tools, one on its side, and selecting moves nothing", async t => {
  const [started, browser] = [await host(t), await launch(t)];
  for (const [width, height, header, tools] of [[390, 844, 110, 115], [360, 740, 110, 115], [320, 640, 110, 115], [844, 390, 60, 62], [768, 1024, 60, 62]]) {
    const page = await open(browser, started, { viewport: { width, height }, hasTouch: true, isMobile: true });
    const stage = await page.locator("#stage").boundingBox();
    await page.selectOption("#objects", { label: "Ball (sphere)" });
    await page.waitForSelector("#along:not([hidden])");
    for (const [at, most] of [["header", header], [".tools", tools]]) assert.ok((await page.locator(at).boundingBox()).height <= most, `${at} at ${width}`);
    assert.deepEqual(await page.locator("#stage").boundingBox(), stage, `${width}`);
    await andFinished(page, () => type(page, `${FIGURE}// more\n`));
    await tab(page, "picture");
    const { scrollWidth, clientWidth, right } = await page.locator("#file-state").evaluate(it => ({ scrollWidth: it.scrollWidth, clientWidth: it.clientWidth, right: it.getBoundingClientRect().right }));
    assert.ok(scrollWidth <= clientWidth + 1 && right <= (await page.locator("#undo").boundingBox()).x, `not saved is cut at ${width}`);
    await page.locator("#undo").click();
    await finished(page);
    const cut = await page.evaluate(() => [...document.querySelectorAll("button, summary")].filter(it => it.checkVisibility({ visibilityProperty: true }) && it.scrollWidth > it.clientWidth + 1).map(it => it.textContent));
    assert.deepEqual(cut, [], `${width}`);
    // What the button opens is below the text, which a phone shows in another tab.
    await page.click("#lessons");
    await page.waitForSelector("#lesson:not([hidden])");
    assert.ok(await page.isVisible("#lesson"), `${width}`);
    await page.context().close();
  }
});

test("at each width the name of the selected object is readable", async t => {
  const [browser, started] = [await launch(t), await host(t)];
  for (const hasTouch of [false, true]) for (const width of [350, 390, 560, 761, 1280]) {
    const page = await open(browser, started, { viewport: { width, height: 844 }, hasTouch, isMobile: hasTouch });
    await page.waitForTimeout(100);
    const [has, needs] = await page.evaluate(() => {
      const menu = document.querySelector("#objects");
      const copy = menu.cloneNode();
      copy.append(new Option("No object"));
      Object.assign(copy.style, { position: "absolute", flex: "none", width: "max-content", maxWidth: "none", minWidth: "0" });
      menu.after(copy);
      const widths = [menu, copy].map(it => it.getBoundingClientRect().width);
      copy.remove();
      return widths;
    });
    assert.ok(has >= needs - 0.5, `${width}: ${has} of ${needs}`);
  }
});
