//! Tests of the report's page in a real browser. They need `chromium` on the path: `cargo test --
//! --ignored browser`.

use std::{path::Path, process::Command};

use serde_json::{Value, json};

use crate::program::Folder;

const SCENE: &str =
    "image { width 96 height 64 } camera { eye (3, 3.5, 8) lookat (0.2, 0.8, 0) d 2.75 }
sphere Ball { center (-1.6, 1, 0) color olive } checkerboard {}
";

/// Script that is appended to the page. It measures the page and prints its findings as JSON.
const SCRIPT: &str = include_str!("../browser.html");

/// Returns what [`SCRIPT`] finds in the page `page`, in a window `width` pixels wide. The theme is
/// dark if `is_dark`, otherwise light.
fn measured(page: &Path, width: u32, is_dark: bool) -> Value {
    let profile = page.with_extension("profile");
    let mut browser = Command::new("chromium");
    browser
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--dump-dom"])
        .arg(format!("--window-size={width},900"))
        .arg(format!("--user-data-dir={}", profile.display()));
    if is_dark {
        browser.arg("--blink-settings=preferredColorScheme=0");
    }
    let address = format!("file://{}", page.display());
    let output = browser.arg(address).output();
    let dom = String::from_utf8(output.expect("Chromium is on the path").stdout).unwrap();
    let answer = dom.split_once("<pre id=\"found\">");
    let (answer, _) = answer.unwrap().1.split_once("</pre>").unwrap();
    let signs = [("&gt;", ">"), ("&lt;", "<"), ("&amp;", "&")];
    let answer = signs
        .iter()
        .fold(answer.to_owned(), |text, (from, to)| text.replace(from, to));
    serde_json::from_str(&answer).unwrap()
}

#[test]
#[ignore = "needs Chromium"]
fn the_report_page_fits_the_window_and_shows_every_picture() {
    let folder = Folder::with([("a.scn", SCENE)]);
    let reported = folder.run("report a.scn -o out --runs 2 --budget 3");
    assert_eq!(reported.status, 0, "{}", reported.errors);
    let html = folder.text("out/index.html");
    folder.write("asked.html", html.replacen("</body>", SCRIPT, 1));
    for (width, is_dark) in [(1280, false), (420, false), (1280, true)] {
        let found = measured(&folder.path("asked.html"), width, is_dark);
        let (ink, paper) = if is_dark {
            ("rgb(221, 221, 221)", "rgb(24, 24, 24)")
        } else {
            ("rgb(17, 17, 17)", "rgb(255, 255, 255)")
        };
        for (path, expected) in [
            ("/wide", json!(0)),
            ("/images", json!(20)),
            ("/broken", json!(0)),
            ("/cut", json!([])),
            ("/page", json!([ink, paper])),
            ("/chart", json!([ink, paper])),
            ("/charts/0/outside", json!([])),
            ("/charts/0/upon", json!([])),
            ("/charts/1/outside", json!([])),
            ("/charts/1/upon", json!([])),
            ("/charts/2", Value::Null),
        ] {
            let there = found.pointer(path).unwrap_or(&Value::Null);
            assert_eq!(*there, expected, "{path}, {width}, {is_dark}: {found:#}");
        }
        let texts = [0, 1].map(|chart| found["charts"][chart]["texts"].as_u64());
        assert!(texts.iter().all(|&count| count > Some(15)), "{found:#}");
    }
}
