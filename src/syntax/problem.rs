//! Makes the diagnostics of syntax problems from the texts in `messages`.

use std::collections::BTreeMap;

use crate::{
    diagnostic::{Applicability, Diagnostic, Edit, Fix, Label, Severity},
    source::Span,
};

/// Texts of a problem, and whether its fix is safe.
#[derive(Clone, Copy, Debug)]
pub struct Message {
    /// The four texts: the code without `pinhole::`, the message, the label and the help. The help
    /// is shown only if there is no fix.
    texts: [&'static str; 4],
    applicability: Applicability,
}

impl Message {
    /// Makes a message from its code, message, label and help. Fixes of the problem are unsafe
    /// unless [`Message::safe`] marks them as safe.
    pub const fn new(texts: [&'static str; 4]) -> Self {
        Self {
            texts,
            applicability: Applicability::Unsafe,
        }
    }

    /// Marks fixes of the problem as safe. This requires that each fix keeps everything that was
    /// written and that only one meaning of the text is plausible.
    pub const fn safe(self) -> Self {
        self.safe_if(true)
    }

    /// Marks fixes of the problem as safe if `is_safe`, and as unsafe otherwise.
    pub const fn safe_if(mut self, is_safe: bool) -> Self {
        self.applicability = Applicability::safe_if(is_safe);
        self
    }

    /// Returns whether the problem is a superfluous token: its code is `plus_sign` or starts with
    /// `needless`.
    pub fn is_needless(&self) -> bool {
        self.texts[0].starts_with("needless") || self.texts[0] == "plus_sign"
    }

    /// Makes the diagnostic of the problem at `span`. Replaces `{0}`, `{1}` and so on in the texts
    /// by `words`. If there is a fix, the help is left out, since the title of the fix says what to
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
        let fix = fix
            .into()
            .map(|fix| fix.with_applicability(self.applicability));
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

/// Returns the fix that replaces the text at `span` by `text`.
pub fn replace(span: Span, text: impl Into<String>) -> Fix {
    let text = text.into();
    let title = format!("write `{}`", shorten(&text));
    Fix::new(title, [Edit::new(span, text)])
}

/// Returns a text such as ", and at 3 more places" for a problem that occurs at `more` further
/// places. Returns an empty text if `more` is 0.
pub fn further_places(more: usize) -> String {
    match more {
        0 => String::new(),
        1 => ", and at one more place".to_owned(),
        _ => format!(", and at {more} more places"),
    }
}

/// Merges all reports of the same unknown operator, such as `−` for `-`, into the first of them.
/// Afterwards, the fix of that report contains the edits for all places.
pub fn merge_sign_reports(problems: &mut Vec<Diagnostic>) {
    // Maps each message to the index in `kept` of the first report, and to the number of others.
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
            found.message += &further_places(more);
        }
    }
    *problems = kept;
}

/// Shortens a text for a message: joins its lines with spaces, and replaces everything after the
/// first 40 characters by `…`.
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
