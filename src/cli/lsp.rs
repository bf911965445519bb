//! `lsp`: runs the language server on standard input and output.

use std::io;

use super::{CommandError, Status, command_error, output};
use crate::{
    diagnostic::visible_line,
    lsp::{Server, stdio},
};

/// Serves an editor until it sends `exit` or disconnects.
pub fn run() -> Result<Status, CommandError> {
    let log = |message: &str| output::to_people(&format!("{}\n", visible_line(message)));
    let server = Server::new(log);
    match stdio::serve(server, io::stdin(), &mut io::stdout().lock(), log) {
        Ok(true) => Ok(Status::Done),
        // The Language Server Protocol requires exit status 1 if the client sends `exit` without
        // `shutdown`. `SceneErrors` has this status.
        Ok(false) => Ok(Status::Negative),
        Err(error) => Err(command_error(format!(
            "cannot write to standard output: {error}"
        ))),
    }
}
