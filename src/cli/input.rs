//! Scenes from files, from standard input and from pictures.

use std::{
    fs::{self, File},
    io::{self, Read},
    path::{Path, PathBuf},
};

use super::{Trouble, args::Overrides, output};
use crate::{
    area::Area,
    diagnostic::Report,
    film::{Recipe, SIGNATURE, read_recipe},
    scene::{self, Reading},
    source::{Source, Sources},
};

/// A scene file with more bytes than this is not read: it is not one.
const SCENE_LIMIT: u64 = 256 << 20;

/// So much of a picture is read: more than enough for what may stand before its pixels.
const PICTURE_LIMIT: u64 = 8 << 20;

/// No picture that is compared has more bytes.
const FILE_LIMIT: u64 = 4 << 30;

/// What a scene is read from.
pub struct Input {
    /// The scene's text and the overrides, those that a picture carries before those of the command line.
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
        let name = path.display().to_string();
        let bytes = bytes(path)
            .map_err(|error| Trouble(format!("cannot read {}: {error}", shown(path))))?;
        let mut input = if bytes.starts_with(&SIGNATURE) {
            let recipe = read_recipe(&bytes)
                .map_err(|error| Trouble(format!("cannot read {}: {error}", shown(path))))?;
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

    /// Reads the scene, and reports its problems to people.
    pub fn scene(&self) -> Reading {
        let reading = scene::read(&self.sources);
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

/// What SCENE or FILE is called in a message.
pub fn shown(path: &Path) -> String {
    path.display().to_string()
}

/// Whether two paths lead to one file.
pub fn is_same_file(a: &Path, b: &Path) -> bool {
    match (fs::canonicalize(a), fs::canonicalize(b)) {
        (Ok(a), Ok(b)) => a == b,
        _ => false,
    }
}

/// The whole of a picture's file, or a scene's.
pub fn whole(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let from: Box<dyn Read> = match is_standard(path) {
        true => Box::new(io::stdin().lock()),
        false => Box::new(File::open(path)?),
    };
    let mut from = from.take(FILE_LIMIT);
    from.read_to_end(&mut bytes)?;
    if bytes.len() as u64 >= FILE_LIMIT {
        return Err(io::Error::other("it has more than 4 GiB"));
    }
    Ok(bytes)
}

/// The bytes of a scene, or as much of a picture as can matter.
pub fn bytes(path: &Path) -> io::Result<Vec<u8>> {
    if is_standard(path) {
        return limited(io::stdin().lock());
    }
    limited(File::open(path)?)
}

/// Reads a scene, or as much of a picture as can matter.
fn limited(mut from: impl Read) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let by_ref = from.by_ref();
    by_ref
        .take(SIGNATURE.len() as u64)
        .read_to_end(&mut bytes)?;
    if bytes == SIGNATURE {
        by_ref.take(PICTURE_LIMIT).read_to_end(&mut bytes)?;
        return Ok(bytes);
    }
    by_ref.take(SCENE_LIMIT).read_to_end(&mut bytes)?;
    if bytes.len() as u64 >= SCENE_LIMIT {
        return Err(io::Error::other(
            "it has more than 256 MiB, too much for a scene",
        ));
    }
    Ok(bytes)
}
