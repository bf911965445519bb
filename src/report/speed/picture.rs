//! Crops of the rendered pictures, and where they are wrong.

use std::io;

use base64::{Engine, prelude::BASE64_STANDARD};
use png::{BitDepth, ColorType, Compression, Encoder};

use super::measure::Measurement;
use crate::{
    area::Area,
    film::{self, Film, Recipe, write_png},
    scene::Method,
};

/// The largest crop: several stand beside each other on a page, and a sample's noise is to be seen.
const CROP: (u32, u32) = (240, 135);

/// The picture as a whole is at most so wide and high: a page is not much wider, and its file stays small.
const WHOLE: (u32, u32) = (640, 480);

/// The colours of an error's logarithm: ColorBrewer's YlOrBr, whose lightness falls, so that it prints in grey and serves the colour-blind.
const COLORS: [[f64; 3]; 6] = [
    [255.0, 255.0, 255.0],
    [254.0, 227.0, 145.0],
    [254.0, 153.0, 41.0],
    [204.0, 76.0, 2.0],
    [140.0, 45.0, 4.0],
    [60.0, 16.0, 2.0],
];

/// The decades of error that the colours stand for, up to 1; less is white.
const DECADES: f64 = 3.0;

/// The part of the picture that the crops show: the one where the methods together are most wrong, in steps of half its size.
pub fn crop(measured: &Measurement) -> Area {
    let whole = measured.whole();
    let (width, height) = (whole.width.min(CROP.0), whole.height.min(CROP.1));
    let part = |x, y| Area {
        x,
        y,
        width,
        height,
    };
    let places = |length: u32, size: u32| {
        let last = length - size;
        (0..last).step_by((size / 2).max(1) as usize).chain([last])
    };
    let wrong = |area: Area| -> f64 {
        let films = measured
            .series
            .iter()
            .filter_map(|series| series.picture.as_ref());
        films
            .map(|film| squares(film, &measured.reference.film, area))
            .sum()
    };
    let mut best = (part(0, 0), -1.0);
    for y in places(whole.height, height) {
        for x in places(whole.width, width) {
            let wrong = wrong(part(x, y));
            if wrong > best.1 {
                best = (part(x, y), wrong);
            }
        }
    }
    best.0
}

fn squares(film: &Film, reference: &Film, area: Area) -> f64 {
    // Every other pixel of every other row says it as well.
    area.iter()
        .filter(|(x, y)| x % 2 == 0 && y % 2 == 0)
        .flat_map(|(x, y)| {
            let (a, b) = (film.pixel(x, y), reference.pixel(x, y));
            [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
        })
        .map(|difference| difference * difference)
        .sum()
}

/// The whole exact picture as a PNG in a `data:` URI, and its size there: squares of as many pixels as it takes are averaged, in linear light.
/// It carries the scene.
pub fn whole(measured: &Measurement) -> io::Result<(String, Area)> {
    let exact = &measured.reference.film;
    let (width, height) = (exact.width(), exact.height());
    let side = width.div_ceil(WHOLE.0).max(height.div_ceil(WHOLE.1));
    let size = Area::whole(width.div_ceil(side), height.div_ceil(side));
    let square = |x: u32, y: u32| {
        let (x, y) = (x * side, y * side);
        let area = Area {
            x,
            y,
            width: side.min(width - x),
            height: side.min(height - y),
        };
        film::mean(area.iter().map(|(x, y)| (1, exact.pixel(x, y))))
    };
    let film = Film::from_fn(size.width, size.height, square).map_err(io::Error::other)?;
    let mut recipe = measured.subject.recipe.clone();
    recipe.overrides.push("sampler.method=exact".to_owned());
    let mut bytes = Vec::new();
    write_png(&film, &recipe, &mut bytes)?;
    Ok((data_uri(&bytes), size))
}

/// A crop of a film as a PNG in a `data:` URI. The picture carries the scene with the method, so that Pinhole can render it again.
pub fn shown(
    measured: &Measurement,
    film: &Film,
    method: Method,
    part: Area,
) -> io::Result<String> {
    let mut recipe = Recipe {
        crop: Some(part),
        ..measured.subject.recipe.clone()
    };
    recipe
        .overrides
        .push(format!("sampler.method={}", method.name()));
    if method != Method::Exact {
        recipe
            .overrides
            .push(format!("sampler.per_pixel={}", measured.shown));
        recipe
            .overrides
            .push(format!("sampler.seed={}", measured.seed));
    }
    let mut bytes = Vec::new();
    write_png(&cropped(film, part)?, &recipe, &mut bytes)?;
    Ok(data_uri(&bytes))
}

fn cropped(film: &Film, part: Area) -> io::Result<Film> {
    let mut cropped = Film::new(part.width, part.height).map_err(io::Error::other)?;
    for y in 0..part.height {
        let row = &film.row(part.y + y)[part.x as usize..][..part.width as usize];
        let to = Area {
            x: 0,
            y,
            width: part.width,
            height: 1,
        };
        cropped.put(to, row);
    }
    Ok(cropped)
}

/// Where a crop is wrong, and how much: the largest difference of a pixel's channels to the exact picture, in [`COLORS`].
pub fn heat(film: &Film, reference: &Film, part: Area) -> io::Result<String> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, part.width, part.height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Balanced);
    let mut writer = encoder.write_header()?;
    let pixels: Vec<u8> = part
        .iter()
        .flat_map(|(x, y)| {
            let (a, b) = (film.pixel(x, y), reference.pixel(x, y));
            color((0..3).map(|c| (a[c] - b[c]).abs()).fold(0.0, f64::max))
        })
        .collect();
    writer.write_image_data(&pixels)?;
    writer.finish()?;
    Ok(data_uri(&bytes))
}

/// The colour of an error, 0 to 1.
fn color(error: f64) -> [u8; 3] {
    let place = (1.0 + libm::log10(error.max(1e-300)) / DECADES).clamp(0.0, 1.0);
    let place = place * (COLORS.len() - 1) as f64;
    let below = (place as usize).min(COLORS.len() - 2);
    let share = place - below as f64;
    [0, 1, 2].map(|c| {
        (COLORS[below][c] + share * (COLORS[below + 1][c] - COLORS[below][c])).round() as u8
    })
}

/// The scale of the heat maps: errors that people know, and their colours as CSS has them.
pub fn scale() -> impl Iterator<Item = (&'static str, String)> {
    let steps = [
        ("≤ 0.001", 1e-3),
        ("0.003", 3e-3),
        ("0.01", 1e-2),
        ("0.03", 3e-2),
        ("0.1", 0.1),
        ("0.3", 0.3),
        ("1", 1.0),
    ];
    steps.into_iter().map(|(name, error)| {
        let [r, g, b] = color(error);
        (name, format!("#{r:02x}{g:02x}{b:02x}"))
    })
}

fn data_uri(png: &[u8]) -> String {
    format!("data:image/png;base64,{}", BASE64_STANDARD.encode(png))
}
