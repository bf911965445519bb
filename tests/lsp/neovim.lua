-- Script for Neovim: opens the scene, waits for the server, sends requests, edits, and records the
-- results.

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
-- Types the missing letter; the change is sent to the server as in normal typing.
vim.api.nvim_win_set_cursor(0, { 4, 0 })
vim.cmd("normal! fdai")
found.mended = diagnostics(0)
found.text = lines()[4]

vim.api.nvim_win_set_cursor(0, { 4, 21 })
found.hover = ask("textDocument/hover").contents.value
found.definition = ask("textDocument/definition").range
found.completion = ask("textDocument/completion")[2].label
local symbols = ask("textDocument/documentSymbol", { textDocument = vim.lsp.util.make_text_document_params() })
found.symbol = vim.lsp.util.symbols_to_items(symbols, buffer)[6].text
found.highlights = #ask("textDocument/documentHighlight")
local edit = ask("textDocument/rename", vim.tbl_extend("force", vim.lsp.util.make_position_params(), { newName = "middle" }))
vim.lsp.util.apply_workspace_edit(edit, client.offset_encoding)
found.renamed = lines()

-- Many changes at once, in a text with characters of every width; then a mistake, whose position
-- shows that both sides still have the same text.
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

-- Failures are recorded in the answers, as a headless editor must not wait for a key.
vim.opt.more = false
local fine, failure = pcall(run)
found.failure = not fine and tostring(failure) or nil
found.wrong = wrong
local answers = vim.env.ANSWERS
local file = io.open(answers, "w")
file:write(vim.json.encode(found))
file:close()
vim.cmd("qall!")
