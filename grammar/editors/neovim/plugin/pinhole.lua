-- Starts the language server for scenes. To start the server in another way, set
-- vim.g.pinhole_no_lsp before this file is read.
if vim.g.pinhole_no_lsp then
  return
end

if vim.lsp.enable then -- Neovim 0.11 and newer read the configuration in lsp/pinhole.lua.
  vim.lsp.enable("pinhole")
  return
end

-- All scenes share one server.
local client

vim.api.nvim_create_autocmd("FileType", {
  pattern = "pinhole",
  callback = function(event)
    if vim.fn.executable("pinhole") == 0 then
      vim.notify_once("The program pinhole is not on PATH: scenes are highlighted, and no more.", vim.log.levels.WARN)
      return
    end
    client = client
      or vim.lsp.start_client({
        name = "pinhole",
        cmd = { "pinhole", "lsp" },
        root_dir = vim.fn.fnamemodify(event.file, ":p:h"),
        on_exit = function()
          client = nil
        end,
      })
    if client then
      vim.lsp.buf_attach_client(event.buf, client)
      vim.bo[event.buf].omnifunc = "v:lua.vim.lsp.omnifunc" -- Neovim 0.11 sets this itself.
    end
  end,
})
