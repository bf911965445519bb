//! Reads definitions, including those that lack their `let`, their name, their `=` or their value.

use super::{Recovery, is_name};
use crate::{
    diagnostic::{Edit, Fix},
    source::Span,
    suggest,
    syntax::{
        messages::{self as say, statement},
        problem::shorten,
        tree::{Definition, Item, Name, Value, ValueKind, bad},
    },
};

/// Words that start a definition in other languages, separated by spaces.
const OTHER_LETS: &str =
    "var const def define set val auto local int float double number vec3 vector";

/// Maximum number of preceding items that are searched for a definition of the same name; earlier
/// definitions are not found. Without a limit, the time would grow with the square of the number of
/// lines. With a much smaller maximum, fewer definitions would be found.
const ITEMS_BEFORE: usize = 64;

impl<'s> Recovery<'_, 's> {
    /// Reads a definition, `let NAME = VALUE`.
    pub(super) fn definition(&mut self) {
        let keyword = self.bump();
        let mut definition = Definition::begun(keyword);
        let problems_before = self.problems.len();
        definition.name = self.name_of_definition(keyword);
        if let Some(name) = definition.name
            && self.is(0, "=")
            && self.is_name(1)
            && self.is(2, "{")
            && !self.is_on_new_line(1)
        {
            self.bump();
            return self.named_block(keyword, name);
        }
        definition.equals = matches!(self.word(0), "=" | ":" | ":=").then(|| self.bump());
        if self.is(0, "=") && self.is_adjacent(0) {
            definition.equals = definition.equals.map(|first| first.to(self.bump()));
        }
        definition.value = self.value_of_definition(definition.name, definition.equals);
        self.clear_uncertain_fixes(problems_before);
        definition.span = keyword.to(definition.value.span);
        let is_right = self.problems.len() == problems_before;
        // A name after the definition is correct, since it starts the next item. A separator after
        // a correct definition is reported later, by `separator`. Any other token is unexpected.
        let is_next = self.is_name(0) || (is_right && matches!(self.word(0), ";" | ","));
        if !is_next && !self.is_boundary() {
            if is_right {
                let help = "write one value behind the `=`";
                self.unexpected("the end of the definition", help);
                definition.value = bad(definition.value.span);
            }
            self.resync();
        }
        self.items.push(Item::Definition(definition));
    }

    fn value_of_definition(&mut self, name: Option<Name<'s>>, sign: Option<Span>) -> Value<'s> {
        let (start, problems_before) = (self.here(), self.problems.len());
        let value = (!self.is_end_of_definition()).then(|| self.value());
        let Some(name) = name else {
            self.problems.truncate(problems_before);
            return bad(value.map_or(self.behind(), |value| value.span));
        };
        let text = shorten(name.text);
        let Some(value) = value else {
            let span = name.span.to(sign.unwrap_or(name.span));
            self.report(&say::LET_WITHOUT_VALUE, span, &[&text], None);
            return bad(self.behind());
        };
        let edit = match sign {
            Some(sign) if self.written(sign) == "=" => return value,
            Some(sign) => Edit::new(Span::new(self.id, name.span.end, sign.end), " ="),
            None => Edit::insert(self.id, start.start, "= "),
        };
        let title = format!("write `let {text} = {}`", self.short(value.span));
        let fix = Fix::new(title, [edit]);
        self.report(&say::MISSING_EQUALS, sign.unwrap_or(start), &[&text], fix);
        value
    }

    /// Reads the name after `let`. Several tokens before the `=` are reported together as a bad
    /// name. Returns `None` if the name is missing or bad.
    fn name_of_definition(&mut self, keyword: Span) -> Option<Name<'s>> {
        let is_sign = matches!(self.word(0), "=" | ":" | ":=");
        if is_sign || self.is_end_of_definition() || self.is_head(0) {
            let span = if is_sign { self.here() } else { keyword };
            self.report(&say::MISSING_NAME, span, &[], None);
            return None;
        }
        let is_end = |word: &str| matches!(word, "=" | ":" | ":=" | "{" | "}" | "let");
        let count = self.find_in_line(is_end);
        let has_equals =
            matches!(self.word(count), "=" | ":" | ":=") && !self.is_on_new_line(count);
        if self.is_name(0) && (count == 1 || !has_equals) {
            return Some(self.name());
        }
        let is_function = self.is_name(0) && self.is(1, "(") && !self.is(2, ")");
        let mut span = self.bump();
        for _ in 1..if has_equals { count } else { 1 } {
            span = span.to(self.bump());
        }
        if is_function && let Some(said) = statement("function") {
            self.report(&say::NOT_IN_LANGUAGE, span, &said, None);
        } else {
            // For a name such as `2ball`, the help suggests the name with the digits at its end,
            // `ball2`.
            let written = self.short(span);
            let letters = written.trim_start_matches(|c: char| c.is_ascii_digit());
            let digits = written.len() - letters.len();
            let help = if is_name(letters) && digits > 0 {
                format!(
                    ", as in `{letters}{}`",
                    written.get(..digits).unwrap_or_default()
                )
            } else {
                String::new()
            };
            self.report(&say::BAD_NAME, span, &[&written, &help], None);
        }
        self.items.push(Item::Bad(span));
        None
    }

    /// Returns whether the next token ends the definition, so that its value is missing.
    fn is_end_of_definition(&mut self) -> bool {
        let word = self.word(0);
        matches!(word, "" | "let" | "{" | "}" | ";")
            || (self.is_name(0)
                && self.is_on_new_line(0)
                && !self.is_foreign_call()
                && (!self.words.is_value(word) || self.is_head(0)))
    }

    /// Reads a definition that lacks its `let`, as in `x = 3` or `var x = 3`. Returns `false` and
    /// reads nothing if the line is not such a definition.
    pub(super) fn missing_let(&mut self) -> bool {
        let (word, start) = (self.word(0), self.here());
        let is_let = suggest::nearest(word, ["let"]).is_some()
            || OTHER_LETS.split(' ').any(|other| other == word);
        let is_plain = self.is(1, "=");
        if !(is_plain || (is_let && self.is_name(1) && self.is(2, "="))) {
            return false;
        }
        if !is_plain {
            self.bump();
        }
        let name = self.name();
        let mut definition = Definition::begun(Span::new(self.id, start.start, start.start));
        definition.name = Some(name);
        definition.equals = Some(self.bump());
        let problems_before = self.problems.len();
        let value = (!self.is_end_of_definition()).then(|| self.value());
        let value = value.unwrap_or_else(|| bad(self.behind()));
        let text = shorten(name.text);
        let written = self.written(value.span);
        if is_plain && self.is_assigned_again(word, written) {
            let what = "assignments: a name keeps its value";
            let help = "give the new value a name of its own with `let NAME = VALUE`";
            self.problems.truncate(problems_before);
            self.report(&say::NOT_IN_LANGUAGE, start, &[what, help], None);
        } else {
            let before = Span::new(self.id, start.start, name.span.start);
            let mut edits = vec![Edit::new(before, "let ")];
            // In other languages, a `;` ends the definition. The fix removes it.
            if self.is(0, ";") {
                let sign = self.bump();
                edits.push(Edit::remove_in(sign, self.text));
            }
            let is_next = self.is_on_new_line(0) || (self.is_name(0) && self.is(1, "="));
            let is_right = self.problems.len() == problems_before && value.kind != ValueKind::Bad;
            self.problems.truncate(problems_before);
            let right = shorten(written);
            let title = format!("write `let {text} = {right}`");
            let fix = (is_right && is_next).then(|| Fix::new(title, edits));
            // A word of another language, such as `var` or `int`, may say something that `let` does
            // not say, so replacing it is not safe.
            let is_foreign = !is_plain && suggest::nearest(word, ["let"]).is_none();
            let said = say::MISSING_LET.safe_if(!is_foreign);
            self.report(&said, start, &[&text, &right], fix);
            definition.span = start.to(value.span);
            definition.value = bad(value.span);
            self.items.push(Item::Definition(definition));
        }
        self.resync();
        true
    }

    /// Returns whether `name = value` assigns a new value to a name rather than defining it: the
    /// name is already defined, or occurs in `value`.
    fn is_assigned_again(&self, name: &str, value: &str) -> bool {
        let is_defined = |item: &Item<'s>| match item {
            Item::Definition(it) => it.name.is_some_and(|it| it.text == name),
            _ => false,
        };
        let mut words = value.split(|c: char| !c.is_alphanumeric());
        self.words.is_let(name)
            || words.any(|word| word == name)
            || self.items.iter().rev().take(ITEMS_BEFORE).any(is_defined)
    }
}
