//! A real editor talks to the server: Neovim without its window, which has to be there: `cargo test -- --ignored neovim`, with `nvim` on
//! the path.

use std::process::Command;

use serde_json::{Value, json};

use crate::program::Folder;

/// What Neovim does: it opens the scene, waits for the server, asks, edits, and writes down what came of it.
const SCRIPT: &str = r#"
local found = {}
local wrong = {}
local function run()
vim.lsp.set_log_level("error")
local binary = vim.env.PINHOLE
vim.opt.swapfile = false
vim.cmd("edit scene.scn")
local buffer = vim.api.nvim_get_current_buf()
local id = vim.lsp.start_client({ name = "pinhole", cmd = { binary, "lsp" } })
vim.lsp.buf_attach_client(buffer, id)
local client = vim.lsp.get_client_by_id(id)
vim.wait(10000, function() return client.initialized end, 10)

local function diagnostics(count)
  vim.wait(10000, function() return #vim.diagnostic.get(buffer) == count end, 10)
  local list = {}
  for _, d in ipairs(vim.diagnostic.get(buffer)) do
    table.insert(list, { line = d.lnum, column = d.col, stop = d.end_col, message = d.message, code = d.code or d.user_data.lsp.code })
  end
  table.sort(list, function(a, b) return a.line < b.line end)
  return list
end

local function ask(method, params)
  local answer = vim.lsp.buf_request_sync(buffer, method, params or vim.lsp.util.make_position_params(), 10000)
  local own = (answer or {})[id]
  if own == nil or own.error ~= nil then table.insert(wrong, { method = method, answer = own or vim.NIL }) end
  return own and own.result or vim.NIL
end

local function lines() return vim.api.nvim_buf_get_lines(buffer, 0, -1, false) end

found.broken = diagnostics(1)
-- Type the missing letter; the change goes to the server as it does when somebody types.
vim.api.nvim_win_set_cursor(0, { 4, 0 })
vim.cmd("normal! fdai")
found.mended = diagnostics(0)
found.text = lines()[4]

vim.api.nvim_win_set_cursor(0, { 4, 21 })
found.hover = ask("textDocument/hover").contents
found.definition = ask("textDocument/definition")
local completions = vim.lsp.util.text_document_completion_list_to_complete_items(ask("textDocument/completion"), "")
found.completion = vim.tbl_map(function(item) return item.word end, completions)
local symbols = ask("textDocument/documentSymbol", { textDocument = vim.lsp.util.make_text_document_params() })
found.symbols = vim.tbl_map(function(item) return item.text end, vim.lsp.util.symbols_to_items(symbols, buffer))
found.highlights = #ask("textDocument/documentHighlight")
local edit = ask("textDocument/rename", vim.tbl_extend("force", vim.lsp.util.make_position_params(), { newName = "middle" }))
vim.lsp.util.apply_workspace_edit(edit, client.offset_encoding)
found.renamed = lines()

-- Many changes at once, in a text with characters of every width; then a mistake, whose place shows that both still have the
-- same text.
for _ = 1, 10 do
  vim.cmd("silent 2move 4")
  vim.cmd("silent 4move 1")
  vim.cmd("silent %s/middle/é🎱/g")
  vim.cmd("silent %s/é🎱/middle/g")
  vim.cmd("silent 1,2join")
  vim.cmd("silent 1s/ let/\\rlet/")
end
vim.cmd("silent %s/0.5 }/0.5  colour olive }/")
found.after = diagnostics(1)
found.last = lines()
vim.lsp.stop_client(id)
vim.wait(10000, function() return client.is_stopped() end, 10)
found.stopped = client.is_stopped()
end

-- Whatever fails is said in the answers; an editor without a window must not wait for a key.
vim.opt.more = false
local fine, failure = pcall(run)
found.failure = not fine and tostring(failure) or nil
found.wrong = wrong
local answers = vim.env.ANSWERS
local file = io.open(answers, "w")
file:write(vim.json.encode(found))
file:close()
vim.cmd("qall!")
"#;

const SCENE: &str = "// 🎱 é: a ball
let ball = (0, 1, 0)
camera { eye (0, 1, 5)  lookat ball  d 1 }
sphere Ball { center ball  /* 🎱 */ radus 0.5 }
";

#[test]
#[ignore = "needs Neovim"]
fn neovim_writes_a_scene() {
    let folder = Folder::with([("scene.scn", SCENE), ("script.lua", SCRIPT)]);
    let home = folder.path("");
    let mut neovim = Command::new("nvim");
    neovim
        .args(["--headless", "--clean", "-c", "luafile script.lua"])
        .current_dir(&home)
        .env("PINHOLE", env!("CARGO_BIN_EXE_pinhole"))
        .env("ANSWERS", folder.path("answers.json"));
    for name in ["HOME", "XDG_STATE_HOME", "XDG_CACHE_HOME"] {
        neovim.env(name, &home);
    }
    let output = neovim.output().expect("Neovim is on the path");
    assert!(folder.path("answers.json").exists(), "{output:?}");
    let found: Value = serde_json::from_slice(&folder.read("answers.json")).unwrap();
    let message = "a sphere has no field `radus`\nhelp: did you mean `radius`? A sphere takes center, radius and color.";
    let renamed = [
        "// 🎱 é: a ball",
        "let middle = (0, 1, 0)",
        "camera { eye (0, 1, 5)  lookat middle  d 1 }",
        "sphere Ball { center middle  /* 🎱 */ radius 0.5 }",
    ];
    for (path, expected) in [
        ("/wrong", json!([])),
        (
            "/broken",
            json!([{ "line": 3, "column": 38, "stop": 43, "code": "unknown_field", "message": message }]),
        ),
        ("/mended", json!([])),
        (
            "/text",
            json!("sphere Ball { center ball  /* 🎱 */ radius 0.5 }"),
        ),
        (
            "/hover/value",
            json!("`let ball = (0, 1, 0)` (line 2)\n\na vector: `(0, 1, 0)`"),
        ),
        (
            "/definition/range/start",
            json!({ "line": 1, "character": 4 }),
        ),
        ("/completion/1", json!("ball")),
        ("/symbols/5", json!("[Object] Ball")),
        ("/highlights", json!(3)),
        ("/renamed", json!(renamed)),
        (
            "/last/3",
            json!("sphere Ball { center middle  /* 🎱 */ radius 0.5  colour olive }"),
        ),
        ("/after/0/code", json!("unknown_field")),
        ("/after/0/line", json!(3)),
        ("/after/0/column", json!(52)),
        ("/stopped", json!(true)),
    ] {
        assert_eq!(found.pointer(path), Some(&expected), "{path}: {found:#}");
    }
    assert_eq!(found.get("failure"), None);
}
