//! Recognises files that were given instead of a picture, such as web pages, and says what to do.

/// Kinds of files that users may give instead of a picture. Each entry contains the first bytes of
/// such files and the description for the error message.
const BEGINNINGS: [(&[u8], &str); 8] = [
    (
        b"version https://git-lfs",
        "a pointer of Git LFS: `git lfs pull` fetches the picture",
    ),
    (b"%PDF", "a PDF: use the picture in it, as a PNG"),
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

/// Format names in the header of HEIC pictures, which telephones and cameras make. They are at byte
/// 8 of the file.
const CAMERAS: [&[u8]; 5] = [b"heic", b"heix", b"hevc", b"mif1", b"msf1"];

/// Returns a description of a file that is not a picture, or `None` if its kind is not recognised.
pub(super) fn of(bytes: &[u8]) -> Option<&'static str> {
    if bytes.is_empty() {
        return Some("an empty file");
    }
    if bytes.get(4..8) == Some(b"ftyp") && CAMERAS.contains(&bytes.get(8..12)?) {
        return Some("HEIC, as telephones write it: use the program's own file, as a PNG");
    }
    let is = |(beginning, _): &&(&[u8], &str)| bytes.trim_ascii_start().starts_with(beginning);
    BEGINNINGS.iter().find(is).map(|(_, what)| *what)
}
