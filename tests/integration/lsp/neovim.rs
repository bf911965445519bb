//! A real editor talks to the server: Neovim without its window, which has to be there: `cargo test -- --ignored neovim`, with `nvim` on
//! the path.

use std::{path::Path, process::Command};

use serde_json::Value;

use crate::{program::Folder, snapshot::assert_file};

const SCENE: &str = "// 🎱 é: a ball
let ball = (0, 1, 0)
camera { eye (0, 1, 5)  lookat ball  d 1 }
sphere Ball { center ball  /* 🎱 */ radus 0.5 }
";

/// It does what `tests/lsp/neovim.lua` says, and gets the answers beside that.
#[test]
#[ignore = "needs Neovim"]
fn neovim_writes_a_scene() {
    let folder = Folder::with([("scene.scn", SCENE)]);
    let home = folder.path("");
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/lsp/neovim.lua");
    let mut neovim = Command::new("nvim");
    neovim
        .args(["--headless", "--clean", "-c"])
        .arg(format!("luafile {}", script.display()))
        .current_dir(&home)
        .env("PINHOLE", env!("CARGO_BIN_EXE_pinhole"))
        .env("ANSWERS", folder.path("answers.json"));
    for name in ["HOME", "XDG_STATE_HOME", "XDG_CACHE_HOME"] {
        neovim.env(name, &home);
    }
    let output = neovim.output().expect("Neovim is on the path");
    assert!(folder.path("answers.json").exists(), "{output:?}");
    let mut found: Value = serde_json::from_slice(&folder.read("answers.json")).unwrap();
    // Lua keeps no order.
    found.sort_all_objects();
    let found = format!("{found:#}\n");
    assert_file(&script.with_extension("json"), &found);
}
