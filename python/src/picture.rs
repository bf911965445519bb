//! Pictures as arrays of NumPy, and arrays of NumPy as pictures.

use numpy::{AsSliceError, Element, PyArray1, PyArray3, PyArrayMethods, PyReadonlyArray3};
use pinhole::{
    area::Area,
    color::srgb_to_linear,
    film::{self, Film, Pixel, Rounding},
};
use pyo3::{exceptions::PyMemoryError, prelude::*};

/// Makes an array of rows, columns and channels from a picture, without copying its pixels.
pub fn array<T: Element>(py: Python<'_>, film: Film<[T; 3]>) -> PyResult<Bound<'_, PyArray3<T>>>
where
    [T; 3]: Pixel,
{
    let shape = [film.height() as usize, film.width() as usize, 3];
    PyArray1::from_vec(py, film.into_pixels().into_flattened()).reshape(shape)
}

/// A picture of another program, as a contiguous array of rows, columns and channels.
#[derive(FromPyObject)]
pub enum Pixels<'py> {
    Bytes(PyReadonlyArray3<'py, u8>),
    Words(PyReadonlyArray3<'py, u16>),
    Light(PyReadonlyArray3<'py, f64>),
}

impl Pixels<'_> {
    /// Copies the numbers, so that another thread can read them.
    pub fn copied(&self) -> Result<Numbers, AsSliceError> {
        Ok(match self {
            Self::Bytes(pixels) => Numbers::Bytes(pixels.to_vec()?),
            Self::Words(pixels) => Numbers::Words(pixels.to_vec()?),
            Self::Light(pixels) => Numbers::Light(pixels.to_vec()?),
        })
    }
}

/// The values of a picture: the rows from the top and, for each pixel, red, green and blue.
pub enum Numbers {
    /// Whole numbers of 8 bits, in sRGB.
    Bytes(Vec<u8>),
    /// Whole numbers of 16 bits, in sRGB.
    Words(Vec<u16>),
    /// Floats in linear light.
    Light(Vec<f64>),
}

impl Numbers {
    /// Converts the values to a picture with the size of `part`. The result is the same as if the
    /// values were read from a file.
    pub fn picture(&self, part: Area) -> PyResult<film::Picture> {
        let (film, rounding) = match self {
            Self::Bytes(numbers) => (encoded(numbers, part)?, Rounding::Byte),
            Self::Words(numbers) => (encoded(numbers, part)?, Rounding::Word),
            Self::Light(numbers) => (filled(numbers, part, |light| light)?, Rounding::Float),
        };
        Ok(film::Picture::new(film, rounding))
    }
}

/// Makes a film from integers in sRGB. The largest value of their type is white.
fn encoded<T: Copy + Into<usize>>(numbers: &[T], part: Area) -> PyResult<Film> {
    let white = (1_usize << (8 * size_of::<T>())) - 1;
    let light = (0..=white).map(|number| srgb_to_linear(number as f64 / white as f64));
    let light: Vec<f64> = light.collect();
    filled(numbers, part, |number| light[number.into()])
}

fn filled<T: Copy>(numbers: &[T], part: Area, light: impl Fn(T) -> f64) -> PyResult<Film> {
    let (pixels, _) = numbers.as_chunks();
    let width = part.width as usize;
    let pixel = |x, y| pixels[y as usize * width + x as usize].map(&light);
    Film::from_fn(part.width, part.height, pixel)
        .map_err(|error| PyMemoryError::new_err(error.to_string()))
}
