//! The language's reference, held against the program.

use std::{fs, path::Path};

use pinhole::schema;

use super::codes;
use crate::scenes::fenced;

#[test]
fn the_reference_has_every_row_of_the_table() {
    let reference = file("grammar/language.md");
    let mut block = String::new();
    let mut rows = Vec::new();
    for line in reference.lines().filter(|line| line.starts_with('|')) {
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        if let [kind, field, takes, preset, must] = cells[..] {
            if !kind.is_empty() {
                block = kind.to_owned();
            }
            rows.push((block.clone(), field, takes, preset, must));
        }
    }
    let mut fields = 0;
    for kind in schema::BLOCKS {
        for field in kind.fields {
            fields += 1;
            let place = format!("{}.{}", kind.name, field.name);
            let row = rows
                .iter()
                .find(|row| row.0 == kind.name && row.1 == field.name);
            let &(_, _, takes, preset, must) = row.unwrap_or_else(|| panic!("no row {place}"));
            let noun = field.takes.noun();
            let takes_noun = noun.trim_start_matches("a ").trim_start_matches("an ");
            assert_eq!(takes, takes_noun, "{place}");
            assert_ne!(field.example, "", "{place}");
            match field.preset {
                schema::Preset::Value(value) => assert_eq!(preset, value.to_string(), "{place}"),
                schema::Preset::Required => assert_eq!(preset, "required", "{place}"),
                schema::Preset::Nothing => assert_eq!(preset, "none", "{place}"),
                schema::Preset::Alternative => {
                    for other in kind.excludes(field.name) {
                        assert!(preset.contains(other) || must.contains(other), "{place}");
                    }
                }
            }
            for condition in field.must {
                assert!(
                    must.contains(&condition.to_string()),
                    "{place}: {condition}"
                );
            }
            let excluded: Vec<&str> = kind.excludes(field.name).collect();
            if field.preset != schema::Preset::Alternative && !excluded.is_empty() {
                let excludes = format!("not with {}", excluded.join(", "));
                assert!(must.contains(&excludes), "{place}: {excludes}");
            }
        }
        for together in kind.together {
            assert!(reference.contains(together), "{together}");
        }
    }
    let header_and_rule = 2;
    assert_eq!(rows.len(), fields + header_and_rule);
}

#[test]
fn the_reference_has_every_method_function_and_name() {
    let reference = file("grammar/language.md");
    for (method, _) in schema::METHODS {
        assert!(reference.contains(&format!("| {} |", method.name())));
    }
    // Elsewhere, a name such as `min` may be a field's.
    let rows = reference
        .split("## ")
        .find(|part| part.starts_with("Functions"));
    let rows: Vec<&str> = rows
        .expect("the functions")
        .lines()
        .filter(|line| line.starts_with('|'))
        .collect();
    for function in schema::FUNCTIONS {
        let ways = ['`', '('].map(|end| format!("`{}{end}", function.name));
        let has = |row: &&&str| ways.iter().any(|way| row.contains(way));
        assert_eq!(rows.iter().filter(has).count(), 1, "{}", function.name);
    }
    for (name, ..) in schema::CONSTANTS {
        assert!(reference.contains(&format!("`{name}`")));
    }
}

#[test]
fn every_scene_of_the_reference_checks_clean() {
    let reference = file("grammar/language.md");
    let mut scenes = 0;
    for scene in fenced(&reference, "scn") {
        assert_eq!(codes(scene), [""; 0], "{scene}");
        scenes += 1;
    }
    assert!(scenes >= 4);
}

fn file(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
    fs::read_to_string(path).expect("the file can be read")
}
