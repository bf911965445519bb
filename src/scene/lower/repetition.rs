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
    source::Span,
    syntax::{
        NESTING_LIMIT,
        tree::{self, Index, Name, Repetition},
    },
};

/// Maximum number of objects of a scene with repetitions.
const MOST_OBJECTS: u32 = 1 << 24;

/// A block with its indices.
#[derive(Clone, Copy)]
struct Repeated<'a, 's> {
    block: &'a tree::Block<'s>,
    repetition: &'a Repetition<'s>,
}

impl<'s> Repeated<'_, 's> {
    /// Whether a value depends on one of the indices.
    fn uses(self, value: &tree::Value<'s>) -> bool {
        let mut indices = self.repetition.indices.iter();
        indices.any(|index| value.mentions(index.name.text))
    }

    /// Whether a place lies in a value that depends on one of the indices.
    fn has_use_at(self, place: Span) -> bool {
        let counts = self.repetition.indices.iter().map(|index| &index.count);
        let mut values = self.block.fields.iter().map(|it| &it.value).chain(counts);
        values.any(|it| it.span.start <= place.start && place.end <= it.span.end && self.uses(it))
    }
}

/// A way through the combinations of some indices' values.
struct Walk<'a, 's> {
    of: Repeated<'a, 's>,
    indices: &'a [Index<'s>],
    /// The values of the first of them.
    values: Vec<u32>,
    /// How many values may still be taken.
    left: u32,
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
        if repetition.indices.len() > NESTING_LIMIT {
            let message = format!("these are more than {NESTING_LIMIT} indices");
            let problem = error("bad_repetition", message).at(repetition.span, "too many");
            return self
                .problems
                .push(problem.help("one or two, as a rule, are enough"));
        }
        let names: Vec<Name<'s>> = repetition.indices.iter().map(|it| it.name).collect();
        let mut known = Vec::new();
        for (at, &name) in names.iter().enumerate() {
            if self.is_index(name, names.get(..at).unwrap_or_default()) {
                known.push(name);
                self.unused_index(name, block);
            }
        }
        if known.len() == names.len() {
            self.combinations(row, Repeated { block, repetition });
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

    fn combinations(&mut self, row: &'static schema::Block, of: Repeated<'_, 's>) {
        let Some((last, others)) = of.repetition.indices.split_last() else {
            return;
        };
        // None is made before it is known how many there are.
        let mut left = MOST_OBJECTS.saturating_sub(self.objects.len() as u32);
        let mut is_counted = |this: &mut Self, values: &[u32]| {
            let count = this.count(last, of, values);
            let fewer = count.map(|count| left.checked_sub(count));
            if fewer == Some(None) {
                this.too_many(of.repetition);
            }
            left = fewer.flatten().unwrap_or_default();
            fewer.flatten().is_some()
        };
        let mut walk = Walk {
            of,
            indices: others,
            values: Vec::new(),
            left: MOST_OBJECTS,
        };
        if !self.walk(&mut walk, &mut is_counted) {
            return;
        }
        let mut lowered: Option<Block<'s>> = None;
        let mut has_warned = false;
        let mut is_made = |this: &mut Self, values: &[u32]| {
            let told = this.problems.len();
            this.is_odd = Some(values.iter().fold(0, |sum, value| sum ^ value) % 2 == 1);
            match &mut lowered {
                Some(again) => this.again(of, again),
                None => lowered = Some(this.lowered(row, of.block)),
            }
            let is_built = lowered.as_ref().is_some_and(|it| this.object(it, values));
            if is_built && has_warned {
                this.problems.truncate(told);
            }
            has_warned |= this.problems.len() > told;
            this.here(told, of, values);
            is_built
        };
        let mut walk = Walk {
            of,
            indices: &of.repetition.indices,
            values: Vec::new(),
            left: 2 * MOST_OBJECTS,
        };
        self.walk(&mut walk, &mut is_made);
    }

    /// Goes through combinations of values, the last index fastest, until `each` answers that it
    /// wants no more; answers whether it wanted all.
    fn walk(
        &mut self,
        walk: &mut Walk<'_, 's>,
        each: &mut dyn FnMut(&mut Self, &[u32]) -> bool,
    ) -> bool {
        let Some(index) = walk.indices.get(walk.values.len()) else {
            return each(self, &walk.values);
        };
        let Some(count) = self.count(index, walk.of, &walk.values) else {
            return false;
        };
        for value in 0..count {
            let Some(left) = walk.left.checked_sub(1) else {
                self.too_many(walk.of.repetition);
                return false;
            };
            walk.left = left;
            let number = Value::Number(f64::from(value));
            self.names.set_index(index.name, Some(number));
            walk.values.push(value);
            let goes_on = self.is_wanted() && self.walk(walk, each);
            walk.values.pop();
            if !goes_on {
                return false;
            }
        }
        true
    }

    /// Evaluates the fields again that depend on the indices.
    fn again(&mut self, of: Repeated<'_, 's>, lowered: &mut Block<'s>) {
        for field in &of.block.fields {
            let rows = lowered.row.fields.iter().zip(&mut lowered.given);
            let mut rows = rows.filter(|(row, _)| row.name == field.name.text);
            if let Some((row, Some(given))) = rows.next()
                && (row.takes == Type::Color || of.uses(&field.value))
            {
                given.value = self.typed(row, &field.value);
            }
        }
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

    /// How many values an index has at some values of those before it.
    fn count(&mut self, index: &Index<'s>, of: Repeated<'_, 's>, values: &[u32]) -> Option<u32> {
        let (tree, name) = (&index.count, index.name.text);
        let told = self.problems.len();
        let value = self.trying(tree.span, |it| it.evaluate(tree, Some(Type::Number)));
        let found = match value {
            None => {
                self.here(told, of, values);
                return None;
            }
            Some(Value::Number(number)) if number >= 0.0 && number.fract() == 0.0 => {
                return Some(number.min(f64::from(MOST_OBJECTS) + 1.0) as u32);
            }
            Some(Value::Number(number)) => numbers::beside(number, &[number.round()]),
            Some(value) => value.kind().noun().to_owned(),
        };
        let message = format!("`{name}` counts up to a whole number, and this is {found}");
        let problem = error("bad_count", message).at(tree.span, "how many there are");
        let help = format!("write a whole number that is not negative, such as `{name} < 8`");
        self.problems.push(problem.help(help));
        self.here(told, of, values);
        None
    }

    fn too_many(&mut self, repetition: &Repetition<'s>) {
        let message = format!("the indices have more than {MOST_OBJECTS} combinations");
        let problem = error("bad_count", message).at(repetition.span, "too many");
        self.problems
            .push(problem.help("let the indices count less far"));
    }

    /// Says of which combination the problems are that were found since so many.
    fn here(&mut self, told: usize, of: Repeated<'_, 's>, values: &[u32]) {
        let at = of.repetition.indices.iter().zip(values);
        let at: Vec<_> = at
            .map(|(index, at)| format!("{} = {at}", index.name.text))
            .collect();
        // What is wrong with the first one is often wrong with all.
        let is_first = values.iter().all(|&value| value == 0);
        let is_of_index = |problem: &Diagnostic| {
            let label = problem.labels.first();
            label.is_some_and(|label| !is_first || of.has_use_at(label.span))
        };
        let new = self.problems.get_mut(told..).unwrap_or_default().iter_mut();
        for problem in new.filter(|problem| !at.is_empty() && is_of_index(problem)) {
            let (span, message) = (of.repetition.span, format!("here {}", at.join(", ")));
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
        let problem: Diagnostic = error("bad_repetition", message);
        let problem = problem.at(repetition.span, "not here").help(help);
        self.problems.push(problem.fixes([fix]));
    }
}
