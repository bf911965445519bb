//! A picture does not depend on how it was rendered.

use std::{
    num::NonZero,
    sync::atomic::{AtomicBool, AtomicU64, Ordering},
};

use pinhole::{
    area::Area,
    film::Film,
    render::{Control, RenderError, render},
    sampling::Sampling,
    scene::{Count, Method, Scene},
    tracer::World,
};

use crate::{figure::figure, sampling::placed};

fn picture(scene: &Scene, part: Area, threads: usize) -> Film {
    let control = Control {
        threads: NonZero::new(threads),
        ..Control::default()
    };
    let [width, height] = [scene.image.width, scene.image.height];
    let sampling = Sampling::new(&scene.sampler, width, height);
    render(&World::new(scene), &sampling, part, &control).unwrap()
}

#[test]
fn any_number_of_threads_makes_the_same_picture() {
    for method in Method::SAMPLED {
        let scene = figure(61, 37, method, Count::Total(61 * 37 * 5 + 300));
        let whole = Area::whole(61, 37);
        let one = picture(&scene, whole, 1);
        assert_eq!(one, picture(&scene, whole, 2));
        assert_eq!(one, picture(&scene, whole, 7));
    }
}

#[test]
fn a_crop_is_the_part_of_the_whole_picture() {
    for method in Method::SAMPLED {
        let scene = figure(61, 37, method, Count::Total(61 * 37 * 5 + 300));
        let whole = picture(&scene, Area::whole(61, 37), 2);
        for part in [
            "0,0,1,1",
            "60,36,1,1",
            "13,7,20,29",
            "0,0,61,37",
            "5,0,1,37",
        ] {
            let part: Area = part.parse().unwrap();
            let cropped = picture(&scene, part, 2);
            assert_eq!(
                [cropped.width(), cropped.height()],
                [part.width, part.height]
            );
            for (x, y) in part.iter() {
                assert_eq!(cropped.pixel(x - part.x, y - part.y), whole.pixel(x, y));
            }
        }
    }
}

#[test]
fn a_pixel_is_the_mean_of_its_samples() {
    let scene = figure(16, 9, Method::Sobol, Count::PerPixel(10_000));
    let film = picture(&scene, Area::whole(16, 9), 2);
    let (world, sampling) = (World::new(&scene), Sampling::new(&scene.sampler, 16, 9));
    for (x, y) in Area::whole(16, 9).iter() {
        let mut counts = vec![0_u64; world.palette().len()];
        for point in placed(&sampling, [x, y], 0..10_000) {
            counts[world.slot_at(x, y, point)] += 1;
        }
        let seen = counts
            .iter()
            .zip(world.palette())
            .map(|(&count, color)| (count, color.to_linear()));
        assert_eq!(film.pixel(x, y), pinhole::film::mean(seen));
    }
}

#[test]
fn pixels_without_a_sample_show_the_background() {
    let mut scene = figure(40, 30, Method::Random, Count::Total(100));
    scene.image.background = pinhole::color::Color::from_bytes([1, 2, 3]);
    let background = scene.image.background.to_linear();
    let film = picture(&scene, Area::whole(40, 30), 2);
    let sampling = Sampling::new(&scene.sampler, 40, 30);
    let mut empty = 0;
    for (x, y) in Area::whole(40, 30).iter() {
        if sampling.count(x, y) == 0 {
            empty += 1;
            assert_eq!(film.pixel(x, y), background);
        }
    }
    assert_eq!(empty, 1100);
}

#[test]
fn progress_adds_up() {
    for (size, count) in [(60, Count::PerPixel(5)), (2, Count::PerPixel(10_000_000))] {
        let scene = figure(size, size, Method::Regular, count);
        let sampling = Sampling::new(&scene.sampler, size, size);
        let done = AtomicU64::new(0);
        let control = Control {
            threads: None,
            progress: &|samples| {
                done.fetch_add(samples, Ordering::Relaxed);
            },
            cancel: &AtomicBool::new(false),
        };
        let world = World::new(&Scene {
            objects: Vec::new(),
            ..scene.clone()
        });
        render(&world, &sampling, Area::whole(size, size), &control).unwrap();
        assert_eq!(done.into_inner(), sampling.total());
    }
}

#[test]
fn a_render_without_end_can_be_ended() {
    for (size, count) in [(1, 1 << 53), (1 << 10, 1 << 33)] {
        let scene = figure(size, size, Method::Random, Count::PerPixel(count));
        let cancel = AtomicBool::new(false);
        let control = Control {
            threads: None,
            progress: &|_| cancel.store(true, Ordering::Relaxed),
            cancel: &cancel,
        };
        let sampling = Sampling::new(&scene.sampler, size, size);
        let ended = render(
            &World::new(&scene),
            &sampling,
            Area::whole(size, size),
            &control,
        );
        assert!(matches!(ended, Err(RenderError::Cancelled)));
    }
}
