//! A scene: its text, and what the text means.

use std::{collections::HashSet, fmt, str::FromStr, sync::Arc};

use super::{Error, Exact, Picture};
use crate::{
    area::Area,
    diagnostic::{Diagnostic, Mistakes},
    format::format,
    render::{self, Control, RenderError},
    sampling::Sampling,
    scene::{self, Scene as SceneData},
    source::{Source, Sources},
    tracer::World,
};

/// A scene without mistakes: its text, and what the text means.
///
/// ```
/// let scene = pinhole::Scene::parse(
///     "camera { eye (0, 2, 8)  lookat (0, 1, 0) }
///      sphere { center (0, 1, 0) }
///      checkerboard {}",
/// )?;
/// let rolled = scene.with_set("camera.roll=8deg")?;
/// assert_eq!(rolled.data().camera.roll, pinhole::Angle::from_degrees(8.0));
/// # Ok::<(), pinhole::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    sources: Arc<Sources>,
    data: SceneData,
    warnings: Vec<Diagnostic>,
}

impl Scene {
    /// Reads a scene from its text.
    ///
    /// # Errors
    ///
    /// The text has mistakes. All of them are returned.
    pub fn parse(text: &str) -> Result<Self, Mistakes> {
        Self::read(Sources::new(Source::from_text("scene", text)))
    }

    /// Makes a scene from data, for example from a changed copy of another scene's data. The
    /// scene's text is generated from the data. In it, repeated objects are written one by one and
    /// have other names: `Ball[3, 1]` becomes `Ball_3_1`.
    ///
    /// ```
    /// use pinhole::{Scene, glam::DVec3, scene::{Object, Sphere}};
    ///
    /// let mut data = Scene::parse("camera { eye (0, 2, 8)  lookat (0, 1, 0) } checkerboard {}")?
    ///     .data()
    ///     .clone();
    /// data.image.width = 640;
    /// for x in 0..5 {
    ///     let (center, radius) = (DVec3::new(f64::from(x), 1.0, 0.0), 0.4);
    ///     let ball = Sphere { center, radius, color: "tomato".parse()? };
    ///     data.objects_mut().push(Object::new(ball).named(format!("Ball_{x}")));
    /// }
    /// let scene = Scene::from_data(&data)?;
    /// assert!(scene.to_string().contains("Ball_4 { center (4, 1, 0)  radius 0.4"));
    ///
    /// data.camera.near = -1.0;
    /// assert_eq!(Scene::from_data(&data).unwrap_err().iter().count(), 1);
    /// # Ok::<(), pinhole::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// The data break a condition of the language: for example, a radius is 0, a number is NaN, or
    /// an object's name contains a space. The places of the mistakes refer to the generated text.
    pub fn from_data(data: &SceneData) -> Result<Self, Mistakes> {
        Self::parse(&formatted(data.text()?))
    }

    /// Returns the scene with one more setting in the form of the option `--set`, for example
    /// `camera.roll=8deg`. It changes a field of the camera, the image, the sampler or a named
    /// object, or the value of a `let`. An earlier setting of the same target is replaced.
    ///
    /// # Errors
    ///
    /// The scene has nothing with the setting's name, or the value is not allowed for it.
    pub fn with_set(&self, setting: &str) -> Result<Self, Mistakes> {
        self.with_sets([setting])
    }

    /// Returns the scene with several more settings, as [`with_set`](Self::with_set) does. The text
    /// is read only once, with all settings. So values can be set that are allowed only together.
    ///
    /// ```
    /// let scene = pinhole::Scene::parse("camera { eye (0, 2, 8)  lookat (0, 1, 0)  far 20 }")?;
    /// assert!(scene.with_set("camera.near=30").is_err());
    /// let farther = scene.with_sets(["camera.near=30", "camera.far=40"])?;
    /// assert_eq!(farther.data().camera.far, Some(40.0));
    /// # Ok::<(), pinhole::Mistakes>(())
    /// ```
    ///
    /// # Errors
    ///
    /// The scene has nothing with the name of one of the settings, or a value is not allowed.
    pub fn with_sets<S: AsRef<str>>(
        &self,
        settings: impl IntoIterator<Item = S>,
    ) -> Result<Self, Mistakes> {
        let settings: Vec<S> = settings.into_iter().collect();
        let targets: HashSet<_> = settings.iter().map(|set| target(set.as_ref())).collect();
        let earlier = self.sources.sets.iter().map(Source::text);
        let kept = earlier.filter(|set| !targets.contains(&target(set)));
        let sources = Sources::new(self.sources.file.clone()).with_sets(kept);
        Self::read(sources.with_sets(&settings))
    }

    pub(super) fn read(sources: Sources) -> Result<Self, Mistakes> {
        let sources = Arc::new(sources);
        let reading = scene::read(&sources);
        match reading.scene {
            Some(data) => Ok(Self {
                sources,
                data,
                warnings: reading.diagnostics,
            }),
            None => Err(Mistakes::new(sources, reading.diagnostics)),
        }
    }

    /// Returns what the text means, as plain data: image, camera, sampler and objects, with all
    /// values computed.
    pub fn data(&self) -> &SceneData {
        &self.data
    }

    /// Returns the warnings about the text, sorted by their places in it.
    ///
    /// ```
    /// let scene = pinhole::Scene::parse("camera { eye (0, 2, 8)  lookat (0, 1, 0) }")?;
    /// assert_eq!(scene.diagnostics()[0].message, "the scene has no objects");
    /// # Ok::<(), pinhole::Mistakes>(())
    /// ```
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.warnings
    }

    /// Returns the scene's text and settings. The places of warnings are positions in them.
    pub fn sources(&self) -> &Sources {
        &self.sources
    }

    /// Renders the picture as the scene's sampler says, on all processors. If the sampler's method
    /// is `exact`, the picture is computed without samples, as by
    /// [`render_exact`](Self::render_exact).
    ///
    /// # Errors
    ///
    /// There is not enough memory, or no thread can be started.
    pub fn render(&self) -> Result<Picture, Error> {
        self.render_with(self.size(), &Control::default())
    }

    /// Renders an area of the picture as [`render`](Self::render) does. `control` limits the
    /// threads, reports the progress and can cancel the render. Each pixel has the same colour as
    /// in the whole picture.
    ///
    /// ```
    /// use std::{
    ///     num::NonZero,
    ///     sync::atomic::{AtomicBool, AtomicU64, Ordering},
    /// };
    ///
    /// use pinhole::{area::Area, render::Control};
    ///
    /// # let scene = pinhole::Scene::parse("camera { eye (0, 2, 8)  lookat (0, 1, 0) }
    /// #     checkerboard {}  image { width 40  height 30 } sampler { per_pixel 16 }")?;
    /// let (done, stop) = (AtomicU64::new(0), AtomicBool::new(false));
    /// let control = Control {
    ///     threads: NonZero::new(1),
    ///     progress: &|samples| {
    ///         done.fetch_add(samples, Ordering::Relaxed);
    ///     },
    ///     cancel: &stop, // another thread may set it
    /// };
    /// let middle = Area { x: 10, y: 10, width: 20, height: 10 };
    /// let picture = scene.render_with(middle, &control)?;
    /// assert_eq!((picture.width(), picture.height()), (20, 10));
    /// assert_eq!(done.into_inner(), 20 * 10 * 16);
    /// # Ok::<(), pinhole::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// The area has no pixels or does not lie in the picture, the render was cancelled, there is
    /// not enough memory, or no thread can be started.
    pub fn render_with(&self, area: Area, control: &Control) -> Result<Picture, Error> {
        let size = self.size();
        let world = World::new_unless(&self.data, control.cancel).map_err(RenderError::from)?;
        let sampling = Sampling::new(&self.data.sampler, size.width, size.height);
        let film = render::render(&world, &sampling, area, control)?;
        let mut picture = Picture::rendered(film, &self.sources);
        if area != size {
            picture.coded.crop = Some(area);
            picture.coded.size = Some([size.width, size.height]);
        }
        Ok(picture)
    }

    /// Computes the picture without samples, whatever the scene's sampler says. Each pixel's mean
    /// colour has an error bound, which is at most 10⁻⁹ in ordinary views.
    ///
    /// # Errors
    ///
    /// There is not enough memory, or no thread can be started.
    pub fn render_exact(&self) -> Result<Exact, Error> {
        let world = World::new(&self.data);
        let exact = render::render_exact(&world, self.size(), &Control::default())?;
        Ok(Exact {
            picture: Picture::rendered(exact.film, &self.sources),
            bounds: exact.bounds,
        })
    }

    pub(super) fn size(&self) -> Area {
        Area::whole(self.data.image.width, self.data.image.height)
    }
}

impl Picture {
    /// Returns the scene that the picture shows. It is known if the picture was rendered, or read
    /// from a PNG that carries its scene.
    ///
    /// ```
    /// let scene = pinhole::Scene::parse("camera { eye (0, 2, 8)  lookat (0, 1, 0) }")?;
    /// let picture = scene.with_sets(["image.width=40", "image.height=30"])?.render()?;
    /// let rolled = picture.scene()?.with_set("camera.roll=8deg")?;
    /// assert_eq!(rolled.data().image.width, 40);
    /// # Ok::<(), pinhole::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// The scene is unknown, or has mistakes.
    pub fn scene(&self) -> Result<Scene, Error> {
        let sources = self.sources().ok_or(Error::NoScene)?;
        Ok(Scene::read(sources.clone())?)
    }
}

/// Writes the scene's text. If the scene has settings, the text is generated from its
/// [data](Scene::data). Such a text contains no comments and no `let`s, and repeated objects are
/// written one by one.
impl fmt::Display for Scene {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.sources.sets[..] {
            [] => f.write_str(self.sources.file.text()),
            _ => f.write_str(&formatted(self.data.to_string())),
        }
    }
}

/// Reads a scene from its text, as [`Scene::parse`] does.
impl FromStr for Scene {
    type Err = Mistakes;

    fn from_str(text: &str) -> Result<Self, Mistakes> {
        Self::parse(text)
    }
}

/// Returns the target of a setting: the words before its `=`.
fn target(setting: &str) -> Vec<&str> {
    let (target, _) = setting.split_once('=').unwrap_or((setting, ""));
    target.split('.').map(str::trim).collect()
}

/// Returns a text in the canonical layout, or as it is if it cannot be parsed.
fn formatted(text: String) -> String {
    format(&Source::from_text("scene", text.clone())).unwrap_or(text)
}
