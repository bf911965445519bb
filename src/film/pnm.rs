//! PNM files (PBM, PGM and PPM), the simplest picture formats, which students' first programs often
//! write. The types P1 to P6 are read.
//!
//! Shells and systems may damage such files. The damage is repaired if it can be recognised for
//! certain: a byte order mark or lines of text in front, UTF-16 or UTF-8 instead of bytes, or a
//! carriage return inserted before every line feed. Missing numbers and numbers out of range are
//! reported with their position. PAM files (type P7) are read by the crate `image` instead.

use super::{
    memory,
    picture::{Coding, Picture, Rounding},
    pixels::Film,
    unreadable::{Unreadable, check_size},
};
use crate::color::srgb_to_linear;

/// Maximum length, in bytes, of the text before a picture. A program may print messages before its
/// picture. If the messages are longer than this limit, the picture is not found. Usual messages
/// are far shorter.
const LINES_BEFORE: usize = 1 << 16;

const BOM: &[u8] = b"\xef\xbb\xbf";

/// Encoding of a PNM file, recognised by its first bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// One byte per character, as usual. The number is the length of the byte order mark before the
    /// picture: 0 or 3 bytes.
    Plain(usize),
    /// UTF-16, i.e. two bytes per character.
    Utf16 {
        /// Length of the byte order mark, in bytes.
        mark: usize,
        /// Whether the high byte of each character comes first.
        is_big: bool,
    },
}

/// Recognises the encoding of a PNM file. Returns `None` for other files, and for a PNM after lines
/// of text.
pub fn start(bytes: &[u8]) -> Option<Start> {
    let mark = if bytes.starts_with(BOM) { 3 } else { 0 };
    if is_head(&bytes[mark..]) {
        return Some(Start::Plain(mark));
    }
    let (mark, is_big) = match bytes {
        [0xff, 0xfe, ..] => (2, false),
        [0xfe, 0xff, ..] => (2, true),
        [0, b'P', ..] => (0, true),
        _ => (0, false),
    };
    let text = narrowed(bytes.get(mark..mark + 6)?, is_big)?;
    is_head(&text).then_some(Start::Utf16 { mark, is_big })
}

/// Returns the position of a PNM that begins after lines of other text, or `None` if there is none.
pub fn after_lines(bytes: &[u8]) -> Option<usize> {
    let start = &bytes[..bytes.len().min(LINES_BEFORE)];
    let feeds = (0..start.len()).filter(|&at| start[at] == b'\n');
    feeds.map(|at| at + 1).find(|&at| {
        // A line of text may also begin with the same characters as a PNM. It is taken for a PNM
        // only if two numbers, the picture's width and height, follow.
        let mut head = PnmReader::new(&start[at..]);
        is_head(&start[at..]) && head.number().is_ok() && head.number().is_ok()
    })
}

/// Returns whether bytes begin as a PNM does: with `P1` to `P6`, followed by white space or a
/// comment.
fn is_head(bytes: &[u8]) -> bool {
    matches!(bytes, [b'P', b'1'..=b'6', end, ..] if end.is_ascii_whitespace() || *end == b'#')
}

/// Converts UTF-16 to bytes. Returns `None` if a character is above 255.
fn narrowed(bytes: &[u8], is_big: bool) -> Option<Vec<u8>> {
    let (pairs, _) = bytes.as_chunks::<2>();
    let byte = |&[a, b]: &[u8; 2]| match if is_big { (a, b) } else { (b, a) } {
        (0, byte) => Some(byte),
        _ => None,
    };
    pairs.iter().map(byte).collect()
}

/// Reads a PNM, after repairing damage if possible. A picture that would be decoded to more than
/// `limit` bytes is rejected.
///
/// # Errors
///
/// The file is no PNM, is damaged, or is too large. The message says what is wrong, and at which
/// position.
pub fn read(bytes: &[u8], limit: u64) -> Result<Picture, Unreadable> {
    match start(bytes) {
        Some(Start::Plain(0)) => read_bytes(bytes, limit, Coding::Exact),
        Some(Start::Plain(mark)) => read_bytes(&bytes[mark..], limit, Coding::TextBefore),
        Some(Start::Utf16 { mark, is_big }) => {
            let is_bytes = (b'4'..=b'6').contains(&bytes[mark + if is_big { 3 } else { 2 }]);
            let text = narrowed(&bytes[mark..], is_big).filter(|_| !is_bytes);
            let text = text.ok_or_else(|| damaged(UTF_16.to_owned()))?;
            read_bytes(&text, limit, Coding::Utf16)
        }
        None => {
            let at = after_lines(bytes).ok_or(Unreadable::Format(None))?;
            read_bytes(&bytes[at..], limit, Coding::TextBefore)
        }
    }
}

const UTF_16: &str = "it was turned into UTF-16, as `>` of PowerShell does, which loses bytes: \
    have the program write the file itself, or use `cmd /c \"program > picture.ppm\"`";

const LOST: &str = "it was read as a text of UTF-8 and written again, as `>` of PowerShell 7 does, which \
    loses bytes: have the program write the file itself, or use `cmd /c \"program > picture.ppm\"`";

fn damaged(cause: String) -> Unreadable {
    Unreadable::Damaged {
        format: "PNM".to_owned(),
        cause,
    }
}

fn read_bytes(bytes: &[u8], limit: u64, coding: Coding) -> Result<Picture, Unreadable> {
    let kind = bytes[1] - b'0';
    let mut reader = PnmReader::new(bytes);
    let [width, height] = [reader.number()?, reader.number()?];
    let is_bits = kind == 1 || kind == 4;
    let maxval = if is_bits { 1 } else { reader.number()? };
    if !(1..=65535).contains(&maxval) {
        let cause = format!("its maxval is {maxval}, which is not from 1 to 65535");
        return Err(damaged(cause));
    }
    let rounding = match maxval {
        0..=255 => Rounding::Byte,
        _ => Rounding::Word,
    };
    let length = if maxval < 256 { 1 } else { 2 };
    check_size([width, height], length, limit)?;
    let (Ok(width), Ok(height)) = (u32::try_from(width), u32::try_from(height)) else {
        return Err(Unreadable::Large {
            width,
            height,
            limit,
        });
    };
    let channels: usize = if matches!(kind, 3 | 6) { 3 } else { 1 };
    let whole = 2 * channels + size_of::<[f64; 3]>();
    memory::check(width, height, whole as u64)?;
    let mut film = Film::new(width, height)?;
    let raster = Raster {
        width: width as usize,
        height: height as usize,
        channels,
        maxval: maxval as u16,
    };
    let (numbers, mended) = match kind {
        1..=3 => (raster.in_text(&mut reader, is_bits)?, None),
        4 => (raster.in_bits(reader.after_one_space())?, None),
        _ => raster.in_bytes(&reader, length as usize)?,
    };
    let light: Vec<f64> = (0..=maxval)
        .map(|number| srgb_to_linear(number as f64 / maxval as f64))
        .collect();
    let light = |number: &u16| light[usize::from(*number)];
    for (pixel, numbers) in film.pixels_mut().iter_mut().zip(numbers.chunks(channels)) {
        *pixel = match numbers {
            [r, g, b] => [r, g, b].map(light),
            _ => [light(&numbers[0]); 3],
        };
    }
    Ok(Picture {
        digest: None,
        film,
        rounding,
        coding: mended.unwrap_or(coding),
        crop: None,
        size: None,
        opacity: None,
    })
}

/// Size and number format of the picture in a PNM. `maxval` is the number that stands for white.
struct Raster {
    width: usize,
    height: usize,
    channels: usize,
    maxval: u16,
}

impl Raster {
    fn count(&self) -> usize {
        self.width * self.height * self.channels
    }

    /// Describes, for an error message, the pixel and the channel of the number with index `index`.
    fn place(&self, index: usize) -> String {
        let pixel = index / self.channels;
        let (x, y) = (pixel % self.width, pixel / self.width);
        match self.channels {
            1 => format!("pixel ({x}, {y})"),
            _ => {
                let channel = ["red", "green", "blue"][index % 3];
                format!("the {channel} of pixel ({x}, {y})")
            }
        }
    }

    fn cut_off(&self, index: usize) -> Unreadable {
        damaged(format!(
            "it is cut off before {}, after {index} of {} numbers",
            self.place(index),
            self.count()
        ))
    }

    fn above(&self, index: usize, number: u64, line: Option<usize>) -> Unreadable {
        let line = line.map_or_else(String::new, |line| format!(" in line {line}"));
        damaged(format!(
            "{} is {number}{line}, and its maxval is {}: no number may be above that",
            self.place(index),
            self.maxval
        ))
    }

    /// Reads the numbers of a file that writes them as text, separated by white space. If `is_bits`
    /// is set, each number is a single digit, 0 for white or 1 for black, and white space may be
    /// missing.
    fn in_text(&self, reader: &mut PnmReader, is_bits: bool) -> Result<Vec<u16>, Unreadable> {
        let mut numbers = Vec::with_capacity(self.count());
        for index in 0..self.count() {
            reader.skip_space();
            if reader.is_at_end() {
                return Err(self.cut_off(index));
            }
            let number = if is_bits {
                reader.bit()
            } else {
                reader.number()
            };
            match number? {
                number if number > u64::from(self.maxval) => {
                    return Err(self.above(index, number, Some(reader.line())));
                }
                number if is_bits => numbers.push(1 - number as u16),
                number => numbers.push(number as u16),
            }
        }
        Ok(numbers)
    }

    /// Reads the bits of a black-and-white picture, in which 1 is black. Each row begins with a new
    /// byte.
    fn in_bits(&self, raster: &[u8]) -> Result<Vec<u16>, Unreadable> {
        let row = self.width.div_ceil(8);
        let bit = |index: usize| {
            let (x, y) = (index % self.width, index / self.width);
            let byte = raster.get(y * row + x / 8);
            let byte = byte.ok_or_else(|| self.cut_off(index))?;
            Ok(1 - u16::from(byte >> (7 - x % 8) & 1))
        };
        (0..self.count()).map(bit).collect()
    }

    /// Reads binary numbers with the high byte first. `length` is the length of a number, 1 or 2
    /// bytes. If the bytes had to be repaired, also returns the kind of damage.
    fn in_bytes(
        &self,
        reader: &PnmReader,
        length: usize,
    ) -> Result<(Vec<u16>, Option<Coding>), Unreadable> {
        let raster = reader.after_one_space();
        let wanted = length * self.count();
        let text = reader.after_line_end();
        let text = text.filter(|_| raster.len() != wanted);
        let mended = text.and_then(|rest| mended(rest, wanted));
        if raster.len() != wanted && mended.is_none() && is_text_with_losses(raster) {
            return Err(damaged(LOST.to_owned()));
        }
        let raster = mended.as_ref().map_or(raster, |(raster, _)| raster);
        let number = |index: usize| {
            let bytes = raster.get(length * index..length * (index + 1));
            let number = match bytes.ok_or_else(|| self.cut_off(index))? {
                [byte] => u16::from(*byte),
                bytes => u16::from_be_bytes([bytes[0], bytes[1]]),
            };
            if number > self.maxval {
                return Err(self.above(index, number.into(), None));
            }
            Ok(number)
        };
        let numbers: Result<_, _> = (0..self.count()).map(number).collect();
        Ok((numbers?, mended.map(|(_, coding)| coding)))
    }
}

/// Repairs binary numbers that a system damaged because it took them for text. Returns the bytes
/// and the kind of damage, or `None` if no repair gives exactly `wanted` bytes.
fn mended(raster: &[u8], wanted: usize) -> Option<(Vec<u8>, Coding)> {
    let of_lines = |raster: &[u8]| without_returns(raster, wanted);
    if let Some(raster) = of_lines(raster) {
        return Some((raster, Coding::TextMode));
    }
    let letters = str::from_utf8(raster).ok()?.chars();
    let bytes = letters.map(|letter| u8::try_from(letter).ok());
    let bytes = bytes.collect::<Option<Vec<u8>>>()?;
    if bytes.len() == wanted {
        return Some((bytes, Coding::Utf8));
    }
    Some((of_lines(&bytes)?, Coding::Utf8))
}

/// Returns whether bytes are UTF-8 text in which invalid bytes were replaced by U+FFFD. The
/// replaced bytes cannot be recovered.
fn is_text_with_losses(raster: &[u8]) -> bool {
    str::from_utf8(raster).is_ok_and(|text| text.contains(char::REPLACEMENT_CHARACTER))
}

/// Removes the carriage returns that a system inserted before line feeds. Returns `None` if a line
/// feed has no carriage return before it, or if the result does not have `wanted` bytes.
fn without_returns(raster: &[u8], wanted: usize) -> Option<Vec<u8>> {
    let is_feed = |at: usize| raster[at] == b'\n';
    let mut feeds = (0..raster.len()).filter(|&at| is_feed(at));
    if feeds.any(|at| at == 0 || raster[at - 1] != b'\r') {
        return None;
    }
    let is_kept = |&at: &usize| raster[at] != b'\r' || raster.get(at + 1) != Some(&b'\n');
    let kept: Vec<u8> = (0..raster.len())
        .filter(is_kept)
        .map(|at| raster[at])
        .collect();
    (kept.len() == wanted).then_some(kept)
}

/// A reader of the numbers in a PNM file. It skips white space and comments.
struct PnmReader<'b> {
    bytes: &'b [u8],
    at: usize,
}

impl<'b> PnmReader<'b> {
    /// Makes a reader that starts after the two characters at the start of the file, such as `P6`.
    fn new(bytes: &'b [u8]) -> Self {
        Self { bytes, at: 2 }
    }

    fn is_at_end(&self) -> bool {
        self.at >= self.bytes.len()
    }

    /// Returns the number of the current line, from 1.
    fn line(&self) -> usize {
        let before = &self.bytes[..self.at];
        1 + before.iter().filter(|&&byte| byte == b'\n').count()
    }

    fn skip_space(&mut self) {
        while let Some(&byte) = self.bytes.get(self.at) {
            match byte {
                b'#' => {
                    let rest = self.bytes[self.at..].iter();
                    let ends = |&byte: &u8| byte == b'\n' || byte == b'\r';
                    self.at += rest.take_while(|byte| !ends(byte)).count();
                }
                _ if byte.is_ascii_whitespace() || byte == 0x0b => self.at += 1,
                _ => break,
            }
        }
    }

    fn number(&mut self) -> Result<u64, Unreadable> {
        self.skip_space();
        let word = self.bytes[self.at.min(self.bytes.len())..]
            .split(|byte| byte.is_ascii_whitespace() || matches!(byte, b'#' | 0x0b))
            .next()
            .unwrap_or_default();
        let text = str::from_utf8(word).ok();
        let number = text.filter(|text| text.bytes().all(|byte| byte.is_ascii_digit()));
        let number = number.and_then(|text| text.parse().ok());
        if let Some(number) = number {
            self.at += word.len();
            return Ok(number);
        }
        // The line number is determined only for an error message, since counting lines for every
        // number would take too long.
        let line = self.line();
        Err(damaged(match word {
            [] => "it ends before its size and maxval".to_owned(),
            _ => {
                let word = String::from_utf8_lossy(&word[..word.len().min(20)]);
                let is_number = word.parse::<f64>().is_ok();
                let is_text = !is_number && word.starts_with(char::is_alphabetic);
                let way_out =
                    is_text.then_some(": what is not the picture's goes to standard error");
                let way_out = way_out.unwrap_or_default();
                format!("`{word}` in line {line} is no whole number{way_out}")
            }
        }))
    }

    /// Reads one digit, 0 or 1.
    fn bit(&mut self) -> Result<u64, Unreadable> {
        let byte = self.bytes[self.at];
        self.at += 1;
        match byte {
            b'0' | b'1' => Ok(u64::from(byte - b'0')),
            _ => {
                let cause = format!(
                    "`{}` in line {} is no bit",
                    byte.escape_ascii(),
                    self.line()
                );
                Err(damaged(cause))
            }
        }
    }

    /// Returns the bytes of the pixels in a binary PNM. Exactly one white-space character separates
    /// the header from the pixels.
    fn after_one_space(&self) -> &'b [u8] {
        self.bytes.get(self.at + 1..).unwrap_or_default()
    }

    /// Returns the bytes after the header and its line end. Returns `None` if the header has no
    /// line end.
    fn after_line_end(&self) -> Option<&'b [u8]> {
        let rest = self.bytes.get(self.at..)?;
        rest.strip_prefix(b"\r\n").or(rest.strip_prefix(b"\n"))
    }
}
