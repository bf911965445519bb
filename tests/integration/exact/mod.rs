//! The computed picture against closed forms, against itself in other ways, against samples and against rational arithmetic.

mod board;
mod diagonal;
mod rational;

use std::{f64::consts::PI, fmt::Write, num::NonZero, sync::atomic::AtomicBool};

use glam::{DVec2, dvec3};
use pinhole::{
    area::Area,
    color::Color,
    film,
    render::{Control, Exact, render, render_exact, render_exact_bytes},
    sampling::Sampling,
    scene::{self, Count, Lens, Method, Sampler, Scene, Shape, View},
    source::{Source, Sources},
    tracer::World,
};

use crate::tracer::Random;

pub fn read(text: &str) -> Scene {
    let sources = Sources::new(Source::from_text("a.scn", text));
    let reading = scene::read(&sources);
    reading
        .scene
        .unwrap_or_else(|| panic!("not a scene: {text}"))
}

pub fn example(name: &str, width: u32, height: u32) -> Scene {
    let path = format!("{}/examples/{name}", env!("CARGO_MANIFEST_DIR"));
    let mut scene = read(&std::fs::read_to_string(path).unwrap());
    (scene.image.width, scene.image.height) = (width, height);
    scene
}

pub fn examples() -> Vec<String> {
    let folder = format!("{}/examples", env!("CARGO_MANIFEST_DIR"));
    let names = std::fs::read_dir(folder).unwrap();
    let names = names.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<_> = names.filter(|name| name.ends_with(".scn")).collect();
    names.sort();
    assert!(names.len() >= 20);
    names
}

fn exact(scene: &Scene) -> Exact {
    part(scene, Area::whole(scene.image.width, scene.image.height))
}

fn part(scene: &Scene, area: Area) -> Exact {
    part_by(scene, area, None)
}

fn part_by(scene: &Scene, area: Area, threads: Option<usize>) -> Exact {
    let control = Control {
        threads: threads.and_then(NonZero::new),
        progress: &|_| {},
        cancel: &AtomicBool::new(false),
    };
    render_exact(&World::new(scene), area, &control).unwrap()
}

/// Up to a dozen spheres, triangles and boxes in each other's way, seen from among them, cut by near and far planes at times.
pub fn random_scene(random: &mut Random, floor: bool) -> Scene {
    let mut text = String::from("image { width 24 height 18 background #123 }\n");
    let mut number = |low: f64, high: f64| (random.within(low, high) * 1000.0).round() / 1000.0;
    let mut vector = |x: (f64, f64), y: (f64, f64), z: (f64, f64)| {
        format!(
            "({}, {}, {})",
            number(x.0, x.1),
            number(y.0, y.1),
            number(z.0, z.1)
        )
    };
    let eye = vector((-4.0, 4.0), (-2.0, 5.0), (2.0, 8.0));
    let lookat = vector((-1.0, 1.0), (0.0, 1.0), (-1.0, 1.0));
    let mut shapes = String::new();
    let colors = ["red", "lime", "blue", "gold", "cyan", "white"];
    let objects = 2 + random.bits() % 11;
    for index in 0..objects {
        let mut number = |low: f64, high: f64| (random.within(low, high) * 1000.0).round() / 1000.0;
        let center = format!(
            "({}, {}, {})",
            number(-2.0, 2.0),
            number(-1.0, 2.0),
            number(-2.0, 2.0)
        );
        let color = colors[index as usize % colors.len()];
        shapes += &match index % 4 {
            0 | 1 => format!(
                "sphere {{ center {center} radius {} color {color} }}\n",
                number(0.1, 1.8)
            ),
            2 => format!(
                "triangle {{ centroid {center} normal ({}, {}, {}) sides ({}, {}, {}) spin {}deg color {color} }}\n",
                number(-1.0, 1.0),
                number(-1.0, 1.0),
                number(-1.0, 1.0),
                number(1.5, 2.5),
                number(1.5, 2.5),
                number(1.5, 2.5),
                number(0.0, 360.0)
            ),
            _ => format!(
                "box {{ center {center} size ({}, {}, {}) color {color} }}\n",
                number(0.2, 2.0),
                number(0.2, 2.0),
                number(0.2, 2.0)
            ),
        };
    }
    let mut number = |low: f64, high: f64| (random.within(low, high) * 1000.0).round() / 1000.0;
    let (roll, fov) = (number(-180.0, 180.0), number(20.0, 140.0));
    text += &format!("camera {{ eye {eye} lookat {lookat} roll {roll}deg fov {fov}deg");
    if number(0.0, 1.0) < 0.4 {
        text += &format!(" near {}", number(0.5, 4.0));
    }
    if number(0.0, 1.0) < 0.3 {
        text += &format!(" far {}", number(4.5, 12.0));
    }
    text += " }\n";
    if floor {
        text += &format!(
            "checkerboard {{ y {} square {} }}\n",
            number(-1.0, 0.5),
            number(0.2, 1.5)
        );
    }
    read(&(text + &shapes))
}

/// What two pixels may differ by: their bounds, and the roundings of sums of colours.
fn allowed(bounds: &[f32]) -> f64 {
    bounds.iter().map(|&bound| f64::from(bound)).sum::<f64>() + 4.0 * f64::EPSILON
}

/// Of a scene with twice the resolution four pixels are one of the original.
fn adds_up(scene: &Scene, name: &str) {
    let whole = Area::whole(scene.image.width, scene.image.height);
    part_adds_up(scene, whole, name);
}

/// The same for a part of the picture, which is returned.
fn part_adds_up(scene: &Scene, area: Area, name: &str) -> Exact {
    let mut fine = scene.clone();
    fine.image.width *= 2;
    fine.image.height *= 2;
    let twice = Area {
        x: 2 * area.x,
        y: 2 * area.y,
        width: 2 * area.width,
        height: 2 * area.height,
    };
    let (coarse, fine) = (part(scene, area), part(&fine, twice));
    for (x, y) in Area::whole(area.width, area.height).iter() {
        let quarters = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| (2 * x + i, 2 * y + j));
        let bound = |picture: &Exact, (x, y): (u32, u32)| {
            picture.bounds[(y * picture.film.width() + x) as usize]
        };
        let whole = bound(&coarse, (x, y));
        let bounds = quarters.map(|at| 0.25 * bound(&fine, at));
        let limit = allowed(&[whole]) + allowed(&bounds);
        for channel in 0..3 {
            let mean = quarters
                .map(|(x, y)| fine.film.pixel(x, y)[channel])
                .iter()
                .sum::<f64>()
                / 4.0;
            let difference = (mean - coarse.film.pixel(x, y)[channel]).abs();
            assert!(
                difference <= limit,
                "{name} at {x}, {y}: {difference:e} of {limit:e}"
            );
        }
    }
    coarse
}

#[test]
fn four_quarters_are_the_pixel() {
    for name in examples() {
        adds_up(&example(&name, 48, 32), &name);
    }
}

#[test]
fn four_quarters_are_the_pixel_of_scenes_that_pierce_themselves() {
    let mut random = Random(7);
    for round in 0..24 {
        adds_up(
            &random_scene(&mut random, round % 2 == 0),
            &format!("round {round}"),
        );
    }
}

#[test]
fn four_quarters_are_the_pixel_of_extreme_cameras() {
    let figure = example("figure_9_9.scn", 24, 16);
    let with = |change: &dyn Fn(&mut Scene)| {
        let mut scene = figure.clone();
        change(&mut scene);
        scene
    };
    let wide = |d: f64| with(&|scene| scene.camera.lens = Lens::Distance(d));
    let along = |d: f64| {
        with(&|scene| {
            scene.camera.view = View::Direction(dvec3(0.0, 0.0, -1.0));
            scene.camera.lens = Lens::Distance(d);
        })
    };
    let height = |y: f64| with(&|scene| scene.camera.eye.y = y);
    let squares = |side: f64| {
        with(&|scene| {
            for object in &mut scene.objects {
                if let Shape::Checkerboard(board) = &mut object.shape {
                    board.square = side;
                }
            }
        })
    };
    let sized = |width: u32, height: u32| {
        with(&|scene| (scene.image.width, scene.image.height) = (width, height))
    };
    for (name, scene) in [
        ("wide", wide(0.1)),
        ("very wide", wide(0.02)),
        ("much too wide", wide(1e-3)),
        ("wider", wide(1e-5)),
        ("along an axis as wide as can be", along(1e-12)),
        ("narrow", wide(1e5)),
        ("tiny squares", squares(1e-3)),
        ("squares of a micrometre", squares(1e-6)),
        ("squares of nothing", squares(1e-100)),
        ("huge squares", squares(1e6)),
        ("squares beyond everything", squares(1e300)),
        ("an ant's eye", height(1e-6)),
        ("a satellite's eye", height(1e8)),
        ("a pixel", sized(1, 1)),
        ("a row", sized(60, 1)),
        ("a column", sized(1, 60)),
    ] {
        let bound = exact(&scene).bound();
        assert!(bound <= 1e-8, "{name}: {bound:e}");
        adds_up(&scene, name);
    }
}

#[test]
fn a_quarter_turn_sweeps_the_other_way() {
    let mut scenes: Vec<_> = examples()
        .iter()
        .map(|name| example(name, 40, 40))
        .collect();
    let mut random = Random(8);
    scenes.extend((0..12).map(|round| {
        let mut scene = random_scene(&mut random, round % 2 == 0);
        (scene.image.width, scene.image.height) = (24, 24);
        scene
    }));
    for (index, scene) in scenes.into_iter().enumerate() {
        let side = scene.image.width;
        let mut turned = scene.clone();
        turned.camera.roll.degrees += 90.0;
        let (straight, turned) = (exact(&scene), exact(&turned));
        for (x, y) in Area::whole(side, side).iter() {
            // Rolled to the right, the camera sees the world turned counter-clockwise.
            let (u, v) = (y, side - 1 - x);
            let bounds = [
                straight.bounds[(y * side + x) as usize],
                turned.bounds[(v * side + u) as usize],
            ];
            for channel in 0..3 {
                let difference =
                    (straight.film.pixel(x, y)[channel] - turned.film.pixel(u, v)[channel]).abs();
                assert!(
                    difference <= allowed(&bounds),
                    "scene {index} at {x}, {y}: {difference:e}"
                );
            }
        }
    }
}

#[test]
fn no_pixel_depends_on_what_was_computed_before_it() {
    for name in ["figure_9_9.scn", "rolled.scn", "piercing.scn"] {
        let scene = example(name, 96, 80);
        let whole = exact(&scene);
        for area in ["0,0,1,1", "63,7,3,40", "17,0,50,30", "5,0,1,80"] {
            let area: Area = area.parse().unwrap();
            let cropped = part(&scene, area);
            for (x, y) in area.iter() {
                let pixel = cropped.film.pixel(x - area.x, y - area.y);
                assert_eq!(pixel, whole.film.pixel(x, y), "{name} at {x}, {y}");
                let bound = cropped.bounds[area.index(x, y)];
                assert_eq!(bound, whole.bounds[(y * 96 + x) as usize]);
            }
        }
    }
}

#[test]
fn any_number_of_threads_computes_the_same_picture() {
    for name in ["figure_9_9.scn", "rolled.scn", "piercing.scn"] {
        // Tiles of all sizes, and more than threads.
        let scene = example(name, 201, 140);
        let whole = Area::whole(201, 140);
        let one = part_by(&scene, whole, Some(1));
        for threads in [2, 5] {
            assert_eq!(one, part_by(&scene, whole, Some(threads)), "{name}");
        }
    }
}

#[test]
fn bytes_are_those_of_the_means() {
    for name in examples() {
        let scene = example(&name, 70, 52);
        let area: Area = "3,1,66,50".parse().unwrap();
        let control = Control {
            threads: None,
            progress: &|_| {},
            cancel: &AtomicBool::new(false),
        };
        let bytes = render_exact_bytes(&World::new(&scene), area, &control).unwrap();
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

/// A picture of one pixel: how much of it an object in white covers.
fn share(camera: &str, object: &str) -> (f64, f64) {
    let scene = read(&format!(
        "image {{ width 1 height 1 }} camera {{ {camera} }} {object}"
    ));
    let exact = exact(&scene);
    (exact.film.pixel(0, 0)[0], exact.bound())
}

fn is_share(camera: &str, object: &str, expected: f64) {
    let (found, bound) = share(camera, object);
    let difference = (found - expected).abs();
    assert!(bound <= 1e-12, "{object}: bound {bound:e}");
    assert!(
        difference <= bound + 4.0 * f64::EPSILON,
        "{object}: {found} for {expected}, {difference:e}"
    );
}

#[test]
fn half_planes() {
    // The pixel is 2 wide at distance 1; the box's right side is seen at x/4, or at x/5 where its side face is seen, too.
    for edge in [-3.5f64, -0.25, 0.0, 1.0, 3.0] {
        let object = format!("box {{ min (-100, -100, -5) max ({edge}, 100, -4) color white }}");
        let expected = 0.5 + edge / if edge < 0.0 { 10.0 } else { 8.0 };
        let camera = "eye (0, 0, 0) direction (0, 0, -1) d 1";
        is_share(camera, &object, expected);
        is_share(&format!("{camera} roll 90deg"), &object, expected);
    }
    // Rolled by 45° about an edge through the pixel's centre, and by any angle: half of it.
    for roll in [45.0, 1e-9, 17.0, 89.999999] {
        let camera = format!("eye (0, 0, 0) direction (0, 0, -1) d 1 roll {roll}deg");
        is_share(
            &camera,
            "box { min (-100, -100, -5) max (0, 100, -4) color white }",
            0.5,
        );
    }
}

#[test]
fn discs_and_ellipses() {
    // The silhouette of a sphere on the axis is a circle of radius R/√(D² − R²) at distance 1.
    for radius in [0.7f64, 0.1, 1e-3, 1e-6] {
        let circle = radius * radius / (1.0 - radius * radius);
        if circle < 1.0 {
            let object = format!("sphere {{ center (0, 0, -1) radius {radius} color white }}");
            is_share(
                "eye (0, 0, 0) direction (0, 0, -1) d 1",
                &object,
                PI * circle / 4.0,
            );
        }
    }
    // Off the axis it is an ellipse of area πR²√C/(z² − R²)^(3/2), C = c·c − R², z the centre's depth.
    for (x, y, z, radius) in [
        (0.3, 0.2, 1.0, 0.25),
        (-0.5, 0.4, 1.0, 0.2),
        (2.0, -1.0, 4.0, 1.0f64),
    ] {
        let power: f64 = x * x + y * y + z * z - radius * radius;
        let depth: f64 = z * z - radius * radius;
        let area = PI * radius * radius * power.sqrt() / (depth * depth.sqrt());
        let object = format!("sphere {{ center ({x}, {y}, -{z}) radius {radius} color white }}");
        is_share(
            "eye (0, 0, 0) direction (0, 0, -1) d 1",
            &object,
            area / 4.0,
        );
    }
}

#[test]
fn squares_from_above() {
    // From height 1 the pixel shows [−1, 1]²: 2 × 2 squares of side 1, and what is left of larger ones.
    let camera = "eye (0, 1, 0) direction (0, -1, 0) up (0, 0, -1) d 1";
    let board = |square: f64| format!("checkerboard {{ square {square} colors (white, black) }}");
    is_share(camera, &board(1.0), 0.5);
    is_share(camera, &board(0.125), 0.5);
    let moved = "eye (0.25, 1, 0.5) direction (0, -1, 0) up (0, 0, -1) d 1";
    // s integrates to −1/2 over x from −3/4 to 5/4, and to 1 · −1/2 … over z from −1/2 to 3/2.
    is_share(moved, &board(1.0), 0.5);
    let moved = "eye (0.25, 0.75, 0.5) direction (0, -1, 0) up (0, 0, -1) d 1";
    // x from −1/2 to 1: +1 − 1/2; z from −1/4 to 5/4: −1/4 + 1 − 1/4; of an area of (3/2)².
    is_share(moved, &board(1.0), 0.5 + 0.5 * (0.5 * 0.5) / 2.25);
}

#[test]
fn samples_agree_within_their_statistical_error() {
    const SAMPLES: u64 = 1024;
    let mut random = Random(20);
    for round in 0..24 {
        let mut scene = random_scene(&mut random, round % 3 != 0);
        scene.sampler = Sampler {
            method: Method::Random,
            count: Count::PerPixel(SAMPLES),
            seed: round,
        };
        let computed = exact(&scene);
        let whole = Area::whole(scene.image.width, scene.image.height);
        let control = Control {
            threads: None,
            progress: &|_| {},
            cancel: &AtomicBool::new(false),
        };
        let sampling = Sampling::new(&scene.sampler, whole.width, whole.height);
        let sampled = render(&World::new(&scene), &sampling, whole, &control).unwrap();
        // With two colours, p and 1 − p, the variance of a mean is p(1 − p)/n; with more it is at most m(1 − m)/n for
        // channels from 0 to 1 of mean m.
        let (mut sum, mut expected, mut mixed) = (0.0, 0.0, 0);
        for (x, y) in whole.iter() {
            let (a, b) = (computed.film.pixel(x, y), sampled.pixel(x, y));
            for channel in 0..3 {
                let mean = a[channel];
                let variance = mean * (1.0 - mean) / SAMPLES as f64;
                let difference = a[channel] - b[channel];
                assert!(
                    difference.abs() <= 6.5 * variance.sqrt() + 12.0 / SAMPLES as f64,
                    "round {round} at {x}, {y}: {} and {}",
                    a[channel],
                    b[channel]
                );
                if computed.bounds[whole.index(x, y)] > 0.0 {
                    sum += difference * difference;
                    expected += variance;
                    mixed += 1;
                }
            }
        }
        // Its mean is the expected one or, with several colours, below; its spread that of so many squares.
        let spread = (2.0 / f64::from(mixed.max(1))).sqrt();
        assert!(
            sum <= expected * (1.0 + 6.0 * spread),
            "round {round}: {sum:e} for {expected:e}"
        );
    }
}

#[test]
fn bounds_keep_their_promise() {
    for (far, limit) in [(Some(100.0), 1e-12), (Some(1e3), 1e-9), (None, 1e-9)] {
        let mut scene = example("figure_9_9.scn", 256, 256);
        scene.camera.far = far;
        let exact = exact(&scene);
        assert!(exact.bound() <= limit, "far {far:?}: {:e}", exact.bound());
        let certified = film::certified(&exact.film, &exact.bounds);
        assert!(
            certified as f64 >= 0.99999 * exact.bounds.len() as f64,
            "{certified}"
        );
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
    let mut random = Random(7);
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
    assert!(seen.bound() <= 1e-12, "{:e}", seen.bound());
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
    let mut random = Random(3);
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
    let mut random = Random(11);
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
    assert!(exact.bound() <= 1e-8, "{:e}", exact.bound());
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
            assert!(bound <= 1e-12, "{gap} {center}: {bound:e}");
            adds_up(&scene, gap);
        }
    }
}
