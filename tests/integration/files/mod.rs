//! Tests that files are written completely or not at all, and only to the intended places. Commands
//! never wait for special files, such as pipes.

#[cfg(unix)]
mod forged;
#[cfg(unix)]
mod hostile;
#[cfg(unix)]
mod interruptions;
mod output_folder;

use std::{fs, io, path::Path, sync::atomic::AtomicBool};

use pinhole::files::{self, Original, Purpose, check_writable};

use crate::program::Folder;

const SCENE: &str = "image { width 6 height 4 }
camera { eye (3, 3.5, 8) lookat (0.2, 0.8, 0) d 2.75 }
sphere Ball { center (-1, 1, 0) }
";

/// Returns a folder with [`SCENE`] in `a.scn` and `b.scn`, and with the scene's picture in `a.png`.
fn folder() -> Folder {
    let folder = Folder::with([("a.scn", SCENE), ("b.scn", SCENE)]);
    folder.told("render a.scn", 0);
    folder
}

/// Writes `content` to a path that the user of a command has named. An existing file is replaced.
fn write(path: &Path, content: &[u8]) -> io::Result<()> {
    files::write(path, Purpose::Named, &AtomicBool::new(false), |out| {
        out.write_all(content)
    })
}

#[test]
fn a_file_stays_as_it_was_until_the_new_one_is_complete() {
    let folder = Folder::with([]);
    let path = folder.path("a.png");
    write(&path, b"old").unwrap();
    let failed = files::write(&path, Purpose::Named, &AtomicBool::new(false), |out| {
        out.write_all(&[0; 1 << 20])?;
        assert_eq!(fs::read(&path)?, b"old");
        Err(io::Error::other("the disk is full"))
    });
    assert_eq!(failed.unwrap_err().to_string(), "the disk is full");
    let cancelled = files::write(&path, Purpose::Named, &AtomicBool::new(true), |out| {
        out.write_all(b"new")
    });
    assert!(cancelled.is_err());
    assert_eq!(folder.read("a.png"), b"old");
    write(&path, b"new").unwrap();
    assert_eq!(folder.read("a.png"), b"new");
    check_writable(&path, Purpose::Named).unwrap();
    check_writable(&folder.path("b.png"), Purpose::Named).unwrap();
    assert_eq!(folder.names(), ["a.png"], "something was left behind");
}

#[test]
fn leftover_temporary_files_are_removed_and_those_in_use_are_kept() {
    let folder = Folder::with([]);
    let path = folder.path("a.png");
    let (left, others) = (".pinhole-a.png-abcdef.tmp", ".pinhole-b.png-abcdef.tmp");
    files::write(&path, Purpose::Named, &AtomicBool::new(false), |out| {
        folder.write(left, "");
        folder.write(others, "");
        write(&path, b"inner")?;
        assert!(!folder.names().contains(&left.to_owned()));
        out.write_all(b"outer")
    })
    .unwrap();
    assert_eq!(folder.read("a.png"), b"outer");
    assert_eq!(folder.names(), [others, "a.png"]);
    write(&folder.path(&("ä".repeat(125) + ".png")), b"long").unwrap();
}

#[cfg(unix)]
#[test]
fn writing_keeps_links_permissions_and_devices() {
    use std::os::unix::fs::{PermissionsExt, symlink};

    let folder = Folder::with([]);
    let mode = |name| {
        fs::metadata(folder.path(name))
            .unwrap()
            .permissions()
            .mode()
            & 0o777
    };
    folder.write("plain", b"");
    write(&folder.path("file"), b"old").unwrap();
    assert_eq!(mode("file"), mode("plain"));
    fs::set_permissions(folder.path("file"), fs::Permissions::from_mode(0o640)).unwrap();
    for (link, target) in [("link", "file"), ("dangling", "created")] {
        symlink(target, folder.path(link)).unwrap();
        write(&folder.path(link), b"new").unwrap();
        assert!(folder.path(link).is_symlink());
        assert_eq!(folder.read(target), b"new");
    }
    assert_eq!(mode("file"), 0o640);
    write("/dev/null".as_ref(), b"new").unwrap();
    assert!(!fs::metadata("/dev/null").unwrap().is_file());
}

#[test]
fn a_new_file_appears_complete_and_replaces_nothing() {
    let folder = Folder::with([("there", "old")]);
    let new = |name: &str| {
        let path = folder.path(name);
        files::write(&path, Purpose::New, &AtomicBool::new(false), |out| {
            assert!(!path.exists() || name == "there");
            out.write_all(b"new")
        })
    };
    new("a").unwrap();
    assert_eq!(folder.read("a"), b"new");
    let error = new("there").unwrap_err();
    assert_eq!(error.kind(), io::ErrorKind::AlreadyExists);
    // If another program creates a file of this name before the new file is complete, writing
    // fails.
    let path = folder.path("b");
    let late = files::write(&path, Purpose::New, &AtomicBool::new(false), |out| {
        folder.write("b", "theirs");
        out.write_all(b"new")
    });
    assert_eq!(late.unwrap_err().kind(), io::ErrorKind::AlreadyExists);
    assert_eq!(folder.read("b"), b"theirs");
    assert_eq!(folder.names(), ["a", "b", "there"]);
}

#[test]
fn a_file_changed_since_it_was_read_is_not_overwritten() {
    let folder = Folder::with([]);
    let path = folder.path("a.scn");
    let other = folder.path("other");
    let in_place = || fs::write(&path, "theirs").unwrap();
    let renamed = || {
        fs::write(&other, "theirs").unwrap();
        fs::rename(&other, &path).unwrap();
    };
    let gone = || fs::remove_file(&path).unwrap();
    let came = || fs::write(&path, "theirs").unwrap();
    let cases: [(_, &dyn Fn(), _); 4] = [
        (Some("old"), &in_place, Some("theirs")),
        (Some("old"), &renamed, Some("theirs")),
        (Some("old"), &gone, None),
        (None, &came, Some("theirs")),
    ];
    for (before, meanwhile, after) in cases {
        let _ = fs::remove_file(&path);
        if let Some(before) = before {
            fs::write(&path, before).unwrap();
        }
        let original = match before {
            Some(_) => Original::read(&path, |path| files::read(path, 9)).unwrap(),
            None => Original::missing(),
        };
        let within = &folder.path("");
        let again = Purpose::Again {
            within,
            original: &original,
        };
        for (number, purpose) in [Purpose::Change(&original), again].into_iter().enumerate() {
            let changed = || {
                files::write(&path, purpose, &AtomicBool::new(false), |out| {
                    // Another program changes the file during the first of the two writes. Before
                    // the second write, the file already differs from the original.
                    if number == 0 {
                        meanwhile();
                    }
                    out.write_all(b"ours")
                })
            };
            assert!(files::is_changed(&changed().unwrap_err()), "{before:?}");
            assert_eq!(fs::read_to_string(&path).ok().as_deref(), after);
            assert!(folder.names().iter().all(|name| name == "a.scn"));
        }
    }
}

#[cfg(unix)]
#[test]
fn a_folder_replaced_by_an_outward_link_is_not_followed() {
    for is_there in [false, true] {
        for number in 0..3 {
            let outside = Folder::with([]);
            let folder = Folder::with([("out/b/other", "")]);
            let (within, path) = (&folder.path("out"), folder.path("out/b/a"));
            if is_there {
                fs::write(&path, "old").unwrap();
            }
            let original = if is_there {
                Original::read(&path, |path| files::read(path, 9)).unwrap()
            } else {
                Original::missing()
            };
            let again = Purpose::Again {
                within,
                original: &original,
            };
            let purpose = [Purpose::Within(within), Purpose::Private(within), again][number];
            // During the write, the folder is moved together with the unfinished file, and a link
            // takes the folder's place.
            let (inner, moved) = (folder.path("out/b"), outside.path("b"));
            let written = files::write(&path, purpose, &AtomicBool::new(false), |out| {
                fs::rename(&inner, &moved)?;
                std::os::unix::fs::symlink(&moved, &inner)?;
                out.write_all(b"new")
            });
            let error = written.unwrap_err().to_string();
            assert_eq!(error, "a link leads out of its folder from there");
            let found = fs::read_to_string(moved.join("a")).ok();
            assert_eq!(found.as_deref(), is_there.then_some("old"));
        }
    }
}

#[cfg(unix)]
#[test]
fn drafts_are_readable_only_by_their_user() {
    use std::os::unix::fs::PermissionsExt;

    let folder = Folder::with([]);
    let mode = |name| {
        let found = fs::metadata(folder.path(name)).unwrap();
        found.permissions().mode() & 0o777
    };
    let set = |name, mode| {
        fs::set_permissions(folder.path(name), fs::Permissions::from_mode(mode)).unwrap();
    };
    let path = folder.path("state/drafts/a.json");
    files::keep(&path, "old").unwrap();
    let modes = || ["state", "state/drafts", "state/drafts/a.json"].map(mode);
    assert_eq!(modes(), [0o700, 0o700, 0o600]);
    // The new file becomes private, even if everybody can read the folder and the old file.
    set("state/drafts", 0o755);
    set("state/drafts/a.json", 0o644);
    files::keep(&path, "new").unwrap();
    assert_eq!(mode("state/drafts/a.json"), 0o600);
    assert_eq!(folder.text("state/drafts/a.json"), "new");
}
