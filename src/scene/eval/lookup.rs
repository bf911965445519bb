//! What a name stands for, and what is wrong with one that stands for nothing.

use super::{Evaluator, names::Defined};
use crate::{
    diagnostic::{Diagnostic, Edit, Label},
    scene::{
        css,
        error::error,
        schema::{self, Predefined, Type, predefined},
        value::Value,
    },
    source::{SourceId, Span},
    suggest,
    syntax::tree::{self, ValueKind},
};

impl<'s> Evaluator<'_, 's> {
    pub(super) fn name(
        &mut self,
        name: &'s str,
        span: Span,
        wanted: Option<Type>,
    ) -> Option<Value> {
        let defined = self.names.defined.get(name);
        // A block that an argument changes is read after all definitions.
        let is_above =
            |defined: &&Defined| span.source != SourceId::File || defined.place.start < span.start;
        if let Some(defined) = defined.filter(is_above) {
            return defined.value;
        }
        match predefined(name) {
            Some(Predefined::Value(value)) => return Some(value),
            Some(Predefined::Function(function)) => {
                let message =
                    format!("`{name}` is a function, and stands here without its arguments");
                self.problems.push(
                    error("function_without_arguments", message)
                        .at(span, "a function")
                        .help(format!("write `{}`", function.call()))
                        .writing(span, [function.call()]),
                );
                return None;
            }
            None if self.names.parts.contains(name) => return None,
            None => {}
        }
        let mut problems = self.names.problems.borrow_mut();
        let mut reported = self.names.reported.borrow_mut();
        let index = *reported.entry(name).or_insert(problems.len());
        match problems.get_mut(index) {
            Some(problem) => and_here(problem, span),
            None => problems.push(match self.names.definition(name) {
                Some(definition) => self.used_before(name, span, definition),
                None => self.unknown_name(name, span, wanted),
            }),
        }
        None
    }

    fn used_before(&self, name: &str, span: Span, definition: Span) -> Diagnostic {
        let line = self.sources.get(definition.source).line(definition.start);
        let used = self.sources.get(span.source).line(span.start);
        let is_own = span.source == SourceId::File && used == line && definition.start < span.start;
        let message = format!("`{name}` is used before it is defined");
        error("used_before_definition", message)
            .at(span, "used here")
            .at(definition, format!("defined here, in line {line}"))
            .help(match span.source {
                SourceId::Set(_) => format!("move `let {name}` before what is set"),
                SourceId::File if is_own => {
                    "a `let` cannot use itself: write a value, or the name of an earlier `let`"
                        .to_owned()
                }
                SourceId::File => format!("move `let {name}` up, before line {used}"),
            })
    }

    fn unknown_name(&self, name: &str, span: Span, wanted: Option<Type>) -> Diagnostic {
        let is_color = matches!(wanted, Some(Type::Color | Type::Colors));
        let near = self.nearest(name, wanted, is_color);
        let problem = match is_color {
            true => error(
                "unknown_color",
                format!("there is no colour named `{name}`"),
            )
            .at(span, "not a colour, and not defined"),
            false => error("unknown_name", format!("there is nothing named `{name}`"))
                .at(span, "not defined"),
        };
        let is_object = self.names.objects.contains(name);
        let help = match &near {
            _ if is_object && !is_color => {
                return problem.help(
                    "an object is no value: define its place with `let`, and use that in both",
                );
            }
            Some(near) => format!("did you mean `{near}`?"),
            None if is_color => "write a CSS colour's name, `#rrggbb` or `rgb(r, g, b)`".to_owned(),
            None => format!("define it before it is used: `let {name} = …`"),
        };
        problem.help(help).writing(span, near)
    }

    /// The nearest name: of the colours where one is wanted, otherwise of what can be computed with.
    fn nearest(&self, name: &str, wanted: Option<Type>, is_color: bool) -> Option<String> {
        // `ff0000`, the code of a colour without its sign.
        let is_digits = name.bytes().all(|byte| byte.is_ascii_hexdigit());
        if is_color && matches!(name.len(), 3 | 6) && is_digits {
            return Some(format!("#{name}"));
        }
        // `olive green`: of two colours the first one.
        if let Some((first, _)) = name.split_once(char::is_whitespace)
            && css::color(first).is_some()
        {
            return Some(first.to_owned());
        }
        let lets = self.names.to_compare()?.iter().copied();
        let colors = css::names().map(|name| name as &str);
        let constants = schema::CONSTANTS.iter().map(|&(name, ..)| name);
        let near = match is_color {
            true => suggest::nearest(name, lets.chain(colors)),
            false => suggest::nearest(name, lets.chain(constants)),
        };
        let near = near.or_else(|| match wanted {
            None => suggest::nearest(name, css::names()),
            Some(_) => None,
        });
        near.map(str::to_owned)
    }

    /// What a value is, and where its name was defined if it is one.
    pub fn described(&self, value: &tree::Value<'s>, kind: Type) -> String {
        let noun = kind.noun();
        let defined = match value.kind {
            ValueKind::Name(name) => self.names.defined.get(name),
            _ => None,
        };
        match defined {
            Some(defined) if defined.from != SourceId::File => {
                format!("{noun} (from {})", self.sources.get(defined.from).name())
            }
            Some(defined) => {
                let line = self.sources.file.line(defined.place.start);
                format!("{noun} (defined in line {line})")
            }
            None => noun.to_owned(),
        }
    }
}

/// Adds another place where the same name is used.
fn and_here(problem: &mut Diagnostic, span: Span) {
    // More places than these would hide the first.
    const MOST: usize = 20;
    if problem.labels.len() <= MOST {
        let message = "and here".to_owned();
        problem.labels.push(Label { span, message });
    }
    for fix in &mut problem.fixes {
        let text = fix.edits.first().map(|edit| edit.text.clone());
        fix.edits.extend(text.map(|text| Edit::new(span, text)));
    }
}
