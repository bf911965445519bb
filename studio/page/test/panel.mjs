// Opens the page in a panel of VS Code, for the tests. The packaged extension runs in a substitute
// for VS Code, with the real program as its server. Chromium shows the panel's page.

import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { Document } from "../../../grammar/editors/vscode/test/documents.mjs";
import { editor, load, RESOURCES, Uri } from "../../../grammar/editors/vscode/test/vscode.mjs";
import { finished } from "./helpers.mjs";

const home = fileURLToPath(new URL("../../../grammar/editors/vscode", import.meta.url));
const PANEL = "https://panel.test/";
const PINHOLE = process.env.PINHOLE ?? "pinhole";

/** Some colours of VS Code's own themes. */
const COLORS = {
  light: { "editor-background": "#ffffff", foreground: "#3b3b3b", "sideBar-background": "#f8f8f8", "editorWidget-border": "#e5e5e5", "focusBorder": "#005fb8" },
  dark: { "editor-background": "#1f1f1f", foreground: "#cccccc", "sideBar-background": "#181818", "editorWidget-border": "#313131", "focusBorder": "#0078d4" },
};

/** Packs the extension, with the page that is tested. */
export function packed() {
  execFileSync("node", ["build.mjs"], { cwd: home, stdio: "inherit" });
}

/**
 * Opens documents with the scenes `texts`, and the panel for the first one. Returns the page, the
 * documents, the substitute for VS Code, and the text editor of the first document.
 */
export async function opened(context, browser, texts, { theme = "dark", width = 700, height = 800, waits = true } = {}) {
  const folder = mkdtempSync(path.join(tmpdir(), "pinhole-panel-"));
  const documents = Object.entries(texts).map(([name, text]) => new Document(Uri.file(path.join(folder, `${name}.scn`)), text));
  const setting = PINHOLE.includes("/") ? path.resolve(PINHOLE) : execFileSync("which", [PINHOLE], { encoding: "utf8" }).trim();
  const { vscode, seen } = editor({ documents, setting });
  const extension = load(vscode);
  const kept = new Map();
  const workspaceState = { get: key => kept.get(key), update: (key, value) => kept.set(key, value) };
  context.after(async () => {
    await extension.deactivate();
    rmSync(folder, { recursive: true });
  });
  await extension.activate({ subscriptions: [], extensionPath: home, extensionUri: Uri.file(home), workspaceState });
  seen.commands.get("pinhole.picture")();
  const [panel] = seen.panels;
  const page = await (await browser.newContext({ viewport: { width, height } })).newPage();
  page.complaints = [];
  page.on("console", message => ["error", "warning"].includes(message.type()) && page.complaints.push(message.text()));
  page.on("pageerror", error => page.complaints.push(error.message));
  await page.exposeFunction("toExtension", message => panel.page.say(message));
  await page.addInitScript(() => {
    window.acquireVsCodeApi = () => ({
      postMessage: message => void window.toExtension(message),
      getState: () => JSON.parse(sessionStorage.getItem("state") ?? "null") ?? undefined,
      setState: state => sessionStorage.setItem("state", JSON.stringify(state)),
    });
  });
  // As in VS Code, the panel can load only files in its `localResourceRoots`.
  await page.route("**", route => {
    const url = new URL(route.request().url());
    if (url.href === PANEL) return route.fulfill({ contentType: "text/html", body: inVsCode(panel.webview.html, theme) });
    const root = panel.webview.options.localResourceRoots.find(it => url.origin === RESOURCES && url.pathname.startsWith(`${it.path}/`));
    if (root === undefined) return route.abort();
    route.fulfill({ path: url.pathname, headers: { "access-control-allow-origin": "*" } });
  });
  panel.page.hear = message => page.evaluate(it => window.postMessage(it, "*"), message).catch(() => {});
  panel.page.load = () => void page.goto(PANEL).catch(() => {});
  await page.goto(PANEL);
  if (waits) await finished(page);
  return { page, documents, document: documents[0], vscode, seen, panel, run: name => seen.commands.get(name)(), textEditor: vscode.window.visibleTextEditors[0] };
}

/** Adds to a page what VS Code adds: a style, and the theme's colours and classes. */
function inVsCode(html, theme) {
  const colors = Object.entries(COLORS[theme]).map(([name, color]) => `--vscode-${name}: ${color}`).join("; ");
  return html
    .replace("<html ", `<html style="${colors}; --vscode-font-family: system-ui, sans-serif" `)
    .replace("<head>", "<head><style>body { background-color: transparent; color: var(--vscode-editor-foreground); padding: 0 20px; } kbd { border: 1px solid; padding: 1px 3px; }</style>")
    .replace("<body>", `<body class="vscode-${theme}">`);
}

/** Changes the theme of VS Code, as it does while a page is open. */
export async function paint(page, theme) {
  await page.evaluate(([theme, colors]) => {
    for (const [name, color] of Object.entries(colors)) document.documentElement.style.setProperty(`--vscode-${name}`, color);
    document.body.className = `vscode-${theme}`;
  }, [theme, COLORS[theme]]);
}
