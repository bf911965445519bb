//! What is found of a part, and what that may cost.

use std::{fmt::Write, ops::ControlFlow};

use glam::dvec3;

use super::{Among, Part, Quartering, Room, budget::Budget};
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
fn layers_cost_what_is_seen_of_them_however_many_they_are() {
    for count in [9, 31, 32, 33, 101, 1001] {
        for layers in [triangles_in_layers(count), boards_in_layers(count)] {
            let world = World::new(&read(&layers));
            for samples in [4.0, 16.0, f64::INFINITY] {
                let quartering = match samples.is_finite() {
                    // Of a thousand, rays ask few, the nearest first.
                    true if count > 1000 => continue,
                    true => Quartering::for_samples(&world, samples),
                    false => Quartering::new(&world),
                };
                let mut room = Room::default();
                for tile in Area::whole(SIZE, SIZE).tiles(16) {
                    let flow = quartering.parts(tile, &mut room, &mut |part| {
                        let few = match part {
                            Part::Flat { .. } => 0,
                            Part::Open { live, .. } => live.len(),
                            Part::Plain { among, .. } => match among {
                                Among::All => usize::MAX,
                                Among::Crowd(crowd) => crowd.len(),
                                Among::Live(live) => live.len(),
                            },
                        };
                        // At the horizon the nearest one below and the nearest one above.
                        assert!(few <= 2, "{count}, {samples} samples: {part:?}");
                        ControlFlow::Continue(())
                    });
                    assert!(flow.is_continue());
                }
            }
        }
    }
}

#[test]
fn squares_no_longer_than_pixels_are_not_asked_for_in_quarters() {
    let part = Area {
        x: 0,
        y: SIZE - 16,
        width: 16,
        height: 16,
    };
    for (square, is_dust) in [("0.001", true), ("0.2", false)] {
        let board = format!("checkerboard {{ y -1 square {square} }}");
        let world = World::new(&read(&board));
        let mut parts = 0;
        let mut room = Room::default();
        let flow = Quartering::for_samples(&world, 1.0).parts(part, &mut room, &mut |_| {
            parts += 1;
            ControlFlow::Continue(())
        });
        assert!(flow.is_continue());
        assert_eq!(parts == 1, is_dust, "{square}: {parts} parts");
    }
}

#[test]
fn bounds_that_hold_a_part_hardly_cut_it_be_it_one_pixel_high() {
    let whole = Area::whole(SIZE, SIZE);
    let middle = SIZE / 2;
    let row = Area {
        y: middle,
        height: 1,
        ..whole
    };
    let column = Area {
        x: middle,
        width: 1,
        ..whole
    };
    let mut crowd = Vec::new();
    for (objects, is_hardly) in [
        (triangles_in_layers(40), true),
        (thousand_spheres(3.0), false),
    ] {
        let world = World::new(&read(&objects));
        for part in [whole, row, column] {
            assert!(world.crowd_in(part, 1 << 20, &mut crowd));
            assert!(!crowd.is_empty());
            assert_eq!(world.is_hardly_cut(part, &crowd), is_hardly, "{part:?}");
        }
    }
}

#[test]
fn what_a_wall_hides_is_not_found() {
    let wall = "box { min (-9, -9, -5) max (9, 9, -4) }";
    let mut crowd = Vec::new();
    for (depth, behind) in [(8.0, true), (3.0, false)] {
        let world = World::new(&read(&format!("{} {wall}", thousand_spheres(depth))));
        let whole = Area::whole(SIZE, SIZE);
        assert_eq!(world.crowd_in(whole, 4, &mut crowd), behind);
        assert!(world.crowd_in(whole, 1 << 20, &mut crowd));
        assert_eq!(crowd.len() == 1, behind);
        assert!(behind || crowd.len() == 1001, "{}", crowd.len());
        // Neither where it lies across the cells of the hierarchy.
        for part in whole.tiles(7) {
            assert!(world.crowd_in(part, 1 << 20, &mut crowd));
            assert!(crowd.len() == 1 || !behind, "{part:?}");
        }
    }
}

#[test]
fn budgets_of_all_sizes() {
    let (pixel, tile) = (Area::pixel(0, 0), Area::whole(64, 64));
    let most = |samples, area| Budget::of(samples).most(area);
    assert_eq!([0.0, 0.3, 1.0].map(|samples| most(samples, pixel)), [0; 3]);
    assert_eq!(
        [0.0, 0.003, 1.0].map(|samples| most(samples, tile)),
        [0, 0, 256]
    );
    assert_eq!(most(64.0, pixel), 44);
    assert!(most(libm::exp2(60.0), tile) > 1 << 60);
    assert_eq!(Budget::ENDLESS.most(pixel), usize::MAX);
    // In a crowd 64 samples pay for five boxes, and eight for one sphere or triangle.
    assert!(Budget::of(64.0).is_for_forms(5 * 8) && !Budget::of(64.0).is_for_forms(6 * 8));
    assert!(Budget::of(8.0).is_for_forms(4) && !Budget::of(8.0).is_for_forms(6));
    assert!(Budget::ENDLESS.is_for_forms(1 << 40));
    assert!(Budget::of(16.0).is_for_a_look(tile, 4) && !Budget::of(1.0).is_for_a_look(tile, 128));
}

#[test]
fn rays_that_ask_many_objects_raise_the_budget() {
    let slivers: String = (0..400)
        .map(|index| {
            let depth = 5.0 + f64::from(index) / 1000.0;
            format!(
                "triangle {{ centroid ({}, 0, -{depth}) normal (0, 0, 1) spin 45deg sides (8, 8, 0.001) }} ",
                f64::from(index % 20) / 40.0 - 0.25
            )
        })
        .collect();
    let (slivers, spheres) = (read(&slivers), read(&thousand_spheres(5.0)));
    let raised = |scene: &Scene| {
        let area = Area::whole(SIZE, SIZE);
        let budget = Budget::of(1.0);
        let probed = budget.probed(&World::new(scene), area);
        probed.most(area) as f64 / budget.most(area) as f64
    };
    assert!(raised(&slivers) > 5.0, "{}", raised(&slivers));
    assert!(raised(&spheres) < 2.0, "{}", raised(&spheres));
    // Few samples are not worth it.
    let world = World::new(&slivers);
    let few = Budget::of(1.0).probed(&world, Area::whole(8, 8));
    assert_eq!(
        few.most(Area::whole(8, 8)),
        Budget::of(1.0).most(Area::whole(8, 8))
    );
}

#[test]
fn parts_are_of_all_kinds_but_for_exact_pictures() {
    let floor = "checkerboard { square 0.3 y -1 } sphere { center (0, 1, -6) }";
    let world = World::new(&read(&format!("{} {floor}", thousand_spheres(5.0))));
    let count = |quartering: &Quartering| {
        let mut kinds = [0; 5];
        for tile in Area::whole(SIZE, SIZE).tiles(16) {
            let flow = quartering.parts(tile, &mut Room::default(), &mut |part| {
                kinds[match part {
                    Part::Flat { .. } => 0,
                    Part::Open { .. } => 1,
                    Part::Plain { among, .. } => match among {
                        Among::Live(_) => 2,
                        Among::Crowd(_) => 3,
                        Among::All => 4,
                    },
                }] += 1;
                ControlFlow::Continue(())
            });
            assert!(flow.is_continue());
        }
        kinds
    };
    let [one, three] = [1.0, 3.0].map(|samples| count(&Quartering::for_samples(&world, samples)));
    let found = |kind: usize| one[kind] + three[kind] > 0;
    assert!((0..5).all(found), "{one:?} {three:?}");
    let [flat, open, plain @ ..] = count(&Quartering::new(&world));
    assert!(flat > 0 && open > 0 && plain == [0; 3]);
    assert_eq!(
        count(&Quartering::for_samples(&world, 0.0)),
        [0, 0, 0, 0, 16]
    );
}

#[test]
fn areas_are_left_out_after_crowded_ones_and_looked_at_again() {
    // Spheres smaller than pixels, of which a look gains nothing, in all columns up to the middle; beyond it there is nothing.
    let crowd: String = (0..30_000)
        .map(|index| {
            let at = dvec3(
                f64::from(index % 150) / 150.0 - 1.0,
                f64::from(index / 150) / 100.0 - 1.0,
                0.0,
            ) * 2.5;
            format!("sphere {{ center ({}, {}, -5) radius 0.004 }} ", at.x, at.y)
        })
        .collect();
    let world = World::new(&read(&crowd));
    let quartering = Quartering::for_samples(&world, 4.0);
    let mut room = Room::default();
    // How many of so many looks at an area find that it has one colour.
    let mut flat = |x: u32, looks: usize| {
        let area = Area {
            x,
            y: 24,
            width: 16,
            height: 16,
        };
        let mut flat = 0;
        for _ in 0..looks {
            let flow = quartering.parts(area, &mut room, &mut |part| {
                flat += usize::from(matches!(part, Part::Flat { .. }));
                ControlFlow::Continue(())
            });
            assert!(flow.is_continue());
        }
        flat
    };
    assert_eq!(flat(48, 10), 10);
    // Ten of these are four looks, and six that are left out.
    assert_eq!(flat(8, 10), 0);
    assert_eq!(flat(48, 10), 6);
    assert_eq!(flat(48, 10), 10);
}
