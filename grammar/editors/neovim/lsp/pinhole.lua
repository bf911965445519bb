-- Configuration of the language server. Neovim 0.11 and newer find the file by its name.
return {
  cmd = { "pinhole", "lsp" },
  filetypes = { "pinhole" },
  root_markers = { ".git" },
}
