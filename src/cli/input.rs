//! Reads scenes from files, from standard input and from pictures.

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

/// Maximum length of a scene's file, in bytes. A longer file is rejected.
const SCENE_LIMIT: u64 = 256 << 20;

/// Number of bytes of a picture that are read to find the scene in it. The chunks of a [`Recipe`]
/// before the pixels are shorter.
const PICTURE_LIMIT: u64 = 8 << 20;

/// Number of bytes at the start of a file that decide whether the file is a picture. Before the
/// picture, a program may have printed lines into the file, but not more than this.
const START: u64 = 1 << 16;

/// A scene as it was read, before parsing.
pub struct SceneInput {
    /// The scene's text and its overrides: first those that a picture carries, then those on the
    /// command line.
    pub sources: Sources,
    /// Whether the scene was read from a picture that carries it.
    pub is_picture: bool,
    /// The crop that the picture carries, if there is one.
    pub crop: Option<Area>,
}

/// Returns whether the argument is `-`, which stands for standard input or output.
pub fn is_standard(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// Rejects arguments that would read standard input twice.
pub fn check_standard(paths: &[PathBuf]) -> Result<(), Trouble> {
    match paths.iter().filter(|path| is_standard(path)).count() {
        0 | 1 => Ok(()),
        _ => Err(Trouble(
            "standard input can be read once only, and `-` is given twice".to_owned(),
        )),
    }
}

impl SceneInput {
    /// Reads the scene that the argument `path` names, with the overrides.
    pub fn read(path: &Path, overrides: &Overrides) -> Result<Self, Trouble> {
        let bytes = argument(path).and_then(limited);
        let bytes = bytes.map_err(|error| unreadable(path, &error))?;
        Self::of_bytes(path, bytes, overrides)
    }

    /// Reads a text that the command `command` will change. Also returns the original of its file,
    /// or `None` for standard input. Fails for pipes.
    pub fn to_change(
        path: &Path,
        overrides: &Overrides,
        command: &str,
    ) -> Result<(Self, Option<Original>), Trouble> {
        let (input, original) = if is_standard(path) {
            (Self::read(path, overrides)?, None)
        } else {
            // Pipes are rejected, since writing to a pipe would not change the text that was read.
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
        if input.is_picture {
            return Err(Trouble(format!(
                "{} is a picture; {command} takes the scene's text",
                shown(path)
            )));
        }
        Ok((input, original))
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

    /// Makes the input from `bytes`, the text of the scene's file `path`.
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
        // The number in the name of an override counts only the arguments on the command line, not
        // the overrides that a picture carries.
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

    /// Reads the scene, and reports its problems to the user. Objects outside of the picture are
    /// not reported, since they may be intended, for example in one frame of an animation. The
    /// commands that check the text itself report them.
    pub fn scene(&self) -> Reading {
        let mut reading = scene::read(&self.sources);
        let is_of_text = |it: &Diagnostic| it.code == "pinhole::outside_picture";
        reading.diagnostics.retain(|it| !is_of_text(it));
        output::to_people(&self.report(&reading));
        reading
    }

    /// Returns the report about the scene's problems as readable text.
    pub fn report(&self, reading: &Reading) -> String {
        Report::new(&self.sources, output::style()).human(&reading.diagnostics)
    }

    /// Returns the scene's text and the overrides, for a picture to carry.
    pub fn recipe(&self, crop: Option<Area>) -> Recipe {
        let sets = self.sources.sets.iter();
        Recipe {
            scene: self.sources.file.text().to_owned(),
            overrides: sets.map(|set| set.text().to_owned()).collect(),
            crop,
        }
    }
}

/// Returns the name of a path for messages: on one line, with control characters made visible.
pub fn shown(path: &Path) -> String {
    visible_line(&path.display().to_string()).into_owned()
}

/// Warns about copies of a file that were left by processes that were killed while they wrote the
/// file.
pub fn name_copies(path: &Path) {
    for copy in files::copies_left(path) {
        let (copy, path) = (shown(&copy), shown(path));
        output::warning(&format!(
            "{copy} was left by a program that was ended while it wrote {path}, and may hold what should be there; remove it if not"
        ));
    }
}

/// Makes the error message that a path cannot be read.
pub fn unreadable(path: &Path, error: &dyn std::fmt::Display) -> Trouble {
    Trouble(format!("cannot read {}: {error}", shown(path)))
}

/// Makes the error message that a path cannot be written to.
pub fn unwritable(path: &Path, error: &dyn std::fmt::Display) -> Trouble {
    Trouble(format!("cannot write to {}: {error}", shown(path)))
}

/// Makes the error message that files cannot be written into an output folder.
pub fn not_written(why: NotWritten) -> Trouble {
    unwritable(&why.path, &why.error)
}

/// Replaces the text of a file. Fails if the file is no longer what was read.
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

/// Returns whether two paths lead to the same existing file.
pub fn is_same_file(a: &Path, b: &Path) -> bool {
    match (fs::canonicalize(a), fs::canonicalize(b)) {
        (Ok(a), Ok(b)) => a == b,
        _ => false,
    }
}

/// The bytes of an argument that should be a picture.
pub enum FileBytes {
    /// All bytes of a picture.
    Picture(Vec<u8>),
    /// Bytes of another file: all of them or only the first, as [`IfNotPicture`] says.
    Other(Vec<u8>),
}

/// Reads a picture. If the first bytes show that the file is no picture, reads as much of it as
/// `if_not_picture` says.
pub fn read_picture_or(
    path: &Path,
    large: &LargeArgs,
    if_not_picture: IfNotPicture,
) -> io::Result<FileBytes> {
    let (mut from, length) = opened(path)?;
    let start = files::read_from(from.by_ref().take(START), START)?;
    let is_picture = film::is_picture(&start)
        || matches!(if_not_picture, IfNotPicture::ReadStart)
            && film::is_picture_behind_lines(&start);
    let limit = match (is_picture, if_not_picture) {
        (true, _) => large.file_limit(),
        (false, IfNotPicture::ReadScene) => SCENE_LIMIT,
        (false, IfNotPicture::ReadStart) => return Ok(FileBytes::Other(start)),
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
    Ok(if is_picture {
        FileBytes::Picture(bytes)
    } else {
        FileBytes::Other(bytes)
    })
}

/// How much is read of a file that is not a picture.
pub enum IfNotPicture {
    /// The whole file, up to the maximum length of a scene.
    ReadScene,
    /// Only the first bytes, which show that the file is not a picture.
    ReadStart,
}

/// Reads the bytes of a scene's file, or the start of a picture, which contains the scene. Fails
/// unless the path is a regular file.
pub fn bytes(path: &Path) -> io::Result<Vec<u8>> {
    limited(files::open(path)?)
}

/// Opens the argument SCENE or PICTURE for reading.
fn argument(path: &Path) -> io::Result<Box<dyn Read>> {
    opened(path).map(|(from, _)| from)
}

/// Opens an argument for reading. Also returns its length in bytes if it is a regular file.
fn opened(path: &Path) -> io::Result<(Box<dyn Read>, Option<u64>)> {
    if is_standard(path) {
        return Ok((Box::new(io::stdin().lock()), None));
    }
    let file = files::open_argument(path)?;
    let length = file.metadata().ok().filter(fs::Metadata::is_file);
    Ok((Box::new(file), length.map(|found| found.len())))
}

/// Reads a scene, or the start of a picture, which contains the scene.
fn limited(mut from: impl Read) -> io::Result<Vec<u8>> {
    let start = files::read_from(from.by_ref().take(START), START)?;
    let is_picture = start.starts_with(&SIGNATURE);
    let whole = io::Cursor::new(start).chain(from);
    if is_picture {
        return files::read_from(whole.take(PICTURE_LIMIT), PICTURE_LIMIT);
    }
    files::read_from(whole, SCENE_LIMIT).map_err(|error| match error.kind() {
        io::ErrorKind::FileTooLarge => no_scene(),
        _ => error,
    })
}

fn no_scene() -> io::Error {
    io::Error::other("it has more than 256 MiB, too much for a scene")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A reader that fails like a broken disk.
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
