//! Finds what is obviously wrong with a picture, before the search for mistakes: values that are
//! not finite numbers, an empty or noisy picture, empty rows, or transparency.

use glam::DVec3;

use super::{
    hypotheses::{Candidate, Curve, Mistake, MistakeRow, ROWS, is_near},
    scoring::{FaultyTracer, Grid},
    verdict::NamedMistake,
};
use crate::{area::Area, film::Film, scene::Scene};

/// Ratio above which a picture is noise: the mean squared difference of neighbouring pixels,
/// divided by the mean squared difference of two arbitrary pixels. In noise, this ratio is 1 on
/// average, and 0.8 leaves a margin for chance. In a picture of a scene, it is smaller, because
/// neighbouring pixels are alike.
const NOISE_RATIO: f64 = 0.8;

/// Number of cells along the picture's longer side that are tested to find out why a picture is
/// empty. One ray per cell tests whether a program with a certain mistake sees an object. With
/// fewer cells, more small objects are missed. With more, the test takes longer.
const CELLS: u32 = 32;

/// Maximum number of possible causes that are listed for an empty picture. Chosen to keep the
/// advice short.
const CAUSES: usize = 3;

fn fact(id: &'static str, message: impl Into<String>, help: impl Into<String>) -> NamedMistake {
    NamedMistake {
        id,
        object: None,
        message: message.into(),
        help: help.into(),
        set: Vec::new(),
        explains: 1.0,
    }
}

/// Reports how many pixels of a picture are not finite numbers. Returns `None` if all are finite.
pub fn not_finite(film: &Film) -> Option<NamedMistake> {
    let is_finite = |pixel: &&[f64; 3]| pixel.iter().all(|light| light.is_finite());
    let count = film.pixels().len() - film.pixels().iter().filter(is_finite).count();
    let message = match count {
        0 => return None,
        1 => "a pixel is no finite number".to_owned(),
        count => format!("{count} pixels are no finite numbers"),
    };
    let help = "a division by zero, or the square root of a negative number, makes them";
    Some(fact("not_finite", message, help))
}

/// Reports as a mistake that a picture has only one colour or is noise, unless the same is true of
/// the exact picture. Returns `None` if there is nothing to report.
pub fn empty_or_noise(film: &Film, exact: &Film, scene: &Scene) -> Option<NamedMistake> {
    let first = film.pixels()[0];
    if film.pixels().iter().all(|pixel| *pixel == first) {
        // One colour is correct if the exact picture shows the same colour everywhere.
        if exact.pixels().iter().all(|pixel| is_near(*pixel, first)) {
            return None;
        }
        let background = scene.image.background;
        if is_near(first, background.to_linear()) {
            let message = format!(
                "nothing of the scene is seen: the picture has the colour of the background, {background}, all over"
            );
            return Some(fact("nothing_seen", message, causes(scene)));
        }
        if first == [0.0; 3] {
            let help = "nothing was written into it, or zeros: a colour from 0 to 1 as a whole number is 0, and is multiplied by 255 before it becomes one";
            return Some(fact("black", "the picture is black all over", help));
        }
        let help = "a ray leaves through its own pixel: its direction has to be made anew for each";
        return Some(fact(
            "one_colour",
            "the picture has one colour all over",
            help,
        ));
    }
    (is_noise(film) && !is_noise(exact)).then(|| {
        let message = "the picture is noise: it is no more like this scene than noise is";
        let help = "look at the file: a header with another size or another number of bytes in a pixel, or memory that was never written";
        fact("noise", message, help)
    })
}

/// Returns whether a picture is noise, i.e. whether neighbouring pixels differ about as much as
/// distant ones.
fn is_noise(film: &Film) -> bool {
    let width = film.width() as usize;
    let pixels = film.pixels();
    let count = pixels.len() as f64;
    let pixels: Vec<DVec3> = pixels.iter().copied().map(DVec3::from).collect();
    let mean = pixels.iter().sum::<DVec3>() / count;
    let square = |one: &DVec3, other: &DVec3| one.distance_squared(*other);
    let far = pixels.iter().map(|pixel| square(pixel, &mean)).sum::<f64>() / count;
    let pairs = pixels.iter().zip(&pixels[width.min(pixels.len())..]);
    let below = pairs.map(|(one, other)| square(one, other)).sum::<f64>() / count;
    let rows = pixels.chunks_exact(width).flat_map(|row| row.windows(2));
    let beside = rows.map(|pair| square(&pair[0], &pair[1])).sum::<f64>() / count;
    far > 0.0 && below.min(beside) > 2.0 * NOISE_RATIO * far
}

/// Returns advice that lists mistakes by which the picture of this scene would be empty.
fn causes(scene: &Scene) -> String {
    let part = Area::whole(scene.image.width, scene.image.height);
    let grid = Grid::new(&scene.image, part, CELLS);
    let background = scene.image.background.to_linear();
    let right = Candidate::correct(scene);
    let shows_nothing = |row: &&'static MistakeRow| {
        let wrong = right.with(Mistake::Row(row, None));
        wrong.is_some_and(|wrong| {
            let tracer = FaultyTracer::new(&wrong.drawn(&grid), wrong.behaviour, Curve::Correct);
            let cells = tracer.moments(grid.cells, 1).mean;
            cells.iter().all(|cell| cell.to_array() == background)
        })
    };
    let found = ROWS.iter().filter(shows_nothing).take(CAUSES);
    let found: Vec<&str> = found.map(|row| row.message).collect();
    match &found[..] {
        [] => "print the direction of one ray, and ask one object for its hit by hand".to_owned(),
        found => format!("in this scene it would be so if {}", found.join(", or if ")),
    }
}

/// Finds empty rows at the top or bottom of a picture: they all have one colour, although the exact
/// picture shows something else there. A single row, and rows that fill the picture, do not count.
/// Returns the picture with the empty rows replaced by NaN, and a message. Returns `None` if no
/// empty rows are found.
pub fn without_empty_rows(film: &Film, exact: &Film) -> Option<(Film, NamedMistake)> {
    let (width, height) = (film.width() as usize, film.height());
    let rows = |is_below: bool| {
        let at = |y: u32| if is_below { height - 1 - y } else { y };
        let light = film.row(at(0))[0];
        let is_empty = |y: &u32| film.row(at(*y)).iter().all(|pixel| *pixel == light);
        let count = (0..height).take_while(is_empty).count() as u32;
        // A row that should have one colour, such as the sky's, may show a wrong colour instead of
        // being empty. The row's correct colour is then usually nowhere in the picture. So the row
        // is reported as empty only if its correct colour appears somewhere.
        let is_shown = |light| film.pixels().iter().any(|pixel| is_near(*pixel, light));
        let is_wrong = |y: &u32| {
            let own = exact.row(at(*y));
            let has_several = own.iter().any(|pixel| !is_near(*pixel, own[0]));
            let wrong = own.iter().filter(|pixel| !is_near(**pixel, light));
            wrong.count() > width / 8 && (has_several || is_shown(own[0]))
        };
        let [one, other] = [at(0), at(count.max(1) - 1)];
        let is_found = (0..count).filter(is_wrong).count() >= 2 && count + 2 <= height;
        is_found.then_some([one.min(other), one.max(other)])
    };
    let [first, last] = rows(true).or_else(|| rows(false))?;
    let mut left = film.clone();
    left.pixels_mut()[first as usize * width..][..(last - first + 1) as usize * width]
        .fill([f64::NAN; 3]);
    let help = "a picture is written when all of its rows are made, and each index, row · width + column, is used once";
    let message = format!("rows {first} to {last} are empty: they have one colour");
    Some((left, fact("rows_missing", message, help)))
}

/// Reports that a picture is not opaque. `least` and `most` are the least and the greatest alpha of
/// its pixels, from 0 to 1.
pub fn transparent([least, most]: [f64; 2]) -> NamedMistake {
    let help = "alpha is 255 in every pixel of an opaque picture, or the file has no alpha";
    let byte = |part: f64| (255.0 * part).round();
    let (id, is) = match [least, most].map(byte) {
        [0.0, 0.0] => ("transparent", "transparent all over: its alpha is 0".into()),
        [one, two] if one == two => ("alpha", format!("not opaque: its alpha is {one} of 255")),
        [one, two] => (
            "alpha",
            format!("not opaque: its alpha is {one} to {two} of 255"),
        ),
    };
    fact(id, format!("the picture is {is}"), help)
}
