//! Lists the files in a folder or zip file, with the names of the folders that contain them. Links
//! are not followed. Hidden files and files such as `Thumbs.db`, which operating systems create,
//! are skipped.

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

/// Name of the file in which a Gradescope export lists the students of each folder.
pub const METADATA: &str = "submission_metadata.yml";

/// Maximum number of files in a folder or zip file on the command line. With more, listing fails.
/// The limit bounds time and memory if the user names a wrong folder. A class has far fewer files.
const MOST_FILES: usize = 200_000;

/// Maximum depth of nested folders that are listed. A deeper folder is listed as an error. The
/// limit bounds the recursion, which could otherwise exhaust the stack. Submissions are nested far
/// less deeply.
const DEEPEST: usize = 40;

/// Maximum depth at which folders are recorded in addition to their files, so that empty folders
/// are not lost. Two levels suffice: folders of classes, and the students' folders in them.
const NAMED: usize = 2;

/// A file, with its path as a list: the names of the folders that contain it, then its own name.
pub type FoundFile = (Vec<String>, SubmittedFile);

/// The files in a folder and its subfolders, or in a zip file.
#[derive(Debug, Default)]
pub struct FileTree {
    /// Path of the folder or zip file on the command line, as it is printed, with a `/` at its end.
    pub place: String,
    pub found: Vec<FoundFile>,
    /// The folders, including empty ones, down to depth [`NAMED`]. Each is a path as a list of
    /// names, relative to `place`.
    pub folders: BTreeSet<Vec<String>>,
    /// The folders that are Git repositories. Each is a path as a list of names, relative to
    /// `place`. A repository deeper than [`NAMED`] is represented by its ancestor at this depth.
    pub clones: BTreeSet<Vec<String>>,
}

impl FileTree {
    /// Lists a folder. The teacher's own files and folders, `own`, are left out.
    ///
    /// # Errors
    ///
    /// Returns an error if the folder cannot be read, or has too many files.
    pub fn of_folder(path: &Path, own: &[&Path]) -> io::Result<Self> {
        let mut tree = Self::at(path);
        tree.walk(path, &[], own)?;
        Ok(tree)
    }

    /// Lists those entries of a folder that are in `names`. The teacher's own files, `own`, are
    /// left out.
    ///
    /// # Errors
    ///
    /// Returns an error if the folder cannot be read, or has too many files.
    pub fn of_some(path: &Path, names: &BTreeSet<&OsStr>, own: &[&Path]) -> io::Result<Self> {
        let mut tree = Self::at(path);
        let entries = fs::read_dir(or_here(path))?.collect::<io::Result<Vec<_>>>()?;
        let named = |entry: &DirEntry| names.contains(&*entry.file_name());
        tree.walk_entries(entries.into_iter().filter(named).collect(), &[], own)?;
        Ok(tree)
    }

    /// Lists a zip file. A zip file may contain a single folder with everything else in it. If this
    /// folder seems to contain a class, its content is listed, without the folder itself. Returns
    /// the reason if the zip file cannot be read.
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

    /// Lists a subfolder. `before` is its path as a list of names, relative to the folder on the
    /// command line. Returns an error if the subfolder cannot be read, or if there are too many
    /// files.
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
                // A subfolder that cannot be read is listed as a file with the error, so that its
                // student is not left out.
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

    /// Records a folder and the folders that contain it, down to depth [`NAMED`].
    fn add_folder(&mut self, names: &[String]) {
        for depth in 1..=names.len().min(NAMED) {
            self.folders.insert(names[..depth].to_vec());
        }
    }

    /// Records that a folder is a Git repository. If it is deeper than [`NAMED`], its ancestor at
    /// this depth is recorded instead.
    fn add_clone(&mut self, names: &[String]) {
        if !names.is_empty() {
            self.clones.insert(names[..names.len().min(NAMED)].to_vec());
        }
    }

    /// Adds the entries of a zip file. `before` is the path of the zip file as a list of names.
    /// Returns the reason if the zip file cannot be read or has too many entries.
    fn unpack(&mut self, path: &Path, before: &[String]) -> Result<(), String> {
        let (archive, entries) = Archive::open(path)?;
        let archive = Arc::new(archive);
        // The zip file is recorded like a folder, so that its student is listed even if it contains
        // no files.
        self.add_folder(before);
        for entry in entries {
            // The names are never used as paths, so `..` can simply be dropped.
            let parts = entry.name.split('/').map(str::to_owned);
            let parts: Vec<_> = parts
                .filter(|part| !matches!(&**part, "" | "." | ".."))
                .collect();
            let junk = parts.iter().position(|part| is_passed_over(part));
            let names = [before, &parts[..]].concat();
            if let Some(at) = junk.filter(|&at| parts[at] == ".git") {
                self.add_clone(&names[..before.len() + at]);
            }
            // A student's folder is recorded even if all files in it are skipped.
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

    /// Returns the name of the only folder at the top of a zip file. Returns `None` if there are
    /// several, or if the folder does not seem to contain a class.
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

    /// Removes the folders that contain whole classes from the tree, and returns them with their
    /// names. A folder contains a class in each of these cases:
    ///
    /// - Gradescope's metadata file is in it.
    /// - All names in it are in Moodle's form.
    /// - It contains Git repositories, and its name ends in `-submissions`, as in GitHub Classroom.
    pub fn take_classes(&mut self) -> Vec<(String, Self)> {
        let files = self.found.iter().map(|(names, _)| names);
        let mut inner = BTreeMap::<&str, Vec<&str>>::new();
        for names in files.chain(&self.folders) {
            match &names[..] {
                // If the metadata file is at the top, the whole tree is one class, so its
                // subfolders are not classes.
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

    /// Removes the files and folders below the folder `root` from the tree, and returns them as a
    /// tree of their own.
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

/// Returns the path, or `.` (the current folder) if the path is empty.
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

/// Returns whether a file or folder is skipped because of its name: if the name begins with a dot,
/// i.e. is hidden, or if an operating system creates files of this name.
fn is_passed_over(name: &str) -> bool {
    const NAMES: [&str; 3] = ["__MACOSX", "Thumbs.db", "desktop.ini"];
    name.starts_with('.') || NAMES.iter().any(|own| name.eq_ignore_ascii_case(own))
}

fn is_named_as_archive(name: &str) -> bool {
    let ending = name.rsplit('.').next().unwrap_or_default();
    const ENDINGS: [&str; 8] = ["zip", "tar", "gz", "tgz", "rar", "7z", "xz", "bz2"];
    ENDINGS.iter().any(|own| ending.eq_ignore_ascii_case(own))
}
