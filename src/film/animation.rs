//! Animated PNG files: pictures of the same size, one after the other. All browsers show them.

use std::{
    fmt,
    io::{self, Write},
    mem,
    sync::{Arc, Mutex},
};

use png::Writer;

use super::{pixels::Film, png::encoder};
use crate::lock::lock;

/// An animation to which pictures are added one by one. Earlier pictures are in memory only in
/// compressed form.
pub struct Animation {
    size: [u32; 2],
    writer: Writer<Shared>,
    file: Shared,
}

impl Animation {
    /// Begins an animation of `count` pictures, each of which is shown for `pause` milliseconds.
    /// After the last picture, the animation starts again.
    ///
    /// # Errors
    ///
    /// `count` is 0, or a PNG cannot have this size.
    pub fn new(size: [u32; 2], count: u32, pause: u16) -> io::Result<Self> {
        let file = Shared::default();
        let mut encoder = encoder(file.clone(), size);
        encoder.set_animated(count, 0)?;
        encoder.set_frame_delay(pause, 1000)?;
        let writer = encoder.write_header()?;
        Ok(Self { size, writer, file })
    }

    /// Adds the next picture.
    ///
    /// # Errors
    ///
    /// The picture has another size than the first one, or there are more pictures than expected.
    pub fn add(&mut self, film: &Film<[u8; 3]>) -> io::Result<()> {
        if [film.width(), film.height()] != self.size {
            let why = "the size of the picture changes";
            return Err(io::Error::new(io::ErrorKind::InvalidInput, why));
        }
        Ok(self.writer.write_image_data(film.pixels().as_flattened())?)
    }

    /// Returns the bytes of the file.
    ///
    /// # Errors
    ///
    /// There are fewer pictures than expected.
    pub fn finish(self) -> io::Result<Vec<u8>> {
        self.writer.finish()?;
        Ok(mem::take(&mut lock(&self.file.0)))
    }
}

impl fmt::Debug for Animation {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("Animation")
            .field("size", &self.size)
            .finish_non_exhaustive()
    }
}

/// The bytes of a file, shared with the writer. They remain when the writer is dropped.
#[derive(Clone, Debug, Default)]
struct Shared(Arc<Mutex<Vec<u8>>>);

impl Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        lock(&self.0).write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
