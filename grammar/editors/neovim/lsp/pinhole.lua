-- Configuration of the language server. Neovim 0.11 and newer find it by the name of this file.
return {
  cmd = { "pinhole", "lsp" },
  filetypes = { "pinhole" },
  root_markers = { ".git" },
}
