//! Shows a picture in the terminal, with messages below it.
//!
//! Each character cell shows two pixels, one above the other: the character is the upper half of a
//! block, drawn in the colour of the upper pixel on a background in the colour of the lower one.
//! This is coarse, but works in every terminal with colours.

use std::{
    env,
    fmt::Write,
    io::{self, IsTerminal},
};

use terminal_size::{Height, Width, terminal_size_of};

use super::{CommandError, command_error, output};
use crate::{area::Area, color::linear_to_srgb, film::Film};

/// The terminal, reached through standard error, in which `watch` shows pictures and messages.
pub struct Screen {
    /// The picture above the messages; `None` if only messages are shown.
    shown: Option<ShownPicture>,
    /// Messages since the scene's last change. When a new picture is drawn, they are printed again
    /// below it.
    messages: String,
}

/// The picture that is shown in the terminal.
#[derive(Default)]
struct ShownPicture {
    film: Option<Film>,
    /// The characters and escape sequences that draw the picture.
    drawn: String,
    /// Number of columns and rows of character cells that were available when the picture was
    /// drawn.
    size: (usize, usize),
}

impl Screen {
    /// Makes a screen that shows only messages.
    pub fn of_words() -> Self {
        Self {
            shown: None,
            messages: String::new(),
        }
    }

    /// Makes a screen that shows pictures and messages. Fails unless standard error is a terminal
    /// with colours.
    pub fn of_pictures() -> Result<Self, CommandError> {
        if !io::stderr().is_terminal() {
            return Err(command_error(
                "`--show` draws in a terminal, and standard error is none",
            ));
        }
        if !output::has_color() {
            return Err(command_error(
                "`--show` draws in colours, and the terminal has none, by `TERM`, `NO_COLOR` or `CLICOLOR`",
            ));
        }
        // The picture is drawn from the top of the screen. The earlier content of the screen is
        // scrolled up first, so that the user can still scroll back to it.
        output::to_people(&format!("{}\x1b[H", "\n".repeat(size().1)));
        Ok(Self {
            shown: Some(ShownPicture::default()),
            messages: String::new(),
        })
    }

    /// Clears the messages and keeps the last picture.
    pub fn begin(&mut self) {
        self.messages.clear();
        self.refresh();
    }

    /// Prints a message below the picture.
    pub fn print(&mut self, text: &str) {
        self.messages.push_str(text);
        output::to_people(text);
    }

    /// Returns how many pixels of the picture `whole`, in each direction, are shown as one dot,
    /// rounded down. A dot is half a character cell. Returns `None` if no pictures are shown.
    pub fn side(&self, whole: Area) -> Option<u32> {
        self.shown.as_ref()?;
        let (columns, rows) = size();
        let scale = scale(whole.width as usize, whole.height as usize, columns, rows);
        Some((scale as u32).max(1))
    }

    /// Shows a picture, with the messages below it; does nothing if no pictures are shown.
    pub fn draw(&mut self, film: Film) {
        if let Some(shown) = &mut self.shown {
            shown.film = Some(film);
            shown.redraw();
            self.refresh();
        }
    }

    /// Redraws the last picture if the terminal's size has changed.
    pub fn fit(&mut self) {
        if let Some(shown) = &mut self.shown
            && shown.film.is_some()
            && shown.size != size()
        {
            shown.redraw();
            // The terminal may have wrapped lines that were drawn for the old width, so the screen
            // is cleared first.
            output::to_people("\x1b[2J");
            self.refresh();
        }
    }

    fn refresh(&self) {
        if let Some(ShownPicture { drawn, .. }) = &self.shown {
            // The picture is drawn over the old one. If the screen were cleared first, the picture
            // would flicker.
            output::to_people(&format!("\x1b[H{drawn}\x1b[J{}", self.messages));
        }
    }
}

impl ShownPicture {
    fn redraw(&mut self) {
        self.size = size();
        if let Some(film) = &self.film {
            self.drawn = drawn(film, self.size, Palette::of_terminal());
        }
    }
}

/// Set of colours that a terminal can show.
#[derive(Clone, Copy)]
enum Palette {
    /// All 24-bit colours.
    Full,
    /// Only 256 colours. The nearest one is used.
    Of256,
}

impl Palette {
    fn of_terminal() -> Self {
        let is_full = |value: String| value == "truecolor" || value == "24bit";
        if env::var("COLORTERM").is_ok_and(is_full) {
            Self::Full
        } else {
            Self::Of256
        }
    }

    /// Appends the escape sequence that sets a colour: that of the foreground if `which` is 38, or
    /// of the background if it is 48.
    fn push(self, text: &mut String, which: u8, [r, g, b]: [u8; 3]) {
        // Writing to a string does not fail, so the result is ignored.
        let _ = match self {
            Self::Full => write!(text, "\x1b[{which};2;{r};{g};{b}m"),
            Self::Of256 => write!(text, "\x1b[{which};5;{}m", nearest_of_256([r, g, b])),
        };
    }
}

/// Returns the number of columns and rows of character cells in which a picture may be drawn.
fn size() -> (usize, usize) {
    let (columns, rows) = terminal_size_of(io::stderr())
        .map_or((80, 24), |(Width(columns), Height(rows))| {
            (usize::from(columns), usize::from(rows))
        });
    (columns.max(1), rows_of_picture(rows))
}

/// Returns how many of the terminal's rows may show the picture. About 12 rows are left for
/// messages, since the report of a problem is about eleven rows long.
fn rows_of_picture(rows: usize) -> usize {
    const MESSAGES: usize = 12;
    let rest = rows.saturating_sub(MESSAGES);
    rest.clamp(rows / 3, rows * 3 / 4).max(1)
}

/// Returns the characters that draw a picture in at most `columns` × `rows` character cells.
fn drawn(film: &Film, (columns, rows): (usize, usize), palette: Palette) -> String {
    let (width, height) = (film.width() as usize, film.height() as usize);
    let scale = scale(width, height, columns, rows);
    let dots =
        |pixels: usize, most: usize| ((pixels as f64 / scale).round() as usize).clamp(1, most);
    let (across, down) = (dots(width, columns), dots(height, 2 * rows));
    let dot = |x: usize, y: usize| {
        let columns = share(x, across, width);
        mean(film, columns, share(y, down, height))
    };
    let mut text = String::new();
    for y in (0..down).step_by(2) {
        for x in 0..across {
            palette.push(&mut text, 38, dot(x, y));
            if y + 1 < down {
                palette.push(&mut text, 48, dot(x, y + 1));
            }
            text.push('▀');
        }
        text.push_str("\x1b[0m\x1b[K\n");
    }
    text
}

/// Returns how many pixels of the picture, in each direction, are shown as one dot. A character
/// cell contains two dots, one above the other, since it is about twice as high as wide.
fn scale(width: usize, height: usize, columns: usize, rows: usize) -> f64 {
    (width as f64 / columns as f64).max(height as f64 / (2 * rows) as f64)
}

/// Divides a range of `pixels` pixels into `parts` parts of about equal size, and returns the part
/// with the index `index`. The part contains at least one pixel.
fn share(index: usize, parts: usize, pixels: usize) -> std::ops::Range<usize> {
    let start = (index * pixels / parts).min(pixels - 1);
    let end = ((index + 1) * pixels / parts).max(start + 1);
    start..end.min(pixels)
}

/// Returns the mean of the pixels in the given columns and rows, as bytes of sRGB. It is computed
/// in linear light.
fn mean(film: &Film, columns: std::ops::Range<usize>, rows: std::ops::Range<usize>) -> [u8; 3] {
    let count = (columns.len() * rows.len()) as f64;
    let mut sum = [0.0; 3];
    for y in rows {
        for pixel in &film.row(y as u32)[columns.clone()] {
            for (sum, channel) in sum.iter_mut().zip(pixel) {
                *sum += channel;
            }
        }
    }
    sum.map(|sum| (linear_to_srgb(sum / count) * 255.0).round() as u8)
}

/// Returns the number of the terminal's colour nearest to `color`, among the colours 16 to 255.
/// These are a cube with six levels of red, green and blue, and 24 grays.
fn nearest_of_256(color: [u8; 3]) -> u8 {
    const LEVELS: [u8; 6] = [0, 95, 135, 175, 215, 255];
    let distance = |other: [u8; 3]| -> u32 {
        let squares = color
            .iter()
            .zip(other)
            .map(|(a, b)| u32::from(a.abs_diff(b)).pow(2));
        squares.sum()
    };
    let nearest = color.map(|channel| {
        let levels = (0u8..6).min_by_key(|&index| LEVELS[usize::from(index)].abs_diff(channel));
        levels.unwrap_or_default()
    });
    let [r, g, b] = nearest;
    let of_cube = (
        distance(nearest.map(|index| LEVELS[usize::from(index)])),
        16 + 36 * r + 6 * g + b,
    );
    let greys = (0u8..24).map(|index| (distance([8 + 10 * index; 3]), 232 + index));
    greys.fold(of_cube, |best, grey| best.min(grey)).1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_fits_and_keeps_its_proportions() {
        let film = |width, height| Film::from_fn(width, height, |_, _| [0.5; 3]).unwrap();
        for (width, height, columns, rows, across, lines) in [
            (1280, 720, 80, 24, 80, 23),
            (1280, 720, 200, 20, 71, 20),
            (100, 100, 80, 24, 48, 24),
            (1, 1, 10, 10, 10, 5),
            (1000, 1, 10, 10, 10, 1),
            (1, 1000, 10, 10, 1, 10),
        ] {
            let text = drawn(&film(width, height), (columns, rows), Palette::Full);
            assert_eq!(text.lines().count(), lines, "{width} × {height}");
            for line in text.lines() {
                assert_eq!(line.matches('▀').count(), across, "{width} × {height}");
            }
        }
    }

    #[test]
    fn a_picture_leaves_room_for_a_report() {
        for (rows, of_picture) in [(1, 1), (10, 3), (24, 12), (40, 28), (60, 45), (100, 75)] {
            assert_eq!(rows_of_picture(rows), of_picture, "{rows}");
        }
    }

    #[test]
    fn a_dot_is_the_mean_of_its_pixels_in_linear_light() {
        let film = Film::from_fn(4, 4, |x, y| match (x + y) % 2 {
            0 => [1.0, 0.0, 1.0],
            _ => [0.0; 3],
        });
        let text = drawn(&film.unwrap(), (2, 1), Palette::Full);
        let cell = "\x1b[38;2;188;0;188m\x1b[48;2;188;0;188m▀";
        assert_eq!(text, format!("{cell}{cell}\x1b[0m\x1b[K\n"));
    }

    #[test]
    fn the_nearest_of_256_colours() {
        for (color, nearest) in [
            ([0, 0, 0], 16),
            ([255, 255, 255], 231),
            ([255, 0, 0], 196),
            ([128, 128, 128], 244),
            ([128, 128, 0], 100),
        ] {
            assert_eq!(nearest_of_256(color), nearest, "{color:?}");
        }
    }
}
