//! Fields that a block needs and is not given.

use super::{
    Block, Lowering,
    field_fixes::{examples, quoted},
};
use crate::{
    scene::{error::error, schema::Preset},
    suggest,
};

impl<'s> Lowering<'s> {
    pub(super) fn missing_fields(&mut self, block: &Block<'s>) {
        if block.unfinished {
            return;
        }
        let has = |name: &&str| block.given(name).is_some() || block.meant.contains(name);
        let rows = block.row.fields.iter();
        let required = rows.filter(|row| row.preset == Preset::Required && !has(&row.name));
        let mut needed: Vec<&'static str> = required.map(|row| row.name).collect();
        let mut missing: Vec<String> = needed.iter().map(|name| format!("`{name}`")).collect();
        // The other ways to give what is missing.
        let mut others: Vec<Vec<&'static str>> = Vec::new();
        let mut half = None;
        for choice in block.row.choices {
            let needs = |way: &&[&'static str]| -> Vec<&'static str> {
                let alternative = |name: &&str| {
                    let row = block.row.field(name);
                    row.is_some_and(|row| row.preset == Preset::Alternative) && !has(name)
                };
                way.iter()
                    .copied()
                    .filter(|name| alternative(name))
                    .collect()
            };
            let taken: Vec<_> = choice
                .ways
                .iter()
                .filter(|way| way.iter().any(has))
                .collect();
            match taken.as_slice() {
                // Without any, one is needed unless the defaults of one are enough.
                [] => {
                    let ways: Vec<_> = choice.ways.iter().map(needs).collect();
                    if ways.iter().any(Vec::is_empty) {
                        continue;
                    }
                    missing.push(either(&ways));
                    let mut ways = ways.into_iter();
                    let kept = needed.clone();
                    needed.extend(ways.next().unwrap_or_default());
                    others = ways.map(|way| [kept.clone(), way].concat()).collect();
                }
                [way] => {
                    let names = needs(way);
                    let given = way.iter().find_map(|name| block.given(name));
                    if let ([_, ..], Some(given)) = (names.as_slice(), given) {
                        half = Some(given.name);
                        let beside = self.sources.text(given.name);
                        missing.push(format!("{} beside its `{beside}`", quoted(&names)));
                    } else {
                        missing.extend(names.iter().map(|name| format!("`{name}`")));
                    }
                    needed.extend(names);
                }
                // They exclude each other, which is reported.
                _ => {}
            }
        }
        if missing.is_empty() {
            return;
        }
        let all = suggest::list(missing.iter().map(String::as_str));
        let ways: Vec<Vec<&str>> = [needed.clone()].into_iter().chain(others).collect();
        let fixes = ways.iter().filter_map(|names| {
            let title = format!("add {}", quoted(names));
            self.add_fields(block, title, &examples(block, names))
        });
        let fixes: Vec<_> = fixes.collect();
        let message = format!("{} needs {all}", block.row.noun);
        let label = match (missing.len(), needed.len()) {
            (1, 1) => "it is not given",
            _ => "they are not given",
        };
        let mut problem = error("missing_field", message)
            .at(block.keyword, label)
            .help(format!("write `{}`", examples(block, &needed).join("  ")))
            .fixes(fixes);
        if let Some(half) = half {
            problem = problem.at(half, "not enough by itself");
        }
        self.problems.push(problem);
    }
}

/// The ways to give what is missing: `center`, or `min` and `max`.
fn either(ways: &[Vec<&str>]) -> String {
    let separator = match ways.iter().all(|way| way.len() == 1) {
        true => " or ",
        false => ", or ",
    };
    let ways: Vec<String> = ways.iter().map(|way| quoted(way)).collect();
    ways.join(separator)
}
