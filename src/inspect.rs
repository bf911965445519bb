//! What a scene means, in numbers: the camera's axes, its field of view, the vanishing points, the
//! objects.

mod json;

use std::{borrow::Cow, cmp::Ordering, fmt};

use crate::{
    area::Area,
    math::{Big, Real},
    numbers::{grouped, short, short_vector},
    scene::{Camera, Checkerboard, Count, Cuboid, Image, Method, Outline, Scene, Shape, Sphere},
    seen::{self, LISTED, Seen},
    source::Source,
    tracer::{Basis, vertices},
};
use glam::DVec3;

/// What `pinhole inspect` shows. Every number is the rounding of what real arithmetic makes of the
/// scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Inspection {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The camera.
    pub camera: CameraFacts,
    /// The sampling technique.
    pub method: Method,
    /// Samples in each pixel, if that is what the scene gives.
    pub per_pixel: Option<u64>,
    /// Samples in the whole picture.
    pub total: u64,
    /// The seed.
    pub seed: u64,
    /// For each of the world's axes where its parallels meet, in pixels from the picture's top
    /// left corner; `None` if the axis is parallel to the view plane.
    pub vanishing_points: [Option<[f64; 2]>; 3],
    /// The objects in file order.
    pub objects: Vec<ObjectFacts>,
    /// Whether the areas that are seen of them are exact.
    pub is_exact: bool,
}

/// A camera in numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraFacts {
    /// The eye.
    pub eye: DVec3,
    /// The picture's right.
    pub u: DVec3,
    /// The picture's top.
    pub v: DVec3,
    /// Against the view direction.
    pub w: DVec3,
    /// Distance from the eye to the view plane, in metres.
    pub d: f64,
    /// Height of the window, in metres.
    pub view_height: f64,
    /// The angle that the window's height takes up, in degrees.
    pub fov_deg: f64,
    /// The angle that the window's width takes up, in degrees.
    pub hfov_deg: f64,
    /// The near plane's depth.
    pub near: f64,
    /// The far plane's depth.
    pub far: Option<f64>,
    /// Up, down or level, as the exact y of the view direction says.
    pub looks: &'static str,
}

/// An object in numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjectFacts {
    /// Its name.
    pub name: Option<String>,
    /// The values of its block's indices.
    pub indices: Box<[u32]>,
    /// The line it begins in, counted from 1.
    pub line: usize,
    /// What it is.
    pub shape: Shape,
    /// What is seen of it.
    pub seen: Seen,
}

impl ObjectFacts {
    /// Its name, or else its indices, by which the members of a block are told apart.
    fn shown_name(&self) -> Cow<'_, str> {
        match (&self.name, &*self.indices) {
            (Some(name), _) => Cow::Borrowed(name),
            (None, []) => Cow::Borrowed("-"),
            (None, indices) => Cow::Owned(format!("{indices:?}")),
        }
    }
}

/// Says what a scene means; `source` is the file that it was read from.
pub fn inspect(scene: &Scene, source: &Source) -> Inspection {
    let per_pixel = match scene.sampler.count {
        Count::PerPixel(count) => Some(count),
        Count::Total(_) => None,
    };
    let basis = Basis::new(&scene.camera, &scene.image);
    let (seen, is_exact) = seen::seen(scene);
    let objects = scene.objects.iter().zip(seen);
    let objects = objects.map(|(object, seen)| ObjectFacts {
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

/// The samples in the whole picture.
pub fn total_samples(count: Count, image: &Image) -> u64 {
    match count {
        Count::PerPixel(count) => {
            count.saturating_mul(u64::from(image.width) * u64::from(image.height))
        }
        Count::Total(total) => total,
    }
}

/// A camera by itself, and where the parallels of each axis meet: what [`inspect`] says of a whole
/// scene.
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

/// Where the lines parallel to an axis meet. The ray along the axis a has the direction (a·u, a·v,
/// −a·w) in the camera's axes, and meets the view plane where that is scaled to depth 1.
fn vanishing_point(image: &Image, basis: &Basis, axis: usize) -> Option<[f64; 2]> {
    // w is −f/|f|, so this is zero exactly where the axis is parallel to the view plane.
    if basis.w[axis].is_zero() {
        return None;
    }
    let depth = basis.w[axis].negated().times(&basis.pitch);
    let half = |pixels: u32| Big::from_f64(f64::from(pixels)).scaled(-1);
    let x = half(image.width).plus(&basis.u[axis].over(&depth));
    let y = half(image.height).minus(&basis.v[axis].over(&depth));
    Some([rounded(&x), rounded(&y)])
}

/// Rounded to a finite `f64`, without a negative zero.
fn rounded(x: &Big) -> f64 {
    x.to_finite() + 0.0
}

/// What is seen of the objects that are not listed, in sum.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Rest {
    objects: u64,
    seen: u64,
    /// The area that shows them, in pixels.
    pixels: f64,
    outside: u64,
}

const AXES: [&str; 3] = ["x", "y", "z"];

/// The same for people, who want no list of a million objects.
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
                summary(&object.shape)
            )?;
        }
        let more = self.objects.len().saturating_sub(LISTED) as u64;
        if more > 0 {
            writeln!(f, "  {} more, which --format json lists", grouped(more))?;
        }
        self.write_seen(f)
    }
}

/// What is seen of the objects.
impl Inspection {
    /// What is seen of all that are not listed: how many of them, and how many pixels.
    fn rest(&self) -> Option<Rest> {
        let rest = self.objects.get(LISTED..).filter(|rest| !rest.is_empty())?;
        let mut sum = Rest {
            objects: rest.len() as u64,
            ..Rest::default()
        };
        for object in rest {
            match object.seen {
                Seen::Part(_, pixels) => {
                    sum.seen += 1;
                    sum.pixels += pixels;
                }
                Seen::Outside(_) => sum.outside += 1,
                Seen::HiddenBy(_) | Seen::Nothing => {}
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
        let about = match self.is_exact {
            true => "",
            false => ", about: by the middles of pixels where there are too many outlines",
        };
        writeln!(f, "\nin the picture{about}")?;
        for (index, object) in self.objects.iter().enumerate().take(LISTED) {
            let name = object.shown_name();
            let words = match object.seen {
                Seen::Part(around, pixels) => {
                    let Area {
                        x,
                        y,
                        width,
                        height,
                    } = around;
                    format!("{width} x {height} pixels at ({x}, {y}), {}", share(pixels))
                }
                Seen::Outside(place) => place.words().replace('`', ""),
                Seen::HiddenBy(other) => {
                    let other = self.objects.get(other);
                    let name = other.map(|it| it.name.as_deref().unwrap_or(it.shape.kind()));
                    format!("hidden by {}", name.unwrap_or_default())
                }
                Seen::Nothing => "nothing of it".to_owned(),
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

/// A camera for people: its axes, its field of view, and where the parallels of each axis meet.
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

/// A shape in one line.
pub fn summary(shape: &Shape) -> String {
    match *shape {
        Shape::Sphere(Sphere {
            center,
            radius,
            color,
        }) => format!(
            "center {}, radius {}, {color}",
            short_vector(center),
            short(radius)
        ),
        Shape::Triangle(triangle) => {
            let [a, b, c] = vertices(&triangle).map(short_vector);
            match triangle.outline {
                Outline::Centered(_) => {
                    format!("base {a} to {b}, apex {c}, {}", triangle.color)
                }
                Outline::Vertices(_) => format!("vertices {a}, {b}, {c}, {}", triangle.color),
            }
        }
        Shape::Box(Cuboid {
            min,
            max,
            color,
            faces,
        }) => {
            let (min, max) = (short_vector(min), short_vector(max));
            match faces {
                None => format!("from {min} to {max}, {color}"),
                Some([x, y, z]) => format!("from {min} to {max}, {x}, {y} and {z}"),
            }
        }
        Shape::Checkerboard(Checkerboard { y, square, colors }) => {
            let [even, odd] = colors;
            let (y, square) = (short(y), short(square));
            format!("y {y}, squares of {square}, {even} and {odd}")
        }
    }
}
