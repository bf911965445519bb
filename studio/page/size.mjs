// Limits the page's TypeScript to 3850 lines of code, without comments and blank lines, and to 100
// characters in a line.

import { readdirSync, readFileSync } from "node:fs";

const files = readdirSync("src").filter(file => file.endsWith(".ts"));
const lines = files.flatMap(file => readFileSync(`src/${file}`, "utf8").split("\n").slice(0, -1).map((line, i) => ({ line, at: `${file}:${i + 1}` })));
const code = lines.filter(({ line }) => !/^\s*(\/\/|\/\*|\*|$)/.test(line));
const long = lines.filter(({ line }) => [...line].length > 100).map(({ at }) => at);
if (code.length > 3850) throw new Error(`the page has ${code.length} lines of code in TypeScript, which are more than 3850`);
if (long.length > 0) throw new Error(`more than 100 characters: ${long.join(", ")}`);
