//! Blocks with indices, each of which stands for many objects.

use super::{
    block::Block,
    lowering::{Lowering, words},
};
use crate::{
    diagnostic::{Diagnostic, Fix, Label},
    numbers,
    scene::error::{error, twice, warning},
    schema::{self, Type, Value, predefined},
    syntax::tree::{self, Index, Name, Repetition},
};

/// Maximum number of objects of a scene with repetitions.
const MOST_OBJECTS: u32 = 1 << 24;

/// An index at one of its values.
struct Place {
    value: u32,
    count: u32,
}

impl<'s> Lowering<'s> {
    /// Makes an object for each combination of the indices' values, the last index fastest. A
    /// mistake ends that, so that it is reported once.
    pub(super) fn repeated(
        &mut self,
        row: &'static schema::Block,
        block: &tree::Block<'s>,
        repetition: &Repetition<'s>,
    ) {
        let names: Vec<Name<'s>> = repetition.indices.iter().map(|it| it.name).collect();
        let mut known = Vec::new();
        for (at, &name) in names.iter().enumerate() {
            if self.is_index(name, names.get(..at).unwrap_or_default()) {
                known.push(name);
                self.unused_index(name, block);
            }
        }
        if known.len() == names.len() {
            self.combinations(row, block, repetition);
        } else {
            // What uses them is silent.
            known
                .iter()
                .for_each(|name| self.names.set_index(*name, None));
            self.lowered(row, block);
        }
        known
            .iter()
            .for_each(|name| self.names.forget_index(name.text));
        self.is_odd = None;
    }

    fn combinations(
        &mut self,
        row: &'static schema::Block,
        block: &tree::Block<'s>,
        repetition: &Repetition<'s>,
    ) {
        let indices = &repetition.indices;
        let mut places: Vec<Place> = Vec::new();
        let mut lowered: Option<Block<'s>> = None;
        let mut has_warned = false;
        let before = self.objects.len();
        let mut left = MOST_OBJECTS.saturating_sub(before as u32);
        while self.is_wanted() {
            // Those behind the one that was counted begin anew.
            while let Some(index) = indices.get(places.len())
                && places.last().is_none_or(|place| place.value < place.count)
            {
                let told = self.problems.len();
                self.set(index, 0);
                let Some(count) = self.count(index) else {
                    return self.here(told, repetition, &places);
                };
                places.push(Place { value: 0, count });
            }
            let Some(fewer) = left.checked_sub(1) else {
                self.objects.truncate(before);
                return self.too_many(repetition);
            };
            left = fewer;
            if places.len() == indices.len() && places.iter().all(|it| it.value < it.count) {
                let told = self.problems.len();
                let values: Vec<u32> = places.iter().map(|place| place.value).collect();
                self.is_odd = Some(values.iter().fold(0, |sum, value| sum ^ value) % 2 == 1);
                let again = match &mut lowered {
                    Some(again) => {
                        self.again(block, repetition, again);
                        again
                    }
                    None => lowered.insert(self.lowered(row, block)),
                };
                let is_built = self.object(again, &values);
                if is_built && has_warned {
                    self.problems.truncate(told);
                }
                has_warned |= self.problems.len() > told;
                self.here(told, repetition, &places);
                if !is_built {
                    return;
                }
            }
            // The next combination.
            while let Some(place) = places.last_mut() {
                place.value += 1;
                if place.value < place.count {
                    break;
                }
                places.pop();
            }
            match (
                places.last(),
                places.len().checked_sub(1).and_then(|at| indices.get(at)),
            ) {
                (Some(&Place { value, .. }), Some(index)) => self.set(index, value),
                _ => return,
            }
        }
    }

    /// Evaluates the fields again that depend on the indices.
    fn again(
        &mut self,
        block: &tree::Block<'s>,
        repetition: &Repetition<'s>,
        lowered: &mut Block<'s>,
    ) {
        for field in &block.fields {
            let rows = lowered.row.fields.iter().zip(&mut lowered.given);
            let mut rows = rows.filter(|(row, _)| row.name == field.name.text);
            if let Some((row, Some(given))) = rows.next()
                && (row.takes == Type::Color || is_used(&field.value, repetition))
            {
                given.value = self.typed(row, &field.value);
            }
        }
    }

    fn set(&mut self, index: &Index<'s>, value: u32) {
        let value = Value::Number(f64::from(value));
        self.names.set_index(index.name, Some(value));
    }

    /// Reports an index that cannot have its name.
    fn is_index(&mut self, name: Name<'s>, others: &[Name<'s>]) -> bool {
        let text = name.text;
        let mut earlier = others.iter().filter(|other| other.text == text);
        let first = earlier.next().map(|other| other.span);
        let problem = if let Some(what) = predefined(text) {
            let message = format!("`{text}` is {} already", what.noun());
            error("predefined_name", message).at(name.span, "this name is taken")
        } else if let Some(first) = first.or_else(|| self.names.place(text)) {
            let message = format!("`{text}` is defined twice");
            twice("duplicate_let", message, [first, name.span])
        } else {
            return true;
        };
        let help = format!("choose another name for the index, such as `{text}_index`");
        self.problems.push(problem.help(help));
        false
    }

    fn unused_index(&mut self, name: Name<'s>, block: &tree::Block<'s>) {
        let text = self.sources.text(name.span.to(block.span));
        if words(text).filter(|word| *word == name.text).count() > 1 {
            return;
        }
        let message = format!("the index `{}` is not used", name.text);
        let help = format!(
            "use it in a value, such as `center ({}, 1, 0)`: without it the objects lie in one place",
            name.text
        );
        let problem = warning("unused_index", message);
        self.problems
            .push(problem.at(name.span, "no value depends on it").help(help));
    }

    /// How many values an index has.
    fn count(&mut self, index: &Index<'s>) -> Option<u32> {
        let (tree, name) = (&index.count, index.name.text);
        let value = self.trying(tree.span, |it| it.evaluate(tree, Some(Type::Number)))?;
        let found = match value {
            Value::Number(number) if number >= 0.0 && number.fract() == 0.0 => {
                return Some(number.min(f64::from(MOST_OBJECTS) + 1.0) as u32);
            }
            Value::Number(number) => numbers::beside(number, &[number.round()]),
            _ => value.kind().noun().to_owned(),
        };
        let message = format!("`{name}` counts up to a whole number, and this is {found}");
        let problem = error("bad_count", message).at(tree.span, "how many there are");
        let help = format!("write a whole number that is not negative, such as `{name} < 8`");
        self.problems.push(problem.help(help));
        None
    }

    fn too_many(&mut self, repetition: &Repetition<'s>) {
        let message = format!("these are more than {MOST_OBJECTS} objects");
        let problem = error("too_many_objects", message).at(repetition.span, "too many");
        self.problems
            .push(problem.help("let the indices count less far"));
    }

    /// Says of which combination the problems are that were found since so many.
    fn here(&mut self, told: usize, repetition: &Repetition<'s>, places: &[Place]) {
        if places.is_empty() {
            return;
        }
        let at = repetition.indices.iter().zip(places);
        let at: Vec<_> = at
            .map(|(index, at)| format!("{} = {}", index.name.text, at.value))
            .collect();
        let message = format!("here {}", at.join(", "));
        for problem in self.problems.get_mut(told..).unwrap_or_default() {
            let span = repetition.span;
            let message = message.clone();
            problem.labels.push(Label { span, message });
        }
    }

    /// Reports a repetition of what is no object.
    pub(super) fn not_repeated(&mut self, row: &schema::Block, repetition: &Repetition<'s>) {
        let message = format!("{} is not repeated", row.noun);
        let help = format!(
            "take this away; only objects are repeated, for a scene has one `{}`",
            row.name
        );
        let fix = Fix::remove("take this away", repetition.span, self.sources);
        let problem: Diagnostic = error("unexpected_repetition", message);
        let problem = problem.at(repetition.span, "not here").help(help);
        self.problems.push(problem.fixes([fix]));
    }
}

/// Whether a value depends on one of the indices.
fn is_used(value: &tree::Value<'_>, repetition: &Repetition<'_>) -> bool {
    let mut indices = repetition.indices.iter();
    indices.any(|index| value.mentions(index.name.text))
}
