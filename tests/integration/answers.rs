//! `inspect` and `probe` as data: against hand-made numbers and the oracle.

use glam::{DVec2, DVec3, dvec2, dvec3};
use pinhole::{
    inspect::{Inspection, inspect},
    probe::{Probe, probe},
    report::numerics::oracle::{ALL_SIZES, Oracle, length},
    scene::View,
};

use crate::{
    scenes::{read, sources},
    tracer::{Random, camera, cuboid, floor, sphere, triangle},
};

fn example(name: &str) -> String {
    let path = format!("{}/examples/{name}.scn", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(path).unwrap()
}

fn inspected(text: &str) -> Inspection {
    inspect(&read(text), &sources(text).file)
}

fn probed(text: &str, x: f64, y: f64) -> Probe {
    probe(&read(text), dvec2(x, y))
}

#[test]
fn the_figure_is_what_it_is() {
    let json = inspected(&example("figure_9_9")).to_json();
    assert_eq!(
        json["image"],
        serde_json::json!({ "width": 1280, "height": 720 })
    );
    assert_eq!(json["camera"]["eye"], serde_json::json!([3.0, 3.5, 8.0]));
    assert_eq!(json["camera"]["looks"], "down");
    assert_eq!(json["camera"]["far"], serde_json::Value::Null);
    let fov = json["camera"]["fov_deg"].as_f64().unwrap();
    assert!((fov - 2.0 * libm::atan(1.0 / 2.75).to_degrees()).abs() < 1e-12);
    assert_eq!(
        json["sampler"],
        serde_json::json!({ "method": "multi_jittered", "per_pixel": 16, "total": 14_745_600, "seed": 1 })
    );
    let objects = json["objects"].as_array().unwrap();
    let kinds: Vec<_> = objects
        .iter()
        .map(|object| object["kind"].as_str().unwrap())
        .collect();
    assert_eq!(kinds, ["sphere", "triangle", "box", "checkerboard"]);
    assert_eq!(objects[1]["name"], "Sail");
    assert_eq!(objects[3]["name"], serde_json::Value::Null);
    assert_eq!(objects[2]["min"], serde_json::json!([1.75, 0.0, -1.5]));
    let text = example("figure_9_9");
    let above = text
        .lines()
        .take_while(|line| !line.starts_with("triangle"));
    assert_eq!(objects[1]["line"], above.count() + 1);
}

#[test]
fn the_default_triangle_has_the_sides_of_the_assignment() {
    let json = inspected("camera { eye (0, 0, 9) lookat (0, 0, 0) } triangle { centroid (1, 2, 3) normal (0.3, -0.2, 1) }").to_json();
    let vertex = |i: usize| {
        let v = &json["objects"][0]["vertices"][i];
        dvec3(
            v[0].as_f64().unwrap(),
            v[1].as_f64().unwrap(),
            v[2].as_f64().unwrap(),
        )
    };
    let [left, right, apex] = [0, 1, 2].map(vertex);
    let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-14, "{a} is not {b}");
    close(left.distance(apex), 2.0);
    close(right.distance(apex), 2.0);
    close(left.distance(right), 1.0);
    let mean = (left + right + apex) / 3.0;
    close(mean.distance(dvec3(1.0, 2.0, 3.0)), 0.0);
    // Level base, apex above it, and right of left as seen from the tip of the normal.
    close(left.y, right.y);
    assert!(apex.y > left.y && right.x > left.x);
    let normal = (right - left).cross(apex - left).normalize();
    close(normal.distance(dvec3(0.3, -0.2, 1.0).normalize()), 0.0);
}

#[test]
fn vanishing_points_are_where_far_points_are_seen() {
    let json = inspected(&example("three_vanishing_points")).to_json();
    let scene = read(&example("three_vanishing_points"));
    for (axis, direction) in [DVec3::X, DVec3::Y, DVec3::Z].into_iter().enumerate() {
        let pixel = &json["vanishing_points"][axis]["pixel"];
        let pixel = dvec2(pixel[0].as_f64().unwrap(), pixel[1].as_f64().unwrap());
        let ray = probe(&scene, pixel).direction;
        assert!(ray.cross(direction).length() < 1e-14, "{axis}: {ray}");
    }
    let vanishing = |name: &str| {
        inspected(&example(name))
            .vanishing_points
            .map(|point| point.is_some())
    };
    assert_eq!(vanishing("one_vanishing_point"), [false, false, true]);
    assert_eq!(vanishing("two_vanishing_points"), [true, false, true]);
    assert_eq!(vanishing("three_vanishing_points"), [true, true, true]);
    let middle = inspected(&example("one_vanishing_point")).vanishing_points[2];
    assert_eq!(middle, Some([400.0, 225.0]));
}

#[test]
fn cameras_look_up_down_or_level() {
    let looks = |name: &str| inspected(&example(name)).camera.looks;
    assert_eq!(looks("straight_up"), "up");
    assert_eq!(looks("straight_down"), "down");
    assert_eq!(looks("one_vanishing_point"), "level");
}

#[test]
fn a_floor_point_of_the_worked_case_is_twice_its_view_plane_point() {
    // The view plane point (1, −1.5) is 160 pixels to the right of the middle and 240 above it.
    let probe = probed(&example("looking_down_the_y_axis"), 560.0, 160.0);
    let (floor, ..) = probe
        .hits
        .iter()
        .find(|(_, kind, _)| *kind == "checkerboard")
        .unwrap();
    assert_eq!(floor.point, dvec3(2.0, 0.0, -3.0));
    assert_eq!(floor.depth, 10.0);
}

#[test]
fn all_crossings_are_listed_and_one_is_seen() {
    let text = "camera { eye (0, 0, 10) direction (0, 0, -1) near 10 }
        sphere A { center (0, 0, 0) radius 2 color teal }
        sphere B { center (0, 0, 0) radius 2 color red }
        box    C { min (-1, -1, -5) max (1, 1, -4) }";
    let probe = probed(text, 400.0, 225.0);
    let listed: Vec<_> = probe
        .hits
        .iter()
        .map(|(hit, _, name)| (name.as_deref().unwrap(), hit.t, hit.visible))
        .collect();
    assert_eq!(
        listed,
        [
            ("A", 8.0, false),
            ("B", 8.0, false),
            ("A", 12.0, true),
            ("B", 12.0, false),
            ("C", 14.0, false),
            ("C", 15.0, false)
        ]
    );
    assert_eq!(probe.color.to_string(), "#008080");
    assert_eq!(probe.direction, DVec3::NEG_Z);
}

#[test]
fn points_outside_the_picture_are_probed_too() {
    let text =
        "camera { eye (0, 0, 4) direction (0, 0, -1) } sphere { center (40, 0, 0) radius 1 }";
    // The sphere is seen 10 times the eye's distance to the right: at x = 20 in the view plane, 225 pixels a unit.
    let probe = probed(text, 400.0 + 20.0 * 225.0, 225.0);
    assert_eq!(probe.color.to_string(), "#808000");
    assert!(probed(text, -1e300, 1e300).hits.is_empty());
}

#[test]
fn distances_and_points_are_right_to_the_last_bit() {
    let mut random = Random::new(3);
    for _ in 0..60 {
        let eye = random.vector(5.0);
        let mut camera = camera(eye, random.vector(1.0));
        camera.view = View::Direction(random.vector(1.0));
        let corner = random.vector(3.0);
        let scene = crate::tracer::scene(
            camera,
            &[
                sphere(random.vector(3.0), random.within(0.5, 4.0)),
                triangle(random.vector(3.0), random.vector(1.0)),
                cuboid(corner, corner + DVec3::splat(random.within(0.5, 4.0))),
                floor(),
            ],
        );
        let (x, y) = (random.bits() as u32 % 64, random.bits() as u32 % 64);
        let offset = dvec2(0.25, -0.375);
        let oracle = Oracle::new(&scene, ALL_SIZES);
        let r = oracle.direction(x, y, offset);
        let pixels = dvec2(f64::from(x) + 0.5, f64::from(y) + 0.5) + offset;
        let probe = probe(&scene, pixels);
        let mut expected = Vec::new();
        for index in 0..scene.objects.len() {
            for t in oracle.crossings(index, &r) {
                let point = oracle.point(&t, &r).map(|x| x.to_f64().value());
                let t = (t * length(&r)).to_f64().value();
                expected.push((t, index, DVec3::from(point)));
            }
        }
        expected.sort_by(|a, b| a.0.total_cmp(&b.0));
        assert_eq!(probe.hits.len(), expected.len());
        for ((hit, ..), (t, object, point)) in probe.hits.iter().zip(expected) {
            assert_eq!((hit.t, hit.object, hit.point), (t, object, point));
        }
    }
}

#[test]
fn what_the_probe_sees_is_what_the_picture_shows() {
    let scene = read(&example("piercing"));
    let world = pinhole::tracer::World::new(&scene);
    for y in (0..450).step_by(37) {
        for x in (0..800).step_by(41) {
            let probe = probe(&scene, dvec2(f64::from(x) + 0.5, f64::from(y) + 0.5));
            let slot = world.slot_at(x, y, DVec2::ZERO);
            assert_eq!(probe.color, world.palette()[slot]);
        }
    }
}

#[test]
fn the_widest_and_the_narrowest_views_are_probed() {
    let lenses = [
        "d 1e-300 view_height 1e300",
        "d 1e300 view_height 1e-300",
        "d 5e-324",
        "d 1.7e308",
    ];
    for lens in lenses {
        let text = format!(
            "image {{ width 1 height 1 }} camera {{ eye (0, 1, 5) lookat (0, 1, 0) {lens} }} box {{ center (0, 1, 0) size (1, 1, 1) }}"
        );
        let probe = probed(&text, 0.5, 0.5);
        let depths: Vec<_> = probe.hits.iter().map(|(hit, ..)| hit.depth).collect();
        assert_eq!(depths, [4.5, 5.5], "{lens}");
        let json = inspected(&text).to_json().to_string();
        assert_eq!(json.matches("null").count(), 4, "{lens}: {json}");
    }
}

#[test]
fn what_is_beyond_the_range_of_numbers_is_shown_at_its_end() {
    let text = "camera { eye (0, 1.7e308, 0) direction (0, -1, -1) } checkerboard {}";
    let probe = probed(text, 400.0, 225.0);
    let (hit, ..) = &probe.hits[0];
    assert_eq!((hit.t, hit.depth), (f64::MAX, f64::MAX));
    assert_eq!(hit.point, dvec3(0.0, 0.0, -1.7e308));
}
