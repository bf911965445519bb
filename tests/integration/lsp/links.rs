//! The code of a diagnostic links to its page.

use std::{
    fs,
    path::{Path, PathBuf},
};

use pinhole::explain;
use serde_json::{Value, json};

use super::client::Client;

const WRONG: &str = "camera { eye (0, 1, 5)  lookat (0, 0, 0)  fov 30 }
sphere { center (0, 1, 0)  radus 1 }
sphere { center (0, 1, 0)  radus 2 }
";

fn linking() -> Value {
    json!({ "textDocument": { "publishDiagnostics": { "codeDescriptionSupport": true } } })
}

/// The codes of some diagnostics, with what they link to.
fn links(diagnostics: &Value) -> Vec<(&str, Option<&str>)> {
    let found = diagnostics["diagnostics"].as_array().expect("a list");
    found
        .iter()
        .map(|found| {
            let code = found["code"].as_str().expect("a code");
            (code, found["codeDescription"]["href"].as_str())
        })
        .collect()
}

/// Every file in a folder and in those within.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder");
    let mut found = Vec::new();
    for entry in entries {
        let path = entry.expect("an entry").path();
        match path.is_dir() {
            true => found.extend(files(&path)),
            false => found.push(path),
        }
    }
    found.sort();
    found
}

#[test]
fn a_code_links_to_its_page_in_the_users_caches() {
    let folder = tempfile::tempdir().unwrap();
    let caches = folder.path().join("é caches");
    let mut client = Client::start_with(&caches);
    let diagnostics = client.begin(linking(), WRONG);
    let version = env!("CARGO_PKG_VERSION");
    let address = |code: &str| {
        let folder = folder.path().display();
        format!("file://{folder}/%C3%A9%20caches/pinhole/explain-{version}/{code}.md")
    };
    let [angle, field] = ["bare_angle", "unknown_field"].map(address);
    assert_eq!(
        links(&diagnostics),
        [
            ("bare_angle", Some(angle.as_str())),
            ("unknown_field", Some(field.as_str())),
            ("unknown_field", Some(field.as_str())),
        ]
    );
    // The pages that are linked are there, and nothing else is.
    let kept = caches.join(format!("pinhole/explain-{version}"));
    let expected = ["bare_angle.md", "unknown_field.md"].map(|name| kept.join(name));
    assert_eq!(files(&caches), expected);
    for (file, code) in expected.iter().zip(["bare_angle", "unknown_field"]) {
        let page = explain::page(code).expect("it is explained");
        assert_eq!(fs::read_to_string(file).unwrap(), page.text);
    }
    // A fix names the diagnostic as it was told.
    let place = json!({ "line": 1, "character": 30 });
    let actions = client.about(
        "codeAction",
        json!({ "range": { "start": place, "end": place }, "context": { "diagnostics": [] } }),
    );
    assert_eq!(actions[0]["diagnostics"][0], diagnostics["diagnostics"][1]);
    client.leave();
}

#[test]
fn a_page_that_is_not_as_it_should_be_is_written_again() {
    let caches = tempfile::tempdir().unwrap();
    let kept = format!("pinhole/explain-{}", env!("CARGO_PKG_VERSION"));
    let file = caches.path().join(kept).join("bare_angle.md");
    fs::create_dir_all(file.with_file_name("")).unwrap();
    fs::write(&file, "# Old").unwrap();
    let mut client = Client::start_with(caches.path());
    client.begin(linking(), WRONG);
    client.leave();
    let page = explain::page("bare_angle").expect("it is explained");
    assert_eq!(fs::read_to_string(&file).unwrap(), page.text);
}

#[test]
fn where_no_page_can_be_written_nothing_is_linked() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "").unwrap();
    for caches in [&file, &file.join("within")] {
        let mut client = Client::start_with(caches);
        let diagnostics = client.begin(linking(), WRONG);
        let expected = ["bare_angle", "unknown_field", "unknown_field"];
        assert_eq!(links(&diagnostics), expected.map(|code| (code, None)));
        // That is not worth a word: nothing is said on standard error.
        client.leave();
    }
    assert_eq!(files(folder.path()), [file]);
}

#[test]
fn a_client_that_knows_no_links_gets_none() {
    let caches = tempfile::tempdir().unwrap();
    let mut client = Client::start_with(caches.path());
    let diagnostics = client.begin(json!({}), WRONG);
    assert_eq!(links(&diagnostics)[0], ("bare_angle", None));
    assert!(
        diagnostics["diagnostics"][0]
            .get("codeDescription")
            .is_none()
    );
    client.leave();
    assert_eq!(files(caches.path()), [] as [PathBuf; 0]);
}
