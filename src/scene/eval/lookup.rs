//! What a name stands for, and what is wrong with one that stands for nothing.

use super::{Evaluator, calls::example, names::Defined};
use crate::{
    diagnostic::{Diagnostic, Edit, Label},
    math::Angle,
    scene::{
        css,
        error::error,
        schema::{self, Type},
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
        if let Some(defined) = self.names.defined.get(name) {
            return defined.value;
        }
        if let Some(color) = css::color(name) {
            return Some(Value::Color(color));
        }
        match name {
            "pi" => return Some(Value::Number(std::f64::consts::PI)),
            "deg" => return Some(Value::Angle(Angle::from_degrees(1.0))),
            "rad" => return Some(Value::Angle(Angle::from_radians(1.0))),
            _ => {}
        }
        if let Some(function) = schema::function(name) {
            let message = format!("`{name}` is a function, and stands here without its arguments");
            self.problems.push(
                error("function_without_arguments", message)
                    .at(span, "a function")
                    .help(format!("write `{}`", example(function)))
                    .writing(span, [example(function)]),
            );
            return None;
        }
        if self.names.parts.contains(name) {
            return None;
        }
        let mut reported = self.names.reported.borrow_mut();
        if let Some(&index) = reported.get(name) {
            if let Some(problem) = self.problems.get_mut(index) {
                and_here(problem, span);
            }
            return None;
        }
        reported.insert(name, self.problems.len());
        drop(reported);
        let problem = match self.names.definition(name) {
            Some(definition) => self.used_before(name, span, definition),
            None => self.unknown_name(name, span, wanted),
        };
        self.problems.push(problem);
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
        let near = self.nearest(name, wanted);
        let did_you_mean = near.as_ref().map(|near| format!("did you mean `{near}`?"));
        if matches!(wanted, Some(Type::Color | Type::Colors)) {
            let help = "write a CSS colour's name, `#rrggbb` or `rgb(r, g, b)`".to_owned();
            return error(
                "unknown_color",
                format!("there is no colour named `{name}`"),
            )
            .at(span, "not a colour, and not defined")
            .help(did_you_mean.unwrap_or(help))
            .writing(span, near);
        }
        let problem = error("unknown_name", format!("there is nothing named `{name}`"));
        let problem = problem.at(span, "not defined");
        if self.names.objects.contains(name) {
            return problem
                .help("an object is no value: define its place with `let`, and use that in both");
        }
        let help = format!("define it before it is used: `let {name} = …`");
        let help = did_you_mean.unwrap_or(help);
        problem.help(help).writing(span, near)
    }

    /// The nearest name: of the colours where one is wanted, otherwise of what can be computed with.
    fn nearest(&self, name: &str, wanted: Option<Type>) -> Option<String> {
        let is_color = matches!(wanted, Some(Type::Color | Type::Colors));
        // `ff0000`, the code of a colour without its sign.
        if is_color
            && matches!(name.len(), 3 | 6)
            && name.bytes().all(|byte| byte.is_ascii_hexdigit())
        {
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
        let near = match is_color {
            true => suggest::nearest(name, lets.chain(colors)),
            false => {
                let constants = schema::CONSTANTS.iter().map(|&(name, _)| name);
                let near = suggest::nearest(name, lets.chain(constants));
                near.or_else(|| match wanted {
                    None => suggest::nearest(name, colors),
                    Some(_) => None,
                })
            }
        };
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
            Some(Defined { set: Some(set), .. }) => {
                format!("{noun} (from {})", self.sources.get(*set).name())
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
    if problem.labels.len() > MOST {
        return;
    }
    let message = "and here".to_owned();
    problem.labels.push(Label { span, message });
    for fix in &mut problem.fixes {
        let text = fix.edits.first().map(|edit| edit.text.clone());
        fix.edits.extend(text.map(|text| Edit::new(span, text)));
        fix.edits.sort_by_key(|edit| edit.span);
    }
}
