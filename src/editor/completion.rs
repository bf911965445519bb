//! Computes the completions at an offset of the text.
//!
//! A field or a block is inserted with example values, which the author replaces by typing.

use super::{
    analysis::Analysis,
    cursor::{Expected, Situation, situation},
    hover,
};
use crate::{
    color::Color,
    scene::{describe, example_beside},
    schema::{self, BlockKind, FieldRow, Function, Preset, Type, Value, css},
    source::Span,
};

/// A completion: a word or a longer text that an editor offers to insert.
#[derive(Clone, Debug, PartialEq)]
pub struct Completion {
    /// The text shown in the list of completions. Editors compare it with the typed word.
    pub label: String,
    /// Kind of the completion, for which editors show a symbol.
    pub kind: CompletionKind,
    /// A short description beside the label, such as the type or the value.
    pub detail: String,
    /// A longer description in Markdown.
    pub help: String,
    /// The inserted text, with placeholders for values.
    pub insert: Vec<SnippetPart>,
    /// The span that the inserted text replaces.
    pub replaces: Span,
    /// Rank in the list of completions. Smaller ranks come first.
    pub rank: u8,
}

/// Kind of a completion.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum CompletionKind {
    /// The keyword `let`.
    Keyword,
    /// A whole block, such as `sphere { … }`.
    Block,
    /// A field of a block.
    Field,
    /// The name of a definition (`let`) or of an index (`for`).
    Definition,
    /// A function.
    Function,
    /// A sampling method.
    Method,
    /// A predefined constant or unit: `pi`, `deg`, `rad`.
    Constant,
    /// A named colour.
    Color(Color),
    /// An example value of a field.
    Value,
}

/// A part of the text that a completion inserts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SnippetPart {
    /// Text that is inserted as it is.
    Text(String),
    /// An example value, which the editor selects so that typing replaces it.
    Placeholder(String),
}

/// Returns the completions at the offset `at`, the best ones first.
pub fn completions(analysis: &Analysis<'_>, at: usize) -> Vec<Completion> {
    let at = analysis.source().floor_char_boundary(at);
    let Some(situation) = situation(analysis, at) else {
        return Vec::new();
    };
    let mut completions = match situation.expected {
        Expected::Item => items(analysis, &situation),
        Expected::Field => fields(analysis, &situation),
        Expected::Value => values(analysis, &situation),
    };
    completions.sort_by(|a, b| (a.rank, &a.label).cmp(&(b.rank, &b.label)));
    completions
}

/// Returns a completion that replaces the typed word by `word`, without placeholders.
fn word(
    situation: &Situation,
    word: &str,
    kind: CompletionKind,
    [detail, help]: [String; 2],
    rank: u8,
) -> Completion {
    Completion {
        label: word.to_owned(),
        kind,
        detail,
        help,
        insert: vec![text(word)],
        replaces: situation.word,
        rank,
    }
}

fn text(text: impl Into<String>) -> SnippetPart {
    SnippetPart::Text(text.into())
}

fn placeholder(value: impl Into<String>) -> SnippetPart {
    SnippetPart::Placeholder(value.into())
}

/// Returns completions for `let`, for all kinds of objects, and for each of `image`, `camera` and
/// `sampler` that the scene does not contain yet.
fn items(analysis: &Analysis<'_>, situation: &Situation) -> Vec<Completion> {
    let is_there = |row: &schema::BlockRow| {
        // While the word `sp` is typed in front of `camera {`, the parser reads `sp camera {`: a
        // block with the keyword `sp` and the name `camera`. So a kind of block is present if its
        // word stands in the place of a keyword or of a name.
        let words = analysis.blocks().flat_map(|block| [block.kind, block.name]);
        let mut words = words.flatten();
        words.any(|word| word.span != situation.word && word.text == row.name)
    };
    let rows = schema::BLOCKS.iter();
    let rows = rows.filter(|row| row.is_object || !is_there(row));
    let blocks = rows.map(|row| {
        let about = [row.help.to_owned(), describe::about_block(row)];
        // The camera comes first, because a scene needs one.
        let rank = u8::from(row.kind != BlockKind::Camera);
        let mut block = word(situation, row.name, CompletionKind::Block, about, rank);
        // If the text after the word already looks like the rest of a block, only the keyword is
        // inserted.
        if !situation.goes_on {
            block.insert = block_with_fields(row);
        }
        block
    });
    let about = ["gives a value a name", describe::ABOUT_LET].map(str::to_owned);
    let definition = Completion {
        insert: vec![
            text("let "),
            placeholder("name"),
            text(" = "),
            placeholder("1"),
        ],
        ..word(situation, "let", CompletionKind::Keyword, about, 2)
    };
    blocks.chain([definition]).collect()
}

/// Returns the text of a block with the fields that it must have. A block with at most one required
/// field is written on one line.
fn block_with_fields(row: &schema::BlockRow) -> Vec<SnippetPart> {
    let least = row.least_fields();
    let (open, between, close) = match least.len() {
        0 | 1 => (" { ", "  ", " }"),
        _ => (" {\n  ", "\n  ", "\n}"),
    };
    let mut pieces = vec![text(format!("{}{open}", row.name))];
    // The values of the fields are aligned in a column, as the formatter does.
    let widest = least.iter().map(|field| field.name.len()).max();
    let width = widest.unwrap_or(0);
    for (index, field) in least.iter().enumerate() {
        if index > 0 {
            pieces.push(text(between));
        }
        pieces.push(text(format!("{:width$} ", field.name)));
        pieces.extend(value_to_type_over(field.example));
    }
    if least.is_empty() {
        pieces.push(placeholder(""));
    }
    pieces.push(text(close));
    pieces
}

/// Splits an example value into the parts of a snippet. Each element of a list becomes a
/// placeholder. A value that is not a list becomes one placeholder.
fn value_to_type_over(example: &str) -> Vec<SnippetPart> {
    let inner = example.strip_prefix('(').and_then(|e| e.strip_suffix(')'));
    match inner {
        Some(inner) => list_to_type_over("(", inner.split(", ")),
        None => vec![placeholder(example)],
    }
}

/// Returns the snippet parts of a list. `open` is the text before the list's elements, e.g. `(`.
/// Each of the elements `parts` becomes a placeholder.
fn list_to_type_over<'p>(open: &str, parts: impl Iterator<Item = &'p str>) -> Vec<SnippetPart> {
    let mut pieces = vec![text(open)];
    for part in parts {
        if pieces.len() > 1 {
            pieces.push(text(", "));
        }
        pieces.push(placeholder(part));
    }
    pieces.push(text(")"));
    pieces
}

/// Returns an example value for the field `field`. The value does not contradict the other fields
/// of the current block.
fn example(analysis: &Analysis<'_>, situation: &Situation, field: &FieldRow) -> String {
    let at = situation.word.start;
    // The current block is the last one that starts before the word. Its `}` may still be missing.
    let blocks = analysis.blocks();
    let block = blocks.take_while(|block| block.span.start <= at).last();
    example_beside(field, &|name| {
        let row = situation.block?.field(name)?;
        let given = block?.fields.iter().find(|given| given.name.text == name)?;
        analysis.model.value(&given.value, Some(row.takes))
    })
}

/// Returns completions for the fields that can be added to the current block: those that it does
/// not have yet and that do not conflict with its other fields.
fn fields(analysis: &Analysis<'_>, situation: &Situation) -> Vec<Completion> {
    let Some(row) = situation.block else {
        return Vec::new();
    };
    let is_open = |field: &&FieldRow| {
        let given = &situation.given;
        !given.contains(&field.name) && !row.excludes(field.name).any(|name| given.contains(&name))
    };
    let fields = row.fields.iter().filter(is_open).map(|field| {
        let detail = describe::kind_and_preset(field).replace('`', "");
        let about = [detail, describe::about_field(row, field)];
        let rank = match field.preset {
            Preset::Required => 0,
            Preset::Alternative => 1,
            Preset::Value(_) | Preset::Nothing => 2,
        };
        let mut completion = word(situation, field.name, CompletionKind::Field, about, rank);
        if !situation.goes_on {
            completion.insert = vec![text(format!("{} ", field.name))];
            let example = example(analysis, situation, field);
            completion.insert.extend(value_to_type_over(&example));
        }
        completion
    });
    fields.collect()
}

/// Returns completions for a value or a part of a value.
fn values(analysis: &Analysis<'_>, situation: &Situation) -> Vec<Completion> {
    if situation.wanted == Some(Type::Method) {
        return methods(situation);
    }
    let wanted = situation.wanted;
    let is_color =
        wanted.map(|wanted| matches!(wanted, Type::Color | Type::Colors | Type::FaceColors));
    let lists = [Some(Type::Colors), Some(Type::FaceColors)];
    let mut completions: Vec<Completion> = written_out(analysis, situation).into_iter().collect();
    completions.extend(definitions(analysis, situation, is_color));
    if lists.contains(&wanted) {
        // The value must be a list of colours, so functions and single colours are not offered.
        return completions;
    }
    completions.extend(functions(situation, is_color));
    if is_color != Some(true) {
        completions.extend(constants(situation));
    }
    if is_color != Some(false) {
        completions.extend(colors(situation));
    }
    completions
}

fn methods(situation: &Situation) -> Vec<Completion> {
    let methods = schema::METHODS.iter().map(|(method, help)| {
        let about = [*help; 2].map(str::to_owned);
        word(situation, method.name(), CompletionKind::Method, about, 0)
    });
    methods.collect()
}

/// Returns a completion with the field's example value. Returns `None` if a part of the value is
/// typed already.
fn written_out(analysis: &Analysis<'_>, situation: &Situation) -> Option<Completion> {
    let field = situation.field.filter(|_| situation.is_whole_value)?;
    let example = example(analysis, situation, field);
    let detail = match field.preset {
        Preset::Value(literal) if example == literal => "the default",
        _ => field.takes.word(),
    };
    let about = [detail, field.help].map(str::to_owned);
    Some(Completion {
        insert: value_to_type_over(&example),
        ..word(situation, &example, CompletionKind::Value, about, 0)
    })
}

/// Returns completions for the `for` indices of the current block and for the definitions before
/// the typed word. If `is_color` is `Some(true)`, only colours are offered. If it is `Some(false)`,
/// colours are left out. If it is `None`, all are offered.
fn definitions(
    analysis: &Analysis<'_>,
    situation: &Situation,
    is_color: Option<bool>,
) -> Vec<Completion> {
    let mut completions = Vec::new();
    let block = analysis.path(situation.word.start).block;
    let indices = block.and_then(|block| block.repetition.as_ref());
    for index in indices.iter().flat_map(|it| &it.indices) {
        if is_color != Some(true) && index.name.span.end < situation.word.start {
            let about = ["an index".to_owned(), hover::about_index(analysis, index)];
            let rank = rank(situation, Some(Type::Number));
            let kind = CompletionKind::Definition;
            completions.push(word(situation, index.name.text, kind, about, rank));
        }
    }
    for definition in analysis.model.definitions() {
        let Some(name) = definition.name else {
            continue;
        };
        let is_own = situation.field.is_none() && situation.defining == Some(name.span);
        let is_before = definition.span.end <= situation.word.start && !is_own;
        let first = analysis.model.definition_at(name.text, usize::MAX);
        let is_first = first.is_some_and(|first| first.span == definition.span);
        if !is_before || !is_first {
            continue;
        }
        let value = analysis.model.defined(definition);
        let kind = value.map(|value| value.kind());
        let fits = match (is_color, kind) {
            (_, Some(kind @ (Type::Colors | Type::FaceColors))) => situation.wanted == Some(kind),
            (_, Some(_)) if matches!(situation.wanted, Some(Type::Colors | Type::FaceColors)) => {
                false
            }
            (Some(is_color), Some(kind)) => is_color == (kind == Type::Color),
            _ => true,
        };
        if !fits {
            continue;
        }
        let rank = rank(situation, kind);
        let kind = match value {
            Some(Value::Color(color)) => CompletionKind::Color(color),
            _ => CompletionKind::Definition,
        };
        let detail = value.map(|value| value.to_string()).unwrap_or_default();
        let about = [detail, hover::about_definition(analysis, definition)];
        completions.push(word(situation, name.text, kind, about, rank));
    }
    completions
}

fn functions(situation: &Situation, is_color: Option<bool>) -> Vec<Completion> {
    let gives_color = |function: &&Function| function.gives == Type::Color;
    let functions = schema::FUNCTIONS.iter().filter(|function| match is_color {
        Some(is_color) => gives_color(function) == is_color,
        None => true,
    });
    let functions = functions.map(|function| {
        let about = [
            describe::signature(function).0,
            describe::about_function(function),
        ];
        let rank = rank(situation, Some(function.gives)) + 2;
        let kind = CompletionKind::Function;
        let mut completion = word(situation, function.name, kind, about, rank);
        if !situation.goes_on {
            let open = format!("{}(", function.name);
            completion.insert = list_to_type_over(&open, function.example().iter().copied());
        }
        completion
    });
    functions.collect()
}

fn constants(situation: &Situation) -> Vec<Completion> {
    let constants = schema::CONSTANTS.iter().map(|(name, _, help)| {
        let about = [*help; 2].map(str::to_owned);
        word(situation, name, CompletionKind::Constant, about, 5)
    });
    constants.collect()
}

fn colors(situation: &Situation) -> Vec<Completion> {
    let colors = css::names().filter_map(|name| Some((name, css::color(name)?)));
    let colors = colors.map(|(name, color)| {
        let about = [color.to_string(), hover::about_color(color)];
        let rank = if situation.wanted.is_some() { 2 } else { 6 };
        word(situation, name, CompletionKind::Color(color), about, rank)
    });
    colors.collect()
}

/// Returns the rank of a value of the type `kind` in the list of completions: 1 if it has the
/// wanted type or if no type is wanted, otherwise 2.
fn rank(situation: &Situation, kind: Option<Type>) -> u8 {
    u8::from(situation.wanted.is_some() && kind != situation.wanted) + 1
}
