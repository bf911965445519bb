//! Tests that pictures traced with culling have the same bits as pictures traced sample by sample.
//! Culling traces the samples of a pixel together, against the objects that may be seen in it. The
//! tests of `tracer` compare pictures traced sample by sample with an independent, slow
//! computation.

use std::{
    collections::BTreeSet,
    fmt::Write,
    num::NonZero,
    ops::ControlFlow,
    sync::{
        Arc,
        atomic::{AtomicU64, Ordering},
    },
};

use glam::DVec3;
use pinhole::{
    render::{Control, render},
    scene::{Count, Method, Scene},
    tracer::{PicturePart, Quartering, Scratch, World},
};

#[path = "../../benches/one_by_one/mod.rs"]
mod one_by_one;

pub use self::one_by_one::one_by_one;

use crate::{
    effort::{Effort, sampled_and_exhaustive},
    generated::{Numbers, generated},
    random::Random,
    scenes::{example, example_names, read, sampled, sampling, whole, with_samples},
    table::rows,
};

/// Asserts that the picture of `scene` by culling has the same bits as the picture traced sample by
/// sample. Returns the number of different colours in the picture.
#[track_caller]
fn compare(scene: &Scene, method: Method, count: Count) -> usize {
    let scene = with_samples(scene, method, count);
    let (world, sampling) = (World::new(&scene), sampling(&scene));
    let done = AtomicU64::new(0);
    let control = Control {
        threads: NonZero::new(2),
        progress: &|more| {
            done.fetch_add(more, Ordering::Relaxed);
        },
        ..Control::default()
    };
    let culled = render(&world, &sampling, whole(&scene), &control).unwrap();
    let plain = one_by_one(&world, &sampling, whole(&scene));
    let is_equal = culled.pixels() == plain.pixels();
    assert!(is_equal, "not the picture one by one of {scene:?}");
    assert_eq!(done.into_inner(), sampling.total());
    let colors = plain.pixels().iter().map(|pixel| pixel.map(f64::to_bits));
    colors.collect::<BTreeSet<_>>().len()
}

sampled_and_exhaustive!(culling_is_exact_for_every_example_and_method);

fn culling_is_exact_for_every_example_and_method(effort: Effort) {
    for name in effort.first(6, example_names()) {
        let scene = example(&name, 43, 29);
        for method in Method::SAMPLED {
            let pixels = 43 * 29;
            for count in [
                Count::PerPixel(1),
                Count::PerPixel(9),
                Count::Total(7 * pixels + 400),
                Count::Total(pixels / 3),
            ] {
                compare(&scene, method, count);
            }
        }
    }
}

#[test]
fn culling_is_exact_for_sample_counts_around_chunk_sizes() {
    let scene = example("figure_9_9", 11, 7);
    for n in [3, 4, 5, 7, 8, 63, 64, 65, 130, 4095, 4096, 4097, 9000] {
        assert!(compare(&scene, Method::Sobol, Count::PerPixel(n)) > 10);
    }
}

#[test]
fn culling_is_exact_for_boards_of_small_and_large_squares() {
    for [view, boards, counts, colors] in rows(
        "
        -- A pixel's side on the floor is 1/32 when the eye looks down, so corners of pixels lie on every edge of a square: in each pixel beside one it is not certain by corners alone what is seen.
        256 (0, 4, 0) lookat (0, 0, 0) up (0, 0, -1) d 1 -> square 0.25 -> 1 5 -> 2
        256 (0, 4, 0) lookat (0, 0, 0) up (0, 0, -1) d 1 -> square 0.03125 -> 1 5 -> 2
        256 (0.015625, 4, 0) lookat (0.015625, 0, 0) up (0, 0, -1) d 1 -> square 0.25 -> 1 5 -> 2
        256 (1e6, 4, 0) lookat (1e6, 0, 0) up (0, 0, -1) d 1 -> square 0.09375 -> 1 5 -> 2
        -- Dense rows.
        32 (0.3, 2, 5) lookat (7, 1.8, -30) roll 3deg -> square 1 -> 40 -> 11
        32 (0.3, 2, 5) lookat (7, 1.8, -30) roll 3deg -> square 0.001 -> 40 -> 11
        32 (0.3, 2, 5) lookat (7, 1.8, -30) roll 3deg -> y 1 square 1e-6 -> 40 -> 11
        32 (0.3, 2, 5) lookat (7, 1.8, -30) roll 3deg -> y -5 square 300 -> 40 -> 11
    ",
    ) {
        let (side, eye) = view.split_once(' ').unwrap();
        let scene = read(&format!(
            "image {{ width {side} height {side} }} camera {{ eye {eye} }}
             checkerboard {{ {boards} }} sphere {{ center (2, 1, -1) }}"
        ));
        for n in counts.split(' ').map(|n| n.parse().unwrap()) {
            let found = compare(&scene, Method::Jittered, Count::PerPixel(n));
            assert!(found >= colors.parse().unwrap(), "{view}, {boards}: {found}");
        }
    }
}

#[test]
fn culling_is_exact_for_generated_scenes() {
    for wild in [0, 5, 30] {
        let scenes = generated(Numbers::Wild(wild), [24, 18], 2024).take(100);
        let scenes = scenes.zip(Method::SAMPLED.into_iter().cycle());
        let colors =
            scenes.map(|((_, scene), method)| compare(&scene, method, Count::PerPixel(24)));
        let colors: usize = colors.sum();
        // Ensures that the pictures are not nearly empty. Pixels at edges mix colours, so the
        // hundred pictures together must have more than a thousand colours. This is not required if
        // many numbers in the scenes have extreme magnitudes (`wild`).
        assert!(colors > 100 * 10 || wild > 5, "{wild}: {colors}");
    }
}

sampled_and_exhaustive!(culling_is_exact_for_scenes_full_of_ties);

fn culling_is_exact_for_scenes_full_of_ties(effort: Effort) {
    let scenes = generated(Numbers::MultiplesOf(0.5), [8, 8], 77);
    for (_, scene) in effort.first(60, scenes.take(300)) {
        // All numbers in the scenes are multiples of 1/2, and the samples form a regular grid. A
        // single sample lies at the pixel's centre; four samples lie 1/4 pixel from it along both
        // axes. Therefore, many samples hit edges exactly, and many rays lie in the planes of
        // surfaces.
        for n in [1, 4, 16] {
            compare(&scene, Method::Regular, Count::PerPixel(n));
        }
    }
}

/// Renders thousands of overlapping triangles. Half of them lie in a tilted plane, and half in the
/// plane of the checkerboard. One of the scenes has more triangles than the tracer's cache of
/// objects in high precision can keep.
#[test]
fn culling_is_exact_for_thousands_of_coplanar_triangles() {
    let mut random = Random::new(141);
    let mut place = || (random.bits() % 512) as f64 / 64.0 - 4.0;
    let mut few =
        "image { width 24 height 16 } camera { eye (1, 4, 9) lookat (0, 0, 0) }\n".to_owned();
    let mut many = String::new();
    for index in 0..4000 {
        let (a, b) = (place(), place());
        // Triangles of even index lie in the plane y = −z/3, and the others in the board's plane.
        // The normals of the triangles in one plane differ in length.
        let (centroid, normal) = match index % 2 {
            0 => ((a, b / 2.0, -1.5 * b), (0, 3, 1)),
            _ => ((a, 0.0, b), (0, 1, 0)),
        };
        let length = index % 5 + 1;
        for (text, length, blue) in [(&mut few, length, 0), (&mut many, 3 * length, 99)] {
            let _ = writeln!(
                text,
                "triangle {{ centroid {centroid:?} normal {length} * {normal:?} color rgb({}, {}, {blue}) }}",
                index % 256,
                index / 256
            );
        }
    }
    few += "checkerboard {}\n";
    // `many` becomes the scene `few`, followed by a copy of each triangle with another colour and a
    // longer normal. The copies are hidden, because only the first of coinciding triangles is
    // visible. So both scenes must give the same picture.
    many.insert_str(0, &few);
    let [few, many] = [&few, &many].map(|text| read(text));
    assert!(compare(&few, Method::Jittered, Count::PerPixel(4)) > 100);
    compare(&many, Method::Jittered, Count::PerPixel(4));
    let [few, many] = [few, many].map(|scene| sampled(&scene));
    assert_eq!(few.pixels(), many.pixels());
}

/// Returns the text of `count` spheres of different colours. Each coordinate of a centre is between
/// −`reach` and `reach`, and each radius between `low` and `high`.
pub fn spheres(random: &mut Random, count: u32, reach: f64, [low, high]: [f64; 2]) -> String {
    let sphere = |index| {
        let DVec3 { x, y, z } = random.vector(reach);
        let (radius, red, green) = (random.within(low, high), index % 256, index / 256);
        format!(
            "sphere {{ center ({x}, {y}, {z}) radius {radius} color rgb({red}, {green}, 9) }}\n"
        )
    };
    (0..count).map(sphere).collect()
}

#[test]
fn culling_is_exact_for_parallel_layers() {
    for (count, apart) in [(9, 0.1), (33, 0.1), (33, 1e-13), (33, 1e-30), (120, 0.05)] {
        let mut text = "image { width 24 height 18 } camera { eye (0.3, 0.2, 4) lookat (0, 0, 0) roll 10deg }\n".to_owned();
        for index in 0..count {
            // The layers are not listed in the order of their heights. Every third layer has the
            // same height as another one, so some of the objects coincide.
            let place = f64::from(index * 37 % count);
            let height = 1.0 + apart * (place - place % 3.0 % 2.0);
            let sign = if index % 2 == 0 { "-" } else { "" };
            let (odd, even) = (index % 200, index * 7 % 200);
            text += &format!(
                "checkerboard {{ y {sign}{height} square 0.7 colors (rgb({odd}, 0, 0), rgb(0, {even}, 9)) }}
                 triangle {{ centroid (0, 0, -{height}) normal (0.3, 0.2, 1) sides (3, 3, 3) color rgb(9, {odd}, {even}) }}\n"
            );
        }
        let mut all = read(&text);
        for (near, far) in [(0.0, None), (5.3, Some(40.0)), (5.0, Some(8.0))] {
            (all.camera.near, all.camera.far) = (near, far);
            for n in [1, 4, 16] {
                compare(&all, Method::Jittered, Count::PerPixel(n));
            }
        }
    }
}

#[test]
fn culling_is_exact_for_crowds_of_pixel_sized_objects() {
    let mut random = Random::new(12);
    let mut scenes = generated(Numbers::Wild(0), [1, 1], 31);
    let mut methods = Method::SAMPLED.into_iter().cycle();
    // If few objects may be seen in a pixel, the tracer evaluates several samples of the pixel at
    // once; otherwise, it traces them one by one. The pictures of 160 × 120 pixels test the first
    // way: their pixels are small, so few objects may be seen in each.
    for (roll, clips, size, counts) in [
        (0, "", "width 31 height 23", &[2, 4, 8, 9, 100][..]),
        (0, "near 5.5 far 8", "width 31 height 23", &[1, 3, 16]),
        (30, "", "width 31 height 23", &[1, 3, 16]),
        (45, "near 5.5 far 8", "width 31 height 23", &[1, 3, 16]),
        (0, "", "width 160 height 120", &[1, 3]),
        (45, "near 5.5 far 8", "width 160 height 120", &[4]),
    ] {
        let mut text = format!(
            "image {{ {size} }} camera {{ eye (0.5, 0.3, 7) lookat (0, 0, 0) roll {roll}deg {clips} }}\n"
        );
        text += &spheres(&mut random, 1 << 12, 2.5, [1e-4, 0.08]);
        for index in 0..1000 {
            let size = random.within(0.01, 0.08);
            let [at, normal] = [2.5, 1.0].map(|size| random.vector(size));
            let [at, normal] = [at, normal].map(|DVec3 { x, y, z }| format!("({x}, {y}, {z})"));
            let color = format!("rgb({}, {}, 99)", index % 256, index / 256);
            let _ = writeln!(
                text,
                "box {{ center {at} size {size} * (1, 2, 0.5) color {color} }}
                 triangle {{ centroid -{at} normal {normal} sides (0.1, 0.1, 0.05) color {color} }}"
            );
        }
        // The additional objects are: two equal spheres, of which the first is visible; a sphere
        // that touches them; and two very large spheres.
        text += "sphere { center (0, 0, 0) radius 0.7 color red }
            sphere { center (0, 0, 0) radius 0.7 color lime }
            sphere { center (1.4, 0, 0) radius 0.7 color blue }
            sphere { center (0, -1e7, 0) radius 1e7 - 2 color cyan }
            sphere { center (0, 0, -1e12) radius 0.9e12 color white }";
        let mut all = read(&text);
        let objects = Arc::make_mut(&mut all.objects);
        let (_, others) = scenes.next().unwrap();
        objects.extend_from_slice(&others.objects);
        // A thousand objects are listed a second time. The copies are invisible, because only the
        // first of equal objects is seen.
        objects.extend_from_within(3500..4500);
        // The tracer traces samples one by one in areas of the picture where many objects may be
        // seen (`Crowded`). The scene must have such an area, so that the comparisons below include
        // this case.
        let world = World::new(&all);
        let parts = Quartering::for_samples(&world, 1.0);
        let flow = parts.parts(
            whole(&all),
            &mut Scratch::default(),
            &mut |part| match part {
                PicturePart::Crowded { .. } => ControlFlow::Break(()),
                _ => ControlFlow::Continue(()),
            },
        );
        assert!(flow.is_break(), "no part is crowded");
        for (&n, method) in counts.iter().zip(&mut methods) {
            assert!(compare(&all, method, Count::PerPixel(n)) > 100);
        }
    }
}
