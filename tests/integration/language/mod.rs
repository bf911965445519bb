//! Tests of what scene files mean, i.e. of the scenes read from them, and of the agreement of the
//! language's reference with the program.

mod answers;
mod help;
mod overrides;
mod reference;
mod repetition;
mod text;
mod visibility;

const CAMERA: &str = "camera { eye (0, 2, 8) lookat (0, 1, 0) }\n";

/// Returns the codes of the diagnostics of a scene, separated by spaces.
fn codes(text: &str) -> String {
    crate::diagnostics::codes(text, &[]).join(" ")
}
