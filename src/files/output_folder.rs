//! A folder for the output files of a command, in which the user's own files are never replaced.
//!
//! The folder contains a list, `.pinhole`, of the files that Pinhole wrote there, with the SHA-256
//! of each content, in the format that `sha256sum --check` reads. A file that is not in the list,
//! or has another hash, belongs to the user.

use std::{
    collections::BTreeMap,
    fs, io,
    path::{Path, PathBuf},
    sync::atomic::AtomicBool,
};

use hmac_sha256::Hash;

use super::{
    error_words::in_words,
    kind::{FileKind, folder, read},
    original::Original,
    write::{Purpose, check_writable, write},
};

/// Name of the file in which the names and the hashes of Pinhole's files in the folder are listed.
const LIST: &str = ".pinhole";

/// First line of the file [`LIST`], for people who open it.
const HEAD: &str = "# Files that pinhole made here, and replaces unless they were changed\n";

/// Maximum length of the file [`LIST`], in bytes. A longer one is an error.
const LIST_LIMIT: u64 = 16 << 20;

/// Maximum length, in bytes, of a file that Pinhole wrote into the folder. A longer file cannot be
/// Pinhole's, so it is not replaced.
const FILE_LIMIT: u64 = 256 << 20;

/// A folder for the output files of a command, in which no file of the user is replaced.
#[derive(Debug)]
pub struct OutputFolder {
    path: PathBuf,
    /// For each file that Pinhole wrote: its name, with `/` between folders, and the hashes that
    /// its content may have.
    hashes: BTreeMap<String, Vec<String>>,
}

/// Error that a file or a folder prevents the files from being written.
#[derive(Debug)]
pub struct NotWritten {
    /// Path of the file or folder.
    pub path: PathBuf,
    /// The cause of the error, in words.
    pub error: io::Error,
}

impl NotWritten {
    fn new(path: &Path, error: io::Error) -> Self {
        Self {
            path: path.to_owned(),
            error: in_words(error),
        }
    }
}

impl OutputFolder {
    /// Opens the folder at `path` for files with the given names. Creates the folder if it is
    /// missing.
    ///
    /// # Errors
    ///
    /// The folder cannot be created or written to, or one of the names is taken by a file of the
    /// user. In both cases, no file was written.
    pub fn open<'n>(
        path: &Path,
        names: impl IntoIterator<Item = &'n str>,
    ) -> Result<Self, NotWritten> {
        let failed = |error| NotWritten::new(path, error);
        match fs::metadata(path) {
            Ok(found) if !found.is_dir() => {
                let message = format!("it is {}, not a folder", FileKind::of(&found));
                return Err(failed(io::Error::new(
                    io::ErrorKind::NotADirectory,
                    message,
                )));
            }
            Ok(_) => {}
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                fs::create_dir_all(path).map_err(failed)?;
            }
            Err(error) => return Err(failed(error)),
        }
        let mut folder = Self {
            path: path.to_owned(),
            hashes: BTreeMap::new(),
        };
        folder.read_list()?;
        let list = path.join(LIST);
        check_writable(&list, Purpose::Within(path))
            .map_err(|error| NotWritten::new(&list, error))?;
        for name in names {
            folder.check(name)?;
        }
        Ok(folder)
    }

    /// Writes files, after checking that none of them would replace a file of the user.
    ///
    /// # Errors
    ///
    /// A file of the user is in the way, or a file cannot be written. All files of the user are
    /// usually found before any file is written. Otherwise, the files after the failing one are
    /// missing.
    pub fn write<T: AsRef<[u8]>>(&mut self, files: &[(String, T)]) -> Result<(), NotWritten> {
        // Another run may have written other files here since the folder was opened.
        let list = self.read_list()?;
        for (name, _) in files {
            self.check(name)?;
        }
        // The new hashes are added to the list before any file is written. If this process is ended
        // at any time, the list therefore contains the hash of each file's content, old or new.
        for (name, text) in files {
            let hashes = self.hashes.entry(name.clone()).or_default();
            let hash = hash(text.as_ref());
            if !hashes.contains(&hash) {
                hashes.push(hash);
            }
        }
        self.write_list(&list)?;
        for (name, text) in files {
            // Another program may have created a file of this name while other files were written.
            let original = self.check(name)?;
            let path = self.path.join(name);
            let folder = folder(&path);
            fs::create_dir_all(folder).map_err(|error| NotWritten::new(folder, error))?;
            self.write_one(name, &original, text.as_ref())?;
        }
        let list = self.read_list()?;
        for (name, text) in files {
            self.hashes.insert(name.clone(), vec![hash(text.as_ref())]);
        }
        self.write_list(&list)
    }

    /// Writes the file `name` if the file at its path is still `original`.
    fn write_one(&self, name: &str, original: &Original, bytes: &[u8]) -> Result<(), NotWritten> {
        let path = self.path.join(name);
        let go_on = AtomicBool::new(false);
        let purpose = Purpose::Again {
            within: &self.path,
            original,
        };
        write(&path, purpose, &go_on, |out| out.write_all(bytes))
            .map_err(|error| NotWritten { path, error })
    }

    /// Reads `.pinhole`, the list of the files that Pinhole wrote into the folder, and sets
    /// `hashes` to the hashes in it. Returns `.pinhole` as it was read.
    fn read_list(&mut self) -> Result<Original, NotWritten> {
        let path = self.path.join(LIST);
        let list = read_list_file(&path).map_err(|error| NotWritten::new(&path, error))?;
        self.hashes = parse_list(&list).map_err(|error| NotWritten::new(&path, error))?;
        Ok(list)
    }

    /// Writes `hashes` into the list `.pinhole`, unless the file already contains them. Fails if
    /// the file is no longer `original`.
    fn write_list(&self, original: &Original) -> Result<(), NotWritten> {
        let text = self.list();
        if original.bytes() == Some(text.as_bytes()) {
            return Ok(());
        }
        self.write_one(LIST, original, text.as_bytes())
    }

    fn list(&self) -> String {
        let lines = self.hashes.iter().flat_map(|(name, hashes)| {
            let line = move |hash| format!("{hash}  {name}\n");
            hashes.iter().map(line)
        });
        HEAD.to_owned() + &lines.collect::<String>()
    }

    /// Reads the file `name`, if it exists. Fails if Pinhole did not write the file, if it was
    /// changed since, or if a part of its path is not a folder.
    fn check(&self, name: &str) -> Result<Original, NotWritten> {
        let mut path = self.path.clone();
        let mut parts = name.split('/').peekable();
        let mut original = Original::missing();
        while let Some(part) = parts.next() {
            path.push(part);
            let checked = match parts.peek() {
                Some(_) => check_folder(&path),
                None => self.check_file(&path, name).map(|found| original = found),
            };
            match checked {
                Ok(()) => {}
                Err(error) if error.kind() == io::ErrorKind::NotFound => break,
                Err(error) => return Err(NotWritten::new(&path, error)),
            }
        }
        Ok(original)
    }

    fn check_file(&self, path: &Path, name: &str) -> io::Result<Original> {
        let found = fs::symlink_metadata(path)?;
        match FileKind::of(&found) {
            _ if found.is_symlink() => return Err(refused(LINK)),
            FileKind::File => {}
            kind => return Err(kind.refused()),
        }
        let Some(hashes) = self.hashes.get(name) else {
            return Err(refused(
                "pinhole did not make this file: move it away, or name another folder",
            ));
        };
        let is_made = |bytes: &[u8]| hashes.contains(&hash(bytes));
        match Original::read(path, |path| read(path, FILE_LIMIT)) {
            Ok(found) if found.bytes().is_some_and(is_made) => Ok(found),
            Err(error) if error.kind() != io::ErrorKind::FileTooLarge => Err(error),
            _ => Err(refused(
                "it was changed since pinhole made it: move it away, or name another folder",
            )),
        }
    }
}

fn check_folder(path: &Path) -> io::Result<()> {
    let found = fs::symlink_metadata(path)?;
    match FileKind::of(&found) {
        _ if found.is_symlink() => Err(refused(LINK)),
        FileKind::Folder => Ok(()),
        _ => Err(refused(
            "it is in the place of a folder: move it away, or name another folder",
        )),
    }
}

fn refused(message: &str) -> io::Error {
    io::Error::new(io::ErrorKind::AlreadyExists, message)
}

const LINK: &str = "it is a symbolic link, and nothing is written outside of the folder";

/// Reads the file [`LIST`] at `path`, if it exists. Fails if the path is a symbolic link.
fn read_list_file(path: &Path) -> io::Result<Original> {
    match fs::symlink_metadata(path) {
        Ok(found) if found.is_symlink() => return Err(io::Error::other(LINK)),
        Ok(_) => {}
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Original::missing()),
        Err(error) => return Err(error),
    }
    Original::read(path, |path| read(path, LIST_LIMIT))
}

/// Parses the content of the file [`LIST`]. Returns the hashes of each file in the list, by its
/// name.
fn parse_list(list: &Original) -> io::Result<BTreeMap<String, Vec<String>>> {
    let Some(bytes) = list.bytes() else {
        return Ok(BTreeMap::new());
    };
    let no_list = || {
        let message =
            "it is no list of files that pinhole made: move it away, or name another folder";
        io::Error::new(io::ErrorKind::InvalidData, message)
    };
    let text = std::str::from_utf8(bytes).map_err(|_| no_list())?;
    let mut hashes = BTreeMap::<_, Vec<_>>::new();
    for line in text.strip_prefix(HEAD).ok_or_else(no_list)?.lines() {
        let (hash, name) = line.split_once("  ").ok_or_else(no_list)?;
        hashes
            .entry(name.to_owned())
            .or_default()
            .push(hash.to_owned());
    }
    Ok(hashes)
}

fn hash(bytes: &[u8]) -> String {
    let digest = Hash::hash(bytes);
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}
