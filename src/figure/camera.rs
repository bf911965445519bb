//! Draws the figure `camera`. It shows three things from outside: the camera's eye, one ray, and
//! the window, i.e. the rectangle in space that the picture shows.

use glam::{DVec2, DVec3};

use super::{
    canvas::{Canvas, WIDTH, number},
    outside::{Outside, bounds3, draw_objects, visible_overlays},
};
use crate::{
    area::Area,
    editor::viewport::towards_observer,
    inspect::inspect_camera,
    probe::{Probe, probe},
    projection::Projection,
    scene::{Scene, Shape},
    seen::{Visibility, seen},
    tracer::Hit,
};

/// Height of the figure, in SVG units, before empty space is cropped. The figure's width is 680.
/// The scene is scaled to fit, so it would be smaller in a lower figure.
const HEIGHT: f64 = 460.0;

/// Maximum length of a ray that is drawn completely, as a multiple of the distance from the eye to
/// a corner of the window. Of a longer ray, only the start is drawn. With a larger value, the
/// window could become too small to be recognised.
const FARTHEST: f64 = 15.0;

/// Maximum number of objects that are drawn, not counting checkerboards. The object that the ray
/// meets is drawn first, and then the first objects of the scene. With many more, the figure would
/// be confusing.
const MOST_OBJECTS: usize = 60;

/// Width and height, in SVG units, below which a window is too small to be recognised. In the
/// figure of such a window, the label says that the window is too small.
const TINY: f64 = 16.0;

/// Approximate maximum number of lines between a checkerboard's squares, in each direction. If
/// there are more, only every second line is drawn, or every third, and so on. More lines would
/// hide the rest of the figure.
const MOST_LINES: f64 = 14.0;

/// Draws the figure. The ray goes through the middle of `pixel`. If `pixel` is `None`, it goes
/// through a pixel near the middle of the largest object.
pub fn draw(scene: &Scene, pixel: Option<[u32; 2]>) -> String {
    let [x, y] = pixel.unwrap_or_else(|| pixel_of_largest(scene));
    let middle = DVec2::new(f64::from(x), f64::from(y)) + 0.5;
    let Probe { hits, .. } = probe(scene, middle);
    let hit = hits.into_iter().find(|(hit, _)| hit.visible);
    let view = Projection::new(&scene.camera, &scene.image);
    let (facts, _) = inspect_camera(&scene.camera, &scene.image);
    let size = view.size;
    let corners = [DVec2::ZERO, size.with_y(0.0), size, size.with_x(0.0)];
    let corners = corners.map(|corner| view.at_depth(corner, facts.d));
    let window = view.eye + view.ahead * facts.d;
    let in_window = view.at_depth(middle, facts.d);
    let to_corner = corners[0].distance(view.eye);
    let is_near = |hit: &Hit| hit.t <= FARTHEST * to_corner;
    let end = match &hit {
        Some((hit, _)) if is_near(hit) => hit.point,
        Some(_) => view.eye + (in_window - view.eye) * 3.0,
        None => view.eye + (in_window - view.eye) * 2.0,
    };
    let reach = 1.6 * end.distance(view.eye).max(to_corner);

    let mut points = vec![view.eye, window, end];
    points.extend(corners);
    let met = hit.as_ref().map(|(hit, _)| hit.object);
    let within = objects_within(scene, reach, met);
    let is_behind = |(_, middle, radius): &Body| view.depth(*middle) + radius <= 0.0;
    let (behind, ahead): (Vec<_>, Vec<_>) = within.iter().copied().partition(is_behind);
    for (_, middle, radius) in &within {
        let corner =
            |i: u32| DVec3::from([1, 2, 4].map(|bit| if i & bit > 0 { *radius } else { -radius }));
        points.extend((0..8).map(|i| *middle + corner(i)));
    }
    let boards = boards(scene, &mut points, reach);
    let (min, max) = bounds3(&points);
    let arrow = 0.13 * (max - min).length();
    points.extend([-view.ahead, view.right, view.top].map(|axis| view.eye + axis * arrow));

    // The observer is on the side of the camera from which the ray runs to the right.
    let side = towards_observer(&view);
    let panel = [
        DVec2::new(50.0, 34.0),
        DVec2::new(WIDTH - 50.0, HEIGHT - 34.0),
    ];
    let outside = Outside::new(&points, [side, DVec3::Y], panel);

    let mut canvas = Canvas::new(HEIGHT);
    for line in boards {
        outside.line(&mut canvas, "faint", &line);
    }
    let indices = |bodies: &[Body]| bodies.iter().map(|(index, ..)| *index).collect();
    outside.outlines(&mut canvas, "faint dash", scene, indices(&behind));
    outside.objects(&mut canvas, scene, indices(&ahead));
    // An object that is too large for the figure is drawn only if the ray meets it.
    let large = met.filter(|met| within.iter().all(|(index, ..)| index != met));
    let large = large.filter(|_| hit.as_ref().is_some_and(|(hit, _)| is_near(hit)));
    let is_board = |index: &usize| scene.objects[*index].shape.checkerboard().is_some();
    let large: Vec<_> = large.into_iter().filter(|index| !is_board(index)).collect();
    let drawn = within.len() + large.len();
    outside.outlines(&mut canvas, "faint", scene, large);
    for corner in corners {
        outside.line(&mut canvas, "faint", &[view.eye, corner]);
    }
    // The window contains the outlines of the objects as the camera sees them.
    let picture = visible_overlays(scene);
    let in_frame = |at: DVec2| view.at_depth(at.clamp(DVec2::ZERO, view.size), facts.d);
    draw_objects(
        &mut canvas,
        scene,
        &picture,
        |at| outside.at(in_frame(at)),
        panel,
    );
    let [a, b, c, d] = corners;
    outside.line(&mut canvas, "blue", &[a, b, c, d, a]);
    outside.line(&mut canvas, "green dash", &[view.eye, window]);
    canvas.arrow(
        "ink dash",
        outside.at(window),
        outside.at(window + view.ahead * arrow),
    );
    let eye = outside.at(view.eye);
    for (axis, name) in [(view.right, "*u*"), (view.top, "*v*"), (-view.ahead, "*w*")] {
        let tip = outside.at(view.eye + axis * arrow);
        canvas.arrow("ink", eye, tip);
        canvas.label("ink", [tip, eye], name);
    }
    match hit {
        Some((hit, _)) if is_near(&hit) => outside.line(&mut canvas, "red", &[view.eye, end]),
        _ => canvas.arrow("red", eye, outside.at(end)),
    }
    canvas.dot("ink", eye, 5.0);
    canvas.dot("green", outside.at(window), 3.0);
    canvas.dot("red", outside.at(in_window), 5.0);

    let distance = number(facts.d);
    let axis = outside.at(window);
    let tip = outside.at(window + view.ahead * arrow);
    let [d_at, pixel_at] = [view.eye.midpoint(window), in_window].map(|it| outside.at(it));
    if let Some((_, middle, _)) = behind.first() {
        let at = outside.at(*middle);
        canvas.label("faint", [at, eye], "behind the eye");
    }
    let count = (0..scene.objects.len())
        .filter(|index| !is_board(index))
        .count();
    if drawn < count {
        canvas.note(format!("{drawn} of {count} objects are drawn."));
    }
    canvas.label("green", [d_at; 2], format!("*d* = {distance}"));
    canvas.label("ink", [eye, axis], "eye");
    canvas.label("red", [pixel_at; 2], format!("pixel ({x}, {y})"));
    let frame = corners.map(|corner| outside.at(corner));
    let is_tiny = |corner: &DVec2| (*corner - frame[0]).abs().max_element() < TINY;
    let name = if frame.iter().all(is_tiny) {
        "window, too small to be seen here"
    } else {
        "window"
    };
    canvas.label_any("blue", &frame, axis, name);
    canvas.label("ink", [tip; 2], "view direction −*w*");
    let told = match &hit {
        Some((hit, object)) => {
            let name = object.name.as_deref().unwrap_or(object.shape.kind());
            let far = if is_near(hit) { "" } else { ", farther on" };
            let t = number(hit.t);
            format!("{name}, *t* = {t}{far}")
        }
        None => "the background".to_owned(),
    };
    if hit.as_ref().is_some_and(|(hit, _)| is_near(hit)) {
        canvas.dot("red", outside.at(end), 5.0);
    }
    canvas.label("red", [outside.at(end); 2], &*told);
    canvas.finish_cropped(
        "A pinhole camera, seen from outside",
        &format!(
            "All rays leave the eye. The window lies at the distance d = {distance} along the view direction −w and is {} tall. \
            The ray through the middle of pixel ({x}, {y}) meets: {}. At the eye stand the axes u (the picture's right), v (its top) and w.",
            number(facts.view_height),
            told.replace('*', "")
        ),
    )
}

/// Returns the pixel in the middle of the object that covers the largest area of the picture.
/// Checkerboards are ignored. If there is no other object, returns the middle of the picture.
fn pixel_of_largest(scene: &Scene) -> [u32; 2] {
    let (seen, _) = seen(scene);
    let mut largest = (0.0, Area::whole(scene.image.width, scene.image.height));
    for (seen, object) in seen.iter().zip(scene.objects.iter()) {
        let is_board = matches!(object.shape, Shape::Checkerboard(_));
        if let Visibility::Part(around, pixels) = *seen
            && !is_board
            && pixels > largest.0
        {
            largest = (pixels, around);
        }
    }
    let (_, around) = largest;
    [around.x + around.width / 2, around.y + around.height / 2]
}

/// Index of an object, and the centre and the radius of its bounding sphere.
type Body = (usize, DVec3, f64);

/// Returns the objects to draw, at most [`MOST_OBJECTS`], without checkerboards. The object with
/// the index `first` comes first. `reach` is the distance from the eye, in metres, up to which the
/// figure shows the scene. Objects are left out if their radius is at least `reach`, or if they
/// extend beyond 1.5 times `reach` from the eye.
fn objects_within(scene: &Scene, reach: f64, first: Option<usize>) -> Vec<Body> {
    let others = (0..scene.objects.len()).filter(|index| Some(*index) != first);
    let bodies = first.into_iter().chain(others).filter_map(|index| {
        let (middle, radius) = scene.objects[index].shape.bounding_sphere()?;
        Some((index, middle, radius))
    });
    let is_small = |&(_, middle, radius): &Body| {
        radius < reach && middle.distance(scene.camera.eye) + radius < 1.5 * reach
    };
    bodies.filter(is_small).take(MOST_OBJECTS).collect()
}

/// Returns the lines between the squares of the checkerboards that are drawn, at most about
/// [`MOST_LINES`] in each direction. The lines cover the bounding box of `points`, the points that
/// the figure shows. The corners of each drawn board are added to `points`. Boards are left out if
/// they are more than `reach` metres above or below the eye, or if their squares are very large.
fn boards(scene: &Scene, points: &mut Vec<DVec3>, reach: f64) -> Vec<[DVec3; 2]> {
    let mut lines = Vec::new();
    let (min, max) = bounds3(points);
    let extent = (max - min).x.max((max - min).z);
    for object in scene.objects.iter() {
        let Shape::Checkerboard(board) = object.shape else {
            continue;
        };
        if (board.y - scene.camera.eye.y).abs() > reach || board.square > 4.0 * extent {
            continue;
        }
        let step = board.square * (extent / (board.square * MOST_LINES)).ceil().max(1.0);
        let (from, to) = ((min / step).floor() * step, (max / step).ceil() * step);
        let at = |x: f64, z: f64| DVec3::new(x, board.y, z);
        for i in (0..=MOST_LINES as u32 + 2).map(|i| step * f64::from(i)) {
            let (x, z) = (from.x + i, from.z + i);
            let is_within = [x <= to.x, z <= to.z];
            let both = [[at(x, from.z), at(x, to.z)], [at(from.x, z), at(to.x, z)]];
            lines.extend(
                both.into_iter()
                    .zip(is_within)
                    .filter(|it| it.1)
                    .map(|it| it.0),
            );
        }
        points
            .extend([from, to, from.with_x(to.x), to.with_x(from.x)].map(|it| it.with_y(board.y)));
    }
    lines
}
