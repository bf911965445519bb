//! What is found of a part.

use std::ops::ControlFlow;

use super::{Part, Quartering, Scratch, candidates};
use crate::{
    area::Area,
    scene::{self, Scene},
    source::{Source, Sources},
    tracer::World,
};

const SIZE: u32 = 64;

fn read(objects: &str) -> Scene {
    let text = format!(
        "image {{ width {SIZE} height {SIZE} }} camera {{ eye (0, 0, 0) direction (0, 0, -1) d 2 }} {objects}"
    );
    let sources = Sources::new(Source::from_text("a.scn", text));
    scene::read(&sources).scene.unwrap()
}

/// A thousand spheres of a depth all over the picture.
fn thousand_spheres(depth: f64) -> String {
    let sphere = |index: i32| {
        let x = (f64::from(index % 40) - 19.5) * 0.02 * depth;
        let y = (f64::from(index / 40) - 12.0) * 0.02 * depth;
        let radius = depth * 0.004;
        format!("sphere {{ center ({x}, {y}, -{depth}) radius {radius} }} ")
    };
    (0..1000).map(sphere).collect()
}

/// Large triangles in planes behind each other, in any order, before the first of which nothing lies.
fn triangles_in_layers(count: usize) -> String {
    let triangle = |index: usize| {
        let depth = 10.0 + (index * 37 % count) as f64 / 64.0;
        format!(
            "triangle {{ centroid (0, 0, -{depth}) normal (0.3, 0.2, 1) sides (400, 400, 400) }} "
        )
    };
    (0..count).map(triangle).collect()
}

/// Boards below each other and above each other, of one colour each, in any order; the horizon lies in the picture.
fn boards_in_layers(count: usize) -> String {
    let board = |index: usize| {
        let height = 1.0 + (index * 37 % count) as f64 / 64.0;
        let sign = ["", "-"][index % 2];
        format!("checkerboard {{ y {sign}{height} colors (teal, teal) }} ")
    };
    (0..count).map(board).collect()
}

#[test]
fn of_layers_only_those_that_are_seen_are_candidates() {
    for count in [9, 33, 101, 1001] {
        for layers in [triangles_in_layers(count), boards_in_layers(count)] {
            let world = World::new(&read(&layers));
            let parts = Quartering::new(&world);
            let flow = parts.parts(
                Area::whole(SIZE, SIZE),
                &mut Scratch::default(),
                &mut |part| {
                    let few = match part {
                        Part::OneColor { .. } => 0,
                        // All boards meet at the horizon, between these two rows.
                        Part::Pixel { y: 31 | 32, .. } => 0,
                        Part::Pixel { candidates, .. } => candidates.len(),
                        Part::Crowded { .. } => usize::MAX,
                    };
                    assert!(few <= 2, "{count}: {part:?}");
                    ControlFlow::Continue(())
                },
            );
            assert!(flow.is_continue());
        }
    }
}

#[test]
fn what_a_wall_hides_is_not_found() {
    let wall = "box { min (-9, -9, -5) max (9, 9, -4) }";
    let mut found = Vec::new();
    for (depth, behind) in [(8.0, true), (3.0, false)] {
        let world = World::new(&read(&format!("{} {wall}", thousand_spheres(depth))));
        let whole = Area::whole(SIZE, SIZE);
        assert_eq!(candidates::within(&world, whole, 1, &mut found), behind);
        assert!(candidates::within(&world, whole, usize::MAX, &mut found));
        assert_eq!(found.len() == 1, behind);
        assert!(behind || found.len() == 1001, "{}", found.len());
        // Neither where it lies across the cells of the quadtree.
        for part in whole.tiles(7) {
            assert!(candidates::within(&world, part, usize::MAX, &mut found));
            assert!(found.len() == 1 || !behind, "{part:?}");
        }
    }
}
