//! Shows a scene from outside, i.e. from an observer beside its camera.
//!
//! The view maps given points in space to a rectangle of the drawing, which they fill as far as
//! possible. The observer is a [`Camera`] of the scene language, so that [`Projection`] and the
//! editor's outlines can be used.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::canvas::Canvas;
use crate::{
    color::Color,
    editor::viewport::{Overlays, ShownObjects, clip, overlays},
    math::Angle,
    projection::Projection,
    scene::{Camera, Image, Lens, Scene, Shape, View},
    seen::{Visibility, seen},
};

/// Distance of the observer from the middle of the shown points, as a multiple of the radius of a
/// sphere around them. With a larger distance, the view shows less depth. With a smaller one, it is
/// more distorted by perspective. Chosen by eye.
const DISTANCE: f64 = 6.0;

/// Maximum absolute value of the coordinates that determine the view, in metres. Larger coordinates
/// are clamped, so that sums and squares of coordinates do not overflow. An `f64` reaches 1.8e308.
const MOST: f64 = 1e100;

/// A view of a scene from outside, in a rectangle of the drawing.
pub struct Outside {
    camera: Camera,
    image: Image,
    projection: Projection,
    panel: [DVec2; 2],
    scale: f64,
    offset: DVec2,
}

impl Outside {
    /// Makes the view that fits `points` into the rectangle `panel`. `side` is the direction
    /// towards the observer, and `up` points upwards in the drawing.
    pub fn new(points: &[DVec3], [side, up]: [DVec3; 2], panel: [DVec2; 2]) -> Self {
        let (min, max) = bounds3(points);
        // Coordinates are clamped, because sums of very large ones could overflow.
        let within = |v: DVec3| v.clamp(DVec3::splat(-MOST), DVec3::splat(MOST));
        let (min, max) = (within(min), within(max));
        let radius = ((max - min).length() / 2.0).max(1.0 / MOST);
        let side = side.normalize_or(DVec3::Z);
        let camera = Camera {
            eye: min.midpoint(max) + side * (DISTANCE * radius),
            view: View::Direction(-side),
            up,
            roll: Angle::default(),
            lens: Lens::Fov(Angle::from_degrees(30.0)),
            view_height: 2.0,
            near: 0.0,
            far: None,
        };
        let image = Image {
            width: 1000,
            height: 1000,
            background: Color::BLACK,
        };
        let projection = Projection::new(&camera, &image);
        let seen: Vec<DVec2> = points
            .iter()
            .map(|point| projection.projected(*point))
            .collect();
        let (scale, offset) = fit(&seen, panel);
        Self {
            camera,
            image,
            projection,
            panel,
            scale,
            offset,
        }
    }

    /// Returns the position in the drawing of a point in space.
    pub fn at(&self, point: DVec3) -> DVec2 {
        self.projection.projected(point) * self.scale + self.offset
    }

    /// Draws the line through `points` in space. The line is cut off at the edge of the rectangle
    /// `panel`.
    pub fn line(&self, canvas: &mut Canvas, class: &str, points: &[DVec3]) {
        for line in self.projection.line(points) {
            let line: Vec<DVec2> = line
                .iter()
                .map(|at| *at * self.scale + self.offset)
                .collect();
            draw_within(canvas, class, &line, self.panel);
        }
    }

    /// Draws the outlines of the objects with the given indices, filled with the objects' colours.
    pub fn objects(&self, canvas: &mut Canvas, scene: &Scene, indices: Vec<usize>) {
        let overlays = self.overlays(scene, indices);
        let place = |at: DVec2| at * self.scale + self.offset;
        draw_objects(canvas, scene, &overlays, place, self.panel);
    }

    /// Draws the outlines of the objects with the given indices in the style `class`.
    pub fn outlines(&self, canvas: &mut Canvas, class: &str, scene: &Scene, indices: Vec<usize>) {
        let place = |at: &DVec2| *at * self.scale + self.offset;
        for outline in self.overlays(scene, indices).objects {
            for line in outline.lines {
                let line = thinned(line.iter().map(place).collect());
                draw_within(canvas, class, &line, self.panel);
            }
        }
    }

    fn overlays(&self, scene: &Scene, indices: Vec<usize>) -> Overlays {
        let scene = Scene {
            camera: self.camera,
            image: self.image,
            sampler: scene.sampler,
            objects: Arc::clone(&scene.objects),
        };
        overlays(&scene, &ShownObjects::Only(indices))
    }
}

/// Returns the [`Overlays`] of the picture that the scene's camera sees, with the outlines of the
/// objects that are at least partly visible.
pub fn visible_overlays(scene: &Scene) -> Overlays {
    let (seen, _) = seen(scene);
    let is_seen = |(index, seen)| matches!(seen, Visibility::Part(..)).then_some(index);
    let indices = seen.into_iter().enumerate().filter_map(is_seen).collect();
    overlays(scene, &ShownObjects::Only(indices))
}

/// Draws the outlines in `overlays`, filled with the colours of their objects. The function `place`
/// maps a point of the picture to the drawing. Checkerboards are left out, since the outline of a
/// checkerboard shows only one of its squares.
pub fn draw_objects(
    canvas: &mut Canvas,
    scene: &Scene,
    overlays: &Overlays,
    place: impl Fn(DVec2) -> DVec2,
    panel: [DVec2; 2],
) {
    for outline in &overlays.objects {
        let shape = &scene.objects[outline.object].shape;
        if matches!(shape, Shape::Checkerboard(_)) {
            continue;
        }
        let lines = outline.lines.iter();
        let lines = lines.map(|line| thinned(line.iter().map(|at| place(*at)).collect()));
        let lines: Vec<Vec<DVec2>> = lines.collect();
        let [color, ..] = shape.colors();
        let points = lines.iter().flatten();
        let hull = hull(points.map(|at| at.clamp(panel[0], panel[1])).collect());
        canvas.fill("fill", color, &hull);
        for line in &lines {
            draw_within(canvas, "faint", line, panel);
        }
    }
}

/// Removes each point of a line that is less than one SVG unit away from the kept point before it.
/// The last point is always kept. This keeps the file small if there are many small spheres, and
/// the removed points would not be visible.
fn thinned(mut line: Vec<DVec2>) -> Vec<DVec2> {
    let end = line.last().copied();
    line.dedup_by(|next, kept| next.distance_squared(*kept) < 1.0);
    line.extend(end.filter(|end| line.last() != Some(end)));
    line
}

/// Draws those parts of a line that lie in the rectangle `panel`.
pub fn draw_within(canvas: &mut Canvas, class: &str, line: &[DVec2], panel: [DVec2; 2]) {
    let mut part: Vec<DVec2> = Vec::new();
    for ends in line.windows(2) {
        let Some([from, to]) = clip([ends[0], ends[1]], panel) else {
            continue;
        };
        if part.last() != Some(&from) {
            canvas.line(class, &part);
            part = vec![from];
        }
        part.push(to);
    }
    canvas.line(class, &part);
}

/// Returns the scale and the offset that map `points` to the rectangle `panel`. The mapped points
/// fill the rectangle as far as possible, and are centred in it.
pub fn fit(points: &[DVec2], panel: [DVec2; 2]) -> (f64, DVec2) {
    let least = points.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let greatest = points.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
    let scale = ((panel[1] - panel[0]) / (greatest - least)).min_element();
    (
        scale,
        panel[0].midpoint(panel[1]) - least.midpoint(greatest) * scale,
    )
}

/// Returns the least and the greatest coordinates of `points` on each axis.
pub fn bounds3(points: &[DVec3]) -> (DVec3, DVec3) {
    let least = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let greatest = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    (least, greatest)
}

/// Returns the convex hull of points, by Andrew's monotone chain algorithm.
fn hull(mut points: Vec<DVec2>) -> Vec<DVec2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let chain = |points: &mut dyn Iterator<Item = &DVec2>| {
        let mut chain: Vec<DVec2> = Vec::new();
        for &point in points {
            while let [.., a, b] = chain[..]
                && (b - a).perp_dot(point - b) <= 0.0
            {
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let mut hull = chain(&mut points.iter());
    hull.extend(chain(&mut points.iter().rev()));
    hull
}
