// Limits the page's TypeScript to 3600 lines of at most 100 characters.

import { readdirSync, readFileSync } from "node:fs";

const files = readdirSync("src").filter(file => file.endsWith(".ts"));
const lines = files.flatMap(file => readFileSync(`src/${file}`, "utf8").split("\n").slice(0, -1).map((line, i) => ({ line, at: `${file}:${i + 1}` })));
const long = lines.filter(({ line }) => [...line].length > 100).map(({ at }) => at);
if (lines.length > 3600) throw new Error(`the page has ${lines.length} lines of TypeScript, which are more than 3600`);
if (long.length > 0) throw new Error(`more than 100 characters: ${long.join(", ")}`);
