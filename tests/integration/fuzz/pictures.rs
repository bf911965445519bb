//! Tests with random picture files. Each file is either decoded, within the limit on memory, or
//! refused.

use std::{io::Cursor, sync::LazyLock};

use image::{DynamicImage, ImageFormat, RgbImage};
use pinhole::film::read_picture_up_to;

use super::{each, flip};
use crate::program::Folder;

/// Maximum number of bytes to which a picture may be decoded in these tests. It is enough for the
/// small pictures of the tests. If a random change makes a header claim a huge size, the picture is
/// refused.
const LIMIT: u64 = 1 << 20;

/// Returns a small picture in each format and in several colour types.
fn pictures() -> &'static [Vec<u8>] {
    static PICTURES: LazyLock<Vec<Vec<u8>>> = LazyLock::new(|| {
        let picture = RgbImage::from_fn(19, 11, |x, y| {
            image::Rgb([(x * 13) as u8, (y * 23) as u8, (x * y) as u8])
        });
        let color = DynamicImage::ImageRgb8(picture);
        let formats = [
            ImageFormat::Png,
            ImageFormat::Jpeg,
            ImageFormat::Gif,
            ImageFormat::Bmp,
            ImageFormat::Tiff,
            ImageFormat::WebP,
            ImageFormat::Pnm,
        ];
        let kinds = [
            color.clone(),
            color.to_luma8().into(),
            color.to_rgba8().into(),
            color.to_rgb16().into(),
        ];
        let mut all = Vec::new();
        for format in formats {
            for kind in &kinds {
                let mut bytes = Cursor::new(Vec::new());
                if kind.write_to(&mut bytes, format).is_ok() {
                    all.push(bytes.into_inner());
                }
            }
        }
        assert!(all.len() > 12, "{}", all.len());
        let folder = Folder::with([("a.scn", pinhole::scene::SMALLEST)]);
        for name in ["a.exr", "a.png"] {
            folder.done(&format!(
                "render a.scn -o {name} --set image.width=20 --set image.height=10"
            ));
            all.push(folder.read(name));
        }
        all
    });
    &PICTURES
}

#[test]
fn random_picture_bytes_are_read_or_refused_within_the_limit() {
    each(300, |random| {
        let mut bytes = random.one_of(pictures()).clone();
        match random.below(16) {
            // The start of one file is joined with the rest of another.
            0 => {
                let other = random.one_of(pictures());
                let at = random.below(bytes.len());
                bytes.truncate(at);
                bytes.extend(&other[at.min(other.len())..]);
            }
            _ => flip(random, &mut bytes),
        }
        if let Ok(picture) = read_picture_up_to(&bytes, LIMIT) {
            let pixels = u64::from(picture.film.width()) * u64::from(picture.film.height());
            // A pixel takes at least four bytes of memory, so a decoded picture has at most a
            // quarter as many pixels as the limit has bytes.
            assert!((1..=LIMIT / 4).contains(&pixels), "{pixels}");
        }
    });
}
