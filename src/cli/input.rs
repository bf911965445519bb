//! Reads scenes from files, from standard input and from pictures.

use std::{
    fs,
    io::{self, Read},
    path::{Path, PathBuf},
};

use super::{
    CommandError,
    args::{LargeArgs, Overrides},
    command_error,
    interrupt::Interrupt,
    output,
    sweep::{Sweep, SweepStep},
};
use crate::{
    area::Area,
    diagnostic::{Diagnostic, Report, visible_line},
    files::{self, NotWritten, Original, Purpose},
    film::{self, Recipe, SIGNATURE, read_recipe},
    scene::{self, Reading, Scene},
    source::{Source, Sources},
};

/// Maximum length of a scene's file, in bytes. A longer file is rejected. Chosen far above the
/// length of any sensible scene; it keeps an endless input, such as `/dev/zero`, from filling the
/// memory.
const SCENE_LIMIT: u64 = 256 << 20;

/// Number of bytes at the start of a PNG that are read to find the scene in it, 8 MiB. Pinhole
/// stores at most 1 MiB of text ([`Recipe`]) before the pixels. The other 7 MiB leave room for data
/// that other programs insert before the pixels.
pub const PICTURE_LIMIT: u64 = 8 << 20;

/// Number of bytes at the start of a file that are searched for a picture, 64 KiB. A student's
/// program may print messages before it prints its picture, and both may be saved in one file. If
/// the messages are longer than 64 KiB, the picture is not found; usual messages are far shorter.
const START: u64 = 1 << 16;

/// A scene that was read, but not yet parsed.
pub struct SceneInput {
    /// The scene's text and its overrides (`--set` arguments). Overrides that are stored in a
    /// picture come before those on the command line.
    pub sources: Sources,
    /// Whether the scene was read from a PNG in which Pinhole stored it.
    pub is_picture: bool,
    /// The part of the picture that was rendered, if the scene was read from a PNG that shows only
    /// a part.
    pub crop: Option<Area>,
}

/// Returns whether the argument is `-`, which stands for standard input or output.
pub fn is_standard(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// Rejects arguments that would read standard input twice.
pub fn check_standard(paths: &[PathBuf]) -> Result<(), CommandError> {
    match paths.iter().filter(|path| is_standard(path)).count() {
        0 | 1 => Ok(()),
        _ => Err(command_error(
            "standard input can be read once only, and `-` is given twice",
        )),
    }
}

impl SceneInput {
    /// Reads the scene from the file `path` or, for `-`, from standard input, and adds the
    /// overrides of the command line.
    pub fn read(path: &Path, overrides: &Overrides) -> Result<Self, CommandError> {
        let bytes = argument(path).and_then(limited);
        let bytes = bytes.map_err(|error| unreadable(path, &error))?;
        Self::of_bytes(path, bytes, overrides)
    }

    /// Reads the text of a scene that the command `command` will change. Also returns the file as
    /// it was read, or `None` if the scene comes from standard input. Fails if `path` is a named
    /// pipe or a picture.
    pub fn to_change(
        path: &Path,
        overrides: &Overrides,
        command: &str,
    ) -> Result<(Self, Option<Original>), CommandError> {
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
            return Err(command_error(format!(
                "{} is a picture; {command} takes the scene's text",
                shown(path)
            )));
        }
        Ok((input, original))
    }

    fn of_bytes(path: &Path, bytes: Vec<u8>, overrides: &Overrides) -> Result<Self, CommandError> {
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

    /// Makes the input from `bytes`, the content of the scene's file `path`.
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
        // Each source is named after the position of its `--set` argument on the command line,
        // counted from 1. The list `sources.sets` may already contain overrides that are stored in
        // a picture. They are not in `overrides`, so they are not counted.
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

    /// Parses the scene and prints its problems. Warnings about objects outside of the picture are
    /// not printed, since such objects may be intended, for example in one frame of an animation.
    /// Returns [`CommandError::SceneErrors`] if the scene has errors.
    pub fn scene(&self) -> Result<Scene, CommandError> {
        let mut reading = scene::read(&self.sources);
        let is_of_text = |it: &Diagnostic| it.code == "pinhole::outside_picture";
        reading.diagnostics.retain(|it| !is_of_text(it));
        output::to_people(&self.report(&reading));
        reading.scene.ok_or(CommandError::SceneErrors)
    }

    /// Parses the scene and prints its problems if it has errors.
    pub fn scene_without_warnings(&self) -> Result<Scene, CommandError> {
        let reading = scene::read(&self.sources);
        if reading.scene.is_none() {
            output::to_people(&self.report(&reading));
        }
        reading.scene.ok_or(CommandError::SceneErrors)
    }

    /// Returns the scenes of a sweep. Prints the problems of the first scene, and the errors of the
    /// last one.
    pub fn steps(&self, sweep: &Sweep) -> Result<Vec<SweepStep>, CommandError> {
        let [first, last] = sweep.ends().map(|set| self.with_set(&set));
        // The warnings of the last scene are not printed, since they are mostly the same as those
        // of the first scene.
        first.scene()?;
        last.scene_without_warnings()?;
        sweep.steps(&self.sources)
    }

    /// Returns the input with one more `--set` argument, which a sweep has made.
    pub fn with_set(&self, set: &str) -> Self {
        let mut sources = self.sources.clone();
        let name = format!("{}, --sweep", sources.file.name());
        sources.sets.push(Source::from_text(name, set));
        Self { sources, ..*self }
    }

    /// Returns the report about the scene's problems as readable text.
    pub fn report(&self, reading: &Reading) -> String {
        Report::new(&self.sources, output::style()).human(&reading.diagnostics)
    }

    /// Returns the data that a picture file stores about the scene: its text, its overrides and the
    /// crop. `crop` is the rendered part of the picture, or `None` if the whole picture was
    /// rendered. `whole` is the area of the whole picture.
    pub fn into_recipe(self, crop: Option<Area>, whole: Area) -> Recipe {
        Recipe {
            overrides: self.overrides(),
            scene: self.sources.file.into_text(),
            crop,
            size: crop.map(|_| [whole.width, whole.height]),
        }
    }

    /// Returns the overrides of the scene's values, i.e. the `--set` arguments.
    pub fn overrides(&self) -> Vec<String> {
        let sets = self.sources.sets.iter();
        sets.map(|set| set.text().to_owned()).collect()
    }
}

/// Returns a path for use in messages: on one line, with control characters made visible.
pub fn shown(path: &Path) -> String {
    visible_line(&path.display().to_string()).into_owned()
}

/// Warns about copies of a file. They were left by processes that were killed while they wrote the
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
pub fn unreadable(path: &Path, error: &dyn std::fmt::Display) -> CommandError {
    command_error(format!("cannot read {}: {error}", shown(path)))
}

/// Makes the error message that a path cannot be written to.
pub fn unwritable(path: &Path, error: &dyn std::fmt::Display) -> CommandError {
    command_error(format!("cannot write to {}: {error}", shown(path)))
}

/// Makes the error message that files cannot be written into an output folder.
pub fn not_written(why: NotWritten) -> CommandError {
    unwritable(&why.path, &why.error)
}

/// Replaces the text of a file. Fails if another program has changed the file since it was read.
pub fn change(
    path: &Path,
    original: &Original,
    text: &str,
    interrupt: &Interrupt,
) -> Result<(), CommandError> {
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

/// The bytes of a file that was expected to be a picture.
pub enum FileBytes {
    /// All bytes of a picture.
    Picture(Vec<u8>),
    /// Bytes of a file that is not a picture: all of them, or only the first. [`IfNotPicture`]
    /// decides which.
    Other(Vec<u8>),
}

/// Reads a picture. If the first bytes show that the file is not a picture, `if_not_picture` says
/// how much of it is read.
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

/// How much to read of a file that turns out not to be a picture.
pub enum IfNotPicture {
    /// The whole file, up to the maximum length of a scene.
    ReadScene,
    /// Only the first bytes, which suffice for an error message.
    ReadStart,
}

/// Reads a scene's file. If it is a PNG, which may contain a scene, only its start is read. Fails
/// unless the path is a regular file.
pub fn bytes(path: &Path) -> io::Result<Vec<u8>> {
    limited(files::open(path)?)
}

/// Opens a scene's file, or standard input for `-`, for reading.
fn argument(path: &Path) -> io::Result<Box<dyn Read>> {
    opened(path).map(|(from, _)| from)
}

/// Opens a file, or standard input for `-`, for reading. If it is a regular file, also returns its
/// length in bytes.
fn opened(path: &Path) -> io::Result<(Box<dyn Read>, Option<u64>)> {
    if is_standard(path) {
        return Ok((Box::new(io::stdin().lock()), None));
    }
    let file = files::open_argument(path)?;
    let length = file.metadata().ok().filter(fs::Metadata::is_file);
    Ok((Box::new(file), length.map(|found| found.len())))
}

/// Reads a scene's text. If it is in a PNG, only the start of the PNG is read.
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
