//! Edits of fields and blocks as a whole.

use super::{block::Block, lowering::Lowering};
use crate::{
    diagnostic::{Applicability, Edit, Fix},
    scene::examples::example_beside,
    schema::{Choice, Preset},
    source::{SourceId, Sources, Span},
    suggest,
};

/// Adds lines with made-up values at the end of the file.
pub(super) fn at_end(title: impl Into<String>, lines: &str, sources: &Sources) -> Fix {
    let text = sources.file.text();
    let line_end = sources.file.line_end();
    let apart = match text.ends_with('\n') || text.len() == sources.file.bom_len() {
        true => "",
        false => line_end,
    };
    let added = format!("{apart}{}", lines.replace('\n', line_end));
    Fix::new(title, [Edit::insert(SourceId::File, text.len(), added)]).placeholder()
}

/// Of a thing that is there twice, keeps the first or the second one. Of equal ones either will do.
pub(super) fn one_of_two(name: &str, [first, second]: [Span; 2], sources: &Sources) -> [Fix; 2] {
    let ways = [("first", "second", second), ("second", "first", first)];
    ways.map(|(kept, removed, span)| {
        let title = format!("keep the {kept} `{name}`, remove the {removed}");
        let words = |span| sources.text(span).split_whitespace();
        match words(first).eq(words(second)) {
            true => remove_equal(title, span, sources),
            false => Fix::remove_whole(title, span, sources),
        }
    })
}

/// Takes away what stands elsewhere, too: nothing is lost, unless a comment goes with it or stands
/// in it.
pub(super) fn remove_equal(title: String, span: Span, sources: &Sources) -> Fix {
    let fix = Fix::remove_whole(title, span, sources);
    let mut taken = fix.edits.iter().map(|edit| sources.text(edit.span));
    let is_safe = taken.all(|text| !text.contains("//") && !text.contains("/*"));
    fix.with_applicability(Applicability::safe_if(is_safe))
}

impl Lowering<'_> {
    /// Adds fields with made-up values at the end of a block that stands in the file: on its line,
    /// or on lines of their own.
    pub(super) fn add_fields(
        &self,
        block: &Block<'_>,
        title: impl Into<String>,
        fields: &[String],
    ) -> Option<Fix> {
        let edit = Edit::add_fields(block.span, self.sources, fields)?;
        Some(Fix::new(title, [edit]).placeholder())
    }

    /// Of two fields that exclude each other, keeps either one with what belongs to it, if that is
    /// all that it needs, and nothing else stands between the fields that go.
    pub(super) fn one_of(
        &self,
        block: &Block<'_>,
        choice: &Choice,
        fields: [&str; 2],
    ) -> impl Iterator<Item = Fix> {
        let ways = fields.map(|field| {
            let ways = choice.ways.iter().copied();
            let (kept, removed): (Vec<&[&str]>, Vec<&[&str]>) =
                ways.partition(|way| way.contains(&field));
            let is_given = |name: &&str| block.given(name).is_some();
            let is_missing = |name: &&str| {
                let row = block.row.field(name);
                row.is_some_and(|row| row.preset == Preset::Alternative) && !is_given(name)
            };
            let [mut kept, mut removed] = [kept.concat(), removed.concat()];
            if kept.iter().any(is_missing) {
                return None;
            }
            kept.retain(is_given);
            removed.retain(is_given);
            let places = removed.iter().filter_map(|name| block.given(name));
            let whole = places.map(|given| given.field()).reduce(Span::to)?;
            let within = block.given.iter().flatten();
            let within =
                within.filter(|it| whole.start <= it.name.start && it.name.end <= whole.end);
            let title = format!("keep {}, remove {}", quoted(&kept), quoted(&removed));
            let fix = || Fix::remove_whole(title, whole, self.sources);
            (within.count() == removed.len()).then(fix)
        });
        ways.into_iter().flatten()
    }
}

/// Names in a title.
pub(super) fn quoted(names: &[&str]) -> String {
    let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    suggest::list(names.iter().map(String::as_str))
}

/// Fields with values that they can have beside those that are given.
pub(super) fn examples(block: &Block<'_>, names: &[&str]) -> Vec<String> {
    let rows = names.iter().filter_map(|name| block.row.field(name));
    rows.map(|row| {
        let value = example_beside(row, &|other| block.given(other)?.value);
        format!("{} {value}", row.name)
    })
    .collect()
}
