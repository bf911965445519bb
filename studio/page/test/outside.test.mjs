// Tests of the view from outside: its drags by a real pointer and by keys, what it draws, and where
// it is shown.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { andFinished, FIGURE, hand, host, launch, link, menu, onPage, open, rested, text, type } from "./helpers.mjs";

/** Waits until the view from outside shows its handles and its final picture, and nothing
 * changes. */
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

/** Returns the names of handles that are drawn in the view from outside. */
const labels = page => page.locator("#outside-lines text").allTextContents();

/** Chooses a view by the name of its button: Start, Top, Side or Front. */
async function look(page, name) {
  const before = await page.evaluate(() => document.querySelector("#outside-handles").innerHTML);
  await page.click(`#dock button:text("${name}")`);
  await page.waitForFunction(before => document.querySelector("#outside-handles").innerHTML !== before, before);
  await outside(page);
}

/** A scene whose far plane is below the view from outside in a window of 1280×720. */
const DEEP = `image { width 640  height 360 }
camera { eye (4, 3, 8)  lookat (0, 1, 0)  d 2  near 1  far 40 }
sphere { center (-1.5, 1, 0) }
box { center (2, 1.5, -1)  size (1, 3, 1) }
checkerboard {}
`;

test("a handle beyond the border that gets the focus scrolls neither the picture nor the view from outside", async t => {
  const page = await open(await launch(t), await host(t, DEEP), { viewport: { width: 1280, height: 720 } });
  await outside(page);
  let beyond = 0;
  for (const place of ["#outside", "#stage"]) {
    const { y, height } = await page.locator(place).boundingBox();
    for (const handle of await page.locator(`${place} .handle`).all()) {
      const box = await handle.boundingBox();
      beyond += Number(box !== null && box.y > y + height);
      await handle.focus();
      assert.deepEqual(await page.locator(place).evaluate(it => [it.scrollLeft, it.scrollTop]), [0, 0], place);
    }
  }
  assert.ok(beyond > 0);
});

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
      // The far plane lies outside of the view at first, so the view is zoomed out.
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

test("a window dragged past the eye stays just in front of it, however fast, and follows the pointer back", async t => {
  for (const steps of [2, 20]) {
    const page = await open(await launch(t), await host(t));
    await outside(page);
    const [from, eye] = [await center(named(page, "d")), await center(named(page, "eye"))];
    const past = [0, 1].map(axis => 3 * (eye[axis] - from[axis]));
    await hand(page, from, past, { steps, hold: true });
    await rested(page);
    assert.equal(number(await text(page), "d"), 0.03, "a hundredth of 2.75, in steps of 0.01");
    await page.mouse.move(...from, { steps: 5 });
    await page.mouse.up();
    await rested(page);
    assert.ok(Math.abs(number(await text(page), "d") - 2.75) < 0.06, await text(page));
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
  // The pointer is pressed beside the handle, on the crate itself.
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
  // After the drag of the ball, the element for the note is in the main picture again.
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
  // A small window has no room for the view or the glass, and the page says so.
  for (const key of ["u", "g"]) {
    await page.setViewportSize({ width: 700, height: 700 });
    await page.focus("#stage");
    await page.keyboard.press(key);
    assert.match(await page.textContent("#said"), /needs a wider or higher window/);
    await page.setViewportSize({ width: 1280, height: 800 });
    assert.ok(await page.isHidden("#dock"), key);
  }
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
  await andFinished(other, () => other.click('#examples button:text-is("straight down")'));
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
    // In the view that the server has chosen, these handles lie within the dock.
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

test("a camera that a change of the text moves out of the view is shown again", async t => {
  const page = await open(await launch(t), await host(t));
  await outside(page);
  const isInside = async name => {
    if (await named(page, name).count() === 0) return false;
    const [x, y] = await center(named(page, name));
    const box = await page.locator("#outside").boundingBox();
    return x >= box.x && x <= box.x + box.width && y >= box.y && y <= box.y + box.height;
  };
  await type(page, FIGURE.replace(/eye .*/, "eye    (0, 12, 40)"));
  await outside(page);
  for (const name of ["eye", "d", "up"]) assert.ok(await isInside(name), name);
  // If the user has zoomed so far that the camera is outside of the view, the view stays.
  await page.focus("#outside");
  for (let i = 0; i < 12; i++) await page.keyboard.press("=");
  await outside(page);
  assert.ok(!(await isInside("eye")));
});

test("the main picture is finished while the server chooses another view", async t => {
  const page = await open(await launch(t), await host(t));
  await outside(page);
  const sent = [];
  const session = await page.context().newCDPSession(page);
  await session.send("Network.enable");
  session.on("Network.webSocketFrameSent", ({ response }) => sent.push(response.payloadData));
  await page.locator(".cm-line").getByText("2.75", { exact: true }).click();
  await page.keyboard.press("End");
  for (const [i, name] of ["Top", "Side", "Front", "Start", "Top", "Side"].entries()) {
    await andFinished(page, async () => {
      await page.keyboard.press(i % 2 === 0 ? "Backspace" : "5");
      await page.waitForTimeout(40 * i);
      await page.evaluate(name => [...document.querySelectorAll("#dock button")].find(it => it.textContent === name).click(), name);
    });
  }
  // A request for a frame without a view would replace the request for the main picture.
  assert.ok(sent.length > 20);
  assert.deepEqual(sent.filter(it => it.includes("pinhole/frame") && it.includes('"view":null')), []);
});

test("two fingers zoom and shift the view, one turns it, and the text stays", async t => {
  const page = await open(await launch(t), await host(t), { viewport: { width: 820, height: 1180 }, hasTouch: true });
  await outside(page);
  const session = await page.context().newCDPSession(page);
  const touch = (type, ...points) => session.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
  const { x, y, height } = await page.locator("#outside").boundingBox();
  // In the lower left corner, no object is under the fingers.
  const [left, low] = [x + 60, y + height - 20];
  const places = async () => {
    await outside(page);
    return Promise.all(["eye", "lookat"].map(name => center(named(page, name))));
  };
  const apart = ([a, b]) => Math.hypot(a[0] - b[0], a[1] - b[1]);
  const before = await places();
  await touch("touchStart", [left, low]);
  await touch("touchStart", [left, low], [left + 60, low]);
  for (let i = 1; i <= 6; i++) await touch("touchMove", [left, low], [left + 60 + 5 * i, low]);
  await touch("touchEnd");
  const nearer = await places();
  // The fingers have moved apart, so the view is zoomed.
  assert.ok(apart(nearer) > 1.3 * apart(before), `${apart(before)} ${apart(nearer)}`);
  await page.click('#dock button:text("Start")');
  assert.ok(apart([(await places())[0], before[0]]) < 2);
  await touch("touchStart", [left, low]);
  await touch("touchStart", [left, low], [left + 60, low]);
  for (let i = 1; i <= 6; i++) {
    await touch("touchMove", [left + 6 * i, low - 3 * i], [left + 60 + 6 * (i - 1), low - 3 * (i - 1)]);
    await touch("touchMove", [left + 6 * i, low - 3 * i], [left + 60 + 6 * i, low - 3 * i]);
  }
  await touch("touchEnd");
  const shifted = await places();
  // Both points move in the direction of the fingers. Points nearer than the middle of the view
  // move farther.
  for (const i of [0, 1]) {
    const [right, down] = [0, 1].map(axis => shifted[i][axis] - before[i][axis]);
    assert.ok(right > 20 && right < 80 && Math.abs(right + 2 * down) < 6, `${right} ${down}`);
  }
  await page.click('#dock button:text("Start")');
  await places();
  await touch("touchStart", [left, low]);
  await page.waitForTimeout(300);
  for (let i = 1; i <= 6; i++) await touch("touchMove", [left + 8 * i, low]);
  await touch("touchEnd");
  const turned = await places();
  assert.ok(apart([turned[0], before[0]]) > 6, "one finger turns");
  assert.equal(await text(page), FIGURE);
});

test("on a page that is higher than wide, the divider follows the pointer, and the view has what is left", async t => {
  const browser = await launch(t);
  const started = await host(t);
  const page = await open(browser, started, { viewport: { width: 820, height: 1180 } });
  await outside(page);
  const box = async id => page.locator(id).boundingBox();
  const before = await box("#outside");
  const { x, width, height } = await box("#divider");
  for (const by of [90, -60]) {
    const from = (await box("#divider")).y;
    await hand(page, [x + width / 2, from + height / 2], [0, by]);
    await outside(page);
    // The text's share of the page is rounded to whole percents, so the divider may be some pixels
    // away from the pointer.
    assert.ok(Math.abs((await box("#divider")).y - from - by) <= 8, `${by}`);
  }
  const after = await box("#outside");
  assert.ok(after.height > before.height + 15, `${before.height} ${after.height}`);
  const share = await page.getAttribute("#divider", "aria-valuenow");
  const shares = expected => page.waitForFunction(expected => document.querySelector("#divider").getAttribute("aria-valuenow") === expected, expected, { timeout: 5000 });
  await page.setViewportSize({ width: 1280, height: 720 });
  // With text and picture side by side, the text has a share of its own.
  await shares("42");
  await page.setViewportSize({ width: 820, height: 1180 });
  await shares(share);
});

test("the view is downloaded as an SVG, with its picture, the camera, and the outlines of all objects", async t => {
  const page = await open(await launch(t), await host(t, FIGURE.replace("d      2.75", "d      2.75\n  near   2\n  far    14")), { colorScheme: "dark" });
  await outside(page);
  const [download] = await Promise.all([page.waitForEvent("download"), menu(page, "Download", "#download-outside")]);
  assert.equal(download.suggestedFilename(), "scene-outside.svg");
  const svg = readFileSync(await download.path(), "utf8");
  // The SVG is shown in an empty page, without Studio's style.
  const alone = await page.context().browser().newPage();
  await alone.setContent(svg);
  const found = await alone.evaluate(async () => {
    const image = document.querySelector("image");
    const picture = new Image();
    picture.src = image.href.baseVal;
    await picture.decode();
    const shown = [...document.querySelectorAll("svg > *")].filter(it => getComputedStyle(it).display !== "none");
    const lines = shown.filter(it => it.tagName === "path" && !it.classList.contains("under"));
    return {
      picture: [picture.naturalWidth, picture.naturalHeight],
      size: ["width", "height"].map(it => Number(image.getAttribute(it))),
      labels: shown.filter(it => it.tagName === "text").map(it => it.textContent),
      outlines: lines.filter(it => it.classList.contains("outline")).length,
      camera: lines.flatMap(it => ["frustum", "rays", "window", "near", "far"].filter(name => it.classList.contains("camera") && it.classList.contains(name))),
      inks: lines.map(it => getComputedStyle(it).stroke),
      wide: document.documentElement.scrollWidth,
    };
  });
  assert.deepEqual(found.picture, found.size.map(it => 2 * it));
  for (const label of ["eye", "lookat", "near 2", "far 14"]) assert.ok(found.labels.includes(label), `${label} of ${found.labels}`);
  assert.equal(found.outlines, 3);
  assert.deepEqual(found.camera.sort(), ["far", "frustum", "near", "rays", "window"]);
  // All lines are dark, for printers without colours.
  for (const ink of found.inks) assert.ok(ink.match(/\d+/g).map(Number).reduce((sum, it) => sum + it) < 3 * 100, ink);
  // The page does not keep the outlines of the SVG. While the view is hidden, it cannot be
  // downloaded.
  await outside(page);
  assert.equal(await page.locator("#outside-lines .outline").count(), 0);
  await page.click("#outside-hide");
  assert.ok(await page.isHidden("#download-outside"));
});

test("a sheet of paper has picture, view and text on one page, whatever the window's size and colours", async t => {
  const browser = await launch(t);
  const started = await host(t);
  for (const [width, height, colorScheme] of [[1280, 720, "light"], [1920, 1080, "dark"], [820, 1180, "light"], [400, 800, "light"]]) {
    const page = await open(browser, started, { viewport: { width, height }, colorScheme });
    if (width > 760) await outside(page);
    const placed = () => page.evaluate(() => ["#canvas", "#outside-canvas", "#outside-lines text"].map(it => JSON.stringify(document.querySelector(it)?.getBoundingClientRect())));
    const before = await placed();
    const pdf = await page.pdf({ preferCSSPageSize: true });
    assert.equal((pdf.toString("latin1").match(/\/Type\s*\/Page\b/g) ?? []).length, 1, `${width}`);
    // After printing, the page is as it was before.
    await rested(page);
    if (width > 760) await outside(page);
    await page.waitForTimeout(300);
    assert.equal(await page.locator("body.paper").count(), 0);
    assert.deepEqual(await placed(), before, `${width}`);
    await page.evaluate(() => dispatchEvent(new Event("beforeprint")));
    await page.emulateMedia({ media: "print" });
    const found = await page.evaluate(() => Object.fromEntries(["#stage", "#canvas", "#outside", "#outside-canvas", "#print-text"].map(it => [it, document.querySelector(it).getBoundingClientRect().toJSON()])));
    for (const [place, picture] of width > 760 ? [["#stage", "#canvas"], ["#outside", "#outside-canvas"]] : [["#stage", "#canvas"]]) {
      const [outer, inner] = [found[place], found[picture]];
      assert.ok(Math.abs(outer.width - 180 / 25.4 * 96) < 1, `${place} at ${width}: ${outer.width}`);
      assert.ok(inner.left >= outer.left - 1 && inner.right <= outer.right + 1 && inner.width > 0.4 * outer.width, `${picture} at ${width}: ${JSON.stringify(inner)}`);
    }
    if (width < 760) assert.equal(found["#outside"].height, 0);
    assert.ok(found["#print-text"].top > found["#canvas"].bottom);
    await page.context().close();
  }
});

test("handles that are moved aside stay in the view, and the far plane is in it", async t => {
  // With a touch screen, handles are larger, so more handles are moved aside to avoid overlaps.
  const page = await open(await launch(t), await host(t, FIGURE.replace("d      2.75", "d      2.75\n  far    14")), { viewport: { width: 1280, height: 720 }, hasTouch: true });
  await outside(page);
  const box = await page.locator("#outside").boundingBox();
  for (const view of ["Top", "Side", "Front", "Start"]) {
    await look(page, view);
    const handles = page.locator("#outside-handles .handle");
    for (let i = 0; i < await handles.count(); i++) {
      const [x, y] = await center(handles.nth(i));
      assert.ok(x >= box.x && x <= box.x + box.width && y >= box.y && y <= box.y + box.height, `${view}: ${await handles.nth(i).getAttribute("aria-label")} at ${x}, ${y}`);
    }
  }
});

test("the left button turns the view with new pictures, however long one takes", async t => {
  const page = await open(await launch(t), await host(t), { late: { "pinhole/frame": 60 } });
  await outside(page);
  const { x, y, height } = await page.locator("#outside").boundingBox();
  await page.evaluate(() => {
    window.pictures = 0;
    document.querySelector("#outside-canvas").addEventListener("pinhole-frame", () => window.pictures++);
  });
  await hand(page, [x + 60, y + height - 15], [80, 20], { steps: 80, hold: true });
  const seen = await page.evaluate(() => window.pictures);
  await page.mouse.up();
  assert.ok(seen >= 3, `${seen}`);
});

test("Control with + - 0 is left to the browser, and Escape takes back that the view was chosen", async t => {
  const page = await open(await launch(t), await host(t));
  await outside(page);
  await page.evaluate(() => {
    window.taken = [];
    addEventListener("keydown", event => event.ctrlKey && event.key !== "Control" && window.taken.push(event.defaultPrevented));
  });
  const before = await center(named(page, "eye"));
  await page.focus("#outside");
  for (const key of ["-", "=", "0"]) await page.keyboard.press(`Control+${key}`);
  await outside(page);
  assert.deepEqual(await page.evaluate(() => window.taken), [false, false, false]);
  const { x, y, height } = await page.locator("#outside").boundingBox();
  await hand(page, [x + 60, y + height - 15], [40, 12], { hold: true });
  await page.waitForTimeout(300);
  await page.keyboard.press("Escape");
  await page.mouse.up();
  await outside(page);
  assert.deepEqual(await center(named(page, "eye")), before);
  assert.doesNotMatch(await link(page), /view=/);
});

test("an SVG has the same size beside the glass and from another window, and none is made of an error", async t => {
  const browser = await launch(t);
  const started = await host(t);
  const widths = [];
  for (const width of [1280, 1600]) {
    const page = await open(browser, started, { viewport: { width, height: 800 } });
    await outside(page);
    if (width === 1600) await page.focus("#stage");
    if (width === 1600) await page.keyboard.press("g");
    await outside(page);
    const [download] = await Promise.all([page.waitForEvent("download"), menu(page, "Download", "#download-outside")]);
    const svg = readFileSync(await download.path(), "utf8");
    widths.push(/<svg[^>]* width="(\d+)"/.exec(svg)[1]);
    // Some programs ignore the opacity of an image, so a translucent rectangle makes it pale.
    assert.doesNotMatch(/<image[^>]*>/.exec(svg)[0], /opacity/);
    assert.match(svg, /<image[^>]*\/><rect[^>]* fill-opacity="0\.4/);
    if (width === 1280) continue;
    await type(page, FIGURE.replace("camera  {", "camra {"));
    await page.waitForFunction(() => document.querySelector("#outside-note").textContent !== "");
    await menu(page, "Download", "#download-outside");
    await page.waitForFunction(() => /no view from outside/.test(document.querySelector("#said").textContent));
    assert.equal(await page.locator("#outside.ink").count(), 0);
  }
  assert.equal(widths[0], widths[1]);
});

test("beside the glass, the printed view and its lines have one frame, on one page, and labels do not overlap", async t => {
  const page = await open(await launch(t), await host(t), { viewport: { width: 1280, height: 720 } });
  await outside(page);
  await page.mouse.click(...(await onPage(page, [620, 330])));
  await page.keyboard.press("g");
  await page.waitForSelector("#glass-points circle");
  await outside(page);
  const pdf = await page.pdf({ preferCSSPageSize: true });
  assert.equal((pdf.toString("latin1").match(/\/Type\s*\/Page\b/g) ?? []).length, 1);
  await outside(page);
  await page.evaluate(() => dispatchEvent(new Event("beforeprint")));
  await page.emulateMedia({ media: "print" });
  const { boxes, names } = await page.evaluate(() => ({
    boxes: ["#outside", "#outside-canvas", "#outside-lines"].map(it => document.querySelector(it).getBoundingClientRect()).map(({ left, top, right, bottom }) => [left, top, right, bottom]),
    names: [...document.querySelectorAll("#outside-lines text")].map(it => ({ label: it.textContent, box: it.getBoundingClientRect().toJSON() })),
  }));
  for (const box of boxes) box.forEach((side, i) => assert.ok(Math.abs(side - boxes[0][i]) < 2, JSON.stringify(boxes)));
  assert.ok(names.length >= 4, JSON.stringify(names));
  for (const [i, { label, box: a }] of names.entries()) for (const { label: other, box: b } of names.slice(0, i))
    assert.ok(a.right <= b.left + 1 || b.right <= a.left + 1 || a.bottom <= b.top + 1 || b.bottom <= a.top + 1, `${label} and ${other}`);
});

test("a text with an error is printed with its first error and line", async t => {
  const page = await open(await launch(t), await host(t));
  await type(page, FIGURE.replace("camera  {", "camra {"));
  await page.waitForSelector("#problem-list li");
  await page.evaluate(() => dispatchEvent(new Event("beforeprint")));
  await page.emulateMedia({ media: "print" });
  assert.match(await page.innerText("#print-text"), /^scene\.scn, .*\nLine 6: there is no kind of block `camra`/);
});

test("a hint of the text before a drag is hidden until the drag has ended", async t => {
  const page = await open(await launch(t), await host(t));
  await outside(page);
  const hint = page.locator(".hint", { hasText: "fov" });
  await hint.waitFor();
  const before = await hint.textContent();
  await hand(page, await center(named(page, "d")), [60, 5], { hold: true });
  await page.waitForFunction(() => !document.querySelector(".cm-content").textContent.includes("2.75"));
  assert.ok(await hint.isHidden());
  await page.mouse.up();
  await hint.waitFor();
  assert.notEqual(await hint.textContent(), before);
});
