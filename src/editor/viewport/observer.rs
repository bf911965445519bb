//! Chooses a second camera that shows a scene, together with the scene's own camera, from outside.
//!
//! In: a scene, and the direction from which it is to be seen. Out: an [`Observer`], a second
//! camera that sees the eye, the window and the objects near them. `outside` draws the scene's
//! camera as this observer sees it.

use glam::{DVec2, DVec3};

use super::{camera, outside::camera_handles};
use crate::{
    color::Color,
    math::{Angle, trig, unit},
    projection::Projection,
    scene::{Camera, FieldOwner, Image, Lens, Scene, Shape, View},
    schema::CAMERA,
};

/// Default vertical field of view of the observer, in degrees. The client may give another. With a
/// smaller angle, parallel lines look more parallel, and the view shows less depth. Chosen by eye.
pub const USUAL_FOV: f64 = 30.0;

/// Maximum fraction of the width and height of the observer's picture that the points to be shown
/// fill. The rest is a margin for labels, and for dragging a handle outwards. Chosen by eye.
const FILLED: f64 = 0.75;

/// Maximum distance from the eye to another point that the observer must see, as a multiple of the
/// distance from the eye to a corner of the window. Points farther away are left out; with them,
/// the window would be too small to be recognised.
const FARTHEST: f64 = 60.0;

/// Maximum absolute value of the coordinates that determine the view, in metres. Larger coordinates
/// are limited to it. Sums and squares of coordinates then do not overflow, since an `f64` reaches
/// 1.8e308.
const MOST: f64 = 1e100;

/// Minimum distance from the observer to the point that it looks at, as a fraction of the greatest
/// coordinate of that point. The fraction must be well above the rounding errors of coordinates,
/// about 1e-16, so that the observer does not look at its own eye.
const NEAREST: f64 = 1e-9;

/// Number of times that the observer is moved so that the shown points are in the middle of its
/// picture. Each move changes the distance, so the points are no longer exactly in the middle, but
/// the error shrinks each time. With fewer moves, the points would be visibly off the middle.
const ROUNDS: usize = 4;

/// A camera beside the scene's own, which shows the scene from outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observer {
    /// Position of the observer's eye.
    pub eye: DVec3,
    /// Point in the middle of the observer's picture.
    pub lookat: DVec3,
    /// The observer's up vector.
    pub up: DVec3,
    /// Vertical field of view of the observer, in degrees.
    pub fov: f64,
    /// Width and height of the observer's picture, in pixels.
    pub size: [u32; 2],
}

impl Observer {
    /// Returns the observer as a camera of the scene language.
    pub fn camera(&self) -> Camera {
        Camera {
            eye: self.eye,
            view: View::Lookat(self.lookat),
            up: self.up,
            roll: Angle::default(),
            lens: Lens::Fov(Angle::from_degrees(self.fov)),
            view_height: 2.0,
            near: 0.0,
            far: None,
        }
    }

    /// Returns the scene with the observer in place of its own camera, and with a picture of the
    /// observer's size.
    pub fn scene(&self, scene: &Scene) -> Scene {
        let [width, height] = self.size;
        Scene {
            camera: self.camera(),
            image: Image {
                width,
                height,
                ..scene.image
            },
            ..scene.clone()
        }
    }

    /// Derives the observer's projection.
    pub fn projection(&self) -> Projection {
        let [width, height] = self.size;
        let image = Image {
            width,
            height,
            background: Color::BLACK,
        };
        Projection::new(&self.camera(), &image)
    }

    /// Returns whether the observer's camera and its picture meet the language's conditions.
    pub fn is_possible(&self) -> bool {
        let most = 1 << 20;
        let is_size = |side: &u32| (1..=most).contains(side);
        FieldOwner::Camera(self.camera()).is_possible()
            && self.up.is_finite()
            && self.up != DVec3::ZERO
            && self.size.iter().all(is_size)
    }

    /// Returns the observer that sees the eye, the window and the objects near them as large as
    /// possible. `from` is the direction from these points to the observer. If it is `None`, the
    /// observer is to the right of the scene's camera, behind it and above it, so that the view
    /// axis runs to the right in the picture.
    pub fn around(scene: &Scene, from: Option<DVec3>, up: DVec3, fov: f64, size: [u32; 2]) -> Self {
        let own = Projection::new(&scene.camera, &scene.image);
        let points = shown_points(scene, &own);
        let side = from.unwrap_or_else(|| towards_observer(&own));
        let side = unit(side).0;
        let side = if side.is_finite() { side } else { DVec3::Z };
        let bounds = |points: &mut dyn Iterator<Item = DVec3>| {
            let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
            points.fold(none, |(least, most), it| (least.min(it), most.max(it)))
        };
        let (least, most) = bounds(&mut points.iter().copied());
        let aim = least.midpoint(most);
        let mut observer = Self {
            eye: aim + side * (1.0_f64).max(aim.abs().max_element()),
            lookat: aim,
            up,
            fov,
            size,
        };
        let projection = observer.projection();
        let half = trig::tan(Angle::from_degrees(fov / 2.0)) * FILLED;
        let slope = DVec2::new(half * f64::from(size[0]) / f64::from(size[1]), half);
        // Returns two coordinates of a point along the picture's right and top, and a third one
        // towards the observer.
        let turned = |it: DVec3| {
            let DVec3 { x, y, z } =
                DVec3::from([projection.right, projection.top, side].map(|axis| it.dot(axis)));
            (DVec2::new(x, y), z)
        };
        for round in 0..=ROUNDS {
            let relative = || points.iter().map(|point| turned(*point - observer.lookat));
            let needed =
                relative().map(|(across, near)| (across.abs() / slope).max_element() + near);
            let greatest = observer.lookat.abs().max_element();
            let least = (NEAREST * greatest).max(1.0 / MOST);
            let distance = needed.fold(least, f64::max);
            if round < ROUNDS {
                let seen =
                    relative().map(|(across, near)| (across / (distance - near)).extend(0.0));
                let (least, most) = bounds(&mut { seen });
                let middle = least.midpoint(most) * distance;
                if middle.is_finite() {
                    observer.lookat += projection.right * middle.x + projection.top * middle.y;
                }
            }
            observer.eye = observer.lookat + side * distance;
        }
        observer
    }
}

/// Returns the direction towards an observer to the right of a camera, behind it and above it.
pub fn towards_observer(camera: &Projection) -> DVec3 {
    let level = (camera.ahead + camera.top * 0.2).with_y(0.0);
    let level = level.normalize_or(DVec3::NEG_Z);
    level.cross(DVec3::Y) * 0.72 - level * 0.55 + DVec3::Y * 0.42
}

/// Returns the points that an observer must see: the eye with its up vector, the corners of the
/// window, the point that the camera looks at, the handle of the far plane, and the ends of the
/// objects along each axis.
///
/// An object is left out if it is too large or too far away. Let l be the greatest of three
/// distances from the eye: to a corner of the window, to the far side of the nearest object, and to
/// the point that the camera looks at. An object's radius must be less than 1.6·l, and its far side
/// nearer to the eye than 2.4·l. The handle of the far plane must be nearer than 2.4·l, too.
fn shown_points(scene: &Scene, own: &Projection) -> Vec<DVec3> {
    let (eye, d) = (own.eye, scene.camera.view_height / (own.pitch * own.size.y));
    let corners = [
        DVec2::ZERO,
        own.size.with_y(0.0),
        own.size,
        own.size.with_x(0.0),
    ];
    let corners = corners.map(|corner| own.at_depth(corner, d));
    let window = corners[0].distance(eye);
    let is_within = |distance: &f64| *distance < FARTHEST * window;
    let distance = Some(camera::distance(scene)).filter(is_within);
    let bodies = || {
        let shapes = scene.objects.iter().map(|object| &object.shape);
        let spheres = shapes.filter_map(Shape::bounding_sphere);
        spheres.map(|(middle, radius)| (middle, radius, middle.distance(eye) + radius))
    };
    let nearest = bodies().map(|(.., end)| end).filter(is_within);
    let nearest = nearest.reduce(f64::min);
    let seen = [distance, nearest].into_iter().flatten();
    let reach = 1.6 * seen.fold(window, f64::max);
    let mut points = vec![eye];
    points.extend(corners);
    points.extend(distance.map(|distance| eye + own.ahead * distance));
    let handles = camera_handles(&scene.camera, &scene.image).into_iter();
    let is_shown = |(name, at): &(&str, DVec3)| match *name {
        name if name == CAMERA.far.name => at.distance(eye) < 1.5 * reach,
        name => name == CAMERA.up.name,
    };
    points.extend(handles.filter(is_shown).map(|(_, at)| at));
    for (middle, radius, end) in bodies() {
        if radius < reach && end < 1.5 * reach {
            points.extend(DVec3::AXES.map(|axis| middle + axis * radius));
            points.extend(DVec3::AXES.map(|axis| middle - axis * radius));
        }
    }
    let most = DVec3::splat(MOST);
    let is_number = |point: &DVec3| !point.is_nan();
    let limited = points
        .into_iter()
        .filter(is_number)
        .map(|point| point.clamp(-most, most));
    limited.collect()
}
