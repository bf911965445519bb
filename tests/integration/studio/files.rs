//! The scene's file: read, saved, changed by others, and no other file.

use std::{
    fs,
    net::TcpListener,
    path::Path,
    process::{Output, Stdio},
};

use serde_json::{Value, json};

use super::client::{Page, Studio, studio};
use crate::program::command;

const SCENE: &str = pinhole::scene::SMALLEST;

fn save(page: &mut Page, text: &str, base: Option<&str>) -> Value {
    page.respond("studio/save", json!({ "text": text, "base": base }))
}

/// What the page is told to be in the file.
fn told(page: &mut Page) -> Value {
    let file = page.told("studio/file");
    json!({ "text": file["text"], "reason": file["reason"] })
}

fn saved() -> Value {
    json!({ "ok": true })
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<_> = names.collect();
    names.sort();
    names
}

#[test]
fn a_text_is_saved_and_other_pages_hear_of_it() {
    let (folder, studio) = studio();
    let path = folder.path().join("a.scn");
    let (mut first, _) = studio.page();
    let (mut second, _) = studio.page();
    assert_eq!(save(&mut first, "// é\r\n", Some(SCENE))["result"], saved());
    assert_eq!(fs::read(&path).unwrap(), "// é\r\n".as_bytes());
    assert_eq!(
        told(&mut second),
        json!({ "text": "// é\r\n", "reason": null })
    );
    // What is there already need not be written, whatever it was made from.
    assert_eq!(save(&mut second, "// é\r\n", Some("x"))["result"], saved());
    assert_eq!(
        save(&mut second, "// 2", Some("// é\r\n"))["result"],
        saved()
    );
    // The first page has heard of that alone, and not of what it has saved itself.
    assert_eq!(told(&mut first), json!({ "text": "// 2", "reason": null }));
    assert_eq!(studio.page().1["text"], "// 2");
    assert_eq!(names(folder.path()), ["a.scn"]);
}

#[test]
fn what_somebody_else_has_saved_is_not_overwritten() {
    let (folder, studio) = studio();
    let path = folder.path().join("a.scn");
    let (mut page, _) = studio.page();
    fs::write(&path, "// theirs").unwrap();
    // Whether the page has been told or not.
    let theirs = json!({ "ok": false, "text": "// theirs" });
    assert_eq!(save(&mut page, "// mine", Some(SCENE))["result"], theirs);
    assert_eq!(fs::read_to_string(&path).unwrap(), "// theirs");
    assert_eq!(page.told("studio/file")["text"], "// theirs");
    assert_eq!(
        save(&mut page, "// mine", Some("// theirs"))["result"],
        saved()
    );
    // It is gone.
    fs::remove_file(&path).unwrap();
    let nothing = json!({ "text": null, "reason": null });
    assert_eq!(told(&mut page), nothing);
    let gone = json!({ "ok": false, "text": null });
    assert_eq!(save(&mut page, "// more", Some("// mine"))["result"], gone);
    assert_eq!(save(&mut page, "// mine", None)["result"], saved());
    assert_eq!(fs::read_to_string(&path).unwrap(), "// mine");
    // It is in another encoding, which would be lost.
    fs::write(&path, b"// \xff").unwrap();
    let reason = "it is not a text in UTF-8";
    assert_eq!(told(&mut page), json!({ "text": null, "reason": reason }));
    for base in [None, Some("// mine")] {
        let error = save(&mut page, "// more", base)["error"].clone();
        assert_eq!(error["message"], format!("a.scn cannot be read: {reason}"));
        assert_eq!(fs::read(&path).unwrap(), b"// \xff");
    }
}

#[test]
fn a_page_hears_of_what_other_editors_save() {
    let (folder, studio) = studio();
    let (mut page, _) = studio.page();
    for text in ["// 1", "// 2", SCENE] {
        // By another name first, as many editors do it.
        let other = folder.path().join("other");
        fs::write(&other, text).unwrap();
        fs::rename(&other, folder.path().join("a.scn")).unwrap();
        assert_eq!(page.told("studio/file")["text"], text);
    }
}

#[test]
fn a_save_that_fails_changes_nothing() {
    let (folder, studio) = studio();
    let path = folder.path().join("a.scn");
    let (mut page, _) = studio.page();
    // No name but its own.
    let elsewhere = json!({ "text": "x", "base": SCENE, "name": "b.scn" });
    let error = page.respond("studio/save", elsewhere)["error"].clone();
    assert_eq!(error["message"], "this scene is in a.scn");
    let own = json!({ "text": SCENE, "base": SCENE, "name": "a.scn" });
    assert_eq!(page.ask("studio/save", own), saved());
    // Where the text was there is a folder now.
    fs::remove_file(&path).unwrap();
    fs::create_dir(&path).unwrap();
    let error = save(&mut page, "// mine", None)["error"].clone();
    assert_eq!(error["code"], -32803);
    assert_eq!(names(folder.path()), ["a.scn"]);
}

#[test]
fn a_new_scene_is_saved_under_a_name_that_no_file_has() {
    let folder = tempfile::tempdir().unwrap();
    let inner = folder.path().join("inner");
    fs::create_dir(&inner).unwrap();
    fs::write(inner.join("there.scn"), "// there").unwrap();
    #[cfg(unix)]
    std::os::unix::fs::symlink("../made.scn", inner.join("link.scn")).unwrap();
    let before = names(&inner);
    let studio = Studio::start(&inner, &[]);
    let (mut page, file) = studio.page();
    let (mut other, _) = studio.page();
    assert_eq!(
        file,
        json!({ "name": "scene.scn", "text": SCENE, "reason": null, "saved": false })
    );
    let save = |page: &mut Page, name: Value| {
        let params = json!({ "text": "// new", "base": SCENE, "name": name });
        page.respond("studio/save", params)
    };
    let wrong = [
        json!(null),
        json!(""),
        json!(1),
        json!("new"),
        json!("new.png"),
        json!("../new.scn"),
        json!("sub/new.scn"),
        json!(inner.join("new.scn")),
        json!(".new.scn"),
        json!("there.scn"),
    ];
    for name in wrong
        .into_iter()
        .chain(cfg!(unix).then(|| json!("link.scn")))
    {
        let response = save(&mut page, name.clone());
        assert_eq!(response["error"]["code"], -32803, "{name}");
        assert_eq!(names(&inner), before, "{name}");
        assert_eq!(names(folder.path()), ["inner"], "{name}");
    }
    assert_eq!(
        fs::read_to_string(inner.join("there.scn")).unwrap(),
        "// there"
    );
    assert_eq!(save(&mut page, json!("new one.scn"))["result"], saved());
    let path = inner.join("new one.scn");
    assert_eq!(fs::read_to_string(&path).unwrap(), "// new");
    // From now on it is a file like any other.
    let file = json!({ "name": "new one.scn", "text": "// new", "reason": null, "saved": true });
    for page in [&mut page, &mut other] {
        assert_eq!(page.told("studio/file"), file);
    }
    let response = save(&mut other, json!("second.scn"));
    assert_eq!(response["error"]["message"], "this scene is in new one.scn");
    fs::write(&path, "// theirs").unwrap();
    assert_eq!(page.told("studio/file")["text"], "// theirs");
    let params = json!({ "text": "// mine", "base": "// theirs" });
    assert_eq!(page.ask("studio/save", params), saved());
    assert_eq!(fs::read_to_string(&path).unwrap(), "// mine");
}

fn fails(folder: &Path, arguments: &[&str]) -> String {
    let arguments = [&["studio", "--no-open"], arguments].concat();
    let Output { status, stderr, .. } = command(folder, &arguments).output().unwrap();
    assert_eq!(status.code(), Some(2));
    String::from_utf8(stderr).unwrap()
}

#[test]
fn what_cannot_be_edited_is_told_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::write(path.join("a.scn"), SCENE).unwrap();
    fs::write(path.join("bytes.scn"), b"\xff").unwrap();
    let rendered = command(path, &["render", "a.scn", "--crop", "0,0,1,1"]).status();
    assert!(rendered.unwrap().success());
    let taken = TcpListener::bind(("127.0.0.1", 0)).unwrap();
    let port = taken.local_addr().unwrap().port().to_string();
    for (arguments, said) in [
        (&["missing.scn"][..], "cannot read missing.scn: "),
        (&["."], ". is not a file"),
        (&["-"], "standard input cannot be edited"),
        (&["a.png"], "a.png is a picture"),
        (
            &["bytes.scn"],
            "cannot read bytes.scn: it is not a text in UTF-8",
        ),
        (
            &["a.scn", "--port", &port],
            &format!("cannot serve a page at port {port}: "),
        ),
        (&["--port", "0"], "invalid value '0'"),
    ] {
        let errors = fails(path, arguments);
        assert!(errors.starts_with(&format!("error: {said}")), "{errors}");
    }
}

#[cfg(unix)]
#[test]
fn a_browser_is_started_unless_it_is_not_wanted_and_an_interrupt_ends_it() {
    use std::{
        env,
        os::unix::fs::PermissionsExt,
        process::Command,
        thread,
        time::{Duration, Instant},
    };

    let folder = tempfile::tempdir().unwrap();
    let programs = folder.path().join("bin");
    fs::create_dir(&programs).unwrap();
    for name in ["xdg-open", "open"] {
        let browser = programs.join(name);
        fs::write(
            &browser,
            "#!/bin/sh\necho \"$1\" > part && mv part opened\n",
        )
        .unwrap();
        fs::set_permissions(&browser, fs::Permissions::from_mode(0o755)).unwrap();
    }
    let path = format!("{}:{}", programs.display(), env::var("PATH").unwrap());
    let opened = folder.path().join("opened");
    for arguments in [&["studio", "--no-open"][..], &["studio"]] {
        let mut command = command(folder.path(), arguments);
        command.env("PATH", &path).stdout(Stdio::null());
        let mut studio = Studio::started(command);
        if arguments.len() == 1 {
            let end = Instant::now() + super::client::PATIENCE;
            while !opened.exists() && Instant::now() < end {
                thread::sleep(Duration::from_millis(10));
            }
            // Others can read it: it has a token of its own, which serves once.
            let address = fs::read_to_string(&opened).unwrap();
            let (host, token) = address.trim().split_once("/?token=").unwrap();
            assert_eq!(host, format!("http://{}", studio.host()));
            assert!(token != studio.token && token != studio.secret);
            for status in ["303", "403"] {
                let response = studio.get(&format!("/?token={token}"), "");
                assert!(response.starts_with(&format!("HTTP/1.1 {status} ")));
            }
        }
        let (_page, _) = studio.page();
        let id = studio.child.id().to_string();
        assert!(
            Command::new("kill")
                .args(["-INT", &id])
                .status()
                .unwrap()
                .success()
        );
        assert_eq!(studio.child.wait().unwrap().code(), Some(130));
        assert_eq!(opened.exists(), arguments.len() == 1);
    }
}
