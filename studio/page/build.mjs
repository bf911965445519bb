// Builds the page: `node build.mjs` writes it to dist/ for the host `pinhole studio`, and `node
// build.mjs static FOLDER` writes it for a website. The bytes depend only on the sources and the
// lock file.

import { mkdirSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import path from "node:path";
import { build } from "esbuild";
import { marked, Renderer } from "marked";

const [host = "served", folder = "dist"] = process.argv.slice(2);
if (host !== "served" && host !== "static") throw new Error(`there is no host ${host}: it is served or static`);
mkdirSync(folder, { recursive: true });

/** The gallery of examples. The menu of the page lists its scenes, in the same order. */
const gallery = readFileSync("../../examples/README.md", "utf8");
const examples = [...gallery.matchAll(/^\|.*\]\((\w+)\.scn\)/gm)].map(([, name]) => [name, readFileSync(`../../examples/${name}.scn`, "utf8")]);
const folderOfLessons = "../../examples/lessons";
const lessons = readdirSync(folderOfLessons).filter(file => /^\d.*\.md$/.test(file)).sort().map(file => {
  const name = file.replace(/\.md$/, "");
  const read = ending => readFileSync(path.join(folderOfLessons, `${name}.${ending}`), "utf8");
  return { name, text: read("md"), start: read("scn") };
});
const EMPTY = `image { width 1280  height 720  background black }

camera { eye (3, 3.5, 8)  lookat (0.2, 0.8, 0)  d 2.75 }

sampler { method multi_jittered  per_pixel 16  seed 1 }
`;

const target = ["chrome111", "firefox113", "safari16.4"];
const { metafile } = await build({
  // The host `pinhole studio` runs the engine itself. On a website, a worker of the page runs it.
  entryPoints: { studio: "src/main.ts", ...(host === "static" ? { engine: "src/worker.ts" } : {}) },
  // `npm run site` makes this file from the engine.
  alias: { "pinhole-engine": "./engine/pinhole.js" },
  bundle: true,
  format: "esm",
  target,
  minify: true,
  legalComments: "none",
  define: { EXAMPLES: JSON.stringify(examples), LESSONS: JSON.stringify(lessons), EMPTY: JSON.stringify(EMPTY) },
  metafile: true,
  logLevel: "warning",
  outdir: folder,
});
await build({ entryPoints: ["src/studio.css"], bundle: true, target, minify: true, logLevel: "warning", outdir: folder });

// A website sends no headers of its own, so the page contains its content security policy. The host
// `pinhole studio` sends a stricter one, with a nonce for the editor's styles.
const policy = [
  "default-src 'none'",
  "script-src 'self' 'wasm-unsafe-eval'",
  "style-src 'self' 'unsafe-inline'",
  "img-src blob: data:",
  "connect-src 'self'",
  "worker-src 'self'",
  "base-uri 'none'",
  "form-action 'none'",
].join("; ");
// The page contains the reference of the language, without its links, which would leave the page.
const renderer = new Renderer();
// The served page contains the figures, since it loads no other file. In the static page, they are
// left out, because site.mjs limits its size.
renderer.image = ({ href, text }) => {
  if (host === "static") return "";
  const svg = readFileSync(path.join("../../grammar", href), "utf8").replaceAll("\n", "");
  return `<img src="data:image/svg+xml,${encodeURIComponent(svg)}" alt="${text}">`;
};
renderer.link = function ({ tokens }) { return this.parser.parseInline(tokens); };
renderer.heading = function ({ tokens, depth }) { return `<h${depth + 2}>${this.parser.parseInline(tokens)}</h${depth + 2}>`; };
// The page's reference ends before the section on overrides. The rest is about the command line and
// its reports, and about the layout of the text, which Shift-Alt-F produces.
const [reference, ...end] = readFileSync("../../grammar/language.md", "utf8").replace(/^# .*\n/, "").split("\n## Overrides\n");
if (end.length !== 1) throw new Error("the reference has no section on overrides to end before");
let page = readFileSync("src/index.html", "utf8").replace("__REFERENCE__", () => marked.parse(reference, { renderer }));
if (host === "static") {
  page = page
    .replace('<meta name="pinhole-host" content="served">', `<meta http-equiv="Content-Security-Policy" content="${policy}">\n    <meta name="pinhole-host" content="static">`)
    .replace('    <meta name="pinhole-nonce" content="__NONCE__">\n', "")
    // A link to a website works for everybody, so this note is hidden.
    .replace('<p id="share-local">', '<p id="share-local" hidden>')
    // A website cannot choose its port, so this note is hidden.
    .replace('<span id="kept-served">', '<span id="kept-served" hidden>')
    // The engine in the browser writes no EXR, so this button is hidden.
    .replace('<button type="button" id="download-exr">', '<button type="button" id="download-exr" hidden>')
    // Indentation before a tag is removed. This does not change scenes, in which `<` is written
    // `&lt;`.
    .replace(/^ +</gm, "<");
}
writeFileSync(path.join(folder, "index.html"), page);

// Collect the licences of the packages in the bundle.
const folders = new Set(Object.keys(metafile.inputs).map(file => file.match(/^.*node_modules\/(@[^/]+\/)?[^/]+/)?.[0]).filter(Boolean));
const texts = [...folders].sort().map(folder => {
  const { name, version } = JSON.parse(readFileSync(path.join(folder, "package.json"), "utf8"));
  const license = readdirSync(folder).find(file => /^licen[cs]e/i.test(file));
  if (license === undefined) throw new Error(`${name} comes without the text of its licence`);
  return `${name} ${version}\n\n${readFileSync(path.join(folder, license), "utf8").trim()}\n`;
});
writeFileSync(path.join(folder, "LICENSES.txt"), `studio.js contains the packages below, each under its licence.\n\n${texts.join("\n\n")}`);
