//! What is known of a pixel: how close it is to its true mean, and which of its bytes are certain.

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
    let seen = exact(&read(&text));
    assert!(seen.bound() <= 1e-9, "{:e}", seen.bound());
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
    for text in [boards, fan] {
        let seen = exact(&read(&text));
        assert!(seen.bound() <= 1e-9, "{:e}", seen.bound());
    }
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
        let encoder = film::Encoder::new();
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
        scene.objects.push(object);
    }
    let exact = exact(&scene);
    assert!(exact.bound() <= 1e-9, "{:e}", exact.bound());
}

/// Outlines of spheres that all but coincide are told apart, as closely as roundings allow.
#[test]
fn outlines_that_nearly_coincide() {
    for gap in ["1e-6", "1e-8", "1e-10", "1e-12", "1e-14", "1e-15"] {
        for center in ["(0, 0.3, 0)", &format!("({gap}, 0.3, 0)")] {
            let scene = read(&format!(
                "image {{ width 24 height 16 }}
                 camera {{ eye (0, 1.5, 6) lookat (0, 0.5, 0) }}
                 sampler {{ method exact }}
                 sphere {{ center (0, 0.3, 0) radius 1 color red }}
                 sphere {{ center {center} radius 1 + {gap} color blue }}"
            ));
            let bound = exact(&scene).bound();
            assert!(bound <= 1e-9, "{gap} {center}: {bound:e}");
            adds_up(&scene, gap);
        }
    }
}

/// A heap of boxes that is seen in a small part of one pixel, far away or in a wide view, is cut where it is, not all of the pixel.
#[test]
fn heaps_in_a_small_part_of_a_pixel() {
    for (distance, count) in [(1e3, 40), (1e5, 40), (1e5, 100)] {
        let boxes: String = (0..count)
            .map(|i| {
                let [row, column] = [i / 10, i % 10].map(f64::from);
                let x = 0.31 * distance + 1.5 * row;
                let z = 1.5 * column - distance;
                let height = 1.0 + 0.1 * ((7.0 * row + 3.0 * column) % 5.0);
                let color = ["red", "lime", "blue"][(i % 3) as usize];
                format!(
                    "box {{ min ({x}, 0, {z}) max ({}, {height}, {}) color {color} }}\n",
                    x + 1.0,
                    z + 1.0
                )
            })
            .collect();
        let scene = read(&format!(
            "image {{ width 6 height 4 background white }}
             camera {{ eye (0, 1.7, 0) direction (0.3, -0.01, -1) d 2 }}
             {boxes}"
        ));
        let bound = exact(&scene).bound();
        assert!(bound <= 1e-9, "{count} at {distance}: {bound:e}");
    }
    // Six boxes cut by a near plane, in the pixels next to the middle of a wide view: pieces that are nothing but roundings are not cut on.
    let boxes: String = [
        ("(-0.9, -0.5, -2.8)", "(-0.8, 0.5, -2.7)", "aqua"),
        ("(-0.9, 0, -2.9)", "(-0.8, 0.5, -2.8)", "lime"),
        ("(-0.8, -0.5, -3)", "(-0.7, 0.1, -2.9)", "red"),
        ("(-0.9, 0, -3)", "(-0.8, 0.1, -2.9)", "blue"),
        ("(-1, 0, -2.8)", "(-0.9, 0.5, -2.7)", "magenta"),
        ("(-1, 0, -3)", "(-0.9, 0.1, -2.9)", "red"),
    ]
    .map(|(min, max, color)| format!("box {{ min {min} max {max} color {color} }}\n"))
    .concat();
    let scene = read(&format!(
        "image {{ width 3 height 2 }}
         camera {{
           eye (0, 1, 0) direction (0, -0.5, -1) up (-0.9007722890570433, 1, -0.9632900419652703)
           view_height 2 fov 179.99deg near 0.17672630528511746
         }}
         {boxes}"
    ));
    let bound = exact(&scene).bound();
    assert!(bound <= 1e-9, "{bound:e}");
}

/// Curves that go beside each other for long, nearer than slabs can be cut for: of the one scene all is told, of the other all but its endless squares.
#[test]
fn curves_beside_each_other() {
    for text in [
        "image { width 3 height 2 }
         camera { eye (0, 1, 0) direction (0.63, -0.1, 0.39) roll 45deg d 0.15 }
         sphere { center (0, 1, -6e6) radius 6000001 color navy }
         checkerboard { y 0 }
         triangle { centroid (3.4, 1e-12, 2.2) normal (0, -1, 0) color olive }",
        "image { width 1 height 1 background blue }
         camera {
           eye (0.46423707751978815, 0.01, -1.7155281016245234)
           direction (-0.5670807891629539, -0.6050437145195939, -0.15161214354303753)
           roll 45deg d 3.335412630144437 near 3.970146834830003
         }
         box A {
           min (-3.203781816520416, -5.949855179823845, -4.027622223195476)
           max (-2.3644350116690855, -2.871548678609776, -1.678847305965552)
           color lime
         }
         box B {
           min (-3.2037818165204426, -5.949855179823845, -4.027622223195476)
           max (-2.3644350116690855, -2.8715486786097677, -1.6788473059655382)
           color red
         }
         sphere {
           center (-2.784108414094764, -4.410701929216811, -2.8532347645804976)
           radius 1.98098571335329 color maroon
         }",
    ] {
        let bound = exact(&read(text)).bound();
        assert!(bound <= 1e-9, "{bound:e}\n{text}");
    }
}

/// Spheres that all but coincide cut what is seen of a board into so many regions that what is neglected of each is too much together.
#[test]
fn a_board_in_many_regions() {
    for far in ["far 5000", "far 1e6", ""] {
        let text = format!(
            "image {{ width 1 height 1 background blue }}
             camera {{
               eye (-1.8603737249385341, 1, 1.4622338056093724)
               direction (-0.9514402817618297, -0.027598734570998706, 0.21549868997034038)
               roll 30deg d 0.32620205140372116 near 4.44474041915774 {far}
             }}
             checkerboard {{ y -0.19897537002530774 square 0.01922466376114783 }}
             sphere {{ center (-6.2213043953821305, -0.1989753137269249, 5.515023694289672) radius 0.32531062980435055 color red }}
             sphere {{ center (-6.221304045132754, -0.19897535882331618, 5.515023750588055) radius 0.32531062980435055 color olive }}
             sphere {{ center (-6.221304045132754, -0.1989753137269249, 5.515023637991289) radius 0.32531061148988816 color lime }}"
        );
        let bound = exact(&read(&text)).bound();
        assert!(bound <= 1e-9, "{far}: {bound:e}");
    }
}
