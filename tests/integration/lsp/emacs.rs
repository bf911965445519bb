//! Tests the language server in Emacs in batch mode, with each of the two clients of Emacs, eglot
//! and lsp-mode. The tests need `emacs` on the path, with both clients:
//! `cargo test -- --ignored emacs`. Emacs 28.2, eglot 1.9 and lsp-mode 8.0 are known to work.

use std::{path::Path, process::Command};

use serde_json::Value;

use super::path_with_program;
use crate::program::Folder;

const SCENE: &str = "let r = 1
camera { eye (0, 1, 5)   lookat (0, r, 0) }
sphere Ball { center (0, r, 0)  radus 2*r }
";

/// Text that the scene must have at the end. The script in Emacs fixes the field `radus`, renames
/// `r`, and formats the text.
const EDITED: &str = "let height = 1
camera { eye (0, 1, 5)  lookat (0, height, 0) }
sphere Ball { center (0, height, 0)  radius 2 * height }
";

/// Runs the script `tests/lsp/emacs.el` in Emacs.
#[test]
#[ignore = "needs Emacs"]
fn emacs_completes_fixes_renames_and_formats_a_scene() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for client in ["eglot", "lsp-mode"] {
        let folder = Folder::with([("scene.scn", SCENE)]);
        let mut emacs = Command::new("emacs");
        emacs
            .args(["-q", "--batch", "-l"])
            .arg(root.join("tests/lsp/emacs.el"))
            .current_dir(folder.path(""))
            .env("HOME", folder.path(""))
            .env("PATH", path_with_program())
            .env("CLIENT", client)
            .env("MODE", root.join("grammar/editors/emacs/pinhole-mode.el"));
        let output = emacs.output().expect("Emacs is on the path");
        assert!(folder.path("answers.json").exists(), "{output:?}");
        let found: Value = serde_json::from_slice(&folder.read("answers.json")).expect("JSON");
        assert_eq!(found["failure"], Value::Null, "{client}: {output:?}");
        assert_eq!(found["mode"], "pinhole-mode");
        let told = found["told"][0].as_str().expect("a message");
        assert!(
            told.contains("a sphere has no field `radus`"),
            "{client}: {told}"
        );
        assert_eq!(
            found["completed"],
            serde_json::json!(["sphere"]),
            "{client}"
        );
        assert_eq!(found["text"], EDITED, "{client}");
    }
}
