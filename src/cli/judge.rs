//! A scene that pictures are judged by: what `diff` and `grade` have in common.

use std::{num::NonZero, path::Path, sync::atomic::AtomicBool};

use pinhole::{
    area::Area,
    film::{self, Comparison, Picture, SizesDiffer, Tolerance},
    grading::{Jpeg, Reference, Verdict},
    render::{Control, Exact, RenderError},
    scene::Scene,
};

/// A scene, or a part of it, and its exact picture.
pub struct Judge<'a> {
    /// The part.
    pub part: Area,
    reference: Reference<'a>,
}

impl<'a> Judge<'a> {
    /// Makes the exact picture, on so many threads or as many as there are; `progress` counts its pixels.
    pub fn new(
        scene: &'a Scene,
        part: Area,
        threads: Option<NonZero<usize>>,
        cancel: &AtomicBool,
        progress: &(dyn Fn(u64) + Sync),
    ) -> Result<Self, RenderError> {
        let control = Control {
            threads,
            progress,
            cancel,
        };
        let reference = Reference::new(scene, part, &control)?;
        Ok(Self { part, reference })
    }

    /// The exact picture.
    pub fn exact(&self) -> &Exact {
        &self.reference.exact
    }

    /// How far a picture is from the exact one: beyond so many steps, and the exact picture's own bound.
    pub fn compare(&self, picture: &Picture, steps: f64) -> Result<Comparison, SizesDiffer> {
        film::compare(&picture.film, &self.exact().film, self.tolerance(steps))
    }

    /// So many steps, and the exact picture's own bound on top.
    pub fn tolerance(&self, steps: f64) -> Tolerance<'_> {
        Tolerance {
            steps,
            bounds: Some(&self.exact().bounds),
        }
    }

    /// What is wrong with a picture.
    pub fn judge(
        &self,
        picture: &Picture,
        jpeg: Option<Jpeg>,
        comparison: &Comparison,
        cancel: &AtomicBool,
    ) -> Result<Verdict, RenderError> {
        self.reference
            .judge(&picture.film, jpeg, comparison, cancel)
    }
}

/// The part of a scene that a picture shows: the crop that it carries, or all of it.
///
/// # Errors
///
/// Their sizes differ, in words that follow the picture's name.
pub fn part(picture: &Picture, scene: &Scene) -> Result<Area, String> {
    let [width, height] = [picture.film.width(), picture.film.height()];
    let whole = Area::whole(scene.image.width, scene.image.height);
    match picture.crop {
        Some(crop) if [crop.width, crop.height] == [width, height] => match crop.lies_in(whole) {
            true => Ok(crop),
            false => Err(format!(
                "is the part {crop} of a picture, which does not lie within the scene's {} × {} pixels",
                whole.width, whole.height
            )),
        },
        _ if [whole.width, whole.height] == [width, height] => Ok(whole),
        _ => Err(format!(
            "has {width} × {height} pixels, and the scene's picture {} × {}",
            whole.width, whole.height
        )),
    }
}

/// Whether a file's ending is that of a picture.
pub fn is_named_as_picture(path: &Path) -> bool {
    const ENDINGS: [&str; 14] = [
        "png", "exr", "jpg", "jpeg", "ppm", "pgm", "pnm", "pam", "bmp", "tif", "tiff", "webp",
        "gif", "pbm",
    ];
    path.extension()
        .is_some_and(|ending| ENDINGS.iter().any(|own| ending.eq_ignore_ascii_case(own)))
}

/// A `--set` argument as a shell takes it.
pub fn quoted(argument: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "._-+".contains(c);
    match argument.split_once('=') {
        Some((target, value)) if !value.chars().all(is_plain) => format!("{target}='{value}'"),
        _ => argument.to_owned(),
    }
}
