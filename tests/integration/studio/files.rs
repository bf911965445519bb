//! Tests of the scene's file: the host reads and saves it, and notices changes by other programs.
//! The host touches no other file.

use std::{fs, net::TcpListener};

use pinhole::scene::SMALLEST as SCENE;
use serde_json::{Value, json};

use super::client::{Page, Studio, studio};
#[cfg(unix)]
use crate::interrupt::send_signal;
use crate::{
    lsp::client::{Client, PATIENCE},
    program::Folder,
};

fn save(page: &mut Client<Page>, text: &str, base: Option<&str>) -> Value {
    page.respond("studio/save", json!({ "text": text, "base": base }))
}

/// Waits for the host's next message about the file. Returns the file's text, and the reason why
/// the file cannot be read, if there is one.
fn told(page: &mut Client<Page>) -> [Value; 2] {
    let mut file = page.notification("studio/file");
    ["text", "reason"].map(|field| file[field].take())
}

fn saved() -> Value {
    json!({ "ok": true })
}

fn file(name: &str, text: &str, is_saved: bool) -> Value {
    json!({ "name": name, "text": text, "reason": null, "saved": is_saved })
}

#[test]
fn a_save_writes_the_file_and_notifies_other_pages() {
    let (folder, studio) = studio();
    let (mut first, found) = studio.page();
    assert_eq!(found, file("a.scn", SCENE, true));
    let (mut second, _) = studio.page();
    assert_eq!(save(&mut first, "// é\r\n", Some(SCENE))["result"], saved());
    assert_eq!(folder.text("a.scn"), "// é\r\n");
    assert_eq!(told(&mut second), [json!("// é\r\n"), Value::Null]);
    // `base` is the content that the page knows. In the first row, `base` is out of date, but the
    // save succeeds because the file already contains the text.
    for (text, base) in [("// é\r\n", "x"), ("// 2", "// é\r\n")] {
        assert_eq!(save(&mut second, text, Some(base))["result"], saved());
    }
    // The first page is notified only of the second page's save, not of its own.
    assert_eq!(told(&mut first), [json!("// 2"), Value::Null]);
    assert_eq!(studio.page().1["text"], "// 2");
    assert_eq!(folder.names(), ["a.scn"]);
}

#[test]
fn a_save_never_overwrites_a_change_of_another_program() {
    let (folder, studio) = studio();
    let (mut page, _) = studio.page();
    folder.write("a.scn", "// theirs");
    // The host notices the other program's change when the page saves, even before it has told the
    // page about the change.
    let theirs = json!({ "ok": false, "text": "// theirs" });
    assert_eq!(save(&mut page, "// mine", Some(SCENE))["result"], theirs);
    assert_eq!(folder.text("a.scn"), "// theirs");
    assert_eq!(page.notification("studio/file")["text"], "// theirs");
    let answer = save(&mut page, "// mine", Some("// theirs"));
    assert_eq!(answer["result"], saved());
    // Another program removes the file.
    fs::remove_file(folder.path("a.scn")).unwrap();
    assert_eq!(told(&mut page), [Value::Null, Value::Null]);
    let gone = json!({ "ok": false, "text": null });
    assert_eq!(save(&mut page, "// more", Some("// mine"))["result"], gone);
    assert_eq!(save(&mut page, "// mine", None)["result"], saved());
    assert_eq!(folder.text("a.scn"), "// mine");
    // The file gets another encoding, which a save would destroy.
    folder.write("a.scn", b"// \xff");
    let reason = "it is not a text in UTF-8";
    assert_eq!(told(&mut page), [Value::Null, json!(reason)]);
    for base in [None, Some("// mine")] {
        let error = save(&mut page, "// more", base)["error"].take();
        assert_eq!(
            error["message"],
            format!("a.scn is not saved, as it cannot be read: {reason}; save under another name")
        );
        assert_eq!(folder.read("a.scn"), b"// \xff");
    }
}

#[test]
fn a_save_that_fails_changes_nothing() {
    let (folder, studio) = studio();
    let (mut page, _) = studio.page();
    // A new scene can be saved only in the folder of the scene's file, and only with the extension
    // `.scn`.
    for name in ["../b.scn", "sub/b.scn", "b.txt"] {
        let elsewhere = json!({ "text": "x", "base": SCENE, "name": name });
        let error = page.respond("studio/save", elsewhere)["error"].take();
        assert_eq!(error["code"], -32803, "{name}");
        assert_eq!(folder.names(), ["a.scn"], "{name}");
    }
    let own = json!({ "text": SCENE, "base": SCENE, "name": "a.scn" });
    assert_eq!(page.ask("studio/save", own), saved());
    // A folder takes the place of the file.
    fs::remove_file(folder.path("a.scn")).unwrap();
    fs::create_dir(folder.path("a.scn")).unwrap();
    let error = save(&mut page, "// mine", None)["error"].take();
    assert_eq!(error["code"], -32803);
    assert_eq!(folder.names(), ["a.scn"]);
}

/// Tests the two ways to protect a file: permissions, and the system's attribute `i` (immutable).
/// Root may ignore permissions, but not the attribute. A protection that has no effect in the
/// test's environment is skipped.
#[cfg(unix)]
#[test]
fn a_forbidden_save_names_the_file_the_reason_and_a_remedy() {
    use std::process::Command;

    let way_out = "allow it to be changed, or download the scene";
    let permissions = "its permissions, or those of its folder, do not allow that";
    let system = "the system protects it from being changed";
    for (protect, release, why) in [
        ("chmod 444", "chmod 644", permissions),
        ("chattr +i", "chattr -i", system),
    ] {
        let (folder, studio) = studio();
        let path = folder.path("a.scn");
        let run = |command: &str| {
            let mut words = command.split(' ');
            let mut program = Command::new(words.next().unwrap_or_default());
            let status = program.args(words).arg(&path).output();
            status.is_ok_and(|output| output.status.success())
        };
        let is_protected = run(protect) && fs::File::options().write(true).open(&path).is_err();
        let (mut page, _) = studio.page();
        let answer = is_protected.then(|| save(&mut page, "// mine", Some(SCENE)));
        run(release);
        let Some(mut answer) = answer else { continue };
        let message = format!("a.scn is not saved: {why}; {way_out}");
        assert_eq!(answer["error"]["message"].take(), message, "{protect}");
        assert_eq!(folder.text("a.scn"), SCENE);
        // Once saving is allowed again, the file is saved.
        assert_eq!(save(&mut page, "// mine", Some(SCENE))["result"], saved());
    }
}

#[test]
fn a_new_scene_is_saved_only_under_an_unused_name() {
    let outer = Folder::with([("inner/there.scn", "// there")]);
    let inner = outer.path("inner");
    let before = if cfg!(unix) {
        vec!["link.scn", "there.scn"]
    } else {
        vec!["there.scn"]
    };
    #[cfg(unix)]
    std::os::unix::fs::symlink("../made.scn", inner.join("link.scn")).unwrap();
    let mut command = outer.command("studio --no-open");
    command.current_dir(&inner);
    let studio = Studio::start(command);
    let (mut page, found) = studio.page();
    let (mut other, _) = studio.page();
    let nothing = json!({ "name": "scene.scn", "text": null, "reason": null, "saved": false });
    assert_eq!(found, nothing);
    let save = |page: &mut Client<Page>, name: Value| {
        let params = json!({ "text": "// new", "base": SCENE, "name": name });
        page.respond("studio/save", params)
    };
    let mut names = json!([
        null,
        "",
        1,
        "new",
        "new.png",
        "../new.scn",
        "sub/new.scn",
        inner.join("new.scn"),
        ".new.scn"
    ]);
    let names = names.as_array_mut().unwrap();
    names.extend(before.iter().map(|name| json!(name)));
    for name in names {
        let response = save(&mut page, name.clone());
        assert_eq!(response["error"]["code"], -32803, "{name}");
        assert_eq!(crate::program::names(&inner), before, "{name}");
        assert_eq!(outer.names(), ["inner"], "{name}");
    }
    assert_eq!(outer.text("inner/there.scn"), "// there");
    assert_eq!(save(&mut page, json!("new one.scn"))["result"], saved());
    assert_eq!(outer.text("inner/new one.scn"), "// new");
    // When the new scene is saved for the first time, both pages are notified of it, as of any
    // saved file.
    for page in [&mut page, &mut other] {
        assert_eq!(
            page.notification("studio/file"),
            file("new one.scn", "// new", true)
        );
    }
    // The other page saves another new scene in the same folder, but cannot overwrite an existing
    // file.
    let response = save(&mut other, json!("there.scn"));
    assert_eq!(response["error"]["code"], -32803);
    assert_eq!(outer.text("inner/there.scn"), "// there");
    assert_eq!(save(&mut other, json!("second.scn"))["result"], saved());
    assert_eq!(outer.text("inner/second.scn"), "// new");
    assert_eq!(outer.text("inner/new one.scn"), "// new");
    outer.write("inner/new one.scn", "// theirs");
    assert_eq!(page.notification("studio/file")["text"], "// theirs");
    let params = json!({ "text": "// mine", "base": "// theirs" });
    assert_eq!(page.ask("studio/save", params), saved());
    assert_eq!(outer.text("inner/new one.scn"), "// mine");
}

#[cfg(unix)]
#[test]
fn a_scene_replaced_by_a_pipe_is_reported_and_blocks_nothing() {
    let (folder, mut studio) = studio();
    let (mut page, _) = studio.page();
    folder.make_pipe("pipe");
    fs::rename(folder.path("pipe"), folder.path("a.scn")).unwrap();
    let reason = json!("it is a pipe, not a file");
    assert_eq!(told(&mut page), [Value::Null, reason]);
    let error = save(&mut page, "// mine", Some(SCENE))["error"].take();
    let message = "a.scn is not saved, as it cannot be read: it is a pipe, not a file; save under another name";
    assert_eq!(error["message"], message);
    send_signal("INT", &studio.child);
    assert_eq!(studio.child.wait().unwrap().code(), Some(130));
}

#[test]
fn files_that_cannot_be_edited_are_refused_at_the_start() {
    let folder = Folder::with([("a.scn", SCENE)]);
    folder.write("bytes.scn", b"\xff");
    let wide = |mark: &str, text: &str| -> Vec<u8> {
        let units = mark.encode_utf16().chain(text.encode_utf16());
        units.flat_map(u16::to_le_bytes).collect()
    };
    folder.write("marked.scn", wide("\u{feff}", SCENE));
    folder.write("wide.scn", wide("", SCENE));
    assert_eq!(folder.run("render a.scn --crop 0,0,1,1").status, 0);
    let taken = TcpListener::bind(("127.0.0.1", 0)).unwrap();
    let port = taken.local_addr().unwrap().port();
    for (arguments, said) in [
        ("missing.scn", "cannot read missing.scn: "),
        (".", "cannot read .: it is a folder, not a file"),
        ("-", "standard input cannot be edited"),
        ("a.png", "a.png is a picture"),
        (
            "bytes.scn",
            "cannot read bytes.scn: it is not a text in UTF-8",
        ),
        (
            "marked.scn",
            "cannot read marked.scn: it is UTF-16, not UTF-8: save it as UTF-8",
        ),
        (
            "wide.scn",
            "cannot read wide.scn: it is UTF-16, not UTF-8: save it as UTF-8",
        ),
        (
            &format!("a.scn --port {port}"),
            &format!("cannot serve a page at port {port}: "),
        ),
        ("--port 0", "invalid value '0'"),
    ] {
        let errors = folder.told(&format!("studio --no-open {arguments}"), 2);
        assert!(errors.starts_with(&format!("error: {said}")), "{errors}");
    }
}

#[cfg(unix)]
#[test]
fn a_browser_opens_with_a_single_use_token_unless_no_open_is_given() {
    use rustix::net::sockopt::set_socket_recv_buffer_size;
    use std::{
        env,
        io::Read,
        os::unix::fs::PermissionsExt,
        process::Stdio,
        thread,
        time::{Duration, Instant},
    };
    use tungstenite::protocol::frame::coding::CloseCode;

    let folder = Folder::with([]);
    for name in ["bin/xdg-open", "bin/open"] {
        folder.write(name, "#!/bin/sh\necho \"$1\" > part && mv part opened\n");
        fs::set_permissions(folder.path(name), fs::Permissions::from_mode(0o755)).unwrap();
    }
    let path = format!(
        "{}:{}",
        folder.path("bin").display(),
        env::var("PATH").unwrap()
    );
    let opened = folder.path("opened");
    // The text is longer than the socket buffers, so the host cannot send it completely to a page
    // that does not read its messages.
    let long = "// a long scene\n".repeat(1 << 19);
    folder.write("a.scn", &long);
    for (arguments, is_opened) in [("studio --no-open", false), ("studio a.scn", true)] {
        let mut command = folder.command(arguments);
        command.env("PATH", &path).stdout(Stdio::null());
        let studio = Studio::start(command);
        if !is_opened {
            studio.page();
            assert!(!opened.exists());
            continue;
        }
        let end = Instant::now() + PATIENCE;
        while !opened.exists() && Instant::now() < end {
            thread::sleep(Duration::from_millis(10));
        }
        // Other users can read the command line with which the browser is started. Therefore, it
        // contains a separate token that works only once.
        let address = folder.text("opened");
        let (host, once) = address.trim().split_once("/#token=").unwrap();
        assert_eq!(host, format!("http://{}", studio.host()));
        assert_ne!(once, studio.token);
        let (mut first, session) = studio.admitted(once).unwrap();
        assert!(session != once && session != studio.token);
        // The page reconnects with the token of its session.
        let (mut again, token) = studio.admitted(&session).unwrap();
        assert_eq!(token, session);
        // The pending messages are read first. The notice that the session has ended comes after
        // them.
        first.notification("studio/file");
        again.notification("studio/file");
        let (mut other, _) = studio.page();
        let mut silent = studio.socket();
        set_socket_recv_buffer_size(silent.get_ref(), 1 << 16).unwrap();
        silent.send(session.as_str().into()).unwrap();
        silent.read().unwrap();
        // A second use of the address ends the session, and does not start a new one.
        let twice = CloseCode::from(4003);
        for token in [once, &session, once] {
            assert_eq!(studio.admitted(token).err(), Some(twice));
        }
        assert_eq!([first.closed(), again.closed()], [twice; 2]);
        // The session also ends for a page that does not read its messages. The host gives up a
        // write to such a page only after 10 seconds, but the session must end long before. Four
        // seconds suffice even on a busy machine.
        thread::sleep(Duration::from_secs(4));
        let mut rest = Vec::new();
        let _ = silent.get_mut().read_to_end(&mut rest);
        assert!(rest.len() < long.len(), "{} bytes", rest.len());
        // Pages with the printed token are not affected.
        other.open(json!({}), SCENE);
        other.diagnostics();
        studio.page();
    }
}

#[cfg(unix)]
#[test]
fn a_signal_ends_studio_within_a_second_and_closes_its_pages() {
    use std::{
        io::Write,
        thread,
        time::{Duration, Instant},
    };
    use tungstenite::protocol::frame::coding::CloseCode;

    for (signal, is_pipe) in [("INT", false), ("TERM", false), ("INT", true)] {
        let (folder, mut studio) = studio();
        let (mut page, _) = studio.page();
        page.open(json!({}), SCENE);
        page.diagnostics();
        let (mut idle, _socket) = (studio.stream(), studio.socket());
        idle.write_all(b"GET / HT").unwrap();
        if is_pipe {
            // A pipe takes the place of the file. If the host opened the pipe, it would wait for
            // another program to write to it.
            fs::remove_file(folder.path("a.scn")).unwrap();
            folder.make_pipe("a.scn");
            // The host checks the file regularly. It does so at least once in 2.5 seconds.
            thread::sleep(Duration::from_millis(2500));
        }
        let begun = Instant::now();
        send_signal(signal, &studio.child);
        assert_eq!(studio.child.wait().unwrap().code(), Some(130));
        let time = begun.elapsed();
        assert!(time < Duration::from_secs(1), "{signal} {is_pipe} {time:?}");
        if !is_pipe {
            assert_eq!(page.closed(), CloseCode::Away);
        }
    }
}

/// Drafts are unsaved texts of pages. They survive restarts of the program. A draft is deleted when
/// its text is saved, or when the user discards it.
#[test]
fn drafts_survive_a_restart_until_they_are_saved_or_discarded() {
    let folder = Folder::with([("a.scn", SCENE)]);
    let start = || {
        let mut command = folder.command("studio --no-open a.scn");
        command.env("XDG_STATE_HOME", folder.path("state"));
        command.env("LOCALAPPDATA", folder.path("state"));
        Studio::start(command)
    };
    let offered = |studio: &Studio| {
        let drafts = studio.page().1["drafts"].take();
        let drafts = drafts.as_array().cloned().unwrap_or_default();
        assert!(drafts.iter().all(|it| it["time"].as_u64() > Some(0)));
        let texts = drafts
            .iter()
            .map(|it| it["text"].as_str().unwrap_or_default());
        texts.collect::<Vec<_>>().join(" ")
    };
    let twelve: Vec<String> = (0..12).map(|key| key.to_string()).collect();
    let twelve: Vec<(&str, Option<&str>)> =
        twelve.iter().map(|key| (&**key, Some(&**key))).collect();
    // Each row has drafts that are stored one after the other, the drafts offered to a later page,
    // and the drafts left after this page has saved `// b`.
    let cases = [
        (
            &[("x", Some("// 0")), ("y", Some("// 1"))][..],
            "// 1 // 0",
            "// 1 // 0",
        ),
        (
            &[
                ("x", Some("// 0")),
                ("y", Some("// b")),
                ("x", Some("// 2")),
            ],
            "// 2 // b",
            "// 2",
        ),
        (
            &[("x", Some("// 0")), ("y", Some("// 1")), ("y", None)],
            "// 0",
            "// 0",
        ),
        // A draft equal to the file is not offered. At most ten drafts are offered.
        (&[("x", Some(SCENE)), ("y", Some("// 1"))], "// 1", "// 1"),
        (&twelve, "11 10 9 8 7 6 5 4 3 2", "11 10 9 8 7 6 5 4 3 2"),
        (&[("x", None)], "", ""),
    ];
    for (written, later, left) in cases {
        let mut first = start();
        for (id, text) in written {
            let (mut page, _) = first.page();
            let draft = json!({ "id": id, "name": "a.scn", "text": text, "base": SCENE });
            assert_eq!(page.ask("studio/draft", draft), saved());
        }
        first.child.kill().unwrap();
        let second = start();
        assert_eq!(offered(&second), later, "{written:?}");
        let (mut page, _) = second.page();
        assert_eq!(save(&mut page, "// b", Some(SCENE))["result"], saved());
        let now = offered(&second);
        assert_eq!(now.replace(SCENE, "").trim(), left, "{written:?}");
        for (id, _) in written {
            assert_eq!(page.ask("studio/draft", json!({ "id": id })), saved());
        }
        assert_eq!(offered(&second), "", "{written:?}");
        assert_eq!(save(&mut page, SCENE, Some("// b"))["result"], saved());
    }
    let studio = start();
    let (mut page, _) = studio.page();
    let answer = page.respond("studio/draft", json!({ "text": "// 0" }));
    assert_eq!(answer["error"]["code"], -32602);
}
