//! The parser: from pest's pairs to the tree.
//!
//! In: a source. Out: its tree, comments and problems. Items are read in `items`, values in `values`, and what went wrong in
//! `mistakes`. The functions that build nodes carry the names of the grammar's rules, one each; what a slip is called and
//! what the junk rules ate is explained in `junk`.
//!
//! Spans are taken from tokens: pest's own span of a rule may end after the white space behind it. Only byte offsets are
//! used (a line and a column from pest would take a walk over the text each).

mod items;
mod mistakes;
mod parts;
mod values;

pub use parts::parse_in_parts;

use std::{borrow::Cow, collections::BTreeMap, ops::Range, sync::atomic::AtomicBool, thread};

use miette::Diagnostic as _;
use pest::{Parser as _, iterators::Pair};

use super::{
    Parsed, Problem,
    comments::{self, Deep, Start, Walk},
    grammar::{Grammar, Rule},
    junk,
    tree::{Item, Name, Tree, Value, ValueKind},
};
use crate::{
    cancel,
    source::{Source, SourceId, Span},
};

/// The stack that pest gets: it takes some ten kilobytes for each level of nesting without optimization.
const STACK: usize = 64 << 20;

/// Parses a file.
pub fn parse(source: &Source, id: SourceId) -> Parsed<'_> {
    parse_unless(source, id, &cancel::NEVER)
}

/// The same, or, cancelled, as much of the file as was read until then.
pub fn parse_unless<'s>(source: &'s Source, id: SourceId, cancel: &AtomicBool) -> Parsed<'s> {
    with_stack(|| {
        let (mut parser, walk) = Parser::of_source(source, id, source.bom_len(), cancel);
        parser.pieces(source.text().len(), cancel);
        parser.finish(walk)
    })
}

/// Parses the part of a text from an offset on as one value: a `--set` argument's. The tree has one item, a definition
/// without a name.
pub fn parse_value(source: &Source, id: SourceId, start: usize) -> (Value<'_>, Vec<Problem>) {
    with_stack(|| {
        let (mut parser, walk) = Parser::of_source(source, id, start, &cancel::NEVER);
        let value = parser.whole_value();
        (value, parser.finish(walk).problems)
    })
}

/// Runs on a thread with a stack of known size, so that the nesting limit holds in every build and on every thread.
fn with_stack<T: Send>(work: impl Fn() -> T + Sync) -> T {
    thread::scope(|scope| {
        let builder = thread::Builder::new().stack_size(STACK);
        match builder
            .spawn_scoped(scope, &work)
            .map(|handle| handle.join())
        {
            Ok(Ok(result)) => result,
            Ok(Err(panic)) => std::panic::resume_unwind(panic),
            // No thread to be had: the caller's stack holds the limit in an optimized build.
            Err(_) => work(),
        }
    })
}

struct Parser<'s> {
    id: SourceId,
    /// The text as it was written.
    text: &'s str,
    /// The text with blanks for comments of other languages, if it has any.
    clean: Option<String>,
    /// The text as pest reads it: values that nest too deep are a 0 and blanks there.
    read: Cow<'s, str>,
    /// Where the piece that pest is reading starts: its offsets count from there.
    base: usize,
    /// Where the text ends.
    end: usize,
    deep: Vec<Deep>,
    items: Vec<Item<'s>>,
    problems: Vec<Problem>,
    /// Whether the last item was lines without meaning.
    in_odd_lines: bool,
    /// Blocks without their `}` that another block followed at once.
    nesting: usize,
}

type Pairs<'p> = Pair<'p, Rule>;

impl<'s> Parser<'s> {
    /// Reads from an offset on, what the walk over the text found left out.
    fn of_source(
        source: &'s Source,
        id: SourceId,
        start: usize,
        cancel: &AtomicBool,
    ) -> (Self, Walk) {
        let text = source.text();
        let first = match id {
            SourceId::File => Start::Items,
            SourceId::Set(_) => Start::Value,
        };
        let mut walk = comments::walk(text.get(start..).unwrap_or_default(), first, cancel);
        walk.shift(start);
        let foreign = walk.foreign.iter();
        let foreign: Vec<_> = foreign.map(|(sign, end)| sign.start..*end).collect();
        let read = with_blanks(without_deep(text, &walk.deep), &walk.odd_spaces);
        let parser = Self {
            read: with_blanks(read, &foreign),
            clean: match with_blanks(Cow::Borrowed(text), &foreign) {
                Cow::Borrowed(_) => None,
                Cow::Owned(clean) => Some(clean),
            },
            deep: std::mem::take(&mut walk.deep),
            ..Self::new(text, id, start)
        };
        (parser, walk)
    }

    /// Reads from an offset on.
    fn new(text: &'s str, id: SourceId, start: usize) -> Self {
        Self {
            id,
            text,
            clean: None,
            read: Cow::Borrowed(text),
            base: start,
            end: text.len(),
            deep: Vec::new(),
            items: Vec::new(),
            problems: Vec::new(),
            in_odd_lines: false,
            nesting: 0,
        }
    }

    fn finish(mut self, walk: Walk) -> Parsed<'s> {
        for deep in &self.deep {
            let span = Span::new(self.id, deep.at, deep.at + 1);
            self.problems.push(Problem::TooDeep { span });
        }
        self.odd_spaces(&walk.odd_spaces);
        self.foreign_comments(&walk.foreign);
        self.lone_return(&walk.comments);
        let last = walk.comments.last();
        let unclosed = last.filter(|_| walk.unclosed).map(|last| last.start);
        // What the comment took may be all that seems to be missing.
        let took_all =
            last.filter(|last| last.end == self.text.len() && self.has_lone_return(last));
        let cut = unclosed.or(took_all.map(|last| last.start));
        if let Some(start) = unclosed {
            // What the comment took is no second mistake.
            self.problems
                .retain(|problem| starts_before(problem, self.id.start() + start));
            let span = Span::new(self.id, start, start + 2);
            self.problems.push(Problem::UnclosedComment { span });
        }
        let comments = walk.comments.into_iter();
        Parsed {
            tree: Tree { items: self.items },
            comments: comments
                .map(|range| Span::new(self.id, range.start, range.end))
                .collect(),
            problems: self.problems,
            cut,
        }
    }

    /// Where lines end at carriage returns alone, a comment of one line takes all that follows.
    fn lone_return(&mut self, comments: &[Range<usize>]) {
        let comment = comments
            .iter()
            .find(|comment| self.has_lone_return(comment));
        let at = comment.and_then(|comment| {
            let written = self.text.get(comment.clone())?;
            Some(comment.start + written.find('\r')?)
        });
        if let Some(at) = at {
            let span = Span::new(self.id, at, at + 1);
            self.problems.push(Problem::LoneReturn { span });
        }
    }

    fn has_lone_return(&self, comment: &Range<usize>) -> bool {
        let written = self.text.get(comment.clone()).unwrap_or_default();
        written.starts_with("//") && written.trim_end_matches('\r').contains('\r')
    }

    /// One report for comments in lines that follow each other without anything between.
    fn foreign_comments(&mut self, comments: &[(Range<usize>, usize)]) {
        let mut before = None;
        for (sign, end) in comments {
            let place = Span::new(self.id, sign.start, sign.end);
            let gap = before.and_then(|before| self.text.get(before..sign.start));
            match self.problems.last_mut() {
                Some(Problem::ForeignComment { places, .. })
                    if gap.is_some_and(|gap| gap.trim().is_empty()) =>
                {
                    places.push(place);
                }
                _ => {
                    let words = self.text.get(sign.end..*end).unwrap_or_default();
                    self.problems.push(Problem::ForeignComment {
                        sign: self.short(place),
                        right: junk::shorten(&format!("//{words}")),
                        span: place,
                        places: vec![place],
                    });
                }
            }
            before = Some(*end);
        }
    }

    /// One report for each sort of character, at the first one.
    fn odd_spaces(&mut self, places: &[Range<usize>]) {
        let mut sorts: BTreeMap<&str, Vec<Span>> = BTreeMap::new();
        for place in places {
            let span = Span::new(self.id, place.start, place.end);
            sorts.entry(self.written(span)).or_default().push(span);
        }
        for (text, places) in sorts {
            let Some(&span) = places.first() else {
                continue;
            };
            self.problems.push(Problem::OddSpace {
                what: junk::name_of_space(text),
                more: places.len() - 1,
                span,
                places,
            });
        }
    }

    /// Reads piece after piece up to the first that ends at an offset or behind it, or until it is cancelled; answers whether one
    /// ends there.
    fn pieces(&mut self, end: usize, cancel: &AtomicBool) -> bool {
        let read = std::mem::take(&mut self.read);
        while self.base < end && !cancel::is_set(cancel) {
            let rest = read.get(self.base..).unwrap_or_default();
            // The junk rules take everything but white space: there is always a piece, or the end.
            let mut length = 0;
            for pair in Grammar::parse(Rule::next, rest).into_iter().flatten() {
                if pair.as_rule() == Rule::EOI {
                    return end == self.end;
                }
                length = pair.as_span().end();
                self.piece(pair);
                if self.base + length >= end {
                    break;
                }
            }
            if length == 0 {
                return false;
            }
            self.base += length;
        }
        self.base == end
    }

    fn piece(&mut self, pair: Pairs<'_>) {
        match pair.as_rule() {
            Rule::definition => {
                let definition = self.definition(pair);
                self.items.push(Item::Definition(definition));
            }
            Rule::block => {
                let block = self.block(pair);
                self.items.push(Item::Block(block));
            }
            Rule::bad_definition => self.bad_definition(pair),
            Rule::stray_close => self.stray_close(pair),
            Rule::bad_item => self.bad_item(pair),
            _ => return,
        }
        if matches!(self.items.last(), Some(Item::Definition(_))) {
            self.nesting = 0;
        }
        self.in_odd_lines &= matches!(self.items.last(), Some(Item::Bad(_)));
    }

    fn whole_value(&mut self) -> Value<'s> {
        let read = std::mem::take(&mut self.read);
        let rest = read.get(self.base..).unwrap_or_default();
        if let Ok(mut pairs) = Grammar::parse(Rule::whole_value, rest)
            && let Some(pair) = pairs.next()
        {
            return self.value(pair);
        }
        let span = self.trimmed(self.base, self.end);
        let problem = match span.range().is_empty() {
            true => Problem::SetWithoutValue {
                span: Span::new(self.id, self.base.saturating_sub(1), self.base),
            },
            false => junk::value(self.clean(), span),
        };
        self.problems.push(problem);
        bad(span)
    }

    fn name(&self, pair: &Pairs<'_>) -> Name<'s> {
        let span = self.span(pair);
        Name {
            text: self.written(span),
            span,
        }
    }

    fn span(&self, pair: &Pairs<'_>) -> Span {
        let span = pair.as_span();
        Span::new(self.id, self.base + span.start(), self.base + span.end())
    }

    fn written(&self, span: Span) -> &'s str {
        self.text.get(span.range()).unwrap_or_default()
    }

    /// The text without comments of other languages.
    fn clean(&self) -> &str {
        self.clean.as_deref().unwrap_or(self.text)
    }

    /// A name of the clean text as one of the text itself.
    fn own(&self, name: Name<'_>) -> Name<'s> {
        Name {
            text: self.written(name.span),
            span: name.span,
        }
    }

    /// What stands under a span, for a message.
    fn short(&self, span: Span) -> String {
        junk::shorten(self.written(span))
    }

    fn rest_of_value(&self, start: usize) -> String {
        let rest = self.text.get(start..).unwrap_or_default().trim_start();
        let end = rest.find(|c: char| c.is_whitespace() || "{}(),;".contains(c));
        junk::shorten(rest.get(..end.unwrap_or(rest.len())).unwrap_or_default())
    }

    /// The word or sign that stands at an offset.
    fn word_at(&self, start: usize) -> Span {
        let rest = self.text.get(start..).unwrap_or_default();
        let other = |c: char| !c.is_ascii_alphanumeric() && c != '_';
        let first = rest.chars().next().map_or(0, char::len_utf8);
        let length = rest.find(other).unwrap_or(rest.len()).max(first);
        Span::new(self.id, start, start + length)
    }

    /// The same span without white space and comments at its end.
    fn trimmed(&self, start: usize, end: usize) -> Span {
        let text = self.clean().get(start..end).unwrap_or_default();
        Span::new(self.id, start, start + junk::written_length(text))
    }

    /// The same span without white space at its end.
    fn tight(&self, span: Span) -> Span {
        let length = self.written(span).trim_end().len();
        Span::new(self.id, span.start, span.start + length)
    }
}

fn bad<'s>(span: Span) -> Value<'s> {
    Value {
        kind: ValueKind::Bad,
        span,
    }
}

/// The text with each value that nests too deep replaced by a 0 and blanks.
fn without_deep<'s>(text: &'s str, deep: &[Deep]) -> Cow<'s, str> {
    if deep.is_empty() {
        return Cow::Borrowed(text);
    }
    let mut read = String::with_capacity(text.len());
    for Deep { value, .. } in deep {
        read.push_str(text.get(read.len()..value.start).unwrap_or_default());
        read.push('0');
        let blanks = value.end.saturating_sub(read.len());
        read.extend(std::iter::repeat_n(' ', blanks));
    }
    read.push_str(text.get(read.len()..).unwrap_or_default());
    Cow::Owned(read)
}

/// The text with plain blanks in these places.
fn with_blanks<'s>(text: Cow<'s, str>, places: &[Range<usize>]) -> Cow<'s, str> {
    if places.is_empty() {
        return text;
    }
    let mut read = String::with_capacity(text.len());
    for place in places {
        read.push_str(text.get(read.len()..place.start).unwrap_or_default());
        read.extend(std::iter::repeat_n(' ', place.len()));
    }
    read.push_str(text.get(read.len()..).unwrap_or_default());
    Cow::Owned(read)
}

fn starts_before(problem: &Problem, place: usize) -> bool {
    if matches!(problem, Problem::UnclosedBlock { .. }) {
        return false;
    }
    let first = problem.labels().and_then(|mut labels| labels.next());
    first.is_none_or(|label| label.offset() + label.len() < place)
}
