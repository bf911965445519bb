//! Coarse pictures are true and become finer.

use std::sync::atomic::{AtomicBool, Ordering};

use glam::dvec2;
use pinhole::{
    area::Area,
    refine::{SIDES, coarse_to_fine},
    render::{Control, RenderError},
    scene::{Count, Method},
    tracer::World,
};

use crate::figure::figure;

fn figure_of(width: u32, height: u32) -> World {
    World::new(&figure(width, height, Method::Random, Count::PerPixel(1)))
}

#[test]
fn steps_become_finer_and_show_what_is_there() {
    let world = figure_of(101, 67);
    let control = Control::default();
    let part: Area = "3,2,97,61".parse().unwrap();
    for (finest, sides) in [
        (1, &[16, 8, 4, 2, 1][..]),
        (3, &[16, 8, 4, 3]),
        (8, &[16, 8]),
        (40, &[40]),
    ] {
        let mut shown = Vec::new();
        coarse_to_fine(&world, part, finest, &control, |coarse| shown.push(coarse)).unwrap();
        assert!(shown.iter().map(|coarse| &coarse.side).eq(sides));
        for coarse in shown {
            assert_eq!(coarse.film.width(), 97_u32.div_ceil(coarse.side));
            assert_eq!(coarse.film.height(), 61_u32.div_ceil(coarse.side));
            for (pixel, block) in coarse.film.pixels().iter().zip(part.tiles(coarse.side)) {
                // The centre, found in another way: from the middle of the block's first pixel.
                let (right, down) = (block.width - 1, block.height - 1);
                let offset = dvec2(f64::from(right % 2), f64::from(down % 2)) / 2.0;
                let (x, y) = (block.x + right / 2, block.y + down / 2);
                let color = world.palette()[world.slot_at(x, y, offset)];
                assert_eq!(*pixel, color.to_linear(), "{block}");
            }
        }
    }
}

#[test]
fn a_preview_can_be_ended_at_every_step() {
    let world = figure_of(64, 36);
    for end in 1..=SIDES.len() {
        let cancel = AtomicBool::new(false);
        let control = Control {
            threads: None,
            progress: &|_| {},
            cancel: &cancel,
        };
        let mut steps = 0;
        let ended = coarse_to_fine(&world, Area::whole(64, 36), 1, &control, |_| {
            steps += 1;
            cancel.store(steps == end, Ordering::Relaxed);
        });
        assert!(matches!(ended, Err(RenderError::Cancelled)));
        assert_eq!(steps, end);
    }
}
