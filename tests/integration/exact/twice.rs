//! The computed picture against itself in other ways: in pieces, turned, in parts, on other threads.

use super::*;
use crate::effort::{Effort, sampled_and_exhaustive};

#[test]
fn four_quarters_are_the_pixel() {
    for name in examples() {
        adds_up(&example(&name, 48, 32), &name);
    }
}

#[test]
fn four_quarters_are_the_pixel_of_scenes_that_pierce_themselves() {
    let mut random = Random::new(7);
    for round in 0..24 {
        adds_up(
            &random_scene(&mut random, round % 2 == 0),
            &format!("round {round}"),
        );
    }
}

sampled_and_exhaustive!(four_quarters_are_the_pixel_of_extreme_cameras);

fn four_quarters_are_the_pixel_of_extreme_cameras(effort: Effort) {
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
    let table = [
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
    ];
    for (name, scene) in effort.first(3, table) {
        adds_up(&scene, name);
    }
}

/// A sphere that goes through a face which the eye is hardly above: its circle there is seen as an ellipse that is hardly more than a line.
#[test]
fn four_quarters_are_the_pixel_where_a_circle_is_seen_edge_on() {
    let face = "box { min (-100, -50, -100) max (100, 0, 100) color black }";
    let board = "checkerboard { square 1e-4 colors (white, black) }";
    let view = |eye: &str, rest: &str, size: u32, below: &str| {
        read(&format!(
            "image {{ width {size} height {size} background blue }}
             camera {{ eye {eye} {rest} }}
             sphere {{ center (0, 0, 0) radius 1 color red }}
             {below}"
        ))
    };
    let level = "direction (0, 0, -1) roll 45deg d 1 view_height 0.3333333333333333";
    let mut random = Random::new(9);
    for exponent in 6..28 {
        let height = libm::ldexp(random.within(1.0, 2.0), -2 * exponent);
        let eye = format!("({}, {height:e}, 3)", random.within(-0.5, 0.5));
        for below in [face, board] {
            let scene = view(&eye, level, 2, below);
            let bound = exact(&scene).bound();
            assert!(bound <= 1e-9, "{eye}: {bound:e}");
            adds_up(&scene, &eye);
        }
    }
    // By an integral along x of 50 digits, split where the outline meets the pixel's sides.
    let scene = view(
        "(0.26249413893393775, 3.1572076715858895e-08, 3)",
        level,
        1,
        face,
    );
    let found = exact(&scene);
    let off = (found.film.pixel(0, 0)[0] - 0.500_000_064_227_617_3).abs();
    assert!(off <= found.bound() && found.bound() < 1e-9, "{off:e}");
}

#[test]
fn a_quarter_turn_sweeps_the_other_way() {
    let mut scenes: Vec<_> = examples()
        .iter()
        .map(|name| example(name, 40, 40))
        .collect();
    let mut random = Random::new(8);
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
