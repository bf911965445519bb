//! Converts repeated blocks: a block with indices, such as `sphere for i < 8 { … }`, stands for
//! many objects.

use std::collections::BTreeSet;

use super::lowering::Lowering;
use crate::{
    diagnostic::{Edit, Fix, Label},
    numbers,
    scene::error::{error, twice, warning},
    schema::{BlockRow, Type, Value, predefined},
    source::Span,
    syntax::{
        NESTING_LIMIT, shorten,
        tokens::has_name,
        tree::{self, Block, Index, Name, Repetition, ValueKind},
    },
};

/// Maximum number of objects in a scene with repeated blocks, a limit that the language's reference
/// states. A block that would exceed it is reported as an error and builds no objects. Without a
/// limit, a short text could ask for more objects than fit into memory.
const MOST_OBJECTS: usize = 1 << 24;

impl<'s> Lowering<'s> {
    /// Builds the objects of a block with indices, as in `for i < 8, j < 4`: one for each
    /// combination of the indices' values. The last index changes fastest. Stops at the first
    /// combination with a mistake, so that the mistake is reported once.
    pub(super) fn repeated(
        &mut self,
        row: &'static BlockRow,
        block: &Block<'s>,
        repetition: &Repetition<'s>,
    ) {
        if repetition.indices.is_empty() {
            // The indices could not be parsed, so their names are unknown. Uses of the usual names
            // `i`, `j` and `k` are therefore not reported as undefined.
            self.names.know_words("i j k");
            return self.unbuilt(row, block);
        }
        let hidden = repetition.indices.iter();
        let hidden: Vec<_> = hidden
            .filter_map(|index| self.names.hide_below(index.name))
            .collect();
        let indices = repetition.indices.iter().take(NESTING_LIMIT);
        let are_right = indices.fold(true, |so_far, index| {
            self.unused_index(index.name, block);
            self.is_index(index.name) && so_far
        });
        if repetition.indices.len() > NESTING_LIMIT {
            self.too_many(repetition, &format!("more than {NESTING_LIMIT} indices"));
        } else if are_right {
            match self.combinations(block, repetition) {
                Some(combinations) => self.objects_of(row, block, repetition, combinations),
                // The `for` is wrong, but problems of the fields are reported, too.
                None => self.unbuilt_without_indices(row, block, repetition),
            }
        }
        for index in &repetition.indices {
            self.names.forget_index(index.name);
        }
        self.names.restore(hidden);
    }

    /// Returns the combinations of the indices' values, concatenated in order. For `for i < 2, j <
    /// 2`, these are 0 0, 0 1, 1 0 and 1 1. If a count is wrong, reports it and returns `None`.
    ///
    /// Counts that depend on no index are evaluated first. If their product is too large, an error
    /// is thus reported before many combinations are stored.
    fn combinations(&mut self, block: &Block<'s>, repetition: &Repetition<'s>) -> Option<Vec<u32>> {
        let most = MOST_OBJECTS.saturating_sub(self.objects.len());
        if !self.are_counted_before(repetition) {
            return None;
        }
        let mut counts = Vec::new();
        for index in &repetition.indices {
            counts.push(if self.depends(index.count.span, repetition) {
                None
            } else {
                Some(self.count(index).filter(|_| self.is_wanted())?)
            });
        }
        let mut combinations = Vec::new();
        for (level, index) in repetition.indices.iter().enumerate() {
            let behind = counts.iter().skip(level + 1).flatten();
            let behind = behind.fold(1, |product: usize, count| product.saturating_mul(*count));
            let mut longer: Vec<u32> = Vec::new();
            let before = match level {
                0 => vec![&[][..]],
                _ => combinations.chunks_exact(level).collect(),
            };
            for values in before {
                let count = match counts.get(level).copied().flatten() {
                    Some(count) => count,
                    None => {
                        self.set_indices(repetition, values);
                        let before = self.problems.len();
                        let count = self.count(index).filter(|_| self.is_wanted());
                        self.label_with_indices(before, block, repetition, values);
                        count?
                    }
                };
                let so_far = longer.len() / (level + 1);
                if so_far.saturating_add(count).saturating_mul(behind) > most {
                    let found = format!("more than {MOST_OBJECTS} combinations");
                    self.too_many(repetition, &found);
                    return None;
                }
                // If a later index has no values, there are no combinations at all, so nothing is
                // stored.
                if behind > 0 {
                    for last in 0..count as u32 {
                        longer.extend_from_slice(values);
                        longer.push(last);
                    }
                }
            }
            combinations = longer;
        }
        Some(combinations)
    }

    /// Builds the objects of a block, one for each combination of the indices' values.
    fn objects_of(
        &mut self,
        row: &'static BlockRow,
        block: &Block<'s>,
        repetition: &Repetition<'s>,
        combinations: Vec<u32>,
    ) {
        let changes = |value: Span, takes| takes == Type::Color || self.depends(value, repetition);
        let fields = block.fields.iter().filter_map(|field| {
            let place = row
                .fields
                .iter()
                .position(|it| it.name == field.name.text)?;
            let field_row = row.fields.get(place)?;
            changes(field.value.span, field_row.takes).then_some((place, field_row, &field.value))
        });
        let changing: Vec<_> = fields.collect();
        if combinations.is_empty() {
            let before = self.problems.len();
            self.unbuilt_without_indices(row, block, repetition);
            if self.problems.len() == before {
                let span = repetition.span();
                let written = shorten(self.sources.text(span));
                let message = format!("`{written}` makes no objects");
                let problem = warning("no_objects", message).at(span, "no combination is left");
                self.problems
                    .push(problem.help("let each index count up to 1 or more"));
            }
        }
        let mut lowered = None;
        let mut warnings = BTreeSet::new();
        for values in combinations.chunks_exact(repetition.indices.len().max(1)) {
            let before = self.problems.len();
            self.set_indices(repetition, values);
            self.is_odd = Some(values.iter().fold(0, |sum, value| sum ^ value) % 2 == 1);
            let lowered = match &mut lowered {
                None => lowered.insert(self.lowered(row, block)),
                Some(again) => {
                    for &(place, row, value) in &changing {
                        if let Some(Some(given)) = again.given.get_mut(place) {
                            given.value = self.typed(row, value);
                        }
                    }
                    again
                }
            };
            let is_built = self.is_wanted() && self.object(lowered, values);
            if is_built && self.problems.len() > before {
                // If several objects of the block cause the same warning, it is reported once.
                for problem in self.problems.split_off(before) {
                    let place = problem.labels.first().map(|label| label.span);
                    if warnings.insert((problem.code.clone(), place)) {
                        self.problems.push(problem);
                    }
                }
            }
            self.label_with_indices(before, block, repetition, values);
            if !is_built {
                break;
            }
        }
        self.is_odd = None;
    }

    /// Evaluates the fields of a repeated block to report their problems, without building any
    /// object.
    fn unbuilt(&mut self, row: &'static BlockRow, block: &Block<'s>) {
        self.is_odd = Some(false);
        self.lowered(row, block);
        self.is_odd = None;
    }

    /// Evaluates the fields of a block with unknown indices, to report its problems.
    fn unbuilt_without_indices(
        &mut self,
        row: &'static BlockRow,
        block: &Block<'s>,
        repetition: &Repetition<'s>,
    ) {
        for index in &repetition.indices {
            self.names.set_index(index.name, None);
        }
        self.unbuilt(row, block);
    }

    /// Defines the indices of a repeated block, with the numbers `values`.
    fn set_indices(&mut self, repetition: &Repetition<'s>, values: &[u32]) {
        for (index, &value) in repetition.indices.iter().zip(values) {
            let value = Value::Number(f64::from(value));
            self.names.set_index(index.name, Some(value));
        }
    }

    /// Returns whether the text of a value contains the name of an index.
    fn depends(&self, value: Span, repetition: &Repetition<'_>) -> bool {
        let text = self.sources.text(value);
        let mut indices = repetition.indices.iter();
        indices.any(|index| has_name(text, index.name.text))
    }

    /// Returns whether every count uses only earlier indices, as in `for i < 8, j < i`. Otherwise
    /// reports the first count that uses its own index or a later one.
    fn are_counted_before(&mut self, repetition: &Repetition<'s>) -> bool {
        for (at, index) in repetition.indices.iter().enumerate() {
            let mut later = repetition.indices.iter().skip(at);
            let used = later.find_map(|later| Some((later, use_of(&index.count, later.name)?)));
            let Some((other, place)) = used else { continue };
            let name = other.name.text;
            let whole = self.sources.text(other.name.span.to(other.count.span));
            let (message, help) = if other.name.span == index.name.span {
                (
                    format!("`{name}` is used in its own count"),
                    "write a number, or a `let` or an index before it".to_owned(),
                )
            } else {
                (
                    format!("`{name}` counts behind what it is used in"),
                    format!("write `{}` first", shorten(whole)),
                )
            };
            let problem = error("used_before_definition", message).at(place, "used here");
            self.problems
                .push(problem.at(other.name.span, "the index").help(help));
            return false;
        }
        true
    }

    /// Defines an index with an unknown value. If its name is already defined, reports the name and
    /// returns `false`.
    fn is_index(&mut self, name: Name<'s>) -> bool {
        let text = name.text;
        let problem = if let Some(what) = predefined(text) {
            let message = format!("`{text}` is {} already", what.noun());
            error("predefined_name", message).at(name.span, "this name is taken")
        } else if let Some(first) = self.names.place(text) {
            let message = format!("`{text}` is defined twice");
            twice("duplicate_let", message, [first, name.span])
        } else {
            self.names.set_index(name, None);
            return true;
        };
        let help = format!("choose another name for the index, such as `{text}_index`");
        self.problems.push(problem.help(help));
        false
    }

    /// Warns of an index that the block does not use.
    fn unused_index(&mut self, name: Name<'s>, block: &Block<'s>) {
        let behind = Span::new(name.span.source, name.span.end, block.span.end);
        let text = self.sources.text(behind);
        // If the block contains the index's name in another capitalization, that word is reported
        // as an undefined name. It probably means the index, so the index is not reported as
        // unused.
        let mut words = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
        if block.open.is_none()
            || has_name(text, name.text)
            || words.any(|word| word != name.text && word.eq_ignore_ascii_case(name.text))
        {
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

    /// Returns the number of values of an index, i.e. the value of its count. The indices before it
    /// must have values. If the count is not a whole number ≥ 0, reports it and returns `None`.
    fn count(&mut self, index: &Index<'s>) -> Option<usize> {
        let (tree, name) = (&index.count, index.name.text);
        let value =
            self.with_tried_suggestions(tree.span, |it| it.evaluate(tree, Some(Type::Number)))?;
        let found = match value {
            Value::Number(number) if number >= 0.0 && number.fract() == 0.0 => {
                return Some(number as usize);
            }
            Value::Number(number) => numbers::comparable(number, &[number.round()]),
            value => value.kind().noun().to_owned(),
        };
        let message = format!("`{name}` counts up to a whole number, and this is {found}");
        let problem = error("bad_count", message).at(tree.span, "how many there are");
        let written = shorten(self.sources.text(tree.span));
        let help = match value {
            Value::Number(number)
                if number < 0.0 && matches!(tree.kind, ValueKind::Negation { .. }) =>
            {
                format!(
                    "write how many there are, such as `{name} < {}`",
                    (-number).ceil()
                )
            }
            Value::Number(number) if number < 0.0 => {
                format!("write `{name} < max(0, {written})`, if there is none then")
            }
            Value::Number(number) if tree.parts().is_empty() => {
                format!(
                    "write `{name} < {}` or `{name} < {}`",
                    number.floor(),
                    number.ceil()
                )
            }
            Value::Number(_) => format!("make `{written}` a whole number"),
            _ => format!("write a whole number, such as `{name} < 8`"),
        };
        self.problems.push(problem.help(help));
        None
    }

    fn too_many(&mut self, repetition: &Repetition<'s>, found: &str) {
        let problem = error("bad_count", format!("there are {found}"));
        let problem = problem.at(repetition.span(), "too many");
        self.problems
            .push(problem.help("let the indices count less far, or take some of them away"));
    }

    /// Adds a label with the current values of the indices, such as `here i = 3`, to every problem
    /// except the first `before` ones.
    fn label_with_indices(
        &mut self,
        before: usize,
        block: &Block<'s>,
        repetition: &Repetition<'s>,
        values: &[u32],
    ) {
        if values.is_empty() || self.problems.len() == before {
            return;
        }
        let at = repetition.indices.iter().zip(values);
        let at = at.map(|(index, at)| format!("{} = {at}", index.name.text));
        let message = format!("here {}", Vec::from_iter(at).join(", "));
        let fields = block.fields.iter().map(|it| it.value.span);
        let counts = repetition.indices.iter().map(|it| it.count.span);
        let with_index = fields.chain(counts);
        let with_index: Vec<Span> = with_index
            .filter(|it| self.depends(*it, repetition))
            .collect();
        // The first object is the one whose indices are all 0. A mistake that does not depend on
        // the indices is found when this object is built. A label with the indices would then be
        // misleading, so it is added only if the value with the mistake contains the name of an
        // index.
        let is_first = values.iter().all(|&value| value == 0);
        // If an expression depends on an index, a fix must not replace it by the value that it has
        // for one combination.
        let keeps = |edit: &Edit| {
            let mut indices = repetition.indices.iter();
            let written = self.sources.text(edit.span);
            indices.all(|index| {
                let name = index.name.text;
                !has_name(written, name) || has_name(&edit.text, name)
            })
        };
        for problem in self.problems.get_mut(before..).unwrap_or_default() {
            let count = problem.fixes.len();
            let help = problem.help.clone().unwrap_or_default();
            let mut edits = problem.fixes.iter().flat_map(|fix| &fix.edits);
            let is_in_help = edits.any(|edit| !keeps(edit) && help.contains(&*edit.text));
            problem.fixes.retain(|fix| fix.edits.iter().all(keeps));
            if problem.fixes.len() < count && is_in_help {
                let help = "its value differs by index, and an index begins at 0: write a formula that does for all of them";
                problem.help = Some(help.to_owned());
            }
            // In a row of triangles that ends in a point, the vertices of the last triangle are
            // often on one line. The help says how to leave this triangle out.
            if problem.is("on_one_line")
                && let Some(help) = &mut problem.help
            {
                *help += "; if only those at an end of a row shrink to a line, let the index count to one less, as in `j < m - 1`";
            }
            let place = problem.labels.first().map(|label| label.span);
            let depends =
                |it: &Span| place.is_some_and(|at| it.source == at.source && it.to(at) == *it);
            if !is_first || with_index.iter().any(depends) {
                let (span, message) = (repetition.span(), message.clone());
                problem.labels.push(Label { span, message });
            }
        }
    }

    /// Reports the `for` of a block that is not an object, such as the camera.
    pub(super) fn not_repeated(&mut self, row: &BlockRow, repetition: &Repetition<'s>) {
        let (name, span) = (row.name, repetition.span());
        let help = format!("take this away; only objects are repeated: a scene has one `{name}`");
        let fix = Fix::remove("take this away", span, self.sources);
        let problem = error("bad_repetition", format!("{} is not repeated", row.noun));
        self.problems
            .push(problem.at(span, "not here").help(help).fixes([fix]));
    }
}

/// Returns the span of the first use of `name` in a value, if there is one.
fn use_of(value: &tree::Value<'_>, name: Name<'_>) -> Option<Span> {
    match value.kind {
        ValueKind::Name(used) => (used == name.text).then_some(value.span),
        _ => value
            .parts()
            .into_iter()
            .find_map(|part| use_of(part, name)),
    }
}
