//! Tests of picture files: their contents, and the refusal of damaged or oversized files.

mod compare;
mod foreign;
mod light;

use std::{io::Cursor, iter};

use exr::meta::attribute::SampleType;
use pinhole::{
    area::Area,
    color::srgb_to_linear,
    film::{
        Coding, Film, NotOurs, OVERRIDES_LIMIT, Recipe, Rounding, SIGNATURE, TEXT_LIMIT,
        read_picture, read_picture_up_to, read_recipe, write_exr, write_png,
    },
};

use png::{BitDepth, ColorType};

use crate::images::png;

/// Returns a picture whose colours range from dark to light.
fn film(width: u32, height: u32) -> Film {
    Film::from_fn(width, height, |x, y| {
        let light = f64::from(y * width + x) / f64::from(width * height - 1).max(1.0);
        [light, 1.0 - light, light * light]
    })
    .unwrap()
}

/// Encodes the linear light of a channel by the definition of sRGB. Both numbers are from 0 to 1.
fn encoded(light: f64) -> f64 {
    if light <= 0.003_130_8 {
        12.92 * light
    } else {
        1.055 * libm::pow(light, 1.0 / 2.4) - 0.055
    }
}

fn recipe() -> Recipe {
    Recipe {
        scene: "\u{feff}// Grüße\r\nsphere { center (0, 1, 0) }\n\0\r".to_owned(),
        overrides: vec!["Ball.center=(0, 2, 0)".to_owned(), "h = 1.5 ".to_owned()],
        crop: Some("3,4,10,20".parse().unwrap()),
        size: Some([40, 50]),
    }
}

fn png_bytes(film: &Film, recipe: &Recipe) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_png(film, Some(recipe), &mut bytes).unwrap();
    bytes
}

/// Returns the type and the content of each chunk of a PNG file.
fn chunks(png: &[u8]) -> Vec<(&str, &[u8])> {
    let mut rest = &png[8..];
    iter::from_fn(|| {
        let (length, chunk) = rest.split_first_chunk::<4>()?;
        let (kind, chunk) = chunk.split_at(4);
        let (content, checksum_and_more) = chunk.split_at(u32::from_be_bytes(*length) as usize);
        rest = &checksum_and_more[4..];
        Some((str::from_utf8(kind).unwrap(), content))
    })
    .collect()
}

#[test]
fn a_png_is_truecolour_with_no_unexpected_chunks() {
    let film = film(31, 17);
    let png = png_bytes(&film, &recipe());
    let chunks = chunks(&png);
    let mut kinds: Vec<_> = chunks.iter().map(|(kind, _)| *kind).collect();
    kinds.dedup();
    assert_eq!(kinds, ["IHDR", "sRGB", "iTXt", "IDAT", "IEND"]);
    // The header contains the width, the height, 8 bits per channel, and the code 2 for RGB
    // colours. The three zeros stand for the usual compression and filters, and for no interlacing.
    assert_eq!(chunks[0].1, [0, 0, 0, 31, 0, 0, 0, 17, 8, 2, 0, 0, 0]);
    let read = image::load_from_memory(&png).unwrap().into_rgb8();
    for (x, y, pixel) in read.enumerate_pixels() {
        for (light, byte) in film.pixel(x, y).into_iter().zip(pixel.0) {
            assert!((255.0 * encoded(light) - f64::from(byte)).abs() < 0.5001);
        }
    }
}

#[test]
fn a_png_carries_its_recipe_unchanged() {
    let plain = Recipe {
        overrides: Vec::new(),
        crop: None,
        size: None,
        ..recipe()
    };
    for recipe in [recipe(), plain] {
        let png = png_bytes(&film(3, 2), &recipe);
        assert_eq!(read_recipe(&png).unwrap(), recipe);
        assert_eq!(png, png_bytes(&film(3, 2), &recipe));
        let chunks = chunks(&png).into_iter();
        let mut texts = chunks.filter(|(kind, _)| *kind == "iTXt");
        for start in [&b"Software\0\x01\0"[..], b"pinhole:scene\0\x01\0"] {
            assert!(texts.next().unwrap().1.starts_with(start));
        }
    }
}

#[test]
fn a_recipe_beyond_the_text_limit_is_left_out() {
    for (length, fits) in [(TEXT_LIMIT - 29, true), (TEXT_LIMIT - 28, false)] {
        let long = Recipe {
            scene: "/".repeat(length),
            ..recipe()
        };
        assert_eq!(long.fits(), fits);
        let png = png_bytes(&film(3, 2), &long);
        match read_recipe(&png) {
            Ok(read) => assert!(fits && read == long),
            Err(error) => assert!(!fits && matches!(error, NotOurs::NoScene)),
        }
    }
    let many = Recipe {
        overrides: vec![String::new(); 1001],
        ..recipe()
    };
    assert!(!many.fits());
}

/// A decoder's message may quote a part of the file, which can have any length. The program
/// therefore limits the length of its own messages.
#[test]
fn picture_errors_are_at_most_300_characters_long() {
    let long = "x".repeat(5000);
    let heads = [
        "P7\nWIDTH LONG\n",
        "P7\nLONG 3\nENDHDR\n",
        "P7\nWIDTH 3\nHEIGHT 3\nDEPTH 1\nMAXVAL 255\nTUPLTYPE LONG\nENDHDR\n",
        "P6\n3 LONG\n255\n",
        "P3\n3 3\n255\nLONG\n",
        "GIF89aLONG",
        "BMLONG",
        "RIFFLONGWEBPLONG",
        "II*\0LONG",
        "\u{89}PNG\r\n\u{1a}\nLONG",
    ];
    for head in heads {
        // Each character is written as one byte, so that `\u{89}` becomes the first byte of a PNG
        // file.
        let bytes: Vec<u8> = head
            .replace("LONG", &long)
            .chars()
            .map(|c| c as u8)
            .collect();
        let said = read_picture(&bytes).unwrap_err().to_string();
        assert!(said.chars().count() <= 300, "{head}: {said}");
    }
}

#[test]
fn a_damaged_png_never_yields_a_changed_recipe() {
    let png = png_bytes(&film(3, 2), &recipe());
    let idat = png.windows(4).position(|four| four == b"IDAT").unwrap();
    for length in 0..idat {
        assert!(matches!(read_recipe(&png[..length]), Err(NotOurs::Damaged)));
    }
    // No flipped bit may cause a panic. A flipped bit in the header must be detected by the
    // checksum. A flipped bit in the pixels has no effect, because only the part of the file before
    // the pixels is read.
    for bit in 0..8 * png.len() {
        let mut flipped = png.clone();
        flipped[bit / 8] ^= 1 << (bit % 8);
        let is_in_header = (8..33).contains(&(bit / 8));
        match read_recipe(&flipped) {
            Ok(read) => assert!(!is_in_header && read == recipe()),
            Err(error) => assert!(!is_in_header || matches!(error, NotOurs::Damaged)),
        }
    }
}

/// Returns the start of a PNG file that has text chunks with the given keywords and texts.
fn carrying<'a>(texts: impl Iterator<Item = (&'a str, &'a [u8])>) -> Vec<u8> {
    let mut png = SIGNATURE.to_vec();
    for (keyword, text) in texts {
        let chunk = [b"iTXt", keyword.as_bytes(), &[0; 5], text].concat();
        png.extend((chunk.len() as u32 - 4).to_be_bytes());
        png.extend(&chunk);
        png.extend(crc32fast::hash(&chunk).to_be_bytes());
    }
    png.extend(b"\0\0\0\0IDAT");
    png
}

#[test]
fn recipes_with_too_many_or_non_utf8_overrides_are_refused() {
    let scene = ("pinhole:scene", &b"sphere {}"[..]);
    let with = |count, text| {
        let set = ("pinhole:set", text);
        read_recipe(&carrying([scene].into_iter().chain([set].repeat(count))))
    };
    assert_eq!(with(OVERRIDES_LIMIT, b"h=1").unwrap().overrides.len(), 1000);
    let told = with(100_000, b"h=1").unwrap_err().to_string();
    assert_eq!(told, "the picture carries more than 1000 overrides");
    let told = with(1, b"h=\xff").unwrap_err().to_string();
    assert!(
        told.ends_with("an override that is not UTF-8 text"),
        "{told}"
    );
    // Text chunks of other programs may have any content, even invalid UTF-8.
    let foreign = ("Comment", &b"\xff"[..]);
    assert!(read_recipe(&carrying([foreign, scene].into_iter())).is_ok());
}

/// Reads the two formats that the tests of `diff` do not cover: lossy WebP, and the text form of
/// PNM.
#[test]
fn a_lossy_webp_and_a_plain_pnm_are_read() {
    let webp = b"RIFF\x22\0\0\0WEBPVP8 \x16\0\0\0\x30\x01\0\x9d\x01\x2a\x01\0\x01\0\x0e\xc0\xfe\x25\xa4\0\x03\x70\0\0\0\0";
    assert_eq!(read_picture(webp).unwrap().coding, Coding::Lossy);
    let plain = read_picture(b"P2 2 1 4 0 4").unwrap();
    assert_eq!(plain.rounding, Rounding::Byte);
    assert_eq!(plain.film.pixel(1, 0), [1.0; 3]);
    assert!(read_picture(b"P2let = 1").is_err());
}

#[test]
fn every_8_and_16_bit_srgb_value_decodes_to_its_linear_light() {
    let bytes: Vec<u8> = (0..=255).collect();
    let words: Vec<u8> = (0..=u16::MAX).flat_map(u16::to_be_bytes).collect();
    for (size, depth, data, last) in [
        ([256, 1], BitDepth::Eight, bytes, 255.0),
        ([256, 256], BitDepth::Sixteen, words, 65535.0),
    ] {
        let film = read_picture(&png(size, ColorType::Grayscale, depth, &data));
        for (k, pixel) in (0..).zip(film.unwrap().film.pixels()) {
            assert_eq!(*pixel, [srgb_to_linear(f64::from(k) / last); 3]);
        }
    }
}

/// An EXR file may contain colours that were rounded to 16 bits; the program must detect this.
/// Channels that are not read, such as opacity, must have no influence. The first file has 16 bits
/// only for opacity, the second only for green.
#[test]
fn unused_exr_channels_do_not_affect_the_detected_rounding() {
    for (file, rounding) in [
        (
            &include_bytes!("../../film/half_opacity.exr")[..],
            Rounding::Float,
        ),
        (include_bytes!("../../film/half_green.exr"), Rounding::Half),
    ] {
        assert_eq!(read_picture(file).unwrap().rounding, rounding);
    }
}

#[test]
fn a_small_file_of_a_huge_picture_is_refused() {
    let black = vec![0; 2500 * 20_000];
    let bytes = png([20_000; 2], ColorType::Grayscale, BitDepth::One, &black);
    assert!(bytes.len() < 1 << 20);
    let large = "it has 20000 × 20000 pixels, which are decoded to more than the 268435456 bytes that are read";
    assert_eq!(read_picture(&bytes).unwrap_err().to_string(), large);
    // The memory limit allows for four channels per pixel, although the file has only one. A
    // channel needs one byte of memory if the file has 1 bit per channel, and two bytes if the file
    // has 16.
    for (depth, size) in [(BitDepth::One, 4 * 6), (BitDepth::Sixteen, 8 * 6)] {
        let bytes = png(
            [3, 2],
            ColorType::Grayscale,
            depth,
            &[0; 12][..match depth {
                BitDepth::One => 2,
                _ => 12,
            }],
        );
        assert!(read_picture_up_to(&bytes, size).is_ok());
        assert!(read_picture_up_to(&bytes, size - 1).is_err());
    }
}

#[test]
fn png_text_that_unpacks_beyond_the_limit_is_refused() {
    let mut bomb = Vec::new();
    let mut encoder = png::Encoder::new(&mut bomb, 1, 1);
    encoder.set_color(ColorType::Rgb);
    let mut writer = encoder.write_header().unwrap();
    for _ in 0..3 {
        let text = " ".repeat(TEXT_LIMIT / 2);
        let mut chunk = png::text_metadata::ITXtChunk::new("pinhole:set", text);
        chunk.compressed = true;
        writer.write_text_chunk(&chunk).unwrap();
    }
    writer.write_image_data(&[0, 0, 0]).unwrap();
    writer.finish().unwrap();
    assert!(matches!(read_recipe(&bomb), Err(NotOurs::TooMuchText)));
}

#[test]
fn an_exr_stores_means_as_floats_and_the_position_of_the_crop() {
    let film = film(33, 70);
    let part: Area = "7,5,33,70".parse().unwrap();
    for (part, whole, crop) in [
        (Area::whole(33, 70), Area::whole(33, 70), None),
        (part, Area::whole(64, 90), Some(part)),
    ] {
        let mut bytes = Cursor::new(Vec::new());
        write_exr(&film, part, whole, None, &mut bytes).unwrap();
        let bytes = bytes.into_inner();
        // Films of `f64` and `f32` must give the same file, because its channels are 32-bit floats.
        let floats: Film<[f32; 3]> =
            Film::from_fn(33, 70, |x, y| film.pixel(x, y).map(|light| light as f32)).unwrap();
        let mut same = Cursor::new(Vec::new());
        write_exr(&floats, part, whole, None, &mut same).unwrap();
        assert!(same.into_inner() == bytes);
        let meta = exr::meta::MetaData::read_from_buffered(&bytes[..], true).unwrap();
        let header = &meta.headers[0];
        let channels = header.channels.list.iter();
        let channels = channels.map(|channel| (channel.name.to_string(), channel.sample_type));
        let float = |name: &str| (name.to_owned(), SampleType::F32);
        assert!(channels.eq(["B", "G", "R"].map(float)));
        let display = header.shared_attributes.display_window;
        assert_eq!(display.position, (0, 0).into());
        assert_eq!(
            display.size,
            (whole.width as usize, whole.height as usize).into()
        );
        assert_eq!(
            header.own_attributes.layer_position,
            (part.x as i32, part.y as i32).into()
        );
        assert_eq!(header.layer_size, (33, 70).into());
        let read = read_picture(&bytes).unwrap();
        assert_eq!((read.crop, read.rounding), (crop, Rounding::Float));
        let rounded = film.pixels().iter();
        let rounded = rounded.map(|pixel| pixel.map(|light| f64::from(light as f32)));
        assert!(rounded.eq(read.film.pixels().iter().copied()));
    }
}
