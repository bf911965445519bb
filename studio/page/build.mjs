// Builds the page: `node build.mjs` for the served host into dist/, `node build.mjs static FOLDER` for a site. The bytes depend on the sources and the
// lock file alone.

import { mkdirSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import path from "node:path";
import { build } from "esbuild";

const [host = "served", folder = "dist"] = process.argv.slice(2);
if (host !== "served" && host !== "static") throw new Error(`there is no host ${host}: it is served or static`);
mkdirSync(folder, { recursive: true });

const { metafile } = await build({
  // The served host runs the engine itself; a site has it in a worker.
  entryPoints: { studio: "src/main.ts", ...(host === "static" ? { engine: "src/worker.ts" } : {}) },
  // What `npm run site` makes of the engine.
  alias: { "pinhole-engine": "./engine/pinhole.js" },
  bundle: true,
  format: "esm",
  target: ["chrome111", "firefox113", "safari16.4"],
  minify: true,
  legalComments: "none",
  loader: { ".scn": "text" },
  metafile: true,
  logLevel: "warning",
  outdir: folder,
});
await build({ entryPoints: ["src/studio.css"], minify: true, logLevel: "warning", outdir: folder });

// A site sends no headers of its own, so its policy stands in the page. The served host sends a stricter one with a nonce for the styles of the editor.
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
let page = readFileSync("src/index.html", "utf8");
if (host === "static") {
  page = page
    .replace('<meta name="pinhole-host" content="served">', `<meta http-equiv="Content-Security-Policy" content="${policy}">\n    <meta name="pinhole-host" content="static">`)
    .replace('    <meta name="pinhole-nonce" content="__NONCE__">\n', "")
    // A link to a site leads everybody to it.
    .replace('<p id="share-local">', '<p id="share-local" hidden>')
    // The engine in the browser writes no EXR.
    .replace('<button type="button" id="download-exr">', '<button type="button" id="download-exr" hidden>');
}
writeFileSync(path.join(folder, "index.html"), page);

// The licences of what the bundle contains.
const folders = new Set(Object.keys(metafile.inputs).map(file => file.match(/^.*node_modules\/(@[^/]+\/)?[^/]+/)?.[0]).filter(Boolean));
const texts = [...folders].sort().map(folder => {
  const { name, version } = JSON.parse(readFileSync(path.join(folder, "package.json"), "utf8"));
  const license = readdirSync(folder).find(file => /^licen[cs]e/i.test(file));
  if (license === undefined) throw new Error(`${name} comes without the text of its licence`);
  return `${name} ${version}\n\n${readFileSync(path.join(folder, license), "utf8").trim()}\n`;
});
writeFileSync(path.join(folder, "LICENSES.txt"), `studio.js contains the packages below, each under its licence.\n\n${texts.join("\n\n")}`);
