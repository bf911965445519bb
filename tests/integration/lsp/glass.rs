//! Tests of the answers about one pixel: its samples by any method, and the data of the magnifying
//! glass.

use base64::{Engine, prelude::BASE64_STANDARD};
use pinhole::{
    color::Color,
    film::Film,
    scene::{Count, Method},
};
use serde_json::{Value, json};

use super::local_client::LocalClient;
use crate::scenes::{exact, read, sampled};

const SCENE: &str = "image { width 48 height 27 }
camera { eye (0, 1, 6) lookat (0, 0.8, 0) }
sphere Ball { center (0, 1, 0) radius 1 color olive }
box { min (-3, 0, -1) max (-1.5, 1, 0) color orange }
checkerboard {}
";

/// Pixels of the scene's picture: at the sphere's edge over the board, at an edge of the box, at
/// the board alone, at the horizon, and within the sphere.
const PIXELS: [[u32; 2]; 5] = [[19, 13], [17, 12], [30, 25], [40, 12], [24, 11]];

fn numbers(value: &Value) -> Vec<f64> {
    serde_json::from_value(value.clone()).expect("a list of numbers")
}

/// A method and a number of samples in the request have the same effect as in the text.
#[test]
fn samples_are_those_of_the_scene_with_that_method_and_count() {
    let mut client = LocalClient::with(SCENE);
    for method in Method::SAMPLED.into_iter().chain([Method::Exact]) {
        for count in [1, 7, 64] {
            let text = format!("{SCENE}sampler {{ method {method} per_pixel {count} }}");
            let mut scene = read(SCENE);
            scene.sampler.method = method;
            scene.sampler.count = Count::PerPixel(count);
            let film = sampled(&scene);
            let mut written = LocalClient::with(&text);
            for pixel in PIXELS {
                let asked = json!({ "pixel": pixel, "method": method.name(), "count": count });
                let found = client.ask("pinhole/samples", asked);
                let expected = written.ask("pinhole/samples", json!({ "pixel": pixel }));
                assert_eq!(found, expected, "{method} {count} {pixel:?}");
                let [x, y] = pixel;
                assert_eq!(numbers(&found["mean"]), film.row(y)[x as usize]);
            }
        }
    }
}

/// The glass reports the same mean colour as the exact picture, to the last bit. It reports the
/// visible surfaces with the fractions of the pixel that they cover.
#[test]
fn the_glass_agrees_with_the_exact_picture_and_with_probe() {
    let scene = read(SCENE);
    let exact = exact(&scene);
    let mut client = LocalClient::with(SCENE);
    for pixel in PIXELS {
        let [x, y] = pixel;
        let found = client.ask("pinhole/glass", json!({ "pixel": pixel }));
        assert_eq!(numbers(&found["mean"]), exact.film.row(y)[x as usize]);
        assert_eq!(found["method"], scene.sampler.method.name());
        let bound = found["bound"].as_f64().expect("a bound");
        // A picture stores error bounds as `f32`, rounded up.
        let stored = f64::from(exact.bounds[(y * 48 + x) as usize]);
        assert!(
            bound <= stored && stored <= bound * 1.000_001,
            "{bound}, {stored}"
        );

        let seen = found["seen"].as_array().expect("a list");
        let shares: Vec<f64> = seen
            .iter()
            .map(|it| it["share"].as_f64().unwrap())
            .collect();
        assert!(shares.is_sorted_by(|a, b| a >= b), "{shares:?}");
        assert!(
            (shares.iter().sum::<f64>() - 1.0).abs() <= 1e-9,
            "{shares:?}"
        );
        // Among 128 × 128 samples in a grid, a surface's fraction may differ from its fraction of
        // the pixel only by the cells that the surface's edges cross. As many cells as in four rows
        // of the grid are allowed.
        let asked = json!({ "pixel": pixel, "method": "regular", "count": 128 * 128 });
        let many = client.ask("pinhole/samples", asked);
        let colors = many["colors"].as_array().expect("a list");
        let png = BASE64_STANDARD.decode(found["png"].as_str().expect("a picture"));
        let enlarged = image::load_from_memory(&png.expect("base64")).expect("a picture");
        let shown = enlarged.to_rgb8();
        assert_eq!(shown.dimensions(), (128, 128));
        let shown = shown.pixels().map(|it| Color::from_bytes(it.0).to_string());
        assert!(shown.eq(colors.iter().map(|color| color.as_str().unwrap())));
        for (it, share) in seen.iter().zip(shares) {
            let count = colors.iter().filter(|color| **color == it["color"]).count();
            assert!(
                (count as f64 / 16384.0 - share).abs() <= 4.0 / 128.0,
                "{it}"
            );
        }
    }
    // Each row has a pixel, and the names of surfaces that are visible in it.
    for (pixel, labels) in [
        ([19, 13], &["Ball", "checkerboard"][..]),
        ([24, 11], &["Ball"]),
        ([17, 12], &["box", "background"]),
        ([40, 2], &["background"]),
    ] {
        let found = client.ask("pinhole/glass", json!({ "pixel": pixel }));
        let seen = found["seen"].as_array().expect("a list");
        for label in labels {
            assert!(
                seen.iter().any(|it| it["label"] == *label),
                "{pixel:?}: {found}"
            );
        }
    }
}

/// The glass reports the error of each method with the scene's own seed (`own`). It must be the
/// error of the pixel in the rendered picture. The glass also reports the root mean square of the
/// errors with 32 seeds (`typical`). The own seed is one of them, so `typical` must be at least
/// `own`/√32.
#[test]
fn errors_of_the_own_seed_are_those_of_the_picture() {
    let mut client = LocalClient::with(SCENE);
    let mut scene = read(SCENE);
    let exact = exact(&scene).film;
    let mut answers = PIXELS.map(|pixel| client.ask("pinhole/glass", json!({ "pixel": pixel })));
    for method in Method::SAMPLED {
        for count in [1, 4, 16, 64, 256] {
            (scene.sampler.method, scene.sampler.count) = (method, Count::PerPixel(count));
            let film = sampled(&scene);
            for ([x, y], answer) in PIXELS.into_iter().zip(&mut answers) {
                let one = |film: &Film| film.row(y)[x as usize];
                let (a, b) = (one(&film), one(&exact));
                let squares: f64 = (0..3).map(|i| (a[i] - b[i]) * (a[i] - b[i])).sum();
                let at = answer["counts"].as_array().unwrap();
                let at = at.iter().position(|it| *it == count).expect("the count");
                let errors = answer["errors"].as_array().expect("a list");
                let errors = errors.iter().find(|it| it["method"] == method.name());
                let errors = errors.expect("every method");
                let own = numbers(&errors["own"])[at];
                // The glass and the picture add the samples in different orders, so their roundings
                // differ.
                assert!(
                    (own - (squares / 3.0).sqrt()).abs() <= 1e-12,
                    "{method} {count}"
                );
                let typical = numbers(&errors["typical"])[at];
                assert!(
                    typical * 32.0_f64.sqrt() >= own * (1.0 - 1e-12),
                    "{method} {count}"
                );
            }
        }
    }
    // The last of the `PIXELS` has a single colour, so every sample has the right colour.
    for errors in answers[4]["errors"].as_array().expect("a list") {
        if errors["method"] != "scatter" {
            // The mean of equal colours may have a rounding error.
            assert!(
                numbers(&errors["typical"])
                    .iter()
                    .all(|error| *error <= 1e-15)
            );
        }
    }
}

#[test]
fn what_cannot_be_asked_is_refused() {
    let mut client = LocalClient::with(SCENE);
    for (request, params) in [
        ("samples", json!({ "pixel": [1, 1], "method": "soboll" })),
        ("samples", json!({ "pixel": [1, 1], "count": 0 })),
        ("samples", json!({ "pixel": [1, 1], "count": 1 << 21 })),
        ("samples", json!({ "pixel": [48, 1] })),
        ("glass", json!({ "pixel": [1, 27] })),
        ("glass", json!({})),
    ] {
        let answer = client.respond(&format!("pinhole/{request}"), params.clone());
        assert!(answer["error"]["message"].is_string(), "{params}: {answer}");
    }
}
