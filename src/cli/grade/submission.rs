//! Submissions: students and their files.

use std::{path::PathBuf, sync::Arc};

use super::{
    archive::{Archive, UnpackBudget},
    glob::Glob,
};
use crate::cli::{
    args::LargeArgs,
    input::{self, FileBytes, IfNotPicture},
    judge,
};

/// Maximum difference, in seconds, between modification times that count as equal. Zip files store
/// only even seconds, and checking out a repository takes a while.
const SAME_TIME: i64 = 2;

/// Maximum number of a student's pictures that are compared if several have the newest time. The
/// others are listed as not compared.
const MOST_PICTURES: usize = 12;

/// A student's submission.
#[derive(Debug)]
pub struct Student {
    /// Name of the student in the submission system, or else the name of the folder or file.
    pub name: String,
    /// Number that Moodle gives the submission; `None` if Moodle did not collect it.
    pub number: Option<String>,
    /// Path of the student's folder or file, for output.
    pub place: String,
    pub files: Vec<SubmittedFile>,
    /// Whether the submission is a clone of a repository, in which the files' times have no
    /// meaning.
    pub is_clone: bool,
}

/// A submitted file.
#[derive(Debug)]
pub struct SubmittedFile {
    /// Path of the file within the student's submission, with `/` between folders.
    pub path: String,
    /// Path of the file, starting with the argument on the command line, for output.
    pub shown: String,
    /// Modification time in seconds since 1970, if known.
    pub time: Option<i64>,
    /// Length according to the folder or the zip file, in bytes.
    pub length: u64,
    /// The CRC-32 of the file, if it is in a zip file.
    pub sum: Option<u32>,
    pub content: ContentSource,
    /// Whether the file itself is on the command line. It is then a picture, whatever its name is.
    pub is_named: bool,
}

/// Source of a file's bytes.
#[derive(Debug)]
pub enum ContentSource {
    /// A file on disk, or standard input, `-` or `/dev/stdin`, which can be read only once.
    File(PathBuf),
    /// An entry of a zip file, by its index.
    Entry(Arc<Archive>, usize),
    /// A file that is not read, with the reason.
    Refused(String),
}

impl SubmittedFile {
    /// Reads the file, which should be a picture. If the file is on disk and its first bytes show
    /// that it is no picture, only these are read.
    ///
    /// # Errors
    ///
    /// The file cannot be read; the message says why.
    pub fn picture(&self, large: &LargeArgs, budget: &UnpackBudget) -> Result<Vec<u8>, String> {
        match &self.content {
            ContentSource::File(path) => {
                match input::read_picture_or(path, large, IfNotPicture::ReadStart) {
                    Ok(FileBytes::Picture(bytes) | FileBytes::Other(bytes)) => Ok(bytes),
                    Err(error) => Err(error.to_string()),
                }
            }
            ContentSource::Entry(archive, index) => archive.read(*index, budget),
            ContentSource::Refused(why) => Err(why.clone()),
        }
    }

    /// Returns whether the file may be a picture. A file on the command line always may. Otherwise,
    /// its name must match `chosen`, the pattern of `--picture`, or have the extension of a picture
    /// if there is no pattern.
    pub fn is_picture(&self, chosen: Option<&Glob>) -> bool {
        let is_read = !matches!(self.content, ContentSource::Refused(_));
        self.is_named
            || is_read
                && match chosen {
                    Some(glob) => glob.matches(&self.path),
                    None => judge::is_named_as_picture(self.path.as_ref()),
                }
    }
}

/// The files of a student: those that are compared as pictures, and the others.
#[derive(Debug, Default)]
pub struct PictureChoice<'s> {
    pub pictures: Vec<&'s SubmittedFile>,
    /// Names of the other files, some with the reason why the file is not compared.
    pub others: Vec<String>,
}

impl Student {
    /// Returns the newest picture, or several pictures if their times do not show which is the
    /// newest.
    pub fn choice(&self, chosen: Option<&Glob>) -> PictureChoice<'_> {
        let is_picture = |file: &&SubmittedFile| file.is_picture(chosen);
        let (mut pictures, others): (Vec<_>, Vec<_>) = self.files.iter().partition(is_picture);
        let mut others: Vec<String> = others
            .into_iter()
            .map(|file| match &file.content {
                ContentSource::Refused(why) => format!("{} ({why})", file.path),
                _ => file.path.clone(),
            })
            .collect();
        let newest = pictures.iter().filter_map(|file| file.time).max();
        let is_newest = |file: &&SubmittedFile| {
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
            let listed = |file: &&SubmittedFile| {
                format!(
                    "{} (one of more than {MOST_PICTURES} of the same time: --picture chooses)",
                    file.path
                )
            };
            others.extend(more.iter().map(listed));
        }
        PictureChoice { pictures, others }
    }
}
