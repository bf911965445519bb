//! The lexer: from a text to its tokens.
//!
//! In: a text and an offset. Out: one token after the other, comments among them; what lies between
//! two tokens is white space. It knows nothing of the grammar, so it reads any text: a character
//! that starts no token is one by itself. The scan for comments, recovery and the editor read with
//! it; the formatter walks the tree.

/// What a token is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TokenKind {
    /// A word of ASCII letters, digits and `_` that does not start with a digit; `let` is one.
    Name,
    /// What starts with a digit, or with a `.` and a digit, up to the end of the word: `2`, `1e-3`,
    /// `30deg`, `0x10`.
    Number,
    /// `#` and the word right behind it.
    Color,
    /// A text in quotation marks, with these; it ends in its line, before a comment.
    Quoted,
    /// A word with letters that are not ASCII.
    Word,
    /// One character of any other sort, `**` or `:=`.
    Sign,
    /// `// …` without its line end, or `/* … */`; without its `*/` it goes on to the end of the
    /// text.
    Comment,
    /// A character that cannot be seen and is no white space of the language.
    OddSpace,
    /// The end of the text.
    End,
}

/// A token and its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Token {
    /// What it is.
    pub kind: TokenKind,
    /// Its first byte.
    pub start: usize,
    /// One past its last byte.
    pub end: usize,
}

/// Reads a text token by token; past the end it gives [`TokenKind::End`] again and again.
#[derive(Clone, Debug)]
pub struct Lexer<'s> {
    text: &'s str,
    at: usize,
}

impl<'s> Lexer<'s> {
    /// Starts at an offset.
    pub fn new(text: &'s str, at: usize) -> Self {
        Self { text, at }
    }

    /// The next token.
    pub fn token(&mut self) -> Token {
        let bytes = self.text.as_bytes();
        let blank = |byte: &u8| matches!(byte, b' ' | b'\t' | b'\r' | b'\n');
        while bytes.get(self.at).is_some_and(blank) {
            self.at += 1;
        }
        let start = self.at;
        let (kind, end) = self.kind_and_end(start);
        self.at = end;
        Token { kind, start, end }
    }

    /// The next token that is no comment and can be seen.
    pub fn seen_token(&mut self) -> Token {
        loop {
            let token = self.token();
            if !matches!(token.kind, TokenKind::Comment | TokenKind::OddSpace) {
                return token;
            }
        }
    }

    fn kind_and_end(&self, start: usize) -> (TokenKind, usize) {
        let bytes = self.text.as_bytes();
        let Some(&first) = bytes.get(start) else {
            return (TokenKind::End, start);
        };
        let second = bytes.get(start + 1).copied().unwrap_or(b' ');
        match (first, second) {
            (b'a'..=b'z' | b'A'..=b'Z' | b'_', _) => self.word(start),
            (b'0'..=b'9', _) | (b'.', b'0'..=b'9') => (TokenKind::Number, self.number_end(start)),
            (b'/', b'/') => (TokenKind::Comment, line_end(self.text, start)),
            (b'/', b'*') => {
                let length = self.rest(start + 2).find("*/");
                let end = length.map_or(bytes.len(), |length| start + length + 4);
                (TokenKind::Comment, end)
            }
            (b'#', second) if is_name_char(second) => (TokenKind::Color, self.name_end(start + 1)),
            (b'*', b'*') | (b':', b'=') => (TokenKind::Sign, start + 2),
            (b'"' | b'\'', _) => self.quoted(start),
            (b'!'..=b'~', _) => (TokenKind::Sign, start + 1),
            _ => self.other(start),
        }
    }

    /// A character that is not ASCII, or a control character.
    fn other(&self, start: usize) -> (TokenKind, usize) {
        let first = self.rest(start).chars().next().unwrap_or(' ');
        match first {
            '“' | '”' | '„' | '‘' | '’' | '«' => self.quoted(start),
            _ if is_odd_space(first) => (TokenKind::OddSpace, start + first.len_utf8()),
            _ if first.is_alphabetic() => self.word(start),
            _ => (TokenKind::Sign, start + first.len_utf8()),
        }
    }

    fn word(&self, start: usize) -> (TokenKind, usize) {
        let end = self.name_end(start);
        if end > start && self.text.as_bytes().get(end).is_none_or(u8::is_ascii) {
            return (TokenKind::Name, end);
        }
        let rest = self.rest(end);
        let other = |c: char| !c.is_alphanumeric() && c != '_';
        match rest.find(other).unwrap_or(rest.len()) {
            0 => (TokenKind::Name, end),
            length => (TokenKind::Word, end + length),
        }
    }

    fn name_end(&self, start: usize) -> usize {
        let bytes = self.text.as_bytes().get(start..).unwrap_or_default();
        let other = |&byte: &u8| !is_name_char(byte);
        start + bytes.iter().position(other).unwrap_or(bytes.len())
    }

    fn number_end(&self, start: usize) -> usize {
        let bytes = self.text.as_bytes();
        let mut end = start;
        while let Some(&byte) = bytes.get(end) {
            let before = bytes.get(end.wrapping_sub(1)).copied();
            let is_digit = bytes.get(end + 1).is_some_and(u8::is_ascii_digit);
            let is_exponent = matches!(before, Some(b'e' | b'E')) && end > start && is_digit;
            match byte {
                b'.' => {}
                b'+' | b'-' if is_exponent => {}
                _ if is_name_char(byte) => {}
                _ => break,
            }
            end += 1;
        }
        end
    }

    /// Up to the mark that closes it in its line; where there is none, the word behind the mark. A
    /// comment may start within: to the grammar these are no quotation marks.
    fn quoted(&self, start: usize) -> (TokenKind, usize) {
        let mut characters = self.rest(start).char_indices().peekable();
        let first = characters.next().map_or('"', |(_, first)| first);
        let close: &[char] = match first {
            '“' | '”' | '„' => &['”', '“', '"'],
            '‘' | '’' => &['’', '‘', '\''],
            '«' => &['»', '«'],
            _ => &[first],
        };
        let mut end = self.name_end(start + first.len_utf8());
        while let Some((at, character)) = characters.next() {
            if close.contains(&character) {
                end = start + at + character.len_utf8();
                break;
            }
            let next = characters.peek().map_or('\n', |(_, next)| *next);
            if character == '\n' || (character == '/' && matches!(next, '/' | '*')) {
                break;
            }
        }
        (TokenKind::Quoted, end)
    }

    fn rest(&self, at: usize) -> &'s str {
        self.text.get(at..).unwrap_or_default()
    }
}

/// Where the line ends; the carriage return of a CRLF belongs to its end.
pub fn line_end(text: &str, at: usize) -> usize {
    let mut lines = text.get(at..).unwrap_or_default().lines();
    at + lines.next().map_or(0, str::len)
}

/// Whether a byte may stand in a name.
pub fn is_name_char(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_'
}

/// Whether these are the digits of a colour.
pub fn is_color_code(digits: &str) -> bool {
    matches!(digits.len(), 3 | 6) && digits.bytes().all(|digit| digit.is_ascii_hexdigit())
}

/// Whether a character cannot be seen and is no white space of the language.
fn is_odd_space(c: char) -> bool {
    match c {
        ' ' | '\t' | '\r' | '\n' => false,
        '\u{200B}'..='\u{200F}' | '\u{2060}' | '\u{FEFF}' | '\u{AD}' => true,
        _ => c.is_whitespace() || c.is_ascii_control(),
    }
}

/// The digits at the start of a number, up to its unit or whatever else follows them.
pub fn numeric_part(written: &str) -> &str {
    let bytes = written.as_bytes();
    let byte = |at: usize| bytes.get(at).copied().unwrap_or(b' ');
    let digits = |from: usize| {
        let mut at = from;
        while byte(at).is_ascii_digit()
            || (byte(at) == b'_' && at > from && byte(at + 1).is_ascii_digit())
        {
            at += 1;
        }
        at
    };
    let mut end = digits(0);
    if byte(end) == b'.' {
        end = digits(end + 1);
    }
    if matches!(byte(end), b'e' | b'E') {
        let from = end + 1 + usize::from(matches!(byte(end + 1), b'+' | b'-'));
        if byte(from).is_ascii_digit() {
            end = digits(from);
        }
    }
    written.get(..end).unwrap_or_default()
}

/// Whether a name stands in a text, outside of its comments.
pub fn has_name(text: &str, name: &str) -> bool {
    // Most texts do without a look at their tokens.
    let mut lexer = Lexer::new(text, 0);
    text.contains(name)
        && loop {
            let token = lexer.token();
            match token.kind {
                TokenKind::End => break false,
                TokenKind::Name if text.get(token.start..token.end) == Some(name) => break true,
                _ => {}
            }
        }
}
