//! An object that is off in some way that nobody thought of: the picture is right wherever it is not.

use glam::DVec3;

use super::{
    ENOUGH, SEARCHED, called,
    colors::{Near, color},
    likeliest, moved,
    search::Blob,
};
use crate::{
    area::Area,
    film::{Film, Tolerance, compare, rmse},
    grade::{Case, Off, Verdict, explained_share, noise},
    render::RenderError,
    scene::Shape,
};

/// How much larger an object may be, or how much of its size beside its place.
const ROOM: f64 = 1.25;

/// An object takes the blame if its part of the picture is less than this share of it.
const PART: f64 = 0.5;

/// So many pixels have to be wrong there.
const WRONG: usize = 16;

/// Of parts with no less than this share of the most that any has of what is wrong the smallest is looked at first.
const AS_MUCH: f64 = 0.9;

/// The object in whose part of the picture all of the difference is but noise; of several the one in whose part there is most of what noise
/// would not make.
pub fn confined(case: &Case) -> Result<Option<Verdict>, RenderError> {
    let (a, exact, scene) = (&case.full.a, &case.full.exact, &case.full.scene);
    let whole = Area::whole(a.width(), a.height());
    let mut parts = Vec::new();
    for (_, index) in likeliest(case, ROOM).into_iter().take(SEARCHED) {
        let shape = scene.objects[index].shape;
        if matches!(shape, Shape::Checkerboard(_)) {
            continue;
        }
        let part = case.view.extent(&moved(&shape, DVec3::ZERO, ROOM));
        parts.extend(part.map(|part| (share(case, part), part.pixels(), index, part)));
    }
    parts.retain(|(_, pixels, ..)| (*pixels as f64) < PART * whole.pixels() as f64);
    let most = parts.iter().fold(0.0, |most: f64, part| most.max(part.0));
    parts.sort_by_key(|(share, pixels, index, _)| (*share < AS_MUCH * most, *pixels, *index));
    for (_, _, index, part) in parts {
        let Some(Rest { film: rest, noisy }) = outside(case, part)? else {
            continue;
        };
        let name = called(scene, index);
        // Noise is in pixels of several colours alone, and displaces what has one.
        let (but, wrong, off) = match noisy {
            true => ("but for noise ", strays(case, part), None),
            false => ("", wrong(case, part), off(case, index, part)),
        };
        let mut message = format!(
            "{but}the picture is wrong only where {name} is seen, or near it, in {wrong} pixels: something about it is off"
        );
        if let Some(off) = off {
            message += &format!("; what has its colour there is displaced: {off}");
        }
        let left = rmse(&rest, exact);
        return Ok(Some(Verdict {
            mistake: "object",
            message,
            help: format!(
                "look at the fields of the {}, and at how its rays are intersected",
                scene.objects[index].shape.kind()
            ),
            rmse: Some(left),
            explains: Some(explained_share(left, case.difference)),
            off,
        }));
    }
    Ok(None)
}

/// The share of what is wrong that is in a part: of pixels of one colour, in which there is no noise, if any are wrong.
fn share(case: &Case, part: Area) -> f64 {
    match case.strays.pixels {
        0 => case.differences.share(part),
        _ => case.strays.share(part),
    }
}

/// How many pixels of one colour are wrong in a part.
fn strays(case: &Case, part: Area) -> usize {
    (case.strays.share(part) * case.strays.pixels as f64).round() as usize
}

/// How many pixels of a part are wrong.
fn wrong(case: &Case, part: Area) -> usize {
    let (a, exact) = (&case.full.a, &case.full.exact);
    let is_off = |(x, y): &(u32, u32)| noise::is_off((&a.pixel(*x, *y), &exact.pixel(*x, *y)));
    part.iter().filter(is_off).count()
}

/// How far what has an object's colour in a part is from where the exact picture has it.
fn off(case: &Case, index: usize, part: Area) -> Option<Off> {
    let mut shape = case.full.scene.objects[index].shape;
    let color = color(&mut shape).first()?.to_linear();
    let near = Near::to(&color);
    let films = [&case.full.a, &case.full.exact];
    let [is, should] = films.map(|film| Blob::of(film, part, &near));
    if is.pixels.min(should.pixels) < ENOUGH {
        return None;
    }
    // As of a disk.
    let radius = |blob: &Blob| (blob.pixels as f64 / std::f64::consts::PI).sqrt();
    Off::by(is.middle - should.middle, radius(&is) - radius(&should))
}

/// A picture that is right in a part of it.
struct Rest {
    film: Film,
    /// Whether the rest of it differs by more than roundings.
    noisy: bool,
}

/// The picture, right in a part of it, if the rest of it differs by roundings or noise alone.
fn outside(case: &Case, part: Area) -> Result<Option<Rest>, RenderError> {
    let (a, exact) = (&case.full.a, &case.full.exact);
    let is_in = |x: u32, y: u32| Area::pixel(x, y).lies_in(part);
    let rest = Film::from_fn(a.width(), a.height(), |x, y| match is_in(x, y) {
        true => exact.pixel(x, y),
        false => a.pixel(x, y),
    })?;
    let rounding = Tolerance {
        steps: 0.501,
        bounds: None,
    };
    if compare(&rest, exact, rounding).is_ok_and(|found| found.is_equal()) {
        let is_wrong = wrong(case, part) >= WRONG;
        return Ok(is_wrong.then_some(Rest {
            film: rest,
            noisy: false,
        }));
    }
    let none = Film::new(a.width(), a.height())?;
    let variance = Film::from_fn(a.width(), a.height(), |x, y| match is_in(x, y) {
        true => none.pixel(x, y),
        false => case.variance.pixel(x, y),
    })?;
    let Some(noise) = noise::judge(&rest, exact, &variance) else {
        return Ok(None);
    };
    let is_biased = case.is_biased(&rest, exact, &variance, noise)?;
    Ok((!is_biased).then_some(Rest {
        film: rest,
        noisy: true,
    }))
}
