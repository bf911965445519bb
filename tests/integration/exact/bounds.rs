//! What is known of a pixel: how close it is to its true mean, and which of its bytes are certain.

use std::sync::Arc;

use pinhole::color::linear_to_srgb;

use super::*;

/// How many pixels of 16 bits a channel would be certain.
fn certified_words(exact: &Exact) -> usize {
    let word = |light: f64| -> f64 { (65_535.0 * linear_to_srgb(light)).round() };
    let pixels = exact.film.pixels().iter().zip(&exact.bounds);
    let is_certain = |light: &[f64; 3], bound: f64| {
        let is_one = |channel: &f64| word(channel - bound) == word(channel + bound);
        light.iter().all(is_one)
    };
    pixels
        .filter(|&(light, &bound)| is_certain(light, bound.into()))
        .count()
}

#[test]
fn bounds_keep_their_promise() {
    for far in [Some(100.0), Some(1e3), None] {
        let mut scene = example("figure_9_9.scn", 256, 256);
        scene.camera.far = far;
        let exact = exact(&scene);
        assert!(exact.bound() <= 1e-9, "far {far:?}: {:e}", exact.bound());
        let certified = film::certified(&exact.film, &exact.bounds);
        let share = certified as f64 / exact.bounds.len() as f64;
        assert!(share >= 0.99999, "{share}");
        let share = certified_words(&exact) as f64 / exact.bounds.len() as f64;
        assert!(share >= 0.999, "of 16 bits: {share}");
    }
    // Along a diagonal of the board, level and rolled.
    for (direction, roll) in [
        ((1.0, -1.0), 0.0),
        ((-1.0, -1.0), 30.0),
        ((1.0, -3.0), 0.0),
        ((1.0, 0.0), 90.0),
    ] {
        let mut scene = example("figure_9_9.scn", 64, 64);
        scene.camera.view = View::Direction(dvec3(direction.0, 0.0, direction.1));
        scene.camera.roll.degrees = roll;
        scene.camera.lens = Lens::Distance(2.0);
        let exact = exact(&scene);
        assert!(exact.bound() <= 1e-9, "{direction:?}: {:e}", exact.bound());
    }
}

/// So many spheres that pierce each other in one pixel, most of what bounds them hidden.
#[test]
fn a_heap_in_one_pixel() {
    let mut text = String::from(
        "image { width 3 height 3 }
         camera { eye (0, 0, 100) lookat (0, 0, 0) d 0.33 }
         sampler { method exact }\n",
    );
    let mut random = Random::new(7);
    for color in ["olive", "teal", "orange", "red", "blue"].repeat(8) {
        let [at, more]: [DVec2; 2] = [random.offset(), random.offset()];
        let (x, y, z) = (40.0 * at.x, 40.0 * at.y, 40.0 * more.x);
        let radius = 20.0 * (0.6 + more.y);
        let _ = writeln!(
            text,
            "sphere {{ center ({x}, {y}, {z}) radius {radius} color {color} }}"
        );
    }
    is_known(&text);
}

/// The horizons of parallel boards are one line, and so is the edge that the triangles of a fan share: a pixel that they pass through
/// is not cut any further, whose pieces would be without number.
#[test]
fn many_lines_that_are_one() {
    let view = "image { width 48 height 27 }
        camera { eye (3, 3.5, 8) lookat (0.2, 0.8, 0) d 2.75 roll 7deg }\n";
    let (mut boards, mut fan) = (view.to_owned(), view.to_owned());
    for index in 0..40 {
        let index = f64::from(index);
        let (y, square) = (-0.1 * index, 0.5 + 0.1 * index);
        let _ = writeln!(boards, "checkerboard {{ y {y} square {square} }}");
        let (sin, cos) = libm::sincos(0.08 * index);
        let _ = writeln!(
            fan,
            "triangle {{ v0 (0, 0, 0) v1 (0, 2, 0) v2 ({cos}, 1, {sin}) color rgb({index}, 90, 40) }}"
        );
    }
    is_known(&boards);
    is_known(&fan);
}

#[test]
fn bytes_are_those_of_the_means() {
    for name in examples() {
        let scene = example(&name, 70, 52);
        let area: Area = "3,1,66,50".parse().unwrap();
        let control = Control::default();
        let sampler = Sampler {
            method: Method::Exact,
            ..scene.sampler
        };
        let sampling = Sampling::new(&sampler, 70, 52);
        let bytes: Rendered<[u8; 3]> =
            render_as_asked(&World::new(&scene), &sampling, area, &control).unwrap();
        let Rendered::Exact(bytes) = bytes else {
            panic!("{name}: not exact")
        };
        let means = part(&scene, area);
        assert_eq!(bytes.bounds, means.bounds, "{name}");
        let certain = film::certified(&means.film, &means.bounds);
        assert_eq!(bytes.certain, certain, "{name}");
        assert!(certain <= area.pixels());
        let encoder = film::Encoder::default();
        for (bytes, light) in bytes.film.pixels().iter().zip(means.film.pixels()) {
            assert_eq!(*bytes, encoder.pixel(*light), "{name}");
        }
    }
}

#[test]
fn what_is_uniform_is_its_colour() {
    let scene = example("figure_9_9.scn", 96, 96);
    let world = World::new(&scene);
    let exact = exact(&scene);
    let colors: Vec<_> = world
        .palette()
        .iter()
        .map(|color| Color::to_linear(*color))
        .collect();
    let mut uniform = 0;
    let mut random = Random::new(3);
    for (x, y) in Area::whole(96, 96).iter() {
        if exact.bounds[(y * 96 + x) as usize] == 0.0 {
            uniform += 1;
            for _ in 0..8 {
                let offset: DVec2 = random.offset();
                assert_eq!(
                    colors[world.slot_at(x, y, offset)],
                    exact.film.pixel(x, y),
                    "{x}, {y}"
                );
            }
        }
    }
    assert!(uniform > 5000, "{uniform}");
}

#[test]
fn ten_thousand_objects() {
    let mut random = Random::new(11);
    let mut scene = random_scene(&mut random, true);
    (scene.image.width, scene.image.height) = (96, 64);
    scene.camera.near = 0.0;
    scene.camera.far = None;
    let shape = scene.objects[1].shape;
    let Shape::Sphere(ball) = shape else {
        panic!("{shape:?}")
    };
    let object = scene.objects[1].clone();
    for _ in 0..10_000 {
        let mut object = object.clone();
        object.shape = Shape::Sphere(scene::Sphere {
            center: random.vector(3.0),
            radius: random.within(0.005, 0.03),
            ..ball
        });
        Arc::make_mut(&mut scene.objects).push(object);
    }
    let exact = exact(&scene);
    assert!(exact.bound() <= 1e-9, "{:e}", exact.bound());
}

/// Outlines of spheres that all but coincide are told apart, as closely as roundings allow.
#[test]
fn outlines_that_nearly_coincide() {
    for gap in ["1e-6", "1e-8", "1e-10", "1e-12", "1e-14", "1e-15"] {
        for center in ["(0, 0.3, 0)", &format!("({gap}, 0.3, 0)")] {
            let text = format!(
                "image {{ width 24 height 16 }}
                 camera {{ eye (0, 1.5, 6) lookat (0, 0.5, 0) }}
                 sampler {{ method exact }}
                 sphere {{ center (0, 0.3, 0) radius 1 color red }}
                 sphere {{ center {center} radius 1 + {gap} color blue }}"
            );
            is_known(&text);
            adds_up(&read(&text), gap);
        }
    }
}

/// A heap of boxes that is seen in a small part of one pixel, far away or in a wide view, is cut where it is, not all of the pixel.
#[test]
fn heaps_in_a_small_part_of_a_pixel() {
    for (distance, count) in [(1e3, 40), (1e5, 40), (1e5, 100)] {
        let boxes = (0..count).map(|i| {
            let [row, column] = [i / 10, i % 10].map(f64::from);
            let (x, z) = (0.31 * distance + 1.5 * row, 1.5 * column - distance);
            let height = 1.0 + 0.1 * ((7.0 * row + 3.0 * column) % 5.0);
            let color = ["red", "lime", "blue"][(i % 3) as usize];
            format!("box {{ min ({x}, 0, {z}) max ({x} + 1, {height}, {z} + 1) color {color} }}\n")
        });
        let boxes: String = boxes.collect();
        is_known(&format!(
            "image {{ width 6 height 4 background white }}
             camera {{ eye (0, 1.7, 0) direction (0.3, -0.01, -1) d 2 }}
             {boxes}"
        ));
    }
}

/// The scenes of `tests/exact`: the pixels of the crop that a comment asks for, or all, are known to a thousand-millionth, and their quarters are they.
#[test]
fn hard_scenes_are_known() {
    for path in scenes("tests/exact") {
        let text = std::fs::read_to_string(&path).unwrap();
        let scene = read(&text);
        let crop = text.lines().find_map(|line| line.strip_prefix("// crop "));
        let whole = Area::whole(scene.image.width, scene.image.height);
        let area = crop.map_or(whole, |crop| crop.parse().unwrap());
        let name = path.display().to_string();
        let bound = part_adds_up(&scene, area, &name).bound();
        assert!(bound <= 1e-9, "{name}: {bound:e}");
    }
}
