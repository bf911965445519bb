//! Runs the tested program as a user would.

use std::{
    ffi::OsStr,
    fs,
    io::Write,
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
};

use serde_json::Value;
use tempfile::TempDir;

/// Returns a command that runs the program in a folder. The locale and the variables `NO_COLOR` and
/// `NO_GRAPHICS` of the caller's environment do not affect it.
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

/// Returns the sorted names of the entries of a folder.
pub fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<_> = names.collect();
    names.sort();
    names
}

/// Splits a line into words as a shell does: at white space outside of single quotes.
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

/// Exit status and output of a command.
pub struct Outcome {
    pub status: i32,
    pub output: Vec<u8>,
    pub errors: String,
}

impl Outcome {
    pub fn text(&self) -> &str {
        std::str::from_utf8(&self.output).unwrap()
    }

    /// Parses the output, which must be a single line of JSON.
    pub fn json(&self) -> Value {
        let text = self.text();
        assert!(text.ends_with('\n') && text.lines().count() == 1, "{text}");
        serde_json::from_str(text).unwrap()
    }
}

impl From<Output> for Outcome {
    fn from(output: Output) -> Self {
        Self {
            status: output.status.code().expect("the process was not killed"),
            output: output.stdout,
            errors: String::from_utf8(output.stderr).unwrap(),
        }
    }
}

/// A temporary folder in which the program is run. The methods that run a command get its arguments
/// as one line, which [`words`] splits.
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

    /// Writes a file, and creates its parent folder if it does not exist.
    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        let path = self.path(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, content).unwrap();
    }

    /// Creates a named pipe.
    #[cfg(unix)]
    pub fn make_pipe(&self, name: &str) {
        let made = Command::new("mkfifo").arg(self.path(name)).status();
        assert!(made.unwrap().success());
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

    /// Runs a line in a shell, in which the tested program can be called as `pinhole`.
    pub fn shell(&self, line: &str) -> Outcome {
        let program = Path::new(env!("CARGO_BIN_EXE_pinhole")).parent().unwrap();
        let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap());
        let mut shell = any_command("sh", self.0.path(), &["-c", line]);
        shell.env("PATH", path).output().unwrap().into()
    }

    pub fn run(&self, line: &str) -> Outcome {
        self.command(line).output().unwrap().into()
    }

    /// Runs a command with `input` as its standard input.
    pub fn run_reading(&self, line: &str, input: impl AsRef<[u8]>) -> Outcome {
        let mut command = self.command(line);
        let command = command.stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.stderr(Stdio::piped()).spawn().unwrap();
        // Writing fails if the command ends without reading its input. A command may do so, so the
        // failure is ignored.
        let _ = child.stdin.take().unwrap().write_all(input.as_ref());
        child.wait_with_output().unwrap().into()
    }

    /// Runs a command that must succeed and print nothing to standard error. Returns its status and
    /// output.
    #[track_caller]
    pub fn done(&self, line: &str) -> Outcome {
        let said = self.run(line);
        assert_eq!((said.status, said.errors.as_str()), (0, ""), "{line}");
        said
    }

    /// Runs a command that must end with the exit status `status` and print nothing to standard
    /// output. Returns its standard error.
    #[track_caller]
    pub fn told(&self, line: &str, status: i32) -> String {
        let Outcome {
            status: found,
            output,
            errors,
        } = self.run(line);
        assert_eq!((found, output), (status, Vec::new()), "{line}: {errors}");
        errors
    }
}
