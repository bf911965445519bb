//! What the words are that the tree has read.
//!
//! The reader goes by the words before a word, which does not always tell a value from the block behind it: with
//! `let box = 2`, the lines `let c = box` and `box { … }` are a value and a block, or a block and its name. The tree knows; so
//! where a word means something as what the tree takes it for, that is what it is. The reader's answer stays for the rest:
//! of `radius center (0, 1, 0)` the tree makes a call of `center`, and no function has that name.

use super::{Role, Token};
use crate::{
    scene::{SemanticModel, css, predefined, schema},
    source::Span,
    syntax::tree::{Block, Item, Value, ValueKind},
};

/// Gives the words the roles that they have in the tree.
pub fn settle(tokens: &mut [Token], survey: &SemanticModel<'_>) {
    let mut known = Known {
        survey,
        tokens,
        is_method: false,
    };
    for item in &survey.parsed.tree.items {
        match item {
            Item::Definition(definition) => {
                let is_read = !matches!(definition.value.kind, ValueKind::Bad);
                if let Some(name) = definition.name.filter(|_| is_read) {
                    known.is(name.span, Role::Defined);
                }
                known.value(&definition.value);
            }
            Item::Block(block) => known.block(block),
            Item::Bad(_) => {}
        }
    }
}

struct Known<'a, 's> {
    survey: &'a SemanticModel<'s>,
    tokens: &'a mut [Token],
    /// Whether the value is a sampling method.
    is_method: bool,
}

impl<'s> Known<'_, 's> {
    fn is(&mut self, span: Span, role: Role) {
        let index = self.tokens.partition_point(|t| t.span.start < span.start);
        let token = self.tokens.get_mut(index);
        if let Some(token) = token.filter(|token| token.span == span) {
            token.role = role;
        }
    }

    fn block(&mut self, block: &Block<'s>) {
        let Some((kind, row)) = block
            .kind
            .and_then(|kind| Some((kind, schema::block(kind.text)?)))
        else {
            return;
        };
        self.is(kind.span, Role::Kind);
        if let Some(name) = block.name {
            self.is(name.span, Role::ObjectName);
        }
        for field in &block.fields {
            if let Some(known) = row.field(field.name.text) {
                self.is(field.name.span, Role::Field);
                self.is_method = known.takes == schema::Type::Method;
                self.value(&field.value);
                self.is_method = false;
            }
        }
    }

    fn value(&mut self, value: &Value<'s>) {
        match &value.kind {
            ValueKind::Name(_) if self.is_method => self.is(value.span, Role::Method),
            ValueKind::Name(name) if self.is_value(name) => self.is(value.span, Role::Name),
            ValueKind::Call(call) if schema::function(call.function.text).is_some() => {
                self.is(call.function.span, Role::Function);
            }
            _ => {}
        }
        for part in value.parts() {
            self.value(part);
        }
    }

    /// Whether a name is one of a value.
    fn is_value(&self, name: &str) -> bool {
        let is_defined = || self.survey.definition_at(name, usize::MAX).is_some();
        css::color(name).is_some() || predefined(name).is_some() || is_defined()
    }
}
