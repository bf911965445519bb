//! What is found of a part.

use std::{fmt::Write, ops::ControlFlow};

use glam::dvec3;

use super::{Part, Quartering, Room, candidates};
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
    let mut text = String::new();
    for index in 0..1000 {
        let at = dvec3(
            f64::from(index % 40) - 19.5,
            f64::from(index / 40) - 12.0,
            0.0,
        ) * 0.02;
        let at = at * depth;
        let _ = write!(
            text,
            "sphere {{ center ({}, {}, {}) radius {} }} ",
            at.x,
            at.y,
            -depth,
            depth * 0.004
        );
    }
    text
}

/// Large triangles in planes behind each other, in any order, before the first of which nothing lies.
fn triangles_in_layers(count: usize) -> String {
    let mut text = String::new();
    for index in 0..count {
        let depth = 10.0 + (index * 37 % count) as f64 / 64.0;
        let _ = write!(
            text,
            "triangle {{ centroid (0, 0, -{depth}) normal (0.3, 0.2, 1) sides (400, 400, 400) }} "
        );
    }
    text
}

/// Boards below each other and above each other, of one colour each, in any order; the horizon lies in the picture.
fn boards_in_layers(count: usize) -> String {
    let mut text = String::new();
    for index in 0..count {
        let height = 1.0 + (index * 37 % count) as f64 / 64.0;
        let sign = if index % 2 == 0 { "" } else { "-" };
        let _ = write!(
            text,
            "checkerboard {{ y {sign}{height} colors (teal, teal) }} "
        );
    }
    text
}

#[test]
fn of_layers_only_those_that_are_seen_are_candidates() {
    for count in [9, 33, 101, 1001] {
        for layers in [triangles_in_layers(count), boards_in_layers(count)] {
            let world = World::new(&read(&layers));
            let parts = Quartering::new(&world);
            let flow = parts.parts(Area::whole(SIZE, SIZE), &mut Room::default(), &mut |part| {
                let few = match part {
                    Part::Flat { .. } => 0,
                    // All boards meet at the horizon, between these two rows.
                    Part::Open { y: 31 | 32, .. } => 0,
                    Part::Open { candidates, .. } => candidates.len(),
                    Part::Plain { .. } => usize::MAX,
                };
                assert!(few <= 2, "{count}: {part:?}");
                ControlFlow::Continue(())
            });
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

#[test]
fn a_part_is_plain_where_its_candidates_are_more_than_its_samples_are_worth() {
    let world = World::new(&read(&thousand_spheres(3.0)));
    let plain = |samples: f64| {
        let parts = Quartering::for_samples(&world, samples);
        let mut plain = 0;
        let flow = parts.parts(Area::whole(SIZE, SIZE), &mut Room::default(), &mut |part| {
            if let Part::Plain { area } = part {
                plain += area.pixels();
            }
            ControlFlow::Continue(())
        });
        assert!(flow.is_continue());
        plain
    };
    let all = u64::from(SIZE * SIZE);
    assert_eq!(
        [0.0, 0.25, 64.0, f64::INFINITY].map(plain),
        [all, all, 0, 0]
    );
}

#[test]
fn a_pixel_has_the_same_candidates_in_every_part() {
    let scene = format!(
        "{} checkerboard {{ square 0.3 y -1 }}",
        thousand_spheres(5.0)
    );
    let world = World::new(&read(&scene));
    for samples in [1.0, 16.0, f64::INFINITY] {
        let parts = Quartering::for_samples(&world, samples);
        let of = |wanted: Area| {
            let mut of_pixels = vec![String::new(); wanted.pixels() as usize];
            let flow = parts.parts(wanted, &mut Room::default(), &mut |part| {
                let (area, text) = match part {
                    Part::Flat { area, slot } => (area, format!("{slot}")),
                    Part::Open {
                        x, y, candidates, ..
                    } => (Area::pixel(x, y), format!("{candidates:?}")),
                    Part::Plain { area } => (area, "plain".to_owned()),
                };
                for (x, y) in area.iter() {
                    let pixel = &mut of_pixels[wanted.index(x, y)];
                    assert!(pixel.is_empty());
                    pixel.clone_from(&text);
                }
                ControlFlow::Continue(())
            });
            assert!(flow.is_continue());
            of_pixels
        };
        let whole = Area::whole(SIZE, SIZE);
        let all = of(whole);
        for wanted in [
            "0,0,64,64",
            "3,5,40,7",
            "31,31,2,2",
            "63,10,1,54",
            "33,0,31,64",
        ] {
            let wanted: Area = wanted.parse().unwrap();
            let part = of(wanted);
            for (x, y) in wanted.iter() {
                assert_eq!(part[wanted.index(x, y)], all[whole.index(x, y)], "{x}, {y}");
            }
        }
    }
}
