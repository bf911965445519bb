//! The errors of the library's front.

use std::{io, path::PathBuf};

use thiserror::Error;

use crate::{diagnostic::Mistakes, film::SizesDiffer, render::RenderError};

/// Why something cannot be done with a scene or a picture.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// A text is no scene, or data are none.
    #[error(transparent)]
    Mistakes(#[from] Mistakes),
    /// There is not enough memory for a picture, or no thread can be started.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// Two pictures have different sizes.
    #[error(transparent)]
    SizesDiffer(#[from] SizesDiffer),
    /// Bytes are no picture that can be read.
    #[cfg(feature = "read")]
    #[error(transparent)]
    Unreadable(#[from] crate::film::Unreadable),
    /// A file cannot be read.
    #[error("cannot read {}: {error}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The reason.
        error: io::Error,
    },
    /// A file cannot be written.
    #[error("cannot write to {}: {error}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// The reason.
        error: io::Error,
    },
}
