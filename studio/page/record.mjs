// Records the README's animation, examples/studio.gif, from the real page: the ball is dragged, and
// its numbers change. Needs `npm ci`; PINHOLE and CHROMIUM are as for the tests.

import { writeFileSync } from "node:fs";
import gifenc from "gifenc";
import { chromium } from "playwright-core";
import png from "pngjs";
import { finished, host, open } from "./test/helpers.mjs";

const WIDTH = 960;
const HEIGHT = 520;
/** Durations of a frame during a movement and at rest, in milliseconds. */
const MOVING = 60;
const RESTING = 1200;
/** Palette index of pixels that stay as they were. */
const SAME = 255;

const cleaning = [];
const context = { after: act => cleaning.unshift(act) };
const { encoder, add } = recorder();
try {
  const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox"] });
  context.after(() => browser.close());
  const page = await open(browser, await host(context), { viewport: { width: WIDTH, height: HEIGHT }, colorScheme: "light" });
  await page.evaluate(drawPointer);
  const { x, y } = await seen(page, "center", "Ball");
  await page.mouse.move(x, y);
  await shoot(page, RESTING);
  await page.mouse.down();
  // To the right past the sail, up, and back.
  const way = [[0, 0], [0.34, 0], [0.17, -0.32], [0, 0]].map(([right, down]) => [x + right * 380, y + down * 380]);
  for (const [index, from] of way.slice(0, -1).entries()) {
    const to = way[index + 1];
    for (let step = 1; step <= 12; step += 1) {
      const part = (1 - Math.cos((Math.PI * step) / 12)) / 2;
      await page.mouse.move(from[0] + part * (to[0] - from[0]), from[1] + part * (to[1] - from[1]));
      await shoot(page, step === 12 ? RESTING / 3 : MOVING);
    }
  }
  await page.mouse.up();
  await shoot(page, RESTING);
} finally {
  for (const act of cleaning) await act();
}
encoder.finish();
writeFileSync(new URL("../../examples/studio.gif", import.meta.url), encoder.bytes());
console.log(`examples/studio.gif: ${encoder.bytes().length} bytes`);

/** Returns the position of an object's handle in the window. */
async function seen(page, handle, object) {
  await page.getByRole("combobox").first().selectOption({ label: `${object} (sphere)` });
  const box = await page.locator(`[data-handle="${handle}"]`).first().boundingBox();
  return { x: box.x + box.width / 2, y: box.y + box.height / 2 };
}

/** Draws a pointer, which screenshots lack. */
function drawPointer() {
  const pointer = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  pointer.setAttribute("viewBox", "0 0 16 16");
  pointer.innerHTML = '<path d="M1 1v12l3-3 2 5 2-1-2-5h4z" fill="white" stroke="black"/>';
  Object.assign(pointer.style, { position: "fixed", width: "18px", zIndex: "99", pointerEvents: "none" });
  document.body.append(pointer);
  addEventListener("pointermove", event => Object.assign(pointer.style, { left: `${event.clientX}px`, top: `${event.clientY}px` }), true);
}

async function shoot(page, shown) {
  await page.waitForTimeout(80);
  await finished(page);
  add(png.PNG.sync.read(await page.screenshot()), shown);
}

/** Makes a GIF whose frames hold only changed pixels and share the first frame's palette. */
function recorder() {
  const encoder = gifenc.GIFEncoder();
  let palette;
  let before;
  const add = ({ data, width, height }, delay) => {
    palette ??= gifenc.quantize(data, SAME);
    const indexed = gifenc.applyPalette(data, palette);
    const changes = before ? indexed.map((index, at) => (index === before[at] ? SAME : index)) : indexed;
    // The palette is filled up to 256 colours. The last one, with index `SAME`, is not visible.
    const colors = [...palette, ...Array.from({ length: 256 - palette.length }, () => [0, 0, 0])];
    encoder.writeFrame(changes, width, height, { palette: before ? undefined : colors, delay, transparent: before !== undefined, transparentIndex: SAME, dispose: 1 });
    before = indexed;
  };
  return { encoder, add };
}
