//! Writes pictures to files.

use std::{io, path::Path};

use super::{Error, Picture};
#[cfg(feature = "exr")]
use crate::area::Area;
use crate::{
    cancel,
    files::{self, Purpose},
    film,
};

impl Picture {
    /// Writes the picture to a file, completely or not at all. The path's extension selects the
    /// format: `.png` for 8-bit sRGB, with the scene's text in the file, or `.exr` for linear light
    /// in floats. The program `pinhole` writes the same bytes.
    ///
    /// A PNG does not contain the scene if its text and settings are together longer than
    /// [`film::TEXT_LIMIT`], or if there are more than [`film::OVERRIDES_LIMIT`] settings. In the
    /// second case, pass the scene's data to [`Scene::from_data`](super::Scene::from_data), which
    /// makes an equal scene without settings.
    ///
    /// ```
    /// # let folder = tempfile::tempdir().unwrap();
    /// # let path = folder.path().join("a.png");
    /// # let scene = pinhole::Scene::parse("camera { eye (0, 2, 8)  lookat (0, 1, 0) }
    /// #     checkerboard {}  image { width 40  height 30 }")?;
    /// scene.render()?.save(&path)?;
    /// # Ok::<(), pinhole::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// The path's extension is neither `.png` nor `.exr`, the crate was compiled without the
    /// feature of the format, or the file cannot be written.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        let path = path.as_ref();
        let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
        let written = match ending.to_str() {
            #[cfg(feature = "png")]
            Some("png") => files::write(path, Purpose::Named, &cancel::NEVER, |out| {
                film::write_png(self.film(), self.recipe().as_ref(), out)
            }),
            #[cfg(feature = "exr")]
            Some("exr") => files::write(path, Purpose::Named, &cancel::NEVER, |out| {
                let [part, whole] = self.place();
                let own = self.recipe().map(|recipe| recipe.digest());
                let digest = own.or_else(|| self.coded.digest.clone());
                film::write_exr(self.film(), part, whole, digest.as_deref(), out)
            }),
            ending => {
                let message = match ending {
                    Some("png") => "the crate was compiled without its feature `png`",
                    Some("exr") => "the crate was compiled without its feature `exr`",
                    _ => "a picture's file ends in .png or .exr",
                };
                Err(io::Error::new(io::ErrorKind::InvalidInput, message))
            }
        };
        written.map_err(|error| Error::Write {
            path: path.to_owned(),
            error,
        })
    }

    /// Returns the area that the picture shows and the area of the whole picture. They differ only
    /// if the picture shows a part of a scene and it is known which part.
    #[cfg(feature = "exr")]
    fn place(&self) -> [Area; 2] {
        let own = Area::whole(self.width(), self.height());
        match (self.coded.crop, self.coded.size) {
            (Some(part), Some([width, height]))
                if part.lies_in(Area::whole(width, height))
                    && [part.width, part.height] == [own.width, own.height] =>
            {
                [part, Area::whole(width, height)]
            }
            _ => [own, own],
        }
    }

    /// Returns the scene's text and its settings (`--set` arguments) in the form in which a PNG
    /// stores them. Returns `None` if they are unknown.
    fn recipe(&self) -> Option<film::Recipe> {
        let sources = self.sources()?;
        Some(film::Recipe {
            scene: sources.file.text().to_owned(),
            overrides: sources
                .sets
                .iter()
                .map(|set| set.text().to_owned())
                .collect(),
            crop: self.coded.crop,
            size: self.coded.size,
        })
    }
}
