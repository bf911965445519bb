//! Fixes that add or remove whole fields and blocks.

use super::lowering::Lowering;
use crate::{
    diagnostic::{Applicability, Edit, Fix},
    scene::{examples::example_beside, lowered_block::LoweredBlock},
    schema::{Choice, Preset},
    source::{SourceId, Sources, Span},
    suggest,
};

/// Returns a fix that adds `lines`, whose values are placeholders, at the end of the file.
pub(super) fn at_end(title: impl Into<String>, lines: &str, sources: &Sources) -> Fix {
    let text = sources.file.text();
    let line_end = sources.file.line_end();
    let is_line_start = text.ends_with('\n') || text.len() == sources.file.bom_len();
    let separator = if is_line_start { "" } else { line_end };
    let added = format!("{separator}{}", lines.replace('\n', line_end));
    Fix::new(title, [Edit::insert(SourceId::File, text.len(), added)]).placeholder()
}

/// Returns two fixes for a duplicate, which stands at two spans of the text: keep the first one, or
/// keep the second. The fixes are safe if the two texts are equal, except for white space.
pub(super) fn one_of_two(name: &str, [first, second]: [Span; 2], sources: &Sources) -> [Fix; 2] {
    let ways = [("first", "second", second), ("second", "first", first)];
    ways.map(|(kept, removed, span)| {
        let title = format!("keep the {kept} `{name}`, remove the {removed}");
        let words = |span| sources.text(span).split_whitespace();
        if words(first).eq(words(second)) {
            remove_equal(title, span, sources)
        } else {
            Fix::remove_whole(title, span, sources)
        }
    })
}

/// Returns a fix that removes the text at `span` because an equal text stands elsewhere in the
/// file. The fix is safe unless it also removes a comment.
pub(super) fn remove_equal(title: String, span: Span, sources: &Sources) -> Fix {
    let fix = Fix::remove_whole(title, span, sources);
    let mut taken = fix.edits.iter().map(|edit| sources.text(edit.span));
    let is_safe = taken.all(|text| !text.contains("//") && !text.contains("/*"));
    fix.with_applicability(Applicability::safe_if(is_safe))
}

impl Lowering<'_> {
    /// Returns a fix that adds `fields`, whose values are placeholders, at the end of a block: on
    /// its line if the block is on one line, and otherwise on lines of their own. Returns `None` if
    /// the block is not in the file.
    pub(super) fn add_fields(
        &self,
        block: &LoweredBlock<'_>,
        title: impl Into<String>,
        fields: &[String],
    ) -> Option<Fix> {
        let edit = Edit::add_fields(block.span, self.sources, fields)?;
        Some(Fix::new(title, [edit]).placeholder())
    }

    /// Returns the fixes for two given fields that exclude each other, because they belong to
    /// different alternatives of `choice`. A fix keeps the fields of one alternative and removes
    /// those of all others. There are at most two fixes, one for each of the two fields. A fix is
    /// omitted if the kept alternative would be incomplete. It is also omitted if the removed
    /// fields do not follow each other directly in the text.
    pub(super) fn one_of(
        &self,
        block: &LoweredBlock<'_>,
        choice: &Choice,
        fields: [&str; 2],
    ) -> impl Iterator<Item = Fix> {
        let ways = fields.map(|field| {
            let ways = choice.ways.iter().copied();
            let (kept, removed): (Vec<&[&str]>, Vec<&[&str]>) =
                ways.partition(|way| way.contains(&field));
            let is_given = |name: &&str| block.given_by_name(name).is_some();
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
            let places = removed.iter().filter_map(|name| block.given_by_name(name));
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

/// Lists names in backquotes, for a title.
pub(super) fn quoted(names: &[&str]) -> String {
    let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    suggest::list(names.iter().map(String::as_str))
}

/// Returns the fields `names` as text, each with an example value that does not contradict the
/// given fields.
pub(super) fn examples(block: &LoweredBlock<'_>, names: &[&str]) -> Vec<String> {
    let rows = names.iter().filter_map(|name| block.row.field(name));
    rows.map(|row| {
        let value = example_beside(row, &|other| block.given_by_name(other)?.value);
        format!("{} {value}", row.name)
    })
    .collect()
}
