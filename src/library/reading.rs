//! Pictures of other programs: reads them from files, and judges them.

use std::{path::Path, sync::Arc};

use super::{Error, Picture, Scene};
use crate::{
    cancel, files,
    film::{self, DECODED_LIMIT, Jpeg, SizesDiffer, Unreadable},
    grading::{Reference, Verdict},
    render::Control,
    source::{Source, Sources},
};

impl Picture {
    /// Reads a picture file: PNG, OpenEXR, PNM, BMP, TIFF, WebP, GIF or JPEG.
    ///
    /// ```
    /// let picture = pinhole::Picture::open("examples/figure_9_9.png")?;
    /// assert_eq!((picture.width(), picture.height()), (1280, 720));
    /// # Ok::<(), pinhole::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// The file cannot be read, is no picture, or is decoded to more than [`DECODED_LIMIT`] bytes.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let bytes = files::read(path, DECODED_LIMIT).map_err(|error| Error::Read {
            path: path.to_owned(),
            error,
        })?;
        Self::read(&bytes).map_err(|error| Error::NoPicture {
            path: path.to_owned(),
            error,
        })
    }

    /// Reads a picture from the bytes of a file, as [`open`](Self::open) does.
    ///
    /// # Errors
    ///
    /// The bytes are no picture, or are decoded to more than [`DECODED_LIMIT`] bytes.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Error> {
        Ok(Self::read(bytes)?)
    }

    fn read(bytes: &[u8]) -> Result<Self, Unreadable> {
        let sources = film::read_recipe(bytes).ok().map(|recipe| {
            let text = Source::from_text("scene", recipe.scene);
            Arc::new(Sources::new(text).with_sets(recipe.overrides))
        });
        Ok(Self {
            coded: film::read_picture(bytes)?,
            jpeg: Jpeg::of(bytes),
            sources,
        })
    }
}

impl Scene {
    /// Judges a picture that another program made of the scene. The verdict says whether it is
    /// right, right except for sampling noise, or wrong, and which mistakes explain the
    /// differences. For many pictures of one scene, use [`Reference`], which computes the exact
    /// picture only once.
    ///
    /// ```
    /// # let scene = pinhole::Scene::parse("camera { eye (0, 2, 8)  lookat (0, 1, 0) }
    /// #     sphere { center (0, 1, 0) }  checkerboard {}  image { width 64  height 48 }")?;
    /// let theirs = scene.with_set("camera.up=(0, -1, 0)")?.render()?;
    /// let verdict = scene.grade(&theirs)?;
    /// assert!(verdict.to_string().starts_with("wrong"), "{verdict}");
    /// # Ok::<(), pinhole::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// The picture has another size than the scene, and its file does not say which part of the
    /// scene it shows. Or the file names a part that does not lie in the scene's picture. Or there
    /// is not enough memory, or no thread can be started.
    pub fn grade(&self, picture: &Picture) -> Result<Verdict, Error> {
        let file = &picture.coded;
        let size = [picture.width(), picture.height()];
        let whole = [self.size().width, self.size().height];
        let part = match file.crop {
            Some(crop) if [crop.width, crop.height] == size => crop,
            _ if size == whole => self.size(),
            _ => return Err(SizesDiffer(size, whole).into()),
        };
        let reference = Reference::new(self.data(), part, file.rounding, &Control::default())?;
        let comparison = reference.compare(&file.film, file.rounding.steps())?;
        Ok(reference.judge(file, picture.jpeg, &comparison, &cancel::NEVER)?)
    }
}
