//! Compares pictures of boxes with pictures of triangles that form the same boxes. The faces of a
//! box have different colours.

use glam::DVec3;
use pinhole::{
    scene::{Count, Method, Scene, Shape},
    tracer::{World, ray},
};

use crate::{
    diagnostics::codes,
    scenes::{exact, read, sampled, with_samples},
    table::rows,
};

const COLORS: [&str; 3] = ["red", "#00ff00", "blue"];

/// Returns the twelve triangles that form a box's faces. Opposite faces have the same colour.
fn triangles(min: DVec3, max: DVec3) -> String {
    let mut text = String::new();
    for (axis, color) in COLORS.into_iter().enumerate() {
        for side in [min, max] {
            let corner = |across: bool, up: bool| {
                let mut at = side;
                for (axis, is_far) in [((axis + 1) % 3, across), ((axis + 2) % 3, up)] {
                    at[axis] = if is_far { max[axis] } else { min[axis] };
                }
                format!("({:?}, {:?}, {:?})", at.x, at.y, at.z)
            };
            let [a, b, c, d] = [(false, false), (true, false), (true, true), (false, true)]
                .map(|(across, up)| corner(across, up));
            text += &format!("triangle {{ v0 {a} v1 {b} v2 {c} color {color} }}\n");
            text += &format!("triangle {{ v0 {a} v1 {c} v2 {d} color {color} }}\n");
        }
    }
    text
}

/// Rows of a camera and two opposite corners of a box. The eye sees the box from outside, from
/// inside, cut by the near or far plane, in the plane of a face, along an edge, and from far away.
const VIEWS: &[(&str, [f64; 3], [f64; 3])] = &[
    (
        "eye (4, 3, 8) lookat (0, 1, 0)",
        [-1.0, 0.0, -1.0],
        [1.0, 2.0, 1.0],
    ),
    (
        "eye (0.3, 1, 0.2) lookat (5, 0, -4) d 0.7",
        [-3.0, 0.0, -3.0],
        [3.0, 2.5, 3.0],
    ),
    (
        "eye (2, 2.5, 3) lookat (0, 0.5, 0) near 3.2",
        [-1.0, 0.0, -1.0],
        [1.0, 2.0, 1.0],
    ),
    (
        "eye (2, 2.5, 3) lookat (0, 0.5, 0) far 3.6",
        [-1.0, 0.0, -1.0],
        [1.0, 2.0, 1.0],
    ),
    (
        "eye (1, 1.5, 6) lookat (0, 1, 0)",
        [-1.0, 0.0, -1.0],
        [1.0, 2.0, 1.0],
    ),
    (
        "eye (3, 3, 3) lookat (0, 0, 0)",
        [-1.0, -1.0, -1.0],
        [1.0, 1.0, 1.0],
    ),
    (
        "eye (4, 2, 6) lookat (0, 1, 0) fov 0.002deg",
        [-1.0, 0.0, -1.0],
        [1.0, 2.0, 1.0],
    ),
    (
        "eye (-3, 0.1, 0.2) direction (1, 0, 0)",
        [-40.0, -0.5, -1.0],
        [40.0, 0.5, 1.0],
    ),
];

#[test]
fn a_box_with_face_colours_looks_like_triangles_of_its_faces() {
    for (camera, min, max) in VIEWS {
        let [min, max] = [*min, *max].map(DVec3::from);
        let [x, y, z] = COLORS;
        let head = format!(
            "image {{ width 37 height 23 }} camera {{ {camera} }}\nsphere {{ center (0.9, 1.2, 0.8) radius 0.4 color white }}\n"
        );
        let point = |at: DVec3| format!("({:?}, {:?}, {:?})", at.x, at.y, at.z);
        let corners = format!("min {} max {}", point(min), point(max));
        let faces = format!("box Crate {{ {corners} colors ({x}, {y}, {z}) }}");
        let floor = "\ncheckerboard { y 0.5 }";
        let [faces, triangles] =
            [faces, triangles(min, max)].map(|objects| read(&(head.clone() + &objects + floor)));
        for method in [Method::Regular, Method::MultiJittered, Method::Random] {
            let [one, other] = [&faces, &triangles]
                .map(|scene| sampled(&with_samples(scene, method, Count::PerPixel(16))));
            assert!(one.pixels() == other.pixels(), "{camera}, {method:?}");
        }
        let [one, other] = [&faces, &triangles].map(exact);
        for (at, (one_pixel, other_pixel)) in one
            .film
            .pixels()
            .iter()
            .zip(other.film.pixels())
            .enumerate()
        {
            let bound = one.bounds[at] + other.bounds[at] + 1e-12;
            for channel in 0..3 {
                let off = (one_pixel[channel] - other_pixel[channel]).abs();
                assert!(off <= f64::from(bound), "{camera}, {at}: {off} of {bound}");
            }
            assert!(one.bounds[at] < 1e-9, "{camera}, {at}: {}", one.bounds[at]);
        }
        objects_keep_their_places(&faces);
    }
}

/// Asserts that the tracer refers to objects by their indices in the file. The visible hit on a ray
/// must belong to the object that the picture shows there. A hit on a box must have the colour of
/// one of this box's faces.
fn objects_keep_their_places(scene: &Scene) {
    let world = World::new(scene);
    for (x, y) in [(18, 11), (3, 20), (30, 5)] {
        let (_, hits) = ray(
            &world,
            glam::DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5),
        );
        let visible = hits.iter().find(|hit| hit.visible);
        assert_eq!(visible.map(|hit| hit.object), world.object_at(x, y));
        for hit in hits {
            if let Shape::Box(cuboid) = scene.objects[hit.object].shape {
                assert!(cuboid.faces.unwrap().contains(&hit.color));
            }
        }
    }
}

#[test]
fn a_wrong_list_of_face_colours_is_reported() {
    let table = "
        color red colors (red, gold, blue) -> conflicting_fields
        colors red -> wrong_type
        colors (red, blue) -> wrong_type
        colors (red, 2, blue) -> part_type
        colors (red, gold, blue, tan) -> part_count
        colors (1, 2, 3) -> wrong_type
        colors red, gold, blue -> missing_parentheses
        colors [red, gold, blue] -> brackets
        color (red, gold, blue) -> wrong_type
        colors (red, gold, blue) ->
    ";
    for [fields, expected] in rows(table) {
        let text = format!(
            "camera {{ eye (4, 3, 8) lookat (0, 1, 0) }} box {{ center (0, 1, 0) {fields} }}"
        );
        assert_eq!(codes(&text, &[]).join(" "), expected.trim(), "{fields}");
    }
}
