// Takes the README's screenshots of an editor. Headless Chromium shows Monaco, the editor of VS
// Code, with the real `pinhole lsp`, from which all highlighting and all answers come.
//
//     npm ci && PINHOLE=../../../target/release/pinhole npm run shoot

import { spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { pathToFileURL } from "node:url";
import { build } from "esbuild";
import puppeteer from "puppeteer-core";
import { createProtocolConnection, StreamMessageReader, StreamMessageWriter } from "vscode-languageserver-protocol/node";
import { shots } from "./shots.mjs";

const here = import.meta.dirname;
const program = process.env.PINHOLE ?? "pinhole";
const browserPath = process.env.CHROMIUM ?? "/usr/bin/chromium";

const folder = mkdtempSync(path.join(tmpdir(), "pinhole-shots-"));
try {
  await bundle();
  const browser = await puppeteer.launch({ executablePath: browserPath, args: ["--no-sandbox", "--allow-file-access-from-files"] });
  try {
    const wanted = process.argv.slice(2);
    for (const shot of shots.filter(({ name }) => wanted.length === 0 || wanted.includes(name))) await take(browser, shot);
  } finally {
    await browser.close();
  }
} finally {
  rmSync(folder, { recursive: true, force: true });
}

/** Bundles the page with its dependencies. */
async function bundle() {
  const common = { bundle: true, format: "iife", logLevel: "error", outdir: folder, loader: { ".ttf": "dataurl" }, absWorkingDir: here };
  await build({ ...common, entryPoints: { page: "page.js" } });
  await build({ ...common, entryPoints: { worker: "monaco-editor/editor/editor.worker.js" } });
  const worker = JSON.stringify(readFileSync(path.join(folder, "worker.js"), "utf8")).replaceAll("</", "<\\/");
  writeFileSync(path.join(folder, "index.html"), `<!doctype html><meta charset="utf-8">
<link rel="stylesheet" href="page.css">
<style>body { margin: 0; background: #1F1F1F; } #editor { width: 100vw; height: 100vh; }
/* The menu of fixes is sized by its longest line before the fonts are loaded. */
.action-widget, .action-widget .monaco-list { width: 280px !important; }
.suggest-details-container, .suggest-details { height: 150px !important; }</style>
<div id="editor"></div>
<script>
const source = URL.createObjectURL(new Blob([${worker}], { type: "text/javascript" }));
self.MonacoEnvironment = { getWorker: () => new Worker(source) };
</script>
<script src="page.js"></script>`);
}

async function take(browser, { name, width, height, scene, prepare }) {
  const server = spawn(program, ["lsp"], { stdio: ["pipe", "pipe", "inherit"] });
  const connection = createProtocolConnection(new StreamMessageReader(server.stdout), new StreamMessageWriter(server.stdin));
  connection.listen();
  const page = await browser.newPage();
  page.on("pageerror", error => console.error(`${name}: ${error.message}`));
  await page.setViewport({ width, height, deviceScaleFactor: 2 });
  await page.goto(pathToFileURL(path.join(folder, "index.html")).href);
  await page.exposeFunction("ask", (method, params) => connection.sendRequest(method, params));
  await page.exposeFunction("tell", (method, params) => connection.sendNotification(method, params));
  connection.onNotification("textDocument/publishDiagnostics", params =>
    page.evaluate(params => window.told("textDocument/publishDiagnostics", params), params),
  );

  const { capabilities } = await connection.sendRequest("initialize", {
    processId: process.pid,
    rootUri: null,
    capabilities: {
      textDocument: {
        completion: { completionItem: { snippetSupport: true, documentationFormat: ["markdown"], labelDetailsSupport: true } },
        hover: { contentFormat: ["markdown"] },
        codeAction: { codeActionLiteralSupport: { codeActionKind: { valueSet: ["quickfix"] } }, isPreferredSupport: true },
        publishDiagnostics: { relatedInformation: true, codeDescriptionSupport: true },
        semanticTokens: { requests: { full: true }, formats: ["relative"], tokenTypes: [], tokenModifiers: [], multilineTokenSupport: false },
        inlayHint: {},
        colorProvider: {},
      },
    },
  });
  await connection.sendNotification("initialized", {});
  await page.evaluate((text, capabilities) => window.open_scene(text, capabilities), scene, capabilities);
  await page.evaluate(() => document.fonts.ready);
  // Waits for the answers that the editor requests when it is idle (tokens, colours, hints).
  await pause(1500);
  await prepare(editing(page));
  await pause(1000);
  const file = path.join(here, `${name}.png`);
  await page.screenshot({ path: file, optimizeForSpeed: false });
  console.log(`${file}: ${Math.ceil(readFileSync(file).length / 1024)} KiB`);
  await page.close();
  await connection.sendRequest("shutdown");
  await connection.sendNotification("exit");
  connection.dispose();
}

/**
 * Returns the actions that screenshots can use in the editor. A position is given by the text
 * before it, which must occur only once in the scene.
 */
function editing(page) {
  const at = async before => page.evaluate(before => {
    const offset = window.model.getValue().indexOf(before);
    if (offset < 0) throw new Error(`the scene has no ${before}`);
    const position = window.model.getPositionAt(offset + before.length);
    window.editor.setPosition(position);
    window.editor.focus();
  }, before);
  const trigger = id => page.evaluate(id => window.editor.trigger("shot", id, {}), id);
  /** Moves the selection in the list of completions down to the completion `label`. */
  const choose = async label => {
    const chosen = () => page.evaluate(() => document.querySelector(".suggest-widget .monaco-list-row.focused .label-name")?.textContent);
    for (let tries = 0; (await chosen()) !== label; tries++) {
      if (tries === 50) throw new Error(`${label} is not offered`);
      await page.keyboard.press("ArrowDown");
      await pause(50);
    }
  };
  return { at, trigger, choose, pause };
}

function pause(ms) {
  return new Promise(resolve => setTimeout(resolve, ms));
}
