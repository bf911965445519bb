//! Where in a whole picture a part of it lies, which says nothing of that itself.

use super::pixels::Film;
use crate::area::Area;

/// Maximum number of pixels that are compared, over all places.
const MOST_COMPARED: u64 = 100_000_000;

/// Share of the usual difference that is left where a part lies; sampling noise leaves less.
const LEFT: f64 = 0.2;

/// Minimum share of the whole picture: a smaller part looks alike in too many places.
const LEAST_SHARE: f64 = 0.05;

/// The place in a whole picture where a part of it differs far less than elsewhere, if there is
/// one.
pub fn place_of_part(part: &Film, whole: &Film) -> Option<Area> {
    let area = Area::whole(part.width(), part.height());
    let columns = whole.width().checked_sub(area.width)? + 1;
    let rows = whole.height().checked_sub(area.height)? + 1;
    let all = Area::whole(whole.width(), whole.height());
    if (area.pixels() as f64) < LEAST_SHARE * all.pixels() as f64 {
        return None;
    }
    let places = u64::from(columns) * u64::from(rows);
    let compared = (MOST_COMPARED / places).clamp(16, 400).min(area.pixels());
    // Every so many pixels one, with a number that no width is a multiple of in all rows.
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
    (least < LEFT * sum / places as f64).then_some(place)
}
