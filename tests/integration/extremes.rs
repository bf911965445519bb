//! Tests of scenes with numbers of any magnitude. Every valid scene is rendered, and every channel
//! of its picture is finite and from 0 to 1.
//!
//! A normal run renders 150 scenes. The ignored, exhaustive test renders 1200.
//! `PINHOLE_SCENES=10000000 cargo test extremes` renders ten million scenes, which takes hours.

use std::num::NonZero;

use glam::{DVec2, dvec3};
use pinhole::{
    area::Area,
    film::Film,
    render::{Control, render, render_exact},
    scene::{Count, Method, Scene},
    tracer::World,
};

use crate::{
    culling::one_by_one,
    effort::{Effort, sampled_and_exhaustive},
    generated::{Numbers, generated},
    random::Random,
    scenes::{exact, one_thread, read, rendered, resized, sampling, scenes, whole, with_samples},
    table::list,
};

/// Number of generated scenes in an exhaustive run, unless the environment variable
/// `PINHOLE_SCENES` gives another. A normal run renders an eighth of them. More scenes would find
/// rarer errors, but the tests would take longer.
const SCENES: usize = 1200;

/// Number of random samples per pixel whose mean is compared with the exact mean. With 64 samples,
/// chance alone practically never causes a difference of more than [`FAR`]; more samples would take
/// longer.
const SAMPLES: u64 = 64;

/// Maximum difference between the mean of the [`SAMPLES`] samples of a pixel and the exact mean.
/// Light is from 0 to 1. By Hoeffding's inequality, chance causes a greater difference only once in
/// 10^13 means, so such a difference is an error of the program.
const FAR: f64 = 0.49;

/// Percentages of the numbers in a scene that may have any magnitude ([`Numbers::Wild`]). Each
/// percentage is used for a quarter of the generated scenes. With 0, scenes are ordinary; with 100,
/// all numbers may be extreme.
const WILD: [u64; 4] = [0, 5, 30, 100];

fn assert_light(film: &Film, text: &str) {
    for light in film.pixels() {
        let is_light = light.iter().all(|channel| (0.0..=1.0).contains(channel));
        assert!(is_light, "{light:?} of\n{text}");
    }
}

/// Renders a scene with culling, sample by sample, and exactly, and compares the three pictures. If
/// `is_decided` is false, the samples are not compared with the exact picture. A distant
/// checkerboard may have squares so small that the rounding of a hit decides which colour a sample
/// has.
fn render_in_each_way(scene: &Scene, text: &str, is_decided: bool) {
    let control = one_thread();
    let (world, sampling, whole) = (World::new(scene), sampling(scene), whole(scene));
    let culled = render(&world, &sampling, whole, &control).unwrap();
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

sampled_and_exhaustive!(channels_stay_between_0_and_1_for_scenes_of_any_numbers);

fn channels_stay_between_0_and_1_for_scenes_of_any_numbers(effort: Effort) {
    let asked = std::env::var("PINHOLE_SCENES").ok();
    let count = match effort {
        _ if asked.is_some() => asked.unwrap().parse().unwrap(),
        Effort::Sample => SCENES / 8,
        Effort::Exhaustive => SCENES,
    };
    for (seed, wild) in (0..).zip(WILD) {
        for (part, size) in (0..).zip([[3, 2], [1, 3], [2, 1]]) {
            let scenes = generated(Numbers::Wild(wild), size, 3 * seed + part);
            for (text, scene) in scenes.take(count.div_ceil(12)) {
                let scene = with_samples(&scene, Method::Random, Count::PerPixel(SAMPLES));
                render_in_each_way(&scene, &text, wild == 0 || !text.contains("checkerboard"));
            }
        }
    }
}

sampled_and_exhaustive!(a_pixel_does_not_depend_on_the_crop);

/// A pixel has the same value for any crop and any number of threads.
fn a_pixel_does_not_depend_on_the_crop(effort: Effort) {
    let control = one_thread();
    let others = Control {
        threads: NonZero::new(3),
        ..Control::default()
    };
    let mut random = Random::new(1);
    let count = match effort {
        Effort::Sample => 5,
        Effort::Exhaustive => 128,
    };
    for (seed, wild) in (0..).zip(WILD) {
        let scenes = generated(Numbers::Wild(wild), [1, 1], seed);
        for (index, (_, mut scene)) in scenes.take(count).enumerate() {
            if index % 5 == 0 {
                // The eye is so far away that, after rounding, the difference between the eye and a
                // point near the origin no longer depends on the point.
                scene.camera.eye = dvec3(3e267, -3e267, 1e267) * random.within(0.0, 1.0);
            }
            // Most of these pictures have more than 32 columns or rows. The tracer divides a
            // picture first into squares of 32 × 32 pixels, so these pictures extend over two
            // squares.
            let (width, height) = [(37, 3), (3, 35), (7, 9)][index % 3];
            let scene = resized(scene, width, height);
            let mut below = |n: u32| random.bits() as u32 % n;
            let (x, y, n) = (below(width), below(height), below(9) + 1);
            let [width, height] = [width - x, height - y].map(|most| 1 + below(most));
            let crop = Area {
                x,
                y,
                width,
                height,
            };
            for method in Method::SAMPLED.into_iter().chain([Method::Exact]) {
                let scene = with_samples(&scene, method, Count::PerPixel(n.into()));
                let picture =
                    |part, control| rendered::<[f64; 3]>(&scene, part, control).into_film();
                let (all, part) = (picture(whole(&scene), &control), picture(crop, &others));
                assert_eq!(part, all.part(crop).unwrap(), "{crop} of {scene:?}");
            }
        }
    }
}

sampled_and_exhaustive!(scenes_at_the_limits_of_f64_render_alike_in_every_way);

/// Renders each scene of `tests/extremes` with culling, sample by sample, and exactly, and compares
/// the three pictures.
fn scenes_at_the_limits_of_f64_render_alike_in_every_way(effort: Effort) {
    for path in scenes("tests/extremes") {
        if effort == Effort::Sample
            && path.ends_with("a_pixel_that_quartering_does_not_improve.scn")
        {
            continue;
        }
        let text = std::fs::read_to_string(path).unwrap();
        render_in_each_way(&read(&text), &text, !text.contains("// not decided"));
    }
}

/// The picture has one pixel. The camera looks horizontally, with the eye 1/4 below a sphere.
/// Compared with the radius, this distance is tiny, so the sphere looks like a horizontal plane
/// above the eye, and covers about half of the pixel.
///
/// The sphere's silhouette is the upper branch of a hyperbola. The two branches run close above and
/// below the pixel's middle. For the largest radius, they are only 1e-154 pixels apart, which makes
/// the exact mean hard to compute.
#[test]
fn a_huge_sphere_that_touches_the_eye_covers_half_a_pixel() {
    for radius in ["1e3", "1e10", "1e100", "1e200", "1.7976931348623157e308"] {
        let text = format!(
            "image {{ width 1 height 1 background black }}
             camera {{ eye (1.25, -0.25, 3.5) direction (1, 0, 0) }}
             sphere {{ center (1.25, {radius}, 3.5) radius {radius} color white }}"
        );
        let exact = exact(&read(&text));
        let bound = f64::from(exact.bounds[0]);
        // The eye is h = 1/4 below the lowest point of the sphere, whose radius is R. By default,
        // the window is 2 m high at a distance of 2 m. In the middle column, the silhouette then
        // appears √(2h/R) window heights above the middle; the assertion allows twice this height.
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

/// In an extremely wide view, the directions of rays near the picture's centre are tiny vectors
/// compared with those at its edge. The depths of surfaces along these rays are computed from tiny
/// numbers, and the nearest surface must still be found.
#[test]
fn the_nearest_surface_is_seen_at_the_centre_of_the_widest_views() {
    for view in [
        "direction (0, -1, 0) up (0, 0, -1)",
        "direction (0.3, -1, 0.2)",
    ] {
        for d in ["1e-30", "1e-80", "1e-100", "1e-150", "1e-300"] {
            for objects in list("
                sphere { center (1, 1.2, 2) radius 9 color red } sphere { center (1, 1.2, 2) radius 0.8 color white }
                box { center (1, 1.2, 2) size (9, 9, 9) color red } box { center (1, 1.2, 2) size (0.8, 0.9, 0.8) color white }
                checkerboard { square 1e9 colors (red, red) } triangle { centroid (1, 1.2, 2) normal (0, 1, 0) sides (90, 90, 90) color white }
            ") {
                let text = format!(
                    "image {{ width 1 height 1 }} camera {{ eye (1, 1.4, 2) {view} d {d} far 100 }} {objects}"
                );
                let world = World::new(&read(&text));
                let seen = world.color_index_at(0, 0, DVec2::ZERO);
                assert_eq!(world.palette()[seen].to_linear(), [1.0; 3], "{text}");
            }
        }
    }
}
