//! Pictures that are judged by a scene: what `diff` and `grade` have in common.

use std::path::Path;

use super::args::LargeArgs;
use crate::{
    area::Area,
    film::{self, Picture, Unreadable},
    scene::Scene,
};

/// Reads a picture, unless it is larger than is wanted.
///
/// # Errors
///
/// Why it cannot be read.
pub fn picture(bytes: &[u8], large: &LargeArgs) -> Result<Picture, String> {
    film::read_picture_up_to(bytes, large.decoded_limit()).map_err(|error| match error {
        Unreadable::Large { .. } if !large.large => format!("{error}: `--large` reads it"),
        error => error.to_string(),
    })
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
            "has {width} × {height} pixels, and the scene's picture {} × {}{}",
            whole.width,
            whole.height,
            way_out([width, height], [whole.width, whole.height])
        )),
    }
}

/// What makes a picture of another size comparable, in words that follow both sizes.
fn way_out([width, height]: [u32; 2], [own_width, own_height]: [u32; 2]) -> String {
    let product = |a: u32, b: u32| u64::from(a) * u64::from(b);
    if [width, height] == [own_height, own_width] {
        return ": its width and its height are exchanged".to_owned();
    }
    // Of the same proportions, to within a pixel.
    let off = product(width, own_height).abs_diff(product(height, own_width));
    match off <= u64::from(own_width.max(own_height)) {
        true => format!(
            ": --set image.width={width} --set image.height={height} makes the scene's as large"
        ),
        false => String::new(),
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
