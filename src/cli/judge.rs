//! Reads pictures that are compared with a scene, for `diff` and `grade`.

use std::path::Path;

use super::args::LargeArgs;
use crate::{
    area::Area,
    film::{self, Picture, Unreadable},
    scene::Scene,
};

/// Decodes a picture. Unless `--large` was given, a picture that is too large is rejected.
///
/// # Errors
///
/// Returns a message that says why if the picture cannot be decoded.
pub fn picture(bytes: &[u8], large: &LargeArgs) -> Result<Picture, String> {
    film::read_picture_up_to(bytes, large.decoded_limit()).map_err(|error| match error {
        Unreadable::Large { .. } if !large.large => format!("{error}: `--large` reads it"),
        error => error.to_string(),
    })
}

/// Returns the area of the scene that a picture shows. If the picture's file contains a crop, this
/// is the crop. Otherwise, it is the crop `named` on the command line or, if there is none, the
/// whole scene. A crop whose size differs from the picture's is ignored.
///
/// # Errors
///
/// Returns a message if neither a crop nor the whole scene has the picture's size, or if the crop
/// does not lie within the scene. The message is the end of a sentence that begins with the
/// picture's name.
pub fn part(picture: &Picture, scene: &Scene, named: Option<Area>) -> Result<Area, String> {
    let [width, height] = [picture.film.width(), picture.film.height()];
    let whole = Area::whole(scene.image.width, scene.image.height);
    let has_size = |area: &Area| [area.width, area.height] == [width, height];
    match picture.crop.or(named.filter(has_size)).filter(has_size) {
        Some(crop) if crop.lies_in(whole) => Ok(crop),
        Some(crop) => Err(format!(
            "is the part {crop} of a picture, which does not lie within the scene's {} × {} pixels",
            whole.width, whole.height
        )),
        None if has_size(&whole) => Ok(whole),
        None => Err(format!(
            "has {width} × {height} pixels, and the scene's picture {} × {}{}",
            whole.width,
            whole.height,
            way_out([width, height], whole)
        )),
    }
}

/// Returns advice on how to compare a picture whose size differs from the scene's. Returns an empty
/// text if there is no advice.
fn way_out([width, height]: [u32; 2], whole: Area) -> String {
    let [w, h] = [whole.width, whole.height];
    let is_scaled = u64::from(width) * u64::from(h) == u64::from(height) * u64::from(w);
    if is_scaled {
        format!(
            ": `--set image.width={width} --set image.height={height}` compares it with the scene in its size"
        )
    } else if [width, height] == [h, w] {
        ": its width and height are exchanged".to_owned()
    } else if width <= w && height <= h {
        format!(
            ": if it is a part of it, `--crop X,Y,{width},{height}` says which, X pixels from the left and Y from the top"
        )
    } else {
        String::new()
    }
}

/// Returns whether a path has the extension of a picture format.
pub fn is_named_as_picture(path: &Path) -> bool {
    const ENDINGS: [&str; 14] = [
        "png", "exr", "jpg", "jpeg", "ppm", "pgm", "pnm", "pam", "bmp", "tif", "tiff", "webp",
        "gif", "pbm",
    ];
    path.extension()
        .is_some_and(|ending| ENDINGS.iter().any(|own| ending.eq_ignore_ascii_case(own)))
}

/// Quotes the value in a `--set` argument for a shell, if a shell would not take it literally.
pub fn quoted(argument: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "._-+".contains(c);
    match argument.split_once('=') {
        Some((target, value)) if !value.chars().all(is_plain) => format!("{target}='{value}'"),
        _ => argument.to_owned(),
    }
}
