//! Tests of tiny pictures of random scenes with extreme cameras and overlapping objects. Every way
//! to render a picture yields the same bits, and the exact picture agrees with samples.

use std::{
    num::NonZero,
    time::{Duration, Instant},
};

use glam::{DVec3, dvec3};
use pinhole::{
    area::Area,
    film::Film,
    render::{Control, Exact, Rendered},
    scene::{self, Count, Method, Scene, Shape},
    schema::BLOCKS,
};

use crate::{
    exact::pixel,
    fuzz::each,
    random::Random,
    scenes::{one_thread, rendered, sources, whole, with_samples},
};

/// Generator of the texts of random objects. The objects often have points in common.
struct Text<'r> {
    random: &'r mut Random,
    /// Points of all objects written so far: vertices, centres, and points on surfaces.
    points: Vec<DVec3>,
    /// On average, one in `wild` numbers may have any magnitude; none if `wild` is 0.
    wild: u64,
}

impl Text<'_> {
    fn one_in(&mut self, n: u64) -> bool {
        n > 0 && self.random.bits().is_multiple_of(n)
    }

    /// Returns a positive number from 10^−`decades` to 10^`decades`. Its logarithm is uniformly
    /// distributed.
    fn any_size(&mut self, decades: f64) -> f64 {
        libm::exp10(self.random.within(-decades, decades))
    }

    fn number(&mut self, size: f64) -> f64 {
        let ordinary = self.random.within(-size, size);
        if self.one_in(self.wild) {
            let decades = *self.random.one_of(&[3.0, 20.0, 300.0]);
            return ordinary.signum() * self.any_size(decades);
        }
        match self.random.bits() % 4 {
            0 => ordinary,
            1 => ordinary.round(),
            _ => (2.0 * ordinary).round() / 2.0,
        }
    }

    fn length(&mut self, size: f64) -> f64 {
        match self.number(size).abs() {
            0.0 => 1.0,
            length => length,
        }
    }

    /// Returns a point that other objects use, a point near such a point, or a new point.
    fn point(&mut self) -> DVec3 {
        let new = dvec3(self.number(3.0), self.number(3.0), self.number(3.0));
        if self.points.is_empty() || self.one_in(3) {
            return new;
        }
        let known = *self.random.one_of(&self.points);
        let step = *self
            .random
            .one_of(&[0.0, 0.0, 1e-300, 1e-15, 1e-9, 1e-3, 0.5]);
        match self.random.bits() % 4 {
            0 => known,
            1 => known + step * new,
            2 => dvec3(new.x, known.y, new.z),
            _ => known.map(|x| x + step),
        }
    }

    fn color(&mut self) -> &'static str {
        self.random.one_of::<&str>(&[
            "black", "white", "red", "olive", "teal", "#0102fe", "orange",
        ])
    }

    fn object(&mut self) -> String {
        let (color, other, p) = (self.color(), self.color(), self.point());
        let shape = match self.random.bits() % 8 {
            0 | 1 => {
                let radius = self.length(1.5);
                self.points.push(p + radius * DVec3::X);
                format!("sphere {{ center {} radius {radius:?}", vector(p))
            }
            2 | 3 => {
                let (v1, mut v2) = (self.point(), self.point());
                if self.one_in(3) {
                    // The triangle becomes a sliver, since its vertices lie nearly on a line.
                    let thickness = *self.random.one_of(&[1e-15, 1e-9, 1e-3]);
                    v2 = p + self.random.within(-1.0, 2.0) * (v1 - p) + thickness * v2;
                }
                self.points.extend([v1, p.lerp(v1, 0.5), p.lerp(v2, 0.25)]);
                let [v1, v2] = [v1, v2].map(vector);
                format!("triangle {{ v0 {} v1 {v1} v2 {v2}", vector(p))
            }
            4 => {
                let (a, b, normal) = (self.length(2.0), self.length(2.0), self.point());
                let c = *self
                    .random
                    .one_of(&[a, b, a + b, (a - b).abs(), (a + b) * (1.0 - 1e-12)]);
                let (p, normal, spin) = (vector(p), vector(normal), self.number(200.0));
                format!(
                    "triangle {{ centroid {p} normal {normal} sides ({a:?}, {b:?}, {c:?}) spin {spin:?}deg"
                )
            }
            5 | 6 => {
                let size = dvec3(self.length(2.0), self.length(2.0), self.length(2.0));
                self.points.extend([p + size, p + 0.5 * size]);
                format!("box {{ min {} max {}", vector(p), vector(p + size))
            }
            _ => {
                let square = match self.random.bits() % 4 {
                    0 => self.any_size(20.0),
                    1 => self.any_size(3.0),
                    _ => self.length(2.0),
                };
                let y = p.y;
                return format!(
                    "checkerboard {{ y {y:?} square {square:?} colors ({color}, {other}) }}\n"
                );
            }
        };
        self.points.push(p);
        format!("{shape} color {color} }}\n")
    }

    fn camera(&mut self) -> String {
        let (eye, at) = (self.point(), self.point());
        let toward = if self.one_in(3) { at } else { at - eye };
        let mut camera = format!("eye {} direction {}", vector(eye), vector(toward));
        let beside = *self.random.one_of(&[1e-300, 1e-15, 1e-6]) * self.point();
        let up = *self
            .random
            .one_of(&[toward, -toward, toward + beside, self.points[0]]);
        if self.one_in(3) {
            camera += &format!(" up {}", vector(up));
        }
        if self.one_in(3) {
            camera += &format!(" roll {:?}deg", 90.0 * self.number(2.0));
        }
        let degrees = match self.random.bits() % 4 {
            0 => 180.0 - self.any_size(10.0).min(90.0),
            1 => self.any_size(9.0).min(170.0),
            _ => self.random.within(1.0, 179.0),
        };
        let (d, height) = (self.any_size(6.0), self.any_size(6.0));
        camera += &match self.random.bits() % 4 {
            0 => format!(" d {d:?} view_height {height:?}"),
            1 => format!(" hfov {degrees:?}deg"),
            _ => format!(" fov {degrees:?}deg"),
        };
        for clip in ["near", "far"] {
            if self.one_in(4) {
                // The near or far plane often passes through a point that objects have in common.
                let point = self.point();
                let depth = (point - eye).dot(toward.normalize_or(DVec3::X)).abs();
                let depth =
                    *self
                        .random
                        .one_of(&[depth, depth.next_up(), self.points[0].x.abs() + 1.0]);
                camera += &format!(" {clip} {depth:?}");
            }
        }
        camera
    }
}

fn vector(DVec3 { x, y, z }: DVec3) -> String {
    format!("({x:?}, {y:?}, {z:?})")
}

/// Returns the text of a random scene without errors, and the scene itself.
fn random_scene(random: &mut Random) -> (String, Scene) {
    loop {
        let most = [3, 3, 10, 60][random.bits() as usize % 4];
        // A pixel with many objects takes long to compute, so a scene with many objects has a
        // smaller picture.
        let [columns, rows] = if most > 3 { [4, 3] } else { [12, 8] };
        let (width, height) = (1 + random.bits() % columns, 1 + random.bits() % rows);
        let (count, wild) = (random.bits() % (most + 1), [0, 0, 30, 5]);
        let wild = wild[random.bits() as usize % 4];
        let mut text = Text {
            random,
            points: vec![DVec3::ZERO],
            wild,
        };
        let objects: String = (0..count).map(|_| text.object()).collect();
        let (background, camera) = (text.color(), text.camera());
        let text = format!(
            "image {{ width {width} height {height} background {background} }}\ncamera {{ {camera} }}\n{objects}"
        );
        if let Some(scene) = scene::read(&sources(&text)).scene {
            return (text, scene);
        }
    }
}

/// `random_scenes_render_alike_in_parts_and_agree_with_samples` tests only the kinds of objects
/// that random scenes contain, so every kind must occur in them.
#[test]
fn every_kind_of_object_is_in_random_scenes() {
    let mut random = Random::new(1);
    let scenes: Vec<Scene> = (0..64).map(|_| random_scene(&mut random).1).collect();
    for row in BLOCKS.iter().filter(|row| row.is_object) {
        let mut objects = scenes.iter().flat_map(|scene| scene.objects.iter());
        let is_of_kind = |object: &scene::Object| object.shape.kind() == row.name;
        assert!(objects.any(is_of_kind), "{}", row.name);
    }
}

fn three_threads() -> Control<'static> {
    Control {
        threads: NonZero::new(3),
        ..Control::default()
    }
}

/// Divides the picture at a random column and row into four parts. Asserts that the whole picture,
/// rendered by one thread, has the same bits as the parts, rendered by three threads. Returns the
/// whole picture.
fn assert_parts_agree(scene: &Scene, random: &mut Random, text: &str) -> Rendered {
    let area = whole(scene);
    let picture: Rendered = rendered(scene, area, &one_thread());
    let [column, row] = [area.width, area.height].map(|size| random.bits() as u32 % (size + 1));
    for (x, width) in [(0, column), (column, area.width - column)] {
        for (y, height) in [(0, row), (row, area.height - row)] {
            let part = Area {
                x,
                y,
                width,
                height,
            };
            if part.pixels() > 0 {
                let crop = rendered(scene, part, &three_threads());
                let what = format!("{part:?}, {:?}: {text}", scene.sampler.method);
                assert_same_bits(&picture, part, &crop, &what);
            }
        }
    }
    picture
}

/// Asserts that the picture `crop` has the same bits as the area `part` of the picture `one`, both
/// in its pixels and in its error bounds.
#[track_caller]
fn assert_same_bits(one: &Rendered, part: Area, crop: &Rendered, what: &str) {
    let numbers = |picture: &Rendered, x, y| {
        let film: &Film = picture.film();
        let bound = match picture {
            Rendered::Exact(exact) => exact.bounds[(y * film.width() + x) as usize],
            Rendered::Sampled(_) => 0.0,
        };
        (film.pixel(x, y).map(f64::to_bits), bound.to_bits())
    };
    for (x, y) in part.iter() {
        let (one, other) = (numbers(one, x, y), numbers(crop, x - part.x, y - part.y));
        assert_eq!(one, other, "pixel {x}, {y}; {what}");
    }
}

/// Returns whether the exact picture of a scene can be compared with samples. It cannot if a board
/// has squares below 10⁻⁹⁰ of the eye's height above the board. Samples of such a board show only
/// one of its two colours, whereas the exact picture shows their mean.
fn is_comparable(scene: &Scene) -> bool {
    scene.objects.iter().all(|object| match &object.shape {
        Shape::Checkerboard(board) => {
            let height = (board.y - scene.camera.eye.y).abs();
            height == 0.0 || board.square / height > 1e-90
        }
        _ => true,
    })
}

/// Compares each pixel of an exact picture, and the mean of all pixels, with independent samples.
/// The allowed difference is so large that chance practically never exceeds it.
///
/// Light is from 0 to 1. If the true mean μ differs from the computed mean m by at most b, the
/// variance of a sample is at most
///     m·(1 − m) + b,
/// because μ·(1 − μ) has a slope of at most 1. Let V be the sum of the variances of N samples. By
/// Bernstein's inequality, the mean of the samples differs from μ by more than
///     √(2·L·V)/N + 2·L/(3·N)
/// with a probability of at most 2·e^−L. L is chosen such that this is 3e-18. A picture has at most
/// 96 pixels, so 97 means are compared in each of three channels. The probability that chance makes
/// any of 10⁶ pictures fail is then at most 1e-9.
fn assert_agrees_with_samples(scene: &Scene, exact: &Exact, text: &str) {
    let area = whole(scene);
    let each = (1 << 15) / area.pixels();
    let sampled = with_samples(scene, Method::Random, Count::PerPixel(each));
    let sampled: Rendered = rendered(&sampled, area, &one_thread());
    let log = -libm::log(1.5e-18);
    let most = |n: f64, variances: f64| (2.0 * log * variances).sqrt() / n + 2.0 * log / (3.0 * n);
    for channel in 0..3 {
        let (mut sum, mut bounds, mut variances) = (0.0_f64, 0.0, 0.0);
        for (x, y) in area.iter() {
            let (light, bound) = pixel(exact, x, y);
            let (mean, found) = (light[channel], sampled.film().pixel(x, y)[channel]);
            let variance = each as f64 * ((mean * (1.0 - mean)).max(0.0) + bound).min(0.25);
            let most = bound + most(each as f64, variance) + 1e-12;
            let difference = (mean - found).abs();
            assert!(
                difference <= most,
                "pixel {x}, {y}: {mean} ± {bound}, and {found} of {each} samples: {text}"
            );
            (sum, bounds, variances) = (sum + mean - found, bounds + bound, variances + variance);
        }
        let pixels = area.pixels() as f64;
        let most = bounds / pixels + most(pixels * each as f64, variances) + 1e-12;
        assert!(
            sum.abs() / pixels <= most,
            "{sum} of {most} in the sum of all pixels: {text}"
        );
    }
}

#[test]
fn random_scenes_render_alike_in_parts_and_agree_with_samples() {
    each(4, |random| {
        let (text, scene) = random_scene(random);
        let count = match random.bits() % 3 {
            0 => Count::Total(1 + random.bits() % 300),
            _ => Count::PerPixel(1 + random.bits() % 20),
        };
        for method in Method::SAMPLED {
            assert_parts_agree(&with_samples(&scene, method, count), random, &text);
        }
        let start = Instant::now();
        let computed = with_samples(&scene, Method::Exact, Count::PerPixel(1));
        let Rendered::Exact(exact) = assert_parts_agree(&computed, random, &text) else {
            panic!("not computed");
        };
        // The test computes each exact pixel twice: for the whole picture, and for one of the four
        // parts. On an idle machine, an optimized build takes at most two seconds for both. The
        // limit of 20 seconds per pixel allows for slower builds and busy machines.
        let (time, pixels) = (start.elapsed(), whole(&scene).pixels() as u32);
        assert!(time < pixels * Duration::from_secs(20), "{time:?}: {text}");
        if is_comparable(&scene) {
            assert_agrees_with_samples(&scene, &exact, &text);
        }
    });
}
