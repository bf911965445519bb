//! Scenes of numbers of all sizes, as text: whatever can be said is rendered, and no channel is anything but a number from 0 to 1.
//!
//! The tests ask thousands; `PINHOLE_SCENES=10000000 cargo test extremes` asks ten million, for some hours.

use std::{fmt::Write, num::NonZero};

use glam::{DVec2, dvec3};
use pinhole::{
    area::Area,
    film::Film,
    render::{self, Control, render_exact},
    sampling::Sampling,
    scene::{self, Count, Method, Scene},
    source::{Source, Sources},
    tracer::World,
};

use crate::{
    culling::one_by_one,
    effort::{Effort, sampled_and_exhaustive},
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
        write!(text, "camera {{ eye {} ", self.vector()).unwrap();
        let view = ["direction", "lookat"][self.below(2) as usize];
        write!(text, "{view} {} ", self.vector()).unwrap();
        let maybe = |numbers: &mut Self| numbers.below(3) == 0;
        if maybe(self) {
            write!(text, "up {} ", self.vector()).unwrap();
        }
        if maybe(self) {
            write!(text, "roll {:?}deg ", 90.0 * self.number()).unwrap();
        }
        match self.below(3) {
            0 => write!(text, "d {:?} ", self.length()).unwrap(),
            1 => write!(text, "fov {:?}deg ", 45.0 * self.length()).unwrap(),
            _ => {}
        }
        if maybe(self) {
            write!(text, "near {:?} ", self.length()).unwrap();
        }
        if maybe(self) {
            write!(text, "far {:?} ", self.length()).unwrap();
        }
        writeln!(
            text,
            "}}\nsampler {{ method random per_pixel {SAMPLES} seed {} }}",
            self.below(1000)
        )
        .unwrap();
        for _ in 0..self.below(6) {
            self.object(&mut text);
        }
        text
    }

    fn object(&mut self, text: &mut String) {
        let color = self.color();
        let line = match self.below(4) {
            0 => format!(
                "sphere {{ center {} radius {:?} color {color} }}",
                self.vector(),
                self.length()
            ),
            1 => {
                let [a, b] = [0; 2].map(|_: u32| self.length());
                // No longer than the other two together, and often just as long.
                let c = match self.below(3) {
                    0 => a + b,
                    1 => (a - b).abs(),
                    _ => a.max(b),
                };
                format!(
                    "triangle {{ centroid {} normal {} sides ({a:?}, {b:?}, {c:?}) spin {:?}deg color {color} }}",
                    self.vector(),
                    self.vector(),
                    90.0 * self.number()
                )
            }
            2 => format!(
                "box {{ center {} size ({:?}, {:?}, {:?}) color {color} }}",
                self.vector(),
                self.length(),
                self.length(),
                self.length()
            ),
            _ => format!(
                "checkerboard {{ y {:?} square {:?} colors ({color}, {}) }}",
                self.number(),
                self.length(),
                self.color()
            ),
        };
        writeln!(text, "{line}").unwrap();
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
    let control = Control {
        threads: NonZero::new(1),
        ..Control::default()
    };
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

fn read(text: &str) -> Scene {
    let sources = Sources::new(Source::from_text("a.scn", text));
    scene::read(&sources).scene.unwrap()
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
        let sources = Sources::new(Source::from_text("a.scn", text.as_str()));
        if let Some(scene) = scene::read(&sources).scene {
            rendered += 1;
            render(&scene, &text, is_decided);
        }
    }
    assert!(rendered >= count / 3, "{rendered} of {count}");
}

sampled_and_exhaustive!(a_pixel_does_not_depend_on_the_crop);

/// Whatever part of the picture is asked for, a pixel's candidates are those of one grid.
fn a_pixel_does_not_depend_on_the_crop(effort: Effort) {
    let control = Control {
        threads: NonZero::new(1),
        ..Control::default()
    };
    let mut compared = 0;
    let count = effort.part_of(9600) as u64;
    for seed in 0..count {
        let mut numbers = Numbers::new(seed);
        let sources = Sources::new(Source::from_text("a.scn", numbers.scene()));
        let Some(mut scene) = scene::read(&sources).scene else {
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

/// Planes that are one in hundreds of bits but not in more; a view so wide that Z is no normal number, before a near plane; a board that an
/// arc with a weight out of the range of numbers cuts.
#[test]
fn numbers_at_the_ends_of_their_range() {
    for text in [
        "image { width 1 height 3 background olive }
         camera {
             eye (-5e-324, 3.3381639243931894e66, -9361.924398029163)
             lookat (4050288887262.404, 0, 0) d 2978899169125.1675
         }
         sampler { method random per_pixel 64 seed 624 }
         checkerboard { y 2.2250738585072014e-308 square 1.2181708731575115e-44 colors (white, #012345) }
         checkerboard { y 9361.924398029163 square 1.0476640477433287e257 colors (#012345, red) }",
        "image { width 1 height 1 background #012345 }
         camera {
             eye (-1.0000000000000004, 5e-324, -5e-324)
             lookat (2.2250738585072014e-308, 1.7976931348623157e308, -2.2250738585072014e-308)
             d 5e-324 near 2.2250738585072014e-308
         }
         sampler { method random per_pixel 64 seed 325 }
         box {
             center (-2.2250738585072014e-308, 1.1569846590502684e-11, -1.4928749380437587e-266)
             size (2.4134299687027053e17, 9.581610938194515e253, 2.0669146701027507e-246) color red
         }",
        "image { width 1 height 2 background #012345 }
         camera {
             eye (-5e-324, 6.017102002826018e-16, 1e-323)
             direction (-1.7976931348623157e308, 9.780116474456474e135, -5e-324) d 5e-324
         }
         sampler { method random per_pixel 64 seed 24 }
         checkerboard { y 0 square 2.225073858507201e-308 colors (red, olive) }
         sphere { center (3.3788900381063465e18, -9.5e152, -1.7976931348623157e308) radius 1.7976931348623157e308 color #012345 }",
    ] {
        render(&read(text), text, false);
    }
}

/// A face of a box some 1e-157 m from the eye that looks along it; the eye as close inside of a sphere that is a plane, before a far plane.
#[test]
fn surfaces_next_to_the_eye_hide_none_that_are_farther() {
    for text in [
        "image { width 1 height 3 background black }
         camera {
             eye (-1.375, 2.2792403242184486e-157, 0) direction (5.728277404885035e18, 2, -1.0828772186899993)
             fov 90.14124049522594deg
         }
         sampler { method random per_pixel 64 seed 431 }
         checkerboard { y 1.625 square 4 colors (red, black) }
         box { center (-2.20258731564851, 1, -1) size (2.5229940151210704, 2, 2) color black }",
        "image { width 1 height 1 background red }
         camera {
             eye (-1.4400948323844044e-123, 5e-324, -5.891752382539124e49)
             lookat (5e-324, 1.7976931348623157e308, -1.4400948323844046e-123) far 1.7976931348623155e308
         }
         sampler { method random per_pixel 64 seed 15 }
         sphere { center (-1.7976931348623157e308, 0, 5e-324) radius 1.7976931348623157e308 color black }",
        "image { width 3 height 2 background red }
         camera {
             eye (2.033051027204003, 3.0322417127975214, 2.2250738585072014e-308)
             lookat (-1.981158728347209, -2.8181625723516945, -1)
             d 2.2250738585072014e-308 far 5.366531308989971e-12
         }
         sampler { method random per_pixel 64 seed 529 }
         box {
             center (5.716374985185332e-5, 3.25, -2.1128630514894749e-7)
             size (3.3250148901145167, 2, 0.50616931698793) color olive
         }
         sphere { center (2.2746313737473036, 0, -0.375) radius 0.8301405841253926 color white }
         box { center (0, -2, 1) size (2.25, 3.3238474424977014, 2) color #012345 }",
    ] {
        render(&read(text), text, true);
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
        let control = Control {
            threads: NonZero::new(1),
            ..Control::default()
        };
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

/// A pixel in doubt of which every quarter holds smaller and smaller pieces that are known no better ends nevertheless.
#[test]
#[ignore = "exhaustive"]
fn what_quarters_do_not_mend_is_left_in_doubt() {
    let text = "image { width 2 height 3 background olive }
        camera {
          eye (0.4329846651823165, 8.082295773346728e-42, 3.663700849918921e-17)
          lookat (0, -1.0000000000000002, 4.573506416522241e212)
          d 5e-324
        }
        sphere {
          center (7.800537973684832e238, -1.0000000000000002, 2611905.4745264417)
          radius 7.315898598278973e-10
          color black
        }
        triangle {
          centroid (4.664825139693755e-7, 0, 5e-324)
          normal (-60642909.83607577, -2.226370637041624, 2.2250738585072014e-308)
          sides (1.7976931348623157e308, 5e-324, 1.7976931348623157e308)
          spin 1.5950348447970576e-5deg
          color white
        }
        sphere {
          center (-2.130586840912591e-18, 2.2250738585072014e-308, 1.2555945330501196e-45)
          radius 5e-324
          color white
        }";
    render(&read(text), text, true);
}
