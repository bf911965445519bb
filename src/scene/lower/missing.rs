//! Reports the fields that a block needs but does not have.

use super::{
    fixes::{examples, quoted},
    lowering::Lowering,
};
use crate::{
    scene::{error::error, lowered_block::LoweredBlock},
    schema::Preset,
};

impl<'s> Lowering<'s> {
    /// Reports the fields that a block needs but does not have, unless a field may have been lost
    /// by a syntax error.
    pub(super) fn missing_fields(&mut self, block: &LoweredBlock<'s>) {
        if block.unfinished {
            return;
        }
        let row = block.row;
        let has = |name: &&str| block.given_by_name(name).is_some() || block.meant.contains(name);
        let is_missing = |name: &&str, preset| {
            row.field(name).is_some_and(|field| field.preset == preset) && !has(name)
        };
        let required = row.field_names();
        let required = required.filter(|name| is_missing(name, Preset::Required));
        // Each element is one possible set of fields that would complete the block. The first set
        // is the usual one.
        let mut ways: Vec<Vec<&'static str>> = vec![required.collect()];
        for choice in row.choices {
            let is_taken = |way: &&&[&str]| way.iter().any(has);
            let taken = choice.ways.iter().filter(is_taken).count();
            // If the block uses fields of two alternatives, their conflict is reported elsewhere,
            // so none of their fields is reported as missing.
            let open = choice
                .ways
                .iter()
                .filter(|way| taken == 0 || (taken == 1 && is_taken(way)));
            let needs = open.map(|way| {
                let names = way.iter().copied();
                let needed = names.filter(|name| is_missing(name, Preset::Alternative));
                needed.collect()
            });
            let needs: Vec<Vec<&str>> = needs.collect();
            if !needs.iter().any(Vec::is_empty) && !needs.is_empty() {
                let kept = ways.iter();
                let longer =
                    kept.flat_map(|kept| needs.iter().map(|need| [&kept[..], need].concat()));
                ways = longer.collect();
            }
        }
        let Some(first) = ways.first().filter(|first| !first.is_empty()) else {
            return;
        };
        let all: Vec<String> = ways.iter().map(|way| quoted(way)).collect();
        let is_short = ways.iter().all(|way| way.len() == 1);
        let or = if is_short { " or " } else { ", or " };
        let fixes = ways.iter().filter_map(|names| {
            let title = format!("add {}", quoted(names));
            self.add_fields(block, title, &examples(block, names))
        });
        error(
            "missing_field",
            format!("{} needs {}", row.noun, all.join(or)),
        )
        .at(block.keyword, "not complete")
        .help(format!("write `{}`", examples(block, first).join("  ")))
        .fixes(fixes)
        .report(&mut self.problems);
    }
}
