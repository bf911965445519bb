//! An object that is off in some way that nobody thought of: the picture is right wherever it is not.

use glam::DVec3;

use super::{
    ENOUGH, SEARCHED, called,
    colors::{Near, color},
    likeliest, moved,
    palette::Palette,
    search::Blob,
};
use crate::{
    area::Area,
    film::{Film, Tolerance, compare, rmse},
    grade::{
        Case, LEFT, Off, Verdict,
        evidence::FEWEST,
        explained_share,
        noise::{self, Size, Spread},
    },
    render::RenderError,
    scene::Shape,
};

/// How much larger an object may be, or how much of its size beside its place. It is a choice: with more room the parts of neighbours have
/// all of it, too; with less an edge that is off by a little is outside.
const ROOM: f64 = 1.25;

/// An object takes the blame if its part of the picture is less than this share of it: of what is wrong all over, half of the picture would
/// have half by chance.
pub(super) const PART: f64 = 0.5;

/// So many pixels have to be wrong there: as many as name a mistake if all agree.
const WRONG: usize = FEWEST as usize;

/// Of parts with no less than this share of the most that any has of what is wrong the smallest is looked at first: a part is that of a ball
/// around its object, and the corner of a larger one may hold some of the rest.
const AS_MUCH: f64 = 0.9;

/// Bytes that are rounded are off by half a step, and light that was rounded on the way by a little more.
const ROUNDED: f64 = 0.501;

/// The object in whose part of the picture all of the difference is but noise; of several the one in whose part there is most of what noise
/// would not make.
pub fn confined(case: &Case) -> Result<Option<Verdict>, RenderError> {
    let palette = Palette::of(case);
    if let Some(verdict) = palette.foreign(case) {
        return Ok(Some(verdict));
    }
    let mut found = Vec::new();
    for (_, _, index, part) in parts(case) {
        if !palette.is_of(&case.full.scene.objects[index].shape) {
            continue;
        }
        if let Some(rest) = outside(case, part)? {
            let is_clean = !rest.noisy;
            found.push((index, part, rest));
            if is_clean {
                break;
            }
        }
    }
    // Where nothing else is wrong there is no noise, and so it is where another object's part leaves that to noise. Of two that are
    // seen in the same place a few pixels do not tell which it is.
    let is_plain = found.last().is_some_and(|(_, _, rest)| !rest.noisy);
    let is_told = found.len() < 2 || case.strays.pixels >= TELLING;
    let chosen = match (is_plain, is_told) {
        (true, _) => found.pop(),
        (false, true) => found
            .into_iter()
            .max_by(|p, q| case.excess(p.1).total_cmp(&case.excess(q.1))),
        (false, false) => None,
    };
    Ok(chosen.map(|(index, part, rest)| blamed(case, index, part, &rest)))
}

/// The share of what is wrong that is in a part, its pixels, the object and the part.
type Part = (f64, u64, usize, Area);

/// Those that may take the blame, in the order in which they are looked at.
fn parts(case: &Case) -> Vec<Part> {
    let (a, scene) = (&case.full.a, &case.full.scene);
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
    parts
}

/// The object whose part alone explains the difference, if all that is wrong is there or joined on to it:
/// it may be much larger than it should be. Noise joins on to everything, so that it takes a picture that is right elsewhere; and so do
/// objects that a camera displaces, of which it has to be known that it is not off.
pub fn reaching_out(case: &Case) -> Result<Option<Verdict>, RenderError> {
    let parts = parts(case);
    let whole = Area::whole(case.full.a.width(), case.full.a.height());
    let own = |part: &Part| case.differences.share(part.3);
    let Some(most) = parts.iter().max_by(|p, q| own(p).total_cmp(&own(q))) else {
        return Ok(None);
    };
    let part = joined(case, most.3);
    if own(most) < 1.0 - LEFT * LEFT || part.pixels() as f64 >= PART * whole.pixels() as f64 {
        return Ok(None);
    }
    let rest = outside(case, part)?.filter(|rest| !rest.noisy);
    Ok(rest.map(|rest| blamed(case, most.2, part, &rest)))
}

/// A part of the picture and the wrong pixels that are joined on to it.
fn joined(case: &Case, mut part: Area) -> Area {
    let (a, exact) = (&case.full.a, &case.full.exact);
    loop {
        let around = around(part, a);
        let is_off = |&(x, y): &(u32, u32)| noise::is_off((&a.pixel(x, y), &exact.pixel(x, y)));
        let wrong = around.iter().filter(is_off);
        let larger = wrong.fold(part, |part, (x, y)| part.with(Area::pixel(x, y)));
        if larger == part {
            return part;
        }
        part = larger;
    }
}

/// A part of a picture and the pixels next to it.
pub(super) fn around(part: Area, film: &Film) -> Area {
    let [x, y] = [part.x, part.y].map(|at| at.saturating_sub(1));
    Area {
        x,
        y,
        width: (part.x + part.width + 1).min(film.width()) - x,
        height: (part.y + part.height + 1).min(film.height()) - y,
    }
}

/// What is said of an object in whose part of the picture all is wrong that is wrong.
fn blamed(case: &Case, index: usize, part: Area, rest: &Rest) -> Verdict {
    let (exact, scene) = (&case.full.exact, &case.full.scene);
    let name = called(scene, index);
    // Noise is in pixels of several colours alone, and displaces what has one.
    let (but, wrong, off) = match rest.noisy {
        true => ("but for noise ", strays(case, part), None),
        false => ("", wrong(case, part), off(case, index, part)),
    };
    let pixels = if wrong == 1 { "pixel" } else { "pixels" };
    let mut message = format!(
        "{but}the picture is wrong only where {name} is seen, or near it, in {wrong} {pixels}: something about it is off"
    );
    if let Some(off) = off {
        message += &format!("; what has its colour there is displaced: {off}");
    }
    let left = rmse(&rest.film, exact);
    Verdict {
        mistake: "object",
        message,
        help: format!(
            "look at the fields of the {}, and at how its rays are intersected",
            scene.objects[index].shape.kind()
        ),
        rmse: Some(left),
        explains: Some(explained_share(left, case.difference)),
        off,
    }
}

/// So many pixels of one colour tell which of two objects it is, the one with the smaller part. It is a choice: one or two are seen at an edge
/// of both.
const TELLING: u64 = 3;

/// Whether all pixels that are off are in one object's part of the picture, and more of those elsewhere are right than samples leave right that
/// are so far off there.
pub fn is_in_one_part(case: &Case) -> bool {
    let mut objects = case.full.scene.objects.iter();
    objects.any(|object| {
        let part = case.view.extent(&moved(&object.shape, DVec3::ZERO, ROOM));
        part.is_some_and(|part| {
            !matches!(object.shape, Shape::Checkerboard(_)) && is_in_part_alone(case, part)
        })
    })
}

fn is_in_part_alone(case: &Case, part: Area) -> bool {
    let (a, exact) = (&case.full.a, &case.full.exact);
    let (mut inside, mut outside) = (Size::default(), Spread::default());
    for (x, y) in Area::whole(a.width(), a.height()).iter() {
        let (p, q) = (a.pixel(x, y), exact.pixel(x, y));
        let variance = case.variance.pixel(x, y);
        if Area::pixel(x, y).lies_in(part) {
            inside.add(&p, &q, &variance);
        } else if noise::is_off((&p, &q)) {
            return false;
        } else {
            outside.add(&p, &q, &variance, (&p, &q));
        }
    }
    !outside.may_be_right(inside.most_samples())
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
        steps: ROUNDED,
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
    // With few pixels that noise does not explain any object may be right.
    if strays(case, part) < WRONG || case.is_biased(&rest, exact, &variance, noise)? {
        return Ok(None);
    }
    Ok(Some(Rest {
        film: rest,
        noisy: true,
    }))
}
