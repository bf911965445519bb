//! Writes results for programs to standard output, and texts for people to standard error.

use std::{
    borrow::Cow,
    env, fmt,
    io::{self, BufWriter, ErrorKind, IsTerminal, StdoutLock, Write},
};

use terminal_size::{Width, terminal_size_of};

use super::{CommandError, command_error};
use crate::diagnostic::{Drawing, Style, visible, visible_line};

/// Writes a text to standard output. On a terminal, control characters are made visible, so that a
/// text from a scene cannot control the terminal.
pub fn to_programs(text: &[u8]) -> Result<(), CommandError> {
    if io::stdout().is_terminal() {
        page(&visible(&String::from_utf8_lossy(text)))
    } else {
        write(text)
    }
}

/// Writes a text to standard output while it is produced, so that a long text need not be in
/// memory. On a terminal, control characters are made visible.
pub fn stream_to_programs(
    write_to: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), CommandError> {
    if io::stdout().is_terminal() {
        let mut text = Vec::new();
        return write_to(&mut text)
            .map_err(stdout_error)
            .and_then(|()| to_programs(&text));
    }
    let mut out = BufWriter::with_capacity(1 << 16, StandardOutput::new());
    write_to(&mut out)
        .and_then(|()| out.flush())
        .map_err(stdout_error)
}

/// Writes a text to standard output. The text must already be formatted for a terminal and contain
/// no control characters from a scene.
pub fn page(text: &str) -> Result<(), CommandError> {
    write(text.as_bytes())
}

fn write(bytes: &[u8]) -> Result<(), CommandError> {
    let mut out = StandardOutput::new();
    let written = out.write_all(bytes).and_then(|()| out.flush());
    written.map_err(stdout_error)
}

fn stdout_error(error: io::Error) -> CommandError {
    command_error(format!("cannot write to standard output: {error}"))
}

/// Standard output. If the reading program has closed the pipe, as `head` does, further output is
/// dropped without an error.
pub struct StandardOutput(StdoutLock<'static>);

impl StandardOutput {
    /// Locks standard output.
    pub fn new() -> Self {
        Self(io::stdout().lock())
    }
}

impl Write for StandardOutput {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self.0.write(bytes) {
            Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(bytes.len()),
            written => written,
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self.0.flush() {
            Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
            flushed => flushed,
        }
    }
}

/// Writes a text to standard error. Errors are ignored, since there is nowhere to report them.
pub fn to_people(text: &str) {
    let _ = io::stderr().lock().write_all(text.as_bytes());
}

/// Writes a command's result to standard error, wrapped to the width of the terminal. If the
/// reading program has closed the pipe, the rest is dropped without an error.
pub fn answer(text: &str) -> Result<(), CommandError> {
    let columns = terminal_size_of(io::stderr()).filter(|_| is_watched());
    let text = match columns {
        Some((Width(columns), _)) => wrapped(text, columns.into()).into(),
        None => Cow::Borrowed(text),
    };
    match io::stderr().lock().write_all(text.as_bytes()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(command_error(format!(
            "cannot write to standard error: {error}"
        ))),
        _ => Ok(()),
    }
}

/// Wraps lines longer than `width` columns between words. If a line seems to be the row of a table,
/// its continuation lines are indented to the row's last column. Columns that start in the right
/// half of the width are ignored, so that each line has room for words.
pub fn wrapped(text: &str, width: usize) -> String {
    let broken = text.split('\n').map(|line| {
        let words = line.trim_start_matches(' ');
        let (start, _) = line.split_at(line.len() - words.len());
        let indent = " ".repeat(last_column(line, width / 2));
        let options = textwrap::Options::new(width).break_words(false);
        let options = options.initial_indent(start).subsequent_indent(&indent);
        if line.chars().count() > width {
            textwrap::fill(words, options).into()
        } else {
            Cow::Borrowed(line)
        }
    });
    broken.collect::<Vec<_>>().join("\n")
}

/// Returns where the last column of a table's row starts, as a number of characters. Only columns
/// that start at `most` or before it are considered. Columns are separated by at least two spaces.
/// Without such a column, returns an ordinary indentation of 2, or `most` if `most` is less.
fn last_column(line: &str, most: usize) -> usize {
    let letters: Vec<char> = line.chars().take(most + 1).collect();
    let starts = letters.windows(3).enumerate();
    let mut starts = starts.filter(|(_, at)| at[..2] == [' ', ' '] && at[2] != ' ');
    starts.next_back().map_or(most.min(2), |(at, _)| at + 2)
}

/// Prints an error that ended a command.
pub fn error(message: &dyn fmt::Display) {
    to_people(&worded_error(message));
}

/// Formats an error that ended a command.
pub fn worded_error(message: &dyn fmt::Display) -> String {
    worded("error", "1;31", message)
}

/// Prints a warning.
pub fn warning(message: &dyn fmt::Display) {
    to_people(&worded_warning(message));
}

/// Formats a warning.
pub fn worded_warning(message: &dyn fmt::Display) -> String {
    worded("warning", "1;33", message)
}

fn worded(word: &str, color: &str, message: &dyn fmt::Display) -> String {
    let message = message.to_string();
    let message = visible_line(&message);
    if style().color {
        format!("\x1b[{color}m{word}:\x1b[0m {message}\n")
    } else {
        format!("{word}: {message}\n")
    }
}

/// Returns whether standard error is a terminal.
pub fn is_watched() -> bool {
    io::stderr().is_terminal()
}

/// Returns the style of reports on standard error. Colours are used if it is a terminal with
/// colours and `NO_COLOR` is not set. Box-drawing characters are used if the locale is UTF-8. If
/// `NO_GRAPHICS` is set, reports are sentences, for screen readers.
pub fn style() -> Style {
    let plain = Style::default();
    let columns = terminal_size_of(io::stderr()).map(|(Width(columns), _)| usize::from(columns));
    Style {
        drawing: if is_set("NO_GRAPHICS") {
            Drawing::Narrated
        } else if is_unicode() {
            Drawing::Unicode
        } else {
            Drawing::Ascii
        },
        color: is_watched() && has_color(),
        width: columns.unwrap_or(plain.width),
        excerpt: columns.map(|columns| columns.saturating_sub(FRAME)),
    }
}

/// Number of terminal columns that a report needs, to the left of the scene's text, for line
/// numbers and a frame. The scene's text gets the remaining columns. With a smaller number, the
/// terminal would wrap long lines.
const FRAME: usize = 8;

/// Returns the style for texts on standard output, or `None` if it is not a terminal.
pub fn page_style() -> Option<Style> {
    let out = io::stdout();
    out.is_terminal().then(|| {
        let plain = Style::default();
        Style {
            color: has_color(),
            width: terminal_size_of(out).map_or(plain.width, |(Width(columns), _)| columns.into()),
            ..plain
        }
    })
}

/// Returns whether colours may be written to a terminal, according to <https://no-color.org> and
/// <https://bixense.com/clicolors>. Returns `false`, too, for `vt100` and other terminals by DEC,
/// which have no colours.
pub fn has_color() -> bool {
    let is = |name, value| env::var_os(name).is_some_and(|found| found == value);
    let is_of_dec = |name: &str| match name.strip_prefix("vt") {
        Some(model) => model.starts_with(|c: char| c.is_ascii_digit()),
        None => false,
    };
    let terminal = env::var("TERM").unwrap_or_default();
    let is_plain = terminal == "dumb" || is_of_dec(&terminal);
    !is_plain && !is("CLICOLOR", "0") && !is_set("NO_COLOR")
}

/// Returns whether an environment variable is set and not empty.
fn is_set(name: &str) -> bool {
    env::var_os(name).is_some_and(|value| !value.is_empty())
}

/// Returns whether the locale is UTF-8. The first locale variable that is not empty decides. If all
/// are empty, the terminal is assumed to show Unicode.
fn is_unicode() -> bool {
    ["LC_ALL", "LC_CTYPE", "LANG"]
        .iter()
        .find_map(|name| env::var(name).ok().filter(|value| !value.is_empty()))
        .is_none_or(|locale| {
            let locale = locale.to_ascii_uppercase();
            locale.contains("UTF-8") || locale.contains("UTF8")
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_break_at_words_and_hang() {
        for (text, broken) in [
            ("one two three\n", "one two three\n"),
            (
                "one two three four\nfive\n",
                "one two three\n  four\nfive\n",
            ),
            ("a    big sphere", "a    big\n     sphere"),
            (
                "  0   sphere Ball behind",
                "  0   sphere\n      Ball\n      behind",
            ),
            ("unbreakable_word_of_many\n", "unbreakable_word_of_many\n"),
            (
                "  unbreakable_word_of_many x",
                "  unbreakable_word_of_many\n  x",
            ),
            ("été été été été", "été été été\n  été"),
            ("\n\na\n", "\n\na\n"),
        ] {
            assert_eq!(wrapped(text, 13), broken, "{text}");
        }
        for width in 1..20 {
            let text = "  0   box  Crate   from (1, 2, 3)\n";
            let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
            assert_eq!(words(&wrapped(text, width)), words(text), "{width}");
        }
    }
}
