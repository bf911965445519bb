-- Types keys into a second Neovim one after another, as a person does, and records the resulting
-- line of each row. A row of `rows.json` is a text, with `$0` for the cursor, and its keys; the key
-- `menu` waits until completions are shown.

local found = { lines = {} }

local function run()
  local inner = vim.fn.jobstart({
    vim.v.progpath, "--embed", "--headless", "--clean",
    "--cmd", "set noswapfile nomore runtimepath^=" .. vim.env.PLUGIN,
    "-c", vim.env.SNIPPET and "luafile " .. vim.env.SNIPPET or "echo",
  }, { rpc = true })
  local function lua(code, ...) return vim.rpcrequest(inner, "nvim_exec_lua", code, { ... }) end
  local function wait(condition)
    local holds = vim.wait(10000, function() return lua("return " .. condition) end, 20)
    if not holds then error("not within ten seconds: " .. condition) end
  end
  local function open(text)
    vim.fn.writefile(vim.split(text, "\n"), "typed.scn")
    vim.rpcrequest(inner, "nvim_command", "edit! typed.scn")
    wait("#vim.lsp.buf_get_clients(0) > 0")
    wait("select(2, next(vim.lsp.buf_get_clients(0))).initialized == true")
  end

  for index, row in ipairs(vim.json.decode(table.concat(vim.fn.readfile("rows.json"), "\n"))) do
    local before, after = row.text:match("^(.-)%$0(.*)$")
    open(before .. after)
    local lines = vim.split(before, "\n")
    lua("vim.api.nvim_win_set_cursor(0, { ... })", #lines, #lines[#lines])
    -- Behind the last character of a line, text is appended.
    vim.rpcrequest(inner, "nvim_input", after:match("^[^\n]") and "i" or "A")
    for _, key in ipairs(row.keys) do
      if key == "menu" then
        wait("vim.fn.pumvisible() == 1")
      else
        vim.rpcrequest(inner, "nvim_input", key)
        vim.wait(30)
      end
    end
    -- The editor inserts an accepted completion in its next step.
    vim.wait(200)
    found.lines[index] = lua("return vim.api.nvim_get_current_line()")
    vim.rpcrequest(inner, "nvim_input", "<Esc><Esc>")
    vim.wait(30)
  end

  open("let r = 1\ncamera { eye (0, 1, 5)  lookat (0, r, 0) }\nsphere { center (0, r, 0)  radus 2 * r }")
  wait("#vim.diagnostic.get(0) == 1")
  if vim.env.SNIPPET then
    wait("#vim.lsp.inlay_hint.get({ bufnr = 0 }) > 0")
    found.hints = lua("return vim.lsp.inlay_hint.is_enabled({ bufnr = 0 })")
    found.behind_lines = lua([[
      local texts = ""
      for _, mark in ipairs(vim.api.nvim_buf_get_extmarks(0, -1, 0, -1, { details = true, type = "virt_text" })) do
        for _, part in ipairs(mark[4].virt_text) do texts = texts .. part[1] end
      end
      return texts]])
  end
  vim.fn.jobstop(inner)
end

local fine, failure = pcall(run)
found.failure = not fine and tostring(failure) or nil
vim.fn.writefile({ vim.json.encode(found) }, "answers.json")
vim.cmd("qall!")
