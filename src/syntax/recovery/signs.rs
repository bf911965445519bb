//! Collects needless separators, such as `;` and `=`, and the characters that start comments in
//! other languages, such as `#`. If the same sign occurs several times in a block, or outside of
//! all blocks, it is reported once, with a fix for all of its places.

use super::{Recovery, numbers::unit_of};
use crate::{
    diagnostic::{Edit, Fix, MOST_PROBLEMS},
    source::Span,
    syntax::{messages as say, problem::further_places},
};

impl Recovery<'_, '_> {
    /// Reads a `,` or `;` between fields or items, and records it as needless. If a value follows,
    /// the author may have wanted to continue a list. No recorded separator then gets a fix.
    pub(super) fn separator(&mut self) {
        let sign = self.bump();
        self.note_sign(sign);
        let word = self.word(0);
        let is_value = self.starts_value(0)
            && (!self.is_name(0) || self.words.is_value(word) || unit_of(word).is_some());
        self.context.is_doubtful |= is_value && !self.is_boundary();
    }

    pub(super) fn note_sign(&mut self, sign: Span) {
        let word = self.written(sign);
        let places = self.context.signs.entry(word).or_default();
        if places.len() < MOST_PROBLEMS {
            places.push(sign)
        } else {
            self.problems.leave_out(sign)
        }
    }

    /// Reports the recorded separators, and the recorded characters that start comments in other
    /// languages. If one of the problems from the index `first` on has no fix, the purpose of the
    /// separators is uncertain, and they get no fix either.
    pub(super) fn report_signs(&mut self, first: usize) {
        let since = self.problems.get(first..).unwrap_or_default();
        let is_doubtful = since.iter().any(|problem| problem.fixes.is_empty())
            || std::mem::take(&mut self.context.is_doubtful);
        let between = if self.context.is_block {
            "fields"
        } else {
            "items"
        };
        for (sign, places) in std::mem::take(&mut self.context.signs) {
            let Some(&at) = places.first() else { continue };
            let it = if places.len() > 1 { "them" } else { "it" };
            let (message, title) = match sign {
                "=" | ":" | ":=" => (&say::NEEDLESS_EQUALS, format!("take {it} away")),
                "," | ";" => {
                    let title = format!("take {it} away; white space separates {between}");
                    (&say::NEEDLESS_SEPARATOR, title)
                }
                _ => (&say::COMMENT_SIGN, "write `//`".to_owned()),
            };
            let edits = places.iter().map(|&place| {
                if message.is_needless() {
                    return Edit::remove_in(place, self.text);
                }
                let rest = self.text.get(place.start..).unwrap_or_default();
                let signs = rest.len() - rest.trim_start_matches(['#', '-', ';', '%']).len();
                Edit::new(Span::new(self.id, place.start, place.start + signs), "//")
            });
            let words = [sign.trim(), &further_places(places.len() - 1), between];
            let mut found = message.at(at, &words, Fix::new(title, edits));
            if is_doubtful && found.is_needless {
                found.fixes.clear();
            }
            self.problems.push_earlier(found);
        }
    }
}
