//! Compares data that `inspect` and `probe` report with values computed by hand and with exact
//! arithmetic.

use glam::{DVec2, DVec3, dvec2, dvec3};
use pinhole::{
    inspect::{Inspection, inspect},
    probe::{Probe, probe},
    reference::oracle::{ALL_SIZES, Oracle, length},
    scene::{self, View},
    seen::Visibility,
    tracer::World,
};

use crate::{
    generated::{Numbers, generated},
    program::Folder,
    random::Random,
    scenes::{example_text as example, json_of, read, sources},
    tracer::{camera, cuboid, floor, sphere, triangle},
};

fn inspected(text: &str) -> Inspection {
    inspect(&read(text), &sources(text).file)
}

fn probed(text: &str, x: f64, y: f64) -> Probe {
    probe(&read(text), dvec2(x, y))
}

#[test]
fn the_default_triangle_has_the_sides_of_the_assignment() {
    let json = inspected(
        "camera { eye (0, 0, 9) lookat (0, 0, 0) } triangle { centroid (1, 2, 3) normal (0.3, -0.2, 1) }",
    );
    let json = json_of(&json);
    let vertices = json["objects"][0]["vertices"].clone();
    let vertices: [[f64; 3]; 3] = serde_json::from_value(vertices).unwrap();
    let [left, right, apex] = vertices.map(DVec3::from);
    let normal = (right - left).cross(apex - left).normalize();
    for (a, b) in [
        (left.distance(apex), 2.0),
        (right.distance(apex), 2.0),
        (left.distance(right), 1.0),
        (
            ((left + right + apex) / 3.0).distance(dvec3(1.0, 2.0, 3.0)),
            0.0,
        ),
        // The expected base, between `left` and `right`, is level. The apex is above it, and
        // `right` is on the right as seen from the tip of the triangle's normal.
        (left.y, right.y),
        (normal.distance(dvec3(0.3, -0.2, 1.0).normalize()), 0.0),
    ] {
        assert!((a - b).abs() < 1e-14, "{a} is not {b}");
    }
    assert!(apex.y > left.y && right.x > left.x);
}

#[test]
fn vanishing_points_are_where_far_points_are_seen() {
    let three = example("three_vanishing_points");
    let directions = [DVec3::X, DVec3::Y, DVec3::Z];
    for (direction, pixel) in directions
        .into_iter()
        .zip(inspected(&three).vanishing_points)
    {
        let [x, y] = pixel.expect("all three are there");
        let ray = probed(&three, x, y).direction;
        assert!(ray.cross(direction).length() < 1e-14, "{direction}: {ray}");
    }
    let [one, two] = ["one_vanishing_point", "two_vanishing_points"].map(example);
    let middle = Some([400.0, 225.0]);
    assert_eq!(inspected(&one).vanishing_points, [None, None, middle]);
    let two = inspected(&two).vanishing_points;
    assert_eq!(two.map(|point| point.is_some()), [true, false, true]);
    let looks = |name: &str| inspected(&example(name)).camera.looks;
    assert_eq!(looks("straight_up"), "up");
    assert_eq!(looks("straight_down"), "down");
    assert_eq!(looks("one_vanishing_point"), "level");
}

#[test]
fn probe_lists_all_intersections_and_marks_the_visible_one() {
    let text = "camera { eye (0, 0, 10) direction (0, 0, -1) near 10 }
        sphere A { center (0, 0, 0) radius 2 color teal }
        sphere B { center (0, 0, 0) radius 2 color red }
        box    C { min (-1, -1, -5) max (1, 1, -4) }";
    let probe = probed(text, 400.0, 225.0);
    let listed = probe.hits.iter().map(|(hit, object)| {
        let sign = if hit.visible { "!" } else { "" };
        format!("{}{sign} {}", object.name.as_deref().unwrap(), hit.t)
    });
    let listed: Vec<_> = listed.collect();
    assert_eq!(listed.join(", "), "A 8, B 8, A! 12, B 12, C 14, C 15");
    assert_eq!(probe.color.to_string(), "#008080");
    assert_eq!(probe.direction, DVec3::NEG_Z);
}

#[test]
fn probed_distances_and_points_are_correctly_rounded() {
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
fn probe_sees_the_colour_that_the_picture_shows() {
    let scene = read(&example("piercing"));
    let world = World::new(&scene);
    for y in (0..450).step_by(37) {
        for x in (0..800).step_by(41) {
            let probe = probe(&scene, dvec2(f64::from(x) + 0.5, f64::from(y) + 0.5));
            let color_index = world.color_index_at(x, y, DVec2::ZERO);
            assert_eq!(probe.color, world.palette()[color_index]);
        }
    }
}

#[test]
fn probe_works_far_outside_the_picture_and_with_extreme_lenses() {
    let text =
        "camera { eye (0, 0, 4) direction (0, 0, -1) } sphere { center (40, 0, 0) radius 1 }";
    // The centre of the sphere is 40 m to the right of the view axis, at a depth of 4 m. The view
    // plane is 2 m from the eye by default, so it shows the centre at x = 20 m. In the picture, 1 m
    // of the view plane is 225 pixels.
    let probe = probed(text, 400.0 + 20.0 * 225.0, 225.0);
    assert_eq!(probe.color.to_string(), "#808000");
    assert!(probed(text, -1e300, 1e300).hits.is_empty());
    // In this example, the eye looks down, and the floor is twice as far from it as the view plane.
    // The probed pixel is at x = 1 and z = −1.5 in the view plane, so it shows the point of the
    // floor at x = 2 and z = −3.
    let worked = example("looking_down_the_y_axis");
    let hits = probed(&worked, 560.0, 160.0).hits;
    let floor = hits
        .iter()
        .find(|(_, object)| object.shape.kind() == "checkerboard");
    let (floor, ..) = floor.unwrap();
    assert_eq!((floor.point, floor.depth), (dvec3(2.0, 0.0, -3.0), 10.0));
    for lens in [
        "d 1e-300 view_height 1e300",
        "d 1e300 view_height 1e-300",
        "d 5e-324",
        "d 1.7e308",
    ] {
        let text = format!(
            "image {{ width 1 height 1 }} camera {{ eye (0, 1, 5) lookat (0, 1, 0) {lens} }} box {{ center (0, 1, 0) size (1, 1, 1) }}"
        );
        let probe = probed(&text, 0.5, 0.5);
        let depths: Vec<_> = probe.hits.iter().map(|(hit, ..)| hit.depth).collect();
        assert_eq!(depths, [4.5, 5.5], "{lens}");
        let json = json_of(&inspected(&text)).to_string();
        // JSON shows an infinite number as `null`. The output must have only the four `null`s for
        // missing values: the far distance, two vanishing points, and the name of the box. The text
        // from `seen` on is not searched, because it has a further `null` if the box covers almost
        // nothing of a pixel.
        let (facts, _) = json.split_once("\"seen\"").unwrap();
        assert_eq!(facts.matches("null").count(), 4, "{lens}: {json}");
    }
    // Values outside of the range of `f64` are shown as its largest value.
    let text = "camera { eye (0, 1.7e308, 0) direction (0, -1, -1) } checkerboard {}";
    let (hit, ..) = &probed(text, 400.0, 225.0).hits[0];
    assert_eq!((hit.t, hit.depth), (f64::MAX, f64::MAX));
    assert_eq!(hit.point, dvec3(0.0, 0.0, -1.7e308));
}

#[test]
fn inspect_reports_what_is_visible_of_each_object() {
    let scene =
        "image { width 100 height 100 } camera { eye (0, 0, 10) lookat (0, 0, 0) fov 90deg near 1 far 100 }
         box Wall { min (-5, -5, -1) max (5, 5, 0) }
         sphere Hidden { center (0, 0, -5) }
         sphere Behind { center (0, 0, 20) }
         sphere Right { center (60, 0, 0) }
         sphere Above { center (0, 60, 0) }
         sphere Near { center (0, 0, 9.5) radius 0.1 }
         sphere Far { center (0, 0, -200) }
         sphere Row for i < 2 { center (-7 + 99 * i, 0, 0) }";
    let folder = Folder::with([("a.scn", scene)]);
    let json = folder.run("inspect a.scn --format json").json();
    let seen = |index: usize| json["objects"][index]["seen"].to_string();
    assert_eq!(seen(0), r#"{"box":[25,25,50,50],"pixels":2500.0}"#);
    for (index, what) in [
        (1, r#""hidden_by":"Wall""#),
        (2, r#""outside":"behind the camera""#),
        (3, r#""outside":"right of the window""#),
        (4, r#""outside":"above the window""#),
        (5, r#""outside":"nearer than `near`""#),
        (6, r#""outside":"beyond `far`""#),
        // The silhouette of the sphere is an ellipse that extends from 41.5 to 29.2 pixels left of
        // the picture's centre. The sphere has the radius r = 1. Its centre is at the depth z = 10
        // and at the distance c = √149 from the eye. At a distance of 1 m, 1 m² covers 2500 pixels,
        // so the silhouette covers
        //     2500·π·r²·√(c² − r²) / (z² − r²)^1.5 = 96.999154
        // pixels.
        (7, r#""box":[8,44,13,12],"pixels":96.999154}"#),
        (8, r#""outside":"right of the window""#),
    ] {
        assert!(seen(index).contains(what), "{}", seen(index));
    }
    let hits = folder.run("probe a.scn 15 50 --format json").json();
    assert_eq!(hits["hits"][0]["indices"].to_string(), "[0]", "{hits}");
}

/// Compares the exact pictures of two scenes. Each row has the arguments, the exit status, and a
/// part of the message.
#[test]
fn diff_compares_two_scenes_without_sampling_noise() {
    let folder = Folder::with([
        (
            "a.scn",
            "image { width 40 height 30 } camera { eye (0, 0, 9) lookat (0, 0, 0) } sphere { center (0, 0, 0) }",
        ),
        (
            "b.scn",
            "camera { lookat (0, 0, 0) eye (0, 0, 9) } image { width 40 height 30 } let o = (0, 0, 0) sphere { center o }",
        ),
        (
            "c.scn",
            "image { width 40 height 30 } camera { eye (0, 0, 9) lookat (0, 0, 0) } sphere { center (0.01, 0, 0) }",
        ),
        (
            "d.scn",
            "image { width 41 height 30 } camera { eye (0, 0, 9) lookat (0, 0, 0) } sphere { center (0, 0, 0) }",
        ),
    ]);
    for (line, status, words) in [
        ("diff a.scn b.scn", 0, "are equal"),
        ("diff a.scn c.scn -o heat.png", 1, "differ"),
        ("diff a.scn c.scn --tolerance 255", 0, "are equal"),
        ("diff a.scn d.scn", 2, "give both one size"),
        ("diff a.scn b.scn --crop 0,0,1,1", 2, "`--crop`"),
    ] {
        let said = folder.run(line);
        assert_eq!(said.status, status, "{line}: {}", said.errors);
        assert!(said.errors.contains(words), "{line}: {}", said.errors);
    }
    assert!(!folder.read("heat.png").is_empty());
}

/// If a warning says that an object is outside of the picture, no pixel may show the object.
#[test]
fn objects_reported_outside_the_picture_are_not_visible() {
    let mut outside = 0;
    for (text, _) in generated(Numbers::Wild(0), [12, 8], 3).take(300) {
        let Some(scene) = scene::read(&sources(&text)).scene else {
            continue;
        };
        let Some(sight) = scene::Sight::new(&scene.camera, &scene.image) else {
            continue;
        };
        let world = World::new(&scene);
        let pixels = (0..8).flat_map(|y| (0..12).map(move |x| (x, y)));
        let seen: Vec<_> = pixels.filter_map(|(x, y)| world.object_at(x, y)).collect();
        for (index, object) in scene.objects.iter().enumerate() {
            let is_outside = sight.outside(&object.shape).is_some();
            outside += u32::from(is_outside);
            assert!(!is_outside || !seen.contains(&index), "{index}: {text}");
        }
    }
    assert!(outside > 50, "{outside}");
}

/// The text output lists only 100 objects; the JSON output lists all of them.
#[test]
fn inspect_lists_100_objects_and_summarizes_the_rest() {
    let scene =
        "camera { eye (0, 0, 10) lookat (0, 0, 0) } sphere for i < 1100 { center (i, 0, 0) }";
    let folder = Folder::with([("a.scn", scene)]);
    let said = folder.run("inspect a.scn").errors;
    assert_eq!(said.matches("line 1").count(), 100);
    assert_eq!(said.matches("sphere       [99] ").count(), 2, "{said}");
    assert!(
        said.contains("  1_000 more, which --format json lists"),
        "{said}"
    );
    // The window is 17.8 m wide at the depth of the objects, so only the first eight objects are in
    // it. The summary must state that 1000 others are outside.
    let rest = "  1_000 more: 0 seen, 0 %; 1_000 outside of the picture; 0 hidden or too small";
    assert!(said.contains(rest), "{said}");
    let json = folder.done("inspect a.scn --format json").json();
    let objects = json["objects"].as_array().unwrap();
    assert_eq!(objects.len(), 1100);
    assert_eq!(
        objects.iter().filter(|it| it.get("seen").is_some()).count(),
        100
    );
    assert_eq!(json["rest"]["outside"], 1000);
    // The output lists the first 100 objects and summarizes the rest. The numbers in the summary
    // must be those of the objects that are not listed.
    let picture = "image { width 96 height 54 } camera { eye (0, 0, 9) lookat (0, 0, 0) } ";
    let ball =
        |z: &str| format!("sphere for i < 15, j < 10 {{ center (i - 5, j - 4, {z}) radius 0.3 }}");
    for first in ["-i", "i - 30", "12 + i"] {
        let text = format!("{picture}{}", ball(first));
        let inspection = inspected(&text);
        let rest = json_of(&inspection)["rest"].clone();
        let seen = inspection.objects[100..].iter().map(|it| it.seen);
        let count = |is_it: fn(&Visibility) -> bool| seen.clone().filter(is_it).count() as u64;
        assert_eq!(rest["objects"], 50, "{first}");
        assert_eq!(
            rest["seen"],
            count(|it| matches!(it, Visibility::Part(..))),
            "{first}"
        );
        assert_eq!(
            rest["outside"],
            count(|it| matches!(it, Visibility::Outside(_))),
            "{first}"
        );
    }
}
