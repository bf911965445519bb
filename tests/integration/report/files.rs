//! Tests of the files of a report: charts, tables, and a page that needs no other files.

use std::fs;

use base64::{Engine, prelude::BASE64_STANDARD};
use pinhole::{film::read_picture, scene::Method};
use roxmltree::{Document, Node};
use serde_json::Value;

use super::{SCENE, folder, parsed};
use crate::program::{self, Folder};

const XHTML: &str = "http://www.w3.org/1999/xhtml";

/// Returns the width and the height of the PNG picture in an `img` element.
fn size(element: Node) -> (u32, u32) {
    let data = element.attribute("src").unwrap();
    let png = data.strip_prefix("data:image/png;base64,").unwrap();
    let png = BASE64_STANDARD.decode(png).unwrap();
    let film = read_picture(&png).unwrap().film;
    (film.width(), film.height())
}

/// Returns the elements of a document that have the tag `name`.
fn elements<'d>(
    document: &'d Document,
    name: &'static str,
) -> impl Iterator<Item = Node<'d, 'd>> + Clone {
    let all = document.descendants();
    all.filter(move |node| node.tag_name().name() == name)
}

/// Returns the labels of an SVG chart, each with its vertical position.
fn labels(chart: &str) -> Vec<(String, i32)> {
    let document = parsed(chart);
    let root = document.root_element();
    assert!(root.has_tag_name(("http://www.w3.org/2000/svg", "svg")));
    let label = |node: Node| {
        let height = node.attribute("y")?.parse().ok()?;
        Some((node.text()?.trim().to_owned(), height))
    };
    elements(&document, "text").filter_map(label).collect()
}

#[test]
fn a_report_folder_holds_complete_tables_charts_and_a_page() {
    let folder = folder();
    folder.told(
        "report a.scn -o new/speed --samples 1,4 --runs 2 --set Ball.radius=1.2",
        0,
    );
    let read = |name: &str| folder.text(&format!("new/speed/{name}"));
    let all = ".pinhole error-against-samples.svg error-against-time.svg index.html report.csv report.json";
    let names = program::names(&folder.path("new/speed"));
    assert_eq!(names.join(" "), all);
    let methods = Method::SAMPLED.map(Method::name);

    let csv = read("report.csv");
    let lines: Vec<Vec<_>> = csv.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(lines.len(), 1 + methods.len() * 2 + 1);
    assert!(lines.iter().all(|line| line.len() == lines[0].len()));
    let (first, exact) = (&lines[1], &lines[lines.len() - 1]);
    let at = |name: &str| lines[0].iter().position(|it| *it == name).unwrap();
    assert_eq!((exact[0], exact[at("runs")]), ("exact", "2"));
    for name in ["time", "wall"] {
        assert!(first[at(name)].parse::<f64>().unwrap() > 0.0, "{name}");
    }
    // The row of the exact method has no error, but an error bound instead.
    for name in ["per_pixel", "rmse", "slope"] {
        assert_eq!(exact[at(name)], "", "{name}");
        assert_ne!(first[at(name)], "", "{name}");
    }
    assert!(exact[at("bound")].parse::<f64>().unwrap() < 1e-8);
    assert_eq!(first[at("bound")], "");

    let json: Value = serde_json::from_str(&read("report.json")).unwrap();
    assert_eq!(json["overrides"], serde_json::json!(["Ball.radius=1.2"]));

    for (of, has_exact) in [("samples", false), ("time", true)] {
        let labels = labels(&read(&format!("error-against-{of}.svg")));
        let has = |word: &str| labels.iter().any(|(label, _)| label.starts_with(word));
        assert!(has("1/256") && has("exact") == has_exact, "{of}");
        // The labels of the chart do not overlap.
        let is_method = |label: &str| methods.iter().any(|m| label.split(' ').next() == Some(m));
        let labels = labels.iter().filter(|(label, _)| is_method(label));
        let mut heights: Vec<i32> = labels.map(|(_, height)| *height).collect();
        heights.sort_unstable();
        assert_eq!(heights.len(), methods.len());
        let is_apart = |pair: &[i32]| pair[1] - pair[0] >= 15;
        assert!(heights.windows(2).all(is_apart), "{heights:?}");
        assert!(heights[0] > 0 && heights[8] < 440);
    }

    let page = read("index.html");
    let document = parsed(&page);
    let count = |name| elements(&document, name).count();
    // The page shows the exact picture twice, alone and beside the others. For each sampled method,
    // it shows the picture and its difference from the exact picture.
    let counts = [count("script"), count("table"), count("main"), count("img")];
    assert_eq!(counts, [0, 1, 1, 2 + 2 * methods.len()]);
    // The recommendation comes first, then the charts, the table and the pictures.
    let order = ["class=\"verdict\">Use ", "<svg ", "<table>", "<img "];
    let places = order.map(|what| page.find(what).expect(what));
    assert!(places.is_sorted(), "{places:?}");
    // Invisible characters, and characters that reorder text, would be written as escapes, such as
    // `\u{202e}`. The page must not need any.
    assert!(!page.contains("\\u{"), "{page}");
    for image in elements(&document, "img") {
        assert!(!image.attribute("alt").unwrap().is_empty());
        let is_whole = image.attribute("alt") == Some("the exact picture as a whole");
        assert_eq!(size(image), if is_whole { (48, 32) } else { (48, 27) });
    }
    // The page loads nothing from other addresses.
    for node in document.descendants() {
        for name in ["src", "href"] {
            let target = node.attribute(name).unwrap_or("data:");
            assert!(target.starts_with("data:"), "{target}");
        }
    }
}

#[test]
fn the_page_shows_a_large_picture_reduced() {
    let folder = Folder::with([("a.scn", SCENE.replace("checkerboard {}", "").as_str())]);
    folder.told(
        "report a.scn -o out --methods sobol --samples 1 --runs 1 --set image.width=1300 --set image.height=700",
        0,
    );
    let page = folder.text("out/index.html");
    let document = parsed(&page);
    let is_whole = |node: &Node| node.attribute("alt") == Some("the exact picture as a whole");
    let whole = document.descendants().find(is_whole).unwrap();
    assert_eq!(size(whole), (434, 234));
    assert!(page.contains("reduced to 434 × 234 pixels"));
    assert!(page.len() < 500_000, "{}", page.len());
    // The page says nothing about methods and values that were not measured.
    assert!(page.contains("What sobol makes of the picture"));
    for absent in ["Exact makes no error", "Exact takes", "±", "same CPU time"] {
        assert!(!page.contains(absent), "{absent}");
    }
}

#[cfg(unix)]
#[test]
fn scene_names_cannot_escape_the_output_folder_or_break_a_file() {
    let folder = Folder::with([]);
    let names = [
        "...scn",
        "index.html.scn",
        "INDEX.HTML.scn",
        "<b>&\"'\u{1b}[31m\u{ffff}\n.scn",
        "a/../a.scn",
        ".scn",
    ];
    let work = folder.path("work");
    fs::create_dir_all(work.join("a")).unwrap();
    for name in names {
        fs::write(work.join(name), format!("{SCENE}// \u{1b}\n")).unwrap();
    }
    let mut arguments = vec!["report"];
    arguments.extend(names);
    arguments.extend("-o out --samples 1 --runs 1 --methods sobol".split(' '));
    let output = program::command(&work, &arguments).output().unwrap();
    let errors = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{errors}");
    assert!(!errors.contains('\u{1b}'));
    // The command has created nothing outside of the scenes' folder, and only the folder of the
    // report in it.
    assert_eq!(folder.names(), ["work"]);
    let entries = |name: &str| program::names(&folder.path(name));
    assert_eq!(entries("work").len(), names.len() + ["a", "out"].len());
    let made = entries("work/out");
    assert_eq!(
        made.len(),
        names.len() + [".pinhole", "index.html"].len(),
        "{made:?}"
    );
    let is_folder = |name: &&String| ![".pinhole", "index.html"].contains(&name.as_str());
    for made in made.iter().filter(is_folder) {
        for file in ["index.html", "error-against-time.svg"] {
            parsed(&folder.text(&format!("work/out/{made}/{file}")));
        }
    }
    // The page has a chapter for each scene.
    let page = folder.text("work/out/index.html");
    let document = parsed(&page);
    let titles = elements(&document, "h2").filter(|node| node.has_tag_name((XHTML, "h2")));
    let titles: Vec<_> = titles.filter_map(|node| node.text()).collect();
    assert_eq!(titles.len(), names.len() + 2, "{titles:?}");
    let last = ["Which method for what", "How this was measured"];
    assert_eq!(titles[4..], [&["a/../a.scn", ".scn"], &last[..]].concat());
}
