//! Describes the words of the scene language in Markdown, from the tables of the language. Hovers,
//! completion and `pinhole explain` show these texts.

use std::{fmt::Write, ops::Range};

use crate::{
    schema::{self, BlockRow, FieldRow, Function, Preset, Type, css},
    suggest,
};

/// Markdown text about `let`.
pub const ABOUT_LET: &str =
    "`let NAME = VALUE` gives a value a name, for what stands further down.";

/// Markdown text about `for`, which repeats an object of the scene.
pub const ABOUT_FOR: &str = "`for INDEX < COUNT` in the head of an object repeats it: the index is 0, 1, 2 and so on up to COUNT - 1. Of several, separated by commas, the last one counts fastest, and a count may depend on the indices before it. A `color` may be a pair: the first where the sum of the indices is even.";

/// Describes a word of the language in all its meanings: kind of block, field, method, function,
/// constant, colour, `let` and `for`. Except for constants and colours, a description includes an
/// example. Returns `None` if the language does not have the word.
pub fn word(word: &str) -> Option<String> {
    let mut parts = Vec::new();
    let example = |text: &str| format!("\n\n```scn\n{text}\n```");
    if word == "let" {
        parts.push(ABOUT_LET.to_owned() + &example("let middle = (0, 1, 0)"));
    }
    if word == "for" {
        let balls = "sphere Ball for i < 8, j < i { center (i, j, 0)  radius 0.4 }";
        parts.push(ABOUT_FOR.to_owned() + &example(balls));
    }
    if let Some(row) = schema::block(word) {
        parts.push(block_page(row) + &example(&row.example()));
    }
    for row in schema::BLOCKS {
        if let Some(field) = row.field(word) {
            parts.push(about_field(row, field) + &example(&format!("{word} {}", field.example)));
        }
    }
    for (method, help) in schema::METHODS {
        if method.name() == word {
            let sampler = format!("sampler {{ method {word} }}");
            parts.push(format!(
                "`{word}`, a method of the sampler: {help}{}",
                example(&sampler)
            ));
        }
    }
    if let Some(function) = schema::function(word) {
        let call = format!("let value = {}", function.call());
        parts.push(about_function(function) + &example(&call));
    }
    for (name, _, help) in schema::CONSTANTS {
        if *name == word {
            parts.push(format!("`{name}`: {help}"));
        }
    }
    if let Some(color) = css::color(word) {
        parts.push(format!("`{word}`: the colour `{color}`"));
    }
    let text = format!("# {word}\n\n{}\n", parts.join("\n\n"));
    (!parts.is_empty()).then_some(text)
}

/// Describes the field `path`, written `BLOCK.FIELD`, with an example. Returns `None` if there is
/// no such field.
pub fn field_of(path: &str) -> Option<String> {
    let (block, name) = path.split_once('.')?;
    let row = schema::block(block)?;
    let field = row.field(name)?;
    let about = about_field(row, field);
    let example = format!("{name} {}", field.example);
    Some(format!("# {path}\n\n{about}\n\n```scn\n{example}\n```\n"))
}

/// Returns every word for which [`word`] has a description, except colours.
pub fn words() -> impl Iterator<Item = &'static str> {
    let fields = schema::BLOCKS.iter().flat_map(BlockRow::field_names);
    let functions = schema::FUNCTIONS.iter().map(|function| function.name);
    let constants = schema::CONSTANTS.iter().map(|(name, ..)| *name);
    let blocks = ["let", "for"].into_iter().chain(schema::block_names());
    blocks
        .chain(fields)
        .chain(schema::method_names())
        .chain(functions)
        .chain(constants)
}

/// Describes a kind of block: its help line, its fields, and which fields exclude each other, such
/// as `fov` and `d` of a camera.
fn block_page(row: &BlockRow) -> String {
    let mut text = about_block(row);
    for choice in row.choices {
        let _ = write!(
            text,
            "\n\nOf several ways to say the same, a block takes one: {}.",
            choice.why
        );
    }
    text
}

/// Describes a kind of block: its help line and a list of its fields.
pub fn about_block(row: &BlockRow) -> String {
    let mut text = format!("`{}`: {}\n", row.name, row.help);
    for field in row.fields {
        let _ = write!(
            text,
            "\n- `{}` ({}): {}",
            field.name,
            kind_and_preset(field),
            field.help
        );
    }
    text
}

/// Describes a field: its meaning, type, default and conditions.
pub fn about_field(row: &BlockRow, field: &FieldRow) -> String {
    let mut text = format!(
        "`{}` of {}: {}\n\n({})",
        field.name,
        row.noun,
        field.help,
        kind_and_preset(field)
    );
    if !field.must.is_empty() {
        let must: Vec<String> = field.must.iter().map(ToString::to_string).collect();
        let must = suggest::list(must.iter().map(String::as_str));
        let _ = write!(text, "; must be {must}");
    }
    let others: Vec<String> = row
        .excludes(field.name)
        .map(|name| format!("`{name}`"))
        .collect();
    if !others.is_empty() {
        let others = suggest::choice(others.iter().map(String::as_str));
        let _ = write!(text, "; not together with {others}");
    }
    for rule in row.rules_of(field.name) {
        let _ = write!(text, "; {rule}");
    }
    if field.takes == Type::Method {
        text.push('\n');
        for (method, help) in schema::METHODS {
            let _ = write!(text, "\n- `{}`: {help}", method.name());
        }
    }
    text
}

/// Returns the type of a field and its default, in words.
pub fn kind_and_preset(field: &FieldRow) -> String {
    let kind = field.takes.word();
    match field.preset {
        Preset::Value(literal) => format!("{kind}, `{literal}` by default"),
        Preset::Required => format!("{kind}, required"),
        Preset::Alternative | Preset::Nothing => kind.to_owned(),
    }
}

/// Describes a function: its signature and its meaning.
pub fn about_function(function: &Function) -> String {
    format!("`{}`: {}", signature(function).0, function.help)
}

/// Returns the signature of a function as text, and the byte range of each parameter in this text.
pub fn signature(function: &Function) -> (String, Vec<Range<usize>>) {
    let mut label = format!("{}(", function.name);
    let mut parameters = Vec::new();
    for (index, takes) in function.takes.iter().enumerate() {
        if index > 0 {
            label.push_str(", ");
        }
        let start = label.len();
        // A parameter without a name is shown by its type.
        let name = function.parameters.get(index);
        label.push_str(name.copied().unwrap_or_else(|| takes.word()));
        parameters.push(start..label.len());
    }
    if function.more {
        label.push_str(", ");
        let start = label.len();
        label.push('…');
        parameters.push(start..label.len());
    }
    let _ = write!(label, ") → {}", function.gives.word());
    (label, parameters)
}
