//! Tests that the semantic tokens, by which editors colour words, agree with the syntax tree.

use std::{collections::BTreeMap, fs};

use pinhole::{
    editor::{SemanticKind, semantic_tokens},
    schema::{self, Predefined},
    source::{SourceId, Span},
    syntax::{
        self,
        tree::{Item, Value, ValueKind},
    },
};

use super::{about_text, sources};
use crate::scenes::scenes;

/// Returns the kind of each word according to the syntax tree, or `None` if the text has syntax
/// errors.
fn tree_kinds(text: &str) -> Option<BTreeMap<Span, SemanticKind>> {
    let sources = sources(text);
    let parsed = syntax::parse(&sources.file, SourceId::File);
    if !parsed.problems.is_empty() {
        return None;
    }
    let mut words: BTreeMap<Span, SemanticKind> = BTreeMap::new();
    for item in &parsed.tree.items {
        match item {
            Item::Definition(definition) => {
                words.insert(definition.keyword, SemanticKind::Keyword);
                let name = definition.name;
                words.extend(name.map(|name| (name.span, SemanticKind::Variable)));
                collect_values(&definition.value, false, &mut words);
            }
            Item::Block(block) => {
                words.extend(block.kind.map(|kind| (kind.span, SemanticKind::Keyword)));
                words.extend(block.name.map(|name| (name.span, SemanticKind::Class)));
                for field in &block.fields {
                    words.insert(field.name.span, SemanticKind::Property);
                    collect_values(&field.value, field.name.text == "method", &mut words);
                }
            }
            Item::Bad(_) => return None,
        }
    }
    Some(words)
}

fn collect_values(value: &Value<'_>, is_method: bool, words: &mut BTreeMap<Span, SemanticKind>) {
    match &value.kind {
        // A name that contains a hyphen or a space is a mistake and has no kind.
        ValueKind::Name(name) if name.contains(['-', ' ']) => {}
        ValueKind::Name(name) => {
            let kind = match schema::predefined(name) {
                _ if is_method => SemanticKind::EnumMember,
                Some(Predefined::Function(_)) => SemanticKind::Function,
                Some(Predefined::Value(_)) => SemanticKind::EnumMember,
                None => SemanticKind::Variable,
            };
            words.insert(value.span, kind);
        }
        ValueKind::Call(call) if schema::function(call.function.text).is_some() => {
            words.insert(call.function.span, SemanticKind::Function);
        }
        ValueKind::Number(_) | ValueKind::Angle { .. } | ValueKind::ColorCode(_) => {
            words.insert(value.span, SemanticKind::Number);
        }
        _ => {}
    }
    for part in value.parts() {
        collect_values(part, is_method, words);
    }
}

/// The editor derives each semantic token's kind from the tokens around it. In every text without
/// syntax errors, it must be the kind that follows from the syntax tree.
#[test]
fn semantic_tokens_agree_with_the_syntax_tree() {
    let mut files = 0;
    let folders = ["examples", "tests/diagnostics", "tests/syntax/ok"];
    for path in folders.into_iter().flat_map(scenes) {
        // A file that is not UTF-8 is read as an empty text and therefore skipped.
        let text = fs::read_to_string(&path).unwrap_or_default();
        let Some(words) = tree_kinds(&text).filter(|words| !words.is_empty()) else {
            continue;
        };
        files += 1;
        about_text(&text, |analysis| {
            let tokens = semantic_tokens(analysis).into_iter();
            let tokens: BTreeMap<_, _> = tokens.map(|token| (token.span, token.kind)).collect();
            for (span, kind) in words {
                let (found, word) = (tokens.get(&span), analysis.slice(span));
                assert_eq!(found, Some(&kind), "{} {word:?}", path.display());
            }
        })
    }
    assert!(files > 40, "{files}");
}
