//! How a problem of syntax is made of what `messages` says.

use std::collections::BTreeMap;

use crate::{
    diagnostic::{Applicability, Diagnostic, Edit, Fix, Label, Severity},
    source::Span,
};

/// What is said of a slip.
#[derive(Clone, Copy)]
pub struct Message {
    /// Its code without `pinhole::`, what is wrong, what is said at the place, and what to do
    /// where there is no fix.
    texts: [&'static str; 4],
    applicability: Applicability,
}

impl Message {
    /// What has an unsafe fix, if any: its code, what is wrong, what is said at the place, and
    /// help.
    pub const fn new(texts: [&'static str; 4]) -> Self {
        Self {
            texts,
            applicability: Applicability::Unsafe,
        }
    }

    /// The same, whose fix keeps all that was written and has one meaning.
    pub const fn safe(self) -> Self {
        self.safe_if(true)
    }

    /// The same, whose fix does so in some places.
    pub const fn safe_if(mut self, is_safe: bool) -> Self {
        self.applicability = Applicability::safe_if(is_safe);
        self
    }

    /// Whether it is about something that is only too much.
    pub fn is_needless(&self) -> bool {
        self.texts[0].starts_with("needless") || self.texts[0] == "plus_sign"
    }

    /// The problem at a place; the words go where the message names something. A fix says what to
    /// do.
    pub fn at(&self, span: Span, words: &[&str], fix: impl Into<Option<Fix>>) -> Diagnostic {
        let filled = |text: &str| {
            let mut parts = text.split('{');
            let mut filled = parts.next().unwrap_or_default().to_owned();
            for part in parts {
                let word = part.get(..1).and_then(|index| index.parse::<usize>().ok());
                match (word.and_then(|index| words.get(index)), part.get(2..)) {
                    (Some(word), Some(rest)) => filled.extend([word, rest]),
                    _ => filled.extend(["{", part]),
                }
            }
            filled
        };
        let [code, message, label, help] = self.texts;
        let fix = fix.into().map(|fix| fix.being(self.applicability));
        let title = fix.as_ref().map(|fix| fix.title.clone());
        Diagnostic {
            severity: Severity::Error,
            code: format!("pinhole::{}", code),
            message: filled(message),
            help: title.or_else(|| Some(filled(help))),
            labels: vec![Label {
                span,
                message: filled(label),
            }],
            fixes: fix.into_iter().collect(),
            is_needless: self.is_needless(),
            is_of_syntax: true,
        }
    }
}

/// Writes a text in a place.
pub fn replace(span: Span, text: impl Into<String>) -> Fix {
    let text = text.into();
    let title = format!("write `{}`", shorten(&text));
    Fix::new(title, [Edit::new(span, text)])
}

/// That a slip was made so many times more.
pub fn times(more: usize) -> String {
    match more {
        0 => String::new(),
        1 => ", and at one more place".to_owned(),
        _ => format!(", and at {more} more places"),
    }
}

/// Makes one report, at the first place, of all that say the same of a sign, such as each `−` of
/// a text.
pub fn tell_signs_once(problems: &mut Vec<Diagnostic>) {
    // Where the report of a sign is, and how many more there were.
    let mut firsts: BTreeMap<String, (usize, usize)> = BTreeMap::new();
    let mut kept: Vec<Diagnostic> = Vec::with_capacity(problems.len());
    for mut found in std::mem::take(problems) {
        let is_sign = found.code == "pinhole::unknown_operator"
            && matches!(&*found.fixes, [fix] if matches!(&*fix.edits, [it] if it.text.len() == 1));
        if is_sign && let Some((first, more)) = firsts.get_mut(&found.message) {
            *more += 1;
            let edits = found.fixes.drain(..).flat_map(|fix| fix.edits);
            if let Some(fix) = kept.get_mut(*first).and_then(|it| it.fixes.first_mut()) {
                fix.edits.extend(edits);
            }
            continue;
        }
        if is_sign {
            firsts.insert(found.message.clone(), (kept.len(), 0));
        }
        kept.push(found);
    }
    for (first, more) in firsts.into_values() {
        if let Some(found) = kept.get_mut(first) {
            found.message += &times(more);
        }
    }
    *problems = kept;
}

/// What stands at some place, in a message: on one line, and not too long.
pub fn shorten(written: &str) -> String {
    const LONGEST: usize = 40;
    let mut short = String::new();
    for (index, word) in written.split_whitespace().enumerate() {
        if index > 0 {
            short.push(' ');
        }
        short.extend(word.chars().take(LONGEST + 1));
        if short.chars().count() > LONGEST {
            let mut cut: String = short.chars().take(LONGEST).collect();
            cut.push('…');
            return cut;
        }
    }
    short
}
