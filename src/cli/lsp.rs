//! `lsp`: the language server, on standard input and output.

use std::{io, path::PathBuf};

use etcetera::BaseStrategy;
use pinhole::lsp::{self, Ended};

use super::{Status, Trouble, output};

/// Talks to an editor until it ends.
pub fn run() -> Result<Status, Trouble> {
    let log = |message: &str| output::to_people(&format!("{message}\n"));
    let ended = lsp::serve(io::stdin(), &mut io::stdout().lock(), pages(), log);
    match ended {
        Ok(Ended::Properly) => Ok(Status::Done),
        // The protocol asks for a status of 1.
        Ok(Ended::Abruptly) => Ok(Status::SceneErrors),
        Err(error) => Err(Trouble(format!("cannot write to standard output: {error}"))),
    }
}

/// Where the pages that diagnostics link to are kept: with the user's caches, each version's own.
fn pages() -> Option<PathBuf> {
    let caches = etcetera::choose_base_strategy().ok()?.cache_dir();
    let own = concat!("explain-", env!("CARGO_PKG_VERSION"));
    Some(caches.join("pinhole").join(own))
}
