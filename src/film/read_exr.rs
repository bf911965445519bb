//! Reads OpenEXR files of any program, in linear light.

use std::{collections::BTreeSet, io::Cursor};

use exr::{
    block,
    error::Error,
    image::read::{
        image::ReadLayers, layers::ReadChannels, read as reader,
        specific_channels::ReadSpecificChannel,
    },
    math::Vec2,
    meta::{
        attribute::{ChannelDescription, SampleType, Text},
        header::Header,
    },
};

use super::{
    exr::stored_digest,
    memory::TooLarge,
    picture::{Coding, Picture, Rounding},
    pixels::Film,
    unreadable::{Unreadable, check_size},
};
use crate::area::Area;

/// Reads a picture. Rejects a picture that would be decoded to more than `limit` bytes. The alpha
/// channel is ignored: OpenEXR stores colours that are already multiplied by alpha, i.e. mixed with
/// black.
pub fn read(bytes: &[u8], limit: u64) -> Result<Picture, Unreadable> {
    let file = block::read(Cursor::new(bytes), false).map_err(unreadable)?;
    for header in file.headers() {
        // The size is checked before anything is decompressed.
        let Vec2(width, height) = header.layer_size;
        let channels = &header.channels.list;
        // The decoder unpacks all channels of the file, not only R, G, B and A, so all are counted.
        let sizes = channels
            .iter()
            .map(|channel| channel.sample_type.bytes_per_sample());
        let channel = sizes.sum::<usize>().div_ceil(4);
        check_size([width as u64, height as u64], channel as u64, limit)?;
    }
    let [red, green, blue] = channels(file.headers())?;
    let image = reader()
        .no_deep_data()
        .largest_resolution_level()
        .specific_channels()
        .required(red)
        .required(green)
        .required(blue)
        .collect_pixels(
            |Vec2(width, height), _| Film::new(width as u32, height as u32),
            |film: &mut Result<Film, TooLarge>, Vec2(x, y), (r, g, b): (f32, f32, f32)| {
                if let Ok(film) = film {
                    let at = y * film.width() as usize + x;
                    film.pixels_mut()[at] = [r, g, b].map(f64::from);
                }
            },
        )
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_chunks(file)
        .map_err(unreadable)?;
    let window = image.attributes.display_window;
    let corner = image.layer_data.attributes.layer_position - window.position;
    let channels = image.layer_data.channel_data;
    let (red, green, blue) = channels.channels;
    let film = channels.pixels?;
    let (width, height) = (film.width(), film.height());
    let is_whole = corner == Vec2(0, 0) && window.size == Vec2(width as usize, height as usize);
    let crop = match (corner.0.try_into(), corner.1.try_into()) {
        (Ok(x), Ok(y)) if !is_whole => Some(Area {
            x,
            y,
            ..Area::whole(width, height)
        }),
        _ => None,
    };
    let size = match [window.size.0, window.size.1].map(u32::try_from) {
        [Ok(width), Ok(height)] => Some([width, height]),
        _ => None,
    };
    let is_half = |channel: &ChannelDescription| channel.sample_type == SampleType::F16;
    Ok(Picture {
        digest: stored_digest(&image.layer_data.attributes),
        film,
        rounding: if [red, green, blue].iter().any(is_half) {
            Rounding::Half
        } else {
            Rounding::Float
        },
        coding: Coding::Exact,
        crop,
        size: crop.and(size),
        opacity: None,
    })
}

/// Returns the names of the channels to read: `R`, `G` and `B`, possibly with the prefix of a
/// layer, such as `beauty.R`. If several layers have all three channels, the one without a prefix
/// is chosen. Fails if no layer has all three, or if several layers have them and each of these
/// layers has a prefix.
fn channels(headers: &[Header]) -> Result<[Text; 3], Unreadable> {
    let names = headers.iter().flat_map(|header| &header.channels.list);
    let names: BTreeSet<String> = names.map(|channel| channel.name.to_string()).collect();
    let of = |layer: &str| ["R", "G", "B"].map(|letter| format!("{layer}{letter}"));
    let layers = names.iter().filter_map(|name| name.strip_suffix('R'));
    let is_whole = |layer: &&str| of(layer).iter().all(|name| names.contains(name));
    let layers: Vec<&str> = layers.filter(is_whole).collect();
    let layer = match layers[..] {
        [layer] => layer,
        _ if layers.contains(&"") => "",
        _ => {
            let names: Vec<_> = names.iter().map(String::as_str).collect();
            let cause = format!(
                "its channels are {}, of which R, G and B are read, or those of one layer, such as beauty.R",
                names.join(", ")
            );
            return Err(Unreadable::Unsupported {
                format: "OpenEXR".to_owned(),
                cause,
            });
        }
    };
    Ok(of(layer).map(|name| Text::from(&*name)))
}

fn unreadable(error: Error) -> Unreadable {
    let format = "OpenEXR".to_owned();
    let cause = match &error {
        Error::NotSupported(what) | Error::Invalid(what) => what.to_string(),
        other => other.to_string(),
    };
    match error {
        Error::NotSupported(_) => Unreadable::Unsupported { format, cause },
        _ => Unreadable::Damaged { format, cause },
    }
}
