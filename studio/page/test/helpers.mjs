// Starts the host and a browser for the tests. Environment variables: PINHOLE is the program
// (default: `pinhole` on the path), and CHROMIUM the browser. With DIST, the page gets its script
// and style from that folder, so that the program need not be built again after each change.

import { execFileSync, spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import path from "node:path";
import { chromium } from "playwright-core";

const PINHOLE = process.env.PINHOLE ?? "pinhole";

/** Folder for the drafts of hosts. */
export const STATE = mkdtempSync(path.join(tmpdir(), "pinhole-state-"));
process.on("exit", () => rmSync(STATE, { recursive: true, force: true }));

export const FIGURE = readFileSync(new URL("../../../examples/figure_9_9.scn", import.meta.url), "utf8");

/** Starts a browser, which is closed when the test ends. */
export async function launch(context) {
  const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox", "--disable-features=LocalNetworkAccessChecks"] });
  context.after(() => browser.close());
  const folder = process.env.DIST;
  if (folder !== undefined) {
    const newContext = browser.newContext.bind(browser);
    browser.newContext = async options => {
      const created = await newContext(options);
      const fulfil = (route, path) => route.fulfill({ path, headers: { "cache-control": "no-store" } });
      for (const file of ["studio.js", "studio.css"]) await created.route(`**/${file}`, route => fulfil(route, path.join(folder, file)));
      await created.route(url => url.pathname === "/" && url.protocol === "http:", async route => {
        const response = await route.fetch().catch(() => null);
        const nonce = /nonce-([^']+)/.exec(response?.headers()["content-security-policy"])?.[1];
        if (nonce === undefined) return route.continue();
        route.fulfill({ response, body: readFileSync(path.join(folder, "index.html"), "utf8").replace("__NONCE__", nonce) });
      });
      return created;
    };
  }
  return browser;
}

/** Starts a host of a new file with the text `text`. Host and folder are removed after the test. */
export async function host(context, text = FIGURE, name = "scene.scn") {
  const folder = mkdtempSync(path.join(tmpdir(), "pinhole-studio-"));
  const file = path.join(folder, name);
  writeFileSync(file, text);
  const started = { file, folder, text: () => readFileSync(file, "utf8"), write: text => writeFileSync(file, text), ...(await serve(file)) };
  context.after(() => {
    started.stop();
    rmSync(folder, { recursive: true, force: true });
  });
  return started;
}

/** Starts a host of `file`, or of a new scene in `folder`, at the port `port` or any free one. */
export async function serve(file, { port, folder, browser, lesson } = {}) {
  const scene = file === null ? [] : [file];
  const options = [...(browser === undefined ? ["--no-open"] : []), ...(port === undefined ? [] : ["--port", port]), ...(lesson === undefined ? [] : ["--lesson", lesson])];
  // The host looks up the program that opens a browser on the path. A test may put a substitute
  // there, in the folder `browser`.
  const env = { ...process.env, XDG_STATE_HOME: STATE, PATH: browser === undefined ? process.env.PATH : `${browser}:${process.env.PATH}` };
  const child = spawn(PINHOLE, ["studio", ...scene, ...options], { cwd: folder, env, stdio: ["ignore", "ignore", "pipe"] });
  let said = "";
  const address = await new Promise((resolve, reject) => {
    child.stderr.on("data", data => {
      said += data;
      const found = /http:\/\/\S+/.exec(said);
      if (found) resolve(found[0]);
    });
    child.on("exit", () => reject(new Error(`the host ended: ${said}`)));
  });
  const ended = new Promise(resolve => child.on("exit", resolve));
  return { address, stop: signal => (child.kill(signal), ended), pid: child.pid };
}

/** Serves a folder as a web server does. Records the requests. */
export async function site(context, folder) {
  const types = { html: "text/html; charset=utf-8", js: "text/javascript", css: "text/css", wasm: "application/wasm" };
  const requests = [];
  const server = createServer((request, response) => {
    requests.push(request.url);
    const name = request.url === "/" ? "index.html" : path.basename(request.url);
    try {
      const content = readFileSync(path.join(folder, name));
      response.writeHead(200, { "content-type": types[name.split(".").pop()] ?? "text/plain" }).end(content);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise(resolve => server.listen(0, "127.0.0.1", resolve));
  context.after(() => server.close());
  return { address: `http://127.0.0.1:${server.address().port}/`, requests };
}

/** Opens the page of a host and waits for its finished picture. The browser's errors are collected
 * in `page.complaints`. */
export async function open(browser, { address }, { late, ...options } = {}) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, acceptDownloads: true, ...options });
  const page = await context.newPage();
  if (late !== undefined) await delayed(page, late);
  page.complaints = [];
  page.on("console", message => message.type() === "error" && page.complaints.push(message.text()));
  page.on("pageerror", error => page.complaints.push(error.message));
  await page.goto(address);
  await finished(page);
  return page;
}

/** Delays the host's answers. `late` gives the delay for each method, in milliseconds. */
async function delayed(page, late) {
  await page.routeWebSocket("**/socket", socket => {
    const server = socket.connectToServer();
    const asked = new Map();
    socket.onMessage(message => {
      const { id, method } = message[0] === "{" ? JSON.parse(message) : {};
      if (id !== undefined) asked.set(id, method);
      server.send(message);
    });
    server.onMessage(message => {
      const after = late[asked.get(JSON.parse(message).id)] ?? 0;
      if (after === 0) socket.send(message);
      else setTimeout(() => socket.send(message), after);
    });
  });
}

/** Waits for the finished picture of the newest text. */
export async function finished(page) {
  await page.waitForFunction(() => document.querySelector("canvas").dataset.fineness === "final", null, { timeout: 15_000 });
}

/** Calls `act`, and waits for the finished picture of the resulting text. */
export async function andFinished(page, act) {
  const before = await version(page);
  await act();
  await page.waitForFunction(
    before => {
      const { fineness, version } = document.querySelector("canvas").dataset;
      return fineness === "final" && Number(version) > before;
    },
    before,
    { timeout: 30_000 },
  );
}

export async function version(page) {
  return page.evaluate(() => Number(document.querySelector("canvas").dataset.version ?? -1));
}

/** Returns the text in the editor, without the hints. */
export async function text(page) {
  return page.evaluate(() => {
    const lines = [...document.querySelectorAll(".cm-line")].map(line => {
      const copy = line.cloneNode(true);
      for (const hint of copy.querySelectorAll(".hint")) hint.remove();
      return copy.textContent;
    });
    return lines.join("\n");
  });
}

/** Returns the link that Share offers. The dialog stays open. */
export async function link(page) {
  await page.click("#share");
  await page.waitForSelector("#share-dialog[open]");
  return page.inputValue("#share-link");
}

/** Shows the picture or the text on a phone, which has room for only one of them. */
export async function tab(page, name) {
  const button = page.locator(`#tabs [data-tab=${name}]`);
  if (await button.isVisible()) await button.click();
}

/** Replaces the whole text in the editor, as pasting does. */
export async function type(page, text) {
  await tab(page, "text");
  // A click on a colour would open the colour picker, so the click is in the corner.
  await page.click(".cm-content", { position: { x: 2, y: 5 } });
  await page.keyboard.press("Control+a");
  await page.keyboard.insertText(text);
}

/** Converts a point of the picture to one of the page, for the mouse. */
export async function onPage(page, [x, y]) {
  return page.evaluate(
    ([x, y]) => {
      const canvas = document.querySelector("canvas");
      const { left, top, width } = canvas.getBoundingClientRect();
      const zoom = width / Number(document.querySelector("#frame-state").textContent.split(" ")[0]);
      return [left + x * zoom, top + y * zoom];
    },
    [x, y],
  );
}

/** Chooses a tool. A script clicks it, because the camera's tools are in a closed menu. */
export async function choose(page, tool) {
  await page.evaluate(tool => document.querySelector(`input[name=tool][value=${tool}]`).click(), tool);
}

/** Chooses the axis or plane along which drags move objects. */
export async function hold(page, along) {
  await page.check(`input[name=along][value="${along}"]`, { force: true });
}

/** Drags from one point of the picture to another. */
export async function drag(page, from, to) {
  await page.mouse.move(...(await onPage(page, from)));
  await page.mouse.down();
  // The page first asks the server for the object under the pointer.
  await page.waitForTimeout(300);
  const [x, y] = await onPage(page, to);
  await page.mouse.move(x, y, { steps: 5 });
  await page.mouse.up();
}

/** Opens a menu and clicks an item in it. */
export async function menu(page, name, item) {
  await page.click(`summary:text("${name}")`);
  await page.click(item);
}

/** Chooses a local file in the page's menu. */
export async function openFile(page, file) {
  const [chooser] = await Promise.all([page.waitForEvent("filechooser"), menu(page, "File", "#open")]);
  await chooser.setFiles(file);
}

/** Presses at a point of the page, moves by steps at the pace of a hand, and releases. */
export async function hand(page, [x, y], [dx, dy], { steps = 12, back = false, hold = false } = {}) {
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.waitForTimeout(30);
  const part = i => (back ? 1 - Math.abs(2 * i / steps - 1) : i / steps);
  for (let i = 1; i <= steps; i++) {
    await page.mouse.move(x + dx * part(i), y + dy * part(i));
    await page.waitForTimeout(16);
  }
  if (!hold) await page.mouse.up();
}

/** Waits until the text and its picture have stopped changing. */
export async function rested(page) {
  let before = null;
  for (let same = 0; same < 4; ) {
    await page.waitForTimeout(60);
    const now = `${await version(page)} ${await text(page)}`;
    same = now === before ? same + 1 : 0;
    before = now;
  }
  await finished(page);
}

/** Returns the centre of a handle on the page. */
export async function handle(page, label) {
  const { x, y, width, height } = await page.locator(`.handle[aria-label="${label}"]`).boundingBox();
  return [x + width / 2, y + height / 2];
}

/** Returns the size and a digest of the shown picture's pixels. */
export async function pixels(page) {
  return page.evaluate(() => {
    const canvas = document.querySelector("canvas");
    return window.bytesOf(canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height));
  });
}

/** Returns the size and a digest of the pixels that the browser decodes from a PNG in base64. */
export async function decoded(page, png) {
  return page.evaluate(async png => {
    const bytes = Uint8Array.from(atob(png), letter => letter.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes], { type: "image/png" }), { colorSpaceConversion: "none" });
    const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
    const context = canvas.getContext("2d");
    context.drawImage(bitmap, 0, 0);
    return window.bytesOf(context.getImageData(0, 0, canvas.width, canvas.height));
  }, png.toString("base64"));
}

/** Adds the function `bytesOf` to the page, which `pixels` and `decoded` need. It returns the size
 * and a digest of a picture's pixels, for comparisons. */
export async function comparing(page) {
  await page.evaluate(() => {
    window.bytesOf = async ({ data, width, height }) => {
      const digest = new Uint8Array(await crypto.subtle.digest("SHA-256", data));
      return `${width}x${height} ${[...digest].map(byte => byte.toString(16).padStart(2, "0")).join("")}`;
    };
  });
}

/** Renders a scene's text with `pinhole render`, and returns the bytes of the picture's file. */
export function rendered(folder, text, kind = "png") {
  const scene = path.join(folder, "rendered.scn");
  const picture = path.join(folder, `rendered.${kind}`);
  writeFileSync(scene, text);
  execFileSync(PINHOLE, ["render", scene, "-o", picture], { stdio: "ignore" });
  return readFileSync(picture);
}
