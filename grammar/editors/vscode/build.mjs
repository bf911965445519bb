// Bundles into dist/:
//
// - the extension with its dependencies and their licences;
// - the page of Pinhole Studio, for the panel with the picture;
// - the extension's README, with embedded pictures;
// - Pinhole's own licences;
// - the program that the environment variable BUNDLE names, if it is set.

import { copyFileSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
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

mkdirSync("dist/page", { recursive: true });
for (const file of ["index.html", "studio.js", "studio.css", "LICENSES.txt"]) copyFileSync(`../../../studio/page/dist/${file}`, `dist/page/${file}`);
copyFileSync("src/panel.css", "dist/page/panel.css");

// The README's pictures are embedded in it, since the editor would not load them as files.
const page = readFileSync("README.md", "utf8");
writeFileSync("dist/README.md", page.replace(/\]\(([^)]+\.png)\)/g, (_, file) => `](data:image/png;base64,${readFileSync(file, "base64")})`));

const [mit, apache] = ["MIT", "APACHE"].map(name => readFileSync(`../../../LICENSE-${name}`, "utf8").trim());
writeFileSync("LICENSE.txt", `Pinhole is licensed under either of the two licences below, at your option.\n\n${mit}\n\n\n${apache}\n`);

rmSync("bin", { recursive: true, force: true });
if (process.env.BUNDLE) {
  mkdirSync("bin");
  copyFileSync(process.env.BUNDLE, path.join("bin", path.basename(process.env.BUNDLE)));
}
