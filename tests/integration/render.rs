//! A picture does not depend on how it was rendered.

use std::{
    num::NonZero,
    sync::atomic::{AtomicBool, Ordering},
};

use pinhole::{
    area::Area,
    film::Film,
    render::{Control, RenderError, render},
    scene::{Count, Method, Scene},
    tracer::World,
};

use crate::scenes::{example, sampled_by, sampling, whole, with_samples};

fn figure(width: u32, height: u32, method: Method, count: Count) -> Scene {
    with_samples(&example("figure_9_9", width, height), method, count)
}

fn picture(scene: &Scene, part: Area, threads: usize) -> Film {
    let control = Control {
        threads: NonZero::new(threads),
        ..Control::default()
    };
    sampled_by(scene, part, &control)
}

#[test]
fn threads_and_crops_change_no_pixel() {
    for method in Method::SAMPLED {
        let scene = figure(61, 37, method, Count::Total(61 * 37 * 5 + 300));
        let one = picture(&scene, whole(&scene), 1);
        for (threads, part) in [
            (2, "0,0,61,37"),
            (7, "0,0,61,37"),
            (2, "0,0,1,1"),
            (2, "60,36,1,1"),
            (2, "13,7,20,29"),
            (2, "5,0,1,37"),
        ] {
            let part: Area = part.parse().unwrap();
            let cropped = picture(&scene, part, threads);
            assert_eq!(
                (cropped.width(), cropped.height()),
                (part.width, part.height)
            );
            for (x, y) in part.iter() {
                assert_eq!(cropped.pixel(x - part.x, y - part.y), one.pixel(x, y));
            }
        }
    }
}

#[test]
fn pixels_without_a_sample_show_the_background() {
    let mut scene = figure(40, 30, Method::Random, Count::Total(100));
    scene.image.background = pinhole::color::Color::from_bytes([1, 2, 3]);
    let film = picture(&scene, whole(&scene), 2);
    let sampling = sampling(&scene);
    let pixels = whole(&scene).iter();
    let empty = pixels.filter(|&(x, y)| sampling.count(x, y) == 0);
    let empty: Vec<_> = empty.map(|(x, y)| film.pixel(x, y)).collect();
    assert_eq!(empty, [scene.image.background.to_linear(); 1100]);
}

#[test]
fn a_render_without_end_can_be_ended() {
    for (size, count) in [(1, 1 << 53), (1 << 10, 1 << 33)] {
        let scene = figure(size, size, Method::Random, Count::PerPixel(count));
        let cancel = AtomicBool::new(false);
        let control = Control {
            progress: &|_| cancel.store(true, Ordering::Relaxed),
            cancel: &cancel,
            ..Control::default()
        };
        let ended = render(
            &World::new(&scene),
            &sampling(&scene),
            whole(&scene),
            &control,
        );
        assert!(matches!(ended, Err(RenderError::Cancelled)));
    }
}
