// Builds the static site, studio/site: the page with the engine as WebAssembly. Needs Rust with the
// target wasm32-unknown-unknown, and `npm ci`.

import { execFileSync } from "node:child_process";
import { existsSync, readdirSync, readFileSync, rmSync } from "node:fs";
import { homedir } from "node:os";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

/** Maximum size of the site in bytes, with each file compressed as a server sends it. A phone loads
 * a megabyte in a few seconds. A tenth of it is meant for lessons. */
const LIMIT = 1_000_000;

const page = path.dirname(fileURLToPath(import.meta.url));
const root = path.resolve(page, "../..");
const site = path.join(root, "studio/site");
const engine = path.join(page, "engine");
const target = path.resolve(root, process.env.CARGO_TARGET_DIR ?? "target");
const wasm = "wasm32-unknown-unknown";
const run = (program, ...args) => execFileSync(program, args, { cwd: page, stdio: "inherit" });

// Optimizing for size inlines hardly anything; a little inlining makes frames about twice as fast,
// and the engine 1 % larger.
const inlining = ["-C", "llvm-args=-inline-threshold=4"];
// Messages of panics contain paths of source files. This machine's folders are removed from the
// paths, so that the site has the same size on every machine.
const sources = path.join(process.env.CARGO_HOME ?? path.join(homedir(), ".cargo"), "registry/src");
const registries = existsSync(sources) ? readdirSync(sources) : [];
const short = registries.map(registry => `--remap-path-prefix=${path.join(sources, registry)}/=`);
const flags = [...(process.env.RUSTFLAGS ?? "").split(" ").filter(Boolean), ...short].join("\x1f");
const env = { ...process.env, CARGO_ENCODED_RUSTFLAGS: flags };
execFileSync("cargo", ["rustc", "--locked", "--profile", "site", "--target", wasm, "--package", "pinhole-studio-engine", "--", ...inlining], { cwd: page, env, stdio: "inherit" });
run("cargo", "run", "--locked", "--quiet", "--config", "profile.dev.debug=false", "--package", "pinhole-studio-bindgen", "--", path.join(target, wasm, "site/pinhole_studio_engine.wasm"), engine);
rmSync(site, { recursive: true, force: true });
run("node", "build.mjs", "static", site);
// The level -O1 gives the smallest compressed size. Higher levels write less code, but this code
// compresses worse.
const optimizer = path.join(page, "node_modules/binaryen/bin/wasm-opt");
// No data is in the lowest 1024 bytes of memory, which are the far end of the stack. Therefore, the
// optimizer may fold offsets into loads.
const adding = ["--low-memory-unused", "--optimize-added-constants-propagate"];
const passes = ["-O1", "--dae-optimizing", "--rse", "--precompute-propagate", "--code-folding", "--converge", ...adding, "--reorder-locals", "--merge-blocks"];
run("node", optimizer, ...passes, path.join(engine, "pinhole_bg.wasm"), "-o", path.join(site, "pinhole_bg.wasm"));

let packed = 0;
for (const file of readdirSync(site).sort()) {
  const { length } = gzipSync(readFileSync(path.join(site, file)), { level: 9 });
  console.log(`${file.padEnd(20)} ${String(length).padStart(7)} bytes packed`);
  packed += length;
}
console.log(`${"in all".padEnd(20)} ${String(packed).padStart(7)} of at most ${LIMIT}`);
if (packed > LIMIT) process.exitCode = 1;
