//! What can be drawn over a picture: horizon, vanishing points with the lines that lead there, and
//! the objects' outlines and handles.

use glam::{DVec2, DVec3};

use super::{
    handles::{Handle, handles, outline_point},
    lines::Line,
    pick::pick,
};
use crate::{
    inspect,
    math::{Angle, trig},
    projection::Projection,
    scene::{Checkerboard, Cuboid, Object, Scene, Shape, Sphere},
    tracer::{World, vertices},
};

/// Distance between two points of a board's outline that are tested for what stands in front of
/// them, in pixels.
const LOOK: f64 = 2.0;

/// Maximum number of such points per segment.
const MOST_LOOKS: f64 = 1000.0;

/// Maximum number of such points in all: the outlines of further boards are drawn whole.
const MOST_LOOKS_IN_ALL: f64 = 8000.0;

/// So many objects have outlines: nobody can tell more apart.
pub const MOST_OBJECTS: usize = 1000;

/// A sphere's outline has so many sides.
const SIDES: u32 = 64;

/// What can be drawn over a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Overlays {
    /// The picture's width and height.
    pub size: [u32; 2],
    /// Where the view axis meets the picture.
    pub axis: DVec2,
    /// The image of all level directions.
    pub horizon: Option<[DVec2; 2]>,
    /// For the axes x, y and z.
    pub vanishing: [Vanishing; 3],
    /// Where the near plane cuts the checkerboards.
    pub near: Vec<[DVec2; 2]>,
    /// Where the far plane cuts the checkerboards.
    pub far: Vec<[DVec2; 2]>,
    /// Of each object that is shown.
    pub objects: Vec<Outline>,
}

/// Where the lines along an axis of the world meet.
#[derive(Clone, Debug, PartialEq)]
pub struct Vanishing {
    /// The point; none if the axis is parallel to the view plane.
    pub point: Option<DVec2>,
    /// Edges of boxes along the axis, each going on to the point.
    pub lines: Vec<Line>,
}

/// What is drawn of an object.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// Its index in the file.
    pub object: usize,
    /// Its outline.
    pub lines: Vec<Line>,
    /// Its handles by name, and where each is seen.
    pub handles: Vec<(&'static str, Option<DVec2>)>,
}

/// Which objects are shown: by their indices, or the first [`MOST_OBJECTS`] and one that may come
/// behind them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Shown {
    /// These alone.
    Only(Vec<usize>),
    /// The first ones, and this.
    First(Option<usize>),
}

impl Shown {
    /// Whether the object of this index is shown.
    pub fn has(&self, index: usize) -> bool {
        match self {
            Self::Only(indices) => indices.contains(&index),
            Self::First(further) => index < MOST_OBJECTS || Some(index) == *further,
        }
    }
}

/// What can be drawn over the picture of a scene.
pub fn overlays(scene: &Scene, which: &Shown) -> Overlays {
    let Scene { image, camera, .. } = scene;
    let projection = Projection::new(camera, image);
    let objects = || scene.objects.iter().enumerate();
    let shown = || objects().filter(|(index, _)| which.has(*index));
    let (_, points) = inspect::inspect_camera(camera, image);
    let vanishing = [0, 1, 2].map(|axis| {
        let point = points[axis].map(DVec2::from);
        let leading = |point| {
            let edges = shown().flat_map(move |(_, object)| edges_along(&object.shape, axis));
            edges.flat_map(move |edge| leading(&projection, edge, point))
        };
        Vanishing {
            point,
            lines: point.into_iter().flat_map(leading).collect(),
        }
    });
    let cut = |depth: f64| {
        let boards = objects().filter_map(|(_, object)| match object.shape {
            Shape::Checkerboard(Checkerboard { y, .. }) => Some(y),
            _ => None,
        });
        // A depth of 0, or none at all, cuts nothing that is seen.
        let lines = boards.filter_map(|y| projection.level((y - camera.eye.y) / depth));
        lines.take(MOST_OBJECTS).collect()
    };
    let outline = |(index, object): (usize, &Object)| {
        let seen = |(name, at): Handle| (name, at.and_then(|at| projection.point(at)));
        let handles = handles(&object.shape, &projection, projection.right).into_iter();
        Outline {
            object: index,
            lines: outline(&projection, &object.shape),
            handles: handles.map(seen).collect(),
        }
    };
    Overlays {
        size: [image.width, image.height],
        axis: projection.size / 2.0,
        horizon: projection.level(0.0),
        vanishing,
        near: cut(camera.near),
        far: camera.far.map_or_else(Vec::new, cut),
        objects: shown().map(outline).collect(),
    }
}

/// Takes away what of the boards' outlines other objects stand in front of: a square far larger
/// than they are would be drawn across all of them.
pub fn hide(overlays: &mut Overlays, scene: &Scene, world: &World) {
    let is_board = |shape: &Shape| matches!(shape, Shape::Checkerboard(_));
    let is_seen = |index: usize, at: DVec2| {
        let hit = pick(scene, world, at).and_then(|(hit, _)| hit);
        hit.is_none_or(|hit| hit.object == index)
    };
    let projection = Projection::new(&scene.camera, &scene.image);
    let mut left = MOST_LOOKS_IN_ALL;
    for outline in &mut overlays.objects {
        let index = outline.object;
        if !is_board(&scene.objects[index].shape) || left <= 0.0 {
            continue;
        }
        let mut lines: Vec<Line> = Vec::new();
        let segments = outline.lines.iter().flat_map(|line| line.windows(2));
        for (from, to) in segments.map(|ends| (ends[0], ends[1])) {
            // Outside of the picture nothing is seen, so nothing is in front.
            let [first, last] = projection.clip([from, to], 0.0).unwrap_or([to, to]);
            let parts = (first.distance(last) / LOOK).ceil().clamp(1.0, MOST_LOOKS);
            left -= parts;
            let places = (1..parts as u32).map(|part| first.lerp(last, f64::from(part) / parts));
            let mut ends = vec![from, first];
            ends.extend(places.chain([last, to]));
            ends.dedup();
            for (part, piece) in ends.windows(2).enumerate() {
                let [begin, end] = [piece[0], piece[1]];
                if !is_seen(index, begin.midpoint(end)) {
                    continue;
                }
                let joined = lines.last_mut().filter(|line| line.last() == Some(&begin));
                match joined {
                    Some(line) => {
                        // Of a straight line only the ends are kept.
                        if part > 0 {
                            line.pop();
                        }
                        line.push(end);
                    }
                    None => lines.push(vec![begin, end]),
                }
            }
        }
        outline.lines = lines;
    }
}

/// An edge of a box, which goes on to where the lines along it meet.
fn leading(projection: &Projection, [a, b]: [DVec3; 2], point: DVec2) -> Vec<Line> {
    let edge = match projection.depth(a) < projection.depth(b) {
        true => [a, b],
        false => [b, a],
    };
    match projection.line(&edge)[..] {
        [ref line] => projection.joined([[line[0], line[1]], [line[1], point]]),
        _ => Vec::new(),
    }
}

/// The four edges along an axis, of a box.
fn edges_along(shape: &Shape, axis: usize) -> Vec<[DVec3; 2]> {
    let Shape::Box(Cuboid { min, max, .. }) = *shape else {
        return Vec::new();
    };
    let (second, third) = ((axis + 1) % 3, (axis + 2) % 3);
    let edges = [(0, 0), (0, 1), (1, 1), (1, 0)].map(|(j, k)| {
        let mut from = min;
        from[second] = [min, max][j][second];
        from[third] = [min, max][k][third];
        let mut to = from;
        to[axis] = max[axis];
        [from, to]
    });
    edges.into()
}

fn outline(projection: &Projection, shape: &Shape) -> Vec<Line> {
    match shape {
        Shape::Sphere(sphere) => {
            let points: Option<Vec<DVec3>> = circle(projection, sphere).collect();
            points.map_or_else(Vec::new, |points| projection.line(&points))
        }
        Shape::Triangle(triangle) => {
            let [a, b, c] = vertices(triangle);
            projection.line(&[a, b, c, a])
        }
        Shape::Box(_) => {
            let edges = (0..3).flat_map(|axis| edges_along(shape, axis));
            edges.flat_map(|edge| projection.line(&edge)).collect()
        }
        Shape::Checkerboard(board) => square(projection, board),
    }
}

/// The points where rays touch a sphere, all around; none from inside it.
fn circle(projection: &Projection, sphere: &Sphere) -> impl Iterator<Item = Option<DVec3>> {
    let axis = (sphere.center - projection.eye).normalize_or(projection.ahead);
    let (first, second) = axis.any_orthonormal_pair();
    (0..=SIDES).map(move |side| {
        let angle = Angle::from_degrees(360.0 * f64::from(side) / f64::from(SIDES));
        let towards = first * trig::cos(angle) + second * trig::sin(angle);
        outline_point(sphere, projection.eye, towards)
    })
}

/// The square of a checkerboard that the view axis meets.
fn square(projection: &Projection, board: &Checkerboard) -> Vec<Line> {
    let met = projection.on_plane(projection.size / 2.0, DVec3::Y * board.y, DVec3::Y);
    met.map_or_else(Vec::new, |met| {
        let side = board.square;
        let corner = ((met / side).floor() * side).with_y(board.y);
        let [x, z] = [DVec3::X * side, DVec3::Z * side];
        projection.line(&[corner, corner + x, corner + x + z, corner + z, corner])
    })
}
