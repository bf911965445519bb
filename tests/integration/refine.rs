//! Coarse pictures are true, and the last one is the picture.

use std::sync::atomic::{AtomicBool, Ordering};

use glam::dvec2;
use pinhole::{
    area::Area,
    refine::{SIDES, coarse, render_in_steps},
    render::{Control, RenderError, render},
    sampling::Sampling,
    scene::{Count, Method, Scene},
    tracer::World,
};

use crate::figure::figure;

fn prepared(scene: &Scene) -> (World, Sampling) {
    let [width, height] = [scene.image.width, scene.image.height];
    let sampling = Sampling::new(&scene.sampler, width, height);
    (World::new(scene), sampling)
}

#[test]
fn steps_become_finer_and_end_with_the_picture() {
    let (world, sampling) = prepared(&figure(101, 67, Method::Halton, Count::PerPixel(5)));
    let control = Control {
        threads: None,
        progress: &|_| {},
        cancel: &AtomicBool::new(false),
    };
    let part: Area = "3,2,97,61".parse().unwrap();
    let mut shown = Vec::new();
    let last = render_in_steps(&world, &sampling, part, &control, |coarse| {
        shown.push(coarse)
    });
    assert_eq!(
        last.unwrap(),
        render(&world, &sampling, part, &control).unwrap()
    );
    assert!(shown.iter().map(|coarse| coarse.side).eq(SIDES));
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

#[test]
fn a_preview_can_be_ended_at_every_step() {
    let (world, sampling) = prepared(&figure(64, 36, Method::Random, Count::PerPixel(1 << 40)));
    for end in 1..=SIDES.len() {
        let cancel = AtomicBool::new(false);
        let control = Control {
            threads: None,
            progress: &|_| {},
            cancel: &cancel,
        };
        let mut steps = 0;
        let whole = Area::whole(64, 36);
        let ended = render_in_steps(&world, &sampling, whole, &control, |_| {
            steps += 1;
            cancel.store(steps == end, Ordering::Relaxed);
        });
        assert!(matches!(ended, Err(RenderError::Cancelled)));
        assert_eq!(steps, end);
    }
}

#[test]
fn a_block_of_one_pixel_shows_its_centre() {
    let (world, _) = prepared(&figure(16, 9, Method::Random, Count::PerPixel(1)));
    let control = Control {
        threads: None,
        progress: &|_| {},
        cancel: &AtomicBool::new(false),
    };
    let film = coarse(&world, Area::whole(16, 9), 1, &control)
        .unwrap()
        .film;
    for (x, y) in Area::whole(16, 9).iter() {
        let color = world.palette()[world.slot_at(x, y, dvec2(0.0, 0.0))];
        assert_eq!(film.pixel(x, y), color.to_linear());
    }
}
