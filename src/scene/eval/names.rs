//! The names that are defined at some place, and those that are not.

use std::{
    cell::{Cell, RefCell},
    collections::{HashMap, HashSet, hash_map::Entry},
};

use super::{Evaluator, calls::example};
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
    suggest::{self, Budget},
    syntax::tree::{self, Name, ValueKind},
};

/// The names that are defined at some place.
#[derive(Debug, Default)]
pub struct Names<'s> {
    /// The `let`s so far.
    defined: HashMap<&'s str, Defined>,
    /// The same names, in order.
    order: Vec<&'s str>,
    /// The names of the whole file; none while it is still being read.
    whole: Option<Whole<'s>>,
    /// Whether something was asked about the whole file before it was read.
    asked_early: Cell<bool>,
    /// The comparisons that are left in search of the nearest name.
    budget: Budget,
    /// The names that were reported, with the problem's index: the next use of the same name is another label of it.
    reported: RefCell<HashMap<&'s str, usize>>,
}

/// The names that stand in a file, wherever.
#[derive(Debug, Default)]
struct Whole<'s> {
    /// Every `let`.
    definitions: HashMap<&'s str, Span>,
    /// The names of objects, which are no values.
    objects: HashSet<&'s str>,
}

#[derive(Clone, Copy, Debug)]
struct Defined {
    /// None if it failed.
    value: Option<Value>,
    /// The name in the definition.
    place: Span,
    /// The argument that set it, if one did.
    set: Option<SourceId>,
    /// Whether it is only a part of something that cannot be a name.
    is_part: bool,
}

impl<'s> Names<'s> {
    /// No name is defined yet; these will be.
    pub fn new(
        everywhere: impl IntoIterator<Item = Name<'s>>,
        objects: impl IntoIterator<Item = &'s str>,
    ) -> Self {
        let mut whole = Whole {
            objects: objects.into_iter().collect(),
            definitions: HashMap::new(),
        };
        for name in everywhere {
            whole.definitions.entry(name.text).or_insert(name.span);
        }
        Self {
            whole: Some(whole),
            ..Self::default()
        }
    }

    /// Whether something was asked about the names of the whole file, which are not known: what was made of the answers
    /// does not count.
    pub fn were_asked_early(&self) -> bool {
        self.asked_early.get()
    }

    /// Asks for what stands elsewhere in the file: it has to be read as a whole.
    pub fn ask_for_all(&self) {
        self.whole();
    }

    fn whole(&self) -> Option<&Whole<'s>> {
        if self.whole.is_none() {
            self.asked_early.set(true);
        }
        self.whole.as_ref()
    }

    /// Defines a name; a second time it keeps its value.
    pub fn define(&mut self, name: Name<'s>, value: Option<Value>, set: Option<SourceId>) {
        let defined = Defined {
            value,
            place: name.span,
            set,
            is_part: false,
        };
        match self.defined.entry(name.text) {
            Entry::Vacant(free) => {
                self.order.push(name.text);
                free.insert(defined);
            }
            Entry::Occupied(mut part) if part.get().is_part => *part.get_mut() = defined,
            Entry::Occupied(_) => {}
        }
    }

    /// Takes a part of something that cannot be a name for one that is known, until it is defined.
    pub fn guess(&mut self, name: Name<'s>) {
        if let Entry::Vacant(free) = self.defined.entry(name.text) {
            self.order.push(name.text);
            free.insert(Defined {
                value: None,
                place: name.span,
                set: None,
                is_part: true,
            });
        }
    }

    /// Where a name was defined, if it was.
    pub fn place(&self, name: &str) -> Option<Span> {
        self.defined.get(name).map(|defined| defined.place)
    }

    /// Where a name was defined that is not only a part of something that cannot be one.
    pub fn place_of_whole(&self, name: &str) -> Option<Span> {
        let defined = self.defined.get(name).filter(|defined| !defined.is_part);
        defined.map(|defined| defined.place)
    }

    /// The value of a name that was defined; none if it failed.
    pub fn value(&self, name: &str) -> Option<Value> {
        self.defined.get(name)?.value
    }

    /// The first `let` of the file that defines it.
    fn definition(&self, name: &str) -> Option<Span> {
        self.whole()?.definitions.get(name).copied()
    }

    /// Whether it is the name of an object.
    fn is_object(&self, name: &str) -> bool {
        self.whole()
            .is_some_and(|whole| whole.objects.contains(name))
    }

    /// Whether any `let` of the file defines it.
    pub fn knows(&self, name: &str) -> bool {
        self.definition(name).is_some()
    }

    /// The names that are defined so far, to search for the nearest; none if there was enough of searching.
    fn to_compare(&self) -> Option<&[&'s str]> {
        const PREDEFINED: usize = 200;
        let enough = self.budget.spend(self.order.len() + PREDEFINED);
        enough.then_some(&self.order)
    }

    /// The comparisons that are left in search of the nearest name.
    pub fn budget(&self) -> &Budget {
        &self.budget
    }

    /// Every name that the file defines.
    pub fn all(&self) -> impl Iterator<Item = &'s str> {
        let whole = self.whole().into_iter();
        whole.flat_map(|whole| whole.definitions.keys().copied())
    }
}

/// What a predefined name is, if it is one.
pub fn predefined(name: &str) -> Option<&'static str> {
    if css::color(name).is_some() {
        Some("a colour")
    } else if schema::function(name).is_some() {
        Some("a function")
    } else {
        let constant = schema::CONSTANTS
            .iter()
            .any(|&(constant, _)| constant == name);
        match name {
            "pi" if constant => Some("a number"),
            _ if constant => Some("a unit"),
            _ => None,
        }
    }
}

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
    let functions = schema::FUNCTIONS.iter().map(|function| function.name);
    let near = suggest::nearest(name, lets.chain(constants).chain(functions));
    near.or_else(|| match wanted {
        None => suggest::nearest(name, colors),
        Some(_) => None,
    })
}
