//! `lsp`: the language server, on standard input and output.

use std::{io, path::PathBuf};

use etcetera::BaseStrategy;
use pinhole::{
    diagnostic::visible,
    lsp::{Server, stdio},
};

use super::{Status, Trouble, output};

/// Talks to an editor until it ends.
pub fn run() -> Result<Status, Trouble> {
    let log = |message: &str| output::to_people(&format!("{}\n", visible(message)));
    let server = Server::new(pages(), log);
    match stdio::serve(server, io::stdin(), &mut io::stdout().lock(), log) {
        Ok(true) => Ok(Status::Done),
        // The protocol asks for a status of 1.
        Ok(false) => Ok(Status::SceneErrors),
        Err(error) => Err(Trouble(format!("cannot write to standard output: {error}"))),
    }
}

/// Where the pages that diagnostics link to are kept: with the user's caches, each version's own.
fn pages() -> Option<PathBuf> {
    let caches = etcetera::choose_base_strategy().ok()?.cache_dir();
    let own = concat!("explain-", env!("CARGO_PKG_VERSION"));
    Some(caches.join("pinhole").join(own))
}
