//! Draws a picture in the terminal, above the messages about it.
//!
//! Each cell of the terminal shows two pixels, one above the other: a half block in the colour of
//! the upper pixel on a background of the lower pixel's colour. This is coarse, but every terminal
//! with colours can show it.

use std::{
    env,
    fmt::Write,
    io::{self, IsTerminal},
};

use terminal_size::{Height, Width, terminal_size_of};

use super::{Trouble, output};
use crate::{area::Area, color::linear_to_srgb, film::Film};

/// The screen that `watch` writes to, on standard error.
pub struct Screen {
    /// The picture above the messages; `None` if no pictures are shown.
    shown: Option<ShownPicture>,
    /// Messages since the last change of the scene. They are printed again below a new picture.
    messages: String,
}

/// The picture that is on the screen.
#[derive(Default)]
struct ShownPicture {
    film: Option<Film>,
    /// The characters that draw the picture.
    drawn: String,
    /// The number of columns and rows of cells for which the picture was drawn.
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
    pub fn of_pictures() -> Result<Self, Trouble> {
        if !io::stderr().is_terminal() {
            return Err(Trouble(
                "`--show` draws in a terminal, and standard error is none".to_owned(),
            ));
        }
        if !output::has_color() {
            return Err(Trouble(
                "`--show` draws in colours, and the terminal has none, by `TERM`, `NO_COLOR` or `CLICOLOR`".to_owned(),
            ));
        }
        // The picture is drawn from the top of the screen. The previous content is scrolled up
        // first, where people can find it again.
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

    /// Returns the side, in pixels, of the square of pixels that one dot of the screen shows of the
    /// picture `whole`. Returns `None` if no pictures are shown.
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
            // Lines that were drawn for the old width may have left characters behind, so the
            // screen is cleared.
            output::to_people("\x1b[2J");
            self.refresh();
        }
    }

    fn refresh(&self) {
        if let Some(ShownPicture { drawn, .. }) = &self.shown {
            // The screen is not cleared first, since drawing over it does not flicker.
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

/// Colours that a terminal can show.
#[derive(Clone, Copy)]
enum Palette {
    /// All 24-bit colours, which are used as they are.
    Full,
    /// Only 256 colours, of which the nearest one is used.
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

    /// Appends the escape sequence that sets the foreground (`which` = 38) or background (48)
    /// colour.
    fn push(self, text: &mut String, which: u8, [r, g, b]: [u8; 3]) {
        // Writing to a string does not fail.
        let _ = match self {
            Self::Full => write!(text, "\x1b[{which};2;{r};{g};{b}m"),
            Self::Of256 => write!(text, "\x1b[{which};5;{}m", nearest_of_256([r, g, b])),
        };
    }
}

/// Returns the number of columns and rows of cells that a picture may take in the terminal.
fn size() -> (usize, usize) {
    let (columns, rows) = terminal_size_of(io::stderr())
        .map_or((80, 24), |(Width(columns), Height(rows))| {
            (usize::from(columns), usize::from(rows))
        });
    (columns.max(1), rows_of_picture(rows))
}

/// Returns the number of rows that the picture may take, of `rows` rows of the terminal. A report
/// on one mistake takes about eleven rows, and must be readable below the picture.
fn rows_of_picture(rows: usize) -> usize {
    const MESSAGES: usize = 12;
    let rest = rows.saturating_sub(MESSAGES);
    rest.clamp(rows / 3, rows * 3 / 4).max(1)
}

/// Returns the characters that draw a picture in at most `columns` × `rows` cells.
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

/// Returns the number of pixels, in each direction, that a dot shows. A cell is two dots high, and
/// dots are about square.
fn scale(width: usize, height: usize, columns: usize, rows: usize) -> f64 {
    (width as f64 / columns as f64).max(height as f64 / (2 * rows) as f64)
}

/// Returns the range of pixels of part `index`, if `pixels` pixels are divided into `parts` equal
/// parts. The range is never empty.
fn share(index: usize, parts: usize, pixels: usize) -> std::ops::Range<usize> {
    let start = (index * pixels / parts).min(pixels - 1);
    let end = ((index + 1) * pixels / parts).max(start + 1);
    start..end.min(pixels)
}

/// Returns the mean, in linear light, of the pixels in the given columns and rows, as bytes of
/// sRGB.
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

/// Returns the number of the nearest of a terminal's colours 16 to 255, which are a cube of six
/// levels per channel and 24 greys.
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
