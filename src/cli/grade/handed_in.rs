//! What was handed in: a student, and the files of one.

use std::{path::PathBuf, sync::Arc};

use super::{
    archive::{Archive, Budget},
    glob::Glob,
};
use crate::cli::{
    args::LargeArgs,
    input::{self, Compared, Most},
    judge,
};

/// Times that differ by no more seconds are one: a zip file has every second one, and to check out
/// a repository takes a while.
const SAME_TIME: i64 = 2;

/// Maximum number of pictures of the same time that are compared.
const MOST_PICTURES: usize = 12;

/// A student's work.
#[derive(Debug)]
pub struct Student {
    /// As the system calls him, or as his folder or file is called.
    pub name: String,
    /// The number that Moodle has for his work.
    pub number: Option<String>,
    /// His folder or file, to be shown.
    pub place: String,
    pub files: Vec<HandedIn>,
    /// Whether the times of his files say nothing, as in a clone of a repository.
    pub is_clone: bool,
}

/// A file.
#[derive(Debug)]
pub struct HandedIn {
    /// Where it lies in his work, with `/` between folders.
    pub path: String,
    /// The same from what was named, to be shown.
    pub shown: String,
    /// In whole seconds.
    pub time: Option<i64>,
    /// As the folder or the zip file says.
    pub length: u64,
    /// The check sum that a zip file has for it.
    pub sum: Option<u32>,
    pub content: Content,
    /// Whether it was named itself, and is a picture whatever it is called.
    pub is_named: bool,
}

/// Where a file's bytes are.
#[derive(Debug)]
pub enum Content {
    /// In a file of their own; of `-` and `/dev/stdin` they can be read once.
    File(PathBuf),
    /// In a zip file.
    Entry(Arc<Archive>, usize),
    /// They are not looked at, and why.
    Refused(String),
}

impl HandedIn {
    /// Reads it as a picture, whose first bytes say whether it is one before the others are read.
    ///
    /// # Errors
    ///
    /// Why it cannot be read.
    pub fn picture(&self, large: &LargeArgs, budget: &Budget) -> Result<Vec<u8>, String> {
        match &self.content {
            Content::File(path) => match input::compared(path, large, Most::Start) {
                Ok(Compared::Picture(bytes) | Compared::Other(bytes)) => Ok(bytes),
                Err(error) => Err(error.to_string()),
            },
            Content::Entry(archive, index) => archive.read(*index, budget),
            Content::Refused(why) => Err(why.clone()),
        }
    }

    /// Whether it may be a picture, or is chosen as one.
    pub fn is_picture(&self, chosen: Option<&Glob>) -> bool {
        let is_read = !matches!(self.content, Content::Refused(_));
        self.is_named
            || is_read
                && match chosen {
                    Some(glob) => glob.matches(&self.path),
                    None => judge::is_named_as_picture(self.path.as_ref()),
                }
    }
}

/// Which files of a student are compared.
#[derive(Debug, Default)]
pub struct Choice<'s> {
    pub pictures: Vec<&'s HandedIn>,
    /// The others, and why they are not.
    pub others: Vec<String>,
}

impl Student {
    /// The newest of the pictures, or several where it cannot be told which one that is.
    pub fn choice(&self, chosen: Option<&Glob>) -> Choice<'_> {
        let is_picture = |file: &&HandedIn| file.is_picture(chosen);
        let (mut pictures, others): (Vec<_>, Vec<_>) = self.files.iter().partition(is_picture);
        let mut others: Vec<String> = others
            .into_iter()
            .map(|file| match &file.content {
                Content::Refused(why) => format!("{} ({why})", file.path),
                _ => file.path.clone(),
            })
            .collect();
        let newest = pictures.iter().filter_map(|file| file.time).max();
        let is_newest = |file: &&HandedIn| {
            let times = (file.time, newest);
            self.is_clone
                || matches!(times, (Some(time), Some(newest)) if newest - time <= SAME_TIME)
                || newest.is_none()
        };
        let (newest, older): (Vec<_>, Vec<_>) = pictures.into_iter().partition(is_newest);
        others.extend(
            older
                .iter()
                .map(|file| format!("{} (an older picture)", file.path)),
        );
        pictures = newest;
        if pictures.len() > MOST_PICTURES {
            let more = pictures.split_off(MOST_PICTURES);
            let listed = |file: &&HandedIn| {
                format!(
                    "{} (one of more than {MOST_PICTURES} of the same time: --picture chooses)",
                    file.path
                )
            };
            others.extend(more.iter().map(listed));
        }
        Choice { pictures, others }
    }
}
