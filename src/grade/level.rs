//! A picture and its scene at some size.

use std::{borrow::Cow, sync::atomic::Ordering};

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::{Curve, Make, Turn, bias::Trend, exact, extent::View, order};
use crate::{
    area::Area,
    film::{Film, TooLarge},
    math::{Big, Real},
    render::{self, Control, RenderError},
    sampling::Sampling,
    scene::{Count, Image, Lens, Method, Sampler, Scene, Shape},
    threads,
    tracer::{Basis, World},
};

/// A picture for searches has about so many columns and rows at most, and one for searches from afar: an exact picture of the first takes
/// a few milliseconds, of which a fit takes some dozens, and one of the second, which the hundreds of places cost where a search begins,
/// a tenth of that. In the second an object of a quarter of the width still has a few pixels.
pub const SMALL: [u32; 2] = [112, 72];
pub const TINY: [u32; 2] = [28, 18];

/// More objects than this are many: about half as many as the pixels of a tiny picture, so that most of these see several.
const MANY: usize = 256;

/// A small picture with fewer columns or rows than this is one whose pixels see much each, from what is near to the horizon.
const THIN: u32 = 3;

/// The samples in each pixel of a small picture that is not exact, as it would take too long: their errors are those of 1/16 of a pixel,
/// and a start needs to be right within one.
const SAMPLES: u64 = 16;

/// A picture, its scene and the scene's exact picture, of one size.
pub struct Level<'a> {
    /// The picture.
    pub a: Cow<'a, Film>,
    /// The scene, of which `a` should be the picture.
    pub scene: Cow<'a, Scene>,
    /// What `a` should be.
    pub exact: Cow<'a, Film>,
    /// The side of one of its pixels, in pixels of the whole picture.
    pub factor: u32,
    /// Which part of the scene's picture it is.
    part: Area,
    /// Whether it has so many objects, or is so thin, that a small exact picture takes longer than the whole one: each of its pixels sees
    /// much.
    pub is_heavy: bool,
}

impl<'a> Level<'a> {
    /// The whole picture.
    pub fn full(a: &'a Film, scene: &'a Scene, exact: &'a Film) -> Self {
        Self {
            a: Cow::Borrowed(a),
            scene: Cow::Borrowed(scene),
            exact: Cow::Borrowed(exact),
            factor: 1,
            part: Area::whole(scene.image.width, scene.image.height),
            is_heavy: scene.objects.len() > MANY,
        }
    }

    /// Some rows of the whole picture, for mistakes that are another scene.
    pub fn rows(&self, part: Area) -> Result<Level<'_>, TooLarge> {
        let cut =
            |film: &Film| Film::from_fn(part.width, part.height, |x, y| film.pixel(x, part.y + y));
        Ok(Level {
            a: Cow::Owned(cut(&self.a)?),
            scene: Cow::Borrowed(&*self.scene),
            exact: Cow::Owned(cut(&self.exact)?),
            factor: self.factor,
            part,
            is_heavy: self.is_heavy,
        })
    }

    /// A small one, also of the exact picture: each pixel is the mean of a square of pixels. What of the whole is left at its edges is as much on the left as on the
    /// right, and as much at the top as at the bottom, so that the camera still looks at the middle.
    pub fn small(a: &Film, scene: &Scene, exact: &Film, most: [u32; 2]) -> Result<Self, TooLarge> {
        let whole = [a.width(), a.height()];
        let mut factor = (whole[0].div_ceil(most[0]))
            .max(whole[1].div_ceil(most[1]))
            .min(whole[0].min(whole[1]));
        if factor.is_multiple_of(2) && whole.iter().any(|side| !side.is_multiple_of(2)) {
            factor -= 1;
        }
        let size = whole.map(|side| {
            let pixels = side / factor;
            match (side - pixels * factor).is_multiple_of(2) {
                true => pixels,
                false => (pixels - 1).max(1),
            }
        });
        let scene = resized(scene, size, factor);
        let margin = [0, 1].map(|i| (whole[i] - size[i] * factor) / 2);
        let weight = 1.0 / (f64::from(factor) * f64::from(factor));
        let means = |film: &Film| {
            Film::from_fn(size[0], size[1], |x, y| {
                let mut sum = DVec3::ZERO;
                for row in 0..factor {
                    let row = film.row(margin[1] + y * factor + row);
                    let start = (margin[0] + x * factor) as usize;
                    for pixel in &row[start..start + factor as usize] {
                        sum += DVec3::from(*pixel);
                    }
                }
                (sum * weight).to_array()
            })
        };
        Ok(Self {
            a: Cow::Owned(means(a)?),
            exact: Cow::Owned(means(exact)?),
            is_heavy: scene.objects.len() > MANY || size[0].min(size[1]) < THIN && factor > 1,
            scene: Cow::Owned(scene),
            factor,
            part: Area::whole(size[0], size[1]),
        })
    }

    /// Another picture in this one's size, and the scene of which it should be one, if that is another.
    pub fn beside<'b>(&'b self, a: Film, other: Option<(&Scene, Film)>) -> Level<'b> {
        let (scene, exact) = match other {
            Some((scene, exact)) => (Cow::Owned(self.sized(scene)), Cow::Owned(exact)),
            None => (Cow::Borrowed(&*self.scene), Cow::Borrowed(&*self.exact)),
        };
        Level {
            a: Cow::Owned(a),
            scene,
            exact,
            factor: self.factor,
            part: self.part,
            is_heavy: self.is_heavy,
        }
    }

    /// The picture that a mistake makes.
    pub fn made(&self, make: &Make, control: &Control) -> Result<Film, RenderError> {
        match make {
            Make::Film(make) => Ok(make(&self.exact)?),
            Make::Light(curve) => Ok(map(&self.exact, curve.to)?),
            Make::Turned(turn, curve) => Ok(turned(&self.exact, *turn, *curve)?),
            Make::Scene(scene) if self.factor == 1 => {
                let world = World::new_unless(scene, control.cancel)?;
                Ok(render::render_exact(&world, self.part, control)?.film)
            }
            Make::Scene(scene) => self.picture(&self.sized(scene), control),
            Make::Object(scene, shapes) => self.with_object(scene, shapes, control),
            Make::Curved(scene, curve) => {
                let film = self.picture(&self.sized(scene), control)?;
                Ok(map(&film, curve.to)?)
            }
            Make::Floor(scene, holds) => {
                let other = self.picture(&self.sized(scene), control)?;
                Ok(self.where_floor(*holds, &other, &self.exact)?)
            }
            Make::Ordered(order) => order::picture(&self.scene, *order, control),
            Make::Is(film, _) => Ok(film.clone()),
            Make::Sample(offset) => sampled(&self.scene, *offset, control),
            Make::Squeezed => self.squeezed(control),
        }
    }

    /// The picture with one shape changed: rendered anew where the shape was and where it is.
    fn with_object(
        &self,
        scene: &Scene,
        shapes: &[Option<Shape>; 2],
        control: &Control,
    ) -> Result<Film, RenderError> {
        let mut film = Film::clone(&self.exact);
        if let Some((part, changed)) = self.object(scene, shapes, control)? {
            film.put(part, changed.pixels());
        }
        Ok(film)
    }

    /// A part of the whole picture that a mistake makes, if all of it is made anew.
    pub fn part(
        &self,
        make: &Make,
        part: Area,
        control: &Control,
    ) -> Result<Option<Film>, RenderError> {
        let (scene, curve) = match make {
            Make::Scene(scene) => (scene, None),
            Make::Curved(scene, curve) => (scene, Some(curve)),
            _ => return Ok(None),
        };
        let world = World::new_unless(scene, control.cancel)?;
        let made = render::render_exact(&world, part, control)?.film;
        Ok(Some(match curve {
            Some(curve) => map(&made, curve.to)?,
            None => made,
        }))
    }

    /// One picture where pixels' centres see points (x, z) of the floor, in squares, for which something holds, and another one elsewhere.
    pub fn where_floor(
        &self,
        holds: fn(DVec2) -> bool,
        there: &Film,
        elsewhere: &Film,
    ) -> Result<Film, TooLarge> {
        let floor = Floor::new(&self.scene);
        let pixel = |x, y| match floor.point(x, y) {
            Some(point) if holds(point) => there.pixel(x, y),
            _ => elsewhere.pixel(x, y),
        };
        Film::from_fn(self.a.width(), self.a.height(), pixel)
    }

    /// The part of the picture that a changed shape changes, if any.
    pub fn object(
        &self,
        scene: &Scene,
        shapes: &[Option<Shape>; 2],
        control: &Control,
    ) -> Result<Option<(Area, Film)>, RenderError> {
        let scene = self.sized(scene);
        let Some(part) = View::of(&scene).extents(shapes) else {
            return Ok(None);
        };
        let world = World::new_unless(&scene, control.cancel)?;
        let changed = render::render_exact(&world, part, control)?;
        Ok(Some((part, changed.film)))
    }

    /// What a changed shape changes, if it is seen.
    pub fn trend(
        &self,
        scene: &Scene,
        shapes: &[Option<Shape>; 2],
        control: &Control,
    ) -> Result<Option<Trend>, RenderError> {
        let Some((part, changed)) = self.object(scene, shapes, control)? else {
            return Ok(None);
        };
        let pixels = part.iter().zip(changed.pixels()).map(|((x, y), p)| {
            let q = self.exact.pixel(x, y);
            ([x, y], [0, 1, 2].map(|i| p[i] - q[i]))
        });
        let changed = pixels.filter(|(_, change)| *change != [0.0; 3]);
        Ok(Some(Trend(changed.collect())))
    }

    /// The picture of a scene of any size, exact unless that takes too long in small pictures.
    fn picture(&self, scene: &Scene, control: &Control) -> Result<Film, RenderError> {
        match self.is_heavy && self.factor > 1 {
            true => {
                let whole = Area::whole(scene.image.width, scene.image.height);
                let sampling = grid(scene, SAMPLES);
                let world = World::new_unless(scene, control.cancel)?;
                render::render(&world, &sampling, whole, control)
            }
            false => exact(scene, control),
        }
    }

    /// The picture of a program that spreads a square window over the whole picture: it is squeezed, or stretched.
    fn squeezed(&self, control: &Control) -> Result<Film, RenderError> {
        let (width, height) = (self.scene.image.width, self.scene.image.height);
        let side = width.max(height);
        let mut square = Scene::clone(&self.scene);
        square.image = Image {
            width: side,
            height: side,
            ..square.image
        };
        let fine = self.picture(&square, control)?;
        // The shares of the fine rows (or columns) in one of the picture.
        let parts = |at: u32, of: u32| {
            let scale = f64::from(side) / f64::from(of);
            let (start, end) = (f64::from(at) * scale, f64::from(at + 1) * scale);
            let last = (end.ceil() as u32).min(side);
            (start.floor() as u32..last).map(move |fine| {
                let overlap = end.min(f64::from(fine) + 1.0) - start.max(f64::from(fine));
                (fine, overlap / scale)
            })
        };
        let pixel = |x, y| {
            let mut sum = DVec3::ZERO;
            for (row, share) in parts(y, height) {
                for (column, other) in parts(x, width) {
                    sum += DVec3::from(fine.pixel(column, row)) * (share * other);
                }
            }
            sum.to_array()
        };
        Ok(Film::from_fn(width, height, pixel)?)
    }

    /// A scene of the whole picture's size in this one's.
    fn sized(&self, scene: &Scene) -> Scene {
        match self.factor {
            1 => scene.clone(),
            factor => resized(scene, [self.a.width(), self.a.height()], factor),
        }
    }
}

/// One sample in each pixel, at an offset from its centre.
pub fn sampled(scene: &Scene, offset: DVec2, control: &Control) -> Result<Film, RenderError> {
    let world = World::new_unless(scene, control.cancel)?;
    let colors: Vec<_> = world
        .palette()
        .iter()
        .map(|color| color.to_linear())
        .collect();
    let (width, height) = (scene.image.width, scene.image.height);
    let mut film = Film::new(width, height)?;
    let row = |y| {
        if control.cancel.load(Ordering::Relaxed) {
            return Err(RenderError::Cancelled);
        }
        let row = (0..width).map(|x| colors[world.slot_at(x, y, offset)]);
        Ok(row.collect())
    };
    let rows: Vec<Vec<_>> = threads::install(control.threads, || {
        (0..height)
            .into_par_iter()
            .map(row)
            .collect::<Result<_, _>>()
    })??;
    for (y, row) in (0..).zip(rows) {
        film.put(
            Area {
                x: 0,
                y,
                width,
                height: 1,
            },
            &row,
        );
    }
    Ok(film)
}

/// A grid of so many samples in each pixel of a scene's picture.
pub fn grid(scene: &Scene, samples: u64) -> Sampling {
    let sampler = Sampler {
        method: Method::Regular,
        count: Count::PerPixel(samples),
        seed: 0,
    };
    Sampling::new(&sampler, scene.image.width, scene.image.height)
}

/// Each number of a picture through a curve.
pub fn map(film: &Film, curve: impl Fn(f64) -> f64) -> Result<Film, TooLarge> {
    Film::from_fn(film.width(), film.height(), |x, y| {
        film.pixel(x, y).map(&curve)
    })
}

/// A picture turned, and its light taken through a curve.
pub fn turned(film: &Film, turn: Turn, curve: Curve) -> Result<Film, TooLarge> {
    map(&turn(film)?, curve.to)
}

/// The middle of a scene's picture in pixels `factor` times as large.
fn resized(scene: &Scene, [width, height]: [u32; 2], factor: u32) -> Scene {
    let mut scene = with_distance(scene, distance(scene));
    let rows = f64::from(height) * f64::from(factor);
    scene.camera.view_height *= rows / f64::from(scene.image.height);
    scene.image = Image {
        width,
        height,
        ..scene.image
    };
    scene
}

/// The distance of the view plane, in metres.
pub fn distance(scene: &Scene) -> f64 {
    match scene.camera.lens {
        Lens::Distance(d) => d,
        Lens::Fov(_) | Lens::HorizontalFov(_) => {
            Basis::new(&scene.camera, &scene.image).d.to_finite()
        }
    }
}

/// A scene with the view plane at another distance.
pub fn with_distance(scene: &Scene, d: f64) -> Scene {
    let mut scene = scene.clone();
    scene.camera.lens = Lens::Distance(d);
    scene
}

/// The camera's axes u, v and w, rounded, and the side of a pixel at depth 1.
pub fn axes(scene: &Scene) -> ([DVec3; 3], f64) {
    let basis = Basis::new(&scene.camera, &scene.image);
    let rounded = |v: &[Big; 3]| DVec3::from(v.each_ref().map(Big::to_finite));
    (
        [&basis.u, &basis.v, &basis.w].map(rounded),
        basis.pitch.to_f64(),
    )
}

/// Where pixels see the floor, the plane of the first checkerboard.
struct Floor {
    axes: [DVec3; 3],
    pitch: f64,
    eye: DVec3,
    y: f64,
    square: f64,
    half: DVec2,
}

impl Floor {
    fn new(scene: &Scene) -> Self {
        let (axes, pitch) = axes(scene);
        let board = super::board::boards(scene).next();
        let (y, square) = board.map_or((0.0, 1.0), |(_, board)| (board.y, board.square));
        Self {
            axes,
            pitch,
            eye: scene.camera.eye,
            y,
            square,
            half: DVec2::new(f64::from(scene.image.width), f64::from(scene.image.height)) / 2.0,
        }
    }

    /// The point (x, z) that a pixel's centre sees, in squares, if the floor is in front of it.
    fn point(&self, x: u32, y: u32) -> Option<DVec2> {
        let at = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) - self.half;
        let [u, v, w] = self.axes;
        let ray = (u * at.x - v * at.y) * self.pitch - w;
        let t = (self.y - self.eye.y) / ray.y;
        let point = self.eye + t * ray;
        (t > 0.0 && t.is_finite()).then_some(DVec2::new(point.x, point.z) / self.square)
    }
}
