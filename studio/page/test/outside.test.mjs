// Tests of the view from outside: its drags by a real pointer and by keys, what it draws, and where
// it is shown.

import assert from "node:assert/strict";
import { test } from "node:test";
import { andFinished, FIGURE, hand, host, launch, link, menu, onPage, open, rested, text, type } from "./helpers.mjs";

/** Waits until the view from outside has its handles, its picture, and rests. */
async function outside(page) {
  await page.waitForFunction(() => document.querySelector("#outside-canvas").dataset.fineness === "final" && document.querySelector("#outside-handles .handle") !== null);
  await rested(page);
}

const named = (page, name) => page.locator(`#outside-handles .handle[data-object=null][data-handle=${name}]`);

const center = async locator => {
  const { x, y, width, height } = await locator.boundingBox();
  return [x + width / 2, y + height / 2];
};

const number = (text, field) => Number(new RegExp(`\\b${field}\\s+(-?[\\d.]+)`).exec(text)[1]);
const vector = (text, field) => new RegExp(`\\b${field}\\s+\\(([^)]*)\\)`).exec(text)[1].split(",").map(Number);

/** Returns the labels that are drawn beside handles. */
const labels = page => page.locator("#outside-lines text").allTextContents();

/** Chooses Start, Top, Side or Front. */
async function look(page, name) {
  const before = await page.evaluate(() => document.querySelector("#outside-handles").innerHTML);
  await page.click(`#dock button:text("${name}")`);
  await page.waitForFunction(before => document.querySelector("#outside-handles").innerHTML !== before, before);
  await outside(page);
}

test("the window dragged away from the eye narrows the angle, and Undo takes the drag back", async t => {
  const page = await open(await launch(t), await host(t));
  await outside(page);
  assert.ok((await labels(page)).includes("view_height 2, angle 40.0°"));
  await hand(page, await center(named(page, "d")), [60, 5], { hold: true });
  await page.waitForFunction(() => /camera\.d = /.test(document.querySelector("#outside #drag-note")?.textContent));
  assert.ok(await page.locator("#outside-lines[data-camera-held]").count(), "the dragged camera is highlighted");
  await page.mouse.up();
  await rested(page);
  const d = number(await text(page), "d");
  assert.ok(d > 3.2 && d < 5, `${d}`);
  const angle = 2 * Math.atan(1 / d) * 180 / Math.PI;
  assert.ok((await labels(page)).includes(`view_height 2, angle ${angle.toFixed(1)}°`), `${await labels(page)}`);
  await page.keyboard.press("Control+z");
  assert.equal(await text(page), FIGURE);
});

test("each handle of the camera changes its own field", async t => {
  const scene = FIGURE.replace("d      2.75", "d      2.75\n  near   1\n  far    14");
  const page = await open(await launch(t), await host(t, scene));
  await outside(page);
  for (const [name, by] of [["eye", [20, -30]], ["lookat", [-30, 10]], ["d", [40, 4]], ["view_height", [4, 20]], ["up", [14, 4]], ["near", [20, 10]], ["far", [-30, -20]]]) {
    if (name === "far") {
      // The far plane is beyond the view that was chosen for the rest.
      await page.focus("#outside");
      for (let i = 0; i < 5; i++) await page.keyboard.press("-");
      await outside(page);
    }
    const before = await text(page);
    const from = await center(named(page, name));
    await hand(page, from, by);
    await rested(page);
    const after = await text(page);
    const fields = text => Object.fromEntries([...text.matchAll(/^\s+(\w+)\s+(.*)$/gm)].map(([, field, value]) => [field, value]));
    const [a, b] = [fields(before), fields(after)];
    const changed = Object.keys(b).filter(field => a[field] !== b[field]);
    assert.deepEqual(changed, [name], after);
    const to = await center(named(page, name));
    if (["eye", "lookat"].includes(name)) assert.ok(Math.hypot(to[0] - from[0] - by[0], to[1] - from[1] - by[1]) < 9, `${name} at ${to} instead of ${from} + ${by}`);
  }
});

test("the window and its edge change the fov of a camera that has one", async t => {
  const page = await open(await launch(t), await host(t, FIGURE.replace("d      2.75", "fov    40deg")));
  await outside(page);
  await hand(page, await center(named(page, "fov")), [0, -14]);
  await rested(page);
  const wider = number(await text(page), "fov");
  assert.ok(wider > 41, `${wider}`);
  await hand(page, await center(named(page, "d")), [60, 5]);
  await rested(page);
  const narrower = number(await text(page), "fov");
  assert.ok(narrower < wider - 5, `${narrower} of ${wider}`);
  assert.ok((await labels(page)).includes(`fov ${narrower.toFixed(1)}°`), `${await labels(page)}`);
});

test("an object is dragged along the floor, and what is dragged in the picture is highlighted", async t => {
  const page = await open(await launch(t), await host(t));
  await outside(page);
  await page.selectOption("#objects", { label: "Crate (box)" });
  const own = page.locator('#outside-handles .handle[aria-label="Outside, Crate: center"]');
  const [x, y] = await center(own);
  // Beside the handle, the crate itself is pressed.
  await hand(page, [x + 17, y + 17], [-25, 14]);
  await rested(page);
  const [a, b, c] = vector(/box.*/.exec(await text(page))[0], "center");
  assert.equal(b, 0.75);
  assert.ok(Math.hypot(a - 2, c + 0.5) > 0.3, `${[a, b, c]}`);
  const after = await center(own);
  assert.ok(Math.hypot(after[0] - x + 25, after[1] - y - 14) < 10, `${after} from ${[x, y]}`);
  await hand(page, await onPage(page, [455, 320]), [30, 0], { hold: true });
  await page.waitForSelector("#outside-lines .held", { state: "attached" });
  await page.mouse.up();
  await page.waitForSelector("#outside-lines .held", { state: "detached" });
  // The main picture has its note back.
  assert.ok(await page.locator("#stage #drag-note").count());
});

test("a drag beside objects turns the view, and keys and the wheel move it, without a change of the text", async t => {
  const page = await open(await launch(t), await host(t));
  await outside(page);
  const { x, y, width, height } = await page.locator("#outside").boundingBox();
  const start = await center(named(page, "eye"));
  const differs = async (what, least = 6) => {
    await outside(page);
    const [a, b] = await center(named(page, "eye"));
    assert.ok(Math.hypot(a - start[0], b - start[1]) > least, `${what}: ${[a, b]} is ${start}`);
  };
  const same = async what => {
    await page.waitForFunction(() => true);
    await outside(page);
    const [a, b] = await center(named(page, "eye"));
    assert.ok(Math.hypot(a - start[0], b - start[1]) < 2, `${what}: ${[a, b]} is not ${start}`);
  };
  await hand(page, [x + 60, y + height - 15], [40, 12]);
  await differs("orbit");
  await page.click('#dock button:text("Start")');
  await same("Start");
  await hand(page, [x + 60, y + height - 15], [40, 12], { hold: true });
  await page.keyboard.press("Escape");
  await page.mouse.up();
  await same("Escape");
  await page.focus("#outside");
  await page.keyboard.press("ArrowLeft");
  await differs("an arrow key");
  await page.keyboard.press("0");
  await same("0");
  await page.keyboard.press("-");
  await differs("minus");
  await page.keyboard.press("0");
  await same("0");
  await page.mouse.move(x + width / 2, y + height / 2);
  await page.mouse.wheel(0, 200);
  await differs("the wheel");
  await page.keyboard.down("Shift");
  await hand(page, [x + 60, y + height - 15], [0, -20]);
  await page.keyboard.up("Shift");
  await differs("Shift");
  for (const name of ["Top", "Side", "Front", "Start"]) await look(page, name);
  await same("Start");
  assert.equal(await text(page), FIGURE);
});

test("arrow keys move the handle that has the focus, as one undo step", async t => {
  const page = await open(await launch(t), await host(t));
  await outside(page);
  await named(page, "d").focus();
  for (let i = 0; i < 4; i++) await page.keyboard.press("ArrowRight");
  await page.waitForTimeout(600);
  await rested(page);
  assert.ok(number(await text(page), "d") > 3.2, await text(page));
  assert.equal(await page.evaluate(() => document.activeElement.dataset.handle), "d");
  await page.keyboard.press("Control+z");
  assert.equal(await text(page), FIGURE);
});

test("the ray through the pixel under the pointer is drawn", async t => {
  const page = await open(await launch(t), await host(t));
  await outside(page);
  await page.mouse.move(...(await onPage(page, [455, 320])));
  await page.waitForSelector("#outside-lines .ray", { state: "attached" });
  assert.equal(await page.locator("#outside-lines .met").count(), 2);
  await page.mouse.move(...(await onPage(page, [455, 5])));
  await page.waitForFunction(() => document.querySelectorAll("#outside-lines .met").length === 1);
  await page.mouse.move(200, 300);
  await page.waitForSelector("#outside-lines .ray", { state: "detached" });
});

test("it is hidden and shown by a button, the menu and a key, which is remembered", async t => {
  const page = await open(await launch(t), await host(t));
  await outside(page);
  const height = () => page.evaluate(() => document.querySelector("#stage").clientHeight);
  const before = await height();
  await page.click("#outside-hide");
  assert.ok(await page.isHidden("#outside"));
  assert.ok((await height()) > before);
  await page.reload();
  await page.waitForSelector("#stage");
  assert.ok(await page.isHidden("#outside"));
  await page.focus("#stage");
  await page.keyboard.press("u");
  await outside(page);
  await menu(page, "Show", "#outside-shown");
  assert.ok(await page.isHidden("#outside"));
});

test("without a camera, or with an error, it keeps what it had, and says so", async t => {
  const page = await open(await launch(t), await host(t));
  await outside(page);
  await type(page, FIGURE.replace("camera  {", "camra {"));
  await page.waitForFunction(() => document.querySelector("#outside-note").textContent !== "");
  assert.equal(await page.locator("#outside-handles .handle").count(), 0);
  assert.ok(await page.isVisible("#outside-canvas"));
  await andFinished(page, () => type(page, FIGURE));
  await outside(page);
  assert.equal(await page.textContent("#outside-note"), "");
});

test("a link holds the view that was chosen, and another scene gets a view of its own", async t => {
  const browser = await launch(t);
  const started = await host(t);
  const page = await open(browser, started);
  await outside(page);
  assert.doesNotMatch(await link(page), /view=/);
  await page.click("#share-dialog >> text=Close");
  await page.focus("#outside");
  for (let i = 0; i < 3; i++) await page.keyboard.press("ArrowLeft");
  await outside(page);
  const places = async page => JSON.stringify(await page.locator("#outside-handles .handle").evaluateAll(them => them.map(it => it.style.transform.match(/-?[\d.]+px/g).map(it => Math.round(parseFloat(it))))));
  const expected = await places(page);
  const address = await link(page);
  assert.match(address, /#scene=[\w-]+&view=(-?[\d.]+,){5}-?[\d.]+$/);
  const token = new URL(started.address).hash.slice(1);
  const other = await open(browser, { address: `${address}&${token}` });
  await outside(other);
  assert.equal(await places(other), expected);
  await other.reload();
  await outside(other);
  assert.equal(await places(other), expected);
  await other.click('summary:text("File")');
  await andFinished(other, () => other.click('#examples button:text("camera inside the box")').catch(() => other.locator("#examples button").nth(4).click()));
  await outside(other);
  assert.notEqual(await places(other), expected);
});

for (const [width, height, isShown] of [[1280, 720, true], [1920, 1080, true], [820, 1180, true], [400, 800, false], [844, 390, false], [640, 400, false]]) {
  test(`at ${width} × ${height} it is ${isShown ? "" : "not "}there, and nothing is wider than the page`, async t => {
    const page = await open(await launch(t), await host(t), { viewport: { width, height } });
    if (isShown) await outside(page);
    const found = await page.evaluate(() => ({
      isShown: document.querySelector("#outside").clientHeight > 0,
      high: document.querySelector("#outside").clientHeight,
      stage: document.querySelector("#stage").clientHeight,
      wide: document.documentElement.scrollWidth,
      tall: document.documentElement.scrollHeight,
    }));
    assert.equal(found.isShown, isShown);
    assert.ok(found.wide <= width, `${found.wide}`);
    if (!isShown) return;
    assert.ok(found.high >= 180 && found.stage >= 250 && found.tall <= height, JSON.stringify(found));
    // Nothing of the handles lies outside of the dock when the view is chosen.
    const dock = await page.locator("#outside").boundingBox();
    for (const name of ["eye", "lookat", "d", "view_height"]) {
      const [x, y] = await center(named(page, name));
      assert.ok(x > dock.x && x < dock.x + dock.width && y > dock.y && y < dock.y + dock.height, name);
    }
  });
}

test("with 100 000 objects it shows the camera and the selected object alone", async t => {
  const many = `${FIGURE.replace(/per_pixel +\d+/, "per_pixel 1")}sphere Dot for i < 400, j < 250 { center (i * 0.1 - 20, 0.02, j * 0.1 - 20) radius 0.02 }\n`;
  const page = await open(await launch(t), await host(t, many));
  await page.waitForFunction(() => document.querySelector("#outside-handles .handle") !== null, null, { timeout: 30_000 });
  await page.waitForTimeout(500);
  assert.equal(await page.locator("#outside-handles .handle").count(), 6);
});

test("the printed page has the view from outside", async t => {
  const page = await open(await launch(t), await host(t));
  await outside(page);
  await page.evaluate(() => dispatchEvent(new Event("beforeprint")));
  await page.emulateMedia({ media: "print" });
  await rested(page);
  assert.ok(await page.isVisible("#outside-canvas"));
  for (const hidden of [".dock-tools", "#outside-handles"]) assert.ok(await page.isHidden(hidden), hidden);
});
