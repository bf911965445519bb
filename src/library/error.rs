//! The error type of the library's main types, [`Scene`](super::Scene) and
//! [`Picture`](super::Picture).

use std::{io, path::PathBuf};

use thiserror::Error;

use crate::{
    diagnostic::Mistakes,
    film::{SizesDiffer, TooLarge, WrongPixelCount},
    render::RenderError,
    schema::UnknownMethod,
};

/// Why an operation on a scene or a picture failed. Errors of other modules, and input and output
/// errors, are converted to it by `?`.
///
/// ```
/// use pinhole::{Method, Scene, film::Film};
///
/// fn render_as(method: &str) -> Result<(), pinhole::Error> {
///     let method: Method = method.parse()?;
///     let mut data = Scene::parse(&std::fs::read_to_string("examples/figure_9_9.scn")?)?
///         .data()
///         .clone();
///     data.sampler.method = method;
///     let scene = Scene::from_data(&data)?;
///     let black: Film = Film::new(data.image.width, data.image.height)?;
///     assert_eq!(scene.data().image.width, black.width());
///     Ok(())
/// }
///
/// assert!(render_as("sobol").is_ok());
/// assert!(render_as("sobel").is_err());
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// The text or the data are not a valid scene. All mistakes are listed.
    #[error(transparent)]
    Mistakes(#[from] Mistakes),
    /// A picture cannot be rendered: there is not enough memory, no thread can be started, the area
    /// to render does not lie in the picture, or the render was cancelled.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// Two pictures have different sizes.
    #[error(transparent)]
    SizesDiffer(#[from] SizesDiffer),
    /// The number of pixels is not width · height, or is 0.
    #[error(transparent)]
    WrongPixelCount(#[from] WrongPixelCount),
    /// The bytes are not a picture that can be read.
    #[cfg(feature = "read")]
    #[error(transparent)]
    Unreadable(#[from] crate::film::Unreadable),
    /// A file is not a picture that can be read.
    #[cfg(feature = "read")]
    #[error("cannot read {}: {error}", path.display())]
    NoPicture {
        /// Path of the file.
        path: PathBuf,
        /// Reason why the file is no picture that can be read.
        error: crate::film::Unreadable,
    },
    /// A picture does not carry its scene.
    #[error("the picture carries no scene")]
    NoScene,
    /// A word is not the name of a sampling method.
    #[error(transparent)]
    UnknownMethod(#[from] UnknownMethod),
    /// A function of the standard library failed to read or write.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// A file cannot be read.
    #[error("cannot read {}: {error}", path.display())]
    Read {
        /// Path of the file.
        path: PathBuf,
        /// Reason why the file cannot be read.
        error: io::Error,
    },
    /// A file cannot be written.
    #[error("cannot write to {}: {error}", path.display())]
    Write {
        /// Path of the file.
        path: PathBuf,
        /// Reason why the file cannot be written.
        error: io::Error,
    },
}

/// Makes the error of a film that is too large for the memory.
impl From<TooLarge> for Error {
    fn from(error: TooLarge) -> Self {
        Self::Render(error.into())
    }
}
