//! Coarse pictures that become finer step by step, for a preview.
//!
//! Each picture consists of square blocks, which are smaller than those of the picture before. A
//! block shows the colour at its centre, so that only colours of the scene are shown. The caller
//! decides when to render the full picture (`render`), and when to stop because the scene has
//! changed.

use std::sync::{Mutex, atomic::Ordering};

use crate::{
    area::Area,
    film::Film,
    lock::{lock, unpoisoned},
    render::{Control, RenderError, check_part},
    threads::{self, prelude::*},
    tracer::World,
};
use glam::DVec2;

/// Sides of the blocks of a coarse picture in successive steps, in pixels. Each step takes four
/// times as long as the step before. All steps together take less time than a picture with one
/// sample per pixel. With a larger first side, a picture would appear sooner, but show less of the
/// scene.
pub const SIDES: [u32; 4] = [16, 8, 4, 2];

/// A picture in square blocks, each of one colour.
#[derive(Clone, Debug, PartialEq)]
pub struct Coarse {
    /// Side of a block, in pixels.
    pub side: u32,
    /// One pixel for each block. The blocks of the last column and of the last row may be cut off.
    pub film: Film,
}

/// Renders a part of the picture in blocks that become finer from step to step, down to a side of
/// `finest` pixels, and calls `show` after each step. A cancelled render ends after at most one
/// more row of blocks.
///
/// # Errors
///
/// Returns an error if the part does not lie in the picture, if there is not enough memory, if no
/// thread can be started, or if the render was cancelled.
pub fn coarse_to_fine(
    world: &World,
    part: Area,
    finest: u32,
    control: &Control,
    mut show: impl FnMut(Coarse),
) -> Result<(), RenderError> {
    let coarser = SIDES.into_iter().filter(|&side| side > finest);
    for side in coarser.chain([finest]) {
        show(coarse(world, part, side, control)?);
    }
    Ok(())
}

/// Renders a part of the picture in blocks, from the part's top left corner on. `side` is the side
/// of a block in pixels, at least 1.
///
/// # Errors
///
/// Returns an error if the part does not lie in the picture, if there is not enough memory, if no
/// thread can be started, or if the render was cancelled.
///
/// # Panics
///
/// Panics if `side` is 0.
pub fn coarse(
    world: &World,
    part: Area,
    side: u32,
    control: &Control,
) -> Result<Coarse, RenderError> {
    check_part(part, world.picture())?;
    let colors = world.palette().iter();
    let colors: Vec<_> = colors.map(|color| color.to_linear()).collect();
    let (width, height) = (part.width.div_ceil(side), part.height.div_ceil(side));
    let film = Mutex::new(Film::new(width, height)?);
    threads::install(control.threads, || {
        (0..height).into_par_iter().for_each(|row| {
            if control.cancel.load(Ordering::Relaxed) {
                return;
            }
            let strip = Area {
                y: part.y + row * side,
                height: side.min(part.height - row * side),
                ..part
            };
            let blocks: Vec<_> = strip
                .tiles(side)
                .map(|block| colors[at_center(world, block)])
                .collect();
            let place = Area {
                x: 0,
                y: row,
                width,
                height: 1,
            };
            let mut film = lock(&film);
            film.put(place, &blocks);
        });
    })?;
    if control.cancel.load(Ordering::Relaxed) {
        return Err(RenderError::Cancelled);
    }
    let film = unpoisoned(film.into_inner());
    Ok(Coarse { side, film })
}

/// Returns the palette index of the colour that is seen at the centre of a block.
fn at_center(world: &World, block: Area) -> usize {
    // `place` returns a pixel and an offset from the pixel's middle. If the number of pixels is
    // odd, the centre is the middle of a pixel. If it is even, the centre lies between two pixels,
    // at an offset of −0.5 pixels from the middle of the second.
    let place = |start: u32, length: u32| match length % 2 {
        0 => (start + length / 2, -0.5),
        _ => (start + length / 2, 0.0),
    };
    let ((x, offset_x), (y, offset_y)) =
        (place(block.x, block.width), place(block.y, block.height));
    world.color_index_at(x, y, DVec2::new(offset_x, offset_y))
}
