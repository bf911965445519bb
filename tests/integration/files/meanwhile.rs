//! What happens while the program writes: others save the file, the folder lets nobody in, the
//! process is killed.

use std::{
    fs,
    os::unix::{
        fs::{PermissionsExt, chown},
        process::CommandExt,
    },
    process::{Child, Stdio},
    thread,
    time::Duration,
};

use crate::program::{Folder, Said};

fn spawned(folder: &Folder, line: &str) -> Child {
    let mut command = folder.command(line);
    let command = command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command.spawn().unwrap()
}

#[test]
fn a_save_of_another_program_is_never_lost() {
    let long = "sphere  { color oliv }\n".repeat(4000);
    let theirs = pinhole::scene::SMALLEST;
    for command in ["fmt a.scn", "check --fix a.scn"] {
        let mut left = 0;
        // Somewhere in between, the file has been read and not been written yet.
        for delay in 0..40 {
            let folder = Folder::with([("a.scn", &*long), ("theirs", theirs)]);
            let child = spawned(&folder, command);
            thread::sleep(Duration::from_millis(5 * delay));
            match delay % 2 {
                0 => fs::write(folder.path("a.scn"), theirs).unwrap(),
                _ => fs::rename(folder.path("theirs"), folder.path("a.scn")).unwrap(),
            }
            let said = Said::from(child.wait_with_output().unwrap());
            assert_eq!(folder.text("a.scn"), theirs, "{command}, {delay}");
            if said.errors.contains("another program has changed it") {
                assert_eq!(said.status, 2, "{}", said.errors);
                left += 1;
            } else {
                assert!(said.status <= 1, "{}", said.errors);
            }
        }
        assert!(left > 0, "{command}: no try was in time");
    }
}

#[test]
fn a_file_that_cannot_be_replaced_is_written_in_place() {
    const USER: u32 = 65534;
    let is_root = fs::metadata("/proc/self").is_ok_and(|found| {
        use std::os::unix::fs::MetadataExt as _;
        found.uid() == 0
    });
    for (home, is_writable) in [("home", true), ("none", false)] {
        let folder = Folder::with([("closed/a.scn", "sphere  {}\n"), ("home/x", "")]);
        let open = |name: &str, mode| {
            let path = folder.path(name);
            if is_root {
                chown(&path, Some(USER), Some(USER)).unwrap();
            }
            fs::set_permissions(&path, fs::Permissions::from_mode(mode)).unwrap();
        };
        for (name, mode) in [
            ("", 0o755),
            ("home", 0o755),
            ("closed/a.scn", 0o644),
            ("closed", 0o555),
        ] {
            open(name, mode);
        }
        let mut command = folder.command("fmt closed/a.scn");
        command
            .env_remove("XDG_STATE_HOME")
            .env("HOME", folder.path(home));
        if home == "none" {
            command.env("HOME", folder.path("closed"));
        }
        if is_root {
            command.uid(USER).gid(USER);
        }
        let said = Said::from(command.output().unwrap());
        let text = folder.text("closed/a.scn");
        match is_writable {
            true => {
                assert_eq!((said.status, &*said.errors), (0, ""));
                assert_eq!(text, "sphere {}\n");
                let state = folder.path("home/.local/state/pinhole");
                assert!(crate::program::names(&state).is_empty());
            }
            // Nowhere is room for the copy.
            false => {
                let told = "error: cannot write to closed/a.scn: its permissions, or those of its folder, do not allow that\n";
                assert_eq!((said.status, &*said.errors), (2, told));
                assert_eq!(text, "sphere  {}\n");
            }
        }
        assert_eq!(crate::program::names(&folder.path("closed")), ["a.scn"]);
        open("closed", 0o755);
    }
}

#[test]
fn a_new_file_is_never_empty_whenever_the_process_is_killed() {
    for delay in 0..60 {
        let folder = Folder::with([]);
        let mut child = spawned(&folder, "new a.scn");
        thread::sleep(Duration::from_micros(100 * delay));
        child.kill().unwrap();
        child.wait().unwrap();
        if let Ok(text) = fs::read_to_string(folder.path("a.scn")) {
            assert_eq!(text, pinhole::scene::SMALLEST, "{delay}");
        }
    }
}
