//! `lsp`: the language server, on standard input and output.

use std::io;

use pinhole::lsp::{self, Ended};

use super::{Status, Trouble, output};

/// Talks to an editor until it ends.
pub fn run() -> Result<Status, Trouble> {
    let log = |message: &str| output::to_people(&format!("{message}\n"));
    let ended = lsp::serve(io::stdin(), &mut io::stdout().lock(), log);
    match ended {
        Ok(Ended::Properly) => Ok(Status::Done),
        // The protocol asks for a status of 1.
        Ok(Ended::Abruptly) => Ok(Status::SceneErrors),
        Err(error) => Err(Trouble(format!("cannot write to standard output: {error}"))),
    }
}
