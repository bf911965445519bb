//! Parses a text into the tree.
//!
//! In: a source. Out: its tree, comments and problems. pest, a parser generated from the grammar,
//! reads every item that follows the grammar, except blocks without operators, which `plain` reads
//! faster. The functions here convert pest's pairs (matches of grammar rules) to nodes and are
//! named after the rules. `recovery` reads an item that pest rejects. It also reads an item that
//! pest accepts but that was probably meant otherwise, such as a block with an unknown field.
//!
//! The text is read in pieces, because pest may look at a whole piece before it rejects an item.
//! Each piece ends after a `}` or before a `let`. In a text without mistakes, every `}` ends a
//! block, and every `let` starts a definition.

use std::{
    ops::Range,
    sync::{LazyLock, atomic::AtomicBool},
    thread,
};

use pest::{
    Parser as _,
    iterators::Pair,
    pratt_parser::{Assoc, Op, PrattParser},
};

use super::{
    NESTING_LIMIT, Parsed,
    plain::PlainReader,
    recovery::Recovery,
    scan::Scan,
    tokens::{Lexer, TokenKind},
    tree::{
        Block, Definition, Element, Field, Index, Item, Name, Operator, Repetition, Value,
        ValueKind, bad, call, chain, group, negation, number,
    },
    vocabulary::Vocabulary,
};
use crate::{
    cancel,
    diagnostic::Diagnostic,
    source::{Source, SourceId, Span},
};

/// Parser that pest generates from the rules of the grammar.
#[derive(pest_derive::Parser)]
#[grammar = "grammar/scn.pest"]
struct Grammar;

/// Precedence of the operators, from the lowest to the highest.
static PRECEDENCE: LazyLock<PrattParser<Rule>> = LazyLock::new(|| {
    PrattParser::new()
        .op(Op::infix(Rule::sum, Assoc::Left))
        .op(Op::infix(Rule::product, Assoc::Left))
        .op(Op::prefix(Rule::sign))
});

/// Stack size, in bytes, of the threads that parse. Without optimization, pest and error recovery
/// use tens of kilobytes of stack for each level of nesting, and there are at most 256 levels
/// ([`NESTING_LIMIT`]). All levels together fit into half of this size.
pub const STACK_BYTES: usize = 64 << 20;

/// Maximum nesting depth of a text that is parsed on the caller's stack. With a much larger
/// maximum, a text could overflow a small stack; few texts nest deeper.
const SHALLOW: usize = 12;

/// Minimum length, in bytes, of a value that is parsed on a thread with a stack of its own. Shorter
/// values are parsed on the caller's stack: each nesting level needs at least one byte of text, so
/// they have fewer than 32 levels. With a much larger minimum, a value could overflow a small
/// stack. With a smaller one, more threads would be started.
const SHORT_VALUE_BYTES: usize = 32;

/// Minimum length, in bytes, of the pieces in which a text is read. A piece is usually longer,
/// because it ends at the next place where the text can be split. pest may look at a whole
/// piece before it rejects an item, so with a much larger minimum, each mistake would take long.
pub const CHUNK_BYTES: usize = 4096;

/// Parses a file.
pub fn parse(source: &Source, id: SourceId) -> Parsed<'_> {
    parse_unless(source, id, &cancel::NEVER)
}

/// Parses a file. If `cancel` is set meanwhile, returns the part that was read.
pub fn parse_unless<'s>(source: &'s Source, id: SourceId, cancel: &AtomicBool) -> Parsed<'s> {
    let text = source.text();
    let scan = Scan::of(text, id, source.bom_len(), cancel);
    let words = Vocabulary::new(text);
    let read = |limit| {
        let mut recovery = Recovery::new(source, id, &words);
        recovery.limit = limit;
        let mut builder = TreeBuilder::new(text, id, &words);
        let mut at = source.bom_len();
        while at < text.len() && !cancel::is_set(cancel) {
            let end = first_from(&scan.split_points, at + CHUNK_BYTES).unwrap_or(text.len());
            let deep = first_from(&scan.deep, at).filter(|&place| place <= end);
            let end = deep.unwrap_or(end);
            let (next, is_agreed) = builder.items(at..end, &mut recovery);
            let token = Lexer::new(text, next).seen_token();
            let is_read = token.kind == TokenKind::End || (token.start >= end && deep.is_none());
            at = if !is_agreed {
                next
            } else if is_read {
                token.start
            } else {
                recover_item(&mut recovery, text, token.start)
            };
        }
        recovery
    };
    // Starting a thread takes longer than reading a small scene, so a shallow text is read on the
    // caller's stack. Error recovery may count more levels than the scan; then the text is read
    // again on a thread.
    let is_shallow = scan.nesting <= SHALLOW;
    let shallow = is_shallow.then(|| read(SHALLOW));
    let recovery = shallow.filter(|recovery| !recovery.has_passed_over);
    let recovery = recovery.unwrap_or_else(|| with_stack(|| read(NESTING_LIMIT)));
    recovery.finish(scan)
}

/// Reads the item at `at`, which does not follow the grammar, and returns its end. If pest read a
/// definition directly before `at`, and the text at `at` may continue that definition
/// ([`goes_on`]), removes the definition's node and reads the definition again from its start.
fn recover_item(recovery: &mut Recovery<'_, '_>, text: &str, mut at: usize) -> usize {
    if let Some(Item::Definition(last)) = recovery.items.last()
        && last.span.start >= recovery.read_to
        && goes_on(text, last.span.end, at)
    {
        at = last.span.start;
        recovery.items.pop();
    }
    recovery.item(at)
}

/// Returns the first element of `places` that is at least `offset`. The elements must be in
/// ascending order. Returns `None` if all are less.
pub fn first_from(places: &[usize], offset: usize) -> Option<usize> {
    let first = places.partition_point(|&place| place < offset);
    places.get(first).copied()
}

/// Returns whether the text at `at` may continue a definition that ends at `end`: no line end is
/// between `end` and `at`, or the text at `at` starts with an operator or `)`.
fn goes_on(text: &str, end: usize, at: usize) -> bool {
    let line = text.get(end..at).unwrap_or_default();
    let rest = text.get(at..).unwrap_or_default();
    !line.contains('\n') || rest.starts_with(['+', '-', '*', '/', '^', ')'])
}

/// Parses the text from the offset `start` on as one value, such as that of a `--set` argument.
/// Returns the value and its problems.
pub fn parse_value(source: &Source, id: SourceId, start: usize) -> (Value<'_>, Vec<Diagnostic>) {
    let text = source.text();
    let read = || {
        let scan = Scan::of(text, id, start, &cancel::NEVER);
        let words = Vocabulary::new("");
        let mut recovery = Recovery::new(source, id, &words);
        let value = recovery.whole_value(start);
        (value, recovery.finish(scan).problems)
    };
    if text.len() - start < SHORT_VALUE_BYTES {
        read()
    } else {
        with_stack(read)
    }
}

/// Runs `work` on a new thread with a stack of [`STACK_BYTES`] and returns its result. This stack
/// suffices for the maximum nesting, whatever the build and the stack of the calling thread. Passes
/// on a panic of `work`.
fn with_stack<T: Send>(work: impl Fn() -> T + Sync) -> T {
    thread::scope(|scope| {
        let builder = thread::Builder::new().stack_size(STACK_BYTES);
        let handle = builder.spawn_scoped(scope, &work);
        match handle.map(|handle| handle.join()) {
            Ok(Ok(result)) => result,
            Ok(Err(panic)) => std::panic::resume_unwind(panic),
            // If no thread can be started, `work` runs on the caller's stack. In an optimized
            // build, this stack suffices for the maximum nesting.
            Err(_) => work(),
        }
    })
}

/// Converter of pest's pairs, i.e. matches of grammar rules, into nodes of the syntax tree.
pub struct TreeBuilder<'w, 's> {
    text: &'s str,
    id: SourceId,
    words: &'w Vocabulary<'s>,
    /// Byte offset, in the whole text, of the piece that is parsed. The text is parsed in pieces,
    /// and pest counts offsets from the start of a piece.
    base: usize,
    /// Whether the last item follows the grammar but has an unknown field or function, so that
    /// error recovery should read it again.
    doubtful: bool,
}

impl<'w, 's> TreeBuilder<'w, 's> {
    /// Makes a builder for a text.
    pub fn new(text: &'s str, id: SourceId, words: &'w Vocabulary<'s>) -> Self {
        Self {
            text,
            id,
            words,
            base: 0,
            doubtful: false,
        }
    }

    /// Reads the items in `range`, and adds their nodes to `recovery`. An item that was probably
    /// meant otherwise is read again by error recovery. If the new reading ends at another offset,
    /// reading stops after this item. Returns the end of the last item that was read, and whether
    /// all new readings ended at the same offsets as the first ones.
    pub fn items(&mut self, range: Range<usize>, recovery: &mut Recovery<'_, 's>) -> (usize, bool) {
        let mut end = range.start;
        while let Some((start, item)) = self.item(end..range.end) {
            // In `let a = 2 pi`, followed by `sphere {`, pest reads `pi sphere {` as a block of the
            // kind `pi` with the name `sphere`. The actual kind is `sphere`, so reading stops
            // before `pi`, and recovery reports that `2 pi` lacks its operator.
            if let Item::Block(block) = &item
                && let (Some(kind), Some(name)) = (block.kind, block.name)
                && self.words.is_kind(name.text)
                && !self.words.is_kind(kind.text)
            {
                return (end, true);
            }
            end = item.span().end;
            // An item is read again by error recovery in two cases: it was probably meant otherwise
            // (`doubtful`), or it contains `--`, which may start a comment of another language. In
            // the second case, the item must be shorter than [`CHUNK_BYTES`], to bound the work.
            let written = self.written(item.span());
            if self.doubtful || (written.len() < CHUNK_BYTES && written.contains("--")) {
                match recovery.item_as_meant(start) {
                    Some(read_to) if read_to == end => continue,
                    Some(read_to) => return (read_to, false),
                    None => {}
                }
            }
            recovery.items.push(item);
        }
        (end, true)
    }

    /// Reads the first item in `range`, and returns its start and the item. Returns `None` if
    /// `range` contains no item, or if the first item does not follow the grammar.
    fn item(&mut self, range: Range<usize>) -> Option<(usize, Item<'s>)> {
        self.doubtful = false;
        let text = self.text.get(..range.end)?;
        let mut lexer = Lexer::new(text, range.start);
        let first = lexer.token_after_comments();
        if first.kind == TokenKind::End {
            return None;
        }
        let mut plain = PlainReader::new(text, self.id, self.words, (lexer, first));
        let item = match plain.block() {
            Some(block) => Item::Block(block),
            None => self.item_by_grammar(text, first.start)?,
        };
        Some((first.start, item))
    }

    /// Reads the item that starts at `start` with pest. Returns `None` if it does not follow the
    /// grammar.
    pub fn item_by_grammar(&mut self, text: &str, start: usize) -> Option<Item<'s>> {
        self.base = start;
        let slice = text.get(start..)?;
        let pair = Grammar::parse(Rule::item, slice).ok()?.next()?;
        Some(match pair.as_rule() {
            Rule::definition => Item::Definition(self.definition(pair)),
            _ => Item::Block(self.block(pair)),
        })
    }

    /// Returns whether error recovery should read the last item again.
    #[cfg(test)]
    pub fn is_doubtful(&self) -> bool {
        self.doubtful
    }

    fn definition(&mut self, pair: Pair<'_, Rule>) -> Definition<'s> {
        let start = self.span(&pair).start;
        let keyword = Span::new(self.id, start, start + "let".len());
        let mut definition = Definition::begun(keyword);
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::name => definition.name = Some(self.name(&part)),
                Rule::equals => definition.equals = Some(self.span(&part)),
                Rule::value => definition.value = self.value(part),
                _ => {}
            }
        }
        definition.span = keyword.to(definition.value.span);
        definition
    }

    fn block(&mut self, pair: Pair<'_, Rule>) -> Block<'s> {
        let mut block = Block::new(self.span(&pair), None, None);
        let parts = pair.into_inner();
        // Usually, all parts except the kind and the two braces are fields. Memory is reserved for
        // this number of fields.
        block.fields.reserve_exact(parts.len().saturating_sub(3));
        for part in parts {
            match part.as_rule() {
                Rule::name if block.kind.is_none() => block.kind = Some(self.name(&part)),
                Rule::name => block.name = Some(self.name(&part)),
                Rule::repetition => block.repetition = Some(Box::new(self.repetition(part))),
                Rule::open => block.open = Some(self.span(&part)),
                Rule::close => block.close = Some(self.span(&part)),
                Rule::field => block.fields.push(self.field(part)),
                _ => {}
            }
        }
        if let Some(close) = block.close {
            block.span = block.span.to(close);
        }
        let kind = block.kind.map_or("", |kind| kind.text);
        let is_doubtful = |field: &Field<'_>| self.words.is_doubtful(kind, field);
        self.doubtful |= block.fields.iter().any(is_doubtful);
        block
    }

    fn repetition(&mut self, pair: Pair<'_, Rule>) -> Repetition<'s> {
        let mut repetition = Repetition {
            keyword: self.span(&pair),
            indices: Vec::new(),
        };
        for part in pair.into_inner() {
            let span = self.span(&part);
            match (part.as_rule(), repetition.indices.last_mut()) {
                (Rule::for_word, _) => repetition.keyword = span,
                (Rule::name, _) => repetition.indices.push(Index::begun(self.name(&part))),
                (Rule::less, Some(last)) => last.less = span,
                (Rule::comma, Some(last)) => last.comma = Some(span),
                (_, Some(last)) => last.count = self.value(part),
                (_, None) => {}
            }
        }
        repetition
    }

    fn field(&mut self, pair: Pair<'_, Rule>) -> Field<'s> {
        let span = self.span(&pair);
        let mut name = Name { text: "", span };
        let mut value = bad(span);
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::name => name = self.name(&part),
                _ => value = self.value(part),
            }
        }
        let span = name.span.to(value.span);
        Field { name, value, span }
    }

    fn value(&mut self, pair: Pair<'_, Rule>) -> Value<'s> {
        let mut parts = pair.into_inner();
        if parts.len() == 1
            && let Some(operand) = parts.next()
        {
            return self.operand(operand);
        }
        // The closures for operands, signs and operators all need `self`, so it is in a `RefCell`.
        // Each closure borrows it only while it makes a node, so no two borrows overlap.
        let this = std::cell::RefCell::new(self);
        PRECEDENCE
            .map_primary(|pair| this.borrow_mut().operand(pair))
            .map_prefix(|sign, operand| negation(this.borrow().span(&sign), operand))
            .map_infix(|left, sign, right| {
                let span = this.borrow().span(&sign);
                let operator = Operator::of(sign.as_str()).unwrap_or(Operator::Divide);
                chain(left, operator, span, right)
            })
            .parse(parts)
    }

    fn operand(&mut self, pair: Pair<'_, Rule>) -> Value<'s> {
        let span = self.span(&pair);
        let kind = match pair.as_rule() {
            Rule::number => number(self.written(span)),
            Rule::reference => return self.reference(pair),
            Rule::color => ValueKind::ColorCode(self.written(span)),
            _ => group(self.elements(pair)),
        };
        Value { kind, span }
    }

    fn reference(&mut self, pair: Pair<'_, Rule>) -> Value<'s> {
        let mut parts = pair.into_inner();
        let function = match parts.next() {
            Some(name) => self.name(&name),
            None => return bad(Span::new(self.id, self.base, self.base)),
        };
        let Some(arguments) = parts.next() else {
            return Value::new(ValueKind::Name(function.text), function.span);
        };
        self.doubtful |= self.words.is_foreign_function(function.text);
        let parentheses = self.span(&arguments);
        call(function, self.elements(arguments), parentheses)
    }

    fn elements(&mut self, pair: Pair<'_, Rule>) -> Vec<Element<'s>> {
        let parts = pair.into_inner();
        // Values and commas alternate, so about half of the parts are values.
        let mut elements: Vec<Element<'s>> = Vec::with_capacity(parts.len().div_ceil(2));
        for part in parts {
            if part.as_rule() != Rule::comma {
                let value = self.value(part);
                elements.push(Element { value, comma: None });
            } else if let Some(last) = elements.last_mut() {
                last.comma = Some(self.span(&part));
            }
        }
        elements
    }

    fn name(&self, pair: &Pair<'_, Rule>) -> Name<'s> {
        let span = self.span(pair);
        let text = self.written(span);
        Name { text, span }
    }

    fn span(&self, pair: &Pair<'_, Rule>) -> Span {
        let span = pair.as_span();
        Span::new(self.id, self.base + span.start(), self.base + span.end())
    }

    fn written(&self, span: Span) -> &'s str {
        self.text.get(span.range()).unwrap_or_default()
    }
}
