//! Tests of random drags: a dragged handle appears at the pointer, and no drag makes a text
//! invalid.

use glam::{DVec2, DVec3, dvec2};
use pinhole::{
    editor::viewport::{Along, Drag, ShownObjects, overlays},
    inspect::{CameraFacts, inspect},
    probe::probe,
    scene::{self, CenteredTriangle, Cuboid, Scene, Shape, TriangleOutline, View},
    schema::{BLOCKS, BlockKind},
};
use proptest::{
    array::{uniform2, uniform3, uniform4},
    prelude::*,
    sample::select,
};

use super::answers::dragged;
use crate::scenes::{read, sources};

/// Generates the text of a scene with one object, of any kind, in front of the camera.
fn any_scene() -> impl Strategy<Value = String> {
    let vectors = uniform4(uniform3(-4.0..4.0));
    let turns = uniform2(-200.0..200.0);
    let objects = BLOCKS.iter().filter(|row| row.is_object);
    let objects = select(objects.map(|row| row.kind).collect::<Vec<_>>());
    let object = (objects, any::<bool>());
    let views = (0..2usize, 0..4usize, 0..4usize);
    (vectors, uniform3(0.1..3.0), turns, object, views).prop_map(|(vectors, [s, t, r], [spin, roll], object, views)| {
        let [a, b, c, eye] = vectors.map(|[x, y, z]| format!("({x:.2}, {y:.2}, {z:.3})"));
        let (size, y) = (format!("({s:.2}, {t:.1}, {r:.3})"), vectors[0][1]);
        let object = match object {
            (BlockKind::Sphere, _) => format!("sphere {{ center {a} radius {r:.2} }}"),
            (BlockKind::Box, false) => format!("box {{ center {a} size {size} }}"),
            (BlockKind::Box, true) => format!("let min = {a} box {{ min min max min + {size} }}"),
            (BlockKind::Triangle, false) => format!("triangle {{ centroid {a} normal {b} + (0, 0, 9) sides (2, 2, 1.5) spin {spin:.1}deg }}"),
            (BlockKind::Triangle, true) => format!("triangle {{ v0 {a} v1 {b} v2 {c} }}"),
            (BlockKind::Checkerboard, _) => format!("checkerboard {{ y {y:.2} }}"),
            (kind, _) => panic!("{kind:?} is no object, or a new kind"),
        };
        let view = [format!("lookat {c}"), format!("direction {c} + (0, 0, -9)")];
        let (view, lens) = (&view[views.0], ["", "d 5", "fov 60deg", "hfov 1rad"][views.1]);
        let (width, height) = [(160, 90), (30, 40), (1, 1), (1 << 20, 3)][views.2];
        format!("{object} image {{ width {width} height {height} }} camera {{ eye {eye} + (0, 0, 9) {view} {lens} roll {roll:.0}deg }}")
    })
}

/// Generates a point: inside the picture, slightly outside of it, or very far away. Its coordinates
/// are in units of the picture's width and height.
fn any_point() -> impl Strategy<Value = (f64, f64)> {
    let part = || prop_oneof![8 => -0.5..1.5, 1 => Just(1e300), 1 => Just(-1e12)];
    (part(), part())
}

fn point_of(scene: &Scene, (x, y): (f64, f64)) -> DVec2 {
    dvec2(
        x * f64::from(scene.image.width),
        y * f64::from(scene.image.height),
    )
}

/// Returns the names of the first object's handles.
fn handles(scene: &Scene) -> Vec<&'static str> {
    let objects = overlays(scene, &ShownObjects::First(None)).objects;
    objects[0].handles.iter().map(|(name, _)| *name).collect()
}

fn camera_of(scene: &Scene) -> CameraFacts {
    inspect(scene, &sources("").file).camera
}

/// Returns the position in space of a handle of the first object. For a handle without a fixed
/// position, such as one that depends on the camera, returns the object's centre.
///
/// `held` is the scene before the drag. It is needed for a checkerboard, whose handle starts where
/// the camera's view axis meets the board. The drag then moves the handle straight up or down
/// together with the board.
fn handle_position(scene: &Scene, handle: &str, held: &Scene) -> DVec3 {
    match (scene.objects[0].shape, held.objects[0].shape) {
        (Shape::Sphere(sphere), _) => sphere.center,
        (Shape::Box(Cuboid { min, max, .. }), _) => {
            let mut at = min.midpoint(max);
            if let Some(axis) = axis_of(handle, "") {
                at[axis] = if handle.starts_with("min") { min } else { max }[axis];
            }
            at
        }
        (Shape::Triangle(triangle), _) => match (triangle.outline, handle) {
            (TriangleOutline::Vertices(corners), "v0" | "v1" | "v2") => {
                corners[usize::from(handle.as_bytes()[1] - b'0')]
            }
            (outline, _) => outline.centroid(),
        },
        (Shape::Checkerboard(board), Shape::Checkerboard(before)) => {
            let CameraFacts { eye, w, .. } = camera_of(held);
            (eye + w * ((before.y - eye.y) / w.y)).with_y(board.y)
        }
        (_, other) => panic!("a drag makes a board of a {}", other.kind()),
    }
}

/// Returns the direction in the picture, as a unit vector, in which `point` appears to move if it
/// moves along the coordinate axis `axis`.
fn direction_seen(scene: &Scene, point: DVec3, axis: usize) -> DVec2 {
    let camera = camera_of(scene);
    let turned = |v: DVec3| DVec3::new(v.dot(camera.u), -v.dot(camera.v), -v.dot(camera.w));
    let (at, by) = (turned(point - camera.eye), turned(DVec3::AXES[axis]));
    // Let (x, y, z) be the point in the camera's coordinates. It appears at (x/z, y/z). The vector
    // below is the derivative of (x/z, y/z) along the movement, multiplied by z² and then
    // normalized.
    (by.truncate() * at.z - at.truncate() * by.z).normalize()
}

/// Returns the axis along which a handle moves. Returns `None` if it moves in a plane or in another
/// way.
fn axis_of(handle: &str, word: &str) -> Option<usize> {
    let axis = match handle {
        "y" => "y",
        "radius" | "normal" | "spin" => "",
        _ => handle.split_once('_').map_or(word, |(_, axis)| axis),
    };
    "xyz".find(axis).filter(|_| !axis.is_empty())
}

/// Returns whether the tip of a triangle's normal vector appears within half a pixel of the point
/// `to`. If the normal is too short to reach the ray through `to`, its tip must be as near to this
/// ray as possible.
fn normal_points_to(scene: &Scene, triangle: &CenteredTriangle, to: DVec2) -> bool {
    let camera = camera_of(scene);
    let (width, height) = (f64::from(scene.image.width), f64::from(scene.image.height));
    let across = (to - dvec2(width, height) / 2.0) * (camera.view_height / (height * camera.d));
    let ray = camera.u * across.x - camera.v * across.y - camera.w;
    // The division avoids an overflow: the point may be so far away that the square of a coordinate
    // is infinite.
    let ray = (ray / ray.abs().max_element()).normalize();
    let center = triangle.centroid - camera.eye;
    let foot = ray * center.dot(ray) - center;
    let goal = if foot.length() < triangle.sides.z {
        to
    } else {
        project(
            scene,
            triangle.centroid + foot.normalize() * triangle.sides.z,
        )
    };
    let tip = triangle.centroid + triangle.normal.normalize() * triangle.sides.z;
    project(scene, tip).distance(goal) <= 0.5 + 1e-6
}

/// Returns whether the apex of a triangle appears in the direction of the point `to`, as seen from
/// the centroid. Also returns `true` if the apex or `to` is less than a pixel from the centroid,
/// because rounding then affects the direction too much.
fn apex_lies_towards(scene: &Scene, triangle: &CenteredTriangle, to: DVec2) -> bool {
    let middle = project(scene, triangle.centroid);
    let shown = overlays(scene, &ShownObjects::First(None));
    let (_, apex) = shown.objects[0].handles[2];
    let (wanted, found) = (to - middle, apex.expect("it is seen") - middle);
    let across = wanted.perp_dot(found) / wanted.length();
    wanted.length() < 1.0
        || found.length() < 1.0
        || (across.abs() <= 0.5 + 1e-6 && wanted.dot(found) > 0.0)
}

/// Projects a point in space to the picture. Uses the camera data that `pinhole inspect` reports.
fn project(scene: &Scene, point: DVec3) -> DVec2 {
    let camera = inspect(scene, &sources("").file).camera;
    let from_eye = point - camera.eye;
    let (width, height) = (f64::from(scene.image.width), f64::from(scene.image.height));
    let scale = camera.d * height / camera.view_height / -from_eye.dot(camera.w);
    dvec2(
        width / 2.0 + from_eye.dot(camera.u) * scale,
        height / 2.0 - from_eye.dot(camera.v) * scale,
    )
}

fn assert_near(a: DVec2, b: DVec2, text: &str) {
    assert!(a.distance(b) <= 0.5 + 1e-6, "{a} is not near {b}\n{text}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    /// A drag either brings the handle as close to the pointer as the handle can move, or is
    /// refused with a reason.
    #[test]
    fn a_dragged_handle_appears_at_the_pointer(
        text in any_scene(), to in any_point(), which in 0..7usize, word in prop_oneof![Just(""), Just("x"), Just("y"), Just("z"), Just("floor")],
    ) {
        let reading = scene::read(&sources(&text));
        let Some(before) = reading.scene else { return Ok(()) };
        let to = point_of(&before, to);
        let handles = handles(&before);
        let handle = handles[which % handles.len()];
        let moved = Drag { object: Some(0), handle, from: to, to, along: Along::named(word), step: None, observer: None };
        let Ok(changed) = dragged(&text, &moved) else { return Ok(()) };
        let mut after = read(&changed);
        prop_assert_eq!(after.objects.len(), before.objects.len());
        // The drag may change a `let` that the camera uses, too. The handle must be at the pointer
        // as seen by the camera before the drag, so the old camera is put back.
        after.camera = before.camera;
        let place = handle_position(&after, handle, &before);
        let found = project(&after, place);
        let message = format!("{changed}\n{handle} {word} {to}: {found}");
        match (handle, after.objects[0].shape) {
            ("radius", _) => {
                // The pointer must lie on the sphere's silhouette, so a ray 3/4 pixel further in
                // hits the sphere and a ray 3/4 pixel further out does not. The inner side is
                // towards the projection of the sphere's centre. If the centre is behind the eye,
                // the inner side is in the opposite direction, and `side` is −1.
                let CameraFacts { eye, w, .. } = camera_of(&after);
                let side = (eye - place).dot(w).signum();
                let inwards = (found - to).normalize_or_zero() * (0.75 * side);
                let hits = |at: DVec2| probe(&after, at).hits.iter().any(|(hit, ..)| hit.object == 0);
                let is_near = to.abs().max_element() < 1e4 && before.image.width > 100 && before.image.width < 1000;
                prop_assert!(!is_near || hits(to + inwards) || found.distance(to) < 1.0, "{}", message);
                prop_assert!(!is_near || !hits(to - inwards), "{}", message);
            }
            ("normal" | "spin", Shape::Triangle(triangle)) => {
                let TriangleOutline::Centered(triangle) = triangle.outline else { unreachable!("it has a normal") };
                let is_right = match handle {
                    "normal" => normal_points_to(&after, &triangle, to),
                    _ => apex_lies_towards(&after, &triangle, to),
                };
                prop_assert!(is_right, "{}", message);
            }
            _ => match axis_of(handle, word) {
                None => assert_near(found, to, &message),
                // The handle comes as near to the pointer as its axis allows. So the vector from
                // the pointer to the handle is perpendicular to the handle's movement in the
                // picture.
                Some(axis) => {
                    let left = (to - found).dot(direction_seen(&after, place, axis));
                    prop_assert!(left.abs() <= 0.5 + 1e-6, "{}: {} left", message, left);
                }
            },
        }
    }

    /// A drag of the camera never makes a text invalid, and changes neither the objects nor the
    /// image. An orbit keeps the distance of the eye from the `lookat` point.
    #[test]
    fn a_camera_drag_keeps_objects_and_image_and_an_orbit_its_distance(
        text in any_scene(), from in any_point(), to in any_point(),
        handle in prop_oneof![Just("orbit"), Just("pan"), Just("dolly"), Just("roll"), Just("look"), Just("view_distance")],
    ) {
        let reading = scene::read(&sources(&text));
        let Some(before) = reading.scene else { return Ok(()) };
        let [from, to] = [from, to].map(|point| point_of(&before, point));
        let moved = Drag { object: None, handle, from, to, along: None, step: None, observer: None };
        let Ok(changed) = dragged(&text, &moved) else { return Ok(()) };
        let after = read(&changed);
        prop_assert_eq!(&after.objects, &before.objects);
        prop_assert_eq!(after.image, before.image);
        if let (View::Lookat(point), "orbit") = (before.camera.view, handle)
            && before.image.width > 1
        {
            let [a, b] = [&before, &after].map(|scene| scene.camera.eye.distance(point));
            prop_assert!((a - b).abs() < 0.1 * a, "{}", changed);
        }
    }
}

/// Drags a handle five times. Returns the shapes of the object: before the first drag, and after
/// each of the five.
fn drag_repeatedly(block: &str, handle: &str, step: Option<f64>) -> Vec<Shape> {
    let view = "camera { eye (3, 3.5, 8) lookat (0.2, 0.8, 0) d 2.75 }";
    let mut text = format!("{block} {view}");
    let mut shapes = vec![read(&text).objects[0].shape];
    for by in [
        [0.0, -19.0],
        [13.0, 7.0],
        [-8.5, 17.0],
        [23.0, -31.0],
        [5.0, 3.0],
    ] {
        let scene = read(&text);
        let all = overlays(&scene, &ShownObjects::First(None)).objects;
        let (_, at) = all[0]
            .handles
            .iter()
            .find(|(name, _)| *name == handle)
            .expect("a handle");
        let to = at.expect("it is seen") + DVec2::from(by);
        let moved = Drag {
            object: Some(0),
            handle,
            from: to,
            to,
            along: None,
            step,
            observer: None,
        };
        // A drag that would move a face past the opposite face is refused, and the text stays as it
        // is.
        text = dragged(&text, &moved).unwrap_or(text);
        shapes.push(read(&text).objects[0].shape);
    }
    shapes
}

/// A drag of a box's face leaves the other faces where they are. A drag of a triangle's centre
/// leaves the edge vectors as they are. Rounding errors below 1e-12 are allowed.
#[test]
fn dragging_one_handle_leaves_the_other_sides_and_edges_unchanged() {
    let steps = [None, Some(8.0), Some(3.0), Some(1.0)];
    let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
    let boxes = [
        "box { center (2.1, 0.7, -1.2) size (0.8, 1.4, 1.6) }",
        "box { center (0.123, 0.7, 0) size (1, 1.4567, 1) }",
        "box { min (0.1, 0.25, -1) max (1, 1.5, 0.125) }",
        "let s = 0.7 box { center (0.35, s, 0) size (1, 2 * s, 1) + (0, 0, 1) }",
    ];
    let faces = ["min_x", "max_x", "min_y", "max_y", "min_z", "max_z"];
    for (text, handle, step) in boxes.iter().flat_map(|text| {
        faces
            .iter()
            .flat_map(move |face| steps.map(|step| (text, face, step)))
    }) {
        // In the text that begins with `let`, the centre and the size use the same name. A drag
        // along y changes both of them, so this case is skipped.
        if text.starts_with("let") && handle.ends_with('y') {
            continue;
        }
        let shapes = drag_repeatedly(text, handle, step);
        assert!(
            shapes.windows(2).any(|pair| pair[0] != pair[1]),
            "{text} {handle}"
        );
        let sides = shapes.iter().map(|shape| match shape {
            Shape::Box(Cuboid { min, max, .. }) => [min.to_array(), max.to_array()].concat(),
            _ => panic!("a box"),
        });
        let sides: Vec<Vec<f64>> = sides.collect();
        let held =
            "xyz".find(&handle[4..]).expect("an axis") + 3 * usize::from(handle.starts_with("max"));
        for (side, (first, last)) in sides[0]
            .iter()
            .zip(&sides[5])
            .enumerate()
            .filter(|(side, _)| *side != held)
        {
            assert!(
                near(*first, *last),
                "{text} {handle} {step:?}: side {side} goes from {first} to {last}"
            );
        }
    }
    for step in steps {
        let shapes = drag_repeatedly(
            "triangle { v0 (0, 0.25, 0) v1 (1.125, 0, 0.5) v2 (0, 1, 0.333) }",
            "center",
            step,
        );
        let edges = shapes.iter().map(|shape| match shape {
            Shape::Triangle(triangle) => match triangle.outline {
                TriangleOutline::Vertices([a, b, c]) => [b - a, c - a],
                TriangleOutline::Centered(_) => panic!("it has vertices"),
            },
            _ => panic!("a triangle"),
        });
        let edges: Vec<_> = edges.collect();
        for (a, b) in edges[0].into_iter().zip(edges[5]) {
            assert!(
                a.distance(b) < 1e-12,
                "{step:?}: an edge goes from {a} to {b}"
            );
        }
        assert!(shapes[0] != shapes[5]);
    }

    // In this text, the camera looks at a point. A pan moves the eye and this point together, so
    // the vector from the eye to the point must stay the same.
    let text =
        "sphere { center (0, 0, 0) } camera { eye (3, 3.55, 8) lookat (0.2, 0.8, 0.125) d 2.75 }";
    let ahead = |text: &str| {
        let camera = read(text).camera;
        match camera.view {
            View::Lookat(point) => (camera.eye, point - camera.eye),
            View::Direction(_) => panic!("it looks at a point"),
        }
    };
    let mut panned = text.to_owned();
    for to in [dvec2(310.0, 170.0), dvec2(500.5, 33.25), dvec2(77.0, 401.0)] {
        let from = dvec2(300.0, 200.0);
        let moved = Drag {
            object: None,
            handle: "pan",
            from,
            to,
            along: None,
            step: None,
            observer: None,
        };
        panned = dragged(&panned, &moved).expect("it is panned");
    }
    let [(eye, before), (panned_eye, after)] = [text, &panned].map(ahead);
    assert!(before.distance(after) < 1e-12, "{panned}");
    assert!(eye.distance(panned_eye) > 0.1);
}
