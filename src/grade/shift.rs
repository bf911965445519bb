//! Pictures that are displaced as a whole, by halves of a pixel up to a few.
//!
//! A pixel of the exact picture with twice the columns and rows is a quarter of a pixel, so that four of them make each pixel of the
//! picture displaced by any number of halves. What comes in at an edge is what the scene shows there, nothing at all, or what went out at the
//! other edge, so that the displacement itself is sought away from the edges.

use std::ops::Range;

use glam::DVec3;

use super::{Case, Idea, Make, exact, noise};
use crate::{
    film::Film,
    numbers::short,
    render::RenderError,
    scene::{Image, Scene},
};

/// The farthest displacement, in halves of a pixel: four pixels, more than rounding a place up, down or twice comes to. What is farther is
/// a camera that looks elsewhere.
const REACH: i32 = 8;

/// The displacement that explains most, if any explains something.
pub fn search(case: &Case) -> Result<Vec<Idea>, RenderError> {
    let level = &case.full;
    let [width, height] = super::size(&level.a);
    // A picture larger than this, or of so many objects, takes too long for a guess.
    if u64::from(width) * u64::from(height) > 1 << 22 || level.is_heavy {
        return Ok(Vec::new());
    }
    let fine = fine_picture(case, &level.scene)?;
    let moved = |fine: &Film, [x, y]: [i32; 2]| {
        // A fine pixel's column is as many halves from the left, and the margin is REACH of them.
        let first = |pixel: u32, by: i32| (2 * pixel as i32 + REACH - by) as u32;
        Film::from_fn(width, height, |column, row| {
            let (left, top) = (first(column, x), first(row, y));
            let [p, q, r, s] =
                [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| fine.pixel(left + i, top + j));
            [0, 1, 2].map(|i| 0.25 * (p[i] + q[i] + r[i] + s[i]))
        })
    };
    let mut at = [0, 0];
    let inside = Inside::of(&level.a);
    let mut left = inside.rmse(&level.a, &level.exact);
    // Downhill in the grid of displacements: the differences' slopes say where to go.
    for _ in 0..6 {
        let here = moved(&fine, at)?;
        let [x, y] = inside.slope(&level.a, &here);
        let step = |by: f64| (2.0 * by).round().clamp(-4.0, 4.0) as i32;
        let next = [at[0] + step(x), at[1] + step(y)].map(|by| by.clamp(-REACH, REACH));
        if next == at {
            break;
        }
        let left_there = inside.rmse(&level.a, &moved(&fine, next)?);
        if left_there >= left {
            break;
        }
        (at, left) = (next, left_there);
    }
    if at == [0, 0] {
        return Ok(Vec::new());
    }
    let [x, y] = at.map(|by| f64::from(by) / 2.0);
    let mut way = Vec::new();
    for (by, positive, negative) in [(x, "to the right", "to the left"), (y, "down", "up")] {
        if by != 0.0 {
            let pixels = if by.abs() == 1.0 { "pixel" } else { "pixels" };
            let side = if by > 0.0 { positive } else { negative };
            way.push(format!("{} {pixels} {side}", short(by.abs())));
        }
    }
    let message = format!("the whole picture is displaced by {}", way.join(" and "));
    let idea = |message: String, film: Film, variance: Film| {
        Idea {
        mistake: "shifted",
        message,
        help: "the window's middle is between the pixels, at (width/2, height/2), and pixel (x, y) goes from x to x + 1 and y to y + 1: \
               its centre is at (x + 0.5, y + 0.5)"
            .to_owned(),
        make: Make::Is(film, variance),
    }
    };
    let displaced = moved(&fine, at)?;
    let squares = moved(&fine_picture(case, &noise::squared(&level.scene))?, at)?;
    let variance = noise::of_squares(&squares, &displaced)?;
    let mut ideas = vec![idea(message.clone(), displaced, variance)];
    if at.iter().all(|by| by % 2 == 0) {
        // Whole pixels.
        let from = |pixel: u32, by: i32| i64::from(pixel) - i64::from(by / 2);
        let empty = |film: &Film| {
            Film::from_fn(width, height, |x, y| {
                let (column, row) = (from(x, at[0]), from(y, at[1]));
                match (u32::try_from(column), u32::try_from(row)) {
                    (Ok(column), Ok(row)) if column < width && row < height => {
                        film.pixel(column, row)
                    }
                    _ => [0.0; 3],
                }
            })
        };
        let wrapped = |film: &Film| {
            let wrap = |at: i64, size: u32| at.rem_euclid(i64::from(size)) as u32;
            Film::from_fn(width, height, |x, y| {
                film.pixel(wrap(from(x, at[0]), width), wrap(from(y, at[1]), height))
            })
        };
        ideas.push(idea(
            format!("{message}, and black where it is missing then"),
            empty(&level.exact)?,
            empty(&case.variance)?,
        ));
        ideas.push(idea(
            format!("{message}, and what goes out at one edge comes in at the other"),
            wrapped(&level.exact)?,
            wrapped(&case.variance)?,
        ));
    }
    Ok(ideas)
}

/// A scene's picture with twice the columns and rows, and a margin of [`REACH`] of them on all sides.
fn fine_picture(case: &Case, scene: &Scene) -> Result<Film, RenderError> {
    let mut fine = super::level::with_distance(scene, super::level::distance(scene));
    let sides = [scene.image.width, scene.image.height].map(|side| 2 * side + 2 * REACH as u32);
    fine.camera.view_height *= f64::from(sides[1]) / (2.0 * f64::from(scene.image.height));
    fine.image = Image {
        width: sides[0],
        height: sides[1],
        ..scene.image
    };
    exact(&fine, &case.control)
}

/// The pixels of a picture that no displacement brings in from outside, or all but the outermost if it is too small for that.
struct Inside {
    columns: Range<u32>,
    rows: Range<u32>,
}

impl Inside {
    fn of(film: &Film) -> Self {
        let [columns, rows] = super::size(film).map(|side| {
            // Half as many pixels as halves, and one for the slopes.
            let margin = REACH as u32 / 2 + 1;
            match side > 4 * margin {
                true => margin..side - margin,
                false => 1..side.saturating_sub(1),
            }
        });
        Self { columns, rows }
    }

    fn pixels(&self) -> impl Iterator<Item = (u32, u32)> {
        let columns = self.columns.clone();
        self.rows
            .clone()
            .flat_map(move |y| columns.clone().map(move |x| (x, y)))
    }

    /// Up to a factor, which does not matter here.
    fn rmse(&self, a: &Film, b: &Film) -> f64 {
        let square =
            |(x, y)| (DVec3::from(a.pixel(x, y)) - DVec3::from(b.pixel(x, y))).length_squared();
        self.pixels().map(square).sum::<f64>().sqrt()
    }

    /// How far `a` is displaced against `b`, in pixels to the right and down: the least-squares solution of a − b ≈ −x ∂b/∂x − y ∂b/∂y.
    fn slope(&self, a: &Film, b: &Film) -> [f64; 2] {
        let mut m = [0.0; 5];
        for (x, y) in self.pixels() {
            let [left, right] = [b.pixel(x - 1, y), b.pixel(x + 1, y)];
            let [above, below] = [b.pixel(x, y - 1), b.pixel(x, y + 1)];
            let (p, q) = (a.pixel(x, y), b.pixel(x, y));
            for i in 0..3 {
                let (gx, gy) = ((right[i] - left[i]) / 2.0, (below[i] - above[i]) / 2.0);
                let error = q[i] - p[i];
                m[0] += gx * gx;
                m[1] += gx * gy;
                m[2] += gy * gy;
                m[3] += gx * error;
                m[4] += gy * error;
            }
        }
        let determinant = m[0] * m[2] - m[1] * m[1];
        if determinant <= 1e-12 * m[0] * m[2] || determinant == 0.0 {
            return [0.0; 2];
        }
        [
            (m[3] * m[2] - m[4] * m[1]) / determinant,
            (m[0] * m[4] - m[1] * m[3]) / determinant,
        ]
    }
}
