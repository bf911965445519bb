// Splits a scene into words, each with the type that the TextMate grammar assigns to it. VS Code's
// own engine applies the grammar.

import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { scopes } from "../syntaxes/grammar.mjs";

const require = createRequire(import.meta.url);
const oniguruma = require("vscode-oniguruma");
const textmate = require("vscode-textmate");

const wasm = readFileSync(require.resolve("vscode-oniguruma/release/onig.wasm"));
const onigLib = oniguruma.loadWASM(wasm).then(() => ({
  createOnigScanner: patterns => new oniguruma.OnigScanner(patterns),
  createOnigString: text => new oniguruma.OnigString(text),
}));
const file = new URL("../syntaxes/pinhole.tmLanguage.json", import.meta.url);
const registry = new textmate.Registry({
  onigLib,
  loadGrammar: async () => textmate.parseRawGrammar(readFileSync(file, "utf8"), file.pathname),
});
const grammar = await registry.loadGrammar("source.pinhole");

const typeOf = new Map(Object.entries(scopes).map(([type, scope]) => [scope, type]));

function typeOfScopes(names) {
  const name = names.at(-1);
  if (names.some(name => name.startsWith("comment."))) return "comment";
  if (name === "source.pinhole") return undefined;
  if (!typeOf.has(name)) throw new Error(`no type of token has the scope ${name}`);
  return typeOf.get(name);
}

/**
 * Returns the words of a text, in order, as `{ line, start, text, type }`. `start` is a column in
 * UTF-16 code units. Words without a type are left out.
 */
export function scoped(source) {
  const words = [];
  let state = textmate.INITIAL;
  for (const [line, text] of source.split(/\r?\n/).entries()) {
    const { tokens, ruleStack } = grammar.tokenizeLine(text, state);
    state = ruleStack;
    for (const { startIndex: start, endIndex: end, scopes } of tokens) {
      const type = typeOfScopes(scopes);
      const word = { line, start, text: text.slice(start, end), type };
      const last = words.at(-1);
      // The engine splits a comment into its opening sign, its text and its closing sign.
      const goesOn = type === "comment" && last?.type === type && last.line === line && last.start + last.text.length === start;
      if (goesOn && !word.text.startsWith("/*") && !word.text.startsWith("//")) last.text += word.text;
      else if (type !== undefined && word.text.trim() !== "") words.push(word);
    }
  }
  return words;
}
