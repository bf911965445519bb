//! Fixes of definitions and of what uses them.

use super::{diagnostics, of_scene, sources};

#[test]
fn a_definition_that_failed_explains_its_uses() {
    let codes = |text: &str| -> Vec<String> {
        let found = diagnostics(&sources(&of_scene(text), &[]));
        found.into_iter().map(|d| d.code).collect()
    };
    let only = ["pinhole::predefined_name"];
    let sphere = |name: &str, value: &str| {
        format!("let {name} = {value}  sphere {{ center (0, 1, 0)  radius {name} }}")
    };
    for name in ["max", "deg", "gray"] {
        assert_eq!(codes(&sphere(name, "3")), only, "{name}");
    }
    assert_eq!(
        codes("let gray = 2 let a = (0, gray, 0) let b = 1 + gray"),
        only
    );
    // Others, and what stands above, are mistakes of their own.
    let both = codes("let max = 3 sphere { center (0, 1, 0)  radius min }");
    assert_eq!(
        both,
        [
            "pinhole::predefined_name",
            "pinhole::function_without_arguments"
        ]
    );
    let above = codes("let a = max let max = 3");
    assert_eq!(
        above,
        [
            "pinhole::function_without_arguments",
            "pinhole::predefined_name"
        ]
    );
}
