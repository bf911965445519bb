//! How far two pictures are apart.

use pinhole::{
    area::Area,
    color::srgb_to_linear,
    film::{Film, Largest, Tolerance, compare, heat_map},
};

const HALF: Tolerance = Tolerance {
    steps: 0.5,
    bounds: None,
};

fn film(pixels: &[[f64; 3]]) -> Film {
    let mut film = Film::new(pixels.len() as u32, 1).unwrap();
    film.put(Area::whole(pixels.len() as u32, 1), pixels);
    film
}

#[test]
fn the_largest_difference_has_a_place() {
    let a = film(&[[0.0; 3], [0.5, 0.25, srgb_to_linear(10.0 / 255.0)]]);
    let b = film(&[[0.0; 3], [0.5, 0.25, srgb_to_linear(13.0 / 255.0)]]);
    let found = compare(&a, &b, HALF).unwrap();
    let Largest {
        steps,
        x,
        y,
        channel,
        a,
        b,
    } = found.largest;
    assert_eq!((x, y, channel), (1, 0, 2));
    assert!((steps - 3.0).abs() < 1e-9 && (a - 10.0).abs() < 1e-9 && (b - 13.0).abs() < 1e-9);
    assert_eq!((found.beyond, found.share()), (1, 0.5));
    assert!(!found.is_equal());
}

#[test]
fn the_root_mean_square_is_of_all_channels() {
    let found = compare(
        &film(&[[0.0; 3], [0.6, 0.0, 0.0]]),
        &film(&[[0.0; 3]; 2]),
        HALF,
    );
    assert!((found.unwrap().rmse - (0.36f64 / 6.0).sqrt()).abs() < 1e-15);
}

#[test]
fn a_tolerance_takes_its_own_steps_and_the_bound() {
    let at = |k: f64| film(&[[srgb_to_linear(k / 255.0); 3]]);
    for k in 0..255 {
        let k = f64::from(k);
        assert!(
            compare(&at(k), &at(k + 0.5), HALF).unwrap().is_equal(),
            "{k}"
        );
        assert!(
            !compare(&at(k), &at(k + 0.501), HALF).unwrap().is_equal(),
            "{k}"
        );
    }
    let bounded = Tolerance {
        bounds: Some(&[1e-3]),
        ..HALF
    };
    let (dark, light) = (
        film(&[[0.0; 3]]),
        film(&[[1e-3 + 0.4 / (12.92 * 255.0); 3]]),
    );
    assert!(!compare(&dark, &light, HALF).unwrap().is_equal());
    let found = compare(&dark, &light, bounded).unwrap();
    assert!(found.is_equal() && found.undecided == 1);
    // As far as the bound alone may reach, too.
    assert_eq!(compare(&dark, &dark, bounded).unwrap().undecided, 1);
    let little = Tolerance {
        bounds: Some(&[1e-6]),
        ..HALF
    };
    assert_eq!(compare(&dark, &dark, little).unwrap().undecided, 0);
}

#[test]
fn sizes_that_differ_are_told() {
    let told = compare(&film(&[[0.0; 3]]), &film(&[[0.0; 3]; 2]), HALF).unwrap_err();
    assert_eq!(told.to_string(), "the sizes differ: 1 × 1 pixels and 2 × 1");
}

#[test]
fn heat_grows_ever_brighter() {
    let black = film(&[[0.0; 3]; 256]);
    let steps = (0..256).map(|step| [srgb_to_linear(f64::from(step) / 255.0); 3]);
    let map = heat_map(&black, &film(&steps.collect::<Vec<_>>()), HALF).unwrap();
    let brightness = map
        .pixels()
        .iter()
        .map(|[r, g, b]| 0.2126 * r + 0.7152 * g + 0.0722 * b);
    let brightness: Vec<_> = brightness.collect();
    assert!(brightness[0] == 0.0 && brightness.is_sorted_by(|a, b| a < b));
    assert!(
        map.pixel(255, 0)
            .iter()
            .all(|light| (light - 1.0).abs() < 1e-12)
    );
}
