//! The picture files of `--sweep`: their names, and which of them were rendered by an earlier run.

use std::{
    io::{BufReader, Read},
    path::{Path, PathBuf},
};

use super::{
    CommandError, command_error,
    input::{self, shown},
    picture::{FileFormat, PictureOutput},
};
use crate::{
    files,
    film::{self, Recipe},
};

/// Maximum number of digits that a pattern may ask for, such as 9 in `%09d`. A sweep has at most
/// 1000 pictures, so further digits would only be zeros.
const MOST_DIGITS: usize = 9;

/// Pattern of the paths of numbered pictures, such as `roll-%03d.png`.
pub struct FramePattern {
    before: String,
    after: String,
    /// Minimum number of digits. Zeros are put before a number with fewer digits.
    digits: usize,
}

impl FramePattern {
    /// Parses the output path of a sweep, from the argument of `-o`. The path must contain exactly
    /// one placeholder for the number of a picture, written as `%d` or, for example, `%03d`. A
    /// percent sign is written as `%%`.
    ///
    /// # Errors
    ///
    /// Returns an error if there is no path, if the path is not UTF-8, or if it does not contain
    /// exactly one placeholder.
    pub fn of(output: Option<&Path>) -> Result<Self, CommandError> {
        let named = output.filter(|path| !input::is_standard(path));
        let parsed = match named.map(|path| (path.to_str(), shown(path))) {
            None => Err("it takes `-o FILE`".to_owned()),
            Some((None, shown)) => Err(format!("{shown} is not UTF-8")),
            Some((Some(text), shown)) => Self::parsed(text)
                .ok_or_else(|| format!("{shown} has no single place for the number of a picture")),
        };
        parsed.map_err(|why| {
            command_error(format!(
                "a sweep makes several files, and {why}: write a name such as `-o 'roll-%03d.png'`, in which a number of three digits takes the place of `%03d` (`%d` for as many as it needs, `%%` for a percent sign)"
            ))
        })
    }

    /// Parses a pattern. Returns `None` if the pattern does not contain exactly one placeholder for
    /// a number.
    fn parsed(text: &str) -> Option<Self> {
        let mut parts = vec![String::new()];
        let mut digits = 0;
        let mut rest = text;
        while let Some((before, sign)) = rest.split_once('%') {
            let part = parts.last_mut()?;
            *part += before;
            if let Some(behind) = sign.strip_prefix('%') {
                part.push('%');
                rest = behind;
                continue;
            }
            let (width, behind) = sign.split_once('d')?;
            if !width.is_empty() {
                digits = width.strip_prefix('0')?.parse().ok()?;
            }
            parts.push(String::new());
            rest = behind;
        }
        *parts.last_mut()? += rest;
        let [before, after] = <[String; 2]>::try_from(parts).ok()?;
        (digits <= MOST_DIGITS).then_some(Self {
            before,
            after,
            digits,
        })
    }

    /// Returns the path of the picture with the index `number`.
    pub fn path(&self, number: usize) -> PathBuf {
        let (before, after, digits) = (&self.before, &self.after, self.digits);
        format!("{before}{number:0digits$}{after}").into()
    }
}

/// Returns whether the output's file already contains the picture of `recipe`. A PNG must store the
/// same scene, overrides and crop. An EXR file must store the recipe's digest and crop. Returns
/// `false` if the file cannot be read.
pub fn is_rendered(output: &PictureOutput, recipe: &Recipe) -> bool {
    let stored = || {
        let PictureOutput::File(path, format, _) = output else {
            return None;
        };
        let file = files::open(path).ok()?;
        if *format == FileFormat::Exr {
            let place = film::read_exr_place(BufReader::new(file)).ok()?;
            return Some(place.crop() == recipe.crop && place.digest == Some(recipe.digest()));
        }
        let mut start = Vec::new();
        let mut file = file.take(input::PICTURE_LIMIT);
        file.read_to_end(&mut start).ok()?;
        Some(film::read_recipe(&start).ok()? == *recipe)
    };
    stored() == Some(true)
}
