//! The grammar, `grammar/scn.pest`, compiled by pest, and the precedence of its operators.

use std::sync::LazyLock;

use pest::pratt_parser::{Assoc, Op, PrattParser};

/// pest's parser for the rules of the grammar.
#[derive(pest_derive::Parser)]
#[grammar = "grammar/scn.pest"]
pub struct Grammar;

/// The operators, the loosest first.
pub static PRECEDENCE: LazyLock<PrattParser<Rule>> = LazyLock::new(|| {
    PrattParser::new()
        .op(Op::infix(Rule::sum, Assoc::Left))
        .op(Op::infix(Rule::product, Assoc::Left))
        .op(Op::prefix(Rule::sign))
});
