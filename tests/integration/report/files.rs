//! The files of a report: charts, tables, and a page that stands alone.

use std::{fs, path::Path};

use base64::{Engine, prelude::BASE64_STANDARD};
use image::DynamicImage;
use pinhole::scene::Method;
use roxmltree::Node;
use serde_json::Value;

use super::{SCENE, folder, parsed, read, report, words};
#[cfg(unix)]
use crate::program;

const XHTML: &str = "http://www.w3.org/1999/xhtml";

/// The picture within an element.
fn picture(element: Node) -> DynamicImage {
    let data = element.attribute("src").unwrap();
    let png = data.strip_prefix("data:image/png;base64,").unwrap();
    image::load_from_memory(&BASE64_STANDARD.decode(png).unwrap()).unwrap()
}

#[test]
fn a_folder_gets_whole_files() {
    let folder = folder();
    let arguments = [
        "a.scn",
        "-o",
        "new/speed",
        "--samples",
        "1,4,16",
        "--runs",
        "2",
        "--methods",
        "sobol,random,exact",
        "--set",
        "Ball.radius=1.2",
    ];
    let output = report(&folder, &arguments);
    assert!(output.status.success(), "{}", words(&output.stderr));
    let mut names: Vec<_> = fs::read_dir(folder.path().join("new/speed"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    let all = [
        "error-against-samples.svg",
        "error-against-time.svg",
        "index.html",
        "report.csv",
        "report.json",
    ];
    assert_eq!(names, all);

    let csv = read(&folder, "new/speed/report.csv");
    let lines: Vec<Vec<_>> = csv.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(lines.len(), 1 + 2 * 3 + 1);
    assert!(lines.iter().all(|line| line.len() == lines[0].len()));
    let (names, first, exact) = (&lines[0], &lines[1], &lines[7]);
    let at = |name: &str| names.iter().position(|it| *it == name).unwrap();
    assert_eq!((exact[0], exact[at("runs")]), ("exact", "2"));
    for name in ["time", "wall"] {
        assert!(first[at(name)].parse::<f64>().unwrap() > 0.0, "{name}");
    }
    // The exact method has a bound, which is no measured error.
    for name in ["per_pixel", "rmse", "slope"] {
        assert_eq!(exact[at(name)], "", "{name}");
        assert_ne!(first[at(name)], "", "{name}");
    }
    assert!(exact[at("bound")].parse::<f64>().unwrap() < 1e-8);
    assert_eq!(first[at("bound")], "");

    let json: Value = serde_json::from_str(&read(&folder, "new/speed/report.json")).unwrap();
    assert_eq!(json["overrides"], serde_json::json!(["Ball.radius=1.2"]));

    for name in ["error-against-samples.svg", "error-against-time.svg"] {
        let svg = read(&folder, &format!("new/speed/{name}"));
        let document = parsed(&svg);
        assert!(
            document
                .root_element()
                .has_tag_name(("http://www.w3.org/2000/svg", "svg"))
        );
        let text: Vec<_> = document
            .descendants()
            .filter(|node| node.has_tag_name("text"))
            .collect();
        let labelled = |word: &str| {
            text.iter().any(|node| {
                node.text()
                    .is_some_and(|text| text.trim().starts_with(word))
            })
        };
        assert!(
            labelled("sobol") && labelled("random") && labelled("1/256"),
            "{name}"
        );
        assert_eq!(labelled("exact"), name.contains("time"));
    }

    let page = read(&folder, "new/speed/index.html");
    let document = parsed(&page);
    let elements = |name: &'static str| {
        document
            .descendants()
            .filter(move |node| node.tag_name().name() == name)
    };
    assert_eq!(elements("script").count(), 0);
    assert_eq!(elements("table").count(), 1);
    // The exact picture twice, as a whole and beside the others, and those of the sampled methods.
    assert_eq!(elements("img").count(), 4);
    // First what to do, then the charts, the table, the pictures.
    let order = ["class=\"verdict\">Use ", "<svg ", "<table>", "<img "];
    let places = order.map(|what| page.find(what).expect(what));
    assert!(places.is_sorted(), "{places:?}");
    for image in elements("img") {
        assert!(!image.attribute("alt").unwrap().is_empty());
        let picture = picture(image);
        assert_eq!((picture.width(), picture.height()), (48, 32));
    }
    // Nothing is fetched from elsewhere.
    for node in document.descendants() {
        for attribute in node
            .attributes()
            .filter(|attribute| ["src", "href"].contains(&attribute.name()))
        {
            assert!(attribute.value().starts_with("data:"));
        }
    }
}

#[test]
fn a_large_picture_is_shown_whole_and_small() {
    let folder = folder();
    let arguments = [
        "a.scn",
        "-o",
        "out",
        "--methods",
        "sobol",
        "--samples",
        "1",
        "--runs",
        "1",
        "--set",
        "image.width=1300",
        "--set",
        "image.height=700",
    ];
    assert!(report(&folder, &arguments).status.success());
    let page = read(&folder, "out/index.html");
    let document = parsed(&page);
    let whole = document
        .descendants()
        .find(|node| node.attribute("alt") == Some("the exact picture as a whole"));
    let picture = picture(whole.unwrap());
    assert_eq!((picture.width(), picture.height()), (434, 234));
    assert!(page.contains("reduced to 434 × 234 pixels"));
    assert!(page.len() < 500_000, "{}", page.len());
    // Nothing is said of what was not measured.
    assert!(page.contains("What sobol makes of the picture"));
    for absent in ["Exact makes no error", "Exact takes", "±", "same CPU time"] {
        assert!(!page.contains(absent), "{absent}");
    }
}

#[test]
fn labels_of_a_chart_do_not_lie_upon_each_other() {
    let folder = folder();
    let output = report(
        &folder,
        &["a.scn", "-o", "out", "--samples", "1,4", "--runs", "1"],
    );
    assert!(output.status.success());
    for name in ["samples", "time"] {
        let svg = read(&folder, &format!("out/error-against-{name}.svg"));
        let document = parsed(&svg);
        let mut heights: Vec<i32> = document
            .descendants()
            .filter(|node| {
                let text = node.text().unwrap_or_default().trim();
                let first = text.split(' ').next().unwrap();
                node.has_tag_name("text")
                    && Method::SAMPLED.iter().any(|method| method.name() == first)
            })
            .map(|node| node.attribute("y").unwrap().parse().unwrap())
            .collect();
        assert_eq!(heights.len(), 9);
        heights.sort_unstable();
        assert!(
            heights.windows(2).all(|pair| pair[1] - pair[0] >= 15),
            "{heights:?}"
        );
        assert!(heights[0] > 0 && heights[8] < 440);
    }
}

#[test]
fn several_scenes_have_a_folder_each_and_one_page() {
    let folder = folder();
    fs::create_dir(folder.path().join("sub")).unwrap();
    fs::write(folder.path().join("sub/a.scn"), SCENE).unwrap();
    let arguments = [
        "a.scn",
        "sub/a.scn",
        "-o",
        "out",
        "--samples",
        "1",
        "--runs",
        "1",
        "--methods",
        "halton",
    ];
    assert!(report(&folder, &arguments).status.success());
    for name in [
        "out/a/report.csv",
        "out/a-2/report.json",
        "out/a-2/index.html",
    ] {
        read(&folder, name);
    }
    let page = read(&folder, "out/index.html");
    let document = parsed(&page);
    let titles = document
        .descendants()
        .filter(|node| node.has_tag_name((XHTML, "h2")));
    let titles: Vec<_> = titles.filter_map(|node| node.text()).collect();
    assert_eq!(titles, ["a.scn", "sub/a.scn", "How this was measured"]);
}

#[cfg(unix)]
#[test]
fn no_name_leads_out_of_the_folder_or_breaks_a_file() {
    let folder = folder();
    let names = [
        "...scn",
        "index.html.scn",
        "INDEX.HTML.scn",
        "<b>&\"'\u{1b}[31m\u{ffff}\n.scn",
        "a/../a.scn",
        ".scn",
    ];
    let work = folder.path().join("work");
    fs::create_dir_all(work.join("a")).unwrap();
    let text = format!("{SCENE}// \u{1b}\n");
    for name in names {
        fs::write(work.join(name), &text).unwrap();
    }
    let mut arguments = names.to_vec();
    arguments.extend("-o out --samples 1 --runs 1 --methods sobol".split(' '));
    let arguments = [&["report"], arguments.as_slice()].concat();
    let output = program::command(&work, &arguments).output().unwrap();
    assert!(output.status.success(), "{}", words(&output.stderr));
    assert!(!output.stderr.contains(&0x1b));
    let entries = |path: &Path| {
        let names = fs::read_dir(path)
            .unwrap()
            .map(|entry| entry.unwrap().file_name());
        let mut names: Vec<_> = names.map(|name| name.into_string().unwrap()).collect();
        names.sort();
        names
    };
    // Beside the folder of the scenes there is nothing new, and within it the report's alone.
    assert_eq!(entries(folder.path()), ["a.scn", "work"]);
    assert_eq!(entries(&work).len(), names.len() + ["a", "out"].len());
    let made = entries(&work.join("out"));
    assert_eq!(made.len(), names.len() + 1, "{made:?}");
    for name in made {
        let path = work.join("out").join(&name);
        let page = if path.is_dir() {
            path.join("index.html")
        } else {
            path.clone()
        };
        parsed(&fs::read_to_string(page).unwrap());
        if path.is_dir() {
            parsed(&fs::read_to_string(path.join("error-against-time.svg")).unwrap());
        }
    }
}
