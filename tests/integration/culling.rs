//! A picture is the same to the bit whether its samples are culled and traced many at a time, or one by one, as the oracle has judged them.

use std::{
    collections::BTreeSet,
    num::NonZero,
    ops::ControlFlow,
    sync::{
        Arc,
        atomic::{AtomicBool, AtomicU64, Ordering},
    },
};

use glam::{DVec3, dvec3};
use pinhole::{
    area::Area,
    film::{Encoder, Film},
    render::{Control, render_as_asked},
    sampling::Sampling,
    scene::{Camera, Count, Lens, Method, Outline, Sampler, Scene, Shape, View},
    tracer::{Part, Quartering, Scratch, World},
};

#[path = "../../benches/one_by_one/mod.rs"]
mod one_by_one;

pub use self::one_by_one::one_by_one;

use crate::{
    effort::{Effort, sampled_and_exhaustive},
    exact::{example, examples, random_scene, read},
    figure::figure,
    scenes::sampled_by,
    tracer::{Random, camera, cuboid, floor, planes::scene_full_of_ties, scene, sphere, triangle},
};

/// A part of a picture, and how many samples progress was told of.
fn part(scene: &Scene, part: Area, threads: usize) -> (Film, u64) {
    let done = AtomicU64::new(0);
    let control = Control {
        threads: NonZero::new(threads),
        progress: &|more| {
            done.fetch_add(more, Ordering::Relaxed);
        },
        cancel: &AtomicBool::new(false),
    };
    let film = sampled_by(scene, part, &control);
    (film, done.into_inner())
}

/// A scene with more objects than a scene of the tracer's tests takes at once.
fn crowd(camera: Camera, shapes: &[Shape]) -> Scene {
    let mut scenes = shapes.chunks(200).map(|shapes| scene(camera, shapes));
    let mut all = scenes.next().unwrap();
    let more = scenes.flat_map(|scene| scene.objects.to_vec());
    Arc::make_mut(&mut all.objects).extend(more);
    all
}

/// The same part sample by sample.
fn plain(scene: &Scene, part: Area) -> Film {
    let [width, height] = [scene.image.width, scene.image.height];
    let sampling = Sampling::new(&scene.sampler, width, height);
    one_by_one(&World::new(scene), &sampling, part)
}

fn whole(scene: &Scene) -> Area {
    Area::whole(scene.image.width, scene.image.height)
}

/// Compares a picture with the one made sample by sample; answers how many colours it has.
#[track_caller]
fn compare(scene: &Scene, what: &str) -> usize {
    let film = plain(scene, whole(scene));
    let (culled, done) = part(scene, whole(scene), 2);
    if let Some(at) = (0..film.pixels().len()).find(|&i| film.pixels()[i] != culled.pixels()[i]) {
        let (x, y) = (at as u32 % film.width(), at as u32 / film.width());
        panic!("{what}: another pixel {x}, {y} than one by one in {scene:?}");
    }
    let [width, height] = [scene.image.width, scene.image.height];
    let sampling = Sampling::new(&scene.sampler, width, height);
    assert_eq!(done, sampling.total(), "{what}");
    let colors = film.pixels().iter().map(|pixel| pixel.map(f64::to_bits));
    colors.collect::<BTreeSet<_>>().len()
}

fn with_samples(scene: &Scene, method: Method, count: Count) -> Scene {
    let sampler = Sampler {
        method,
        count,
        seed: 5,
    };
    Scene {
        sampler,
        ..scene.clone()
    }
}

sampled_and_exhaustive!(every_example_by_every_method);

fn every_example_by_every_method(effort: Effort) {
    for name in effort.first(6, examples()) {
        let scene = example(&name, 43, 29);
        for method in Method::SAMPLED {
            let pixels = 43 * 29;
            for count in [
                Count::PerPixel(1),
                Count::PerPixel(9),
                Count::Total(7 * pixels + 400),
                Count::Total(pixels / 3),
            ] {
                compare(&with_samples(&scene, method, count), &name);
            }
        }
    }
}

#[test]
fn many_samples_at_a_time_fill_their_chunks_and_end_them_early() {
    for n in [3, 4, 5, 7, 8, 63, 64, 65, 130, 4095, 4096, 4097, 9000] {
        let scene = figure(11, 7, Method::Sobol, Count::PerPixel(n));
        assert!(compare(&scene, "figure") > 10);
    }
}

#[test]
fn boards_in_blocks_that_are_full_and_cut_off() {
    for name in ["figure_9_9", "rolled", "straight_down", "near_and_far"] {
        let scene = example(&format!("{name}.scn"), 397, 231);
        let scene = with_samples(&scene, Method::Jittered, Count::PerPixel(4));
        assert!(compare(&scene, name) > 10);
    }
}

#[test]
fn squares_whose_edges_are_those_of_pixels() {
    // A pixel's side on the floor is 1/32 when the eye looks down, so corners of pixels lie on every edge of a square: in each pixel beside
    // one it is not certain by corners alone what is seen.
    for (x, square) in [
        (0.0, 0.25),
        (0.0, 0.03125),
        (0.015625, 0.25),
        (1e6, 0.09375),
    ] {
        let scene = read(&format!(
            "image {{ width 256 height 256 }}
             camera {{ eye ({x}, 4, 0) lookat ({x}, 0, 0) up (0, 0, -1) d 1 }}
             checkerboard {{ square {square} }}"
        ));
        for count in [Count::PerPixel(1), Count::PerPixel(5)] {
            compare(&with_samples(&scene, Method::Random, count), "a board");
        }
    }
}

#[test]
fn bytes_are_those_of_the_light() {
    let encoder = Encoder::default();
    for count in [
        Count::PerPixel(1),
        Count::PerPixel(13),
        Count::Total(2_000),
        Count::Total(40_000),
    ] {
        let scene = figure(90, 70, Method::MultiJittered, count);
        let sampling = Sampling::new(&scene.sampler, 90, 70);
        let control = Control::default();
        let crop: Area = "7,9,80,50".parse().unwrap();
        let bytes = render_as_asked(&World::new(&scene), &sampling, crop, &control).unwrap();
        let bytes: Film<[u8; 3]> = bytes.into_film();
        let light = plain(&scene, crop);
        assert_eq!((bytes.width(), bytes.height()), (80, 50));
        for (bytes, &light) in bytes.pixels().iter().zip(light.pixels()) {
            assert_eq!(*bytes, encoder.pixel(light));
        }
    }
}

#[test]
fn scenes_of_all_kinds() {
    let mut random = Random::new(2024);
    let mut colors = 0;
    for index in 0..150 {
        let scene = random_scene(&mut random, index % 2 == 0);
        let method = Method::SAMPLED[index % Method::SAMPLED.len()];
        let scene = with_samples(&scene, method, Count::PerPixel(24));
        colors += compare(&scene, "random");
    }
    // Most have something to see.
    assert!(colors > 150 * 30, "{colors}");
}

/// Triangles that lie in one tilted plane or on the board and overlap, more than are kept in higher precisions.
#[test]
fn very_many_in_one_plane() {
    let mut random = Random::new(141);
    let mut place = || (random.bits() % 512) as f64 / 64.0 - 4.0;
    // Of each plane by several normals. The tilted one is y = −z/3, the other the board's.
    let mut shapes: Vec<_> = (0..4000)
        .map(|index| {
            let (a, b) = (place(), place());
            let length = f64::from(index % 5 + 1);
            match index % 2 {
                0 => triangle(dvec3(a, b / 2.0, -1.5 * b), dvec3(0.0, 3.0, 1.0) * length),
                _ => triangle(dvec3(a, 0.0, b), DVec3::Y * length),
            }
        })
        .collect();
    shapes.push(floor());
    let eye = dvec3(1.0, 4.0, 9.0);
    let resized = |shapes: &[Shape]| {
        let mut scene = scene(camera(eye, DVec3::ZERO), shapes);
        (scene.image.width, scene.image.height) = (24, 16);
        with_samples(&scene, Method::Jittered, Count::PerPixel(4))
    };
    let few = resized(&shapes);
    assert!(compare(&few, "4000 in two planes") > 100);
    // Once more each, with other normals: what comes first in the file is seen.
    shapes.extend_from_within(..4000);
    for shape in &mut shapes[4001..] {
        if let Shape::Triangle(triangle) = shape
            && let Outline::Centered(triangle) = &mut triangle.outline
        {
            triangle.normal *= 3.0;
        }
    }
    let many = resized(&shapes);
    compare(&many, "8000 in two planes");
    let picture = |scene: &Scene| part(scene, whole(scene), 1).0;
    assert_eq!(picture(&few).pixels(), picture(&many).pixels());
}

#[test]
fn crowds_of_all_kinds() {
    let mut random = Random::new(31);
    let (mut dense, mut open) = (0, 0);
    for index in 0..3 {
        let mut all = random_scene(&mut random, index % 2 == 0);
        let more = (0..20).flat_map(|_| random_scene(&mut random, true).objects.to_vec());
        Arc::make_mut(&mut all.objects).extend(more);
        let tiny: Vec<_> = (0..1 << 14)
            .map(|_| sphere(random.vector(3.0), random.within(1e-3, 0.03)))
            .collect();
        let tiny = crowd(camera(DVec3::X, DVec3::ZERO), &tiny);
        Arc::make_mut(&mut all.objects).extend(tiny.objects.to_vec());
        // Some of them twice: the first is seen.
        Arc::make_mut(&mut all.objects).extend_from_within(100..300);
        if index % 3 == 0 {
            (all.camera.near, all.camera.far) = (3.0, Some(6.0));
        }
        // Few samples are traced one by one where objects are dense, many together.
        for n in [1, 4, 8, 12, 100] {
            let all = with_samples(&all, Method::SAMPLED[index], Count::PerPixel(n));
            compare(&all, &format!("{index}: {n}"));
        }
        let world = World::new(&all);
        for (samples, pixels) in [(1.0, &mut dense), (1e4, &mut open)] {
            let parts = Quartering::for_samples(&world, samples);
            let _ = parts.parts(whole(&all), &mut Scratch::default(), &mut |part| {
                *pixels += match part {
                    Part::Crowded { area } if samples == 1.0 => area.pixels(),
                    Part::Pixel { .. } if samples > 1.0 => 1,
                    _ => 0,
                };
                ControlFlow::Continue(())
            });
        }
    }
    // Nearly all of their pixels.
    let all = 3 * 24 * 18;
    assert!(
        dense > all / 2 && open > all / 2,
        "{dense} and {open} of {all}"
    );
}

#[test]
fn layers_near_and_far() {
    for (count, apart) in [(9, 0.1), (33, 0.1), (33, 1e-13), (33, 1e-30), (120, 0.05)] {
        let mut text = "image { width 24 height 18 } camera { eye (0.3, 0.2, 4) lookat (0, 0, 0) roll 10deg }\n".to_owned();
        for index in 0..count {
            // In no order, and one of three a second time, which is not seen.
            let place = f64::from(index * 37 % count);
            let height = 1.0 + apart * (place - place % 3.0 % 2.0);
            let sign = if index % 2 == 0 { "-" } else { "" };
            let (odd, even) = (index % 200, index * 7 % 200);
            text += &format!(
                "checkerboard {{ y {sign}{height} square 0.7 colors (rgb({odd}, 0, 0), rgb(0, {even}, 9)) }}\n"
            );
            text += &format!(
                "triangle {{ centroid (0, 0, -{height}) normal (0.3, 0.2, 1) sides (3, 3, 3) color rgb(9, {odd}, {even}) }}\n"
            );
        }
        let mut all = read(&text);
        for (near, far) in [(0.0, None), (5.3, Some(40.0)), (5.0, Some(8.0))] {
            (all.camera.near, all.camera.far) = (near, far);
            for n in [1, 4, 16] {
                let all = with_samples(&all, Method::Jittered, Count::PerPixel(n));
                compare(&all, &format!("{count} layers {apart} apart, {near}: {n}"));
            }
        }
    }
}

#[test]
fn objects_as_small_as_pixels() {
    // Of so many nothing is known before they are traced one by one, and few of them are in the way of all samples of a pixel.
    let mut random = Random::new(12);
    for (index, roll) in [0.0, 0.0, 30.0, 45.0].into_iter().enumerate() {
        let shapes: Vec<_> = (0..3000)
            .map(|count| {
                let at = random.vector(2.5);
                let size = random.within(0.01, 0.08);
                match count % 3 {
                    0 => sphere(at, size),
                    1 => cuboid(at, at + size * dvec3(1.0, 2.0, 0.5)),
                    _ => triangle(at, random.vector(1.0)),
                }
            })
            .collect();
        let mut camera = camera(dvec3(0.5, 0.3, 7.0), DVec3::ZERO);
        camera.roll = pinhole::math::Angle::from_degrees(roll);
        if index % 2 == 1 {
            (camera.near, camera.far) = (5.5, Some(8.0));
        }
        let mut all = crowd(camera, &shapes);
        for object in Arc::make_mut(&mut all.objects) {
            if let Shape::Triangle(triangle) = &mut object.shape
                && let Outline::Centered(triangle) = &mut triangle.outline
            {
                triangle.sides *= 0.05;
            }
        }
        // Some of them twice: the first is seen.
        Arc::make_mut(&mut all.objects).extend_from_within(100..900);
        (all.image.width, all.image.height) = (47, 35);
        for (n, method) in [2, 3, 4, 8, 9, 16].into_iter().zip(Method::SAMPLED) {
            let all = with_samples(&all, method, Count::PerPixel(n));
            compare(&all, &format!("{index}: {n}"));
        }
    }
}

#[test]
fn parts_cover_each_pixel_once() {
    let mut random = Random::new(7);
    for index in 0..40 {
        let mut all = random_scene(&mut random, index % 2 == 0);
        let more = (0..index).flat_map(|_| random_scene(&mut random, true).objects.to_vec());
        Arc::make_mut(&mut all.objects).extend(more);
        let world = World::new(&all);
        let area = whole(&all);
        for samples in [0.01, 1.0, 3.0, 8.0, 64.0, f64::INFINITY] {
            let mut seen = vec![0; area.pixels() as usize];
            let parts = Quartering::for_samples(&world, samples);
            let flow = parts.parts(area, &mut Scratch::default(), &mut |part| {
                let part = match part {
                    Part::OneColor { area, .. } | Part::Crowded { area } => area,
                    Part::Pixel { x, y, .. } => Area::pixel(x, y),
                };
                part.iter().for_each(|(x, y)| seen[area.index(x, y)] += 1);
                ControlFlow::Continue(())
            });
            assert!(flow.is_continue());
            assert!(seen.iter().all(|&times| times == 1), "{index}: {samples}");
        }
    }
}

sampled_and_exhaustive!(scenes_full_of_ties);

fn scenes_full_of_ties(effort: Effort) {
    let mut random = Random::new(77);
    for _ in effort.first(60, 0..300) {
        let scene = scene_full_of_ties(&mut random);
        // Offsets of odd eighths, and with one sample the centres: on edges and in planes.
        for n in [1, 4, 16] {
            let scene = with_samples(&scene, Method::Regular, Count::PerPixel(n));
            compare(&scene, "ties");
        }
    }
}

sampled_and_exhaustive!(extreme_cameras);

fn extreme_cameras(effort: Effort) {
    let shapes = [
        sphere(dvec3(-1.6, 1.0, 0.0), 1.0),
        cuboid(dvec3(1.5, 0.0, -1.5), dvec3(2.5, 1.5, 0.5)),
        triangle(dvec3(0.2, 1.0, 0.6), dvec3(0.3, 0.0, 1.0)),
        floor(),
    ];
    let eyes = [
        dvec3(3.0, 3.5, 8.0),
        dvec3(3.0, 1e-9, 8.0),
        dvec3(3.0, 1e9, 8.0),
        dvec3(1e9, 2.0, 1e9),
        dvec3(0.0, 0.75, 0.0),
        // Inside the box, the sphere; on the sphere.
        dvec3(2.0, 0.5, -0.5),
        dvec3(-1.6, 1.0, 0.0),
        dvec3(-1.6, 2.0, 0.0),
        dvec3(-1.6, 2.0 + 1e-13, 0.0),
        dvec3(0.0, -4.0, 0.0),
    ];
    let lookats = [
        dvec3(0.2, 0.8, 0.0),
        dvec3(1e3, 0.0, -1e6),
        dvec3(-1.6, 1.5, 0.1),
    ];
    for eye in effort.first(4, eyes) {
        for lookat in lookats {
            for fov in [1e-7, 1.0, 40.0, 120.0, 179.999] {
                let mut camera = camera(eye, lookat);
                camera.view = View::Lookat(lookat);
                camera.lens = Lens::Fov(pinhole::math::Angle::from_degrees(fov));
                for clips in [(0.0, None), (2.5, Some(9.0)), (0.0, Some(1e12))] {
                    (camera.near, camera.far) = clips;
                    let mut scene = scene(camera, &shapes);
                    (scene.image.width, scene.image.height) = (20, 13);
                    let scene = with_samples(&scene, Method::MultiJittered, Count::PerPixel(16));
                    compare(&scene, "extreme");
                }
            }
        }
    }
}

#[test]
fn spheres_of_extreme_sizes() {
    let mut random = Random::new(5);
    let mut tiny: Vec<_> = (0..1500)
        .map(|_| {
            let center = random.vector(3.0);
            sphere(center, random.within(1e-4, 0.05))
        })
        .collect();
    tiny.push(sphere(dvec3(0.0, -1e7, 0.0), 1e7 - 2.0));
    tiny.push(sphere(dvec3(0.0, 0.0, -1e12), 0.9e12));
    // Two equal ones, of which the first is seen, and one that touches them.
    tiny.push(sphere(DVec3::ZERO, 0.7));
    tiny.push(sphere(DVec3::ZERO, 0.7));
    tiny.push(sphere(dvec3(1.4, 0.0, 0.0), 0.7));
    let camera = camera(dvec3(1.0, 2.0, 8.0), DVec3::ZERO);
    let mut scene = crowd(camera, &tiny);
    (scene.image.width, scene.image.height) = (64, 40);
    let scene = with_samples(&scene, Method::Halton, Count::PerPixel(8));
    assert!(compare(&scene, "spheres") > 100);
}

#[test]
fn dense_rows_of_squares() {
    for (square, y) in [(1.0, 0.0), (0.001, 0.0), (1e-6, 1.0), (300.0, -5.0)] {
        let text = format!(
            "image {{ width 40 height 24 }} camera {{ eye (0.3, 2, 5) lookat (7, 1.8, -30) roll 3deg }}
             checkerboard {{ y {y} square {square} }} sphere {{ center (2, 1, -1) }}"
        );
        let scene = with_samples(&read(&text), Method::Jittered, Count::PerPixel(40));
        assert!(compare(&scene, "squares") > 10);
    }
}
