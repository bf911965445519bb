//! The grammar: `grammar/scn.pest`, compiled by pest.

/// pest's parser for the rules of the grammar.
#[derive(pest_derive::Parser)]
#[grammar = "grammar/scn.pest"]
pub struct Grammar;
