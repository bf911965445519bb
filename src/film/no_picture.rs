//! Files that stand in a picture's place and are none: what they are, and the way out.

/// How such files begin, and what is said of them.
const BEGINNINGS: [(&[u8], &str); 8] = [
    (
        b"version https://git-lfs",
        "a pointer of Git LFS: `git lfs pull` fetches the picture",
    ),
    (b"%PDF", "a PDF: hand in the picture itself"),
    (
        b"PK\x03\x04",
        "a zip file: unpack it, or end its name in .zip",
    ),
    (b"<!DOCTYPE", WEB),
    (b"<!doctype", WEB),
    (b"<html", WEB),
    (b"PF\n", PFM),
    (b"Pf\n", PFM),
];

const WEB: &str = "a web page: the download was of a page around the picture, or failed";
const PFM: &str = "a PFM: OpenEXR is the format of floats that is read here";

/// The names of what cameras write, after the eight bytes of an ISO base media file's first box.
const CAMERAS: [&[u8]; 5] = [b"heic", b"heix", b"hevc", b"mif1", b"msf1"];

/// What a file is that is no picture, if it is known.
pub(super) fn of(bytes: &[u8]) -> Option<&'static str> {
    if bytes.is_empty() {
        return Some("an empty file");
    }
    if bytes.get(4..8) == Some(b"ftyp") && CAMERAS.contains(&bytes.get(8..12)?) {
        return Some("HEIC, as telephones write it: hand in what the program wrote, as PNG");
    }
    let is = |(beginning, _): &&(&[u8], &str)| bytes.trim_ascii_start().starts_with(beginning);
    BEGINNINGS.iter().find(is).map(|(_, what)| *what)
}
