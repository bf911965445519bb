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
    kind::{Kind, read},
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
        let failed = |error| NotWritten {
            path: path.to_owned(),
            error,
        };
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
        let list = path.join(LIST);
        let about_list = |error| NotWritten {
            path: list.clone(),
            error,
        };
        let made = made(&list).map_err(about_list)?;
        check_writable(&list, Purpose::Within(path)).map_err(about_list)?;
        let folder = Self {
            path: path.to_owned(),
            made,
        };
        names.into_iter().try_for_each(|name| folder.check(name))?;
        Ok(folder)
    }

    /// Writes files, after it has looked at all of them.
    ///
    /// # Errors
    ///
    /// A file in the way, which is known before the first one is written, unless another program
    /// puts it there meanwhile; or what kept one from being written. Those after it are missing.
    pub fn write<T: AsRef<[u8]>>(&mut self, files: &[(String, T)]) -> Result<(), NotWritten> {
        for (name, _) in files {
            self.check(name)?;
        }
        let before = self.made.clone();
        // Wherever this process is ended, the list has what each file holds by then.
        for (name, text) in files {
            let hashes = self.made.entry(name.clone()).or_default();
            hashes.push(hash(text.as_ref()));
        }
        if self.made != before {
            self.write_one(LIST, self.list().as_bytes())?;
        }
        for (name, text) in files {
            // Another program may have put something there while those before it were written.
            self.check(name)?;
            if let Some(folder) = self.path.join(name).parent() {
                fs::create_dir_all(folder).map_err(|error| NotWritten {
                    path: folder.to_owned(),
                    error,
                })?;
            }
            self.write_one(name, text.as_ref())?;
        }
        for (name, text) in files {
            self.made.insert(name.clone(), vec![hash(text.as_ref())]);
        }
        self.write_one(LIST, self.list().as_bytes())
    }

    fn write_one(&self, name: &str, bytes: &[u8]) -> Result<(), NotWritten> {
        let path = self.path.join(name);
        let go_on = AtomicBool::new(false);
        let purpose = Purpose::Within(&self.path);
        write(&path, purpose, &go_on, |out| out.write_all(bytes))
            .map_err(|error| NotWritten { path, error })
    }

    fn list(&self) -> String {
        let lines = self.made.iter().flat_map(|(name, hashes)| {
            let line = move |hash| format!("{hash}  {name}\n");
            hashes.iter().map(line)
        });
        HEAD.to_owned() + &lines.collect::<String>()
    }

    /// Refuses a name at which there is something that was not made here, or was changed since, and
    /// a folder on the way to it that is none.
    fn check(&self, name: &str) -> Result<(), NotWritten> {
        let mut path = self.path.clone();
        let mut parts = name.split('/').peekable();
        while let Some(part) = parts.next() {
            path.push(part);
            let is_last = parts.peek().is_none();
            match self.check_part(&path, is_last.then_some(name)) {
                Ok(()) => {}
                Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
                Err(error) => return Err(NotWritten { path, error }),
            }
        }
        Ok(())
    }

    fn check_part(&self, path: &Path, file: Option<&str>) -> io::Result<()> {
        let refused = |message| Err(io::Error::new(io::ErrorKind::AlreadyExists, message));
        let found = fs::symlink_metadata(path)?;
        let Some(name) = file else {
            return match Kind::of(&found) {
                _ if found.is_symlink() => refused(LINK),
                Kind::Folder => Ok(()),
                _ => {
                    refused("it is in the place of a folder: move it away, or name another folder")
                }
            };
        };
        match Kind::of(&found) {
            _ if found.is_symlink() => return refused(LINK),
            Kind::File => {}
            kind => return Err(kind.refused()),
        }
        let Some(hashes) = self.made.get(name) else {
            return refused("pinhole did not make this file: move it away, or name another folder");
        };
        match read(path, FILE_LIMIT) {
            Ok(bytes) if hashes.contains(&hash(&bytes)) => Ok(()),
            Err(error) if error.kind() != io::ErrorKind::FileTooLarge => Err(error),
            _ => refused(
                "it was changed since pinhole made it: move it away, or name another folder",
            ),
        }
    }
}

const LINK: &str = "it is a symbolic link, and nothing is written outside of the folder";

/// What a list says was made.
fn made(list: &Path) -> io::Result<BTreeMap<String, Vec<String>>> {
    match fs::symlink_metadata(list) {
        Ok(found) if found.is_symlink() => return Err(io::Error::other(LINK)),
        Ok(_) => {}
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(BTreeMap::new()),
        Err(error) => return Err(error),
    }
    let no_list = || {
        let message =
            "it is no list of files that pinhole made: move it away, or name another folder";
        io::Error::new(io::ErrorKind::InvalidData, message)
    };
    let text = String::from_utf8(read(list, LIST_LIMIT)?).map_err(|_| no_list())?;
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
