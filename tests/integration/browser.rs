//! The report's page in a real browser, which has to be there: `cargo test -- --ignored browser`, with Chromium on the path.

use std::{fs, path::Path, process::Command};

use serde_json::Value;

const SCENE: &str =
    "image { width 96 height 64 } camera { eye (3, 3.5, 8) lookat (0.2, 0.8, 0) d 2.75 }
sphere Ball { center (-1.6, 1, 0) color olive } checkerboard {}
";

/// What the browser makes of the page: it is asked when everything is there, and answers in the page itself.
const QUESTIONS: &str = r#"<script>
addEventListener("load", () => {
  const boxes = [...document.querySelectorAll("svg.chart")].map(chart => {
    const frame = chart.getBoundingClientRect();
    const texts = [...chart.querySelectorAll("text")].map(text => [text.textContent.trim(), text.getBoundingClientRect()]);
    const outside = texts.filter(([, r]) =>
      r.left < frame.left || r.right > frame.right || r.top < frame.top || r.bottom > frame.bottom);
    const meets = (a, b) => a.left < b.right && b.left < a.right && a.top + 3 < b.bottom && b.top + 3 < a.bottom;
    const upon = texts.flatMap(([a, r], i) =>
      texts.slice(i + 1).filter(([, s]) => meets(r, s)).map(([b]) => a + " / " + b));
    return { texts: texts.length, outside: outside.map(([text]) => text), upon };
  });
  const images = [...document.images];
  const ink = element => { const style = getComputedStyle(element); return [style.color, style.backgroundColor]; };
  const captions = [...document.querySelectorAll("figcaption, p")];
  const answer = {
    wide: document.documentElement.scrollWidth - document.documentElement.clientWidth,
    images: images.length,
    broken: images.filter(image => !image.complete || image.naturalWidth === 0).length,
    charts: boxes,
    page: ink(document.body),
    chart: ink(document.querySelector("svg.chart")),
    cut: captions.filter(caption => caption.getBoundingClientRect().right > document.documentElement.clientWidth).map(caption => caption.textContent),
  };
  const found = document.createElement("pre");
  found.id = "found";
  found.textContent = JSON.stringify(answer);
  document.body.append(found);
});
</script>
</body>"#;

/// The answers in a window so wide, in a dark one or not.
fn asked(page: &Path, width: u32, is_dark: bool) -> Value {
    let mut browser = Command::new("chromium");
    browser
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--dump-dom"])
        .arg(format!("--window-size={width},900"))
        .arg(format!(
            "--user-data-dir={}",
            page.with_extension("profile").display()
        ));
    if is_dark {
        browser.arg("--blink-settings=preferredColorScheme=0");
    }
    let output = browser
        .arg(format!("file://{}", page.display()))
        .output()
        .expect("Chromium is on the path");
    let dom = String::from_utf8(output.stdout).unwrap();
    let answer = dom
        .split_once("<pre id=\"found\">")
        .expect("the page was loaded")
        .1;
    let answer = answer.split_once("</pre>").unwrap().0;
    serde_json::from_str(
        &answer
            .replace("&gt;", ">")
            .replace("&lt;", "<")
            .replace("&amp;", "&"),
    )
    .unwrap()
}

#[test]
#[ignore = "needs Chromium"]
fn a_browser_shows_the_whole_page() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.scn"), SCENE).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_pinhole"))
        .args([
            "report", "a.scn", "-o", "out", "--runs", "2", "--budget", "3",
        ])
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert!(output.status.success(), "{output:?}");
    let html = fs::read_to_string(folder.path().join("out/index.html")).unwrap();
    let page = folder.path().join("asked.html");
    fs::write(&page, html.replacen("</body>", QUESTIONS, 1)).unwrap();
    for (width, is_dark) in [(1280, false), (420, false), (1280, true)] {
        let found = asked(&page, width, is_dark);
        let what = format!("{width}, {is_dark}: {found:#}");
        assert_eq!(found["wide"], 0, "{what}");
        assert_eq!(
            (&found["images"], &found["broken"]),
            (&11.into(), &0.into()),
            "{what}"
        );
        assert_eq!(found["cut"], Value::Array(Vec::new()), "{what}");
        let charts = found["charts"].as_array().unwrap();
        assert_eq!(charts.len(), 2);
        for chart in charts {
            assert!(chart["texts"].as_u64().unwrap() > 15, "{what}");
            assert_eq!(chart["outside"], Value::Array(Vec::new()), "{what}");
            assert_eq!(chart["upon"], Value::Array(Vec::new()), "{what}");
        }
        let (ink, paper) = match is_dark {
            false => (["rgb(17, 17, 17)"; 2], "rgb(255, 255, 255)"),
            true => (["rgb(221, 221, 221)"; 2], "rgb(24, 24, 24)"),
        };
        assert_eq!([&found["page"][0], &found["chart"][0]], ink, "{what}");
        assert_eq!(
            [&found["page"][1], &found["chart"][1]],
            [paper; 2],
            "{what}"
        );
    }
}
