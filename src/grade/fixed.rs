//! Samples of right pictures whose errors are not those of independent ones: always at the same places in a pixel, or none in some.

use std::sync::atomic::Ordering;

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::{
    Case, LEFT, Verdict, alike,
    bias::SIGMAS,
    evidence, level,
    noise::{self, Noise},
    objects::Near,
    origin::Origin,
    size,
};
use crate::{
    area::Area,
    film::{Film, Tolerance, compare, rmse},
    render::{self, RenderError},
};

/// The same samples in each pixel.
pub struct Grid {
    /// How many they are; none if several numbers of them make the picture.
    pub samples: Option<u64>,
    /// Where in a pixel they are; none if several places make the picture.
    place: Option<Place>,
    /// Whether enough pixels tell of it.
    pub is_told: bool,
}

/// So many samples in a grid.
#[derive(Clone, Copy)]
struct Cells {
    samples: u64,
    place: Place,
}

/// Where in a pixel the samples of a grid are.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Place {
    /// In the middles of its cells.
    Middles,
    /// At a corner of each of its cells.
    Corners { is_right: bool, is_lower: bool },
    /// From side to side.
    Ends,
}

/// The corners of a cell: whether they are right ones, and lower ones.
const OF_A_CELL: [[bool; 2]; 4] = [[false, false], [false, true], [true, false], [true, true]];

impl Cells {
    fn all() -> impl Iterator<Item = Self> {
        let middles = GRIDS.into_iter().map(|samples| Self {
            samples,
            place: Place::Middles,
        });
        let corners = OF_A_CELL.map(|[is_right, is_lower]| Place::Corners { is_right, is_lower });
        let others = (2..=SIDE).flat_map(move |side| {
            corners
                .into_iter()
                .chain([Place::Ends])
                .map(move |place| Self {
                    samples: u64::from(side * side),
                    place,
                })
        });
        middles.chain(others)
    }

    /// What they make of a part of the picture.
    fn picture(&self, case: &Case, part: Area) -> Result<Film, RenderError> {
        if self.place == Place::Middles {
            let sampling = level::grid(&case.full.scene, self.samples);
            return render::render(case.seen().world(), &sampling, part, &case.control);
        }
        let side = self.samples.isqrt() as u32;
        let cells = Area::whole(side, side).iter();
        let offsets: Vec<_> = cells.map(|cell| self.place.offset(side, cell)).collect();
        picture(case, part, &offsets)
    }
}

/// What samples at these offsets from each pixel's centre make of a part of the picture.
fn picture(case: &Case, part: Area, offsets: &[DVec2]) -> Result<Film, RenderError> {
    let (exact, variance, cancel) = (&case.full.exact, &case.variance, case.control.cancel);
    let seen = case.seen();
    let pixel = |x: u32, y: u32| {
        // A sample on a pixel's side may see what its neighbour does.
        let is_one_color =
            noise::is_flat(&variance.pixel(x, y)) && !noise::is_beside_another(exact, [x, y]);
        if is_one_color {
            return exact.pixel(x, y);
        }
        let samples = offsets.iter().map(|offset| seen.at([x, y], *offset));
        (samples.sum::<DVec3>() / offsets.len() as f64).to_array()
    };
    let row = |row: u32| -> Result<Vec<_>, RenderError> {
        if cancel.load(Ordering::Relaxed) {
            return Err(RenderError::Cancelled);
        }
        let columns = 0..part.width;
        Ok(columns
            .map(|column| pixel(part.x + column, part.y + row))
            .collect())
    };
    let rows = (0..part.height).into_par_iter().map(row);
    let rows: Vec<_> = rows.collect::<Result<_, _>>()?;
    Ok(Film::from_fn(part.width, part.height, |x, y| {
        rows[y as usize][x as usize]
    })?)
}

impl Place {
    /// The offset of a cell's sample from the pixel's centre.
    fn offset(self, side: u32, (column, row): (u32, u32)) -> DVec2 {
        // As far along as a sample may be: what is beyond a side is the next pixel's.
        let within = |place: f64| (place - 0.5).min(0.5f64.next_down());
        let along = |cell: u32, is_end: bool| match self {
            Self::Ends => within(f64::from(cell) / f64::from(side - 1)),
            _ => within(f64::from(cell + u32::from(is_end)) / f64::from(side)),
        };
        let [is_right, is_lower] = match self {
            Self::Corners { is_right, is_lower } => [is_right, is_lower],
            _ => [false; 2],
        };
        DVec2::new(along(column, is_right), along(row, is_lower))
    }
}

/// The name of a cell's corner.
fn corner(of_a_cell: [bool; 2]) -> &'static str {
    match of_a_cell {
        [false, false] => "upper left",
        [false, true] => "lower left",
        [true, false] => "upper right",
        [true, true] => "lower right",
    }
}

/// The samples of a pixel, if they are a grid, the same one in each pixel. Where an edge is parallel to the picture's, its errors add up, and
/// grids of as many rows and columns there make the same.
pub fn grid(case: &Case) -> Result<Option<Grid>, RenderError> {
    if case.origin() == Origin::Mistakes {
        return Ok(None);
    }
    let (a, exact) = (&case.full.a, &case.full.exact);
    let [width, height] = size(a);
    let band = case.worst_rows(ROWS);
    let cut = |film: &Film| Film::from_fn(width, band.height, |x, y| film.pixel(x, band.y + y));
    let (a_there, exact_there) = (cut(a)?, cut(exact)?);
    let enough = LEFT * rmse(&a_there, &exact_there);
    // Bytes that are cut off instead of rounded are off by up to a step beside.
    let tolerance = Tolerance {
        steps: evidence::APART,
        bounds: None,
    };
    let is_near = |a: &Film, made: &Film, enough: f64| {
        rmse(a, made) < enough || compare(a, made, tolerance).is_ok_and(|found| found.is_equal())
    };
    let whole = Area::whole(width, height);
    let (mut found, mut best) = (Vec::new(), None::<(f64, usize, Film)>);
    for cells in Cells::all() {
        // Some rows tell which grid it may be.
        let there = cells.picture(case, band)?;
        if !is_near(&a_there, &there, enough) {
            continue;
        }
        let made = cells.picture(case, whole)?;
        if is_near(a, &made, LEFT * case.difference) {
            let left = rmse(a, &made);
            if best.as_ref().is_none_or(|(least, ..)| left < *least) {
                best = Some((left, found.len(), made));
            }
            found.push(cells);
        }
    }
    let Some((left, at, made)) = best else {
        return Ok(None);
    };
    let cells = found.remove(at);
    let is_told = evidence::is_enough(a, exact, &made);
    if !is_told && left >= LEFT * case.difference {
        // Within a step of it is within a step of much.
        return Ok(None);
    }
    let (mut is_known, mut is_only) = (true, true);
    for other in found {
        // It may not be told from the best one.
        if !evidence::is_enough(a, &other.picture(case, whole)?, &made) {
            is_only = false;
            is_known &= other.place == cells.place;
        }
    }
    Ok(Some(Grid {
        samples: is_only.then_some(cells.samples),
        place: is_known.then_some(cells.place),
        is_told,
    }))
}

impl Grid {
    /// What is said of it.
    pub fn verdict(&self, difference: f64) -> Verdict {
        let samples = self.samples;
        let samples = samples.map_or("a few".to_owned(), |samples| samples.to_string());
        let (rest, not_at) = match self.place {
            None | Some(Place::Middles) => (
                "so that edges along rows and columns are displaced by a part of a pixel"
                    .to_owned(),
                None,
            ),
            Some(Place::Ends) => (
                "from side to side, so that what is on a pixel's sides is counted in its neighbour as well"
                    .to_owned(),
                Some("i/(n - 1)"),
            ),
            Some(Place::Corners { is_right, is_lower }) => (
                format!(
                    "at the {} corners of its cells, so that all edges are displaced by half of a cell",
                    corner([is_right, is_lower])
                ),
                Some(match [is_right, is_lower] {
                    [false, false] => "i/n",
                    [true, true] => "(i + 1)/n",
                    _ => "i/n or (i + 1)/n",
                }),
            ),
        };
        let help = match not_at {
            Some(place) => {
                format!(
                    "the middle of cell i of n is at (i + 0.5)/n, not at {place}; {}",
                    alike::HELP
                )
            }
            None => alike::HELP.to_owned(),
        };
        let message = format!(
            "the picture is that of {samples} samples in each pixel, a grid at the same places in all of them, {rest}"
        );
        alike::verdict(difference, &message, help)
    }
}

/// As few rows as have some edges that are not parallel to them.
const ROWS: u32 = 8;

/// Usual numbers of samples: all small ones, squares, and round ones. A grid of more is off by less than a thirty-second of a pixel.
const GRIDS: [u64; 32] = [
    2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 18, 20, 24, 25, 30, 32, 36, 49, 50, 64, 81,
    100, 121, 144, 169, 196, 256,
];

/// Grids of more rows and columns have corners a sixteenth of a pixel from their cells' middles, or less.
const SIDE: u32 = 8;

/// The share of pixels that are black or of the background's colour as no sample fell into them, and the noise of the rest.
pub fn empty(case: &Case) -> Result<Option<(f64, Noise)>, RenderError> {
    for fill in [[0.0; 3], case.full.scene.image.background.to_linear()] {
        let Some(empty) = Empty::of(case, fill) else {
            continue;
        };
        if let Some(found) = empty.in_the_mean(case)? {
            return Ok(Some(found));
        }
        if let Some((share, noise)) = empty.filled(case)? {
            if noise.is_told() {
                return Ok(Some((share, noise)));
            }
            case.may_be_noise.set(true);
        }
    }
    Ok(None)
}

/// Pixels that no sample fell into, among those in which something else than their colour should be seen.
struct Empty {
    fill: [f64; 3],
    near: Near,
    /// Pixels of one colour, and how many of them are empty.
    flat: u64,
    empty: u64,
}

impl Empty {
    /// Those of one colour, if there are as many as chance has, where it has them: two neighbours as often as one after the other.
    fn of(case: &Case, fill: [f64; 3]) -> Option<Self> {
        let (a, exact, variance) = (&case.full.a, &case.full.exact, &case.variance);
        let [width, height] = size(a);
        let near = Near::to(&fill);
        let is_flat = |x: u32, y: u32| {
            !near.holds(&exact.pixel(x, y)) && noise::is_flat(&variance.pixel(x, y))
        };
        let is_empty = |x: u32, y: u32| near.holds(&a.pixel(x, y));
        let (mut flat, mut empty, mut pairs, mut both) = (0u64, 0u64, 0u64, 0u64);
        for (x, y) in Area::whole(width, height).iter() {
            if !is_flat(x, y) {
                continue;
            }
            flat += 1;
            empty += u64::from(is_empty(x, y));
            if x + 1 < width && is_flat(x + 1, y) {
                pairs += 1;
                both += u64::from(is_empty(x, y) && is_empty(x + 1, y));
            }
        }
        let share = empty as f64 / flat.max(1) as f64;
        // A pair has but two others that it shares a pixel with.
        let is_chance = is_chance(both, share * share * pairs as f64, 3.0);
        (flat > 0 && is_chance && share <= MOSTLY).then_some(Self {
            fill,
            near,
            flat,
            empty,
        })
    }

    fn share(&self) -> f64 {
        self.empty as f64 / self.flat as f64
    }

    /// The noise of means into which the fill comes everywhere: where many pixels are empty one of several colours that has the fill's may be
    /// so or not.
    fn in_the_mean(&self, case: &Case) -> Result<Option<(f64, Noise)>, RenderError> {
        if self.empty == 0 {
            return Ok(None);
        }
        let (a, exact, variance) = (&case.full.a, &case.full.exact, &case.variance);
        let [width, height] = size(a);
        let share = self.share();
        let filled = Film::from_fn(width, height, |x, y| {
            match noise::is_flat(&variance.pixel(x, y)) && self.near.holds(&a.pixel(x, y)) {
                true => exact.pixel(x, y),
                false => a.pixel(x, y),
            }
        })?;
        let full = 1.0 - share;
        let made = Film::from_fn(width, height, |x, y| {
            let light = exact.pixel(x, y);
            [0, 1, 2].map(|i| full * light[i] + share * self.fill[i])
        })?;
        let spread = Film::from_fn(width, height, |x, y| {
            let (light, one) = (exact.pixel(x, y), variance.pixel(x, y));
            let away = [0, 1, 2].map(|i| light[i] - self.fill[i]);
            [0, 1, 2].map(|i| full * one[i].max(0.0) + share * full * away[i] * away[i])
        })?;
        let Some(noise) = noise::judge(a, &made, &spread) else {
            return Ok(None);
        };
        let is_noise = noise::are_flat_pixels_right(&filled, exact, variance)
            && !case.is_biased(a, &made, &spread, noise)?;
        Ok(is_noise.then_some((share, noise)))
    }

    /// The noise of the other pixels: where few are empty, a pixel of several colours is one of them if its samples would hardly make it so.
    fn filled(&self, case: &Case) -> Result<Option<(f64, Noise)>, RenderError> {
        let (a, exact, variance) = (&case.full.a, &case.full.exact, &case.variance);
        let [width, height] = size(a);
        // That many fall into a pixel on an average of which e^−n pixels have none (Poisson); one more that is empty is no less likely.
        let samples = libm::log(self.flat as f64 / self.empty.max(1) as f64);
        let (mut mixed, mut among) = (0u64, 0u64);
        let mut filled = Film::clone(a);
        for (x, y) in Area::whole(width, height).iter() {
            let (is, should) = (a.pixel(x, y), exact.pixel(x, y));
            if self.near.holds(&should) {
                continue;
            }
            let one = variance.pixel(x, y);
            let is_flat = noise::is_flat(&one);
            mixed += u64::from(!is_flat);
            if self.near.holds(&is) && (is_flat || !noise::may_be(&is, &should, &one, samples)) {
                among += u64::from(!is_flat);
                filled.put(Area::pixel(x, y), &[should]);
            }
        }
        let expected = self.share() * mixed as f64;
        // They are a part of those that are expected.
        if self.empty + among == 0 || among as f64 > expected && !is_chance(among, expected, 1.0) {
            return Ok(None);
        }
        let Some(noise) = noise::possible(&filled, exact, variance) else {
            return Ok(None);
        };
        let share = (self.empty + among) as f64 / (self.flat + mixed) as f64;
        Ok((!case.is_biased(&filled, exact, variance, noise)?).then_some((share, noise)))
    }
}

/// Where more than this share of the pixels has a colour it is no fill. It is a choice: as with a tenth of a sample in each pixel.
const MOSTLY: f64 = 0.9;

/// Whether a number is what chance makes of an expected one, if its variance is so many times as large. A small expected number is known only
/// by what was counted, so that it may be off by a few.
fn is_chance(number: u64, expected: f64, times: f64) -> bool {
    (number as f64 - expected).abs() <= SIGMAS * (times * expected).sqrt() + 3.0
}
