// Tests the TextMate grammar on short texts in which the type of a word depends on the words before
// it.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { file, scopes, text } from "../syntaxes/grammar.mjs";
import { scoped } from "./scoped.mjs";

/** Returns the words of a text, each with its type. */
const typed = source => scoped(source).map(({ text, type }) => `${text} ${type}`);

test("pinhole.tmLanguage.json is what `npm run grammar` writes", () => {
  assert.equal(readFileSync(file, "utf8"), text);
});

test("themes see one scope for a word, whoever names it", () => {
  const manifest = JSON.parse(readFileSync(new URL("../package.json", import.meta.url), "utf8"));
  const [{ language, scopes: declared }] = manifest.contributes.semanticTokenScopes;
  assert.equal(language, "pinhole");
  assert.deepEqual(declared, Object.fromEntries(Object.entries(scopes).map(([type, scope]) => [type, [scope]])));
});

test("a name is a field or a value by what stands before it", () => {
  assert.deepEqual(typed("sphere Ball { radius radius - 1 color sun center (0, min(1, 2), 0) }"), [
    "sphere keyword", "Ball class",
    "radius property", "radius variable", "- operator", "1 number",
    "color property", "sun variable",
    "center property", "0 number", "min function", "1 number", "2 number", "0 number",
  ]);
});

test("an object is repeated by indices in its head", () => {
  const block = ["radius property", "i variable", "color property", "r variable"];
  const head = ["for keyword", "i variable.declaration", "< operator", "8 number", "j variable.declaration",
    "< operator", "2 number", "* operator", "i variable", "- operator", "1 number"];
  for (const [text, ...start] of [
    ["sphere Ball for i < 8, j < 2 * (i - 1) { radius i color r }", "sphere keyword", "Ball class"],
    ["box\nfor i<8,j<2*(i-1)\n{ radius i color r }", "box keyword"],
    ["let a = b\nsphere for i < 8, j < 2 * (i - 1) { radius i color r }",
      "let keyword", "a variable.declaration", "= operator", "b variable", "sphere keyword"],
    ["box { color r\nsphere B for i < 8, j < 2 * (i - 1) { radius i color r }",
      "box keyword", "color property", "r variable", "sphere keyword", "B class"],
  ]) assert.deepEqual(typed(text), [...start, ...head, ...block]);
});

test("values go on over lines and comments", () => {
  assert.deepEqual(typed("let a = // of b\n  b *\n  2 /* and\n*/ let\nc = a\nsphere\n{ radius\na } camera Eye\n{}"), [
    "let keyword", "a variable.declaration", "= operator", "// of b comment", "b variable", "* operator",
    "2 number", "/* and comment", "*/ comment",
    "let keyword", "c variable.declaration", "= operator", "a variable",
    "sphere keyword", "radius property", "a variable", "camera keyword", "Eye class",
  ]);
});

test("words of the language are told from names", () => {
  assert.deepEqual(typed("sphere { color #FA0 } let a = (pi * rad, Olive, olives, PI, dot(1.5e-3deg, #abc))"), [
    "sphere keyword", "color property", "#FA0 number",
    "let keyword", "a variable.declaration", "= operator", "pi enumMember", "* operator", "rad enumMember",
    "Olive enumMember", "olives variable", "PI variable", "dot function", "1.5e-3deg number", "#abc number",
  ]);
});

test("tan is a function where it is called, and a colour elsewhere", () => {
  assert.deepEqual(typed("let a = tan(b) let c = 2 * (tan (b)) let d = tan let e = (tan, atan)"), [
    "let keyword", "a variable.declaration", "= operator", "tan function", "b variable",
    "let keyword", "c variable.declaration", "= operator", "2 number", "* operator", "tan function", "b variable",
    "let keyword", "d variable.declaration", "= operator", "tan enumMember",
    "let keyword", "e variable.declaration", "= operator", "tan enumMember", "atan function",
  ]);
});

test("one line holds several items", () => {
  assert.deepEqual(typed("let a = b sphere { radius a } let c = sin(a) box B {} image{}"), [
    "let keyword", "a variable.declaration", "= operator", "b variable", "sphere keyword", "radius property", "a variable",
    "let keyword", "c variable.declaration", "= operator", "sin function", "a variable",
    "box keyword", "B class", "image keyword",
  ]);
});

test("what is unfinished does not spoil what follows", () => {
  const rest = "\nsphere Ball { color Olive }\nlet a = 30deg";
  const expected = typed(rest);
  for (const broken of [
    "", "let", "let a", "let a =", "let a = (1, 2", "let a = b +", "camera", "camera {", "camera { eye", "camera { eye (1,",
    "camera { eye (1, 2, 3)", "camera { roll 2m", "camera { method", "}", "sphere { center f(", "sphere { color \"red }",
  ]) {
    assert.deepEqual(typed(broken + rest).slice(-expected.length), expected, broken);
  }
});
