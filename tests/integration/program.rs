//! The program as it is called from outside.

use std::{
    ffi::OsStr,
    fs,
    io::Write,
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
};

use serde_json::Value;
use tempfile::TempDir;

/// The program in a folder, whatever the environment says of languages and terminals.
pub fn command(folder: &Path, arguments: &[impl AsRef<OsStr>]) -> Command {
    any_command(env!("CARGO_BIN_EXE_pinhole"), folder, arguments)
}

fn any_command(program: &str, folder: &Path, arguments: &[impl AsRef<OsStr>]) -> Command {
    let mut command = Command::new(program);
    command
        .args(arguments)
        .current_dir(folder)
        .env("LC_ALL", "C.UTF-8")
        .env_remove("NO_COLOR")
        .env_remove("NO_GRAPHICS")
        .stdin(Stdio::null());
    command
}

/// The names of what is in a folder, sorted.
pub fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<_> = names.collect();
    names.sort();
    names
}

/// The words of a line as a shell takes them: blanks are between them, but for those in single
/// quotes.
pub fn words(line: &str) -> Vec<String> {
    let mut words = Vec::new();
    let mut word: Option<String> = None;
    let mut is_quoted = false;
    for letter in line.chars() {
        match letter {
            '\'' => {
                is_quoted = !is_quoted;
                word.get_or_insert_default();
            }
            _ if letter.is_whitespace() && !is_quoted => words.extend(word.take()),
            _ => word.get_or_insert_default().push(letter),
        }
    }
    words.extend(word);
    words
}

/// What a call came to.
pub struct Said {
    pub status: i32,
    pub output: Vec<u8>,
    pub errors: String,
}

impl Said {
    pub fn text(&self) -> &str {
        std::str::from_utf8(&self.output).unwrap()
    }

    /// The output's only line.
    pub fn json(&self) -> Value {
        let text = self.text();
        assert!(text.ends_with('\n') && text.lines().count() == 1, "{text}");
        serde_json::from_str(text).unwrap()
    }
}

impl From<Output> for Said {
    fn from(output: Output) -> Self {
        Self {
            status: output.status.code().expect("the process was not killed"),
            output: output.stdout,
            errors: String::from_utf8(output.stderr).unwrap(),
        }
    }
}

/// A folder of its own, in which the program is called by lines as one types them.
pub struct Folder(TempDir);

impl Folder {
    pub fn with<'f>(files: impl IntoIterator<Item = (&'f str, &'f str)>) -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        for (name, text) in files {
            folder.write(name, text);
        }
        folder
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Writes a file, in a folder that is made if there is none.
    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        let path = self.path(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, content).unwrap();
    }

    pub fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    pub fn text(&self, name: &str) -> String {
        String::from_utf8(self.read(name)).unwrap()
    }

    pub fn names(&self) -> Vec<String> {
        names(self.0.path())
    }

    pub fn command(&self, line: &str) -> Command {
        command(self.0.path(), &words(line))
    }

    /// What a shell does with a line in which the program is called `pinhole`.
    pub fn shell(&self, line: &str) -> Said {
        let program = Path::new(env!("CARGO_BIN_EXE_pinhole")).parent().unwrap();
        let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap());
        let mut shell = any_command("sh", self.0.path(), &["-c", line]);
        shell.env("PATH", path).output().unwrap().into()
    }

    pub fn run(&self, line: &str) -> Said {
        self.command(line).output().unwrap().into()
    }

    /// What a command says that has something on its standard input.
    pub fn run_reading(&self, line: &str, input: impl AsRef<[u8]>) -> Said {
        let mut command = self.command(line);
        let command = command.stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.stderr(Stdio::piped()).spawn().unwrap();
        // A command that does not read its input may be gone already.
        let _ = child.stdin.take().unwrap().write_all(input.as_ref());
        child.wait_with_output().unwrap().into()
    }

    /// The output of what has to be done without a word.
    #[track_caller]
    pub fn done(&self, line: &str) -> Said {
        let said = self.run(line);
        assert_eq!((said.status, said.errors.as_str()), (0, ""), "{line}");
        said
    }

    /// What is told to people, and to nobody else, by what ends with this status.
    #[track_caller]
    pub fn told(&self, line: &str, status: i32) -> String {
        let Said {
            status: found,
            output,
            errors,
        } = self.run(line);
        assert_eq!((found, output), (status, Vec::new()), "{line}: {errors}");
        errors
    }
}
