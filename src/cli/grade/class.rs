//! A class's work as it is handed in: single pictures, folders and zip files become students, each
//! with files.
//!
//! A folder or zip file that is named has a student in each of its folders, and in each file beside
//! these. What Moodle writes into names, and Gradescope beside the folders, says who it is. Links
//! are not followed, and nobody is left out.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs, io,
    path::{Path, PathBuf},
    sync::Arc,
    time::UNIX_EPOCH,
};

use hmac_sha256::Hash;

use super::{
    archive::{Archive, Budget, FILE_LIMIT},
    handed_in::{Content, HandedIn, Student},
    names::{self, Submitters},
};
use crate::{
    cli::{
        Trouble,
        input::{is_same_file, is_standard, shown, unreadable},
        judge,
    },
    files,
};

/// Maximum number of files in a folder that is named.
const MOST_FILES: usize = 200_000;

/// Maximum depth of folders.
const DEEPEST: usize = 40;

/// What Gradescope writes beside the folders of an export.
const METADATA: &str = "submission_metadata.yml";

/// A class.
#[derive(Debug, Default)]
pub struct Class {
    pub students: Vec<Student>,
    /// Whether a picture that is named is not there, or no file.
    pub is_one_missing: bool,
    /// What may still be unpacked.
    pub budget: Budget,
}

/// A file with the names of the folders that it lies in, and its own.
type Found = (Vec<String>, HandedIn);

impl Class {
    /// What is named, but for the teacher's own files.
    ///
    /// # Errors
    ///
    /// A folder or zip file that is named cannot be read. A picture that is missing is left to
    /// whoever reads it.
    pub fn read(paths: &[PathBuf], own: &[&Path]) -> Result<Self, Trouble> {
        let mut class = Self::default();
        for path in paths {
            let place = path.display().to_string();
            if path.is_dir() {
                let mut tree = Tree::new(&place, own);
                tree.walk(path, &[])
                    .map_err(|error| unreadable(path, &error))?;
                class.add(&place, folder_name(path), tree);
            } else if is_zip(path) {
                let mut tree = Tree::new(&place, &[]);
                tree.unpack(path, &[])
                    .map_err(|error| unreadable(path, &error))?;
                tree.leave_root();
                class.add(&place, None, tree);
            } else {
                class.is_one_missing |= !is_standard(path) && files::open_argument(path).is_err();
                class.students.push(single(path));
            }
        }
        Ok(class)
    }

    /// The students of a folder or zip file.
    fn add(&mut self, place: &str, folder: Option<String>, mut tree: Tree) {
        let is_metadata = |(names, _): &Found| names.len() == 1 && names[0] == METADATA;
        let at = tree.found.iter().position(is_metadata);
        let metadata = at.map(|at| tree.found.swap_remove(at));
        let metadata = metadata.and_then(|(_, file)| bytes(&file, &self.budget).ok());
        let submitters = metadata.map_or_else(Submitters::default, |bytes| {
            names::submitters(&String::from_utf8_lossy(&bytes))
        });
        let slug = folder.and_then(|name| name.strip_suffix("-submissions").map(str::to_owned));
        tree.found.sort_by(|(a, _), (b, _)| a.cmp(b));
        let mut works: BTreeMap<(String, String), Student> = BTreeMap::new();
        // Who has a folder and no file in it is somebody, too.
        let folders = tree
            .folders
            .iter()
            .map(|name| (vec![name.clone(), String::new()], None));
        let found = tree
            .found
            .into_iter()
            .map(|(names, file)| (names, Some(file)));
        for (names, file) in folders.chain(found) {
            let [first, rest @ ..] = &names[..] else {
                continue;
            };
            let moodle = names::moodle(first);
            let (key, name, number, path) = match (&moodle, rest) {
                (Some(found), _) => {
                    let parts = [found.file]
                        .into_iter()
                        .chain(rest.iter().map(String::as_str));
                    let parts: Vec<_> = parts.filter(|part| !part.is_empty()).collect();
                    let key = (found.name.to_owned(), found.number.to_owned());
                    (
                        key,
                        found.shown(),
                        Some(found.number.to_owned()),
                        parts.join("/"),
                    )
                }
                (None, []) => {
                    let name = submitters.name(first).unwrap_or_else(|| first.clone());
                    ((first.clone(), String::new()), name, None, first.clone())
                }
                (None, rest) => {
                    let name = submitters.name(first);
                    let name = name.unwrap_or_else(|| names::of_folder(first, slug.as_deref()));
                    ((first.clone(), String::new()), name, None, rest.join("/"))
                }
            };
            let student = works.entry(key).or_insert_with(|| Student {
                name,
                number,
                place: format!("{}/{first}", place.trim_end_matches('/')),
                files: Vec::new(),
                is_clone: tree.clones.contains(first),
            });
            student
                .files
                .extend(file.map(|file| HandedIn { path, ..file }));
        }
        for (folder, name) in submitters.all() {
            // A folder that is not there: what he handed in is lost, and he is not.
            works
                .entry((folder.to_owned(), String::new()))
                .or_insert_with(|| Student {
                    name,
                    number: None,
                    place: format!("{}/{folder}", place.trim_end_matches('/')),
                    files: Vec::new(),
                    is_clone: false,
                });
        }
        let mut students = with_companions(works.into_values().collect());
        self.leave_template(&mut students);
        self.students.extend(students);
    }

    /// Takes away what is equal in every folder: that was there before anybody began. Where nobody
    /// would have a picture then, they stay: so they all made one.
    fn leave_template(&self, students: &mut [Student]) {
        let is_folder = |student: &&mut Student| {
            let mut files = student.files.iter();
            files.any(|file| file.shown != student.place)
        };
        let mut works: Vec<&mut Student> = students.iter_mut().filter(is_folder).collect();
        if works.len() < 2 {
            return;
        }
        let equal: BTreeSet<String> = works[0]
            .files
            .iter()
            .filter(|file| self.is_in_all(file, &works))
            .map(|file| file.path.clone())
            .collect();
        let is_own = |file: &HandedIn| !equal.contains(&file.path);
        let is_picture = |file: &HandedIn| judge::is_named_as_picture(file.path.as_ref());
        let has_own = |student: &&mut Student| {
            let mut files = student.files.iter();
            files.any(|file| is_picture(file) && is_own(file))
        };
        let someone_has_own = works.iter().any(has_own);
        for student in &mut works {
            let stays = |file: &HandedIn| is_own(file) || is_picture(file) && !someone_has_own;
            student.files.retain(stays);
        }
    }

    fn is_in_all(&self, file: &HandedIn, works: &[&mut Student]) -> bool {
        let same = works.iter().map(|student| {
            let mut files = student.files.iter();
            files.find(|other| other.path == file.path && other.length == file.length)
        });
        let Some(same) = same.collect::<Option<Vec<_>>>() else {
            return false;
        };
        let hash = |file: &HandedIn| {
            bytes(file, &self.budget)
                .ok()
                .map(|bytes| Hash::hash(&bytes))
        };
        let Some(first) = hash(file) else {
            return false;
        };
        same[1..].iter().all(|other| hash(other) == Some(first))
    }
}

/// A file of a folder or zip file.
fn bytes(file: &HandedIn, budget: &Budget) -> Result<Vec<u8>, String> {
    match &file.content {
        Content::File(path) => files::read(path, FILE_LIMIT).map_err(|error| error.to_string()),
        Content::Entry(archive, index) => archive.read(*index, budget),
        Content::Refused(why) => Err(why.clone()),
    }
}

/// A picture that is named.
fn single(path: &Path) -> Student {
    let place = path.display().to_string();
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let moodle = names::moodle(&name);
    let file = HandedIn {
        path: place.clone(),
        shown: place.clone(),
        time: None,
        length: 0,
        content: Content::File(path.to_owned()),
        is_named: true,
    };
    Student {
        name: moodle
            .as_ref()
            .map_or_else(|| place.clone(), |found| found.shown()),
        number: moodle.map(|found| found.number.to_owned()),
        place,
        files: vec![file],
        is_clone: false,
    }
}

/// A file beside pictures belongs to the one that has its name but for the ending; the others are
/// somebody's, of whom there is nothing else.
fn with_companions(students: Vec<Student>) -> Vec<Student> {
    let stem = |student: &Student| {
        let [file] = &student.files[..] else {
            return None;
        };
        let is_alone = student.place == file.shown;
        let (stem, _) = student.place.rsplit_once('.')?;
        let is_picture = judge::is_named_as_picture(file.path.as_ref());
        is_alone.then(|| (stem.to_owned(), is_picture))
    };
    let mut kept: Vec<Student> = Vec::new();
    let mut companions = Vec::new();
    let stems: BTreeSet<String> = students
        .iter()
        .filter_map(|student| stem(student).filter(|(_, is_picture)| *is_picture))
        .map(|(stem, _)| stem)
        .collect();
    for student in students {
        match stem(&student) {
            Some((stem, false)) if stems.contains(&stem) => companions.push((stem, student)),
            _ => kept.push(student),
        }
    }
    for (of, companion) in companions {
        let mut all = kept.iter_mut();
        if let Some(student) = all.find(|one| stem(one).is_some_and(|(stem, _)| stem == of)) {
            student.files.extend(companion.files);
        }
    }
    kept
}

/// What a folder is called, also where it is `.`.
fn folder_name(path: &Path) -> Option<String> {
    let path = fs::canonicalize(path).ok()?;
    Some(path.file_name()?.to_string_lossy().into_owned())
}

fn is_zip(path: &Path) -> bool {
    let ending = path.extension();
    ending.is_some_and(|ending| ending.eq_ignore_ascii_case("zip")) && path.is_file()
}

/// What systems leave behind, and nobody handed in.
fn is_passed_over(name: &str) -> bool {
    name.starts_with('.') || matches!(name, "__MACOSX" | "Thumbs.db" | "desktop.ini")
}

/// The files below a folder, or in a zip file.
struct Tree<'o> {
    /// What is named.
    place: &'o str,
    found: Vec<Found>,
    /// The folders directly in it.
    folders: BTreeSet<String>,
    /// Those of them that are repositories.
    clones: BTreeSet<String>,
    /// Files and folders that are the teacher's.
    own: &'o [&'o Path],
}

impl<'o> Tree<'o> {
    fn new(place: &'o str, own: &'o [&'o Path]) -> Self {
        Self {
            place: place.trim_end_matches('/'),
            found: Vec::new(),
            folders: BTreeSet::new(),
            clones: BTreeSet::new(),
            own,
        }
    }

    /// Goes through a folder, whose names are those of the folders before it in what is named.
    fn walk(&mut self, folder: &Path, before: &[String]) -> io::Result<()> {
        let mut entries = fs::read_dir(folder)?.collect::<io::Result<Vec<_>>>()?;
        entries.sort_by_key(fs::DirEntry::file_name);
        for entry in entries {
            let name = entry.file_name().to_string_lossy().into_owned();
            if name == ".git" {
                self.clones.extend(before.first().cloned());
            }
            let path = entry.path();
            let is_own = || self.own.iter().any(|own| is_same_file(own, &path));
            if is_passed_over(&name) || before.len() < 2 && is_own() {
                continue;
            }
            let names = [before, &[name]].concat();
            let found = entry.metadata();
            let kind = entry.file_type()?;
            if kind.is_dir() {
                if before.is_empty() {
                    self.folders.extend(names.last().cloned());
                }
                let inner = match names.len() < DEEPEST {
                    true => self.walk(&path, &names),
                    false => Err(io::Error::other("folders are nested too deeply")),
                };
                // What is named must be readable; of what is in it one says what is not.
                if let Err(error) = inner {
                    self.push(names, Content::Refused(error.to_string()), None, 0)?;
                }
                continue;
            }
            let (length, time) = found.map_or((0, None), |found| {
                let time = found.modified().ok();
                let since = time.and_then(|time| time.duration_since(UNIX_EPOCH).ok());
                (found.len(), since.map(|since| since.as_secs() as i64))
            });
            let content = match () {
                () if kind.is_symlink() => Content::Refused("a link".to_owned()),
                () if !kind.is_file() => Content::Refused("not a file".to_owned()),
                () if is_zip(&path) => match self.unpack(&path, &names) {
                    Ok(()) => continue,
                    Err(error) => Content::Refused(error),
                },
                () => Content::File(path),
            };
            self.push(names, content, time, length)?;
        }
        Ok(())
    }

    fn push(
        &mut self,
        names: Vec<String>,
        content: Content,
        time: Option<i64>,
        length: u64,
    ) -> io::Result<()> {
        if self.found.len() == MOST_FILES {
            let message = format!("there are more than {MOST_FILES} files in it");
            return Err(io::Error::other(message));
        }
        let file = HandedIn {
            path: names.join("/"),
            shown: format!("{}/{}", self.place, names.join("/")),
            time,
            length,
            content,
            is_named: false,
        };
        self.found.push((names, file));
        Ok(())
    }

    /// Adds what is in a zip file.
    fn unpack(&mut self, path: &Path, before: &[String]) -> Result<(), String> {
        let (archive, entries) = Archive::open(path)?;
        let archive = Arc::new(archive);
        if let ([first], true) = (before, entries.is_empty()) {
            self.folders.insert(first.clone());
        }
        for entry in entries {
            // No name leads out of the zip file: what is not a folder's own is only shown.
            let parts = entry.name.split('/').map(str::to_owned);
            let parts: Vec<_> = parts
                .filter(|part| !matches!(&**part, "" | "." | ".."))
                .collect();
            if parts.is_empty() || parts.iter().any(|part| is_passed_over(part)) {
                continue;
            }
            let is_nested = is_named_as_archive(&entry.name);
            let content = match entry.refused {
                Some(why) => Content::Refused(why.to_owned()),
                None if is_nested => Content::Refused("an archive in a zip file".to_owned()),
                None => Content::Entry(archive.clone(), entry.index),
            };
            let names = [before, &parts[..]].concat();
            self.push(names, content, entry.time, entry.length)
                .map_err(|error| error.to_string())?;
        }
        Ok(())
    }

    /// Of a zip file that holds a single folder, with folders of students in it, that one is left.
    fn leave_root(&mut self) {
        let Some(root) = self.found.first().map(|(names, _)| names[0].clone()) else {
            return;
        };
        let inner: BTreeSet<&String> = self
            .found
            .iter()
            .filter_map(|(names, _)| names.get(1))
            .collect();
        let is_inside = |(names, _): &Found| names[0] == root && names.len() > 1;
        let is_class = inner.len() > 1 && self.found.iter().all(|(names, _)| names.len() > 2)
            || inner
                .iter()
                .any(|name| *name == METADATA || names::moodle(name).is_some());
        if names::moodle(&root).is_none() && is_class && self.found.iter().all(is_inside) {
            for (names, _) in &mut self.found {
                names.remove(0);
            }
        }
    }
}

fn is_named_as_archive(name: &str) -> bool {
    let ending = name.rsplit('.').next().unwrap_or_default();
    const ENDINGS: [&str; 8] = ["zip", "tar", "gz", "tgz", "rar", "7z", "xz", "bz2"];
    ENDINGS.iter().any(|own| ending.eq_ignore_ascii_case(own))
}

/// Says that there is nobody.
pub fn nobody(paths: &[PathBuf]) -> Trouble {
    let names: Vec<_> = paths.iter().map(|path| shown(path)).collect();
    Trouble(format!(
        "there are no pictures in what is named: {}",
        names.join(", ")
    ))
}
