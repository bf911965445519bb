//! Reads plain blocks without the generated parser, which is many times slower.
//!
//! In: the tokens of a text from an offset on. Out: the node of the block at this offset, if the
//! block is plain. A block is plain if its values are numbers, names, colours, and lists and calls
//! of these, each with at most one minus. The node is the same as the one that `parser` makes with
//! pest, the generated parser. `None` means that pest must read the item, because it has operators
//! or indices, has a mistake, or was probably meant otherwise.
//!
//! Programs write most scenes with many objects, and these scenes are nearly always plain.

use memchr::memmem;

use super::{
    tokens::{Lexer, Token, TokenKind, is_color_code, numeric_part},
    tree::{Block, Element, Field, Item, Name, Value, ValueKind, call, group, negation, number},
    vocabulary::Vocabulary,
};
use crate::source::{SourceId, Span};

/// Maximum depth of nested parentheses in a plain value. A deeper value is left to pest, because
/// the reader needs stack for each level. Few values are deeper.
const NESTING: usize = 4;

/// Reads the text from the offset `from` on if it consists of plain blocks, and returns `None`
/// otherwise. Also returns `None` if the text contains a `/*`, a carriage return or `--`, because
/// [`Scan`](super::scan::Scan) or error recovery may find a mistake there.
pub fn blocks<'s>(
    text: &'s str,
    id: SourceId,
    words: &Vocabulary<'s>,
    from: usize,
) -> Option<Vec<Item<'s>>> {
    let rest = text.get(from..)?;
    if ["/*", "\r", "--"]
        .into_iter()
        .any(|it| memmem::find(rest.as_bytes(), it.as_bytes()).is_some())
    {
        return None;
    }
    let mut lexer = Lexer::new(text, from);
    let first = lexer.token_after_comments();
    let mut reader = PlainReader::new(text, id, words, (lexer, first));
    let mut items = Vec::new();
    while reader.next.kind != TokenKind::End {
        let block = reader.block()?;
        // In `pi sphere {`, `pi` may be the end of the definition before the block.
        if block.name.is_some_and(|name| words.is_kind(name.text)) {
            return None;
        }
        items.push(Item::Block(block));
    }
    Some(items)
}

/// Reader of plain blocks.
#[derive(Debug)]
pub struct PlainReader<'w, 's> {
    text: &'s str,
    id: SourceId,
    words: &'w Vocabulary<'s>,
    lexer: Lexer<'s>,
    /// The token that is read next. It is never a comment.
    next: Token,
}

impl<'w, 's> PlainReader<'w, 's> {
    /// Makes a reader of `text` that starts at the token `next`. `next` must be the token that
    /// `lexer` returned last.
    pub fn new(
        text: &'s str,
        id: SourceId,
        words: &'w Vocabulary<'s>,
        (lexer, next): (Lexer<'s>, Token),
    ) -> Self {
        Self {
            text,
            id,
            words,
            lexer,
            next,
        }
    }

    /// Reads a block: `KIND NAME? { FIELD VALUE … }`.
    pub fn block(&mut self) -> Option<Block<'s>> {
        let kind = self.name()?;
        let name = match self.next.kind {
            TokenKind::Name => Some(self.name()?),
            _ => None,
        };
        let mut block = Block::new(kind.span, Some(kind), name);
        block.open = Some(self.sign(b'{')?);
        while self.next.kind == TokenKind::Name {
            let field = self.field()?;
            if self.words.is_doubtful(kind.text, &field) {
                return None;
            }
            block.fields.push(field);
        }
        let close = self.sign(b'}')?;
        block.close = Some(close);
        block.span = kind.span.to(close);
        Some(block)
    }

    fn field(&mut self) -> Option<Field<'s>> {
        let name = self.name()?;
        let value = self.value(0)?;
        let span = name.span.to(value.span);
        Some(Field { name, value, span })
    }

    fn value(&mut self, depth: usize) -> Option<Value<'s>> {
        match self.sign(b'-') {
            Some(sign) => Some(negation(sign, self.operand(depth)?)),
            None => self.operand(depth),
        }
    }

    fn operand(&mut self, depth: usize) -> Option<Value<'s>> {
        let kind = match self.next.kind {
            TokenKind::Name => return self.reference(depth),
            TokenKind::Sign => {
                let (elements, span) = self.elements(depth)?;
                return Some(Value::new(group(elements), span));
            }
            TokenKind::Number => {
                let kind = number(self.written());
                let (ValueKind::Number(digits) | ValueKind::Angle { number: digits, .. }) = kind
                else {
                    return None;
                };
                (numeric_part(digits) == digits).then_some(kind)?
            }
            TokenKind::Color => {
                let code = self.written();
                let is_code = is_color_code(code.trim_start_matches('#'));
                is_code.then_some(ValueKind::ColorCode(code))?
            }
            _ => return None,
        };
        Some(Value::new(kind, self.advance()))
    }

    fn reference(&mut self, depth: usize) -> Option<Value<'s>> {
        let name = self.name()?;
        if !self.is_sign(b'(') {
            return Some(Value::new(ValueKind::Name(name.text), name.span));
        }
        let (arguments, parentheses) = self.elements(depth)?;
        let is_foreign = self.words.is_foreign_function(name.text);
        (!is_foreign).then(|| call(name, arguments, parentheses))
    }

    /// Reads `(VALUE, …)`, and returns the elements and the span of the whole.
    fn elements(&mut self, depth: usize) -> Option<(Vec<Element<'s>>, Span)> {
        let open = self.sign(b'(')?;
        if depth == NESTING {
            return None;
        }
        let mut elements = Vec::with_capacity(3);
        if let Some(close) = self.sign(b')') {
            return Some((elements, open.to(close)));
        }
        loop {
            let value = self.value(depth + 1)?;
            let comma = self.sign(b',');
            elements.push(Element { value, comma });
            if comma.is_none() {
                let close = self.sign(b')')?;
                return Some((elements, open.to(close)));
            }
        }
    }

    /// Reads a name. Returns `None`, and reads nothing, if the next token is a keyword or no name.
    fn name(&mut self) -> Option<Name<'s>> {
        let text = self.written();
        let is_name = self.next.kind == TokenKind::Name && !matches!(text, "let" | "for");
        is_name.then(|| Name {
            text,
            span: self.advance(),
        })
    }

    /// Reads the sign `sign`. Returns `None`, and reads nothing, if the next token is another one.
    fn sign(&mut self, sign: u8) -> Option<Span> {
        self.is_sign(sign).then(|| self.advance())
    }

    fn is_sign(&self, sign: u8) -> bool {
        self.next.kind == TokenKind::Sign
            && self.text.as_bytes().get(self.next.start) == Some(&sign)
    }

    /// Returns the text of the next token.
    fn written(&self) -> &'s str {
        let Token { start, end, .. } = self.next;
        self.text.get(start..end).unwrap_or_default()
    }

    /// Consumes the next token and returns its span.
    fn advance(&mut self) -> Span {
        let Token { start, end, .. } = self.next;
        self.next = self.lexer.token_after_comments();
        Span::new(self.id, start, end)
    }
}

#[cfg(test)]
mod tests {
    use std::{fs, path::PathBuf};

    use proptest::prelude::*;

    use super::*;
    use crate::syntax::parser::TreeBuilder;

    /// Tries to read a plain block at each token of a text. Asserts that pest reads the same block,
    /// and that error recovery need not read it again. Returns the number of plain blocks.
    #[track_caller]
    fn assert_as_by_pest(text: &str) -> usize {
        let (id, words) = (SourceId::File, Vocabulary::new(text));
        let (mut lexer, mut count) = (Lexer::new(text, 0), 0);
        loop {
            let token = lexer.token();
            if token.kind == TokenKind::End {
                return count;
            }
            let mut reader = PlainReader::new(text, id, &words, (lexer.clone(), token));
            let Some(block) = reader.block() else {
                continue;
            };
            let mut builder = TreeBuilder::new(text, id, &words);
            let item = builder.item_by_grammar(text, token.start);
            assert_eq!(item, Some(Item::Block(block)), "{text:?}");
            assert!(!builder.is_doubtful(), "{text:?}");
            count += 1;
        }
    }

    /// Returns the texts of all scenes of the examples and the tests.
    #[allow(
        clippy::disallowed_methods,
        reason = "files of the repository are not hostile"
    )]
    fn texts_of_the_repository() -> Vec<String> {
        let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
        let mut folders: Vec<_> = ["examples", "tests"].map(|name| root.join(name)).into();
        let mut texts = Vec::new();
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).expect("a folder of the repository") {
                let path = entry.expect("an entry").path();
                if path.is_dir() {
                    folders.push(path);
                } else if path.extension().is_some_and(|extension| extension == "scn") {
                    texts.extend(fs::read_to_string(path));
                }
            }
        }
        texts
    }

    #[test]
    fn plain_blocks_of_all_scenes_are_read_as_by_the_grammar() {
        let texts = texts_of_the_repository();
        let counts = texts.iter().map(|text| assert_as_by_pest(text));
        let plain: usize = counts.sum();
        assert!(plain > 500, "{plain}");
    }

    /// Parts of blocks, with and without mistakes, from which the tests compose random texts.
    const PARTS: &str = "sphere box camera sampler Ball let for center radius color lookat method fov olive pi jittered ball rgb(255,165,0) rgb sqrt(2) vec3(1,2,3) cross((1,0,0),(0,1,0)) ((((1)))) (((((1))))) (1,2,3) (-1,.5,2.) (0,1,0,) (1) () 1 -1 --1 - 2.5 .5 5. 1e3 1e 1.5e-3 1_000 1__0 0x10 30deg 1.5rad 1e2deg 2degrees #fa0 #3366cc #12 #ggg ## \u{a0} \u{e9} olive\u{e9} /*c*/ /* //c\n //}\n \n \r ' \" ** := + * / ^ , ( ) { } = < { }";

    proptest! {
        #[test]
        fn texts_of_any_parts_are_read_as_by_the_grammar(
            parts in prop::collection::vec(prop::sample::select(PARTS.split(' ').collect::<Vec<_>>()), 1..12),
            is_spaced in any::<bool>(),
        ) {
            let text = parts.join(if is_spaced { " " } else { "" });
            assert_as_by_pest(&text);
            assert_as_by_pest(&format!("sphere {{ radius {text} }}"));
            assert_as_by_pest(&format!("sphere {{ center ({text}, 2, 3) color {text} }}"));
        }

        #[test]
        fn damaged_blocks_are_read_as_by_the_grammar(
            numbers in prop::array::uniform4(-1e3..1e3),
            color in prop::sample::select(vec!["olive", "#fa0", "rgb(255, 165, 0)"]),
            part in prop::sample::select(PARTS.split(' ').collect::<Vec<_>>()),
            at in any::<prop::sample::Index>(),
            length in 0_usize..4,
        ) {
            let [x, y, z, r] = numbers;
            let text = format!("sphere Ball {{ center ({x}, {y:.3}, {z:e})  radius {r} // r\n color {color} }}");
            prop_assert!(assert_as_by_pest(&text) >= 1);
            let start = at.index(text.len());
            let end = (start + length).min(text.len());
            assert_as_by_pest(&format!("{}{part}{}", &text[..start], &text[end..]));
        }
    }
}
