//! A picture in the terminal, above what was said of it.
//!
//! Each cell shows two pixels, one above the other: a half block in the colour of the upper one on
//! the colour of the lower one. That is coarse, but every terminal with colours can do it.

use std::{
    env,
    fmt::Write,
    io::{self, IsTerminal},
};

use terminal_size::{Height, Width, terminal_size_of};

use super::{Trouble, output};
use crate::{area::Area, color::linear_to_srgb, film::Film};

/// What people see on standard error.
pub struct Screen {
    /// The picture above what is said, if there is to be one.
    shown: Option<Shown>,
    /// What was said since the last change.
    said: String,
}

/// The last picture.
#[derive(Default)]
struct Shown {
    film: Option<Film>,
    /// It as it is drawn, and the cells that it was drawn for.
    drawn: String,
    size: (usize, usize),
}

impl Screen {
    /// One of words alone.
    pub fn of_words() -> Self {
        Self {
            shown: None,
            said: String::new(),
        }
    }

    /// One of pictures and words, for which it takes a terminal.
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
        // What stands on the screen is scrolled up, where people find it again: what follows is
        // drawn from the top.
        output::to_people(&format!("{}\x1b[H", "\n".repeat(size().1)));
        Ok(Self {
            shown: Some(Shown::default()),
            said: String::new(),
        })
    }

    /// Leaves the last picture alone on the screen.
    pub fn begin(&mut self) {
        self.said.clear();
        self.refresh();
    }

    /// Says something.
    pub fn say(&mut self, text: &str) {
        self.said.push_str(text);
        output::to_people(text);
    }

    /// The side in pixels of blocks about as coarse as the screen is for a picture of this size;
    /// `None` if pictures are not shown.
    pub fn side(&self, whole: Area) -> Option<u32> {
        self.shown.as_ref()?;
        let (columns, rows) = size();
        let scale = scale(whole.width as usize, whole.height as usize, columns, rows);
        Some((scale as u32).max(1))
    }

    /// Shows a picture, and below it what was said.
    pub fn draw(&mut self, film: Film) {
        if let Some(shown) = &mut self.shown {
            shown.film = Some(film);
            shown.redraw();
            self.refresh();
        }
    }

    /// Shows the last picture anew if the terminal has another size than it was drawn for.
    pub fn fit(&mut self) {
        if let Some(shown) = &mut self.shown
            && shown.film.is_some()
            && shown.size != size()
        {
            shown.redraw();
            // What the lines of another width left behind is no part of it.
            output::to_people("\x1b[2J");
            self.refresh();
        }
    }

    fn refresh(&self) {
        if let Some(Shown { drawn, .. }) = &self.shown {
            // The screen is not cleared first: what is drawn over does not flicker.
            output::to_people(&format!("\x1b[H{drawn}\x1b[J{}", self.said));
        }
    }
}

impl Shown {
    fn redraw(&mut self) {
        self.size = size();
        if let Some(film) = &self.film {
            self.drawn = drawn(film, self.size, Palette::of_terminal());
        }
    }
}

/// The colours that a terminal shows.
#[derive(Clone, Copy)]
enum Palette {
    /// All.
    Full,
    /// 256, of which the nearest ones are taken.
    Of256,
}

impl Palette {
    fn of_terminal() -> Self {
        let is_full = |value: String| value == "truecolor" || value == "24bit";
        match env::var("COLORTERM").is_ok_and(is_full) {
            true => Self::Full,
            false => Self::Of256,
        }
    }

    /// Sets the colour of what is written (38) or of what is behind it (48).
    fn push(self, text: &mut String, which: u8, [r, g, b]: [u8; 3]) {
        // Writing to a string does not fail.
        let _ = match self {
            Self::Full => write!(text, "\x1b[{which};2;{r};{g};{b}m"),
            Self::Of256 => write!(text, "\x1b[{which};5;{}m", nearest_of_256([r, g, b])),
        };
    }
}

/// How many columns and rows of cells a picture may take: what is said needs some too.
fn size() -> (usize, usize) {
    let (columns, rows) = terminal_size_of(io::stderr())
        .map_or((80, 24), |(Width(columns), Height(rows))| {
            (usize::from(columns), usize::from(rows))
        });
    (columns.max(1), rows_of_picture(rows))
}

/// A report of one mistake takes eleven rows or so, and is to be read beside the last picture.
fn rows_of_picture(rows: usize) -> usize {
    const SAID: usize = 12;
    let rest = rows.saturating_sub(SAID);
    rest.clamp(rows / 3, rows * 3 / 4).max(1)
}

/// A picture in so many cells at most, each line with its end.
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

/// Pixels per dot: a cell has two dots, which are about square.
fn scale(width: usize, height: usize, columns: usize, rows: usize) -> f64 {
    (width as f64 / columns as f64).max(height as f64 / (2 * rows) as f64)
}

/// The pixels of one of `parts` parts: at least one.
fn share(index: usize, parts: usize, pixels: usize) -> std::ops::Range<usize> {
    let start = (index * pixels / parts).min(pixels - 1);
    let end = ((index + 1) * pixels / parts).max(start + 1);
    start..end.min(pixels)
}

/// The mean of some pixels, as bytes of sRGB.
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

/// The nearest of the colours 16 to 255 of a terminal: a cube of six levels a channel, and 24
/// greys.
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
