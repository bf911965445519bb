//! Tests that a picture does not depend on the number of threads, on crops, or on the type of its
//! pixels.

use std::num::NonZero;

use pinhole::{
    area::Area,
    film::{Encoder, certified},
    render::{Control, Rendered},
    scene::{Count, Method},
};

use crate::scenes::{example, example_names, rendered, whole, with_samples};

#[test]
fn threads_and_crops_change_no_pixel() {
    let pictures =
        Method::SAMPLED.map(|method| ([61, 37], method, Count::Total(61 * 37 * 5 + 300)));
    // The exact picture consists of tiles, i.e. squares of pixels that one thread renders at a
    // time. It is large enough to have more tiles than threads, and tiles that the picture's edge
    // cuts off.
    let exact = ([201, 140], Method::Exact, Count::PerPixel(1));
    for ([width, height], method, count) in pictures.into_iter().chain([exact]) {
        let scene = with_samples(&example("figure_9_9", width, height), method, count);
        let picture = |part, threads| {
            let control = Control {
                threads: NonZero::new(threads),
                ..Control::default()
            };
            rendered::<[f64; 3]>(&scene, part, &control).into_film()
        };
        let one = picture(whole(&scene), 1);
        assert!(
            [2, 7]
                .iter()
                .all(|&threads| picture(whole(&scene), threads) == one)
        );
        for part in ["0,0,1,1", "60,36,1,1", "13,7,20,29", "5,0,1,37"] {
            let part: Area = part.parse().unwrap();
            assert_eq!(picture(part, 2), one.part(part).unwrap());
        }
    }
}

#[test]
fn rendered_bytes_equal_the_encoded_means() {
    let (encoder, control) = (Encoder::default(), Control::default());
    let part: Area = "3,9,66,40".parse().unwrap();
    for name in example_names() {
        for (method, count) in [
            (Method::Exact, Count::PerPixel(1)),
            (Method::MultiJittered, Count::PerPixel(1)),
            (Method::MultiJittered, Count::PerPixel(13)),
            (Method::MultiJittered, Count::Total(2_000)),
            (Method::MultiJittered, Count::Total(40_000)),
        ] {
            let scene = with_samples(&example(&name, 70, 52), method, count);
            let (bytes, light) = (
                rendered::<[u8; 3]>(&scene, part, &control),
                rendered::<[f64; 3]>(&scene, part, &control),
            );
            if let (Rendered::Exact(bytes), Rendered::Exact(light)) = (&bytes, &light) {
                assert_eq!(bytes.bounds, light.bounds, "{name}");
                assert_eq!(
                    bytes.certain,
                    certified(&light.film, &light.bounds),
                    "{name}"
                );
            }
            let (bytes, light) = (bytes.into_film(), light.into_film());
            let expected = light.pixels().iter().map(|light| encoder.pixel(*light));
            assert!(expected.eq(bytes.pixels().iter().copied()), "{name}");
        }
    }
}
