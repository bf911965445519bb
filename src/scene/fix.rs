//! Edits that several problems share.

use super::{SMALLEST, schema};
use crate::{
    diagnostic::{Edit, Fix},
    source::{SourceId, Sources, Span},
};

/// Writes the smallest scene into a file without any items.
pub fn smallest_scene(sources: &Sources) -> Fix {
    Fix::new("write the smallest scene", [at_end(SMALLEST, sources)])
}

/// Of a thing that is there twice, keeps the first or the second one.
pub fn one_of_two(name: &str, [first, second]: [Span; 2], sources: &Sources) -> [Fix; 2] {
    let ways = [("first", "second", second), ("second", "first", first)];
    ways.map(|(kept, removed, span)| {
        let title = format!("keep the {kept} `{name}`, remove the {removed}");
        Fix::remove_whole(title, [span], sources)
    })
}

/// Adds a block with these fields at the end of the file.
pub fn add_block(block: &schema::Block, fields: &[&schema::Field], sources: &Sources) -> Fix {
    let fields = fields.iter();
    let fields = fields.map(|field| format!("{} {}", field.name, field.example()));
    let fields: Vec<String> = fields.collect();
    let added = format!("{} {{ {} }}\n", block.name, fields.join("  "));
    Fix::new(format!("add {}", block.noun), [at_end(&added, sources)])
}

/// Adds lines at the end of the file.
fn at_end(lines: &str, sources: &Sources) -> Edit {
    let text = sources.file.text();
    let line_end = sources.file.line_end();
    let apart = match text.ends_with('\n') || text.len() == sources.file.bom_len() {
        true => "",
        false => line_end,
    };
    let added = format!("{apart}{}", lines.replace('\n', line_end));
    Edit::insert(SourceId::File, text.len(), added)
}

/// The place behind a field's name, with a `=` or `:` that stands there.
pub fn behind(name: Span, sources: &Sources) -> Span {
    let text = sources.get(name.source).text();
    let after = text.get(name.end..).unwrap_or_default();
    let rest = after.trim_start_matches([' ', '\t']);
    let end = match rest.strip_prefix(['=', ':']) {
        Some(rest) => text.len() - rest.len(),
        None => name.end,
    };
    Span::new(name.source, name.end, end)
}
