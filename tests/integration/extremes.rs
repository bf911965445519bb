//! Scenes of numbers of all sizes, as text: whatever can be said is rendered, and no channel is anything but a number from 0 to 1.
//!
//! The tests ask thousands; `PINHOLE_SCENES=10000000 cargo test extremes` asks ten million, for some hours.

use glam::{DVec2, dvec3};
use pinhole::{
    area::Area,
    film::Film,
    render::{self, render_exact},
    sampling::Sampling,
    scene::{self, Count, Method, Scene},
    tracer::World,
};

use crate::{
    culling::one_by_one,
    effort::{Effort, sampled_and_exhaustive},
    scenes::{one_thread, read, scenes, sources},
    tracer::Random,
};

/// How many scenes are made unless the environment says otherwise. Two fifths of them have no mistake.
const SCENES: u64 = 3000;

/// Samples a pixel, at random.
const SAMPLES: u64 = 64;

/// How far a mean of the samples may be from what it estimates: farther at one of 10^13 (Hoeffding's inequality for numbers from 0 to 1).
const FAR: f64 = 0.49;

/// Numbers for a scene, of which most are ordinary or few.
struct Numbers {
    random: Random,
    /// How many of a hundred numbers may be of any size.
    wild: u64,
    /// Lengths that several things of the scene have.
    shared: [f64; 3],
}

impl Numbers {
    fn new(seed: u64) -> Self {
        let mut random = Random::new(seed);
        let wild = [0, 5, 30, 100][random.bits() as usize % 4];
        let mut numbers = Self {
            random,
            wild,
            shared: [1.0; 3],
        };
        numbers.shared = [0; 3].map(|_| numbers.number());
        numbers
    }

    fn below(&mut self, n: u64) -> u64 {
        self.random.bits() % n
    }

    fn number(&mut self) -> f64 {
        let sign = [1.0, -1.0][self.below(2) as usize];
        if self.below(100) >= self.wild {
            return match self.below(4) {
                0 => self.below(5) as f64 - 2.0,
                1 => (self.below(65) as f64 - 32.0) / 8.0,
                _ => self.random.within(-5.0, 5.0),
            };
        }
        sign * match self.below(10) {
            0 => 5e-324,
            1 => f64::MIN_POSITIVE,
            2 => f64::MAX,
            3 => 0.0,
            4 => self.shared[self.random.bits() as usize % 3].next_up(),
            5 => self.shared[self.random.bits() as usize % 3],
            6 | 7 => libm::exp10(self.random.within(-20.0, 20.0)),
            _ => libm::exp10(self.random.within(-323.0, 308.0)),
        }
    }

    fn length(&mut self) -> f64 {
        self.number().abs()
    }

    fn vector(&mut self) -> String {
        let [x, y, z] = [0; 3].map(|_| self.number());
        format!("({x:?}, {y:?}, {z:?})")
    }

    fn color(&mut self) -> &'static str {
        ["black", "white", "red", "olive", "#012345"][self.below(5) as usize]
    }

    /// Up to five objects, a camera, and a picture of few pixels.
    fn scene(&mut self) -> String {
        let [width, height] = [0; 2].map(|_: u32| 1 + self.below(3));
        let mut text = format!(
            "image {{ width {width} height {height} background {} }}\n",
            self.color()
        );
        text += &format!("camera {{ eye {} ", self.vector());
        let view = ["direction", "lookat"][self.below(2) as usize];
        text += &format!("{view} {} ", self.vector());
        let maybe = |numbers: &mut Self| numbers.below(3) == 0;
        if maybe(self) {
            text += &format!("up {} ", self.vector());
        }
        if maybe(self) {
            text += &format!("roll {:?}deg ", 90.0 * self.number());
        }
        text += &match self.below(3) {
            0 => format!("d {:?} ", self.length()),
            1 => format!("fov {:?}deg ", 45.0 * self.length()),
            _ => String::new(),
        };
        for clip in ["near", "far"] {
            if maybe(self) {
                text += &format!("{clip} {:?} ", self.length());
            }
        }
        let seed = self.below(1000);
        text += &format!("}}\nsampler {{ method random per_pixel {SAMPLES} seed {seed} }}\n");
        for _ in 0..self.below(6) {
            text += &self.object();
        }
        text
    }

    fn object(&mut self) -> String {
        let color = self.color();
        match self.below(4) {
            0 => {
                let (center, radius) = (self.vector(), self.length());
                format!("sphere {{ center {center} radius {radius:?} color {color} }}\n")
            }
            1 => {
                let [a, b] = [0; 2].map(|_: u32| self.length());
                // No longer than the other two together, and often just as long.
                let c = match self.below(3) {
                    0 => a + b,
                    1 => (a - b).abs(),
                    _ => a.max(b),
                };
                let (centroid, normal, spin) = (self.vector(), self.vector(), 90.0 * self.number());
                format!(
                    "triangle {{ centroid {centroid} normal {normal} sides ({a:?}, {b:?}, {c:?}) spin {spin:?}deg color {color} }}\n"
                )
            }
            2 => {
                let center = self.vector();
                let [x, y, z] = [0; 3].map(|_: u32| self.length());
                format!("box {{ center {center} size ({x:?}, {y:?}, {z:?}) color {color} }}\n")
            }
            _ => {
                let (y, square, other) = (self.number(), self.length(), self.color());
                format!("checkerboard {{ y {y:?} square {square:?} colors ({color}, {other}) }}\n")
            }
        }
    }
}

fn assert_light(film: &Film, text: &str) {
    for light in film.pixels() {
        let is_light = light.iter().all(|channel| (0.0..=1.0).contains(channel));
        assert!(is_light, "{light:?} of\n{text}");
    }
}

/// Renders a scene culled, one by one and exactly. Whether the samples' squares are those that the exact picture sums up is decided but by
/// hundreds of bits where squares and places are numbers of all sizes, and not asked then.
fn render(scene: &Scene, text: &str, is_decided: bool) {
    let control = one_thread();
    let [width, height] = [scene.image.width, scene.image.height];
    let whole = Area::whole(width, height);
    let world = World::new(scene);
    let sampling = Sampling::new(&scene.sampler, width, height);
    let culled = render::render(&world, &sampling, whole, &control).unwrap();
    assert_light(&culled, text);
    let plain = one_by_one(&world, &sampling, whole);
    assert_eq!(culled.pixels(), plain.pixels(), "{text}");
    let exact = render_exact(&world, whole, &control).unwrap();
    assert_light(&exact.film, text);
    let pixels = exact.film.pixels().iter().zip(culled.pixels());
    for ((exact, sampled), &bound) in pixels.zip(&exact.bounds) {
        assert!(bound >= 0.0, "a bound of {bound} of\n{text}");
        for (exact, sampled) in exact.iter().zip(sampled) {
            assert!(
                !is_decided || (exact - sampled).abs() <= FAR + f64::from(bound),
                "{exact}, sampled {sampled}, of\n{text}"
            );
        }
    }
}

sampled_and_exhaustive!(whatever_the_numbers_every_channel_is_light);

fn whatever_the_numbers_every_channel_is_light(effort: Effort) {
    let scenes = match effort {
        Effort::Sample => SCENES / 8,
        Effort::Exhaustive => SCENES,
    };
    let asked = std::env::var("PINHOLE_SCENES").ok();
    let count = asked.map_or(scenes, |count| count.parse().unwrap());
    let mut rendered = 0;
    for seed in 0..count {
        let mut numbers = Numbers::new(seed);
        let text = numbers.scene();
        let is_decided = numbers.wild == 0 || !text.contains("checkerboard");
        if let Some(scene) = scene::read(&sources(&text)).scene {
            rendered += 1;
            render(&scene, &text, is_decided);
        }
    }
    assert!(rendered >= count / 3, "{rendered} of {count}");
}

sampled_and_exhaustive!(a_pixel_does_not_depend_on_the_crop);

/// Whatever part of the picture is asked for, a pixel's candidates are those of one grid.
fn a_pixel_does_not_depend_on_the_crop(effort: Effort) {
    let control = one_thread();
    let mut compared = 0;
    let count = effort.part_of(3200) as u64;
    for seed in 0..count {
        let mut numbers = Numbers::new(seed);
        let Some(mut scene) = scene::read(&sources(&numbers.scene())).scene else {
            continue;
        };
        if seed % 50 == 0 {
            // So far away that of what lies about the origin nothing is left.
            scene.camera.eye = dvec3(3e267, -3e267, 1e267) * numbers.random.within(0.0, 1.0);
        }
        // More than a square of the grid, but few pixels.
        let [width, height] = [(37, 3), (3, 35), (7, 9)][seed as usize % 3].into();
        (scene.image.width, scene.image.height) = (width, height);
        scene.sampler.count = Count::PerPixel(1 + numbers.below(9));
        let whole = Area::whole(width, height);
        let (x, y) = (numbers.below(width.into()), numbers.below(height.into()));
        let crop = Area {
            x: x as u32,
            y: y as u32,
            width: 1 + numbers.below(u64::from(width) - x) as u32,
            height: 1 + numbers.below(u64::from(height) - y) as u32,
        };
        let world = World::new(&scene);
        for method in Method::SAMPLED.into_iter().chain([Method::Exact]) {
            scene.sampler.method = method;
            let sampling = Sampling::new(&scene.sampler, width, height);
            let picture = |part: Area| match method {
                Method::Exact => render_exact(&world, part, &control).unwrap().film,
                _ => render::render(&world, &sampling, part, &control).unwrap(),
            };
            let (all, part) = (picture(whole), picture(crop));
            for (x, y) in crop.iter() {
                let here = part.pixel(x - crop.x, y - crop.y);
                assert_eq!(
                    here,
                    all.pixel(x, y),
                    "{seed}, {method:?}: {x}, {y} in {crop}"
                );
            }
            compared += 1;
        }
    }
    assert!(compared > 2 * count, "{compared}");
}

/// The scenes of `tests/extremes`.
#[test]
fn scenes_at_the_ends_of_the_range_of_numbers() {
    render_file(|name| name != SLOW);
}

#[test]
#[ignore = "exhaustive"]
fn what_quarters_do_not_mend_is_left_in_doubt() {
    render_file(|name| name == SLOW);
}

const SLOW: &str = "what_quarters_do_not_mend";

fn render_file(is_wanted: impl Fn(&str) -> bool) {
    for path in scenes("tests/extremes") {
        if is_wanted(path.file_stem().unwrap().to_str().unwrap()) {
            let text = std::fs::read_to_string(path).unwrap();
            render(&read(&text), &text, !text.contains("// not decided"));
        }
    }
}

/// Its conic's two branches, in front of the eye and behind it, are one line in any precision.
#[test]
fn a_sphere_that_is_a_plane_fills_half_a_pixel() {
    for radius in ["1e3", "1e10", "1e100", "1e200", "1.7976931348623157e308"] {
        let text = format!(
            "image {{ width 1 height 1 background black }}
             camera {{ eye (1.25, -0.25, 3.5) direction (1, 0, 0) }}
             sphere {{ center (1.25, {radius}, 3.5) radius {radius} color white }}"
        );
        let control = one_thread();
        let world = World::new(&read(&text));
        let exact = render_exact(&world, Area::whole(1, 1), &control).unwrap();
        let bound = f64::from(exact.bounds[0]);
        // The horizon is √(2h/R) above the middle, with the eye h from the surface; the view plane is as far as it is high.
        let above = libm::sqrt(0.5 / radius.parse::<f64>().unwrap());
        for channel in exact.film.pixels()[0] {
            assert!(
                (channel - 0.5).abs() <= 2.0 * above + bound,
                "{radius}: {channel}"
            );
        }
        assert!(bound < 1e-12, "{bound} of a radius of {radius}");
    }
}

/// There a ray's direction is next to nothing beside all others', and so are the numbers that its surfaces are compared by.
#[test]
fn in_the_middle_of_the_widest_views_the_nearest_surface_is_seen() {
    let spheres = "sphere { center (1, 1.2, 2) radius 9 color red }
                   sphere { center (1, 1.2, 2) radius 0.8 color white }";
    let boxes = "box { center (1, 1.2, 2) size (9, 9, 9) color red }
                 box { center (1, 1.2, 2) size (0.8, 0.9, 0.8) color white }";
    let planes = "checkerboard { y 0 square 1e9 colors (red, red) }
                  triangle { centroid (1, 1.2, 2) normal (0, 1, 0) sides (90, 90, 90) color white }";
    for view in [
        "direction (0, -1, 0) up (0, 0, -1)",
        "direction (0.3, -1, 0.2)",
    ] {
        for d in ["1e-30", "1e-80", "1e-100", "1e-150", "1e-300"] {
            for objects in [spheres, boxes, planes] {
                let text = format!(
                    "image {{ width 1 height 1 background black }}
                     camera {{ eye (1, 1.4, 2) {view} d {d} far 100 }}
                     {objects}"
                );
                let world = World::new(&read(&text));
                let seen = world.slot_at(0, 0, DVec2::ZERO);
                assert_eq!(world.palette()[seen].to_linear(), [1.0; 3], "{text}");
            }
        }
    }
}
