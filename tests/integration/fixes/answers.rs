//! Compares the fixes of mistakes, and the texts after the fixes, with files in `tests/fixes`.

use pinhole::{diagnostic::apply, source::SourceId};

use super::{Trial, diagnostics};
use crate::{diagnostics::codes, scenes::sources, snapshot::assert_answers};

/// Applies the first fix again and again until no problem has a fix. Only one fix is applied at a
/// time, because a fix may move the text of later ones. Returns the resulting text, or `None` if
/// the text had no fix.
fn mended(text: &str) -> Option<String> {
    let mut trial = Trial::default();
    trial.apply_fixes(&sources(text), |_, _| true);
    assert_eq!(trial.complaints, [""; 0]);
    let mut mended = text.to_owned();
    loop {
        let found = diagnostics(&sources(&mended));
        let Some(fix) = found.iter().find_map(|d| d.fixes.first()) else {
            let has_error = found.iter().any(|d| d.is_error());
            assert!(!has_error || mended == text, "{mended}");
            return (mended != text).then_some(mended);
        };
        mended = apply(fix, SourceId::File, &mended);
    }
}

const QUESTIONS: [&str; 6] = ["offered", "of_all", "at_the_end", "mended", "kind", "told"];

fn answer(question: &str, text: &str, _: &str) -> String {
    let camera = if text.contains("camera {") {
        ""
    } else {
        "camera { eye (0, 1, 5)  lookat (0, 1, 0) }\n"
    };
    assert!(QUESTIONS.contains(&question), "{question}");
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
    if question == "mended" {
        let mended = mended(&whole);
        let mended = mended.map_or_else(String::new, |mended| of_text(&mended));
        return format!("{} | {mended}", codes(&whole, &[]).join(" "));
    }
    let mut found = diagnostics(&sources(&whole));
    if found.is_empty() {
        return "nothing".to_owned();
    }
    let first = found.remove(0);
    if question == "told" {
        let others = found
            .iter()
            .map(|other| format!(" | and {}", other.message));
        let others: String = others.collect();
        let at = &whole[first.labels[0].span.range()];
        let help = first.help.unwrap_or_default();
        let kind = first.fixes.first().map(|fix| fix.applicability.word());
        let kind = kind.map(|kind| format!(" | {kind}")).unwrap_or_default();
        return format!("{} | {at} | {help}{kind}{others}", first.message);
    }
    let offered = first.fixes.iter().map(|fix| {
        let fixed = apply(fix, SourceId::File, &whole);
        if question == "of_all" {
            assert_eq!(codes(&fixed, &[]), [""; 0]);
        }
        let title = match question {
            "kind" => format!("{}, {}", fix.applicability.word(), fix.title),
            _ => fix.title.clone(),
        };
        format!("{title}: {}", of_text(&fixed))
    });
    let offered: Vec<String> = offered.collect();
    if offered.is_empty() {
        first.help.unwrap_or_default()
    } else {
        offered.join(" | ")
    }
}

#[test]
fn fixes_match_the_files_in_tests_fixes() {
    assert_answers("tests/fixes", answer);
}
