//! The position of a cropped part in a whole picture, for parts whose file does not contain it.

use super::pixels::Film;
use crate::area::Area;

/// Maximum number of pixel comparisons in the search for a part's position: pixels of the part
/// times positions in the whole picture. If all pixels would be more, only some of the part's
/// pixels are compared, at equal distances.
const MAX_COMPARED: u64 = 100_000_000;

/// Maximum ratio of the squared difference between the part and the whole picture at the best
/// position to the mean squared difference over all positions. Above it, the position counts as
/// unknown. Sampling noise leaves a smaller ratio at the right position.
const MAX_LEFT: f64 = 0.2;

/// Minimum ratio of the part's area to that of the whole picture. The position of a smaller part
/// counts as unknown, since so few pixels resemble the whole picture at many positions.
const MIN_SHARE: f64 = 0.05;

/// Finds the position in a whole picture where a part differs far less than elsewhere. Returns the
/// part's area there, or `None` if there is no such position.
pub fn place_of_part(part: &Film, whole: &Film) -> Option<Area> {
    let area = Area::whole(part.width(), part.height());
    let columns = whole.width().checked_sub(area.width)? + 1;
    let rows = whole.height().checked_sub(area.height)? + 1;
    let all = Area::whole(whole.width(), whole.height());
    if (area.pixels() as f64) < MIN_SHARE * all.pixels() as f64 {
        return None;
    }
    let places = u64::from(columns) * u64::from(rows);
    let compared = (MAX_COMPARED / places).clamp(16, 400).min(area.pixels());
    // Of the part's pixels, row by row, one of every `step` is compared. The step is odd, so that
    // it rarely divides the width; then, the compared columns vary from row to row.
    let step = (area.pixels() / compared).max(1) | 1;
    let points: Vec<(u32, u32)> = (0..area.pixels())
        .step_by(step as usize)
        .map(|at| {
            let width = u64::from(area.width);
            ((at % width) as u32, (at / width) as u32)
        })
        .collect();
    let difference = |left: u32, top: u32| -> f64 {
        let squares = points.iter().map(|&(x, y)| {
            let (a, b) = (part.pixel(x, y), whole.pixel(left + x, top + y));
            (0..3).map(|i| (a[i] - b[i]) * (a[i] - b[i])).sum::<f64>()
        });
        squares.sum()
    };
    let (mut least, mut sum, mut place) = (f64::INFINITY, 0.0, area);
    for top in 0..rows {
        for left in 0..columns {
            let found = difference(left, top);
            sum += found;
            if found < least {
                least = found;
                place = Area {
                    x: left,
                    y: top,
                    ..area
                };
            }
        }
    }
    (least < MAX_LEFT * sum / places as f64).then_some(place)
}
