//! Tests the language server in Neovim in headless mode. The tests need `nvim` on the path:
//! `cargo test -- --ignored neovim`. Versions 0.7 and 0.11 are known to work.

use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

use serde_json::{Value, json};

use super::path_with_program;
use crate::{program::Folder, scenes::fenced, snapshot::assert_file};

const SCENE: &str = "// 🎱 é: a ball
let ball = (0, 1, 0)
camera { eye (0, 1, 5)  lookat ball  d 1 }
sphere Ball { center ball  /* 🎱 */ radus 0.5 }
";

fn root(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// Returns a command that runs a script in Neovim with a separate home folder. The command's search
/// path begins with the folder of the tested program.
fn neovim(folder: &Folder, script: &Path) -> Command {
    let home = folder.path("");
    let mut neovim = Command::new("nvim");
    neovim
        .args(["--headless", "--clean", "-c"])
        .arg(format!("luafile {}", script.display()))
        .current_dir(&home)
        .env("PINHOLE", env!("CARGO_BIN_EXE_pinhole"))
        .env("PLUGIN", root("grammar/editors/neovim"))
        .env("ANSWERS", folder.path("answers.json"));
    for name in ["HOME", "XDG_STATE_HOME", "XDG_CACHE_HOME"] {
        neovim.env(name, &home);
    }
    neovim.env("PATH", path_with_program());
    neovim
}

fn answers(folder: &Folder, mut neovim: Command) -> Value {
    let output = neovim.output().expect("Neovim is on the path");
    assert!(folder.path("answers.json").exists(), "{output:?}");
    serde_json::from_slice(&folder.read("answers.json")).expect("JSON")
}

/// Runs the script `tests/lsp/neovim.lua` in Neovim. A JSON file beside the script contains the
/// expected answers.
#[test]
#[ignore = "needs Neovim"]
fn neovim_gets_the_recorded_answers() {
    let folder = Folder::with([("scene.scn", SCENE)]);
    let script = root("tests/lsp/neovim.lua");
    let mut found = answers(&folder, neovim(&folder, &script));
    // Lua tables have no order, so the members of JSON objects are sorted.
    found.sort_all_objects();
    let found = format!("{found:#}\n");
    assert_file(&script.with_extension("json"), &found);
}

/// Three texts: the initial text, the keys to type at `$0`, and the resulting line.
type Typed = [&'static str; 3];

/// Completions that `CTRL-X CTRL-O` requests, as rows of [`Typed`]. Neovim 0.7 inserts the whole
/// completion, Neovim 0.11 only its first word. Therefore, only the beginning of the resulting line
/// is compared.
const ASKED: &[Typed] = &[
    ["$0\ncamera {}", "s p h <C-x><C-o>", "sphere"],
    ["$0\ncamera {}", "s <C-x><C-o> menu <C-n> <C-y>", "sphere"],
    ["triangle { $0 }", "c e n <C-x><C-o>", "triangle { centroid"],
    [
        "let Big_1 = 1\nsphere { radius $0 }",
        "B <C-x><C-o>",
        "sphere { radius Big_1",
    ],
];

/// Completions that Neovim offers while the user types, as rows of [`Typed`]. They are tested only
/// with Neovim 0.11 or later and the configuration that the documentation for editors gives.
const OFFERED: &[Typed] = &[
    // In the next row, the menu is open, but the user chooses no completion. So nothing is
    // inserted.
    ["$0\ncamera {}", "s menu p h", "sph"],
    [
        "$0\ncamera {}",
        "s menu p h <C-n> <C-y>",
        "sphere { center (0, 1, 0) }",
    ],
    [
        "triangle { $0 }",
        "v menu 1 <C-n> <C-y>",
        "triangle { v1 (1, 0, 0) }",
    ],
    [
        "let Big_1 = 1\nlet Big_2 = 2\nsphere { radius $0 }",
        "B menu i g _ 2 <C-n> <C-y>",
        "sphere { radius Big_2 }",
    ],
    ["sphere { radius $0 }", "1 2", "sphere { radius 12 }"],
];

#[test]
#[ignore = "needs Neovim"]
fn neovim_completes_while_typing() {
    let version = Command::new("nvim").arg("--version").output();
    let version = String::from_utf8(version.expect("Neovim is on the path").stdout).expect("text");
    // Neovim has the module `vim.lsp.completion` from version 0.11 on.
    let is_new = !["v0.7.", "v0.8.", "v0.9.", "v0.10."]
        .iter()
        .any(|old| version.contains(old));

    let found = typed(ASKED, None);
    for ([text, keys, line], found) in ASKED.iter().zip(found["lines"].as_array().unwrap()) {
        assert!(
            found.as_str().unwrap().starts_with(line),
            "{text} {keys}: {found}"
        );
    }
    if !is_new {
        return;
    }
    let page = fs::read_to_string(root("grammar/editors/README.md")).unwrap();
    let snippets = fenced(&page, "lua");
    let found = typed(
        OFFERED,
        snippets.into_iter().find(|it| it.contains("autotrigger")),
    );
    for ([text, keys, line], found) in OFFERED.iter().zip(found["lines"].as_array().unwrap()) {
        assert_eq!(found, line, "{text} {keys}");
    }
    assert_eq!(found["hints"], true);
    let behind = found["behind_lines"].as_str().unwrap();
    assert!(behind.contains("no field `radus`"), "{behind}");
}

/// Runs the script `tests/lsp/neovim_types.lua`, which types the keys of each row into the row's
/// text. `snippet`, if given, is a configuration of Neovim. Returns the JSON that the script
/// writes. It contains the resulting `lines`. With a configuration, it also contains `hints`
/// (whether inlay hints are on) and `behind_lines` (the text that is shown after lines).
fn typed(rows: &[Typed], snippet: Option<&str>) -> Value {
    let rows = rows.iter().map(|[text, keys, _]| {
        let keys: Vec<&str> = keys.split(' ').collect();
        json!({ "text": text, "keys": keys })
    });
    let rows = Value::Array(rows.collect()).to_string();
    let folder = Folder::with([("rows.json", rows.as_str())]);
    let mut neovim = neovim(&folder, &root("tests/lsp/neovim_types.lua"));
    if let Some(snippet) = snippet {
        folder.write("snippet.lua", snippet);
        neovim.env("SNIPPET", folder.path("snippet.lua"));
    }
    let found = answers(&folder, neovim);
    assert_eq!(found["failure"], Value::Null);
    found
}
