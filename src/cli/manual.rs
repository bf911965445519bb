//! `completions` and `man`: print a shell's completion script and the manual page. Both are
//! generated from the definitions of the arguments.

use std::io::{self, Write};

use clap::{Command, CommandFactory};
use clap_complete::Shell;
use clap_mangen::Man;

use super::{CommandError, Status, args::Args, command_error, output};

/// Prints the completion script for a shell.
pub fn completions(shell: Shell) -> Result<Status, CommandError> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Args::command(), "pinhole", &mut script);
    output::to_programs(&script)?;
    Ok(Status::Done)
}

/// Prints the manual page of `pinhole`, with a section for each command.
pub fn man() -> Result<Status, CommandError> {
    let mut page = Vec::new();
    write(&mut page).map_err(|error| command_error(format!("cannot write the manual: {error}")))?;
    output::to_programs(&page)?;
    Ok(Status::Done)
}

fn write(page: &mut Vec<u8>) -> io::Result<()> {
    let mut command = Args::command();
    command.build();
    let whole = Man::new(command.clone());
    whole.render_title(page)?;
    whole.render_name_section(page)?;
    whole.render_synopsis_section(page)?;
    whole.render_description_section(page)?;
    for command in command.get_subcommands() {
        if command.get_name() != "help" {
            write_command(page, command)?;
        }
    }
    page.write_all(examples(&whole)?.as_bytes())?;
    whole.render_version_section(page)
}

/// Writes the section about one command. clap makes a manual page for the command. The sections of
/// that page become subsections.
fn write_command(page: &mut Vec<u8>, command: &Command) -> io::Result<()> {
    let own = Man::new(command.clone());
    let mut parts = Vec::new();
    own.render_synopsis_section(&mut parts)?;
    own.render_description_section(&mut parts)?;
    own.render_options_section(&mut parts)?;
    let parts = format!("{}{}", String::from_utf8_lossy(&parts), examples(&own)?);
    let parts: String = parts
        .lines()
        .map(|line| match line.strip_prefix(".SH ") {
            Some(title) => format!(".SS {title}\n"),
            None => format!("{line}\n"),
        })
        .collect();
    let name = command.get_name().to_uppercase();
    write!(page, ".SH \"PINHOLE {name}\"\n{parts}")
}

/// Returns the text that `--help` shows after the options, mostly examples. Its line breaks are
/// kept.
fn examples(man: &Man) -> io::Result<String> {
    let mut extra = Vec::new();
    man.render_extra_section(&mut extra)?;
    let extra = String::from_utf8_lossy(&extra);
    let extra = extra.replace(".SH EXTRA\nExamples:\n", ".SH EXAMPLES\n.nf\n");
    Ok(format!("{}\n.fi\n", extra.trim_end()))
}
