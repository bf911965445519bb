// Bundles the extension with what it uses, and the licences of that, into dist/; and fetches Pinhole's own licences.

import { copyFileSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import path from "node:path";
import { build } from "esbuild";

const { metafile } = await build({
  entryPoints: ["src/extension.js"],
  bundle: true,
  platform: "node",
  target: "node20",
  external: ["vscode"],
  minify: true,
  metafile: true,
  logLevel: "warning",
  outfile: "dist/extension.js",
});

const folders = new Set(Object.keys(metafile.inputs).map(file => file.match(/^.*node_modules\/(@[^/]+\/)?[^/]+/)?.[0]).filter(Boolean));
const texts = [...folders].sort().map(folder => {
  const { name, version } = JSON.parse(readFileSync(path.join(folder, "package.json"), "utf8"));
  const license = readdirSync(folder).find(file => /^licen[cs]e/i.test(file));
  if (license === undefined) throw new Error(`${name} comes without the text of its licence`);
  return `${name} ${version}\n\n${readFileSync(path.join(folder, license), "utf8").trim()}\n`;
});
writeFileSync("dist/LICENSES.txt", `dist/extension.js contains the packages below, each under its licence.\n\n${texts.join("\n\n")}`);

for (const name of ["LICENSE-MIT", "LICENSE-APACHE"]) copyFileSync(`../../../${name}`, name);
