//! Edits that several problems share.

use super::{SMALLEST, schema};
use crate::{
    diagnostic::{Edit, Fix},
    source::{SourceId, Sources, Span},
};

/// Writes what was meant, if that is known.
pub fn written<S: Into<String>>(span: Span, meant: Option<S>) -> Option<Fix> {
    meant.map(|meant| Fix::write(span, meant))
}

/// Writes one of several things in a place.
pub fn instead<S: Into<String>>(span: Span, texts: impl IntoIterator<Item = S>) -> Vec<Fix> {
    texts
        .into_iter()
        .map(|text| Fix::write(span, text))
        .collect()
}

/// Writes the smallest scene into a file without any items.
pub fn smallest_scene(sources: &Sources) -> Vec<Fix> {
    let end = sources.file.text().len();
    let edit = Edit::insert(SourceId::File, end, at_end(SMALLEST, sources));
    vec![Fix::new("write the smallest scene", [edit])]
}

/// Of a thing that is there twice, keeps the first or the second one.
pub fn one_of_two(
    name: &str,
    what: &str,
    [first, second]: [Span; 2],
    sources: &Sources,
) -> Vec<Fix> {
    let ways = [("first", "second", second), ("second", "first", first)];
    let fixes = ways.map(|(kept, removed, span)| {
        let title = format!("keep the {kept} `{name}`{what}, remove the {removed}");
        Fix::remove_whole(title, [span], sources)
    });
    fixes.to_vec()
}

/// Adds a block at the end of the file.
pub fn add_block(block: &str, fields: &[&str], sources: &Sources) -> Vec<Fix> {
    let Some(row) = schema::block(block) else {
        return Vec::new();
    };
    let rows = fields.iter().filter_map(|name| row.field(name));
    let fields: Vec<String> = rows
        .map(|field| format!("{} {}", field.name, field.example()))
        .collect();
    let added = at_end(&format!("{block} {{ {} }}\n", fields.join("  ")), sources);
    vec![Fix::new(
        format!("add {}", row.noun),
        [Edit::insert(
            SourceId::File,
            sources.file.text().len(),
            added,
        )],
    )]
}

/// Lines to add at the end of the file.
fn at_end(lines: &str, sources: &Sources) -> String {
    let text = sources.file.text();
    let line_end = sources.file.line_end();
    let apart = match text.ends_with('\n') || text.len() == sources.file.bom_len() {
        true => "",
        false => line_end,
    };
    format!("{apart}{}", lines.replace('\n', line_end))
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
