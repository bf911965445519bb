//! The command line. Each command has a file: it reads input, calls the library, and prints the
//! result.
//!
//! Pictures and JSON go to standard output, and texts for people to standard error. The exit status
//! is 0 for success, with or without warnings; 1 if the scene has errors, pictures differ, or `fmt
//! --check` would change something; 2 for any other error; and 130 after Ctrl-C.

mod args;
mod check;
mod diff;
mod exact_pictures;
mod explain;
mod figure;
mod fmt;
mod frames;
mod grade;
mod help;
mod input;
mod inspect;
mod interrupt;
mod judge;
mod layout_diff;
mod lesson;
#[cfg(feature = "lsp")]
mod lsp;
mod manual;
mod merge;
mod new;
mod output;
mod picture;
mod probe;
mod progress;
mod render;
mod report;
mod shard;
mod sheet;
mod show;
mod speed;
#[cfg(feature = "studio")]
mod studio;
mod sweep;
mod unified_diff;
mod watch;

use std::{
    env,
    ffi::OsString,
    io,
    path::{Path, PathBuf},
    process::ExitCode,
};

use clap::Parser;

pub use self::interrupt::Interrupt;

use self::args::{Args, Command};
use crate::{diagnostic::visible_line, render::RenderError, threads};

/// Runs the program with the arguments of this process. Handles Ctrl-C. Returns the exit status.
pub fn run() -> ExitCode {
    let interrupt = Interrupt::default();
    match interrupt.listen() {
        Ok(()) => run_with(env::args_os(), &interrupt).into(),
        Err(error) => status_of(Err(error)).into(),
    }
}

/// Runs the command that the arguments name, and returns its exit status. The first argument is the
/// program's name. A caller that handles signals itself, such as the Python package, reports the
/// signals to `interrupt`.
pub fn run_with(args: impl IntoIterator<Item = OsString>, interrupt: &Interrupt) -> u8 {
    let args: Vec<OsString> = args.into_iter().collect();
    let status = match Args::try_parse_from(&args) {
        Ok(args) => status_of(command(args.command, interrupt)),
        Err(answer) => print_answer(&visible_answer(args).unwrap_or(answer)),
    };
    status as u8
}

fn command(command: Command, interrupt: &Interrupt) -> Result<Status, CommandError> {
    if let Some(wanted) = command.threads() {
        threads::limit(wanted);
    }
    match command {
        Command::Render(args) => render::run(&args, interrupt),
        Command::Check(args) => check::run(&args, interrupt),
        Command::New(args) => new::run(&args, interrupt),
        Command::Watch(args) => watch::run(&args, interrupt),
        Command::Inspect(args) => inspect::run(&args),
        Command::Probe(args) => probe::run(&args),
        Command::Diff(args) => diff::run(&args, interrupt),
        Command::Grade(args) => grade::run(&args, interrupt),
        Command::Report(args) => report::run(&args, interrupt),
        Command::Merge(args) => merge::run(&args, interrupt),
        Command::Sheet(args) => sheet::run(&args, interrupt),
        Command::Figure(args) => figure::run(&args, interrupt),
        Command::Lesson { command } => lesson::run(&command),
        Command::Explain(args) => explain::run(&args),
        Command::Fmt(args) => fmt::run(&args, interrupt),
        #[cfg(feature = "lsp")]
        Command::Lsp { .. } => lsp::run(),
        #[cfg(feature = "studio")]
        Command::Studio(args) => studio::run(&args, interrupt),
        Command::Completions { shell } => manual::completions(shell),
        Command::Man => manual::man(),
    }
}

/// Makes the control characters in the arguments visible, parses the arguments again, and returns
/// clap's error or help text. This text repeats arguments, whose control characters must not reach
/// the terminal. Returns `None` if clap accepts the changed arguments.
fn visible_answer(args: Vec<OsString>) -> Option<clap::Error> {
    let shown = |argument: OsString| visible_line(&argument.to_string_lossy()).into_owned();
    Args::try_parse_from(args.into_iter().map(shown)).err()
}

/// Prints clap's answer: a help text, the version, or an error in the arguments. Returns the exit
/// status.
fn print_answer(answer: &clap::Error) -> Status {
    let status = if answer.use_stderr() {
        Status::Failed
    } else {
        Status::Done
    };
    match answer.print() {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            output::error(&format!("cannot write to standard output: {error}"));
            Status::Failed
        }
        _ => status,
    }
}

/// Calls `one` for each scene in turn, and prints its errors. Returns the largest of the exit
/// statuses.
fn each(
    scenes: &[PathBuf],
    interrupt: &Interrupt,
    one: impl Fn(&Path) -> Result<Status, CommandError>,
) -> Status {
    let mut status = Status::Done;
    for path in scenes {
        status = status.max(status_of(one(path)));
        if interrupt.pressed() {
            return Status::Interrupted;
        }
    }
    status
}

/// Exit status of a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Status {
    /// The command is done, with or without warnings.
    Done = 0,
    /// The command ran, but with a negative result: the scene has errors or does not solve a
    /// lesson, the pictures differ, the layout would change, or an editor disconnected without
    /// sending `exit`.
    Negative = 1,
    /// The command failed: wrong arguments, a file that cannot be read or written, or too little
    /// memory.
    Failed = 2,
    /// The command was ended by Ctrl-C.
    Interrupted = 130,
}

impl From<Status> for ExitCode {
    fn from(status: Status) -> Self {
        Self::from(status as u8)
    }
}

/// Returns the exit status of a command that has ended. Prints its error message, except for errors
/// of the scene, which were already printed, and for Ctrl-C.
fn status_of(done: Result<Status, CommandError>) -> Status {
    match done {
        Ok(status) => status,
        Err(CommandError::SceneErrors) => Status::Negative,
        Err(CommandError::Interrupted) => Status::Interrupted,
        Err(error) => {
            output::error(&error);
            Status::Failed
        }
    }
}

/// Reason why a command ended early.
#[derive(Debug, thiserror::Error)]
enum CommandError {
    /// An error, with a message for people.
    #[error("{0}")]
    Message(String),
    /// The scene has errors. They have already been printed.
    #[error("the scene has errors")]
    SceneErrors,
    /// Ctrl-C was pressed.
    #[error("interrupted")]
    Interrupted,
}

/// Makes an error with a message for people.
fn command_error(message: impl Into<String>) -> CommandError {
    CommandError::Message(message.into())
}

impl From<RenderError> for CommandError {
    fn from(error: RenderError) -> Self {
        match error {
            RenderError::Cancelled => Self::Interrupted,
            error => command_error(error.to_string()),
        }
    }
}
