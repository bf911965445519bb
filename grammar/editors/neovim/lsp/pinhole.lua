-- The configuration of the language server, which Neovim 0.11 and newer find by its name.
return {
  cmd = { "pinhole", "lsp" },
  filetypes = { "pinhole" },
  root_markers = { ".git" },
}
