//! Pictures as arrays of NumPy, and arrays of NumPy as pictures.

use numpy::{Element, PyArray1, PyArray3, PyArrayMethods, PyReadonlyArray3, PyUntypedArrayMethods};
use pinhole::{
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

/// A picture of another program, as an array of rows, columns and channels.
#[derive(FromPyObject)]
pub enum Pixels<'py> {
    /// Whole numbers of 8 bits, in sRGB.
    Bytes(PyReadonlyArray3<'py, u8>),
    /// Whole numbers of 16 bits, in sRGB.
    Words(PyReadonlyArray3<'py, u16>),
    /// Floats in linear light.
    Light(PyReadonlyArray3<'py, f64>),
}

impl Pixels<'_> {
    /// Returns the picture as it would be read from a file with these numbers.
    ///
    /// # Errors
    ///
    /// There is not enough memory for the picture.
    pub fn picture(&self) -> PyResult<film::Picture> {
        let (film, rounding) = match self {
            Self::Bytes(pixels) => (encoded(pixels)?, Rounding::Byte),
            Self::Words(pixels) => (encoded(pixels)?, Rounding::Word),
            Self::Light(pixels) => (filled(pixels, |light| light)?, Rounding::Float),
        };
        Ok(film::Picture::new(film, rounding))
    }
}

/// Makes a film from whole numbers in sRGB, the greatest of which is white.
fn encoded<T: Element + Copy + Into<usize> + TryFrom<usize>>(
    pixels: &PyReadonlyArray3<'_, T>,
) -> PyResult<Film> {
    let white = (1_usize << (8 * size_of::<T>())) - 1;
    let light = (0..=white).map(|number| srgb_to_linear(number as f64 / white as f64));
    let light: Vec<f64> = light.collect();
    filled(pixels, |number| light[number.into()])
}

fn filled<T: Element + Copy>(
    pixels: &PyReadonlyArray3<'_, T>,
    light: impl Fn(T) -> f64,
) -> PyResult<Film> {
    let [height, width, _] = *pixels.shape() else {
        unreachable!("an array of three dimensions has three lengths")
    };
    let numbers = pixels.as_array();
    let film = Film::from_fn(width as u32, height as u32, |x, y| {
        [0, 1, 2].map(|channel| light(numbers[[y as usize, x as usize, channel]]))
    });
    film.map_err(|error| PyMemoryError::new_err(error.to_string()))
}
