//! `studio`: serves a web page for editing a scene in a browser.

use std::{
    env,
    process::{Command, Stdio},
    sync::Arc,
};

use tokio::sync::Notify;

use super::{
    CommandError, Status,
    args::StudioArgs,
    command_error,
    input::{self, is_standard, shown},
    interrupt::Interrupt,
    lesson, output, watch,
};
use crate::studio::{Host, LessonFile, SceneFile};

/// Serves the page until Ctrl-C is pressed.
pub fn run(args: &StudioArgs, interrupt: &Interrupt) -> Result<Status, CommandError> {
    let file = file(args)?;
    let name = args
        .scene
        .as_deref()
        .map_or("a new scene".to_owned(), shown);
    if let Some(path) = &args.lesson {
        lesson::read(path)?;
    }
    let lesson = args.lesson.as_deref();
    let lesson = lesson.map(|path| LessonFile::new(path, input::bytes));
    let host = Host::new(args.port.unwrap_or(0), file, lesson).map_err(|error| {
        let port = args
            .port
            .map_or(String::new(), |port| format!(" at port {port}"));
        command_error(format!("cannot serve a page{port}: {error}"))
    })?;
    let [address, address_once] = host.addresses();
    let end = Arc::new(Notify::new());
    let pressed = Arc::clone(&end);
    interrupt.then(move || pressed.notify_one());
    output::to_people(&format!(
        "editing {name} at this address; Ctrl-C ends it\n{address}\n"
    ));
    if !args.no_open && !open(&address_once) {
        output::warning(&"no browser could be started: open the address in one");
    }
    host.serve(end.notified())
        .map_err(|error| command_error(format!("cannot serve a page: {error}")))?;
    Ok(Status::Interrupted)
}

/// Opens the scene's file. If the user named none, makes a new scene, which will be saved in the
/// current folder. Returns an error if the file cannot be read, or is standard input.
fn file(args: &StudioArgs) -> Result<SceneFile, CommandError> {
    let Some(scene) = &args.scene else {
        let folder = env::current_dir()
            .map_err(|error| command_error(format!("there is no current folder: {error}")))?;
        return Ok(SceneFile::new(folder, input::bytes));
    };
    if is_standard(scene) {
        let message = "standard input cannot be edited: it is read once; give a file";
        return Err(command_error(message));
    }
    watch::check_scene(scene)?;
    input::name_copies(scene);
    SceneFile::open(scene, input::bytes)
        .map_err(|error| command_error(format!("cannot read {}: {error}", shown(scene))))
}

/// Starts the system's program that opens an address in a browser. Returns whether it could be
/// started.
fn open(address: &str) -> bool {
    let (program, before): (_, &[&str]) = if cfg!(target_os = "macos") {
        ("open", &[])
    } else if cfg!(windows) {
        ("rundll32", &["url.dll,FileProtocolHandler"])
    } else {
        ("xdg-open", &[])
    };
    let mut command = Command::new(program);
    command.args(before).arg(address);
    command
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    command.spawn().is_ok()
}
