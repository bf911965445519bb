//! Explains words: diagnostic codes, the language's blocks, fields and functions, terms of the
//! camera and of sampling, and words of other programs. Each code has a page with a wrong scene,
//! the corrected one, and the reason for the rule.
//!
//! The pages are the files in `grammar/codes`, Markdown in a fixed form: a title, a description of
//! the mistake, and the sections *Wrong*, *Right* and *Why*. Tests check that every code has a
//! page, that a wrong scene has the mistake of its page and no other, and that a right scene has
//! none. The caller decides how a page is shown, in a terminal or an editor.

/// The reference of the language, as Markdown.
pub const LANGUAGE: &str = include_str!("../grammar/language.md");

/// The glossary of sampling, as Markdown: a section for each term and for each method.
pub const SAMPLING: &str = include_str!("../grammar/sampling.md");

/// The glossary of the camera, as Markdown: a section for each term.
pub const CAMERA: &str = include_str!("../grammar/camera.md");

/// Guide, as Markdown, for converting scenes of programs with left-handed coordinates or with z
/// upwards.
pub const LEFT_HANDED: &str = include_str!("../grammar/left_handed.md");

/// Words that other programs use, and where Pinhole explains their meaning. The first text of a row
/// is a list of such words, separated by commas. The second text is a word of the language or a
/// heading of the language's reference. If only one item or paragraph below the heading explains
/// the words, the heading is followed by `: ` and the item's first words.
const OTHER_NAMES: &[(&str, &str)] = &[
    ("loop, repeat, array, index, for loop", "repetition"),
    ("group, move, translate, scale", "limits: A group"),
    ("condition, if", "limits: A condition"),
    ("step", "limits: A start"),
    ("light, lighting, material, shading", "limits: Light"),
    ("shadow", "limits: A shadow"),
    ("texture, gradient", "limits: A texture"),
    ("cylinder, cone", "limits: A cylinder"),
    ("polygon, quad, disk", "limits: A quadrilateral"),
    ("power, ^", "limits: A power"),
    ("orthographic, parallel", "limits: A parallel projection"),
    ("root, function", "functions"),
    ("face", "colors"),
    (
        "axis, angle, angles, vector, number, pair, units, degrees, radians",
        "values",
    ),
    ("animation", "limits: Moving pictures"),
    (
        "mirror, glass, fog, reflection, transparency, csg, include, import",
        "limits: There is nothing",
    ),
    ("colour", "color"),
    ("operator, expression, parts, component", "operators"),
    ("comment, comments", "text"),
    ("variable, constant", "definitions"),
    ("field, block, default", "blocks"),
    ("mesh", "objects: A mesh"),
    ("wall", "objects: A wall"),
    ("image plane, picture plane, projection plane", "view plane"),
    ("projection", "perspective"),
    ("line of sight", "ray"),
    ("standard deviation, sigma", "variance"),
    ("uncertainty, ±", "standard error"),
    ("scrambling", "owen scrambling"),
    ("error bound", "bound"),
    ("cube", "box"),
    ("ball", "sphere"),
    ("floor, plane", "checkerboard"),
    ("rotate, rotation, turn", "limits: A turned object"),
    ("lens, focal, focal length", "numbers of other programs"),
    ("format, fmt", "layout"),
    ("set", "overrides"),
    ("zoom", "fov"),
    ("position", "eye"),
    ("mod, modulo, remainder, %", "unknown_operator"),
    ("metres, meters", "bad_number"),
    ("antialiasing", "samples"),
    ("strata, stratified, stratification", "stratum"),
    ("moire", "moiré"),
    ("jaggies, stairs, alias", "aliasing"),
    ("grain", "noise"),
    ("error", "rmse"),
    ("convergence", "slope"),
    ("handedness", "left_handed"),
    ("ball.x", "limits: A part of a vector"),
];

/// Returns the words that other programs use, each with the heading or the word that explains it.
pub fn other_names() -> impl Iterator<Item = (&'static str, &'static str)> {
    let named = |&(names, meant): &(&'static str, &'static str)| {
        names.split(", ").map(move |name| (name, meant))
    };
    OTHER_NAMES.iter().flat_map(named)
}

/// Documents whose sections are found by their headings.
const DOCUMENTS: [&str; 3] = [LANGUAGE, SAMPLING, CAMERA];

/// Returns the section of the language's reference, or of a glossary, that has the heading
/// `heading`, in any capitalization. Returns `None` if there is none.
pub fn section(heading: &str) -> Option<&'static str> {
    DOCUMENTS
        .into_iter()
        .find_map(|text| section_of(text, heading))
}

/// Returns the section of the Markdown text `text` whose heading is `heading`, in any
/// capitalization. Returns `None` if there is no such section.
pub fn section_of(text: &'static str, heading: &str) -> Option<&'static str> {
    let is_heading = |line: &str| line.starts_with("## ");
    let mut start = None;
    let (mut offset, mut is_scene) = (0, false);
    for line in text.split_inclusive('\n') {
        is_scene ^= line.starts_with("```");
        if !is_scene && is_heading(line) {
            if let Some(start) = start {
                return text.get(start..offset).map(str::trim_end);
            }
            let words = line.trim_start_matches('#').trim();
            if words.eq_ignore_ascii_case(heading) {
                start = Some(offset);
            }
        }
        offset += line.len();
    }
    start.and_then(|start| text.get(start..).map(str::trim_end))
}

/// Returns a part of the section `heading` of the reference: its heading, the item or paragraph
/// that starts with `words`, and a sentence that refers to the rest of the section. Returns `None`
/// if the section or the item does not exist.
pub fn part(heading: &str, words: &str) -> Option<String> {
    let section = section(heading)?;
    let lines = section.lines();
    let start = |line: &&str| !line.trim_start_matches("- ").starts_with(words);
    let mut found = lines.skip_while(start).peekable();
    let is_item = found.peek()?.starts_with("- ");
    let first = found.next()?;
    let goes_on = |line: &&str| !(line.is_empty() || is_item && line.starts_with("- "));
    let rest = found.take_while(goes_on).map(|line| format!("\n{line}"));
    let title = section.lines().next()?;
    let where_rest = format!("`pinhole explain {heading}` has the others, and an example.");
    Some(format!(
        "{title}\n\n{first}{}\n\n{where_rest}\n",
        rest.collect::<String>()
    ))
}

/// Returns the headings of the sections of the reference and of the glossaries.
pub fn headings() -> impl Iterator<Item = &'static str> {
    let lines = DOCUMENTS.into_iter().flat_map(str::lines);
    lines.filter_map(|line| line.strip_prefix("## "))
}

/// Explanation pages about one subject.
#[derive(Debug)]
pub struct Group {
    /// Subject that all pages of the group are about.
    pub name: &'static str,
    /// The pages, in the order in which one would teach them.
    pub pages: &'static [Page],
}

/// Explanation page of a diagnostic code.
#[derive(Debug, PartialEq, Eq)]
pub struct Page {
    /// The code, without `pinhole::`.
    pub code: &'static str,
    /// The page, as Markdown.
    pub text: &'static str,
}

/// Returns the page of a code, such as `bare_angle`, `pinhole::bare_angle` or
/// `error[pinhole::bare_angle]`. Returns `None` if there is no such code.
pub fn page(code: &str) -> Option<&'static Page> {
    let code = short(code);
    pages().find(|page| page.code == code)
}

/// Returns all pages.
pub fn pages() -> impl Iterator<Item = &'static Page> {
    GROUPS.iter().flat_map(|group| group.pages)
}

/// Returns a code without the text around it in a report: `error[pinhole::bare_angle]` becomes
/// `bare_angle`.
pub fn short(code: &str) -> &str {
    let inner = code.trim().trim_end_matches(':').strip_suffix(']');
    let inner = inner.and_then(|head| head.split_once('[').map(|(_, inner)| inner));
    let code = inner.unwrap_or(code).trim();
    match code.strip_prefix("pinhole") {
        Some(rest) => rest.trim_start_matches(':'),
        None => code,
    }
}

impl Page {
    /// Returns the heading at the top of the page.
    pub fn title(&self) -> &'static str {
        let first = self.text.lines().next().unwrap_or_default();
        first.strip_prefix("# ").unwrap_or(first)
    }
}

/// Defines `GROUPS`. Each line of the input consists of a subject and the codes of its pages.
macro_rules! groups {
    ($($name:literal: $($code:ident)*;)*) => {
        /// All pages, grouped by subject.
        pub const GROUPS: &[Group] = &[$(Group {
            name: $name,
            pages: &[$(Page {
                code: stringify!($code),
                text: include_str!(concat!("../grammar/codes/", stringify!($code), ".md")),
            }),*],
        }),*];
    };
}

groups! {
    "The text": foreign_file not_in_language invalid_utf8 odd_space comment_sign unclosed_comment nested_comment quoted unexpected;
    "Definitions": missing_let missing_equals missing_name bad_name missing_value misplaced_let duplicate_let predefined_name used_before_definition
        unknown_name;
    "Blocks": missing_kind unknown_kind bad_head unopened_block unclosed_block nested_braces stray_closing outside_block duplicate_block
        unexpected_name reserved_name duplicate_name bad_repetition bad_count unused_index
        missing_camera no_objects;
    "Fields": unknown_field missing_field missing_field_name missing_space duplicate_field conflicting_fields needless_equals needless_separator
        wrong_type out_of_range;
    "Numbers and angles": bad_number decimal_comma plus_sign spaced_unit bare_angle number_too_large number_underflow;
    "Colours": unknown_color bad_color_code color_range unit_color;
    "Vectors": missing_parentheses brackets missing_comma needless_comma unclosed_parenthesis part_count part_type;
    "Calculations": missing_operator missing_operand unknown_operator operand_types unknown_function foreign_function function_without_arguments
        argument_count argument_type not_finite too_deep;
    "The camera": view_undefined up_parallel empty_depth nothing_seen outside_picture;
    "Triangles and boxes": not_a_triangle on_one_line empty_box box_too_large;
    "Samples": unknown_method few_samples too_many_samples squares_too_small;
    "Overrides with --set": bad_set bad_target no_such_target;
}
