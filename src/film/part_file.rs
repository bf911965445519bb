//! Reads files that show a part of a picture, row by row, so that parts can be put together without
//! having the whole picture in memory.
//!
//! Only files that Pinhole wrote are understood: PNG with bytes of sRGB, and OpenEXR with the
//! channels R, G and B as 32-bit floats.

use std::{
    collections::VecDeque,
    io::{self, BufRead, Read, Seek},
};

use exr::{
    block::{self, UncompressedBlock, reader::ChunksReader},
    error::Error,
    math::Vec2,
    meta::{
        attribute::{ChannelList, SampleType},
        header::Header,
    },
};
use png::{BitDepth, ColorType, Decoder};

use super::exr::stored_digest;
use crate::area::Area;

/// Rows of a picture, from the top.
pub type FileRows<P> = Box<dyn Iterator<Item = io::Result<Vec<P>>>>;

/// The part of a whole picture that an OpenEXR file shows, according to its header.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExrPlace {
    /// The file's area in the whole picture.
    pub area: Area,
    /// Numbers of columns and rows of the whole picture.
    pub size: [u32; 2],
    /// Digest of the picture's recipe; `None` if another program wrote the file.
    pub digest: Option<String>,
}

impl ExrPlace {
    /// Returns the file's area, or `None` if the file shows the whole picture.
    pub fn crop(&self) -> Option<Area> {
        (self.area != Area::whole(self.size[0], self.size[1])).then_some(self.area)
    }
}

/// Returns the position in the whole picture of the part that an OpenEXR file shows. Does not read
/// the pixels.
///
/// # Errors
///
/// The file is damaged or has several layers, or its data window begins left of or above its
/// display window.
pub fn read_exr_place(file: impl Read + Seek) -> io::Result<ExrPlace> {
    place(block::read(file, false).map_err(io_error)?.headers())
}

fn place(headers: &[Header]) -> io::Result<ExrPlace> {
    let [header] = headers else {
        return Err(invalid("it has several layers"));
    };
    let window = header.shared_attributes.display_window;
    let corner = header.own_attributes.layer_position - window.position;
    let number =
        |number: i32| u32::try_from(number).map_err(|_| invalid("its windows do not overlap"));
    let Vec2(width, height) = header.layer_size;
    let area = Area {
        x: number(corner.0)?,
        y: number(corner.1)?,
        ..Area::whole(width as u32, height as u32)
    };
    let size = [window.size.0 as u32, window.size.1 as u32];
    let digest = stored_digest(&header.own_attributes);
    Ok(ExrPlace { area, size, digest })
}

/// Reads the rows of a PNG file with bytes of sRGB.
///
/// # Errors
///
/// The file is damaged, has pixels of another kind, or is not as wide as `width`.
pub fn png_rows(file: impl BufRead + Seek + 'static, width: u32) -> io::Result<FileRows<[u8; 3]>> {
    let mut reader = Decoder::new(file).read_info().map_err(png_error)?;
    let info = reader.info();
    let is_ours = (info.color_type, info.bit_depth) == (ColorType::Rgb, BitDepth::Eight);
    if !is_ours || info.width != width || info.interlaced {
        return Err(invalid("its pixels are not those that Pinhole wrote"));
    }
    Ok(Box::new(std::iter::from_fn(move || {
        let row = reader.next_row().map_err(png_error).transpose()?;
        Some(row.map(|row| row.data().as_chunks().0.to_vec()))
    })))
}

/// Reads the rows of an OpenEXR file with the channels R, G and B as 32-bit floats.
///
/// # Errors
///
/// The file is damaged, has other channels, or is not as wide as `width`.
pub fn exr_rows(file: impl BufRead + Seek + 'static, width: u32) -> io::Result<FileRows<[f32; 3]>> {
    let reader = block::read(file, false).map_err(io_error)?;
    let [header] = reader.headers() else {
        return Err(invalid("it has several layers"));
    };
    let channels = header.channels.clone();
    let names = channels.list.iter().map(|channel| channel.name.to_string());
    let are_floats = channels
        .list
        .iter()
        .all(|channel| channel.sample_type == SampleType::F32);
    let is_ours = are_floats && names.eq(["B", "G", "R"]) && !header.blocks.has_tiles();
    if !is_ours || header.layer_size.0 != width as usize {
        return Err(invalid("its pixels are not those that Pinhole wrote"));
    }
    let mut blocks = reader
        .all_chunks(false)
        .map_err(io_error)?
        .sequential_decompressor(false);
    let mut ready = VecDeque::new();
    Ok(Box::new(std::iter::from_fn(move || {
        while ready.is_empty() {
            let block = blocks.next()?;
            match block.and_then(|block| rows(&block, &channels)) {
                Ok(rows) => ready.extend(rows),
                Err(error) => return Some(Err(io_error(error))),
            }
        }
        ready.pop_front().map(Ok)
    })))
}

/// Returns the rows of a block. The block's channels must be blue, green and red, in this order.
fn rows(
    block: &UncompressedBlock,
    channels: &ChannelList,
) -> exr::error::Result<Vec<Vec<[f32; 3]>>> {
    let Vec2(width, height) = block.index.pixel_size;
    let mut rows = vec![vec![[0.0; 3]; width]; height];
    for line in block.lines(channels) {
        let row = &mut rows[line.location.position.y() - block.index.pixel_position.y()];
        for (pixel, sample) in row.iter_mut().zip(line.read_samples::<f32>()) {
            pixel[2 - line.location.channel] = sample?;
        }
    }
    Ok(rows)
}

fn invalid(message: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, message)
}

fn png_error(error: png::DecodingError) -> io::Error {
    match error {
        png::DecodingError::IoError(error) => of_reading(error),
        _ => invalid(DAMAGED),
    }
}

fn io_error(error: Error) -> io::Error {
    match error {
        Error::Io(error) => of_reading(error),
        _ => invalid(DAMAGED),
    }
}

const DAMAGED: &str = "it is damaged or cut off";

fn of_reading(error: io::Error) -> io::Error {
    match error.kind() {
        io::ErrorKind::UnexpectedEof => invalid(DAMAGED),
        _ => error,
    }
}
