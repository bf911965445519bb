//! Opens scenes from files: from text files, or from PNG files that contain their scene.

use std::{io, path::Path};

use super::{Error, Scene};
use crate::{
    files,
    film::{self, NotOurs},
    source::{Source, Sources},
};

impl Scene {
    /// Reads a scene from a text file, or from a PNG file that contains the scene. Mistakes are
    /// reported with the file's path.
    ///
    /// ```
    /// let scene = pinhole::Scene::open("examples/figure_9_9.scn")?;
    /// let same = pinhole::Scene::open("examples/figure_9_9.png")?;
    /// assert_eq!(scene.data(), same.data());
    /// # Ok::<(), pinhole::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// The file cannot be read, the text has mistakes, or the picture does not carry its scene.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let not_read = |error| Error::Read {
            path: path.to_owned(),
            error,
        };
        let bytes = files::read(path, u64::MAX).map_err(not_read)?;
        let name = path.display().to_string();
        if !bytes.starts_with(&film::SIGNATURE) {
            return Ok(Self::read(Sources::new(Source::from_bytes(name, bytes)))?);
        }
        let recipe = film::read_recipe(&bytes).map_err(|error| match error {
            NotOurs::NoScene => Error::NoScene,
            damaged => not_read(io::Error::new(io::ErrorKind::InvalidData, damaged)),
        })?;
        let text = Source::from_text(name, recipe.scene);
        Ok(Self::read(Sources::new(text).with_sets(recipe.overrides))?)
    }
}
