//! Reads names in place of values: references and calls of functions.

use super::{Recovery, example};
use crate::{
    schema,
    syntax::{
        messages as say,
        problem::replace,
        tokens::TokenKind,
        tree::{Name, Value, ValueKind, bad},
    },
};

impl<'s> Recovery<'_, 's> {
    /// Reads a value that starts with a name: a reference, the call of a function, or a construct
    /// of another language.
    pub(super) fn reference(&mut self) -> Value<'s> {
        let name = self.name();
        if let Some(value) = self.library_name(name) {
            return value;
        }
        if self.is(0, ".") && self.is_adjacent(0) && self.is_name(1) {
            self.bump();
            let span = name.span.to(self.bump());
            let axis = match self.written(span).rsplit('.').next() {
                Some("x" | "X") => Some("(1, 0, 0)"),
                Some("y" | "Y") => Some("(0, 1, 0)"),
                Some("z" | "Z") => Some("(0, 0, 1)"),
                _ => None,
            };
            let fix = axis.filter(|_| self.words.is_let(name.text));
            let fix = fix.map(|axis| replace(span, format!("dot({}, {axis})", name.text)));
            let help =
                "give the value a name with `let NAME = VALUE`, and use the name in both places";
            let words = ["reading of fields", help];
            self.report(&say::NOT_IN_LANGUAGE, span, &words, fix);
            return bad(span);
        }
        if self.is(0, "(") {
            return self.call(name);
        }
        // An index in brackets, as in `sizes[i]` and `Ball[3]`, is a construct of other languages.
        let (is_let, is_known) = (self.words.is_let(name.text), self.words.is_value(name.text));
        if self.is(0, "[") && self.is_adjacent(0) && (is_let || !is_known) {
            let problems_before = self.problems.len();
            self.group("]");
            self.problems.truncate(problems_before);
            // If a field follows the brackets, as in `Ball[3].center`, the report includes it.
            if self.is(0, ".") && self.is_adjacent(0) && self.is_name(1) {
                self.bump();
                self.bump();
            }
            let span = name.span.to(self.behind());
            let words = if is_let {
                [
                    "lists to take a value from",
                    "write a block for each value, or compute the value from the index",
                ]
            } else {
                [
                    "values of objects",
                    "define the place with `let`, or write the formula that gives it, and use that in both",
                ]
            };
            self.report(&say::NOT_IN_LANGUAGE, span, &words, None);
            return bad(span);
        }
        match schema::function(name.text) {
            Some(row) if self.is_argument(0) => self.call_without_parentheses(name, row),
            _ => Value::new(ValueKind::Name(name.text), name.span),
        }
    }

    /// Returns whether the token `ahead` tokens after the next one can start an argument of a
    /// function that is called without parentheses.
    fn is_argument(&mut self, ahead: usize) -> bool {
        let (word, kind) = (self.word(ahead), self.kind(ahead));
        let is_sign = matches!(word, "[" | "<") || (word == "{" && self.is_flat_list());
        let is_negative = word == "-" && self.kind(ahead + 1) == TokenKind::Number;
        let is_name = kind == TokenKind::Name
            && (self.words.is_let(word) || word == "pi")
            && !self.is(ahead + 1, "(");
        !self.is_on_new_line(ahead)
            && (kind == TokenKind::Number || is_negative || is_name || (is_sign && ahead == 0))
    }

    /// Reports and reads a call without parentheses, such as `sin 30deg`, `rgb 255 0 0` or `length
    /// v - 1`. Reads as many operands as the function has parameters.
    fn call_without_parentheses(&mut self, name: Name<'s>, row: &schema::Function) -> Value<'s> {
        let close = match self.word(0) {
            "[" => "]",
            "<" => ">",
            "{" => "}",
            _ => "",
        };
        if !close.is_empty() {
            return self.call_in_brackets(name, row, close);
        }
        let most = match (row.more, self.lists) {
            (true, 0) => usize::MAX,
            _ => row.takes.len(),
        };
        let problems_before = self.problems.len();
        let mut arguments = vec![self.signed()];
        while arguments.len() < most {
            let comma = usize::from(self.is(0, ","));
            if !self.is_argument(comma) {
                break;
            }
            if comma == 1 {
                self.bump();
            }
            arguments.push(self.signed());
        }
        let span = name.span.to(self.behind());
        if self.problems.len() > problems_before {
            return bad(span);
        }
        let (list, end) = (self.list_of(&arguments), self.last_end);
        let is_whole = row.accepts(arguments.len())
            && (!row.more || self.lists == 0)
            && !self.goes_on(&arguments);
        // An operator after the last argument may belong to the argument or follow the whole call,
        // so the end of the call is uncertain.
        let whole = self.operations(bad(span)).span;
        let is_all = self.last_end == end;
        let mut fix = replace(span, format!("{}({list})", name.text));
        if !is_all {
            fix.title += ", or put more of what follows between the parentheses";
        }
        let said = say::MISSING_PARENTHESES.safe_if(is_all);
        let help = [example(self.context.takes)];
        self.report(&said, span, &help, Some(fix).filter(|_| is_whole));
        bad(whole)
    }
}
