//! Compares the language's reference with the program.

use pinhole::schema::{self, Preset};

const REFERENCE: &str = include_str!("../../../grammar/language.md");

#[test]
fn the_reference_lists_every_field_with_its_type_default_and_conditions() {
    let mut block = "";
    let mut rows = Vec::new();
    for line in REFERENCE.lines().filter(|line| line.starts_with('|')) {
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        if let [kind, field, takes, preset, must] = cells[..] {
            block = if kind.is_empty() { block } else { kind };
            rows.push(((block, field), takes, preset, must));
        }
    }
    for kind in schema::BLOCKS {
        for field in kind.fields {
            let place = format!("{}.{}", kind.name, field.name);
            let at = rows.iter().position(|row| row.0 == (kind.name, field.name));
            let at = at.unwrap_or_else(|| panic!("no row {place}"));
            let (_, takes, preset, must) = rows.swap_remove(at);
            let noun = field.takes.noun().trim_start_matches("a ");
            assert_eq!(takes, noun.trim_start_matches("an "), "{place}");
            assert_ne!(field.example, "", "{place}");
            let excluded: Vec<&str> = kind.excludes(field.name).collect();
            match field.preset {
                Preset::Value(value) => assert_eq!(preset, value.to_string(), "{place}"),
                Preset::Required => assert_eq!(preset, "required", "{place}"),
                Preset::Nothing => assert_eq!(preset, "none", "{place}"),
                Preset::Alternative => {
                    let is_named = |other: &&str| preset.contains(other) || must.contains(other);
                    assert!(excluded.iter().all(is_named), "{place}");
                }
            }
            let mut conditions: Vec<String> = field.must.iter().map(|m| m.to_string()).collect();
            if field.preset != Preset::Alternative && !excluded.is_empty() {
                conditions.push(format!("not with {}", excluded.join(", ")));
            }
            for condition in conditions {
                assert!(must.contains(&condition), "{place}: {condition}");
            }
        }
        for together in kind.joint_conditions {
            assert!(REFERENCE.contains(together), "{together}");
        }
    }
    let header_and_rule = 2;
    assert_eq!(rows.len(), header_and_rule, "{rows:?}");
}

/// In the table of lenses, each row gives a focal length by `d` and by `fov`. The value of `d` must
/// be exact, and the angle correct to its last digit.
#[test]
fn the_lens_table_of_the_reference_is_exact() {
    let mut lenses = 0;
    for line in REFERENCE.lines() {
        let Some((lens, row)) = line.split_once(" mm | ") else {
            continue;
        };
        let lens = lens.trim_start_matches("| ");
        let focal: f64 = lens.parse().unwrap();
        let angle = (2.0 * (12.0 / focal).atan()).to_degrees();
        assert_eq!(row, format!("`d {lens}/12` | `fov {angle:.4}deg` |"));
        lenses += 1;
    }
    assert_eq!(lenses, 8);
}

#[test]
fn the_reference_has_every_method_function_and_name() {
    for (method, _) in schema::METHODS {
        assert!(REFERENCE.contains(&format!("| {} |", method.name())));
    }
    // Only the section about functions is searched, because a name such as `min` may be a field
    // elsewhere.
    let (_, functions) = REFERENCE.split_once("## Functions").unwrap();
    let functions = functions.split("## ").next().unwrap_or_default();
    let rows = functions.lines().filter(|line| line.starts_with('|'));
    for function in schema::FUNCTIONS {
        let ways = ['`', '('].map(|end| format!("`{}{end}", function.name));
        let has = |row: &&str| ways.iter().any(|way| row.contains(way));
        assert_eq!(rows.clone().filter(has).count(), 1, "{}", function.name);
    }
    for (name, ..) in schema::CONSTANTS {
        assert!(REFERENCE.contains(&format!("`{name}`")));
    }
}
