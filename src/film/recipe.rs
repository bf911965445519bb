//! What a picture was made from, and which part of a whole picture it shows. Both are stored in the
//! picture's file.

use hmac_sha256::Hash;

use crate::area::Area;

/// Maximum length, in bytes, of all texts that a PNG stores about its scene. Longer texts are not
/// stored, and not read from a PNG, so that a small file cannot be unpacked to a huge one. Usual
/// scenes are far shorter.
pub const TEXT_LIMIT: usize = 1 << 20;

/// Maximum number of overrides (`--set` arguments) that a PNG stores. If a picture has more,
/// nothing about its scene is stored, and a file that contains more is rejected. Users give far
/// fewer.
pub const OVERRIDES_LIMIT: usize = 1000;

/// Everything from which a picture was made. A PNG stores it, so that the picture can be rendered
/// again.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recipe {
    /// The text of the scene.
    pub scene: String,
    /// The overrides of the scene's values, i.e. the `--set` arguments, in the order given by the
    /// user.
    pub overrides: Vec<String>,
    /// The part of the picture that was rendered; `None` if the whole picture was rendered.
    pub crop: Option<Area>,
    /// Numbers of columns and rows of the whole picture. `None` if the whole picture was rendered,
    /// or if its size is unknown.
    pub size: Option<[u32; 2]>,
}

/// The part of a whole picture that a file shows, and a digest of what the picture was made from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// The part's area in the whole picture.
    pub area: Area,
    /// Numbers of columns and rows of the whole picture.
    pub size: [u32; 2],
    /// Digest of the recipe ([`Recipe::digest`]).
    pub digest: String,
}

impl Recipe {
    /// Returns whether the recipe can be stored in a PNG: it has at most [`OVERRIDES_LIMIT`]
    /// overrides, and its scene and overrides together are at most [`TEXT_LIMIT`] bytes long.
    pub fn fits(&self) -> bool {
        let overrides: usize = self.overrides.iter().map(String::len).sum();
        self.overrides.len() <= OVERRIDES_LIMIT && self.scene.len() + overrides <= TEXT_LIMIT
    }

    /// Returns the part of the picture that this recipe renders. Returns `None` if it renders the
    /// whole picture, or if the whole picture's size is unknown.
    pub fn part(&self) -> Option<Part> {
        Some(Part {
            area: self.crop?,
            size: self.size?,
            digest: self.digest(),
        })
    }

    /// Returns a digest of the scene's text, of the overrides, and of Pinhole's version, as 64
    /// hexadecimal digits. Pictures with equal digests are of the same scene. The digest is the
    /// SHA-256 hash of these texts, each preceded by its length in bytes.
    pub fn digest(&self) -> String {
        let mut hash = Hash::new();
        let overrides = self.overrides.iter().map(String::as_str);
        let texts = [env!("CARGO_PKG_VERSION"), &self.scene].into_iter();
        for text in texts.chain(overrides) {
            hash.update((text.len() as u64).to_le_bytes());
            hash.update(text);
        }
        let bytes = hash.finalize();
        bytes.iter().map(|byte| format!("{byte:02x}")).collect()
    }
}
