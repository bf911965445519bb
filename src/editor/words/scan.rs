//! A text cut into words and signs, by the language's one lexer.

use super::{Role, Token, file};
use crate::{
    source::Span,
    syntax::tokens::{Lexer, TokenKind},
};

/// The tokens without their roles, as far as those follow from places. None reaches into a comment.
pub fn scan(text: &str, comments: &[Span]) -> Vec<Token> {
    let mut tokens = Vec::with_capacity(text.len() / 4);
    let mut comments = comments.iter().peekable();
    let mut lexer = Lexer::new(text, 0);
    loop {
        let token = lexer.token();
        // What recovery took for a comment need not begin as one.
        if let Some(comment) = comments.next_if(|comment| comment.start <= token.start)
            && comment.end > token.start
        {
            lexer = Lexer::new(text, comment.end);
            continue;
        }
        let role = match token.kind {
            TokenKind::Name => Role::Name,
            TokenKind::Number => Role::Number,
            TokenKind::Color => Role::ColorCode,
            TokenKind::Quoted | TokenKind::Word => Role::Other,
            TokenKind::Sign => sign(text.get(token.start..token.end).unwrap_or_default()),
            TokenKind::Comment | TokenKind::OpenComment | TokenKind::OddSpace => continue,
            TokenKind::End => return tokens,
        };
        let span = file(token.start, token.end);
        tokens.push(Token { span, role });
    }
}

fn sign(sign: &str) -> Role {
    match sign {
        "+" | "-" | "*" | "/" => Role::Operator,
        "=" => Role::Equals,
        "{" => Role::Open,
        "}" => Role::Close,
        "(" => Role::OpenList,
        ")" => Role::CloseList,
        "," => Role::Comma,
        _ => Role::Other,
    }
}
