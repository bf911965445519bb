//! A folder for what a command makes, in which nothing else is replaced.
//!
//! The folder keeps a list, `.pinhole`, of the files that were made there and the SHA-256 of what
//! was written into each, in the form that `sha256sum --check` reads. A file that is not in it, or
//! no longer has one of its hashes, is somebody's own.

use std::{
    collections::BTreeMap,
    fs, io,
    path::{Path, PathBuf},
    sync::atomic::AtomicBool,
};

use hmac_sha256::Hash;

use super::{
    kind::{Kind, folder, read},
    original::Original,
    words::in_words,
    write::{Purpose, check_writable, write},
};

/// The list's name.
const LIST: &str = ".pinhole";

/// Its first line.
const HEAD: &str = "# Files that pinhole made here, and replaces unless they were changed\n";

/// A list with more bytes is none.
const LIST_LIMIT: u64 = 16 << 20;

/// A file with more bytes is none that was made here.
const FILE_LIMIT: u64 = 256 << 20;

/// A folder for what a command makes.
#[derive(Debug)]
pub struct OutputFolder {
    path: PathBuf,
    /// What was made there: a file's name, in which `/` stands between folders, and the hashes of
    /// what it may hold.
    made: BTreeMap<String, Vec<String>>,
}

/// Why nothing is written, and because of what.
#[derive(Debug)]
pub struct NotWritten {
    /// The file or folder.
    pub path: PathBuf,
    /// What is wrong with it.
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
    /// The folder at a path, which is made if there is none, for files with these names.
    ///
    /// # Errors
    ///
    /// It cannot be made or written to, or a file there is in the way. Nothing was written.
    pub fn open<'n>(
        path: &Path,
        names: impl IntoIterator<Item = &'n str>,
    ) -> Result<Self, NotWritten> {
        let failed = |error| NotWritten::new(path, error);
        match fs::metadata(path) {
            Ok(found) if !found.is_dir() => {
                let message = format!("it is {}, not a folder", Kind::of(&found));
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
            made: BTreeMap::new(),
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

    /// Writes files, after it has looked at all of them.
    ///
    /// # Errors
    ///
    /// A file in the way, which is known before the first one is written, unless another program
    /// puts it there meanwhile; or what kept one from being written. Those after it are missing.
    pub fn write<T: AsRef<[u8]>>(&mut self, files: &[(String, T)]) -> Result<(), NotWritten> {
        // Another run may have made other files here since it was opened.
        let list = self.read_list()?;
        for (name, _) in files {
            self.check(name)?;
        }
        // Wherever this process is ended, the list has what each file holds by then.
        for (name, text) in files {
            let hashes = self.made.entry(name.clone()).or_default();
            let hash = hash(text.as_ref());
            if !hashes.contains(&hash) {
                hashes.push(hash);
            }
        }
        self.write_list(&list)?;
        for (name, text) in files {
            // Another program may have put something there while those before it were written.
            let original = self.check(name)?;
            let path = self.path.join(name);
            let folder = folder(&path);
            fs::create_dir_all(folder).map_err(|error| NotWritten::new(folder, error))?;
            self.write_one(name, &original, text.as_ref())?;
        }
        let list = self.read_list()?;
        for (name, text) in files {
            self.made.insert(name.clone(), vec![hash(text.as_ref())]);
        }
        self.write_list(&list)
    }

    /// Writes a file, if what was there before still is.
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

    /// Reads the list of what was made.
    fn read_list(&mut self) -> Result<Original, NotWritten> {
        let path = self.path.join(LIST);
        let list = list(&path).map_err(|error| NotWritten::new(&path, error))?;
        self.made = made(&list).map_err(|error| NotWritten::new(&path, error))?;
        Ok(list)
    }

    /// Writes the list in the place of the one that was read.
    fn write_list(&self, original: &Original) -> Result<(), NotWritten> {
        let text = self.list();
        match original.bytes() == Some(text.as_bytes()) {
            true => Ok(()),
            false => self.write_one(LIST, original, text.as_bytes()),
        }
    }

    fn list(&self) -> String {
        let lines = self.made.iter().flat_map(|(name, hashes)| {
            let line = move |hash| format!("{hash}  {name}\n");
            hashes.iter().map(line)
        });
        HEAD.to_owned() + &lines.collect::<String>()
    }

    /// Reads what there is of a name. Refuses what was not made here, or was changed since, and a
    /// folder on the way to it that is none.
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
        match Kind::of(&found) {
            _ if found.is_symlink() => return Err(refused(LINK)),
            Kind::File => {}
            kind => return Err(kind.refused()),
        }
        let Some(hashes) = self.made.get(name) else {
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
    match Kind::of(&found) {
        _ if found.is_symlink() => Err(refused(LINK)),
        Kind::Folder => Ok(()),
        _ => Err(refused(
            "it is in the place of a folder: move it away, or name another folder",
        )),
    }
}

fn refused(message: &str) -> io::Error {
    io::Error::new(io::ErrorKind::AlreadyExists, message)
}

const LINK: &str = "it is a symbolic link, and nothing is written outside of the folder";

/// What there is of a list.
fn list(path: &Path) -> io::Result<Original> {
    match fs::symlink_metadata(path) {
        Ok(found) if found.is_symlink() => return Err(io::Error::other(LINK)),
        Ok(_) => {}
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Original::missing()),
        Err(error) => return Err(error),
    }
    Original::read(path, |path| read(path, LIST_LIMIT))
}

/// What a list says was made.
fn made(list: &Original) -> io::Result<BTreeMap<String, Vec<String>>> {
    let Some(bytes) = list.bytes() else {
        return Ok(BTreeMap::new());
    };
    let no_list = || {
        let message =
            "it is no list of files that pinhole made: move it away, or name another folder";
        io::Error::new(io::ErrorKind::InvalidData, message)
    };
    let text = std::str::from_utf8(bytes).map_err(|_| no_list())?;
    let mut made = BTreeMap::<_, Vec<_>>::new();
    for line in text.strip_prefix(HEAD).ok_or_else(no_list)?.lines() {
        let (hash, name) = line.split_once("  ").ok_or_else(no_list)?;
        made.entry(name.to_owned())
            .or_default()
            .push(hash.to_owned());
    }
    Ok(made)
}

fn hash(bytes: &[u8]) -> String {
    let digits = Hash::hash(bytes).into_iter();
    digits.map(|byte| format!("{byte:02x}")).collect()
}
