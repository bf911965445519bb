//! Sorts the submitted files of a class by student.
//!
//! In a folder or zip file on the command line, each subfolder is the submission of one student,
//! and so is each file beside the subfolders. Moodle writes students' names into file names;
//! Gradescope lists them in a file beside the subfolders. A student without files is listed, too.

use std::{
    collections::{BTreeMap, BTreeSet},
    ffi::OsStr,
    fs,
    path::{Path, PathBuf},
};

use hmac_sha256::Hash;

use super::{
    archive::{FILE_LIMIT, UnpackBudget},
    glob::Glob,
    names::{self, Submitters},
    submission::{ContentSource, Student, SubmittedFile},
    tree::{self, FileTree, METADATA},
};
use crate::{
    cli::{
        CommandError, command_error,
        input::{is_standard, shown, unreadable},
        judge,
    },
    files,
};

/// Reason, shown to the teacher, why a file is not judged: every submission contains the same file,
/// so it comes from the assignment's template.
const TEMPLATE: &str = "equal in every folder: --picture chooses it";

/// The students of a class, with their files.
#[derive(Debug, Default)]
pub struct Class {
    pub students: Vec<Student>,
    /// Whether at least one picture on the command line does not exist or cannot be opened.
    pub is_one_missing: bool,
    /// Number of bytes that may still be unpacked from the class's zip files.
    pub budget: UnpackBudget,
}

impl Class {
    /// Reads the submissions on the command line. The teacher's own files, `own`, are left out.
    /// `chosen` is the file-name pattern in `--picture`.
    ///
    /// # Errors
    ///
    /// Returns an error if a folder or zip file on the command line cannot be read. A missing
    /// picture causes no error here; it is reported when the picture is judged.
    pub fn read(
        paths: &[PathBuf],
        own: &[&Path],
        chosen: Option<&Glob>,
    ) -> Result<Self, CommandError> {
        let mut class = Self::default();
        let mut rest: Vec<&PathBuf> = paths.iter().collect();
        for (parent, names) in expanded_classes(paths) {
            let tree = FileTree::of_some(parent, &names, own);
            let tree = tree.map_err(|error| unreadable(parent, &error))?;
            class.add(folder_name(parent), tree, chosen);
            rest.retain(|path| !(names.contains(name(path)) && parent_of(path) == parent));
        }
        for path in rest {
            if path.is_dir() {
                let tree =
                    FileTree::of_folder(path, own).map_err(|error| unreadable(path, &error))?;
                class.add(folder_name(path), tree, chosen);
            } else if tree::is_zip(path) {
                let tree = FileTree::of_zip(path).map_err(|error| unreadable(path, &error))?;
                class.add(None, tree, chosen);
            } else {
                class.is_one_missing |= !is_standard(path) && files::open_argument(path).is_err();
                class.students.push(student_of_picture(path));
            }
        }
        tell_apart(&mut class.students);
        Ok(class)
    }

    /// Adds the students in the folder or zip file `tree`. If it contains folders of whole classes,
    /// adds the students of these classes, too.
    fn add(&mut self, folder: Option<String>, mut tree: FileTree, chosen: Option<&Glob>) {
        for (name, inner) in tree.take_classes() {
            self.add(Some(name), inner, chosen);
        }
        let is_metadata = |(names, _): &tree::FoundFile| names.len() == 1 && names[0] == METADATA;
        let at = tree.found.iter().position(is_metadata);
        let metadata = at.map(|at| tree.found.swap_remove(at));
        let metadata = metadata.and_then(|(_, file)| bytes(&file, &self.budget).ok());
        let submitters = metadata.map_or_else(Submitters::default, |bytes| {
            names::submitters(&String::from_utf8_lossy(&bytes))
        });
        let slug = folder.and_then(|name| name.strip_suffix(names::CLONES).map(str::to_owned));
        tree.found.sort_by(|(a, _), (b, _)| a.cmp(b));
        let mut works: BTreeMap<(String, String), Student> = BTreeMap::new();
        // A student with an empty folder must be listed, too, so the students' folders are added to
        // the list of files.
        let folders = tree.folders.iter().filter(|names| names.len() == 1);
        let folders = folders.map(|names| (vec![names[0].clone(), String::new()], None));
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
                place: format!("{}{first}", tree.place),
                files: Vec::new(),
                is_clone: tree.clones.iter().any(|clone| clone[0] == *first),
            });
            student
                .files
                .extend(file.map(|file| SubmittedFile { path, ..file }));
        }
        for (folder, name) in submitters.all() {
            // Gradescope's metadata may name a student whose folder is missing. The student is then
            // listed without files.
            works
                .entry((folder.to_owned(), String::new()))
                .or_insert_with(|| Student {
                    name,
                    number: None,
                    place: format!("{}{folder}", tree.place),
                    files: Vec::new(),
                    is_clone: false,
                });
        }
        let mut students = with_companions(works.into_values().collect());
        self.leave_template(&mut students, chosen);
        self.students.extend(students);
    }

    /// Excludes files of the assignment's template. A file that is equal in every submission is
    /// assumed to come from the template. If it is a picture, it is kept in the list, but marked so
    /// that it is not judged; otherwise, it is removed. However, if no student has another picture,
    /// the equal pictures are judged, since all students may have rendered the same picture.
    fn leave_template(&self, students: &mut [Student], chosen: Option<&Glob>) {
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
        let is_own = |file: &SubmittedFile| !equal.contains(&file.path);
        let has_own = |student: &&mut Student| {
            let mut files = student.files.iter();
            files.any(|file| file.is_picture(chosen) && is_own(file))
        };
        let someone_has_own = works.iter().any(has_own);
        for student in &mut works {
            student
                .files
                .retain(|file| is_own(file) || file.is_picture(None) || file.is_picture(chosen));
            for file in student.files.iter_mut().filter(|file| !is_own(file)) {
                if someone_has_own || !file.is_picture(chosen) {
                    file.content = ContentSource::Refused(TEMPLATE.to_owned());
                }
            }
        }
    }

    fn is_in_all(&self, file: &SubmittedFile, works: &[&mut Student]) -> bool {
        let same = works.iter().map(|student| {
            let mut files = student.files.iter();
            files.find(|other| other.path == file.path && other.length == file.length)
        });
        let Some(same) = same.collect::<Option<Vec<_>>>() else {
            return false;
        };
        // A zip file contains a checksum (CRC-32) of each file in it, so such files can be compared
        // without unpacking.
        if file.sum.is_some() && same.iter().all(|other| other.sum.is_some()) {
            return same.iter().all(|other| other.sum == file.sum);
        }
        let hash = |file: &SubmittedFile| {
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

/// Reads a file from disk or from a zip file. Returns the reason if it cannot be read.
fn bytes(file: &SubmittedFile, budget: &UnpackBudget) -> Result<Vec<u8>, String> {
    match &file.content {
        ContentSource::File(path) => {
            files::read(path, FILE_LIMIT).map_err(|error| error.to_string())
        }
        ContentSource::Entry(archive, index) => archive.read(*index, budget),
        ContentSource::Refused(why) => Err(why.clone()),
    }
}

/// Makes a student from a picture that is named on the command line.
fn student_of_picture(path: &Path) -> Student {
    let place = path.display().to_string();
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let moodle = names::moodle(&name);
    let file = SubmittedFile {
        path: place.clone(),
        shown: place.clone(),
        time: None,
        length: 0,
        sum: None,
        content: ContentSource::File(path.to_owned()),
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

/// Merges files with the same name but different extensions into one student. For example,
/// `anna.cpp` becomes a file of the student with the picture `anna.png`. A file for which there is
/// no such picture remains a student of its own.
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

/// Detects arguments that a shell has expanded from a pattern such as `class/*`, where `class` is a
/// folder with the submissions of a class. Returns each such folder, with the names of the
/// arguments that lie directly in it.
///
/// The parent folder of an argument is assumed to be the folder of a class in three cases: the
/// argument is a Git clone; the argument's name has Moodle's form, or is that of Gradescope's
/// metadata file; or two arguments in the parent folder are folders that contain pictures of the
/// same name.
fn expanded_classes(paths: &[PathBuf]) -> BTreeMap<&Path, BTreeSet<&OsStr>> {
    let mut named = BTreeMap::<&Path, BTreeSet<&OsStr>>::new();
    for path in paths {
        let is_list = name(path) == METADATA && path.is_file();
        let is_class = path.is_dir() || tree::is_zip(path) || is_list;
        // A class folder is listed later, and links in it are not followed then. A link on the
        // command line must be followed, so it is not recorded here and is read as a folder of its
        // own. A path such as `..` is not recorded either, because it has no name.
        if is_class && !path.is_symlink() && !name(path).is_empty() {
            named.entry(parent_of(path)).or_default().insert(name(path));
        }
    }
    named.retain(|parent, names| {
        let mut pictures = BTreeSet::new();
        names.iter().any(|name| {
            let path = parent.join(name);
            let is_folder = path.is_dir();
            let is_system = *name == METADATA || names::moodle(&name.to_string_lossy()).is_some();
            let entries = fs::read_dir(&path).into_iter().flatten().flatten();
            let own: Vec<_> = entries.map(|entry| entry.file_name()).collect();
            let is_clone = own.iter().any(|name| name == ".git");
            let mut own = own
                .into_iter()
                .filter(|name| judge::is_named_as_picture(name.as_ref()));
            is_system || is_clone || is_folder && own.any(|picture| !pictures.insert(picture))
        })
    });
    named
}

fn name(path: &Path) -> &OsStr {
    path.file_name().unwrap_or_default()
}

fn parent_of(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new(""))
}

/// Returns the name of a folder, even if the path is `.`.
fn folder_name(path: &Path) -> Option<String> {
    let path = fs::canonicalize(tree::or_here(path)).ok()?;
    Some(path.file_name()?.to_string_lossy().into_owned())
}

/// Makes equal names of students distinct: appends the number that Moodle gives the submission or,
/// if there is no number, the submission's path.
fn tell_apart(students: &mut [Student]) {
    let mut counts = BTreeMap::<String, usize>::new();
    for student in &*students {
        *counts.entry(student.name.clone()).or_default() += 1;
    }
    for student in students {
        if counts[&student.name] > 1 {
            let own = student.number.as_ref().unwrap_or(&student.place);
            student.name = format!("{} ({own})", student.name);
        }
    }
}

/// Makes the error that the arguments contain no pictures of students.
pub fn no_students(paths: &[PathBuf]) -> CommandError {
    let names: Vec<_> = paths.iter().map(|path| shown(path)).collect();
    command_error(format!(
        "there are no pictures in what is named: {}",
        names.join(", ")
    ))
}
