// The TextMate grammar of scene files. `npm run grammar` writes it to pinhole.tmLanguage.json.
//
// The language server gives each word a semantic token. This grammar gives the word the scope that
// `scopes` lists for the token's type, so that a file looks the same before and after the server
// answers. (package.json repeats the table for themes.) The meaning of a name depends on the words
// before it: in `radius r - 1 color sun`, `color` starts a field, and `sun` is a value. A TextMate
// rule that has ended cannot pass information to its parent. Therefore, the rules do not end: the
// rest of a block is read within the rule of the last value, and all rules end together at the
// closing brace.

import { writeFileSync } from "node:fs";

/** Scopes by the type of the semantic token, or by its type and modifier. */
export const scopes = {
  keyword: "keyword.control.pinhole",
  property: "support.type.property-name.pinhole",
  variable: "variable.other.constant.pinhole",
  "variable.declaration": "variable.other.constant.definition.pinhole",
  class: "entity.name.type.class.pinhole",
  function: "support.function.pinhole",
  enumMember: "support.constant.property-value.pinhole",
  number: "constant.numeric.pinhole",
  operator: "keyword.operator.pinhole",
  comment: "comment.pinhole",
};

/** Names of colours in CSS. */
export const colors = `
  aliceblue antiquewhite aqua aquamarine azure beige bisque black blanchedalmond blue blueviolet brown burlywood
  cadetblue chartreuse chocolate coral cornflowerblue cornsilk crimson cyan darkblue darkcyan darkgoldenrod darkgray
  darkgreen darkgrey darkkhaki darkmagenta darkolivegreen darkorange darkorchid darkred darksalmon darkseagreen
  darkslateblue darkslategray darkslategrey darkturquoise darkviolet deeppink deepskyblue dimgray dimgrey dodgerblue
  firebrick floralwhite forestgreen fuchsia gainsboro ghostwhite gold goldenrod gray green greenyellow grey honeydew
  hotpink indianred indigo ivory khaki lavender lavenderblush lawngreen lemonchiffon lightblue lightcoral lightcyan
  lightgoldenrodyellow lightgray lightgreen lightgrey lightpink lightsalmon lightseagreen lightskyblue lightslategray
  lightslategrey lightsteelblue lightyellow lime limegreen linen magenta maroon mediumaquamarine mediumblue mediumorchid
  mediumpurple mediumseagreen mediumslateblue mediumspringgreen mediumturquoise mediumvioletred midnightblue mintcream
  mistyrose moccasin navajowhite navy oldlace olive olivedrab orange orangered orchid palegoldenrod palegreen
  paleturquoise palevioletred papayawhip peachpuff peru pink plum powderblue purple rebeccapurple red rosybrown
  royalblue saddlebrown salmon sandybrown seagreen seashell sienna silver skyblue slateblue slategray slategrey snow
  springgreen steelblue tan teal thistle tomato turquoise violet wheat white whitesmoke yellow yellowgreen
`.trim().split(/\s+/);

export const functions = "sin cos tan asin acos atan atan2 sqrt abs min max length dot cross normalize rgb".split(" ");

const NAME = "[A-Za-z_][A-Za-z0-9_]*";
// A unit after a space is a mistake, but it is coloured as part of the number.
const NUMBER =
  "(?:[0-9][0-9_]*(?:\\.[0-9_]*)?|\\.[0-9][0-9_]*)(?:[eE][-+]?[0-9][0-9_]*)?(?:[ \\t]*(?:deg|rad))?(?![A-Za-z0-9_.])";
const ODD_NUMBER = "\\.?[0-9][A-Za-z0-9_.]*";
const COLOR_CODE = "#[A-Za-z0-9_]*";
const WORD_OF_THE_LANGUAGE = `(?:(?i:${colors.join("|")})|pi|deg|rad)\\b`;
// `tan` is also a colour; it is a function only before a parenthesis.
const FUNCTION = `(?:${functions.map(name => (name === "tan" ? "tan(?=\\s*\\()" : name)).join("|")})\\b`;
const QUOTED = "\"[^\"]*\"?|'[^']*'?";
// Operators, including some that the language does not have. People use them by mistake.
const OPERATOR = "\\*\\*|[-+*/^%×·÷−]";

// A line that starts with the head of a block ends the block above it, whose closing brace may be
// missing.
const NEXT_ITEM =
  `(?=\\blet\\b)|^(?=\\s*${NAME}\\s*(?:${NAME}\\s*)?\\{|\\s*${NAME}\\s+(?:${NAME}\\s+)?for\\s+${NAME}\\s*<)`;
const VALUES_END = `(?=\\})|${NEXT_ITEM}`;

const includes = (...names) => names.map(name => ({ include: `#${name}` }));
const scoped = (match, type) => ({ match, name: scopes[type] });
const captures = (...types) =>
  Object.fromEntries(types.map((type, i) => [i + 1, { name: scopes[type] }]));
const rule = (begin, types, end, ...names) => ({
  begin,
  beginCaptures: captures(...types),
  end,
  patterns: includes(...names),
});

/** Rules for words of values after which no field can begin, such as those in parentheses. */
const WORDS = [
  scoped(`(?<![A-Za-z0-9_.])${NUMBER}`, "number"),
  scoped(COLOR_CODE, "number"),
  { match: QUOTED },
  scoped(`\\b${FUNCTION}`, "function"),
  scoped(`\\b${WORD_OF_THE_LANGUAGE}`, "enumMember"),
  scoped(`\\b${NAME}`, "variable"),
  scoped(OPERATOR, "operator"),
];

/** Returns the rules of values after which the rules `next` apply, such as the rule of a field. */
function values(prefix, ...next) {
  const [value, operation] = [`${prefix}-value`, `${prefix}-operation`];
  const goesOn = ["comment", "parentheses", operation, ...next];
  return {
    [value]: { patterns: includes("sign", `${prefix}-group`, `${prefix}-operand`) },
    [`${prefix}-operand`]: rule(
      `(${NUMBER})|(${COLOR_CODE})|(${FUNCTION})|(${WORD_OF_THE_LANGUAGE})|(${NAME})|${ODD_NUMBER}|${QUOTED}`,
      ["number", "number", "function", "enumMember", "variable"],
      VALUES_END,
      ...goesOn,
    ),
    [`${prefix}-group`]: rule("\\(", [], VALUES_END, "inner", ...goesOn),
    [operation]: rule(`(${OPERATOR})`, ["operator"], VALUES_END, "comment", value),
  };
}

export const grammar = {
  name: "Pinhole scene",
  scopeName: "source.pinhole",
  fileTypes: ["scn"],
  patterns: includes("comment", "definition", "block"),
  repository: {
    comment: {
      patterns: [
        { match: "//.*$", name: "comment.line.double-slash.pinhole" },
        { begin: "/\\*", end: "\\*/", name: "comment.block.pinhole" },
      ],
    },

    definition: {
      patterns: [
        rule(`\\b(let)\\s+(${NAME})`, ["keyword", "variable.declaration"], VALUES_END, "comment", "item-value"),
        rule("\\b(let)\\b", ["keyword"], VALUES_END, "comment", "defined-name"),
      ],
    },
    "defined-name": rule(`(${NAME})`, ["variable.declaration"], VALUES_END, "comment", "item-value"),
    ...values("item", "block"),

    block: {
      patterns: [
        rule(
          `\\b(?!let\\b)(${NAME})(?:\\s+(${NAME}))?\\s*\\{`, ["keyword", "class"], `\\}|${NEXT_ITEM}`, "comment", "field",
        ),
        // The name or the brace of this block is on another line, or after a comment.
        rule(
          `\\b(?!let\\b)(${NAME})\\b`, ["keyword"], `(?<=\\})|(?=\\blet\\b)|^(?=\\s*${NAME}\\s+${NAME}\\s*\\{)`,
          "comment", "body", "repetition", "object-name",
        ),
      ],
    },
    body: rule("\\{", [], `\\}|${NEXT_ITEM}`, "comment", "field"),
    repetition: {
      begin: "\\b(for)\\b",
      beginCaptures: captures("keyword"),
      end: `(?=[{}])|${NEXT_ITEM}`,
      patterns: [
        ...includes("comment", "parentheses"),
        scoped(`\\b${NAME}(?=\\s*<)`, "variable.declaration"),
        scoped("<", "operator"),
        ...WORDS,
      ],
    },
    "object-name": scoped(`\\b${NAME}\\b`, "class"),

    field: {
      patterns: [
        rule("\\b(method)\\b", ["property"], VALUES_END, "comment", "method"),
        rule(`\\b(?!let\\b)(${NAME})`, ["property"], VALUES_END, "comment", "field-value"),
      ],
    },
    method: rule(`(${NAME})`, ["enumMember"], VALUES_END, "comment", "field"),
    ...values("field", "field"),

    // Within parentheses, a name is never a field, so the rule does not depend on previous words.
    inner: {
      begin: "(?<=\\()",
      end: `\\)|(?=[{}])|${NEXT_ITEM}`,
      patterns: [...includes("comment", "parentheses"), ...WORDS],
    },
    parentheses: rule("\\(", [], `(?<=\\))|(?=[{}])|${NEXT_ITEM}`, "inner"),
    sign: scoped("[-+−=:]", "operator"),
  },
};

/** File of the grammar. */
export const file = new URL("pinhole.tmLanguage.json", import.meta.url);
export const text = JSON.stringify(grammar, null, 2) + "\n";

if (process.argv[2] === "write") writeFileSync(file, text);
