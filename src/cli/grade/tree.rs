//! Lists the files in a folder or zip file, with the names of the folders around them. Links are
//! not followed, and files that operating systems create are skipped.

use std::{
    collections::{BTreeMap, BTreeSet},
    ffi::OsStr,
    fs::{self, DirEntry},
    io, mem,
    path::Path,
    sync::Arc,
    time::UNIX_EPOCH,
};

use super::{
    archive::Archive,
    names,
    submission::{ContentSource, SubmittedFile},
};
use crate::cli::input::is_same_file;

/// Name of the file that Gradescope writes beside the folders of an export.
pub const METADATA: &str = "submission_metadata.yml";

/// Maximum number of files in a folder or zip file on the command line. A folder or zip file with
/// more is an error.
const MOST_FILES: usize = 200_000;

/// Maximum depth of nested folders that are listed. A deeper folder is listed with an error instead
/// of its content.
const DEEPEST: usize = 40;

/// Maximum depth at which folders are recorded, empty ones included. Depth 1 may be classes and
/// depth 2 their students.
const NAMED: usize = 2;

/// A file, with the names of its folders and its own name in order.
pub type FoundFile = (Vec<String>, SubmittedFile);

/// The files in a folder and its subfolders, or in a zip file.
#[derive(Debug, Default)]
pub struct FileTree {
    /// The argument on the command line, with a `/` at its end.
    pub place: String,
    pub found: Vec<FoundFile>,
    /// The folders, including empty ones, down to depth [`NAMED`]. Each is a list of names, from
    /// the argument's subfolder on.
    pub folders: BTreeSet<Vec<String>>,
    /// The folders that are repositories, as lists of names like those in `folders`.
    pub clones: BTreeSet<Vec<String>>,
}

impl FileTree {
    /// Lists a folder, except the teacher's own files and folders, `own`.
    ///
    /// # Errors
    ///
    /// The folder cannot be read, or has too many files.
    pub fn of_folder(path: &Path, own: &[&Path]) -> io::Result<Self> {
        let mut tree = Self::at(path);
        tree.walk(path, &[], own)?;
        Ok(tree)
    }

    /// Lists the entries of a folder whose names are in `names`, except the teacher's own files,
    /// `own`.
    ///
    /// # Errors
    ///
    /// As [`Self::of_folder`].
    pub fn of_some(path: &Path, names: &BTreeSet<&OsStr>, own: &[&Path]) -> io::Result<Self> {
        let mut tree = Self::at(path);
        let entries = fs::read_dir(or_here(path))?.collect::<io::Result<Vec<_>>>()?;
        let named = |entry: &DirEntry| names.contains(&*entry.file_name());
        tree.walk_entries(entries.into_iter().filter(named).collect(), &[], own)?;
        Ok(tree)
    }

    /// Lists a zip file. If all entries are in a single folder that looks like a class, lists that
    /// folder's content.
    ///
    /// # Errors
    ///
    /// The file cannot be read; the message says why.
    pub fn of_zip(path: &Path) -> Result<Self, String> {
        let mut tree = Self::at(path);
        tree.unpack(path, &[])?;
        Ok(match tree.only_folder() {
            Some(root) => tree.taken(&root),
            None => tree,
        })
    }

    fn at(path: &Path) -> Self {
        let place = path.display().to_string();
        Self {
            place: match &*place {
                "" => place,
                _ => format!("{}/", place.trim_end_matches('/')),
            },
            ..Self::default()
        }
    }

    /// Lists a subfolder. `before` contains the names of the folders from the argument down to it.
    fn walk(&mut self, folder: &Path, before: &[String], own: &[&Path]) -> io::Result<()> {
        let entries = fs::read_dir(folder)?.collect::<io::Result<Vec<_>>>()?;
        self.walk_entries(entries, before, own)
    }

    fn walk_entries(
        &mut self,
        mut entries: Vec<DirEntry>,
        before: &[String],
        own: &[&Path],
    ) -> io::Result<()> {
        entries.sort_by_key(DirEntry::file_name);
        for entry in entries {
            let name = entry.file_name().to_string_lossy().into_owned();
            if name == ".git" {
                self.add_clone(before);
            }
            let path = entry.path();
            let is_own = || own.iter().any(|own| is_same_file(own, &path));
            if is_passed_over(&name) || before.len() < 2 && is_own() {
                continue;
            }
            let names = [before, &[name]].concat();
            let found = entry.metadata();
            let kind = entry.file_type()?;
            if kind.is_dir() {
                self.add_folder(&names);
                let inner = if names.len() < DEEPEST {
                    self.walk(&path, &names, own)
                } else {
                    Err(io::Error::other("folders are nested too deeply"))
                };
                // The argument itself must be readable. A subfolder that cannot be read is listed
                // as a file with the error.
                if let Err(error) = inner {
                    self.push(names, ContentSource::Refused(error.to_string()), None, 0)?;
                }
                continue;
            }
            let (length, time) = found.map_or((0, None), |found| {
                let time = found.modified().ok();
                let since = time.and_then(|time| time.duration_since(UNIX_EPOCH).ok());
                (found.len(), since.map(|since| since.as_secs() as i64))
            });
            let content = match () {
                () if kind.is_symlink() => ContentSource::Refused("a link".to_owned()),
                () if !kind.is_file() => ContentSource::Refused("not a file".to_owned()),
                () if is_zip(&path) => match self.unpack(&path, &names) {
                    Ok(()) => continue,
                    Err(error) => ContentSource::Refused(error),
                },
                () => ContentSource::File(path),
            };
            self.push(names, content, time, length)?;
        }
        Ok(())
    }

    fn push(
        &mut self,
        names: Vec<String>,
        content: ContentSource,
        time: Option<i64>,
        length: u64,
    ) -> io::Result<()> {
        if self.found.len() == MOST_FILES {
            let message = format!("there are more than {MOST_FILES} files in it");
            return Err(io::Error::other(message));
        }
        let file = SubmittedFile {
            path: names.join("/"),
            shown: format!("{}{}", self.place, names.join("/")),
            time,
            length,
            sum: None,
            content,
            is_named: false,
        };
        self.found.push((names, file));
        Ok(())
    }

    /// Records a folder and the folders around it, up to depth [`NAMED`].
    fn add_folder(&mut self, names: &[String]) {
        for depth in 1..=names.len().min(NAMED) {
            self.folders.insert(names[..depth].to_vec());
        }
    }

    /// Records that a folder is a repository. A folder deeper than [`NAMED`] is recorded as the
    /// folder around it at that depth.
    fn add_clone(&mut self, names: &[String]) {
        if !names.is_empty() {
            self.clones.insert(names[..names.len().min(NAMED)].to_vec());
        }
    }

    /// Adds the entries of a zip file that lies in the folders `before`.
    fn unpack(&mut self, path: &Path, before: &[String]) -> Result<(), String> {
        let (archive, entries) = Archive::open(path)?;
        let archive = Arc::new(archive);
        // The zip file is recorded as a folder, so that its student is listed even if it is empty.
        self.add_folder(before);
        for entry in entries {
            // Names of entries are never used as paths, so `..` can be dropped.
            let parts = entry.name.split('/').map(str::to_owned);
            let parts: Vec<_> = parts
                .filter(|part| !matches!(&**part, "" | "." | ".."))
                .collect();
            let junk = parts.iter().position(|part| is_passed_over(part));
            let names = [before, &parts[..]].concat();
            if let Some(at) = junk.filter(|&at| parts[at] == ".git") {
                self.add_clone(&names[..before.len() + at]);
            }
            // A folder is recorded even if it contains only skipped files.
            let folders = match (junk, entry.is_folder) {
                (Some(at), _) => before.len() + at,
                (None, true) => names.len(),
                (None, false) => names.len().saturating_sub(1),
            };
            self.add_folder(&names[..folders]);
            if parts.is_empty() || junk.is_some() || entry.is_folder {
                continue;
            }
            let is_nested = is_named_as_archive(&entry.name);
            let content = match entry.refused {
                Some(why) => ContentSource::Refused(why.to_owned()),
                None if is_nested => ContentSource::Refused("an archive in a zip file".to_owned()),
                None => ContentSource::Entry(archive.clone(), entry.index),
            };
            self.push(names, content, entry.time, entry.length)
                .map_err(|error| error.to_string())?;
            if let Some((_, file)) = self.found.last_mut() {
                file.sum = Some(entry.sum);
            }
        }
        Ok(())
    }

    /// Returns the name of the single folder around all entries of a zip file. Returns `None` if
    /// there is no such folder or its content does not look like a class.
    fn only_folder(&self) -> Option<String> {
        let files = self.found.iter().map(|(names, _)| &names[..]);
        let all: Vec<_> = files
            .chain(self.folders.iter().map(Vec::as_slice))
            .collect();
        let [root, ..] = all.first()? else {
            return None;
        };
        let inner: BTreeSet<_> = all.iter().filter_map(|names| names.get(1)).collect();
        let is_alone = all.iter().all(|names| names[0] == *root);
        let is_in_folders = self.found.iter().all(|(names, _)| names.len() > 2);
        let is_somebodys = names::moodle(root).is_some();
        (is_alone && inner.len() > 1 && is_in_folders && !is_somebodys).then(|| root.clone())
    }

    /// Removes each folder that contains a whole class, and returns the folders with their names.
    /// Such a folder contains Gradescope's metadata or Moodle's names, or has the suffix of GitHub
    /// Classroom.
    pub fn take_classes(&mut self) -> Vec<(String, Self)> {
        let files = self.found.iter().map(|(names, _)| names);
        let mut inner = BTreeMap::<&str, Vec<&str>>::new();
        for names in files.chain(&self.folders) {
            match &names[..] {
                // The metadata lies beside the folders of the argument itself, which is therefore
                // the class.
                [name] if name == METADATA => return Vec::new(),
                [root, name, ..] => inner.entry(root).or_default().push(name),
                _ => {}
            }
        }
        let is_moodle = |name: &&str| names::moodle(name).is_some();
        let is_class = |(root, inner): &(&str, Vec<&str>)| {
            let is_clone = |clone: &Vec<String>| clone.len() == 2 && clone[0] == **root;
            inner.contains(&METADATA)
                || inner.iter().all(is_moodle) && !is_moodle(root)
                || root.ends_with(names::CLONES) && self.clones.iter().any(is_clone)
        };
        let classes = inner.into_iter().filter(is_class);
        let roots: Vec<String> = classes.map(|(root, _)| root.to_owned()).collect();
        let take = |root: String| {
            let inner = self.taken(&root);
            (root, inner)
        };
        roots.into_iter().map(take).collect()
    }

    /// Removes what is below the folder `root` from this tree, and returns it as a tree.
    fn taken(&mut self, root: &str) -> Self {
        let found = self.found.extract_if(.., |(names, _)| names[0] == root);
        let found = found.map(|(names, file)| (names[1..].to_vec(), file));
        let found = found.filter(|(names, _)| !names.is_empty()).collect();
        let take = |folders: &mut BTreeSet<Vec<String>>| {
            let (inner, others) = mem::take(folders)
                .into_iter()
                .partition::<BTreeSet<_>, _>(|names| names[0] == root);
            *folders = others;
            let cut = inner.into_iter().map(|names| names[1..].to_vec());
            cut.filter(|names| !names.is_empty()).collect()
        };
        Self {
            place: format!("{}{root}/", self.place),
            found,
            folders: take(&mut self.folders),
            clones: take(&mut self.clones),
        }
    }
}

/// Returns the path, or `.` if the path is empty.
pub fn or_here(path: &Path) -> &Path {
    if path.as_os_str().is_empty() {
        Path::new(".")
    } else {
        path
    }
}

/// Returns whether a path is a file whose extension is `zip`, ignoring case.
pub fn is_zip(path: &Path) -> bool {
    let ending = path.extension();
    ending.is_some_and(|ending| ending.eq_ignore_ascii_case("zip")) && path.is_file()
}

/// Returns whether a name is hidden, or is that of a file that operating systems create.
fn is_passed_over(name: &str) -> bool {
    const NAMES: [&str; 3] = ["__MACOSX", "Thumbs.db", "desktop.ini"];
    name.starts_with('.') || NAMES.iter().any(|own| name.eq_ignore_ascii_case(own))
}

fn is_named_as_archive(name: &str) -> bool {
    let ending = name.rsplit('.').next().unwrap_or_default();
    const ENDINGS: [&str; 8] = ["zip", "tar", "gz", "tgz", "rar", "7z", "xz", "bz2"];
    ENDINGS.iter().any(|own| ending.eq_ignore_ascii_case(own))
}
