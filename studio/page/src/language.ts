// Syntax highlighting by lists of words. It does not use the server, so it works without a
// connection.

import { StreamLanguage, syntaxHighlighting } from "@codemirror/language";
import { classHighlighter } from "@lezer/highlight";

export const NUMBER = /(?:\d[\d_]*(?:\.[\d_]*)?|\.\d[\d_]*)(?:[eE][-+]?\d[\d_]*)?/;
const words = (...lists: string[]) => new Set(lists.join(" ").split(" "));

// The words of the language. A test compares them with the language's schema.
const KINDS = words("image camera sampler sphere triangle box checkerboard");
const FIELDS = words(
  "width height background",
  "eye lookat direction up roll d view_height fov hfov near far",
  "method per_pixel total seed",
  "center radius color centroid normal sides spin v0 v1 v2 size min max y square colors",
);
const FUNCTIONS = words(
  "sin cos tan asin acos atan atan2 sqrt abs min max length dot cross normalize rgb",
);
interface State { comment: boolean; block: boolean; parentheses: number; defines: boolean }

const number = new RegExp(`^${NUMBER.source}`);

export const sceneLanguage = StreamLanguage.define<State>({
  name: "pinhole",
  startState: () => ({ comment: false, block: false, parentheses: 0, defines: false }),
  token(stream, state) {
    if (state.comment || stream.match("/*")) {
      state.comment = !stream.match(/^.*?\*\//);
      if (state.comment) stream.skipToEnd();
      return "comment";
    }
    if (stream.eatSpace()) return null;
    if (stream.match("//")) {
      stream.skipToEnd();
      return "comment";
    }
    if (stream.match(number)) {
      stream.match(/^\s*(deg|rad)\b/);
      return "number";
    }
    if (stream.match(/^#[\da-fA-F]+/)) return "atom";
    const word = stream.match(/^[A-Za-z_]\w*/);
    if (word && word !== true) {
      const { defines } = state;
      state.defines = word[0] === "let" || (!state.block && KINDS.has(word[0]));
      if (state.defines || (!state.block && word[0] === "for")) return "keyword";
      if (defines) return "typeName";
      if (FUNCTIONS.has(word[0]) && /^\s*\(/.test(stream.string.slice(stream.pos))
        && (state.parentheses > 0 || !FIELDS.has(word[0]))) return "variableName.special";
      if (state.block && state.parentheses === 0 && FIELDS.has(word[0])) return "propertyName";
      return "variableName";
    }
    const character = stream.next();
    if (character === "(") state.parentheses++;
    if (character === ")" && state.parentheses > 0) state.parentheses--;
    if (character === "{" || character === "}") {
      Object.assign(state, { block: character === "{", parentheses: 0 });
    }
    state.defines = false;
    return "+-*/=<".includes(character ?? "") ? "operator" : "punctuation";
  },
  indent: (state, after, context) => state.block && !/^\s*\}/.test(after) ? context.unit : 0,
  languageData: { commentTokens: { line: "//", block: { open: "/*", close: "*/" } },
    closeBrackets: { brackets: ["(", "{"] }, indentOnInput: /^\s*\}$/ },
});

/** Marks words with CSS classes, whose colours are in editor.css. */
export const sceneHighlighting = syntaxHighlighting(classHighlighter);
