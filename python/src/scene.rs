//! A scene that was read, with its pictures and the answers about it.

use std::{
    io::{self, Cursor},
    num::NonZero,
    sync::{Arc, Mutex, PoisonError, atomic::AtomicBool},
};

use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pinhole::{
    SceneData,
    area::Area,
    diagnostic::{Report, Style, to_json},
    film::{self, Film, Pixel, Recipe, Rounding},
    glam::DVec2,
    grading::{self, Reference},
    inspect, probe,
    render::{self, Control, RenderError},
    sampling::Sampling,
    scene::{self, Reading},
    source::{Source, Sources},
    tracer::World,
};
use pyo3::{
    exceptions::{PyKeyboardInterrupt, PyMemoryError, PyRuntimeError, PyValueError},
    prelude::*,
    types::PyBytes,
};
use serde_json::Value;

use crate::{
    background::cancellable,
    picture::{Pixels, array},
};

/// Converts a failure to render to a Python exception.
fn not_rendered(error: RenderError) -> PyErr {
    let message = error.to_string();
    match error {
        RenderError::TooLarge(_) => PyMemoryError::new_err(message),
        RenderError::Outside { .. } => PyValueError::new_err(message),
        RenderError::Cancelled => PyKeyboardInterrupt::new_err(()),
        _ => PyRuntimeError::new_err(message),
    }
}

/// Returns the text and the settings of the scene that a PNG contains, or `None` if the bytes are
/// no PNG.
#[pyfunction]
pub fn carried(bytes: &[u8]) -> PyResult<Option<(String, Vec<String>)>> {
    if !bytes.starts_with(&film::SIGNATURE) {
        return Ok(None);
    }
    let recipe =
        film::read_recipe(bytes).map_err(|error| PyValueError::new_err(error.to_string()))?;
    Ok(Some((recipe.scene, recipe.overrides)))
}

/// Reads a scene from the bytes of its text and from settings in the form of `--set`. Returns the
/// scene, or `None` if it has errors. Also returns its problems twice: as a JSON array, and as a
/// report for people.
#[pyfunction]
pub fn read(
    py: Python<'_>,
    name: String,
    text: Vec<u8>,
    settings: Vec<String>,
) -> PyResult<(Option<Scene>, String, String)> {
    cancellable(py, move |cancel| {
        let sources = Sources::new(Source::from_bytes(name, text)).with_sets(settings);
        let Reading {
            scene, diagnostics, ..
        } = scene::read_unless(&sources, cancel).map_err(|_| PyKeyboardInterrupt::new_err(()))?;
        let problems: Vec<Value> = diagnostics.iter().map(|it| to_json(it, &sources)).collect();
        let report = Report::new(&sources, Style::default()).human(&diagnostics);
        let scene = scene.map(|data| Scene(Arc::new(Inner::new(sources, data))));
        Ok((scene, Value::from(problems).to_string(), report))
    })?
}

/// A scene without errors. It never changes, so that threads can share it.
#[pyclass(frozen)]
pub struct Scene(Arc<Inner>);

/// Data that the threads working on a scene share.
pub struct Inner {
    sources: Sources,
    data: SceneData,
    /// Scene prepared for the tracer; `None` before the first render.
    world: Mutex<Option<Arc<World>>>,
    /// Exact picture with which the last picture was compared; `None` before the first comparison.
    reference: Mutex<Option<Arc<Reference>>>,
}

/// Left column, top row, width and height of a part; `None` for the whole picture.
pub type Crop = Option<[u32; 4]>;
/// Number of threads; `None` for one per processor.
pub type Threads = Option<NonZero<usize>>;

#[pymethods]
impl Scene {
    /// Width and height of the picture, in pixels.
    #[getter]
    fn size(&self) -> (u32, u32) {
        let image = &self.0.data.image;
        (image.width, image.height)
    }

    fn render<'py>(
        &self,
        py: Python<'py>,
        crop: Crop,
        threads: Threads,
    ) -> PyResult<Bound<'py, PyArray3<u8>>> {
        array(py, self.film(py, crop, threads)?)
    }

    fn render_linear<'py>(
        &self,
        py: Python<'py>,
        crop: Crop,
        threads: Threads,
    ) -> PyResult<Bound<'py, PyArray3<f64>>> {
        array(py, self.film(py, crop, threads)?)
    }

    #[expect(
        clippy::type_complexity,
        reason = "an array of means, and one of bounds"
    )]
    fn render_exact<'py>(
        &self,
        py: Python<'py>,
        crop: Crop,
        threads: Threads,
    ) -> PyResult<(Bound<'py, PyArray3<f64>>, Bound<'py, PyArray2<f32>>)> {
        let exact = self.run(py, move |inner, cancel| {
            let control = control(threads, cancel);
            let world = inner.world(cancel)?;
            render::render_exact(&world, inner.part(crop), &control).map_err(not_rendered)
        })?;
        let shape = [exact.film.height() as usize, exact.film.width() as usize];
        let bounds = PyArray1::from_vec(py, exact.bounds).reshape(shape)?;
        Ok((array(py, exact.film)?, bounds))
    }

    /// Returns the bytes of the picture's PNG.
    fn png(&self, py: Python<'_>, crop: Crop, threads: Threads) -> PyResult<Py<PyBytes>> {
        let bytes = self.run(py, move |inner, cancel| {
            let film: Film<[u8; 3]> = inner.film(crop, threads, cancel)?;
            let mut bytes = Cursor::new(Vec::new());
            film::write_png(&film, Some(&inner.recipe(crop)), &mut bytes)?;
            Ok(bytes.into_inner())
        })?;
        Ok(PyBytes::new(py, &bytes).unbind())
    }

    fn inspect(&self, py: Python<'_>) -> PyResult<String> {
        self.run(py, |inner, _| {
            let mut json = Vec::new();
            inspect::inspect(&inner.data, &inner.sources.file)
                .write_json(&mut json)
                .and_then(|()| String::from_utf8(json).map_err(io::Error::other))
                .map_err(Into::into)
        })
    }

    fn probe(&self, py: Python<'_>, x: f64, y: f64) -> PyResult<String> {
        self.run(py, move |inner, _| {
            Ok(probe::probe(&inner.data, DVec2::new(x, y))
                .to_json()
                .to_string())
        })
    }

    /// Judges a picture that another program has made of the part `crop` of the scene. The picture
    /// must have the size of this part.
    fn grade(&self, py: Python<'_>, picture: Pixels<'_>, crop: Crop) -> PyResult<String> {
        let numbers = picture.copied()?;
        self.run(py, move |inner, cancel| {
            let part = inner.part(crop);
            let picture = numbers.picture(part)?;
            let rounding = picture.rounding;
            let reference = inner.reference(part, rounding, cancel)?;
            let comparison = reference
                .compare(&picture.film, rounding.steps())
                .map_err(|error| PyValueError::new_err(error.to_string()))?;
            let verdict = reference
                .judge(&picture, None, &comparison, cancel)
                .map_err(not_rendered)?;
            let sizes = [[part.width, part.height]; 2];
            let steps = rounding.steps();
            let figures = grading::figures(sizes, Some(&comparison), steps, Some(&verdict));
            Ok(Value::Object(figures).to_string())
        })
    }
}

impl Scene {
    /// Returns the data that threads share.
    pub fn shared(&self) -> Arc<Inner> {
        Arc::clone(&self.0)
    }

    /// Runs `work` on another thread, until it ends or Ctrl-C is pressed.
    pub fn run<T: Send + 'static>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&Inner, &AtomicBool) -> PyResult<T> + Send + 'static,
    ) -> PyResult<T> {
        let inner = self.shared();
        cancellable(py, move |cancel| work(&inner, cancel))?
    }

    fn film<P: Pixel + 'static>(
        &self,
        py: Python<'_>,
        crop: Crop,
        threads: Threads,
    ) -> PyResult<Film<P>> {
        self.run(py, move |inner, cancel| inner.film(crop, threads, cancel))
    }
}

impl Inner {
    fn new(sources: Sources, data: SceneData) -> Self {
        Self {
            sources,
            data,
            world: Mutex::default(),
            reference: Mutex::default(),
        }
    }

    /// Returns the area of the whole picture.
    pub fn whole(&self) -> Area {
        Area::whole(self.data.image.width, self.data.image.height)
    }

    /// Returns the area of a part of the picture.
    pub fn part(&self, crop: Crop) -> Area {
        crop.map_or(self.whole(), |[x, y, width, height]| Area {
            x,
            y,
            width,
            height,
        })
    }

    /// Returns what a picture file stores: the scene's text, its settings, and the part of the
    /// picture.
    pub fn recipe(&self, crop: Crop) -> Recipe {
        let sets = self.sources.sets.iter();
        Recipe {
            scene: self.sources.file.text().to_owned(),
            overrides: sets.map(|set| set.text().to_owned()).collect(),
            crop: crop.map(|_| self.part(crop)),
            size: crop.map(|_| [self.whole().width, self.whole().height]),
        }
    }

    fn film<P: Pixel>(
        &self,
        crop: Crop,
        threads: Threads,
        cancel: &AtomicBool,
    ) -> PyResult<Film<P>> {
        let (world, sampling) = (self.world(cancel)?, self.sampling());
        let control = control(threads, cancel);
        let rendered = render::render_as_asked(&world, &sampling, self.part(crop), &control)
            .map_err(not_rendered)?;
        Ok(rendered.into_film())
    }

    /// Renders a part of the picture in bands of rows, and calls `write` with them.
    pub fn bands<P: Pixel, T>(
        &self,
        crop: Crop,
        threads: Threads,
        cancel: &AtomicBool,
        write: impl FnOnce(&mut dyn Iterator<Item = PyResult<Film<P>>>) -> PyResult<T>,
    ) -> PyResult<T> {
        let (world, sampling) = (self.world(cancel)?, self.sampling());
        let control = control(threads, cancel);
        let bands = render::render_bands(&world, &sampling, self.part(crop), &control)
            .map_err(not_rendered)?;
        write(&mut bands.map(|band| Ok(band.map_err(not_rendered)?.1.into_film())))
    }

    fn sampling(&self) -> Sampling {
        let whole = self.whole();
        Sampling::new(&self.data.sampler, whole.width, whole.height)
    }

    fn world(&self, cancel: &AtomicBool) -> PyResult<Arc<World>> {
        cached(
            &self.world,
            |_| true,
            || World::new_unless(&self.data, cancel).map_err(RenderError::from),
        )
    }

    fn reference(
        &self,
        part: Area,
        rounding: Rounding,
        cancel: &AtomicBool,
    ) -> PyResult<Arc<Reference>> {
        cached(
            &self.reference,
            |found| found.is_for(part, rounding),
            || Reference::new(&self.data, part, rounding, &control(None, cancel)),
        )
    }
}

fn control<'a>(threads: Threads, cancel: &'a AtomicBool) -> Control<'a> {
    Control {
        threads,
        cancel,
        ..Control::default()
    }
}

/// Returns the cached value if it is suitable, and otherwise makes a new one. The lock is not held
/// while a value is made. Therefore, two threads may make the same value. But if the process is
/// forked meanwhile, the lock is free in the new process.
fn cached<T>(
    cache: &Mutex<Option<Arc<T>>>,
    is_suitable: impl Fn(&T) -> bool,
    make: impl FnOnce() -> Result<T, RenderError>,
) -> PyResult<Arc<T>> {
    let lock = || cache.lock().unwrap_or_else(PoisonError::into_inner);
    let found = lock().clone().filter(|found| is_suitable(found));
    if let Some(found) = found {
        return Ok(found);
    }
    let made = Arc::new(make().map_err(not_rendered)?);
    *lock() = Some(Arc::clone(&made));
    Ok(made)
}
