//! Which fixes mistakes get and what they make of a text, as `tests/fixes` has it.

use pinhole::{
    diagnostic::{Fix, apply},
    source::SourceId,
};

use super::{Trial, diagnostics};
use crate::{diagnostics::codes, scenes::sources, snapshot::assert_answers};

fn answer(question: &str, text: &str, _: &str) -> String {
    let camera = match text.contains("camera {") {
        true => "",
        false => "camera { eye (0, 1, 5)  lookat (0, 1, 0) }\n",
    };
    let others = format!("\ncheckerboard {{}}\n{camera}");
    let [before, behind] = match question {
        "of_all" => ["", ""],
        "at_the_end" => [&*others, ""],
        _ => ["", &*others],
    };
    let of_text = |whole: &str| {
        let text = whole
            .strip_prefix(before)
            .and_then(|text| text.strip_suffix(behind));
        text.expect("the rest stays").to_owned()
    };
    let whole = format!("{before}{text}{behind}");
    let fixed = |fix: &Fix, text: &str| apply(fix, SourceId::File, text);
    let found = diagnostics(&sources(&whole));
    if question == "mended" {
        let mut trial = Trial::default();
        trial.type_in(&sources(&whole), |_, _| true);
        assert_eq!(trial.complaints, [""; 0]);
        let mut mended = whole.clone();
        // One fix at a time: it moves the others.
        while let Some(fix) = diagnostics(&sources(&mended))
            .iter()
            .find_map(|d| d.fixes.first())
        {
            mended = fixed(fix, &mended);
        }
        let is_right = !diagnostics(&sources(&mended)).iter().any(|d| d.is_error());
        assert!(is_right || mended == whole, "{mended}");
        let mended = if mended == whole {
            String::new()
        } else {
            of_text(&mended)
        };
        return format!("{} | {mended}", codes(&whole, &[]).join(" "));
    }
    let first = &found[0];
    let offered = first.fixes.iter().map(|fix| {
        let fixed = fixed(fix, &whole);
        if question == "of_all" {
            assert_eq!(codes(&fixed, &[]), [""; 0]);
        }
        format!("{}: {}", fix.title, of_text(&fixed))
    });
    let offered: Vec<String> = offered.collect();
    match offered.is_empty() {
        true => first.help.clone().unwrap_or_default(),
        false => offered.join(" | "),
    }
}

#[test]
fn fixes_are_as_they_stand_there() {
    assert_answers("tests/fixes", answer);
}
