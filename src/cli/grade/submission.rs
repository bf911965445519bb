//! Submissions of students: their files, and the choice of the picture to grade.

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

/// Maximum difference, in seconds, between modification times that are treated as equal. Zip files
/// store times in units of two seconds, so equal times may differ by up to two seconds.
const SAME_TIME: i64 = 2;

/// Maximum number of a student's pictures that are judged if several are equally new. Further
/// pictures are only listed. Chosen so that one student with very many pictures does not delay the
/// grading of a class.
const MOST_PICTURES: usize = 12;

/// A student's submission.
#[derive(Debug)]
pub struct Student {
    /// The student's name in the submission system. If it is unknown, the name of the folder or
    /// file.
    pub name: String,
    /// Number that Moodle gives the submission; `None` if Moodle did not collect it.
    pub number: Option<String>,
    /// Path of the student's folder or file, as it is printed.
    pub place: String,
    pub files: Vec<SubmittedFile>,
    /// Whether the submission is a clone of a Git repository. The times of its files are those of
    /// cloning, so they do not show which file is newest.
    pub is_clone: bool,
}

/// A submitted file.
#[derive(Debug)]
pub struct SubmittedFile {
    /// Path of the file inside the student's submission, with `/` between folders.
    pub path: String,
    /// Path of the file as it is printed. It starts with the argument on the command line.
    pub shown: String,
    /// Modification time in seconds since 1970, if known.
    pub time: Option<i64>,
    /// Length of the file in bytes, as the file system or the zip file gives it.
    pub length: u64,
    /// CRC-32 checksum of the file, if it is in a zip file.
    pub sum: Option<u32>,
    pub content: ContentSource,
    /// Whether the user named the file on the command line. Such a file is treated as a picture,
    /// whatever its name is.
    pub is_named: bool,
}

/// Source of a file's bytes.
#[derive(Debug)]
pub enum ContentSource {
    /// A file on disk, or standard input (`-` or `/dev/stdin`), which can be read only once.
    File(PathBuf),
    /// An entry of a zip file, by its index there.
    Entry(Arc<Archive>, usize),
    /// A file that is not read, for example a link, with the reason.
    Refused(String),
}

impl SubmittedFile {
    /// Reads a file that should be a picture. If the first bytes of a file on disk are not those of
    /// a picture, only the start of the file is read. Returns the reason if the file cannot be
    /// read.
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

    /// Returns whether the file is treated as a picture. This holds for every file that the user
    /// named on the command line. Any other file must be readable, and its path must match
    /// `chosen`, the pattern in `--picture`. Without a pattern, it must have the extension of a
    /// picture.
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

/// A student's files, divided into pictures to compare and other files.
#[derive(Debug, Default)]
pub struct PictureChoice<'s> {
    pub pictures: Vec<&'s SubmittedFile>,
    /// Names of the student's files that are not compared. Some are followed by the reason in
    /// parentheses.
    pub others: Vec<String>,
}

impl Student {
    /// Chooses the student's newest picture for grading. Chooses several pictures if they are
    /// equally new, or if it is unknown which is newest, for example in a Git clone.
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
