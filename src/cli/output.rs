//! Standard output for programs, standard error for people.

use std::{
    borrow::Cow,
    env, fmt,
    io::{self, BufWriter, ErrorKind, IsTerminal, StdoutLock, Write},
};

use terminal_size::{Width, terminal_size_of};

use super::Trouble;
use crate::diagnostic::{Drawing, Style, visible, visible_line};

/// Writes a text to standard output: to programs as it is, and to a terminal so that nothing of it,
/// such as what a scene holds, can act there.
pub fn to_programs(text: &[u8]) -> Result<(), Trouble> {
    match io::stdout().is_terminal() {
        true => page(&visible(&String::from_utf8_lossy(text))),
        false => write(text),
    }
}

/// Writes what may be long as it is made, in the manner of [`to_programs`].
pub fn stream_to_programs(
    write_to: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), Trouble> {
    if io::stdout().is_terminal() {
        let mut text = Vec::new();
        return write_to(&mut text)
            .map_err(unwritten)
            .and_then(|()| to_programs(&text));
    }
    let mut out = BufWriter::with_capacity(1 << 16, Programs::new());
    write_to(&mut out)
        .and_then(|()| out.flush())
        .map_err(unwritten)
}

/// Writes a page of our own, drawn in the style of the terminal, to standard output.
pub fn page(text: &str) -> Result<(), Trouble> {
    write(text.as_bytes())
}

fn write(bytes: &[u8]) -> Result<(), Trouble> {
    let mut out = Programs::new();
    let written = out.write_all(bytes).and_then(|()| out.flush());
    written.map_err(unwritten)
}

fn unwritten(error: io::Error) -> Trouble {
    Trouble(format!("cannot write to standard output: {error}"))
}

/// Standard output. A reader that has gone away, as `head` does, has had enough: that is no
/// trouble, and what is left goes nowhere.
pub struct Programs(StdoutLock<'static>);

impl Programs {
    /// Nobody else writes to it meanwhile.
    pub fn new() -> Self {
        Self(io::stdout().lock())
    }
}

impl Write for Programs {
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

/// Writes to standard error; if nobody reads it, there is nobody to tell.
pub fn to_people(text: &str) {
    let _ = io::stderr().lock().write_all(text.as_bytes());
}

/// Writes what a command was called for to standard error. A reader that has gone away has had
/// enough, as one of standard output.
pub fn answer(text: &str) -> Result<(), Trouble> {
    let columns = terminal_size_of(io::stderr()).filter(|_| is_watched());
    let text = match columns {
        Some((Width(columns), _)) => wrapped(text, columns.into()).into(),
        None => Cow::Borrowed(text),
    };
    match io::stderr().lock().write_all(text.as_bytes()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Trouble(format!("cannot write to standard error: {error}")))
        }
        _ => Ok(()),
    }
}

/// Breaks lines at words where they are longer than `width`, which terminals do within words. A
/// line goes on below its last column, in the left half of the terminal.
pub fn wrapped(text: &str, width: usize) -> String {
    let broken = text.split('\n').map(|line| {
        let words = line.trim_start_matches(' ');
        let (start, _) = line.split_at(line.len() - words.len());
        let indent = " ".repeat(last_column(line, width / 2));
        let options = textwrap::Options::new(width).break_words(false);
        let options = options.initial_indent(start).subsequent_indent(&indent);
        match line.chars().count() > width {
            true => textwrap::fill(words, options).into(),
            false => Cow::Borrowed(line),
        }
    });
    broken.collect::<Vec<_>>().join("\n")
}

/// Where the last column starts that does so no farther right than `most`: behind two spaces.
fn last_column(line: &str, most: usize) -> usize {
    let letters: Vec<char> = line.chars().take(most + 1).collect();
    let starts = letters.windows(3).enumerate();
    let mut starts = starts.filter(|(_, at)| at[..2] == [' ', ' '] && at[2] != ' ');
    starts.next_back().map_or(most.min(2), |(at, _)| at + 2)
}

/// Says what kept a command from its work.
pub fn error(message: &dyn fmt::Display) {
    to_people(&worded_error(message));
}

/// What says why the command was not carried out.
pub fn worded_error(message: &dyn fmt::Display) -> String {
    worded("error", "1;31", message)
}

/// Says what the user might not expect.
pub fn warning(message: &dyn fmt::Display) {
    to_people(&worded_warning(message));
}

/// What says something that the user might not expect.
pub fn worded_warning(message: &dyn fmt::Display) -> String {
    worded("warning", "1;33", message)
}

fn worded(word: &str, color: &str, message: &dyn fmt::Display) -> String {
    let message = message.to_string();
    let message = visible_line(&message);
    match style().color {
        true => format!("\x1b[{color}m{word}:\x1b[0m {message}\n"),
        false => format!("{word}: {message}\n"),
    }
}

/// Whether somebody watches.
pub fn is_watched() -> bool {
    io::stderr().is_terminal()
}

/// How reports are drawn on standard error: in colour on a terminal that has it, unless `NO_COLOR`
/// is set; in ASCII where the locale is not one of UTF-8; in sentences if `NO_GRAPHICS` is set, for
/// screen readers.
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

/// Columns to the left of an excerpt: the number of the line, and the frame.
const FRAME: usize = 8;

/// How a page is drawn on standard output, if that is a terminal.
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

/// Whether a terminal may be written to in colour: <https://no-color.org> and
/// <https://bixense.com/clicolors>. The terminals of DEC, such as the VT100, have none.
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

/// As no-color.org says: present and not empty.
fn is_set(name: &str) -> bool {
    env::var_os(name).is_some_and(|value| !value.is_empty())
}

/// Of the variables for the locale the first that says something counts; where none does, terminals
/// of today know Unicode.
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
