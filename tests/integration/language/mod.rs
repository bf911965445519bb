//! What scenes mean, and the language's reference, held against the program.

mod answers;
mod overrides;
mod reference;
mod repetition;
mod seen;
mod text;
mod ways_out;

const CAMERA: &str = "camera { eye (0, 2, 8) lookat (0, 1, 0) }\n";

/// The codes of what is wrong with a scene, apart by blanks.
fn codes(text: &str) -> String {
    crate::diagnostics::codes(text, &[]).join(" ")
}
