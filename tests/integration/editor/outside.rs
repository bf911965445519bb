//! Tests of the view from outside, in which an observer sees the scene and its camera. Drags of the
//! camera's handles in this view change the numbers of the text.

use glam::{DVec2, DVec3};
use pinhole::{
    editor::viewport::{Along, Drag, Observer, PointedRay, ShownObjects, camera_overlay, overlays},
    inspect::{CameraFacts, inspect_camera},
    scene::{Camera, Scene, View},
};
use proptest::{
    array::{uniform2, uniform3},
    prelude::*,
    sample::select,
};

use super::answers::dragged;
use crate::scenes::read;

const SIZE: [u32; 2] = [500, 240];

/// Generates the text of a camera, in each form of the language, with a sphere and a floor.
fn any_scene() -> impl Strategy<Value = String> {
    let lens = select(vec![
        "",
        "d 2.75",
        "fov 40deg",
        "hfov 1rad",
        "fov 65.5deg view_height 0.7",
    ]);
    let depths = select(vec!["", "near 0.5", "near 1.5 far 12", "far 20"]);
    let vectors = (
        uniform3(-3.0..3.0),
        uniform3(-1.0..1.0),
        uniform3(-1.0..1.0),
    );
    (vectors, lens, depths, any::<bool>(), -60.0..60.0).prop_map(
        |((eye, at, up), lens, depths, is_point, roll)| {
            let vector = |[x, y, z]: [f64; 3]| format!("({x:.2}, {y:.2}, {z:.2})");
            let (eye, at, up) = (vector(eye), vector(at), vector(up));
            let view = if is_point {
                format!("lookat {at}")
            } else {
                format!("direction {at} + (0, 0, -4)")
            };
            format!("camera {{ eye {eye} + (0, 3, 8) {view} up {up} + (0, 3, 0) {lens} {depths} roll {roll:.0}deg }}\nsphere Ball {{ center (0, 1, 0) }}\ncheckerboard {{}}\n")
        },
    )
}

fn observer(scene: &Scene, from: Option<DVec3>) -> Observer {
    Observer::around(scene, from, DVec3::Y, 30.0, SIZE)
}

fn facts(scene: &Scene) -> CameraFacts {
    inspect_camera(&scene.camera, &scene.image).0
}

/// Projects a point to an observer's picture, by the camera data that `pinhole inspect` reports.
fn seen(scene: &Scene, observer: &Observer, point: DVec3) -> DVec2 {
    let facts = facts(&observer.scene(scene));
    let from_eye = point - facts.eye;
    let [width, height] = SIZE.map(f64::from);
    let scale = facts.d * height / facts.view_height / -from_eye.dot(facts.w);
    let across = DVec2::new(from_eye.dot(facts.u), -from_eye.dot(facts.v));
    DVec2::new(width, height) / 2.0 + across * scale
}

/// Returns the position of a handle of the camera in space, computed from the camera data of
/// `pinhole inspect`.
fn place(scene: &Scene, handle: &str) -> DVec3 {
    let Camera { view, up, .. } = scene.camera;
    let CameraFacts {
        eye,
        u,
        v,
        w,
        d,
        view_height,
        hfov_deg,
        near,
        far,
        ..
    } = facts(scene);
    let lower = |depth: f64| eye - w * depth - v * (depth * view_height / (2.0 * d));
    let right = (hfov_deg.to_radians() / 2.0).tan() * d;
    match (handle, view) {
        ("eye", ..) => eye,
        ("lookat", View::Lookat(point)) => point,
        ("direction", View::Direction(direction)) => eye + direction,
        ("d", ..) => eye - w * d,
        ("view_height" | "fov", ..) => eye - w * d + v * (view_height / 2.0),
        ("hfov", ..) => eye - w * d + u * right,
        ("up", View::Lookat(point)) => eye + up.normalize() * (0.12 * point.distance(eye)),
        ("up", View::Direction(_)) => eye + up.normalize() * (0.24 * d),
        ("near", ..) => lower(near),
        ("far", ..) => lower(far.expect("a far plane")),
        _ => panic!("{handle}"),
    }
}

fn handles(scene: &Scene, observer: &Observer) -> Vec<(&'static str, Option<DVec2>)> {
    let projection = observer.projection();
    let drawn = camera_overlay(&scene.camera, &scene.image, &projection, None);
    drawn
        .handles
        .into_iter()
        .map(|it| (it.name, it.at))
        .collect()
}

fn drag<'a>(observer: Observer, handle: &'a str, to: DVec2, step: Option<f64>) -> Drag<'a> {
    let (object, along, from) = (None, None, to);
    Drag {
        object,
        handle,
        from,
        to,
        along,
        step,
        observer: Some(observer),
    }
}

fn is_within(point: DVec2) -> bool {
    let size = DVec2::from(SIZE.map(f64::from));
    (point.cmpge(DVec2::ZERO) & point.cmple(size)).all()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// The view that the program chooses shows the eye, the corners of the window and the sphere,
    /// from any direction.
    #[test]
    fn the_chosen_view_shows_eye_window_and_objects(
        text in any_scene(), from in prop_oneof![Just(None), uniform3(-1.0..1.0).prop_map(Some)],
    ) {
        let scene = read(&text);
        let observer = observer(&scene, from.map(DVec3::from));
        prop_assert!(observer.is_possible());
        let CameraFacts { eye, u, v, w, d, view_height, .. } = facts(&scene);
        let (top, right) = (v * (view_height / 2.0), u * (view_height * 8.0 / 9.0));
        let middle = eye - w * d;
        let ball = DVec3::AXES.map(|axis| DVec3::Y + axis);
        let corners = [top + right, top - right, right - top, -top - right].map(|it| middle + it);
        for point in [eye].into_iter().chain(corners).chain(ball) {
            let at = seen(&scene, &observer, point);
            prop_assert!(is_within(at), "{}: {} at {}", text, point, at);
        }
    }

    /// Each handle is drawn at its geometric position. After a drag, it is at the pointer, or as
    /// near to the pointer as the line on which it moves allows. The other fields of the camera
    /// keep their values.
    #[test]
    fn a_handle_of_the_camera_follows_the_pointer_and_changes_its_field_alone(
        text in any_scene(), which in 0..7usize, by in uniform2(-90.0..90.0), step in prop_oneof![Just(None), Just(Some(8.0))],
    ) {
        let before = read(&text);
        let observer = observer(&before, None);
        let handles = handles(&before, &observer);
        let (handle, at) = handles[which % handles.len()];
        let Some(at) = at else { return Ok(()) };
        let expected = seen(&before, &observer, place(&before, handle));
        prop_assert!(at.distance(expected) < 1e-6, "{handle} of {text} at {at}, not {expected}");
        let to = at + DVec2::from(by);
        let Ok(changed) = dragged(&text, &drag(observer, handle, to, step)) else { return Ok(()) };
        let after = read(&changed);
        prop_assert_eq!(&after.objects, &before.objects);
        // Only the field of the handle may change.
        let mut expected = before.camera;
        match handle {
            "eye" => expected.eye = after.camera.eye,
            "lookat" | "direction" => expected.view = after.camera.view,
            "d" | "fov" | "hfov" => expected.lens = after.camera.lens,
            "view_height" => expected.view_height = after.camera.view_height,
            "up" => expected.up = after.camera.up,
            "near" => expected.near = after.camera.near,
            _ => expected.far = after.camera.far,
        }
        prop_assert_eq!(after.camera, expected, "{}: {}", handle, changed);
        let found = seen(&after, &observer, place(&after, handle));
        let tolerance = 0.5 + step.unwrap_or(0.0) + 1e-6;
        // Each handle changes one number of the camera. `towards` is the direction in space in
        // which the handle moves if this number grows.
        let place = place(&before, handle);
        let own = facts(&before);
        let towards = match handle {
            "eye" | "lookat" | "direction" => {
                prop_assert!(found.distance(to) <= tolerance, "{handle} at {found}, not {to}\n{changed}");
                return Ok(());
            }
            "d" => -own.w,
            "view_height" => own.v,
            "near" | "far" => -own.w - own.v * (own.view_height / (2.0 * own.d)),
            // The handle `up` moves on a sphere. The handle of `fov` or `hfov` moves on a line, but
            // the drag moves the edge of the frustum to the pointer, not the handle.
            // `a_dragged_angle_opens_the_frustum_to_the_pointer` tests these drags.
            _ => return Ok(()),
        };
        let moved = seen(&before, &observer, place + towards * 1e-4) - seen(&before, &observer, place);
        let left = (to - found).dot(moved.normalize());
        // `d` and `view_height` stop at a hundredth of their values before the drag. The near and
        // far planes stop when their distance from each other is a hundredth of what it was; `near`
        // also stops at 0. The limit 0.015 allows for the rounding of the written number.
        let near = before.camera.near;
        let [shorter, nearer] = [facts(&after).d / own.d, after.camera.view_height / before.camera.view_height];
        let between = |depth: f64| before.camera.far.map_or(1.0, |far| (far - depth) / (far - near));
        let is_at_end = match handle {
            "d" => shorter < 0.015,
            "view_height" => nearer < 0.015,
            "near" => after.camera.near == 0.0 || between(after.camera.near) < 0.015,
            _ => after.camera.far.is_some_and(|far| 1.0 - between(far) < 0.015),
        };
        prop_assert!(is_at_end || left.abs() <= tolerance, "{handle}: {left} left\n{changed}");
    }

    /// An object that is dragged from outside appears at the pointer.
    #[test]
    fn an_object_follows_the_pointer_from_outside(text in any_scene(), by in uniform2(-60.0..60.0)) {
        let before = read(&text);
        let observer = observer(&before, None);
        let at = seen(&before, &observer, DVec3::Y);
        let to = at + DVec2::from(by);
        let moved = Drag { object: Some(0), along: Some(Along::Floor), ..drag(observer, "center", to, None) };
        let Ok(changed) = dragged(&text, &moved) else { return Ok(()) };
        let after = read(&changed);
        let center = after.objects[0].shape.center().expect("a centre");
        prop_assert_eq!(center.y, 1.0);
        prop_assert!(seen(&before, &observer, center).distance(to) <= 0.5 + 1e-6, "{}", changed);
    }
}

/// After a drag of the handle of an angle (`fov` or `hfov`), an edge of the frustum passes through
/// the pointer.
#[test]
fn a_dragged_angle_opens_the_frustum_to_the_pointer() {
    for (lens, handle) in [("fov 40deg", "fov"), ("hfov 50deg", "hfov")] {
        let text = format!(
            "camera {{ eye (0, 1, 8) lookat (0, 1, 0) {lens} }} sphere {{ center (0, 1, 0) }}"
        );
        let scene = read(&text);
        let observer = observer(&scene, None);
        let found = handles(&scene, &observer)
            .into_iter()
            .find(|(name, _)| *name == handle);
        let at = found.and_then(|(_, at)| at).expect("it is seen");
        for by in [(0.0, -20.0), (12.0, 9.0), (25.0, -30.0)] {
            let to = at + DVec2::from(by);
            let changed = dragged(&text, &drag(observer, handle, to, None)).expect("a drag");
            let after = read(&changed);
            let edge = place(&after, handle);
            let [eye, edge] = [after.camera.eye, edge].map(|it| seen(&after, &observer, it));
            let left = (edge - eye).normalize().perp_dot(to - eye);
            assert!(
                left.abs() < 1.5,
                "{handle}: {left} from the edge\n{changed}"
            );
        }
    }
}

/// Dragging the camera's window along the view axis changes `d`, the window's distance from the
/// eye. A window that is dragged to the eye or behind it stays just in front of the eye.
#[test]
fn a_window_dragged_along_the_axis_changes_d_as_far_as_the_pointer_moved() {
    let text = "camera { eye (0, 0, 0) direction (0, 0, -1) d 2 } sphere { center (0, 0, -9) }";
    let scene = read(text);
    // The observer looks from the side, so that lengths along the view axis are not foreshortened.
    let observer = observer(&scene, Some(DVec3::X));
    let [one, two] = [2.0, 3.0].map(|d| seen(&scene, &observer, DVec3::NEG_Z * d));
    let changed = dragged(text, &drag(observer, "d", two, Some(4.0))).expect("a drag");
    assert_eq!(changed, text.replace("d 2", "d 3"));
    let back = dragged(&changed, &drag(observer, "d", one, Some(4.0))).expect("a drag");
    assert_eq!(back, text);
    let eye = seen(&scene, &observer, DVec3::ZERO);
    for to in [eye, eye + (eye - two)] {
        let stopped = dragged(text, &drag(observer, "d", to, None));
        assert_eq!(stopped, Ok(text.replace("d 2", "d 0.02")));
    }
}

/// A handle that is dragged past its last possible place stays there. It begins to follow the
/// pointer again when the pointer comes back.
#[test]
fn a_handle_dragged_too_far_stays_at_its_last_place() {
    // Each case has fields of the camera, a handle, the pointer's distances above the eye and in
    // front of it, and the field before and after the drag.
    let cases = [
        ("near 1 far 3", "near", (-1.75, 3.5), "near 1", "near 2.98"),
        ("near 1 far 3", "near", (0.1, -0.2), "near 1", "near 0"),
        ("near 1 far 3", "far", (-0.25, 0.5), "far 3", "far 1.02"),
        ("near 1 far 3", "far", (0.1, -0.2), "far 3", "far 1.02"),
        ("d 2", "d", (0.0, -1.0), "d 2", "d 0.02"),
        ("fov 40deg", "d", (0.0, -1.0), "fov 40deg", "fov 177deg"),
        (
            "d 2 view_height 1",
            "view_height",
            (-0.5, 2.0),
            "view_height 1",
            "view_height 0.01",
        ),
        ("fov 40deg", "fov", (-0.5, 2.0), "fov 40deg", "fov 0.4deg"),
        ("fov 40deg", "fov", (0.1, -2.0), "fov 40deg", "fov 179deg"),
    ];
    for (fields, handle, (above, depth), before, after) in cases {
        let text = format!(
            "camera {{ eye (0, 0, 0) direction (0, 0, -1) {fields} }} sphere {{ center (0, 0, -4) }}"
        );
        let scene = read(&text);
        let observer = observer(&scene, Some(DVec3::X));
        let to = seen(&scene, &observer, DVec3::new(0.0, above, -depth));
        let changed = dragged(&text, &drag(observer, handle, to, None));
        assert_eq!(changed, Ok(text.replace(before, after)), "{handle}");
        // With coarse steps of the pointer, the number is not rounded to one that is an error.
        for step in [1.0, 8.0, 64.0] {
            let coarse = dragged(&text, &drag(observer, handle, to, Some(step)));
            read(&coarse.expect("a drag"));
        }
    }
    let text = "camera { eye (0, 0, 0) direction (0, 0, -1) } sphere { center (0, 0, -4) }";
    let scene = read(text);
    assert_eq!(
        dragged(
            text,
            &drag(observer(&scene, None), "roll", DVec2::ZERO, None)
        ),
        Err("this camera has no handle `roll`".to_owned())
    );
}

/// The ray through a pixel is drawn from the eye to the surface that the ray hits. Two points of
/// the ray are marked: the one in the camera's window, and the one on the surface.
#[test]
fn the_pointed_ray_ends_at_what_it_meets() {
    let scene = read("camera { eye (0, 1, 8) lookat (0, 1, 0) d 2 } sphere { center (0, 1, 0) }");
    let observer = observer(&scene, None);
    let end = DVec3::new(0.0, 1.0, 1.0);
    let pointed = PointedRay {
        pixel: DVec2::new(400.0, 225.0),
        end: Some(end),
    };
    let camera = camera_overlay(
        &scene.camera,
        &scene.image,
        &observer.projection(),
        Some(pointed),
    );
    let [window, met, eye] =
        [DVec3::new(0.0, 1.0, 6.0), end, scene.camera.eye].map(|it| seen(&scene, &observer, it));
    let near = |a: DVec2, b: DVec2| a.distance(b) < 1e-6;
    assert!(
        near(camera.met[0], window) && near(camera.met[1], met),
        "{:?}",
        camera.met
    );
    let (_, ray) = camera
        .lines
        .iter()
        .find(|(name, _)| *name == "ray")
        .expect("a ray");
    assert!(near(ray[0][0], eye) && near(ray[0][1], met), "{ray:?}");
}

/// Even for extreme scenes, the program chooses a view with a valid camera. The lines that are
/// drawn in the view have finite coordinates.
#[test]
fn extreme_scenes_have_a_view() {
    let sphere = "sphere { center (0, 1, 0) }";
    for camera in [
        "eye (0, 1, 8) lookat (0, 1, 0) d 1e-300 view_height 1e-300",
        "eye (0, 1, 8) lookat (0, 1, 0) d 1e-9",
        "eye (1e300, 1, 8) lookat (0, 1, 0)",
        "eye (0, 1, 8) direction (0, -1, 0)",
        "eye (0, 1, 8) lookat (0, 1, 7.999999999999999)",
        "eye (0, 1, 8) lookat (0, 1, 0) near 1e-200 far 1e300",
        "eye (0, 1, 8) lookat (0, 1, 0) fov 179.999999deg",
        "eye (0, 1, 0) lookat (0, 1, -1) d 1e12",
    ] {
        for objects in [sphere, "", "sphere { center (0, 0, 0) radius 1e250 }"] {
            let scene = read(&format!("camera {{ {camera} }} {objects}"));
            for from in [
                None,
                Some(DVec3::Y),
                Some(DVec3::ZERO),
                Some(DVec3::splat(1e300)),
            ] {
                let observer = observer(&scene, from);
                assert!(observer.is_possible(), "{camera}: {observer:?}");
                let projection = observer.projection();
                let drawn = camera_overlay(&scene.camera, &scene.image, &projection, None);
                let lines = drawn
                    .lines
                    .iter()
                    .flat_map(|(_, lines)| lines.iter().flatten());
                let most = 130.0 * 500.0;
                assert!(
                    lines.into_iter().all(|at| at.abs().max_element() < most),
                    "{camera}"
                );
            }
        }
    }
}

/// Overlays seen by an observer are equal to the overlays of a scene whose own camera has the
/// observer's numbers.
#[test]
fn an_observer_is_the_camera_of_its_numbers() {
    let objects = "box { center (2, 0.75, -0.5) } sphere { center (0, 1, 0) } checkerboard {}";
    let scene = read(&format!(
        "camera {{ eye (3, 3.5, 8) lookat (0, 1, 0) }} {objects}"
    ));
    let observer = Observer {
        eye: DVec3::new(9.0, 4.0, 3.0),
        lookat: DVec3::new(0.5, 1.0, 2.0),
        up: DVec3::new(0.1, 1.0, 0.0),
        fov: 33.0,
        size: SIZE,
    };
    let written = read(&format!(
        "image {{ width 500 height 240 }} camera {{ eye (9, 4, 3) lookat (0.5, 1, 2) up (0.1, 1, 0) fov 33deg }} {objects}"
    ));
    let all = ShownObjects::First(None);
    assert_eq!(
        overlays(&observer.scene(&scene), &all),
        overlays(&written, &all)
    );
}
