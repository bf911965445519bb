//! Describes a scene in numbers: the camera's axes, its field of view, the vanishing points, and
//! the objects.

#[cfg(feature = "json")]
mod json;

use std::{borrow::Cow, cmp::Ordering, fmt};

use crate::{
    area::Area,
    math::{Big, Real},
    numbers::{grouped, short, short_vector},
    scene::{Camera, Count, Image, Method, Scene, Shape},
    seen::{self, LISTED, Visibility},
    source::Source,
    tracer::{Basis, vertices},
};
use glam::DVec3;

/// The output of `pinhole inspect`. Every number is the exact value, correctly rounded, except that
/// visible areas are estimates if [`is_exact`](Self::is_exact) is `false`.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Inspection {
    /// Width and height of the picture, in pixels.
    pub size: [u32; 2],
    /// Properties of the camera.
    pub camera: CameraFacts,
    /// The sampling method.
    pub method: Method,
    /// Number of samples per pixel; `None` if the scene gives their total.
    pub per_pixel: Option<u64>,
    /// Number of samples of the whole picture.
    pub total: u64,
    /// Seed of the random numbers for the samples.
    pub seed: u64,
    /// Vanishing points of the lines parallel to the world's x, y and z axes, in pixels from the
    /// picture's top left corner. `None` for an axis that is parallel to the view plane.
    pub vanishing_points: [Option<[f64; 2]>; 3],
    /// Properties of the objects, in file order.
    pub objects: Vec<ObjectFacts>,
    /// Whether the visible areas of the objects ([`ObjectFacts::seen`]) are exact.
    pub is_exact: bool,
}

/// Properties of a camera.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct CameraFacts {
    /// Position of the eye.
    pub eye: DVec3,
    /// Unit vector that points to the right in the picture.
    pub u: DVec3,
    /// Unit vector that points to the top of the picture.
    pub v: DVec3,
    /// Unit vector opposite to the view direction.
    pub w: DVec3,
    /// Distance from the eye to the view plane, in metres.
    pub d: f64,
    /// Height of the window, i.e. of the part of the view plane that the picture shows, in metres.
    pub view_height: f64,
    /// Vertical field of view, in degrees.
    pub fov_deg: f64,
    /// Horizontal field of view, in degrees.
    pub hfov_deg: f64,
    /// Depth of the near plane, in metres.
    pub near: f64,
    /// Depth of the far plane, in metres; `None` if there is no far plane.
    pub far: Option<f64>,
    /// Whether the camera looks "up", "down" or "level". This is decided by the exact sign of the
    /// view direction's y coordinate.
    pub looks: &'static str,
}

/// Properties of an object.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ObjectFacts {
    /// The object's name.
    pub name: Option<String>,
    /// Indices that distinguish the object from others that the same block of the file generates.
    /// Empty if the block generates a single object.
    pub indices: Box<[u32]>,
    /// The line in which the object begins, counted from 1.
    pub line: usize,
    /// The object's shape.
    pub shape: Shape,
    /// The part of the picture in which the object is visible, or the reason why it is not.
    pub seen: Visibility,
}

impl ObjectFacts {
    /// Returns the object's name. If it has no name, returns the indices that distinguish it from
    /// other objects of the same block; if it has no indices either, returns `-`.
    fn shown_name(&self) -> Cow<'_, str> {
        match (&self.name, &*self.indices) {
            (Some(name), _) => Cow::Borrowed(name),
            (None, []) => Cow::Borrowed("-"),
            (None, indices) => Cow::Owned(format!("{indices:?}")),
        }
    }
}

/// Describes a scene. `source` is the text of the scene, in which the lines of the objects are
/// found.
///
/// # Panics
///
/// Panics if the scene was made in code instead of read from a file, and breaks a condition of the
/// language. [`Scene::check`] finds such scenes.
pub fn inspect(scene: &Scene, source: &Source) -> Inspection {
    let per_pixel = match scene.sampler.count {
        Count::PerPixel(count) => Some(count),
        Count::Total(_) => None,
    };
    let basis = Basis::new(&scene.camera, &scene.image);
    let (seen, is_exact) = seen::seen(scene);
    let objects = scene
        .objects
        .iter()
        .zip(seen)
        .map(|(object, seen)| ObjectFacts {
            name: object.name.clone(),
            indices: object.indices.clone(),
            line: source.line(object.span.start),
            shape: object.shape,
            seen,
        });
    Inspection {
        size: [scene.image.width, scene.image.height],
        vanishing_points: [0, 1, 2].map(|axis| vanishing_point(&scene.image, &basis, axis)),
        camera: camera_facts(&scene.camera, &scene.image, &basis),
        method: scene.sampler.method,
        per_pixel,
        total: total_samples(scene.sampler.count, &scene.image),
        seed: scene.sampler.seed,
        objects: objects.collect(),
        is_exact,
    }
}

/// Returns the number of samples of the whole picture.
pub fn total_samples(count: Count, image: &Image) -> u64 {
    match count {
        Count::PerPixel(count) => {
            count.saturating_mul(u64::from(image.width) * u64::from(image.height))
        }
        Count::Total(total) => total,
    }
}

/// Computes the properties of a camera, and the vanishing points of the x, y and z axes. No other
/// part of the scene is needed.
///
/// # Panics
///
/// Panics if the camera or the image was made in code rather than read from a text, and breaks a
/// condition of the language, for example if the camera looks at its own eye. [`Scene::check`]
/// finds such scenes.
pub fn inspect_camera(camera: &Camera, image: &Image) -> (CameraFacts, [Option<[f64; 2]>; 3]) {
    let basis = Basis::new(camera, image);
    let points = [0, 1, 2].map(|axis| vanishing_point(image, &basis, axis));
    (camera_facts(camera, image, &basis), points)
}

fn camera_facts(camera: &Camera, image: &Image, basis: &Basis) -> CameraFacts {
    let vector = |v: &[Big; 3]| v.each_ref().map(rounded).into();
    let view_height = Big::from_f64(camera.view_height);
    let slope = view_height.over(&basis.d).scaled(-1);
    let [width, height] =
        [image.width, image.height].map(|pixels| Big::from_f64(f64::from(pixels)));
    let across = slope.times(&width).over(&height);
    CameraFacts {
        eye: camera.eye,
        u: vector(&basis.u),
        v: vector(&basis.v),
        w: vector(&basis.w),
        d: rounded(&basis.d),
        view_height: camera.view_height,
        fov_deg: rounded(&slope.atan_degrees().scaled(1)),
        hfov_deg: rounded(&across.atan_degrees().scaled(1)),
        near: camera.near,
        far: camera.far,
        looks: match basis.looks {
            Ordering::Greater => "up",
            Ordering::Less => "down",
            Ordering::Equal => "level",
        },
    }
}

/// Returns the vanishing point of the lines parallel to an axis, in pixels from the picture's top
/// left corner. Returns `None` if the axis is parallel to the view plane.
fn vanishing_point(image: &Image, basis: &Basis, axis: usize) -> Option<[f64; 2]> {
    // The camera's axis w is opposite to the view direction. Its component along the given axis is
    // 0 exactly if the given axis is parallel to the view plane. A ray along the given axis a has
    // the coordinates (a·u, a·v, −a·w) in the camera's axes u, v and −w. Dividing the first two
    // coordinates by the third and by a pixel's side at depth 1 gives the distances of the
    // vanishing point from the picture's middle, in pixels.
    if basis.w[axis].is_zero() {
        return None;
    }
    let depth = basis.w[axis].negated().times(&basis.pitch);
    let half = |pixels: u32| Big::from_f64(f64::from(pixels)).scaled(-1);
    let x = half(image.width).plus(&basis.u[axis].over(&depth));
    let y = half(image.height).minus(&basis.v[axis].over(&depth));
    Some([rounded(&x), rounded(&y)])
}

/// Rounds to a finite `f64`. Zero is returned without a sign.
fn rounded(x: &Big) -> f64 {
    x.to_finite() + 0.0
}

/// Numbers about the objects after the first [`LISTED`]. The readable output does not list these
/// objects one by one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Rest {
    objects: u64,
    seen: u64,
    /// Total visible area of the objects that are not listed, in pixels.
    pixels: f64,
    outside: u64,
}

const AXES: [&str; 3] = ["x", "y", "z"];

/// Writes the readable output of `pinhole inspect`. It lists at most [`LISTED`] objects.
impl fmt::Display for Inspection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [width, height] = self.size;
        writeln!(f, "image     {width} x {height} pixels")?;
        writeln!(f)?;
        writeln!(
            f,
            "{}",
            camera_summary(&self.camera, &self.vanishing_points)
        )?;
        let (method, total, seed) = (self.method.name(), grouped(self.total), self.seed);
        match (self.method, self.per_pixel) {
            (Method::Exact, _) => writeln!(f, "sampler   {method}: no samples")?,
            (_, Some(count)) => {
                let count = grouped(count);
                writeln!(
                    f,
                    "sampler   {method}, {count} per pixel, {total} in all, seed {seed}"
                )?;
            }
            (_, None) => writeln!(f, "sampler   {method}, {total} in all, seed {seed}")?,
        }
        writeln!(f)?;
        writeln!(f, "objects")?;
        for (index, object) in self.objects.iter().enumerate().take(LISTED) {
            let kind = object.shape.kind();
            let name = object.shown_name();
            let line = object.line;
            writeln!(
                f,
                "  {index:<3} {kind:<12} {name:<10} line {line:<4} {}",
                object.shape.summary(vertices)
            )?;
        }
        let more = self.objects.len().saturating_sub(LISTED) as u64;
        if more > 0 {
            writeln!(f, "  {} more, which --format json lists", grouped(more))?;
        }
        self.write_seen(f)
    }
}

/// The readable output's text about the areas in which the objects are visible.
impl Inspection {
    /// Returns numbers about the objects after the first [`LISTED`], which are not listed one by
    /// one. Returns `None` if there are no such objects.
    fn rest(&self) -> Option<Rest> {
        let rest = self.objects.get(LISTED..).filter(|rest| !rest.is_empty())?;
        let mut sum = Rest {
            objects: rest.len() as u64,
            ..Rest::default()
        };
        for object in rest {
            match object.seen {
                Visibility::Part(_, pixels) => {
                    sum.seen += 1;
                    sum.pixels += pixels;
                }
                Visibility::Outside(_) => sum.outside += 1,
                Visibility::HiddenBy(_) | Visibility::Nothing => {}
            }
        }
        Some(sum)
    }

    fn write_seen(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.objects.is_empty() {
            return Ok(());
        }
        let all = self.size.map(f64::from).iter().product::<f64>();
        let share = |pixels: f64| format!("{} %", short(100.0 * pixels / all));
        let about = if self.is_exact {
            ""
        } else {
            ", about: by the middles of pixels where there are too many outlines"
        };
        writeln!(f, "\nin the picture{about}")?;
        for (index, object) in self.objects.iter().enumerate().take(LISTED) {
            let name = object.shown_name();
            let words = match object.seen {
                Visibility::Part(around, pixels) => {
                    let Area {
                        x,
                        y,
                        width,
                        height,
                    } = around;
                    format!("{width} x {height} pixels at ({x}, {y}), {}", share(pixels))
                }
                Visibility::Outside(place) => place.words().replace('`', ""),
                Visibility::HiddenBy(other) => {
                    let other = self.objects.get(other);
                    let name = other.map(|it| it.name.as_deref().unwrap_or(it.shape.kind()));
                    format!("hidden by {}", name.unwrap_or_default())
                }
                Visibility::Nothing => "nothing of it".to_owned(),
            };
            let kind = object.shape.kind();
            writeln!(f, "  {index:<3} {kind:<12} {name:<10} {words}")?;
        }
        if let Some(rest) = self.rest() {
            let others = rest.objects - rest.seen - rest.outside;
            let [count, seen, outside, others] =
                [rest.objects, rest.seen, rest.outside, others].map(grouped);
            let share = share(rest.pixels);
            writeln!(
                f,
                "  {count} more: {seen} seen, {share}; {outside} outside of the picture; {others} hidden or too small"
            )?;
        }
        Ok(())
    }
}

/// Formats a camera as readable text: its axes, its field of view, and the vanishing points.
pub fn camera_summary(camera: &CameraFacts, vanishing_points: &[Option<[f64; 2]>; 3]) -> String {
    let mut text = format!("camera    looks {}\n", camera.looks);
    let vectors = [
        ("eye", camera.eye, ""),
        ("u", camera.u, "  the picture's right"),
        ("v", camera.v, "  the picture's top"),
        ("w", camera.w, "  against the view direction"),
    ];
    for (name, vector, meaning) in vectors {
        text += &format!("  {name:<7} {}{meaning}\n", short_vector(vector));
    }
    let [d, height] = [camera.d, camera.view_height].map(short);
    let [fov, hfov] = [camera.fov_deg, camera.hfov_deg].map(short);
    let far = camera.far.map_or("endless".to_owned(), short);
    text += &format!(
        "  d       {d}, view height {height}: a field of view of {fov} degrees, {hfov} across\n"
    );
    text += &format!("  depth   from {} to {far}\n\n", short(camera.near));
    text += "vanishing points, in pixels from the top left corner\n";
    for (axis, pixel) in AXES.iter().zip(vanishing_points) {
        text += &match pixel {
            Some([x, y]) => format!("  {axis}       ({}, {})\n", short(*x), short(*y)),
            None => format!("  {axis}       none: parallel to the view plane\n"),
        };
    }
    text
}
