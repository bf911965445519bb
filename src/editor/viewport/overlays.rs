//! Computes the drawings over a picture: the horizon, vanishing points with the lines that lead to
//! them, and the outlines and handles of objects.

use glam::{DVec2, DVec3};

use super::{
    handles::{Handle, edges_along, handles, outline},
    lines::Polyline,
    pick::pick,
};
use crate::{
    inspect,
    projection::Projection,
    scene::{Checkerboard, Object, Scene},
    tracer::World,
};

/// Distance, in pixels, between the points of a checkerboard's outline at which a ray tests whether
/// an object hides the outline. A smaller distance would cost more rays; with a larger one, the
/// outline would visibly end too early or too late at an object.
const TEST_DISTANCE: f64 = 2.0;

/// Maximum number of points per segment of a checkerboard's outline at which a ray tests whether an
/// object hides the outline. The limit bounds the time for one segment. Segments of up to 2000
/// pixels are tested at points that are [`TEST_DISTANCE`] apart. On longer segments, the points are
/// farther apart.
const MOST_TESTS: f64 = 1000.0;

/// Number of tested points on the outlines of checkerboards after which the remaining outlines of a
/// picture are drawn as if nothing hid them. This bounds the time of an answer. Each side of an
/// outline has at most [`MOST_TESTS`] points, so the four sides of two boards are always tested.
const MOST_TESTS_IN_ALL: f64 = 8000.0;

/// Maximum number of objects whose outlines are drawn over a picture. Nobody can tell more outlines
/// apart, and more would make the answer to the editor longer.
pub const MOST_OBJECTS: usize = 1000;

/// Drawings over a picture. All points are in pixels from its top left corner.
#[derive(Clone, Debug, PartialEq)]
pub struct Overlays {
    /// Width and height of the picture, in pixels.
    pub size: [u32; 2],
    /// Point where the view axis intersects the picture.
    pub axis: DVec2,
    /// The horizon, i.e. the image of all level directions; `None` if it is not visible.
    pub horizon: Option<[DVec2; 2]>,
    /// Vanishing points of the x, y and z axes, in this order.
    pub vanishing: [Vanishing; 3],
    /// Lines of the picture in which the near plane intersects the checkerboards.
    pub near: Vec<[DVec2; 2]>,
    /// Lines of the picture in which the far plane intersects the checkerboards.
    pub far: Vec<[DVec2; 2]>,
    /// Outlines and handles of the shown objects.
    pub objects: Vec<ObjectOverlay>,
}

/// Vanishing point of a coordinate axis, with the lines that lead to it.
#[derive(Clone, Debug, PartialEq)]
pub struct Vanishing {
    /// The vanishing point; `None` if the axis is parallel to the view plane, because parallel
    /// lines then stay parallel in the picture.
    pub point: Option<DVec2>,
    /// Lines along those edges of boxes that are parallel to the axis. Each line runs along one
    /// edge and continues to the vanishing point.
    pub lines: Vec<Polyline>,
}

/// Outline and handles of an object.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjectOverlay {
    /// Index of the object in the scene.
    pub object: usize,
    /// Lines of the outline in the picture.
    pub lines: Vec<Polyline>,
    /// Names of the handles, with their points in the picture. A handle that is not visible has no
    /// point.
    pub handles: Vec<(&'static str, Option<DVec2>)>,
}

/// Choice of the objects whose outlines are drawn.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ShownObjects {
    /// The objects with the listed indices.
    Only(Vec<usize>),
    /// The first [`MOST_OBJECTS`] objects and, if an index is given, also the object with this
    /// index.
    First(Option<usize>),
}

impl ShownObjects {
    /// Returns whether the outline of the object with the index `index` is drawn.
    pub fn has(&self, index: usize) -> bool {
        match self {
            Self::Only(indices) => indices.contains(&index),
            Self::First(further) => index < MOST_OBJECTS || Some(index) == *further,
        }
    }
}

/// Returns the drawings over the picture of a scene.
pub fn overlays(scene: &Scene, which: &ShownObjects) -> Overlays {
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
        let boards = objects().filter_map(|(_, object)| object.shape.checkerboard());
        // A near or far plane cuts each checkerboard along a line. At depth 0, such a plane
        // contains the eye, so the line is not visible. The division then yields infinity or NaN,
        // for which `level` returns no line.
        let lines = boards
            .filter_map(|&Checkerboard { y, .. }| projection.level((y - camera.eye.y) / depth));
        lines.take(MOST_OBJECTS).collect()
    };
    let outline = |(index, object): (usize, &Object)| {
        let seen = |(name, at): Handle| (name, at.and_then(|at| projection.point(at)));
        let handles = handles(&object.shape, &projection, projection.right).into_iter();
        ObjectOverlay {
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

/// Removes the parts of the checkerboards' outlines that other objects hide. Without this, a square
/// that is far larger than the objects would be drawn across all of them.
pub fn hide(overlays: &mut Overlays, scene: &Scene, world: &World) {
    let is_seen = |index: usize, at: DVec2| {
        let hit = pick(scene, world, at).and_then(|(hit, _)| hit);
        hit.is_none_or(|hit| hit.object == index)
    };
    let projection = Projection::new(&scene.camera, &scene.image);
    let mut left = MOST_TESTS_IN_ALL;
    for outline in &mut overlays.objects {
        let index = outline.object;
        if scene.objects[index].shape.checkerboard().is_none() || left <= 0.0 {
            continue;
        }
        let mut lines: Vec<Polyline> = Vec::new();
        let segments = outline.lines.iter().flat_map(|line| line.windows(2));
        for (from, to) in segments.map(|ends| (ends[0], ends[1])) {
            // No object hides a line outside of the picture, so only the part inside is tested.
            let [first, last] = projection.clip([from, to], 0.0).unwrap_or([to, to]);
            let parts = (first.distance(last) / TEST_DISTANCE)
                .ceil()
                .clamp(1.0, MOST_TESTS);
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
                        // If the parts before and after this point belong to one straight segment,
                        // the point is left out.
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

/// Returns an edge of a box, extended to its vanishing point `point`.
fn leading(projection: &Projection, [a, b]: [DVec3; 2], point: DVec2) -> Vec<Polyline> {
    let edge = if projection.depth(a) < projection.depth(b) {
        [a, b]
    } else {
        [b, a]
    };
    match projection.line(&edge)[..] {
        [ref line] => projection.joined([[line[0], line[1]], [line[1], point]]),
        _ => Vec::new(),
    }
}
