//! Edits of whole fields, for problems of a block.

use glam::DVec3;

use super::{Block, Given, Lowering};
use crate::{
    diagnostic::{Edit, Fix},
    scene::{
        example_beside,
        schema::{Choice, Preset},
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

    /// Puts two corners in order: where `min` is greater than `max`, each number takes the other's place. None where they are equal
    /// on an axis, or their numbers do not stand apart.
    pub(super) fn in_order(&self, [min, max]: [Given; 2], [low, high]: [DVec3; 2]) -> Option<Fix> {
        if low.cmpeq(high).any() {
            return None;
        }
        let is_greater = low.cmpgt(high).into();
        let parts = min
            .parts?
            .into_iter()
            .zip(max.parts?)
            .zip::<[bool; 3]>(is_greater);
        let swapped = parts.filter(|(_, is_greater)| *is_greater);
        let edits = swapped.flat_map(|((one, other), _)| {
            [(one, other), (other, one)].map(|(to, from)| Edit::new(to, self.sources.text(from)))
        });
        Some(Fix::new("put the corners in order", edits))
    }

    /// Of two fields that exclude each other, keeps either one with what belongs to it, if that is all that it needs: the fields of the other
    /// ways are removed.
    pub(super) fn one_of(
        &self,
        block: &Block<'_>,
        choice: &Choice,
        [earlier, later]: [&str; 2],
    ) -> Vec<Fix> {
        let ways = [earlier, later].into_iter().filter_map(|field| {
            let given = |name: &&str| block.given(name).is_some();
            let ways = choice.ways.iter().copied();
            let (kept, removed): (Vec<&[&str]>, Vec<&[&str]>) =
                ways.partition(|way| way.contains(&field));
            let is_missing = |name: &&str| {
                let row = block.row.field(name);
                row.is_some_and(|row| row.preset == Preset::Alternative) && !given(name)
            };
            if kept.concat().iter().any(is_missing) {
                return None;
            }
            let [kept, removed] = [kept, removed].map(|ways| {
                ways.concat()
                    .into_iter()
                    .filter(given)
                    .collect::<Vec<&str>>()
            });
            let spans = removed.iter().filter_map(|name| block.given(name));
            Some(Fix::remove_whole(
                format!("keep {}, remove {}", quoted(&kept), quoted(&removed)),
                self.joined(spans.map(|given| given.field()).collect()),
                self.sources,
            ))
        });
        ways.collect()
    }

    /// Places in their order; those with nothing but white space between are one.
    fn joined(&self, mut places: Vec<Span>) -> Vec<Span> {
        places.sort();
        let mut joined: Vec<Span> = Vec::with_capacity(places.len());
        for place in places {
            let gap = |last: &Span| Span::new(place.source, last.end, place.start);
            match joined.last_mut() {
                Some(last)
                    if last.source == place.source
                        && self.sources.text(gap(last)).trim().is_empty() =>
                {
                    last.end = place.end;
                }
                _ => joined.push(place),
            }
        }
        joined
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
