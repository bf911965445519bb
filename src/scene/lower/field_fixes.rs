//! Edits of whole fields, for problems of a block.

use super::{Block, Given, Lowering};
use crate::{
    diagnostic::{Edit, Fix},
    scene::{
        example_beside,
        schema::{Choice, Field, Preset},
    },
    source::{SourceId, Span},
    suggest,
};

impl Lowering<'_> {
    /// Adds fields at the end of a block that stands in the file: on its line, or on lines of their own.
    pub(super) fn add_fields(
        &self,
        block: &Block<'_>,
        title: impl Into<String>,
        fields: &[String],
    ) -> Option<Fix> {
        let text = self.sources.get(block.span.source).text();
        let inside = text.get(..block.span.end)?.strip_suffix('}')?;
        if block.span.source != SourceId::File {
            return None;
        }
        let tight = inside.trim_end();
        let gap = inside.get(tight.len()..)?;
        let (place, added) = match gap.rsplit_once('\n') {
            Some((before, indent)) => {
                let end = if before.ends_with('\r') { "\r\n" } else { "\n" };
                let deeper = match first_indent(tight.get(block.span.start..)?) {
                    Some(deeper) => deeper.to_owned(),
                    None => format!("{indent}  "),
                };
                let lines = fields.iter().map(|f| format!("{deeper}{f}{end}"));
                let at = inside.len() - indent.len();
                (at..at, lines.collect())
            }
            None => {
                let apart = if tight.ends_with('{') { " " } else { "  " };
                let added = format!("{apart}{} ", fields.join("  "));
                (tight.len()..inside.len(), added)
            }
        };
        let span = Span::new(block.span.source, place.start, place.end);
        Some(Fix::new(title, [Edit::new(span, added)]))
    }

    /// Puts two corners in order: where `min` is greater than `max` on some axes, and nowhere equal, each number takes the other's place.
    pub(super) fn in_order(&self, [min, max]: [Given; 2], is_greater: [bool; 3]) -> Fix {
        let swapped: Vec<[Span; 2]> = match (min.parts, max.parts) {
            (Some(low), Some(high)) => {
                let parts = low.into_iter().zip(high).zip(is_greater);
                let swapped = parts.filter(|(_, is_greater)| *is_greater);
                swapped.map(|((low, high), _)| [low, high]).collect()
            }
            _ => vec![[min.span, max.span]],
        };
        let edits = swapped.into_iter().flat_map(|[one, other]| {
            [(one, other), (other, one)].map(|(to, from)| Edit::new(to, self.sources.text(from)))
        });
        Fix::new("put the corners in order", edits)
    }

    /// Of two fields that exclude each other, keeps either one with what belongs to it: the fields of the other ways are removed. What
    /// it needs beside itself takes the place of these.
    pub(super) fn one_of(
        &self,
        block: &Block<'_>,
        choice: &Choice,
        [earlier, later]: [&Field; 2],
    ) -> Vec<Fix> {
        let ways = [earlier, later].into_iter().map(|field| {
            let given = |name: &&str| block.given(name).is_some();
            let (kept, removed): (Vec<&[&str]>, Vec<&[&str]>) = choice
                .ways
                .iter()
                .partition(|way| way.contains(&field.name));
            let (kept, removed) = (kept.concat(), removed.concat());
            let removed: Vec<&str> = removed.into_iter().filter(given).collect();
            let needed = |name: &&str| {
                let row = block.row.field(name);
                row.is_some_and(|row| row.preset == Preset::Alternative) && !given(name)
            };
            let missing: Vec<&str> = kept.iter().copied().filter(needed).collect();
            let kept: Vec<&str> = kept.into_iter().filter(given).collect();
            let spans = removed.iter().filter_map(|name| block.given(name));
            let spans = self.joined(spans.map(|given| given.field()).collect());
            let title = format!("keep {}, remove {}", quoted(&kept), quoted(&removed));
            match missing.is_empty() {
                true => Fix::remove_whole(title, spans, self.sources),
                false => self.in_place(
                    format!("{title}, add {}", quoted(&missing)),
                    &spans,
                    &examples(block, &missing),
                ),
            }
        });
        ways.collect()
    }

    /// Writes fields in the place of the first one of those that are removed.
    fn in_place(&self, title: String, removed: &[Span], fields: &[String]) -> Fix {
        let edits = removed.iter().enumerate().map(|(index, span)| match index {
            0 => Edit::new(*span, fields.join("  ")),
            _ => Edit::remove(*span, self.sources),
        });
        Fix::new(title, edits)
    }

    /// Places in their order; those with nothing but white space between are one.
    fn joined(&self, mut places: Vec<Span>) -> Vec<Span> {
        places.sort();
        let mut joined: Vec<Span> = Vec::with_capacity(places.len());
        for place in places {
            match joined.last_mut() {
                Some(last)
                    if last.source == place.source
                        && last.end <= place.start
                        && self.is_blank(last.end, place) =>
                {
                    last.end = place.end;
                }
                _ => joined.push(place),
            }
        }
        joined
    }

    fn is_blank(&self, from: usize, place: Span) -> bool {
        let between = Span::new(place.source, from, place.start);
        self.sources.text(between).trim().is_empty()
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

/// What stands before the first text of a block's lines behind that of its `{`.
fn first_indent(block: &str) -> Option<&str> {
    let mut lines = block.lines().skip(1).filter(|line| !line.trim().is_empty());
    let line = lines.next()?;
    line.get(..line.len() - line.trim_start().len())
}
