//! Tests with picture files that beginners' own programs write, and with files that the redirection
//! of output has altered: a shell may change line ends or the text encoding.

use std::io::Cursor;

use exr::prelude::{Image, SpecificChannels, WritableImage};
use image::{ImageFormat, Rgb, RgbImage};
use pinhole::film::{Coding, read_picture};

/// A picture of two rows with three pixels each, in the text form of the format PPM.
const TEXT: &str = "P3\n3 2\n255\n1 2 3 4 5 6 7 8 9\n10 11 12 13 14 15 16 17 18\n";

/// Returns the picture of [`TEXT`] in binary form. Two of its values, 10 and 13, are the bytes of a
/// line feed and a carriage return. A program that writes in text mode changes such bytes.
fn bytes() -> Vec<u8> {
    let numbers: Vec<u8> = (1..=18).collect();
    [b"P6\n3 2\n255\n", &numbers[..]].concat()
}

fn utf16(text: &str, mark: &[u8], bytes: fn(u16) -> [u8; 2]) -> Vec<u8> {
    let text = text.encode_utf16().flat_map(bytes);
    mark.iter().copied().chain(text).collect()
}

/// Returns `bytes` as a C library on Windows writes them in text mode, i.e. with a carriage return
/// before each line feed.
fn in_text_mode(bytes: &[u8]) -> Vec<u8> {
    let written = |&byte: &u8| match byte {
        b'\n' => vec![b'\r', b'\n'],
        byte => vec![byte],
    };
    bytes.iter().flat_map(written).collect()
}

#[test]
fn pnm_files_altered_by_shells_are_read_with_a_warning() {
    let right = read_picture(TEXT.as_bytes()).unwrap();
    assert_eq!(right.coding, Coding::Exact);
    let log = "Rendering…\nP3 takes long\n50 %\n";
    let long = "Scanlines remaining: 719\n".repeat(720);
    let with = |before: &[u8], file: &[u8]| [before, file].concat();
    let cases = [
        (bytes(), Coding::Exact),
        (TEXT.replace('\n', "\r\n").into(), Coding::Exact),
        (TEXT.replace('3', "3 # three\n").into(), Coding::Exact),
        (
            with("\u{feff}".as_bytes(), TEXT.as_bytes()),
            Coding::TextBefore,
        ),
        (with("\u{feff}".as_bytes(), &bytes()), Coding::TextBefore),
        (with(log.as_bytes(), TEXT.as_bytes()), Coding::TextBefore),
        (with(log.as_bytes(), &bytes()), Coding::TextBefore),
        (with(long.as_bytes(), TEXT.as_bytes()), Coding::TextBefore),
        (utf16(TEXT, b"\xff\xfe", u16::to_le_bytes), Coding::Utf16),
        (utf16(TEXT, b"\xfe\xff", u16::to_be_bytes), Coding::Utf16),
        (utf16(TEXT, b"", u16::to_le_bytes), Coding::Utf16),
        (utf16(TEXT, b"", u16::to_be_bytes), Coding::Utf16),
        (in_text_mode(&bytes()), Coding::TextMode),
    ];
    for (file, coding) in cases {
        let shown = String::from_utf8_lossy(&file).into_owned();
        let read = read_picture(&file).unwrap_or_else(|error| panic!("{shown}: {error}"));
        assert!(read.film.pixels() == right.film.pixels(), "{shown}");
        assert_eq!(read.coding, coding, "{shown}");
        assert_eq!(coding.warning().is_some(), coding != Coding::Exact);
    }
}

#[test]
fn binary_pnm_reencoded_as_utf8_is_read() {
    let numbers: Vec<u8> = [9, 10, 11, 12, 13, 14, 126, 127, 128]
        .into_iter()
        .chain(247..=255)
        .collect();
    let file = [b"P6\n3 2\n255\n", &numbers[..]].concat();
    let right = read_picture(&file).unwrap();
    let letters = |file: &[u8]| -> Vec<u8> {
        let text: String = file.iter().map(|&byte| char::from(byte)).collect();
        text.into_bytes()
    };
    for file in [letters(&file), in_text_mode(&letters(&file))] {
        let read = read_picture(&file).unwrap();
        assert!(read.film.pixels() == right.film.pixels());
        assert_eq!(read.coding, Coding::Utf8);
        assert!(read.coding.warning().is_some());
    }
    let lost = String::from_utf8_lossy(&file);
    let said = read_picture(lost.as_bytes()).unwrap_err().to_string();
    assert!(said.contains("as `>` of PowerShell 7 does"), "{said}");
}

/// Reading a truncated file either fails or yields all pixels of the whole file.
#[test]
fn a_truncated_picture_file_never_reads_as_a_different_picture() {
    let picture = RgbImage::from_fn(24, 20, |x, y| {
        Rgb([9 * x, 11 * y, 7 * (x + y)].map(|n| n as u8))
    });
    let formats = [
        ImageFormat::Bmp,
        ImageFormat::Gif,
        ImageFormat::Jpeg,
        ImageFormat::Png,
        ImageFormat::Pnm,
        ImageFormat::Tiff,
        ImageFormat::WebP,
    ];
    let coded = formats.map(|format| {
        let mut file = Cursor::new(Vec::new());
        picture.write_to(&mut file, format).unwrap();
        (format!("{format:?}"), file.into_inner())
    });
    let floats = ("EXR".to_owned(), exr(["R", "G", "B"]));
    for (format, file) in coded.into_iter().chain([floats]) {
        let whole = read_picture(&file).unwrap();
        for length in 0..file.len() {
            if let Ok(part) = read_picture(&file[..length]) {
                assert!(
                    part.film.pixels() == whole.film.pixels(),
                    "{format}: {length} of {} bytes",
                    file.len()
                );
            }
        }
    }
}

#[test]
fn a_file_of_another_kind_is_named_in_the_error() {
    let cases: [(&[u8], &str); 7] = [
        (b"", "an empty file"),
        (
            b"version https://git-lfs.github.com/spec/v1\n",
            "`git lfs pull`",
        ),
        (b"%PDF-1.7", "a PDF"),
        (b"PK\x03\x04", "a zip file"),
        (b"\n<!DOCTYPE html>", "a web page"),
        (b"PF\n1 1\n-1.0\n", "OpenEXR is the format of floats"),
        (b"\0\0\0\x18ftypheic", "HEIC"),
    ];
    for (file, words) in cases {
        let said = read_picture(file).unwrap_err().to_string();
        assert!(said.starts_with("it is no picture, but "), "{said}");
        assert!(said.contains(words), "{said}");
    }
}

#[test]
fn pnm_errors_name_the_pixel_or_the_line() {
    let cut = |length: usize| bytes()[..length].to_vec();
    let cases: [(Vec<u8>, &str); 17] = [
        (
            TEXT[..30].into(),
            "cut off before the green of pixel (0, 1), after 10 of 18",
        ),
        (
            TEXT[..11].into(),
            "cut off before the red of pixel (0, 0), after 0 of 18",
        ),
        (TEXT[..7].into(), "it ends before its size and maxval"),
        (
            cut(25),
            "cut off before the blue of pixel (1, 1), after 14 of 18",
        ),
        (cut(11), "cut off before the red of pixel (0, 0)"),
        (
            TEXT.replace("14", "256").into(),
            "the green of pixel (1, 1) is 256 in line 5, and its maxval is 255",
        ),
        (
            "P6 1 1 15\n\x01\x10\x02".into(),
            "the green of pixel (0, 0) is 16, and its maxval is 15",
        ),
        (
            "P5 1 1 256\n\x01\x01".into(),
            "pixel (0, 0) is 257, and its maxval is 256",
        ),
        (
            TEXT.replace("14", "-14").into(),
            "`-14` in line 5 is no whole number",
        ),
        (
            TEXT.replace("14", "0.5").into(),
            "`0.5` in line 5 is no whole number",
        ),
        (
            TEXT.replace("14", "nan").into(),
            "`nan` in line 5 is no whole number",
        ),
        (
            TEXT.replace("14", "13\nline 3\n14").into(),
            "`line` in line 6 is no whole number: what is not the picture's goes to standard error",
        ),
        (
            TEXT.replace("255", "0").into(),
            "its maxval is 0, which is not from 1 to 65535",
        ),
        ("P1\n2 1\n1 2".into(), "`2` in line 3 is no bit"),
        (
            "P4\n9 1\n\x01".into(),
            "cut off before pixel (8, 0), after 8 of 9",
        ),
        ("P2 0 4 255 ".into(), "it has 0 × 4 pixels"),
        (
            utf16("P6\n3 2\n255\nabc", b"\xff\xfe", u16::to_le_bytes),
            "have the program write the file itself",
        ),
    ];
    for (file, words) in cases {
        let shown = String::from_utf8_lossy(&file).into_owned();
        let said = read_picture(&file).unwrap_err().to_string();
        assert!(said.contains(words), "{shown}: {said}");
    }
}

/// Returns an EXR file with three channels of the given names.
fn exr(names: [&str; 3]) -> Vec<u8> {
    let [a, b, c] = names;
    let channels = SpecificChannels::build()
        .with_channel(a)
        .with_channel(b)
        .with_channel(c)
        .with_pixel_fn(|_| (0.25f32, 0.5f32, 0.75f32));
    let mut file = Cursor::new(Vec::new());
    let image = Image::from_channels((2, 1), channels);
    image.write().non_parallel().to_buffered(&mut file).unwrap();
    file.into_inner()
}

#[test]
fn an_exr_with_one_rgb_layer_is_read_and_other_channels_are_listed() {
    for names in [["R", "G", "B"], ["beauty.R", "beauty.G", "beauty.B"]] {
        let film = read_picture(&exr(names)).unwrap().film;
        assert_eq!(film.pixels(), [[0.25, 0.5, 0.75]; 2]);
    }
    let others = [
        (["Y", "RY", "BY"], "its channels are BY, RY, Y, of which"),
        (
            ["R", "beauty.G", "beauty.B"],
            "its channels are R, beauty.B, beauty.G",
        ),
    ];
    for (names, words) in others {
        let said = read_picture(&exr(names)).unwrap_err().to_string();
        assert!(said.contains(words), "{said}");
    }
}
