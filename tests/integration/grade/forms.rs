//! Tests of points and other results in the forms that teachers' systems read: JUnit XML,
//! Gradescope's results and Moodle's worksheet.

use serde_json::Value;

use super::classes::{folder, put};
use crate::{program::Folder, table::rows};

/// Creates a class with one picture of each verdict.
fn class() -> Folder {
    let folder = folder();
    let files = [
        ("class/A_1_assignsubmission_file_a.png", "right.png"),
        ("class/<B> & \"b\"_2_assignsubmission_file_b.png", "red.png"),
        ("class/C_3_assignsubmission_file_c.png", "noise.png"),
        ("class/D_4_assignsubmission_file_d.heic", "ftypheic"),
        ("class/F_6_assignsubmission_file_f.png", "size.png"),
        (
            "points.json",
            r#"{"total": 20, "object": 2, "mistakes": {"background": 3.5, "*": 1}}"#,
        ),
    ];
    put(&folder, &files);
    // The picture differs from the scene in a way that no known mistake explains.
    let mut stripes = image::open(folder.path("right.png")).unwrap().to_rgb8();
    for (x, y, pixel) in stripes.enumerate_pixels_mut() {
        if (x + 2 * y) % 5 < 2 {
            *pixel = image::Rgb(pixel.0.map(|byte| 255 - byte));
        }
    }
    let path = folder.path("class/E_5_assignsubmission_file_e.png");
    stripes.save(path).unwrap();
    folder
}

#[test]
fn junit_has_a_test_case_per_student() {
    let folder = class();
    let said = folder.run("grade a.scn class --format junit");
    assert_eq!((said.status, said.errors.as_str()), (1, ""));
    let document = roxmltree::Document::parse(said.text()).unwrap();
    let suites = document.root_element();
    let suite = suites.first_element_child().unwrap();
    for (node, name) in [(suites, "testsuites"), (suite, "testsuite")] {
        assert!(node.has_tag_name(name));
        for (count, expected) in [
            ("tests", "6"),
            ("failures", "2"),
            ("errors", "1"),
            ("skipped", "1"),
        ] {
            assert_eq!(node.attribute(count), Some(expected), "{count}");
        }
    }
    let cases: Vec<_> = suite.children().filter(|node| node.is_element()).collect();
    let kinds = cases.iter().map(|case| {
        let kind = case
            .first_element_child()
            .map(|node| node.tag_name().name());
        (case.attribute("name").unwrap(), kind)
    });
    let expected = [
        ("<B> & \"b\"", Some("failure")),
        ("A", None),
        ("C", None),
        ("D", Some("error")),
        ("E", Some("skipped")),
        ("F", Some("failure")),
    ];
    assert_eq!(kinds.collect::<Vec<_>>(), expected);
    let failure = cases[0].first_element_child().unwrap();
    assert!(
        failure
            .attribute("message")
            .unwrap()
            .starts_with("wrong: the image has a wrong colour")
    );
    assert!(
        failure
            .text()
            .unwrap()
            .contains("the scene says image.background")
    );
}

#[test]
fn gradescope_gets_a_score_only_where_it_is_known() {
    let folder = class();
    let told = folder.told("grade a.scn class --format gradescope", 2);
    assert!(told.contains("say with `-o DIR`"), "{told}");
    folder.run("grade a.scn class --format gradescope -o out --points points.json");
    let results = |student: &str| -> Value {
        serde_json::from_str(&folder.text(&format!("out/{student}/results.json"))).unwrap()
    };
    let cases = [
        ("A", Some(20.0)),
        ("_B_____b_", Some(16.5)),
        ("C", Some(20.0)),
        ("E", None),
        ("F", Some(18.0)),
    ];
    for (student, score) in cases {
        let found = results(student);
        assert_eq!(found["score"].as_f64(), score, "{student}");
        let tests = found["tests"].as_array().unwrap();
        let names: Vec<_> = tests
            .iter()
            .map(|test| test["name"].as_str().unwrap())
            .collect();
        assert_eq!(
            names,
            [
                "camera",
                "sphere Ball",
                "box with the index 1",
                "colours",
                "sampling",
                "hits"
            ]
        );
        for test in tests {
            assert_eq!(test["visibility"], "visible");
            // With `--points`, only the whole submission has points. If each test had an equal
            // share of them, one mistake could cost more points than its test is worth.
            assert!(test.get("score").is_none() && test.get("max_score").is_none());
        }
        let failed = tests.iter().filter(|test| test["status"] == "failed");
        let failed: Vec<_> = failed.map(|test| test["name"].as_str().unwrap()).collect();
        let expected: &[&str] = match student {
            "_B_____b_" => &["colours"],
            "F" => &["sphere Ball"],
            _ => &[],
        };
        assert_eq!(failed, expected, "{student}");
    }
    assert!(results("D").get("score").is_none());
    // The result for a single student goes to standard output, where an autograder expects it.
    let said = folder.run("grade a.scn class/F_6_assignsubmission_file_f.png --format gradescope");
    assert_eq!(said.status, 1);
    let found: Value = serde_json::from_slice(&said.output).unwrap();
    assert_eq!(found["score"], 5.0);
    // Without a scheme of points, each test gives at most one point, and the score is the sum over
    // all tests.
    let sum = |key: &str| -> f64 {
        let tests = found["tests"].as_array().unwrap().iter();
        tests.filter_map(|test| test[key].as_f64()).sum()
    };
    assert_eq!([sum("score"), sum("max_score")], [5.0, 6.0]);
}

#[test]
fn mistakes_in_all_objects_of_a_block_belong_to_its_first_object() {
    const BALLS: &str = "\
camera { eye (0, 2, 8)  lookat (0, 1, 0) }
sphere Ball for i < 2 { center (4 * i - 2, 1, 0)  radius 1  color teal }
image { width 64  height 36 }
";
    let folder = Folder::with([
        ("a.scn", BALLS),
        ("b.scn", &BALLS.replace("radius 1", "radius 1.4")),
    ]);
    folder.told("render b.scn -o b.png", 0);
    let said = folder.run("grade a.scn b.png --format gradescope");
    let found: Value = serde_json::from_slice(&said.output).unwrap();
    let tests = found["tests"].as_array().unwrap().iter();
    let failed = tests.filter(|test| test["status"] == "failed");
    let failed: Vec<_> = failed.map(|test| test["name"].as_str().unwrap()).collect();
    assert_eq!(failed, ["sphere Ball[0]"]);
}

const WORKSHEET: &str = "\u{feff}Identifier,\"Full name\",Grade,\"Maximum Grade\",\"Grade can be changed\",\"Last modified (grade)\",\"Feedback comments\"\r
\"Participant 1\",\"A, A\",,20.00,Yes,-,\r
\"Participant 2\",B,\"1,50\",20.00,Yes,-,\"old\r\ntext\"\r
\"Participant 99\",\"No, \"\"body\"\"\",,20.00,Yes,\"Monday, 3 March\",\"stays\"\r
\"Participant 5\",E,7.00,20.00,Yes,-,\r
\"Participant 3\",C,2.00,20.00,No,-,\"stays\"\r
";

#[test]
fn a_worksheet_of_moodle_keeps_everything_but_grades_and_comments() {
    let folder = class();
    folder.write("work.csv", WORKSHEET);
    let said =
        folder.run("grade a.scn class --format moodle --worksheet work.csv --points points.json");
    assert_eq!(said.status, 1);
    let missing: Vec<_> = said.errors.lines().collect();
    assert_eq!(
        missing,
        [
            "warning: work.csv has no row for D",
            "warning: work.csv has no row for F"
        ]
    );
    assert_eq!(folder.text("work.csv"), WORKSHEET);
    let filled = said.text();
    // Rows of the worksheet that do not change are kept byte for byte.
    for row in [
        "\"Participant 99\",\"No, \"\"body\"\"\",,20.00,Yes,\"Monday, 3 March\",\"stays\"\r\n",
        "\"Participant 3\",C,2.00,20.00,No,-,\"stays\"\r\n",
    ] {
        assert!(filled.contains(row), "{filled}");
    }
    let (head, _) = WORKSHEET.split_once('\n').unwrap();
    assert!(filled.starts_with(head));
    let records = |text: &str| -> Vec<Vec<String>> {
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let records = reader.records().map(|record| record.unwrap());
        records
            .map(|record| record.iter().map(str::to_owned).collect())
            .collect()
    };
    let (old, new) = (records(WORKSHEET), records(filled));
    assert_eq!(old.len(), new.len());
    for (old, new) in old.iter().zip(&new) {
        for column in [0, 1, 3, 4, 5] {
            assert_eq!(old[column], new[column]);
        }
    }
    let cells: Vec<_> = new
        .iter()
        .map(|row| (&*row[2], row[6].split(['.', ',', ':']).next().unwrap()))
        .collect();
    assert_eq!(
        cells,
        [
            ("20", "Your picture is right"),
            ("16.5", "Your picture differs from the exact one"),
            ("", "stays"),
            ("", "Your picture differs from the exact one"),
            ("2.00", "stays"),
        ]
    );
    assert!(new[1][6].contains("<br>- the image has a wrong colour"));
    // Without a scheme of points, the grades in the worksheet stay as they are. This is tested with
    // a German worksheet: its columns have German names, so `--columns` must say which column is
    // which.
    let german = WORKSHEET
        .replace("Grade,", "Bewertung,")
        .replace("Feedback comments", "Feedback als Kommentar");
    folder.write("german.csv", german);
    let line = "grade a.scn class --format moodle --worksheet german.csv";
    let told = folder.told(line, 2);
    assert!(told.contains("it has no column `Grade` among "), "{told}");
    let columns = "--columns Grade=Bewertung --columns 'Feedback comments=Feedback als Kommentar'";
    folder.run(&format!("{line} {columns} -o out"));
    let kept = records(&folder.text("out/german.csv"));
    assert_eq!(
        kept.iter().map(|row| &*row[2]).collect::<Vec<_>>(),
        ["", "1,50", "", "7.00", "2.00"]
    );
    folder.write("small.csv", WORKSHEET.replace("20.00", "10.00"));
    let told = folder.told(
        "grade a.scn class --format moodle --worksheet small.csv --points points.json",
        2,
    );
    assert!(
        told.contains("its grades go up to 10, and the points to 20"),
        "{told}"
    );
    // Spreadsheet programs may save a worksheet with semicolons or in UTF-16. Such a worksheet is
    // rejected with a hint.
    for bytes in [
        WORKSHEET.replace(',', ";").into_bytes(),
        WORKSHEET
            .encode_utf16()
            .flat_map(u16::to_le_bytes)
            .collect(),
    ] {
        folder.write("saved.csv", bytes);
        let told = folder.told("grade a.scn class --format moodle --worksheet saved.csv", 2);
        assert!(
            told.contains("save it as CSV in UTF-8 with commas"),
            "{told}"
        );
    }
    folder.told("grade a.scn class --format moodle", 2);
    let told = folder.told(&format!("{line} --columns Note=Bewertung"), 2);
    assert!(
        told.contains("where COLUMN is Identifier, Grade,"),
        "{told}"
    );
}

#[test]
fn points_are_numbers_for_known_mistakes() {
    let folder = class();
    let cases = rows(
        r#"
        {"total": 20, "mistakes": {"roll_sing": 3, "*": 2}} -> there is no mistake `roll_sing`: did you mean `roll_sign`?
        {"total": 20, "mistakes": {"roll_sign": -3, "*": 2}} -> `roll_sign` is -3, and points are numbers from 0 on
        {"total": "20", "mistakes": {"*": 2}} -> `total` is "20"
        {"mistakes": {"*": 2}} -> `total` is missing
        {"total": 20, "mistakes": {"radius": 2}} -> `mistakes` has no `*`
        {"total": 20, "bonus": 1, "mistakes": {"*": 2}} -> there is no `bonus` among points
        [20] -> points are {"total": 20
        {"total": 20, -> EOF while parsing
    "#,
    );
    for [points, words] in cases {
        folder.write("points.json", points);
        let told = folder.told("grade a.scn class --points points.json", 2);
        assert!(told.contains(words), "{told}");
    }
    folder.told("grade a.scn class --points none.json", 2);
}

#[test]
fn a_crop_is_compared_with_the_part_that_is_named() {
    let folder = class();
    folder.told(
        "render a.scn -o part.png --crop 4,3,10,12 --set sampler.method=exact",
        0,
    );
    // A PNG file can state which crop of the picture it is. This picture is decoded and saved again
    // without this statement, so the commands cannot know the crop.
    let path = folder.path("part.png");
    image::open(&path).unwrap().to_rgb8().save(&path).unwrap();
    for command in ["grade a.scn part.png", "diff part.png a.scn"] {
        let told = folder.told(command, 2);
        assert!(
            told.contains("if it is a part of it, `--crop X,Y,10,12` says which"),
            "{told}"
        );
        let command = command.replace("part.png", "part.png --crop 4,3,10,12");
        let told = folder.told(&command, 0);
        assert!(told.contains("right: equal to the exact picture"), "{told}");
    }
    let told = folder.told("grade a.scn part.png", 2);
    assert!(
        told.contains("it fits best at `--crop 4,3,10,12`"),
        "{told}"
    );
    folder.told("grade a.scn right.png part.png --crop 4,3,10,12", 0);
    let sized = "--set image.width=12 --set image.height=8";
    folder.told(&format!("render a.scn -o half.png {sized}"), 0);
    let told = folder.told("grade a.scn half.png", 2);
    assert!(
        told.contains("`--set image.width=12 --set image.height=8` compares it"),
        "{told}"
    );
}
