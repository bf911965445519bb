-- The language server, as Neovim 0.11 and newer find it by its name.
return {
  cmd = { "pinhole", "lsp" },
  filetypes = { "pinhole" },
  root_markers = { ".git" },
}
