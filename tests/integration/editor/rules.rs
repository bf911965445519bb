//! Tests of rules that the editor's answers about every block and every field must obey.

use std::time::{Duration, Instant};

use pinhole::{
    editor::{CompletionKind, completions, formatting, hover},
    explain,
    schema::{BLOCKS, Preset},
};

use super::{about_text, answers::inserted, at_cursor};

#[test]
fn offered_function_snippets_cause_no_error() {
    let mut offered = 0;
    for block in [
        "sphere { center (0, 1, 0) radius $0 }",
        "checkerboard { square $0 }",
    ] {
        let functions = at_cursor(block, completions).into_iter();
        let functions = functions.filter(|c| c.kind == CompletionKind::Function && c.rank <= 3);
        for function in functions {
            let text = inserted(&block.replace("$0", ""), &function).replace(['‹', '›'], "");
            let text = format!("camera {{ eye (0, 1, 5) lookat (0, 1, 0) }} {text}");
            let found = about_text(&text, |analysis| analysis.diagnostics().len());
            assert_eq!(found, 0, "{text}");
            offered += 1;
        }
    }
    assert!(offered > 0);
}

#[test]
fn only_the_default_value_is_offered_as_the_default() {
    let mut defaults = 0;
    for row in BLOCKS {
        for field in row.fields {
            let text = format!("{} {{ {} $0 }}", row.name, field.name);
            let offered = at_cursor(&text, completions).into_iter();
            for value in offered.filter(|c| c.kind == CompletionKind::Value) {
                let is_preset = matches!(field.preset, Preset::Value(it) if it == value.label);
                assert_eq!(value.detail == "the default", is_preset, "{}", field.name);
                defaults += usize::from(is_preset);
            }
        }
    }
    assert!(defaults > 10, "{defaults}");
}

#[test]
fn every_rule_between_fields_is_documented_at_one_of_them() {
    for row in BLOCKS {
        for rule in row.joint_conditions {
            let mut fields = row.fields.iter();
            let is_told = fields.any(|field| row.rules_of(field.name).any(|told| told == *rule));
            assert!(is_told, "{rule}");
        }
    }
}

#[test]
fn hovering_a_mistake_shows_its_explain_page() {
    let markdown = |text: &str| at_cursor(text, hover).expect("a hover").markdown;
    let page = |code| explain::page(code).expect("a page").text.trim_end();
    let text = markdown("sphere { center (0, 1, 0) rad$0us 2 }");
    let start = "**error:** a sphere has no field `radus`\n\nhelp: did you mean `radius`? ";
    assert!(text.starts_with(start), "{text}");
    let end = format!("\n\n---\n\n{}", page("unknown_field"));
    assert!(text.ends_with(&end), "{text}");
    let text = markdown(
        "let a = 1 sphere { center (0, 1, 0) } camera { eye (0, 1, 5) up (0$0, 0, 1) direction (0, 0, 1) }",
    );
    assert!(text.starts_with("**warning:** "), "{text}");
    let text = markdown("camera { eye (0, 0, 0) lookat (1, 0, 0) roll $030 }");
    assert!(text.starts_with("**error:** "), "{text}");
    assert!(text.contains("\n\n---\n\n`roll` of a camera: "), "{text}");
    let end = format!("\n\n---\n\n{}", page("bare_angle"));
    assert!(text.ends_with(&end), "{text}");
}

/// Formats a sum of 100 000 terms in one line. This takes a few hundredths of a second. If the
/// formatter read the whole line again for each term, it would take half a minute.
#[test]
fn formatting_a_long_line_takes_linear_time() {
    let text = format!("let b = {}1\n", "1+".repeat(100_000));
    let start = Instant::now();
    let changes = about_text(&text, |analysis| formatting(analysis).map(|all| all.len()));
    assert_eq!(changes, Some(1));
    assert!(start.elapsed() < Duration::from_secs(5));
}
