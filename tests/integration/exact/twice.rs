//! The computed picture against itself in other ways: in pieces, turned, in parts, on other threads.

use std::sync::Arc;

use super::*;
use crate::effort::{Effort, sampled_and_exhaustive};

#[test]
fn four_quarters_are_the_pixel() {
    for name in examples() {
        adds_up(&example(&name, 48, 32), &name);
    }
    // Scenes whose objects pierce each other.
    let mut random = Random::new(7);
    for round in 0..24 {
        let scene = random_scene(&mut random, round % 2 == 0);
        adds_up(&scene, &format!("round {round}"));
    }
}

/// Tilted triangles in rows, in one pixel: their planes cross each other all over it, but no two of them lie above each other.
fn side_by_side(random: &mut Random, rows: u32) -> String {
    let mut text = String::from(
        "image { width 1 height 1 background black }\ncamera { eye (0, 0, 20) lookat (0, 0, 0) d 20 }\n",
    );
    let step = 2.0 / f64::from(rows);
    for (x, y) in Area::whole(rows, rows).iter() {
        let [x, y] = [x, y].map(|at| (f64::from(at) + 0.5) * step - 1.0);
        let [tilt, turn] = [0.3, 0.3].map(|most| random.within(-most, most));
        let side = 0.6 * step;
        writeln!(
            text,
            "triangle {{ centroid ({x}, {y}, 0) normal ({tilt}, {turn}, 1) sides ({side}, {side}, {side}) }}"
        )
        .unwrap();
    }
    text
}

#[test]
fn objects_side_by_side_add_up() {
    let mut random = Random::new(71);
    for rows in [3, 5, 8] {
        let scene = read(&side_by_side(&mut random, rows));
        adds_up(&scene, &format!("{rows} rows of triangles"));
    }
}

/// Planks that pierce each other along lines that end where the one or the other does.
#[test]
fn objects_that_pierce_each_other_in_part_add_up() {
    let mut random = Random::new(72);
    for which in 0..20 {
        let mut text = String::from(
            "image { width 2 height 2 background black }\ncamera { eye (0.3, 0.2, 20) lookat (0, 0, 0) d 20 }\n",
        );
        for color in ["red", "lime", "blue", "gold", "cyan", "white"] {
            let mut number = |most: f64| random.within(-most, most);
            let center = [number(0.7), number(0.7), number(0.3)];
            let half = [0.3 + number(0.25), 0.3 + number(0.25), 0.3 + number(0.25)];
            let corner = |sign: f64| [0, 1, 2].map(|i| center[i] + sign * half[i]);
            let ([x0, y0, z0], [x1, y1, z1]) = (corner(-1.0), corner(1.0));
            writeln!(
                text,
                "box {{ min ({x0}, {y0}, {z0}) max ({x1}, {y1}, {z1}) color {color} }}"
            )
            .unwrap();
            let [x, y, z] = [number(0.6), number(0.6), number(0.2)];
            let [a, b] = [number(2.0), number(2.0)];
            writeln!(
                text,
                "triangle {{ centroid ({x}, {y}, {z}) normal ({a}, {b}, 1) sides (1.6, 1.5, 0.4) color {color} }}"
            )
            .unwrap();
        }
        adds_up(&read(&text), &format!("planks {which}"));
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
    let height = |y: f64| with(&|scene| scene.camera.eye.y = y);
    let sized = |width: u32, height: u32| {
        with(&|scene| (scene.image.width, scene.image.height) = (width, height))
    };
    let squares = |side: f64| {
        with(&|scene| {
            for object in Arc::make_mut(&mut scene.objects) {
                if let Shape::Checkerboard(board) = &mut object.shape {
                    board.square = side;
                }
            }
        })
    };
    let mut along_an_axis = wide(1e-12);
    along_an_axis.camera.view = View::Direction(dvec3(0.0, 0.0, -1.0));
    let lenses = [0.1, 0.02, 1e-3, 1e-5, 1e5].map(wide).into_iter();
    let boards = [1e-3, 1e-6, 1e-100, 1e6, 1e300].map(squares);
    let eyes = [1e-6, 1e8].map(height);
    let sizes = [(1, 1), (60, 1), (1, 60)].map(|(width, height)| sized(width, height));
    let table = lenses
        .chain(boards)
        .chain(eyes)
        .chain(sizes)
        .chain([along_an_axis]);
    for scene in effort.first(3, table) {
        adds_up(&scene, &format!("{:?} of {:?}", scene.camera, scene.image));
    }
}

/// A sphere that goes through a face which the eye is hardly above: its circle there is seen as an ellipse that is hardly more than a line.
#[test]
fn four_quarters_are_the_pixel_where_a_circle_is_seen_edge_on() {
    let face = "box { min (-100, -50, -100) max (100, 0, 100) color black }";
    let board = "checkerboard { square 1e-4 colors (white, black) }";
    let view = |eye: &str, size: u32, below: &str| {
        read(&format!(
            "image {{ width {size} height {size} background blue }}
             camera {{ eye {eye} direction (0, 0, -1) roll 45deg d 1 view_height 0.3333333333333333 }}
             sphere {{ center (0, 0, 0) radius 1 color red }}
             {below}"
        ))
    };
    let mut random = Random::new(9);
    for exponent in 6..28 {
        let height = libm::ldexp(random.within(1.0, 2.0), -2 * exponent);
        let eye = format!("({}, {height:e}, 3)", random.within(-0.5, 0.5));
        for below in [face, board] {
            let scene = view(&eye, 2, below);
            let bound = exact(&scene).bound();
            assert!(bound <= 1e-9, "{eye}: {bound:e}");
            adds_up(&scene, &eye);
        }
    }
    // By an integral along x of 50 digits, split where the outline meets the pixel's sides.
    let scene = view("(0.26249413893393775, 3.1572076715858895e-08, 3)", 1, face);
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
