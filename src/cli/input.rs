//! Scenes from files, from standard input and from pictures.

use std::{
    fs,
    io::{self, Read},
    path::{Path, PathBuf},
};

use super::{
    Trouble,
    args::{LargeArgs, Overrides},
    interrupt::Interrupt,
    output,
};
use crate::{
    area::Area,
    diagnostic::{Diagnostic, Report, visible_line},
    files::{self, NotWritten, Original, Purpose},
    film::{self, Recipe, SIGNATURE, read_recipe},
    scene::{self, Reading},
    source::{Source, Sources},
};

/// A scene file with more bytes than this is not read: it is not one.
const SCENE_LIMIT: u64 = 256 << 20;

/// So much of a picture is read: more than enough for what may stand before its pixels.
const PICTURE_LIMIT: u64 = 8 << 20;

/// So many bytes of a file say whether it is a picture, also after a program's other words.
const START: u64 = 1 << 16;

/// What a scene is read from.
pub struct Input {
    /// The scene's text and the overrides, those that a picture carries before those of the
    /// command line.
    pub sources: Sources,
    /// Whether it is a picture that carries the scene.
    pub is_picture: bool,
    /// The crop that the picture carries.
    pub crop: Option<Area>,
}

/// Whether SCENE or FILE is `-`.
pub fn is_standard(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// Refuses to read standard input twice.
pub fn check_standard(paths: &[PathBuf]) -> Result<(), Trouble> {
    match paths.iter().filter(|path| is_standard(path)).count() {
        0 | 1 => Ok(()),
        _ => Err(Trouble(
            "standard input can be read once only, and `-` is given twice".to_owned(),
        )),
    }
}

impl Input {
    /// Reads what SCENE names.
    pub fn read(path: &Path, overrides: &Overrides) -> Result<Self, Trouble> {
        let bytes = argument(path).and_then(limited);
        let bytes = bytes.map_err(|error| unreadable(path, &error))?;
        Self::of_bytes(path, bytes, overrides)
    }

    /// Reads a text that is to be written back, and what it was; `command` says what is done with
    /// it. Of standard input there is nothing to write back to.
    pub fn to_change(
        path: &Path,
        overrides: &Overrides,
        command: &str,
    ) -> Result<(Self, Option<Original>), Trouble> {
        let (input, original) = if is_standard(path) {
            (Self::read(path, overrides)?, None)
        } else {
            // What is written into a pipe comes back to nobody.
            let original = Original::read(path, bytes).map_err(|error| match error.kind() {
                io::ErrorKind::InvalidInput => {
                    let hint = format!("{command} takes files, or standard input as `-`");
                    unreadable(path, &format!("{error}; {hint}"))
                }
                _ => unreadable(path, &error),
            })?;
            name_copies(path);
            let bytes = original.bytes().unwrap_or_default().to_owned();
            (Self::of_bytes(path, bytes, overrides)?, Some(original))
        };
        match input.is_picture {
            true => Err(Trouble(format!(
                "{} is a picture; {command} takes the scene's text",
                shown(path)
            ))),
            false => Ok((input, original)),
        }
    }

    fn of_bytes(path: &Path, bytes: Vec<u8>, overrides: &Overrides) -> Result<Self, Trouble> {
        let name = path.display().to_string();
        let mut input = if bytes.starts_with(&SIGNATURE) {
            let recipe = read_recipe(&bytes).map_err(|error| unreadable(path, &error))?;
            Self::from_picture(name, recipe)
        } else {
            Self::from_text(name, bytes)
        };
        input.add(overrides);
        Ok(input)
    }

    /// What the bytes of a scene's file say.
    pub fn of(path: &Path, bytes: Vec<u8>, overrides: &Overrides) -> Self {
        let mut input = Self::from_text(path.display().to_string(), bytes);
        input.add(overrides);
        input
    }

    fn from_text(name: String, bytes: Vec<u8>) -> Self {
        Self {
            sources: Sources::new(Source::from_bytes(name, bytes)),
            is_picture: false,
            crop: None,
        }
    }

    fn add(&mut self, overrides: &Overrides) {
        // Numbered as on the command line, whatever a picture carries.
        let sets = (1..).zip(&overrides.sets);
        let sets = sets.map(|(number, set)| Source::from_text(format!("--set #{number}"), set));
        self.sources.sets.extend(sets);
    }

    fn from_picture(name: String, recipe: Recipe) -> Self {
        let sets = (1..)
            .zip(recipe.overrides)
            .map(|(number, set)| Source::from_text(format!("{name}, --set #{number}"), set));
        let mut sources = Sources::new(Source::from_text(name.clone(), recipe.scene));
        sources.sets.extend(sets);
        Self {
            sources,
            is_picture: true,
            crop: recipe.crop,
        }
    }

    /// Reads the scene, and reports its problems to people. That objects lie outside of the picture
    /// is said by commands for the text: for others, such as each frame of a ride, it may be meant.
    pub fn scene(&self) -> Reading {
        let mut reading = scene::read(&self.sources);
        let is_of_text = |it: &Diagnostic| it.code == "pinhole::outside_picture";
        reading.diagnostics.retain(|it| !is_of_text(it));
        output::to_people(&self.report(&reading));
        reading
    }

    /// The problems of the scene, for people.
    pub fn report(&self, reading: &Reading) -> String {
        Report::new(&self.sources, output::style()).human(&reading.diagnostics)
    }

    /// The scene's text with the overrides, for a picture to carry.
    pub fn recipe(&self, crop: Option<Area>) -> Recipe {
        let sets = self.sources.sets.iter();
        Recipe {
            scene: self.sources.file.text().to_owned(),
            overrides: sets.map(|set| set.text().to_owned()).collect(),
            crop,
        }
    }
}

/// What SCENE or FILE is called in a message: on one line, whatever its name holds.
pub fn shown(path: &Path) -> String {
    visible_line(&path.display().to_string()).into_owned()
}

/// Names the copies of a file that were left by processes that were killed while they wrote it.
pub fn name_copies(path: &Path) {
    for copy in files::copies_left(path) {
        let (copy, path) = (shown(&copy), shown(path));
        output::warning(&format!(
            "{copy} was left by a program that was ended while it wrote {path}, and may hold what should be there; remove it if not"
        ));
    }
}

/// Says that a path cannot be read.
pub fn unreadable(path: &Path, error: &dyn std::fmt::Display) -> Trouble {
    Trouble(format!("cannot read {}: {error}", shown(path)))
}

/// Says that a path cannot be written to.
pub fn unwritable(path: &Path, error: &dyn std::fmt::Display) -> Trouble {
    Trouble(format!("cannot write to {}: {error}", shown(path)))
}

/// Says why a folder does not get what was made for it.
pub fn not_written(why: NotWritten) -> Trouble {
    unwritable(&why.path, &why.error)
}

/// Changes the text of a file, if it still is what was read.
pub fn change(
    path: &Path,
    original: &Original,
    text: &str,
    interrupt: &Interrupt,
) -> Result<(), Trouble> {
    let purpose = Purpose::Change(original);
    files::write(path, purpose, interrupt.watch(), |out| {
        out.write_all(text.as_bytes())
    })
    .map_err(|error| unwritable(path, &error))
}

/// Whether two paths lead to one file.
pub fn is_same_file(a: &Path, b: &Path) -> bool {
    match (fs::canonicalize(a), fs::canonicalize(b)) {
        (Ok(a), Ok(b)) => a == b,
        _ => false,
    }
}

/// What a file of a comparison is.
pub enum Compared {
    /// A picture: the whole of it.
    Picture(Vec<u8>),
    /// Something else: as much as a scene may have.
    Other(Vec<u8>),
}

/// Reads a picture, or as much of another file as `most`. Its first bytes say which it is, before
/// the others are read.
pub fn compared(path: &Path, large: &LargeArgs, most: Most) -> io::Result<Compared> {
    let (mut from, length) = opened(path)?;
    let start = files::read_from(from.by_ref().take(START), START)?;
    let is_picture = film::is_picture(&start)
        || matches!(most, Most::Start) && film::is_picture_behind_lines(&start);
    let limit = match (is_picture, most) {
        (true, _) => large.file_limit(),
        (false, Most::Scene) => SCENE_LIMIT,
        (false, Most::Start) => return Ok(Compared::Other(start)),
    };
    let too_large = |error: io::Error| match (error.kind(), is_picture) {
        (io::ErrorKind::FileTooLarge, true) => io::Error::other(large.hint("bytes", limit)),
        (io::ErrorKind::FileTooLarge, false) => no_scene(),
        _ => error,
    };
    if length.is_some_and(|length| length > limit) {
        return Err(too_large(io::ErrorKind::FileTooLarge.into()));
    }
    let whole = io::Cursor::new(start).chain(from);
    let bytes = files::read_from(whole, limit).map_err(too_large)?;
    Ok(match is_picture {
        true => Compared::Picture(bytes),
        false => Compared::Other(bytes),
    })
}

/// What is read of a file that is no picture.
pub enum Most {
    /// What a scene may have.
    Scene,
    /// What says that it is none.
    Start,
}

/// The bytes of a scene's file, or as much of a picture as can matter. Whatever is no file is
/// refused.
pub fn bytes(path: &Path) -> io::Result<Vec<u8>> {
    limited(files::open(path)?)
}

/// What SCENE or PICTURE names, to be read.
fn argument(path: &Path) -> io::Result<Box<dyn Read>> {
    opened(path).map(|(from, _)| from)
}

/// The same, with its length if it is a file.
fn opened(path: &Path) -> io::Result<(Box<dyn Read>, Option<u64>)> {
    if is_standard(path) {
        return Ok((Box::new(io::stdin().lock()), None));
    }
    let file = files::open_argument(path)?;
    let length = file.metadata().ok().filter(fs::Metadata::is_file);
    Ok((Box::new(file), length.map(|found| found.len())))
}

/// Reads a scene, or as much of a picture as can matter.
fn limited(mut from: impl Read) -> io::Result<Vec<u8>> {
    let start = files::read_from(from.by_ref().take(START), START)?;
    let is_picture = start.starts_with(&SIGNATURE);
    let whole = io::Cursor::new(start).chain(from);
    match is_picture {
        true => files::read_from(whole.take(PICTURE_LIMIT), PICTURE_LIMIT),
        false => files::read_from(whole, SCENE_LIMIT).map_err(|error| match error.kind() {
            io::ErrorKind::FileTooLarge => no_scene(),
            _ => error,
        }),
    }
}

fn no_scene() -> io::Error {
    io::Error::other("it has more than 256 MiB, too much for a scene")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Fails as a disk does.
    struct Broken;

    impl Read for Broken {
        fn read(&mut self, _: &mut [u8]) -> io::Result<usize> {
            Err(io::Error::from_raw_os_error(5))
        }
    }

    #[test]
    fn the_limit_of_a_scene_is_its_last_length() {
        for (length, is_read) in [(SCENE_LIMIT, true), (SCENE_LIMIT + 1, false)] {
            let read = limited(io::repeat(b' ').take(length));
            assert_eq!(read.is_ok(), is_read, "{length}");
        }
        let picture = SIGNATURE.as_slice().chain(io::repeat(0));
        assert_eq!(limited(picture).unwrap().len() as u64, PICTURE_LIMIT);
    }

    #[test]
    fn what_the_system_says_of_a_read_is_in_words() {
        for start in [0, 1, START] {
            let error = limited(io::repeat(b' ').take(start).chain(Broken)).unwrap_err();
            assert!(!error.to_string().contains("os error"), "{error}");
        }
    }
}
