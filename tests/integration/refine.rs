//! Tests of previews: the picture is first rendered in large blocks, each in the colour at its
//! centre, and then in smaller and smaller blocks.

use std::sync::atomic::{AtomicBool, Ordering};

use glam::dvec2;
use pinhole::{
    area::Area,
    refine::{SIDES, coarse_to_fine},
    render::{Control, RenderError},
    tracer::World,
};

use crate::scenes::example;

#[test]
fn coarse_steps_become_finer_and_show_the_centres_of_blocks() {
    let world = World::new(&example("figure_9_9", 101, 67));
    let part: Area = "3,2,97,61".parse().unwrap();
    for (finest, sides) in [
        (1, &[16, 8, 4, 2, 1][..]),
        (3, &[16, 8, 4, 3]),
        (8, &[16, 8]),
        (40, &[40]),
    ] {
        let mut shown = Vec::new();
        let show = |coarse| shown.push(coarse);
        coarse_to_fine(&world, part, finest, &Control::default(), show).unwrap();
        assert!(shown.iter().map(|coarse| &coarse.side).eq(sides));
        for coarse in shown {
            assert_eq!(coarse.film.width(), 97_u32.div_ceil(coarse.side));
            assert_eq!(coarse.film.height(), 61_u32.div_ceil(coarse.side));
            for (pixel, block) in coarse.film.pixels().iter().zip(part.tiles(coarse.side)) {
                // The test computes the block's centre in another way than the program: from the
                // block's middle pixel and an offset of 0 or 1/2 pixel.
                let (right, down) = (block.width - 1, block.height - 1);
                let offset = dvec2(f64::from(right % 2), f64::from(down % 2)) / 2.0;
                let (x, y) = (block.x + right / 2, block.y + down / 2);
                let color = world.palette()[world.color_index_at(x, y, offset)];
                assert_eq!(*pixel, color.to_linear(), "{block}");
            }
        }
    }
}

#[test]
fn a_preview_can_be_cancelled_at_every_step() {
    let world = World::new(&example("figure_9_9", 64, 36));
    for end in 1..=SIDES.len() {
        let cancel = AtomicBool::new(false);
        let control = Control {
            cancel: &cancel,
            ..Control::default()
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
