//! Texts of the syntax problems, and whether their fixes are safe. `{0}`, `{1}` and so on are
//! placeholders, which [`Message::at`](super::problem::Message::at) fills.

use super::problem::Message;

/// Problem: the file contains bytes that are not valid UTF-8.
pub const INVALID_UTF8: Message = Message::new(["invalid_utf8", "this file is not valid UTF-8{0}", "this byte is part of no character", "save the file as UTF-8"]);
/// Problem: the file is UTF-16 rather than UTF-8.
pub const UTF16: Message = Message::new(["invalid_utf8", "this file is UTF-16, not UTF-8", "each character takes two bytes", "save the file as UTF-8"]);
/// Problem: the file belongs to another program, or is not text.
pub const FOREIGN_FILE: Message = Message::new(["foreign_file", "this looks like {0}, not like a scene of Pinhole", "no scene starts like this", "the smallest scene is `camera { eye (0, 2, 8)  lookat (0, 1, 0) }` and `sphere { center (0, 1, 0) }`{1}"]);
pub const NOT_IN_LANGUAGE: Message = Message::new(["not_in_language", "the language has no {0}", "not a part of the language", "{1}"]);
// Messages about characters and comments.
pub const CARRIAGE_RETURN: Message = Message::new(["odd_space", "a carriage return alone ends no line{0}", "no line feed follows", "write a line feed in its place"]).safe();
pub const ODD_SPACE: Message = Message::new(["odd_space", "{0} is no white space here{1}", "it cannot be seen", "write a plain space in its place, or take it away"]).safe();
pub const UNCLOSED_COMMENT: Message = Message::new(["unclosed_comment", "a comment is never closed", "the comment starts here and takes the rest of the text", "write `*/` where it ends, or begin it with `//` if it is one line"]);
pub const NESTED_COMMENT: Message = Message::new(["nested_comment", "comments do not nest: the first `*/` ends this one", "this opens no other comment", ""]).safe();
pub const COMMENT_SIGN: Message = Message::new(["comment_sign", "a comment begins with `//`, not with `{0}`{1}", "`//` should stand here", "write `//`; the comment takes the rest of the line"]).safe();
// Messages about items, i.e. definitions and blocks.
pub const MISSING_NAME: Message = Message::new(["missing_name", "a `let` lacks its name", "a name should stand here", "write a name of letters, digits and `_`, such as `let height = 2`"]);
pub const BAD_NAME: Message = Message::new(["bad_name", "`{0}` cannot be a name", "a name should stand here", "a name is made of the letters a to z, digits and `_`, and does not start with a digit{1}"]);
pub const MISSING_EQUALS: Message = Message::new(["missing_equals", "`let {0}` lacks its `=`", "`=` should stand here", ""]).safe();
pub const LET_WITHOUT_VALUE: Message = Message::new(["missing_value", "`let {0}` has no value", "a value should follow", "write `let {0} = ` and a value"]);
pub const MISSING_LET: Message = Message::new(["missing_let", "a value is given to `{0}` without `let`", "`let {0}` should stand here", "write `let {0} = {1}`"]).safe();
pub const MISPLACED_LET: Message = Message::new(["misplaced_let", "a `let` stands within a block", "only fields stand here", "{0}"]);
pub const MISSING_KIND: Message = Message::new(["missing_kind", "a block lacks its kind", "what is this?", "write what it is before the `{`, such as `sphere {`"]);
pub const BAD_HEAD: Message = Message::new(["bad_head", "only a kind and a name stand before a `{`", "this does not belong here", "write `{0} {`, and then its fields"]).safe();
pub const BAD_REPETITION: Message = Message::new(["bad_repetition", "{0}", "not written so", "{1}"]);
/// Message about a mistake in `for INDEX < COUNT`, which repeats an object. It is used if no more
/// specific message applies.
pub const REPEATED: &str = "an object is repeated by `for INDEX < COUNT`";
/// Help for a mistake in `for INDEX < COUNT`, which repeats an object. Shows an example of a
/// correct repetition.
pub const REPEATED_SO: &str = "write, for example, `sphere for i < 8 { center (i, 1, 0) }`: i is 0, 1, 2, … 7; of two indices, as in `for i < 8, j < i`, the second counts within the first";
pub const MISPLACED_INDICES: Message = Message::new(["bad_repetition", "indices stand in the head of an object", "not in its block", "write them before the `{`, as in `sphere for i < 8 {`"]);
pub const COUNT_WITH_LAST: Message = Message::new(["bad_repetition", "an index ends before its count, and is never equal to it", "not written so", ""]);
pub const UNOPENED_BLOCK: Message = Message::new(["unopened_block", "the block `{0}` lacks its braces", "the block's fields stand between `{` and `}`", "write its fields between braces, such as `sphere { center (0, 1, 0) }`"]).safe();
pub const UNCLOSED_BLOCK: Message = Message::new(["unclosed_block", "the block of `{0}` is never closed", "opened here", ""]).safe();
pub const NESTED_BRACES: Message = Message::new(["nested_braces", "{0}", "not in a block, or around one", "a block holds fields only; write each block by itself"]);
pub const OUTSIDE_BLOCK: Message = Message::new(["outside_block", "`{0}` stands outside of every block", "this belongs to no block", "a file holds `let NAME = VALUE` and blocks such as `sphere { … }`; fields stand between a block's braces"]);
pub const NEEDLESS_SEPARATOR: Message = Message::new(["needless_separator", "no `{0}` stands between {2}{1}", "not needed", ""]).safe();
pub const STRAY_CLOSING: Message = Message::new(["stray_closing", "this `{0}` closes nothing", "nothing is open here", "write the parenthesis that opens it, or take it away"]).safe();
pub const UNEXPECTED: Message = Message::new(["unexpected", "expected {0}, found `{1}`", "not here", "{2}"]);
// Messages about fields.
pub const NEEDLESS_EQUALS: Message = Message::new(["needless_equals", "a field takes its value without `{0}`{1}", "not needed", ""]).safe();
pub const TWO_WORDS: Message = Message::new(["bad_name", "`{0}` is one word", "the name of a field", ""]).safe();
pub const MISSING_SPACE: Message = Message::new(["missing_space", "a space is missing between `{0}` and `{1}`", "a field and its value", ""]).safe();
pub const COLOR_WITHOUT_NAME: Message = Message::new(["missing_field_name", "a value stands here without the name of its field", "which field is this for?", "write `color {0}`"]);
pub const MISSING_FIELD_NAME: Message = Message::new(["missing_field_name", "a value stands here without the name of its field", "which field is this for?", "write the name of the field that `{0}` is for before it"]).safe();
// Messages about values.
pub const TOO_DEEP: Message = Message::new(["too_deep", "this value nests more than {0} levels deep", "one level more", "give a part of it a name with `let`, and use the name here"]);
pub const MISSING_OPERAND: Message = Message::new(["missing_operand", "nothing stands {0} this `{1}`", "a value is missing {0} this", "write a value {0} it, or take the `{1}` away"]);
pub const MISSING_OPERATOR: Message = Message::new(["missing_operator", "an operator is missing between `{0}` and `{1}`", "what is to be done with this?", "write an operator between them, or take one of them away"]).safe();
pub const UNKNOWN_OPERATOR: Message = Message::new(["unknown_operator", "there is no operator `{0}`", "not one of `+`, `-`, `*` and `/`", "{1}"]).safe();
pub const PLUS_SIGN: Message = Message::new(["plus_sign", "no `+` stands before a value", "not needed", ""]).safe();
pub const QUOTED: Message = Message::new(["quoted", "a value is written without quotation marks", "without the quotation marks", "write `{0}`"]).safe();
pub const FOREIGN_FUNCTION: Message = Message::new(["foreign_function", "`{0}` is a function of another language", "not a function of this language", "{1}"]);
pub const FOREIGN_NAME: Message = Message::new(["foreign_function", "`{0}` is called `{1}` here", "a name of another language", ""]);
pub const MISSING_PARENTHESES: Message = Message::new(["missing_parentheses", "values that belong together stand in parentheses", "these belong together", "{0}"]).safe();
pub const MISSING_OPEN: Message = Message::new(["missing_parentheses", "a `(` is missing between `{0}` and `{1}`", "the `)` that follows closes nothing", ""]);
pub const UNCLOSED_PARENTHESIS: Message = Message::new(["unclosed_parenthesis", "a parenthesis is never closed", "opened here", "write `)` where it ends"]).safe();
pub const BRACKETS: Message = Message::new(["brackets", "{0} stands in round parentheses", "not in these", "{1}"]).safe();
pub const MISSING_COMMA: Message = Message::new(["missing_comma", "a comma is missing between `{0}` and `{1}`", "a comma should stand before this", "write a comma or an operator between them, or take one away"]).safe();
pub const NEEDLESS_COMMA: Message = Message::new(["needless_comma", "this comma is one too many", "no value stands on one side of it", ""]).safe();
pub const MISSING_PART: Message = Message::new(["missing_value", "a value is missing beside this comma", "something is missing here", "write a value on both sides of it, such as `(1, 0, 3)`"]);
pub const DECIMAL_COMMA: Message = Message::new(["decimal_comma", "{0}", "a comma separates the parts of a vector", ""]);
pub const BAD_COLOR_CODE: Message = Message::new(["bad_color_code", "`{0}` is no colour", "{1}", "write three or six digits from 0 to 9 and a to f, such as `#fa0` or `#ffaa00`"]).safe();
pub const BAD_NUMBER: Message = Message::new(["bad_number", "`{0}` is no number", "{1}", "write a number such as `2`, `0.5` or `1e-3`"]).safe();
pub const SPACED_UNIT: Message = Message::new(["spaced_unit", "a unit stands right behind its number", "no space between the two", "{0}"]).safe();

/// Statements of other languages. Each row has three texts. The first lists the words that start
/// such statements, separated by spaces. The second is a plural noun that completes the message
/// "the language has no …". The third is the help of that message.
const STATEMENTS: &[[&str; 3]] = &[
    ["if else switch case", "conditions", "write what holds; `min` and `max` choose between two numbers"],
    ["for while loop repeat foreach", "loops", "an object is repeated by its head, as in `sphere for i < 8 { center (i, 1, 0) }`"],
    ["import include require use #include", "including of other files", "write all of a scene into one file"],
    ["#version #declare #local #macro #define #if #end", "directives", "name a value with `let NAME = VALUE`; a comment begins with `//`"],
    ["print echo printf console", "output", "take it away; `pinhole inspect` shows what a scene's values are"],
    ["function fn def fun lambda return class struct", "functions of one's own", "give each result a name with `let NAME = VALUE`"],
];

/// Looks up a word that starts a statement in other languages, such as `while`. Returns a plural
/// noun for such statements, such as "loops", and the help. Returns `None` for any other word.
pub fn statement(word: &str) -> Option<[&'static str; 2]> {
    let is_one = |row: &&[&str; 3]| row[0].split(' ').any(|start| start == word);
    STATEMENTS.iter().find(is_one).map(|row| [row[1], row[2]])
}

/// Text that is appended to the help of [`FOREIGN_FILE`] if the program that made the file uses
/// left-handed coordinates, i.e. if the z axis points away from the viewer.
const LEFT_HANDED: &str = "; turn the sign of every z (`pinhole explain left_handed`)";

/// Patterns that recognize files of other programs. A file matches a row if it begins as the row
/// says, contains enough of the row's strings, and contains none of the row's forbidden characters.
/// The columns of a row are:
///
/// - the name of the format;
/// - the possible beginnings of the file, separated by spaces: at most five characters each,
///   compared with the file's first characters other than white space;
/// - the strings to count in the file, separated by `|`;
/// - the minimum total number of these strings;
/// - the characters that must not occur in the file;
/// - a text that is appended to the help, or an empty text.
pub const FOREIGN_FILES: &[(&str, &str, &str, usize, &str, &str)] = &[
    ("XML", "<?xml", "<", 1, "", ""),
    ("XML", "<", "</", 1, "", ""),
    ("JSON", "{\" [{ [\"", "\"", 2, "", ""),
    ("a scene of POV-Ray", "", "light_source|#declare|#version|#include|pigment|global_settings|location <|look_at <", 3, "", LEFT_HANDED),
    ("a scene of pbrt", "", "LookAt |WorldBegin|Shape \"|Film \"|Integrator \"|Sampler \"|AttributeBegin|Camera \"", 2, "", LEFT_HANDED),
    ("YAML", "", ":\n|: ", 3, "{=", ""),
    ("a program in JavaScript", "const impor var let", "new THREE.|new Vector3(|require('|require(\"|=> {|console.|document.|scene.add(", 3, "", ""),
    ("a program in Python", "", "import |def |np.|self.|__name__|bpy.|print(|math.", 3, "{", ""),
    ("a program in C#", "using publi names", "using |public |class |new Vector3(|void ", 3, "", ""),
    ("a mesh of Wavefront", "", "\nv |\nvn |\nf |\nmtllib |\nusemtl ", 3, "{=", ""),
];
