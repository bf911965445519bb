//! Tests of comparing two pictures in the library. The tests of `diff` cover the command.

use pinhole::{
    color::srgb_to_linear,
    film::{Film, Tolerance, compare, heat_map},
};

const HALF: Tolerance = Tolerance {
    steps: 0.5,
    bounds: None,
};

fn film(pixels: &[[f64; 3]]) -> Film {
    Film::from_fn(pixels.len() as u32, 1, |x, _| pixels[x as usize]).unwrap()
}

/// Returns the linear light of an 8-bit sRGB value, which is given as a number from 0 to 255.
fn light(steps: f64) -> f64 {
    srgb_to_linear(steps / 255.0)
}

#[test]
fn pixels_within_the_tolerance_plus_the_bound_compare_equal() {
    for k in 0..255 {
        let k = f64::from(k);
        for (more, is_equal) in [(0.5, true), (0.501, false)] {
            let [a, b] = [k, k + more].map(|steps| film(&[[light(steps); 3]]));
            assert_eq!(compare(&a, &b, HALF).unwrap().is_equal(), is_equal, "{k}");
        }
    }
    let dark = film(&[[0.0; 3]]);
    let bright = film(&[[1e-3 + 0.4 / (12.92 * 255.0); 3]]);
    for (other, bound, is_equal, undecided) in [
        (&bright, None, false, 0),
        (&bright, Some([1e-3]), true, 1),
        // The colours are equal, but the error bound is greater than the tolerance. So it is
        // undecided whether the true colours are equal.
        (&dark, Some([1e-3]), true, 1),
        (&dark, Some([1e-6]), true, 0),
    ] {
        let tolerance = Tolerance {
            bounds: bound.as_ref().map(|bound| &bound[..]),
            ..HALF
        };
        let found = compare(&dark, other, tolerance).unwrap();
        assert_eq!((found.is_equal(), found.undecided), (is_equal, undecided));
    }
}

#[test]
fn comparing_pictures_of_different_sizes_is_an_error() {
    let told = compare(&film(&[[0.0; 3]]), &film(&[[0.0; 3]; 2]), HALF).unwrap_err();
    assert_eq!(told.to_string(), "the sizes differ: 1 × 1 pixels and 2 × 1");
}

#[test]
fn heat_map_brightness_increases_with_the_difference() {
    let steps: Vec<_> = (0..256).map(|step| [light(step.into()); 3]).collect();
    let map = heat_map(&film(&[[0.0; 3]; 256]), &film(&steps), HALF).unwrap();
    let pixels = map.pixels().iter();
    let brightness = pixels.map(|[r, g, b]| 0.2126 * r + 0.7152 * g + 0.0722 * b);
    let brightness: Vec<_> = brightness.collect();
    assert!(brightness[0] == 0.0 && brightness.is_sorted_by(|a, b| a < b));
    let last = map.pixel(255, 0);
    assert!(last.iter().all(|light| (light - 1.0).abs() < 1e-12));
}
