//! Tells Zed how to start Pinhole's language server. Zed compiles this crate to WebAssembly when it
//! installs the extension.

use zed_extension_api::{
    register_extension, settings::LspSettings, Command, Extension, LanguageServerId, Result,
    Worktree,
};

struct Pinhole;

impl Extension for Pinhole {
    fn new() -> Self {
        Self
    }

    /// Returns the command that starts the language server. The program's path comes from the
    /// setting `lsp.pinhole.binary.path`. Without this setting, the program is searched on PATH.
    fn language_server_command(
        &mut self,
        id: &LanguageServerId,
        worktree: &Worktree,
    ) -> Result<Command> {
        let binary = LspSettings::for_worktree(id.as_ref(), worktree)
            .ok()
            .and_then(|settings| settings.binary);
        let command = binary
            .and_then(|binary| binary.path)
            .or_else(|| worktree.which("pinhole"))
            .ok_or("pinhole is not on PATH: install it by `cargo install --path .` from Pinhole's folder")?;
        Ok(Command {
            command,
            args: vec!["lsp".to_string()],
            env: worktree.shell_env(),
        })
    }
}

register_extension!(Pinhole);
