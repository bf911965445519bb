//! A picture does not depend on how it was rendered.

use std::{
    num::NonZero,
    sync::atomic::{AtomicBool, Ordering},
};

use pinhole::{
    area::Area,
    film::Film,
    render::{Control, RenderError, render},
    sampling::Sampling,
    scene::{Count, Method, Scene},
    tracer::World,
};

use crate::{figure::figure, scenes::sampled_by};

fn picture(scene: &Scene, part: Area, threads: usize) -> Film {
    let control = Control {
        threads: NonZero::new(threads),
        ..Control::default()
    };
    sampled_by(scene, part, &control)
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
