//! Writes pictures to files, band by band, so that the whole picture need not be in memory.

use std::{
    io,
    path::{Path, PathBuf},
    sync::atomic::AtomicBool,
};

use numpy::{Element, PyReadonlyArray3, PyUntypedArrayMethods};
use pinhole::{
    area::Area,
    files::{self, Purpose, Sink},
    film::{self, Film, Pixel},
    render::Control,
};
use pyo3::{
    exceptions::{PyMemoryError, PyValueError},
    prelude::*,
    types::PyIterator,
};

use crate::scene::{Crop, Inner, Scene, Threads};

/// Type of a picture's pixels, which determines the format of its file.
trait FilePixel: Pixel + 'static {
    /// Whether the format stores the scene's text.
    const STORES_TEXT: bool;

    /// Writes a part of a scene's picture from bands of rows.
    fn write(
        scene: &Inner,
        crop: Crop,
        out: &mut dyn Sink,
        bands: impl Iterator<Item = io::Result<Film<Self>>>,
    ) -> io::Result<()>;
}

/// PNG, which has 8 bits per channel here.
impl FilePixel for [u8; 3] {
    const STORES_TEXT: bool = true;

    fn write(
        scene: &Inner,
        crop: Crop,
        out: &mut dyn Sink,
        bands: impl Iterator<Item = io::Result<Film<Self>>>,
    ) -> io::Result<()> {
        let Area { width, height, .. } = scene.part(crop);
        film::write_png_bands([width, height], Some(&scene.recipe(crop)), out, bands)
    }
}

/// OpenEXR, which has 32-bit floats here.
impl FilePixel for [f32; 3] {
    const STORES_TEXT: bool = false;

    fn write(
        scene: &Inner,
        crop: Crop,
        out: &mut dyn Sink,
        bands: impl Iterator<Item = io::Result<Film<Self>>>,
    ) -> io::Result<()> {
        let digest = scene.recipe(crop).digest();
        film::write_exr_bands(scene.part(crop), scene.whole(), Some(&digest), out, bands)
    }
}

/// Renders a picture to a PNG file. Returns `false` if the scene's text or its settings are too
/// long to be stored in the file.
#[pyfunction]
pub fn save_png(
    py: Python<'_>,
    scene: &Scene,
    path: PathBuf,
    crop: Crop,
    threads: Threads,
) -> PyResult<bool> {
    save::<[u8; 3]>(py, scene, path, crop, threads)
}

/// Renders a picture to an OpenEXR file. Returns `true`, since the format stores no text.
#[pyfunction]
pub fn save_exr(
    py: Python<'_>,
    scene: &Scene,
    path: PathBuf,
    crop: Crop,
    threads: Threads,
) -> PyResult<bool> {
    save::<[f32; 3]>(py, scene, path, crop, threads)
}

fn save<P: FilePixel>(
    py: Python<'_>,
    scene: &Scene,
    path: PathBuf,
    crop: Crop,
    threads: Threads,
) -> PyResult<bool> {
    scene.run(py, move |inner, cancel| {
        inner.bands::<P, _>(crop, threads, cancel, |bands| {
            write(inner, &path, crop, cancel, bands)
        })
    })
}

/// Writes a PNG file from an iterator over bands of rows, which are arrays of bytes. Returns
/// `false` if the scene's text or its settings are too long to be stored in the file.
#[pyfunction]
pub fn write_png(
    py: Python<'_>,
    scene: &Scene,
    path: PathBuf,
    bands: Py<PyIterator>,
) -> PyResult<bool> {
    write_bands::<u8>(py, scene, &path, bands)
}

/// Writes an OpenEXR file from an iterator over bands of rows, which are arrays of floats. Returns
/// `true`, since the format stores no text.
#[pyfunction]
pub fn write_exr(
    py: Python<'_>,
    scene: &Scene,
    path: PathBuf,
    bands: Py<PyIterator>,
) -> PyResult<bool> {
    write_bands::<f32>(py, scene, &path, bands)
}

/// Writes bands on the calling thread, so that Python handles signals between two bands.
fn write_bands<T: Element + Copy + Sync>(
    py: Python<'_>,
    scene: &Scene,
    path: &Path,
    bands: Py<PyIterator>,
) -> PyResult<bool>
where
    [T; 3]: FilePixel,
{
    let inner = scene.shared();
    py.detach(|| {
        let next = || Python::attach(|py| next_band(bands.bind(py)).transpose());
        write(
            &inner,
            path,
            None,
            Control::default().cancel,
            std::iter::from_fn(next),
        )
    })
}

/// Returns the next band of rows that a Python iterator yields, or `None` at its end.
fn next_band<T: Element + Copy>(bands: &Bound<'_, PyIterator>) -> PyResult<Option<Film<[T; 3]>>>
where
    [T; 3]: Pixel,
{
    let Some(band) = bands.clone().next() else {
        return Ok(None);
    };
    let band: PyReadonlyArray3<'_, T> = band?.extract()?;
    let [height, width, 3] = *band.shape() else {
        return Err(PyValueError::new_err("a band of rows has three channels"));
    };
    let numbers = band.as_slice()?;
    let (pixels, _) = numbers.as_chunks();
    Film::from_fn(width as u32, height as u32, |x, y| {
        pixels[y as usize * width + x as usize]
    })
    .map(Some)
    .map_err(|error| PyMemoryError::new_err(error.to_string()))
}

/// Writes a picture's bands to a file, completely or not at all. Returns `false` if the format
/// stores the scene's text, but the text or the settings are too long for it.
fn write<P: FilePixel>(
    scene: &Inner,
    path: &Path,
    crop: Crop,
    cancel: &AtomicBool,
    mut bands: impl Iterator<Item = PyResult<Film<P>>>,
) -> PyResult<bool> {
    let mut failed = None;
    // The first band is made before the file is opened. Most pictures are rendered as a single
    // band, so they leave no temporary file if this process is killed while it renders.
    let first = bands.next();
    let all = first.into_iter().chain(bands).map(|band| {
        band.map_err(|error| {
            failed = Some(error);
            io::Error::from(io::ErrorKind::Other)
        })
    });
    let written = files::write(path, Purpose::Named, cancel, |out| {
        P::write(scene, crop, out, all)
    });
    if let Some(error) = failed {
        return Err(error);
    }
    written.map_err(|error| not_written(path, &error))?;
    Ok(!P::STORES_TEXT || scene.recipe(crop).fits())
}

fn not_written(path: &Path, error: &io::Error) -> PyErr {
    let message = format!("cannot write to {}: {error}", path.display());
    io::Error::new(error.kind(), message).into()
}
