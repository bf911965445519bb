// Tests the files for other editors. Neovim is run with its files; the other files are parsed.

import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, symlinkSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import path from "node:path";
import { test } from "node:test";
import { program } from "./server.mjs";

const editors = new URL("../../", import.meta.url).pathname;
const { parse } = createRequire(import.meta.url)("smol-toml");
const toml = file => parse(readFileSync(editors + file, "utf8"));

test("Helix's and Zed's files say how to start the server for scenes", () => {
  const helix = toml("helix/languages.toml");
  assert.deepEqual({ ...helix["language-server"].pinhole }, { command: "pinhole", args: ["lsp"] });
  const [language] = helix.language;
  assert.deepEqual([language.name, language["file-types"], language["language-servers"]], ["pinhole", ["scn"], ["pinhole"]]);

  const extension = toml("zed/extension.toml");
  const zed = toml("zed/languages/pinhole/config.toml");
  assert.deepEqual(extension.language_servers.pinhole.languages, [zed.name]);
  assert.deepEqual(zed.path_suffixes, ["scn"]);
  assert.ok(zed.name in JSON.parse(readFileSync(`${editors}zed/settings.json`, "utf8")).languages);
  assert.equal(toml("zed/Cargo.toml").package.version, extension.version);
});

const neovim = process.env.NVIM ?? "nvim";
const skip = spawnSync(neovim, ["--version"]).status === 0 ? false : "Neovim is not installed";

/**
 * Returns what a script prints in a headless Neovim that has opened `source`, with the plugin and
 * the program.
 */
function inNeovim(source, script) {
  const folder = mkdtempSync(path.join(tmpdir(), "pinhole-neovim-"));
  try {
    symlinkSync(path.resolve(program), path.join(folder, "pinhole"));
    writeFileSync(path.join(folder, "a.scn"), source);
    writeFileSync(path.join(folder, "script.lua"), script);
    const started = ["--headless", "-u", "NONE", "-i", "NONE", "--cmd", `set noswapfile runtimepath^=${editors}neovim`];
    return execFileSync(
      neovim,
      [...started, "--cmd", "runtime plugin/pinhole.lua | filetype plugin on | syntax on", "a.scn", "-c", "luafile script.lua", "-c", "qa!"],
      { cwd: folder, encoding: "utf8", timeout: 30_000, env: { ...process.env, PATH: `${folder}:${process.env.PATH}`, XDG_STATE_HOME: folder } },
    );
  } finally {
    rmSync(folder, { recursive: true });
  }
}

test("Neovim highlights scenes without the server", { skip }, () => {
  const source = "let a = 2 * -b\nsphere Ball {\n  radius radius - 1 color sun // c\n  center (0, min(1, a), 2) }\ncamera { method sobol eye (1.5, -.5, 1e3) roll 30deg }";
  const script = `
    local words, last = {}, nil
    for line = 1, vim.fn.line("$") do
      local text = vim.fn.getline(line)
      for first, word, after in text:gmatch("()([%w_.]+)()") do
        table.insert(words, word .. " " .. vim.fn.synIDattr(vim.fn.synID(line, first, 1), "name"):gsub("pinhole", ""))
      end
    end
    io.stdout:write(table.concat(words, "\\n"))`;
  assert.deepEqual(inNeovim(source, script).split("\n"), [
    "let Keyword", "a Defined", "2 Number", "b Name",
    "sphere Kind", "Ball Object", "radius Field", "radius Name", "1 Number", "color Field", "sun Name", "c Comment",
    "center Field", "0 Number", "min Call", "1 Number", "a Name", "2 Number",
    "camera Kind", "method MethodField", "sobol Method", "eye Field", "1.5 Number", ".5 Number", "1e3 Number", "roll Field", "30deg Number",
  ]);
});

test("Neovim shows diagnostics, meanings and completions", { skip }, () => {
  const source = "camera { eye (0, 1, 5)  lookat (0, 1, 0)  roll 30 }\nsphere { center (0, 1, 0)   }\n";
  const script = `
    local function clients() return (vim.lsp.get_clients or vim.lsp.get_active_clients)() end
    assert(vim.wait(10000, function() return #vim.diagnostic.get(0) > 0 end, 20), "no diagnostics")
    assert(#clients() == 1, "one server")
    local function ask(method, line, character)
      local params = { textDocument = vim.lsp.util.make_text_document_params(0), position = { line = line, character = character } }
      local answers = assert(vim.lsp.buf_request_sync(0, method, params, 10000))
      for _, answer in pairs(answers) do return answer.result end
    end
    local hover = ask("textDocument/hover", 1, 10)
    local completion = ask("textDocument/completion", 1, 27)
    local labels = {}
    for _, item in ipairs(completion.items or completion) do labels[item.label] = true end
    io.stdout:write(vim.fn.json_encode({
      filetype = vim.bo.filetype,
      commentstring = vim.bo.commentstring,
      line = vim.diagnostic.get(0)[1].lnum,
      message = vim.diagnostic.get(0)[1].message,
      hover = hover.contents.value,
      radius = labels.radius or false,
      center = labels.center or false,
    }))`;
  const said = JSON.parse(inNeovim(source, script));
  assert.deepEqual([said.filetype, said.commentstring, said.line, said.radius, said.center], ["pinhole", "// %s", 0, true, false]);
  assert.match(said.message, /`roll` is an angle/);
  assert.match(said.hover, /center/);
});
