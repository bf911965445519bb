//! Tests of saving a file in difficult cases: another program saves the same file, the folder is
//! read-only, or the process is killed.

use std::{
    fs,
    os::unix::{
        fs::{PermissionsExt, chown},
        process::CommandExt,
    },
    process::{Child, Stdio},
    thread,
    time::{Duration, Instant},
};

use crate::program::{Folder, Outcome};

fn spawned(folder: &Folder, line: &str) -> Child {
    let mut command = folder.command(line);
    let command = command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command.spawn().unwrap()
}

#[test]
fn a_concurrent_save_of_another_program_is_never_overwritten() {
    let long = "sphere  { color oliv }\n".repeat(4000);
    let theirs = pinhole::scene::SMALLEST;
    for command in ["fmt a.scn", "check --fix a.scn"] {
        let mut left = 0;
        // With some of the delays, the other program saves the file after the command has read it,
        // but before the command writes it.
        for delay in 0..40 {
            let folder = Folder::with([("a.scn", &*long), ("theirs", theirs)]);
            let child = spawned(&folder, command);
            thread::sleep(Duration::from_millis(5 * delay));
            match delay % 2 {
                0 => fs::write(folder.path("a.scn"), theirs).unwrap(),
                _ => fs::rename(folder.path("theirs"), folder.path("a.scn")).unwrap(),
            }
            let said = Outcome::from(child.wait_with_output().unwrap());
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

/// User id and group id of `nobody`, a user without special rights. If root runs the tests,
/// commands run as this user, because root may write everywhere.
const USER: u32 = 65534;

fn is_root() -> bool {
    use std::os::unix::fs::MetadataExt as _;
    fs::metadata("/proc/self").is_ok_and(|found| found.uid() == 0)
}

/// Makes the subfolder `closed` read-only. If root runs the tests, also makes [`USER`] the owner of
/// the folder, of its subfolders `home` and `closed`, and of the scene.
fn give_to_user(folder: &Folder) {
    for (name, mode) in [
        ("", 0o755),
        ("home", 0o755),
        ("closed/a.scn", 0o644),
        ("closed", 0o555),
    ] {
        let path = folder.path(name);
        if is_root() {
            chown(&path, Some(USER), Some(USER)).unwrap();
        }
        fs::set_permissions(&path, fs::Permissions::from_mode(mode)).unwrap();
    }
}

#[test]
fn a_file_in_a_read_only_folder_is_written_in_place() {
    let is_root = is_root();
    for (home, is_writable) in [("home", true), ("none", false)] {
        let folder = Folder::with([("closed/a.scn", "sphere  {}\n"), ("home/x", "")]);
        give_to_user(&folder);
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
        let said = Outcome::from(command.output().unwrap());
        let text = folder.text("closed/a.scn");
        if is_writable {
            assert_eq!((said.status, &*said.errors), (0, ""));
            assert_eq!(text, "sphere {}\n");
            let state = folder.path("home/.local/state/pinhole");
            assert!(crate::program::names(&state).is_empty());
            let mode = fs::metadata(&state).unwrap().permissions().mode();
            assert_eq!(mode & 0o777, 0o700);
        } else {
            // No backup copy can be made, because its folder cannot be created.
            let told = "error: cannot write to closed/a.scn: its permissions, or those of its folder, do not allow that\n";
            assert_eq!((said.status, &*said.errors), (2, told));
            assert_eq!(text, "sphere  {}\n");
        }
        assert_eq!(crate::program::names(&folder.path("closed")), ["a.scn"]);
        let open = fs::Permissions::from_mode(0o755);
        fs::set_permissions(folder.path("closed"), open).unwrap();
    }
}

#[test]
fn a_killed_new_command_leaves_a_complete_file_or_none() {
    let whole = {
        let start = Instant::now();
        Folder::with([]).done("new a.scn");
        start.elapsed()
    };
    let (mut absent, mut present) = (0, 0);
    for delay in 0..60 {
        let folder = Folder::with([]);
        let mut child = spawned(&folder, "new a.scn");
        thread::sleep(whole * delay / 40);
        child.kill().unwrap();
        child.wait().unwrap();
        match fs::read_to_string(folder.path("a.scn")) {
            Ok(text) => {
                assert_eq!(text, pinhole::scene::SMALLEST, "{delay}");
                present += 1;
            }
            Err(_) => absent += 1,
        }
    }
    assert!(absent > 0 && present > 0, "{absent} {present}");
}

/// Kills `pinhole studio` at various times, from before it begins to write the file until it has
/// answered the request.
#[test]
fn a_killed_first_save_leaves_a_complete_file_or_none() {
    use crate::studio::client::Studio;
    use serde_json::json;

    const LAST: u64 = 23;
    let text = "// a scene\n".repeat(1 << 16);
    let (mut absent, mut present) = (0, 0);
    for delay in 0..=LAST {
        let folder = Folder::with([]);
        let mut studio = Studio::start(folder.command("studio --no-open"));
        let (mut page, _) = studio.page();
        let params = json!({ "text": text, "base": pinhole::scene::SMALLEST, "name": "a.scn" });
        page.request("studio/save", params);
        thread::sleep(Duration::from_millis(4 * delay));
        // With the longest delay, the process is killed only after it has created the file, however
        // busy the machine is.
        while delay == LAST && !folder.path("a.scn").exists() {
            thread::sleep(Duration::from_millis(4));
        }
        studio.child.kill().unwrap();
        studio.child.wait().unwrap();
        match fs::read_to_string(folder.path("a.scn")) {
            Ok(found) => {
                assert!(found == text, "{delay}");
                present += 1;
            }
            Err(_) => absent += 1,
        }
    }
    assert!(absent > 0 && present > 0, "{absent} {present}");
}

#[test]
fn a_killed_in_place_write_leaves_the_file_or_its_copy_complete() {
    if !is_root() {
        return;
    }
    let (old, new) = (
        "sphere  {}\n".repeat(1 << 16),
        "sphere {}\n".repeat(1 << 16),
    );
    let mut left = 0;
    for delay in 0..20 {
        let folder = Folder::with([
            ("closed/a.scn", &*old),
            ("other/a.scn", &*new),
            ("home/x", ""),
        ]);
        give_to_user(&folder);
        let fmt = |line: &str| {
            let mut command = folder.command(line);
            command.env_remove("XDG_STATE_HOME");
            command.env("HOME", folder.path("home")).uid(USER).gid(USER);
            command
        };
        let state = folder.path("home/.local/state/pinhole");
        let copies = || {
            if state.exists() {
                crate::program::names(&state)
            } else {
                Vec::new()
            }
        };
        let mut child = fmt("fmt closed/a.scn").spawn().unwrap();
        while copies().is_empty() && child.try_wait().unwrap().is_none() {
            thread::yield_now();
        }
        thread::sleep(Duration::from_micros(500 * delay));
        child.kill().unwrap();
        child.wait().unwrap();
        let text = folder.text("closed/a.scn");
        let copies = copies();
        let is_copied = |name: &String| fs::read(state.join(name)).unwrap() == new.as_bytes();
        let is_whole = text == old || text == new || copies.iter().any(is_copied);
        assert!(is_whole, "{delay}");
        left += copies.len();
        // A killed run may leave a backup copy of the file. The next run that formats the same file
        // mentions the copy; a run that formats another file with an equal name does not.
        for (line, is_named) in [
            ("fmt closed/a.scn", true),
            ("fmt --check other/a.scn", false),
        ] {
            let said = Outcome::from(fmt(line).output().unwrap());
            for copy in &copies {
                assert_eq!(said.errors.contains(&**copy), is_named, "{}", said.errors);
            }
        }
    }
    assert!(left > 0, "no try was in time");
}

/// A user may rewrite a file that belongs to a group of which the user is no member. The rewritten
/// file then belongs to another group, which must not get the permissions that the old group had.
#[test]
fn rewriting_a_file_grants_no_rights_to_another_group() {
    use std::os::unix::fs::MetadataExt;

    if !is_root() {
        return;
    }
    // A user may give a file only to a group to which the user belongs. In the first case, the user
    // belongs to the file's group, so the rewritten file keeps it. In the second case, the file
    // gets the user's own group, without any permissions for this group.
    for (owner, groups, after) in [
        (1234, "--groups=1235", (USER, 1235, 0o660)),
        (USER, "--clear-groups", (USER, USER, 0o600)),
    ] {
        let folder = Folder::with([("a.scn", "sphere  {}\n")]);
        fs::set_permissions(folder.path(""), fs::Permissions::from_mode(0o777)).unwrap();
        chown(folder.path("a.scn"), Some(owner), Some(1235)).unwrap();
        fs::set_permissions(folder.path("a.scn"), fs::Permissions::from_mode(0o660)).unwrap();
        let said = folder.shell(&format!(
            "setpriv --reuid={USER} --regid={USER} {groups} pinhole fmt a.scn"
        ));
        if said.status == 127 {
            return;
        }
        assert_eq!((said.status, &*said.errors), (0, ""));
        let found = fs::metadata(folder.path("a.scn")).unwrap();
        let found = (found.uid(), found.gid(), found.mode() & 0o777);
        assert_eq!(found, after, "{groups}");
    }
}
