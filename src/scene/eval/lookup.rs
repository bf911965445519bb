//! What a name stands for, and what is wrong with one that stands for nothing.

use super::{Evaluator, calls::example, names::Defined};
use crate::{
    diagnostic::Fix,
    math::Angle,
    scene::{
        css,
        error::{Found, Problem},
        fix,
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
            self.problems.push(
                Problem::FunctionWithoutArguments {
                    name: name.to_owned(),
                    example: example(function),
                    span,
                }
                .with([Fix::write(span, example(function))]),
            );
            return None;
        }
        let mut reported = self.names.reported.borrow_mut();
        if let Some(&index) = reported.get(name) {
            if let Some(problem) = self.problems.get_mut(index) {
                problem.and_here(span);
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

    fn used_before(&self, name: &str, span: Span, definition: Span) -> Found {
        let own = span.source == SourceId::File
            && self.sources.file.line(span.start) == self.sources.file.line(definition.start)
            && definition.start < span.start;
        let help = match span.source {
            SourceId::Set(_) => format!("move `let {name}` before what is set"),
            SourceId::File if own => {
                "a `let` cannot use itself: write a value, or the name of an earlier `let`"
                    .to_owned()
            }
            SourceId::File => {
                let line = self.sources.file.line(span.start);
                format!("move `let {name}` up, before line {line}")
            }
        };
        Problem::UsedBeforeDefinition {
            name: name.to_owned(),
            help,
            line: self.sources.get(definition.source).line(definition.start),
            span,
            definition,
            more: Vec::new(),
        }
        .into()
    }

    fn unknown_name(&self, name: &str, span: Span, wanted: Option<Type>) -> Found {
        let colors = matches!(wanted, Some(Type::Color | Type::Colors));
        let lets = self.names.to_compare();
        let near = lets.and_then(|lets| nearest(name, lets, wanted));
        // `olive green`: of two colours the first one.
        let first = name
            .split_whitespace()
            .next()
            .filter(|first| first.len() < name.len());
        let near = first.filter(|first| css::color(first).is_some()).or(near);
        // `ff0000`, the code of a colour without its sign.
        let code = format!("#{name}");
        let is_code = matches!(name.len(), 3 | 6) && name.bytes().all(|c| c.is_ascii_hexdigit());
        let near = match is_code && colors {
            true => Some(code.as_str()),
            false => near,
        };
        let name = name.to_owned();
        if colors {
            let help = match near {
                Some(near) => format!("did you mean `{near}`?"),
                None => "write a CSS colour's name, `#rrggbb` or `rgb(r, g, b)`".to_owned(),
            };
            return Problem::UnknownColor {
                name,
                help,
                span,
                more: Vec::new(),
            }
            .with(fix::written(span, near));
        }
        let is_object = self.names.is_object(&name);
        let help = match near {
            _ if is_object => {
                "an object is no value: define its place with `let`, and use that in both"
                    .to_owned()
            }
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("define it before it is used: `let {name} = …`"),
        };
        Problem::UnknownName {
            name,
            help,
            span,
            more: Vec::new(),
        }
        .with(fix::written(span, near.filter(|_| !is_object)))
    }

    /// What a value is, and where its name was defined if it is one.
    pub fn described(&self, value: &tree::Value<'s>, kind: Type) -> String {
        let noun = kind.noun();
        let ValueKind::Name(name) = value.kind else {
            return noun.to_owned();
        };
        match self.names.defined.get(name) {
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

/// The nearest name: of the colours where one is wanted, otherwise of what can be computed with.
fn nearest<'n>(name: &str, lets: &[&'n str], wanted: Option<Type>) -> Option<&'n str> {
    let lets = lets.iter().copied();
    let colors = css::names().map(|name| name as &str);
    if matches!(wanted, Some(Type::Color | Type::Colors)) {
        return suggest::nearest(name, lets.chain(colors));
    }
    let constants = schema::CONSTANTS.iter().map(|&(name, _)| name);
    let near = suggest::nearest(name, lets.chain(constants));
    near.or_else(|| match wanted {
        None => suggest::nearest(name, colors),
        Some(_) => None,
    })
}
