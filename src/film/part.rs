//! Finds where a part lies in the whole picture, if the part's file does not say so.

use super::pixels::Film;
use crate::area::Area;

/// Approximate maximum number of pixels that are compared in the search for a part's position,
/// summed over all positions. At each position, 16 to 400 pixels are compared, or all pixels of a
/// smaller part. A larger maximum makes the search slower. With a smaller maximum, fewer pixels are
/// compared at each position, and a wrong result is more likely.
const MAX_COMPARED: u64 = 100_000_000;

/// Maximum squared colour difference at the best position, as a fraction of the mean over all
/// positions. If the fraction is larger, no position is returned. At the right position, the usual
/// noise of sampling gives a fraction far below this limit. If the part does not fit anywhere, the
/// fraction is near 1.
const MAX_LEFT: f64 = 0.2;

/// Minimum area of a part, as a fraction of the whole picture's area. No position is returned for a
/// smaller part, since its few pixels may also fit at a wrong position. The value is a guess.
const MIN_SHARE: f64 = 0.05;

/// Finds the position in the whole picture at which a part fits far better than elsewhere. Returns
/// the part's area there, or `None` if there is no such position.
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
    // Only every `step`-th pixel of the part, counted row by row, is compared. If the part's width
    // were a multiple of `step`, all compared pixels would be in few columns. Widths are often
    // even, so `step` is made odd.
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
