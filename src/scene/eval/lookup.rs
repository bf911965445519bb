//! Looks up names, and reports undefined ones.

use super::{
    evaluator::{Evaluator, color_code, literal},
    names::{Defined, Reported},
    suggestion::{Meaning, Suggestion},
};
use crate::{
    diagnostic::{Applicability, Diagnostic, Edit, Label, MOST_PROBLEMS},
    scene::error::error,
    schema::{self, Predefined, Type, Value, css, predefined},
    source::{SourceId, Span},
    suggest,
    syntax::tree::{self, ValueKind},
};

impl<'s> Evaluator<'_, 's> {
    /// Returns the value of a name. If the name is undefined, or is the name of a function, reports
    /// it and returns `None`. Also returns `None` if the definition of the name has errors.
    pub(super) fn name(
        &mut self,
        name: &'s str,
        span: Span,
        wanted: Option<Type>,
    ) -> Option<Value> {
        if let Some(Meaning::Value(value)) = self.names.suggestions.meaning(name) {
            return value;
        }
        let defined = self.names.defined.get(name);
        // If there are `--set` arguments, all definitions are evaluated before the blocks. A name
        // may then already have a value although its definition stands below this use. The language
        // does not allow this in a file, so such a definition is ignored.
        let is_above =
            |defined: &&Defined| span.source != SourceId::File || defined.place.start < span.start;
        if let Some(defined) = defined.filter(is_above) {
            return defined.value;
        }
        match predefined(name) {
            Some(Predefined::Value(value)) => return Some(value),
            Some(Predefined::Function(function)) => {
                let call = function.call();
                self.names.suggestions.push(Suggestion {
                    name,
                    means: Meaning::Value(literal(&call, function.gives)),
                    report: span,
                    otherwise: "write a value, or a function with its arguments".to_owned(),
                });
                let message =
                    format!("`{name}` is a function, and stands here without its arguments");
                error("function_without_arguments", message)
                    .at(span, "a function")
                    .help(format!("write `{call}`"))
                    .writing(span, Applicability::Placeholder, [call])
                    .report(self.problems);
                return None;
            }
            None if self.names.parts.contains(name) => return None,
            None if self.names.suggestions.is_trying() => return None,
            None => {}
        }
        self.report(name, span, wanted);
        None
    }

    /// Reports an undefined name. If the name was reported before, adds this use to the report.
    fn report(&self, name: &'s str, span: Span, wanted: Option<Type>) {
        let mut problems = self.names.problems.borrow_mut();
        let mut reported = self.names.reported.borrow_mut();
        let known = reported.get(name).copied();
        let suggested = match known {
            Some(Reported { index, suggested }) => {
                if let Some(problem) = problems.get_mut(index) {
                    and_here(problem, span);
                }
                suggested
            }
            // Problems beyond the maximum are discarded, so the name is not entered in `reported`.
            None if problems.is_full() => None,
            None => {
                let (problem, suggested) = match self.names.definition(name) {
                    Some(definition) => (self.used_before(name, span, definition), None),
                    None => self.unknown_name(name, span, wanted),
                };
                let index = problems.len();
                if index == MOST_PROBLEMS {
                    return problems.push(problem);
                }
                reported.insert(name, Reported { index, suggested });
                problems.push(problem);
                suggested
            }
        };
        let index = known.map_or(problems.len().saturating_sub(1), |known| known.index);
        let first = problems.get(index).and_then(|it| it.labels.first());
        if let (Some(means), Some(label)) = (suggested, first) {
            self.names.suggestions.push(Suggestion {
                name,
                means,
                report: label.span,
                otherwise: no_other(
                    name,
                    problems.get(index).is_some_and(|it| it.is("unknown_color")),
                ),
            });
        }
    }

    /// If a hyphenated colour such as `light-blue` starts at `span`, returns its span and its name
    /// in one word, such as `lightblue`. Otherwise returns `None`.
    fn hyphenated(&self, span: Span) -> Option<(Span, String)> {
        let text = self.sources.get(span.source).text().get(span.start..)?;
        let is_other = |c: char| !c.is_ascii_alphanumeric() && c != '-';
        let end = text.find(is_other).unwrap_or(text.len());
        let joined = text.get(..end)?.replace('-', "");
        let is_one = end > joined.len() && css::color(&joined).is_some();
        let end = span.start + end;
        is_one.then_some((Span { end, ..span }, joined))
    }

    /// Returns the error that a name is used before its definition.
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

    /// Returns the error that a name is undefined. If the error suggests another name, the meaning
    /// of the other name is returned, too.
    fn unknown_name(
        &self,
        name: &str,
        span: Span,
        wanted: Option<Type>,
    ) -> (Diagnostic, Option<Meaning>) {
        let is_color = matches!(wanted, Some(Type::Color | Type::Colors | Type::FaceColors));
        let joined = self.hyphenated(span);
        let place = joined.as_ref().map_or(span, |(whole, _)| *whole);
        let (near, applicability) = match joined {
            Some((_, joined)) => (Some(joined), Some(Applicability::Safe)),
            None => self.nearest(name, wanted, is_color).unzip(),
        };
        let problem = if is_color {
            error(
                "unknown_color",
                format!("there is no colour named `{name}`"),
            )
            .at(span, "not a colour, and not defined")
        } else {
            error("unknown_name", format!("there is nothing named `{name}`"))
                .at(span, "not defined")
        };
        let is_object = self.names.objects.contains(name);
        let help = match &near {
            _ if is_object && !is_color => {
                let problem = problem.help(
                    "an object is no value: define its place with `let`, and use that in both",
                );
                return (problem, None);
            }
            _ if self.names.indices.contains(name) => {
                let help = format!(
                    "`{name}` is an index of another block, and known there alone: write `for {name} < …` in this head, too, or a `let`"
                );
                return (problem.help(help), None);
            }
            Some(near) => format!("did you mean `{near}`?"),
            None => no_other(name, is_color),
        };
        let means = near
            .as_deref()
            .filter(|_| place == span)
            .map(|near| Meaning::Value(self.meaning(near)));
        let applicability = applicability.unwrap_or(Applicability::Unsafe);
        (
            problem.help(help).writing(place, applicability, near),
            means,
        )
    }

    /// Returns the value of a defined name, a predefined name or a colour code. Returns `None` if
    /// its definition has errors.
    pub(super) fn meaning(&self, name: &str) -> Option<Value> {
        if let Some(defined) = self.names.defined.get(name) {
            return defined.value;
        }
        match predefined(name) {
            Some(Predefined::Value(value)) => Some(value),
            _ => color_code(name).map(Value::Color),
        }
    }

    /// Returns the known name that is nearest to the undefined name `name`, and whether it is a
    /// safe replacement. The candidates are the names that the scene defines. If a colour is wanted
    /// (`is_color`), the named colours are candidates, too; otherwise, the constants are. A
    /// candidate whose value does not have the type `wanted` is left out. If no candidate is near
    /// and the wanted type is unknown, all colours are tried.
    fn nearest(
        &self,
        name: &str,
        wanted: Option<Type>,
        is_color: bool,
    ) -> Option<(String, Applicability)> {
        // The name may be a colour code without its `#`, such as `ff0000`.
        let is_digits = name.bytes().all(|byte| byte.is_ascii_hexdigit());
        if is_color && matches!(name.len(), 3 | 6) && is_digits {
            return Some((format!("#{name}"), Applicability::Safe));
        }
        if let "M_PI" | "tau" | "TAU" = name {
            let pi = if name == "M_PI" { "pi" } else { "(2 * pi)" };
            return Some((pi.to_owned(), Applicability::Unsafe));
        }
        // It is uncertain which of two colours is meant, as in `olive green`, so none is suggested.
        if name.contains(' ') && name.split(' ').all(|word| css::color(word).is_some()) {
            return None;
        }
        let is_of_type = |name: &&str| match (self.meaning(name), wanted) {
            (Some(value), Some(wanted)) => value.kind() == wanted,
            _ => true,
        };
        let lets = self.names.to_compare()?.iter().copied();
        let colors = css::names().map(|name| name as &str);
        let constants = schema::CONSTANTS.iter().map(|&(name, ..)| name);
        let near = if is_color {
            suggest::nearest_name(name, lets.clone().chain(colors).filter(is_of_type))
        } else {
            suggest::nearest_name(name, lets.clone().chain(constants).filter(is_of_type))
        };
        let near = near.or_else(|| match wanted {
            None => suggest::nearest_name(name, css::names()),
            Some(_) => None,
        });
        let near = near?;
        // A name such as `lightred` is not a CSS colour. The author probably did not mean the
        // nearest colour either, such as `lightgrey`, so nothing is suggested.
        let is_of_colors = css::color(near).is_some();
        if is_of_colors && near != name.replace('_', "") && is_of_tone(name) {
            return None;
        }
        let all = lets.chain(css::names().map(|name| name as &str));
        let constants = schema::CONSTANTS.iter().map(|&(name, ..)| name);
        let is_only = suggest::is_only_near(name, near, all.chain(constants).filter(is_of_type));
        let is_sure = is_only && (is_color || !is_of_colors || near.eq_ignore_ascii_case(name));
        Some((near.to_owned(), Applicability::safe_if(is_sure)))
    }

    /// Returns the type of a value in words. If the value is a name, the text also says where the
    /// name was defined.
    pub fn described(&self, value: &tree::Value<'s>, kind: Type) -> String {
        let noun = kind.noun();
        let defined = match value.kind {
            ValueKind::Name(name) => self.names.defined.get(name),
            _ => None,
        };
        match defined {
            Some(defined) if defined.from.source != SourceId::File => {
                format!(
                    "{noun} (from {})",
                    self.sources.get(defined.from.source).name()
                )
            }
            Some(defined) => {
                let line = self.sources.file.line(defined.place.start);
                format!("{noun} (defined in line {line})")
            }
            None => noun.to_owned(),
        }
    }
}

/// Returns whether a name is made of a prefix such as `light` and a colour, as in `lightred`. Such
/// a name is not a misspelling of another colour.
fn is_of_tone(name: &str) -> bool {
    let name = name.to_ascii_lowercase().replace('_', "");
    css::names().any(|hue| {
        let tone = name.strip_suffix(hue).unwrap_or_default();
        let is_tone = |other: &str| {
            other
                .strip_prefix(tone)
                .is_some_and(|it| css::color(it).is_some())
        };
        tone == "bright" || (!tone.is_empty() && css::names().any(is_tone))
    })
}

/// Returns the help for an undefined name for which no other name is suggested.
fn no_other(name: &str, is_color: bool) -> String {
    if !is_color {
        format!("define it before it is used: `let {name} = …`")
    } else if name.contains(' ') {
        let pair = name.replace(' ', ", ");
        format!("write one of them, or `({pair})` to take turns in a `for`")
    } else {
        "write a CSS colour's name, `#rrggbb` or `rgb(r, g, b)`".to_owned()
    }
}

/// Adds another use of an undefined name, at `span`, to the report of its first use.
fn and_here(problem: &mut Diagnostic, span: Span) {
    // A value may be evaluated more than once, but each use gets only one label.
    if problem.labels.iter().any(|label| label.span == span) {
        return;
    }
    /// Maximum number of further uses of an undefined name that get a label. Each label shows a
    /// line of the text, so a much larger number would hide the first use. Any similar number would
    /// do.
    const MOST: usize = 20;
    if problem.labels.len() <= MOST {
        let message = "and here".to_owned();
        problem.labels.push(Label { span, message });
    }
    problem.fixes.retain(|fix| fix.edits.len() < MOST_PROBLEMS);
    for fix in &mut problem.fixes {
        let text = fix.edits.first().map(|edit| edit.text.clone());
        fix.edits.extend(text.map(|text| Edit::new(span, text)));
    }
}
