//! Splits a text into tokens.
//!
//! In: a text and an offset. Out: one token after the other, including comments; between two tokens
//! there is only white space. The lexer does not know the grammar, so it accepts any text: a
//! character that starts no other token is a token by itself. Error recovery, the editor and the
//! scan before parsing use the lexer; the formatter walks the tree instead.

/// Kind of a token.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum TokenKind {
    /// A word of ASCII letters, digits and `_` that does not start with a digit. The keyword `let`
    /// also has this kind.
    Name,
    /// A word that starts with a digit, or with a `.` and a digit: `2`, `1e-3`, `30deg`, `0x10`.
    Number,
    /// A colour code such as `#ff8000`: a `#` and the word directly after it, even if this word is
    /// no valid code.
    Color,
    /// A text in quotation marks, including the marks. If the line has no closing mark, the token
    /// is only the opening mark and the word directly after it.
    Quoted,
    /// A word with letters that are not ASCII.
    Word,
    /// The signs `**` and `:=`, or any other single character.
    Sign,
    /// `// …` without its line end, or `/* … */`. Without a `*/`, the comment extends to the end of
    /// the text.
    Comment,
    /// An invisible character that is not white space of the language.
    OddSpace,
    /// The end of the text.
    End,
}

/// A token with its span in the text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Token {
    /// The token's kind.
    pub kind: TokenKind,
    /// Offset of the token's first byte.
    pub start: usize,
    /// One past the offset of the token's last byte.
    pub end: usize,
}

/// Lexer of a text. At the end of the text, it returns [`TokenKind::End`] at every call.
#[derive(Clone, Debug)]
pub struct Lexer<'s> {
    text: &'s str,
    at: usize,
}

impl<'s> Lexer<'s> {
    /// Makes a lexer that starts at the offset `at`.
    pub fn new(text: &'s str, at: usize) -> Self {
        Self { text, at }
    }

    /// Returns the next token.
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

    /// Returns the next token that is no comment.
    pub fn token_after_comments(&mut self) -> Token {
        loop {
            let token = self.token();
            if token.kind != TokenKind::Comment {
                return token;
            }
        }
    }

    /// Returns the next token that is neither a comment nor an invisible character.
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

    /// Returns the kind and the end of the token at `start`, which begins with a control character
    /// or a non-ASCII character.
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
            let is_exponent = || {
                let before = bytes.get(start..end).and_then(<[u8]>::last);
                let is_digit = bytes.get(end + 1).is_some_and(u8::is_ascii_digit);
                matches!(before, Some(b'e' | b'E')) && is_digit
            };
            match byte {
                b'.' => {}
                _ if is_name_char(byte) => {}
                b'+' | b'-' if is_exponent() => {}
                _ => break,
            }
            end += 1;
        }
        end
    }

    /// Returns the kind and the end of the quoted text at `start`. If no closing mark follows
    /// before the end of the line or before a comment, the token is only the opening mark and the
    /// word directly after it.
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

/// Returns the offset of the end of the line that contains `at`, before its LF or CRLF.
pub fn line_end(text: &str, at: usize) -> usize {
    let mut lines = text.get(at..).unwrap_or_default().lines();
    at + lines.next().map_or(0, str::len)
}

/// Returns whether a byte may stand in a name.
pub fn is_name_char(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_'
}

/// Returns whether `digits` consists of three or six hexadecimal digits, as a colour code without
/// its `#` does.
pub fn is_color_code(digits: &str) -> bool {
    matches!(digits.len(), 3 | 6) && digits.bytes().all(|digit| digit.is_ascii_hexdigit())
}

/// Returns whether a character is invisible and not white space of the language.
fn is_odd_space(c: char) -> bool {
    match c {
        ' ' | '\t' | '\r' | '\n' => false,
        '\u{200B}'..='\u{200F}' | '\u{2060}' | '\u{FEFF}' | '\u{AD}' => true,
        _ => c.is_whitespace() || c.is_ascii_control(),
    }
}

/// Returns the number at the start of `written`, without a unit or other text after it. Returns an
/// empty text if `written` does not start with a number.
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

/// Returns whether a name occurs in a text outside its comments.
pub fn has_name(text: &str, name: &str) -> bool {
    // Most texts do not contain the name at all, so the lexer runs only if `text` contains it.
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
