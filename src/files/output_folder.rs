//! A folder for the output files of a command, in which files of the user are never replaced.
//!
//! The folder contains a list, `.pinhole`, of the files that Pinhole wrote there. The list contains
//! the SHA-256 hash of each file's content, in the format that `sha256sum --check` reads. Any file
//! that is not in the list, or has another hash, belongs to the user.

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

/// Name of the list of the files that Pinhole wrote into an output folder.
const LIST: &str = ".pinhole";

/// First line of the list [`LIST`]. It explains the list to people who open it.
const HEAD: &str = "# Files that pinhole made here, and replaces unless they were changed\n";

/// Maximum length of the list [`LIST`], in bytes. A longer list is an error. A line has about a
/// hundred bytes, so 16 MiB suffice for more than a hundred thousand files.
const LIST_LIMIT: u64 = 16 << 20;

/// Maximum length, in bytes, of an existing file that may be replaced. Pinhole's output files are
/// far shorter, so a longer file must have been changed by the user. It is not replaced, and not
/// read completely.
const FILE_LIMIT: u64 = 256 << 20;

/// A folder for the output files of a command. No file of the user is replaced in it.
#[derive(Debug)]
pub struct OutputFolder {
    path: PathBuf,
    /// SHA-256 hashes of the files that Pinhole wrote. The key is the file's path in the folder,
    /// with `/` between the names. While a file is being written, there are two hashes, of its old
    /// and of its new content.
    hashes: BTreeMap<String, Vec<String>>,
}

/// Error: output files cannot be written because of a file or a folder.
#[derive(Debug)]
pub struct NotWritten {
    /// Path of the file or folder that caused the error.
    pub path: PathBuf,
    /// The cause of the error, in plain words.
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
    /// Opens the folder at `path` to write files with the given names into it. Creates the folder
    /// if it is missing.
    ///
    /// # Errors
    ///
    /// The folder cannot be created or written to, or the user has a file with one of these names.
    /// No file is written in this case.
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

    /// Writes files into the folder. Checks first that no file of the user would be replaced.
    ///
    /// # Errors
    ///
    /// The user has a file with one of the names, or a file cannot be written. The check finds most
    /// errors before any file is written. If writing a file fails later, the files before it in
    /// `files` have been written already.
    pub fn write<T: AsRef<[u8]>>(&mut self, files: &[(String, T)]) -> Result<(), NotWritten> {
        // Another process may have written files into the folder since it was opened, so the list
        // is read again.
        let list = self.read_list()?;
        for (name, _) in files {
            self.check(name)?;
        }
        // The new hashes are added to the list before any file is written, and the old ones are
        // kept. If this process is killed while it writes, the list contains the hashes of all old
        // and all new files, so none of them is taken for a file of the user.
        for (name, text) in files {
            let hashes = self.hashes.entry(name.clone()).or_default();
            let hash = hash(text.as_ref());
            if !hashes.contains(&hash) {
                hashes.push(hash);
            }
        }
        self.write_list(&list)?;
        for (name, text) in files {
            // The file is checked again, since another program may have created it meanwhile.
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

    /// Writes the file `name`, unless it has changed since it was read as `original`.
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

    /// Reads the list [`LIST`] and sets `hashes` to its content. Returns the list's file as it was
    /// read.
    fn read_list(&mut self) -> Result<Original, NotWritten> {
        let path = self.path.join(LIST);
        let list = read_list_file(&path).map_err(|error| NotWritten::new(&path, error))?;
        self.hashes = parse_list(&list).map_err(|error| NotWritten::new(&path, error))?;
        Ok(list)
    }

    /// Writes `hashes` into the list [`LIST`], unless the list already contains exactly these
    /// hashes. Fails if the list has changed since it was read as `original`.
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

    /// Reads the file `name`, if it exists. Fails if it belongs to the user, or if a part of its
    /// path is not a folder.
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

/// Reads the list [`LIST`] at `path`, if it exists. Fails if it is a symbolic link.
fn read_list_file(path: &Path) -> io::Result<Original> {
    match fs::symlink_metadata(path) {
        Ok(found) if found.is_symlink() => return Err(io::Error::other(LINK)),
        Ok(_) => {}
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Original::missing()),
        Err(error) => return Err(error),
    }
    Original::read(path, |path| read(path, LIST_LIMIT))
}

/// Parses the list [`LIST`]. Returns the hashes of each file, by the file's name.
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
