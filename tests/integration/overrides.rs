//! `--set`, on the command line's terms.

use glam::DVec3;
use pinhole::{
    math::Angle,
    scene::{self, Count, Cuboid, Lens, Scene, Shape, Sphere, View},
    source::{Source, Sources},
};

const SCENE: &str = "let h = 1
let middle = (0, h, 0)
camera { eye (0, 2, 8) lookat middle d 3 }
sphere Ball { center middle radius h }
let late = 7
box Crate { center middle size (1, 1, 1) }
checkerboard { }
";

fn sources(sets: &[&str]) -> Sources {
    Sources::new(Source::from_text("test.scn", SCENE)).with_sets(sets)
}

fn read(sets: &[&str]) -> Scene {
    let reading = scene::read(&sources(sets));
    let found = &reading.diagnostics;
    reading.scene.unwrap_or_else(|| panic!("{found:#?}"))
}

/// Code, argument (counted from 1; 0 is the file) and text of the first label of every diagnostic.
fn problems(text: &str, sets: &[&str]) -> Vec<(String, usize, String)> {
    let sources = Sources::new(Source::from_text("test.scn", text)).with_sets(sets);
    let found = scene::read(&sources).diagnostics;
    found
        .iter()
        .map(|diagnostic| {
            let span = diagnostic.labels[0].span;
            let source = sources.sets().position(|(id, _)| id == span.source);
            let source = source.map_or(0, |index| index + 1);
            let code = diagnostic.code.replace("pinhole::", "");
            (code, source, sources.text(span).to_owned())
        })
        .collect()
}

#[track_caller]
fn assert_problem(sets: &[&str], code: &str, argument: usize, under: &str) {
    let expected = (code.to_owned(), argument, under.to_owned());
    assert_eq!(problems(SCENE, sets), [expected], "{sets:?}");
}

fn ball(scene: &Scene) -> (DVec3, f64) {
    match scene.objects[0].shape {
        Shape::Sphere(Sphere { center, radius, .. }) => (center, radius),
        _ => panic!("{scene:?}"),
    }
}

#[test]
fn fields_and_definitions() {
    assert_eq!(
        read(&["camera.roll=30deg"]).camera.roll,
        Angle::from_degrees(30.0)
    );
    assert_eq!(
        ball(&read(&["Ball.center=(0, 2, 0)"])),
        (DVec3::new(0.0, 2.0, 0.0), 1.0)
    );
    assert_eq!(ball(&read(&["h=1.5"])), (DVec3::new(0.0, 1.5, 0.0), 1.5));
    assert_eq!(ball(&read(&[" Ball . radius = h + 1 "])).1, 2.0);
    assert_eq!(
        read(&["image.width=10"]).image.width,
        10,
        "a block that the file leaves out"
    );
}

#[test]
fn the_last_one_wins() {
    assert_eq!(ball(&read(&["h=2", "h=nothing", "h=3"])).1, 3.0);
    assert_eq!(
        ball(&read(&[
            "Ball.radius=2",
            "Ball.radius=red",
            "Ball.radius=3"
        ]))
        .1,
        3.0
    );
    // The text that is replaced is judged for its syntax only.
    assert_problem(&["h=2 +", "h=3"], "missing_operand", 1, "+");
}

#[test]
fn alternatives_are_replaced() {
    let scene = read(&["camera.direction=(0, 0, -1)"]);
    assert_eq!(scene.camera.view, View::Direction(DVec3::NEG_Z));
    let scene = read(&["camera.fov=40deg"]);
    assert_eq!(scene.camera.lens, Lens::Fov(Angle::from_degrees(40.0)));
    let scene = read(&["camera.fov=40deg", "camera.d=4"]);
    assert_eq!(scene.camera.lens, Lens::Distance(4.0));
    let scene = read(&["sampler.per_pixel=4", "sampler.total=1e6"]);
    assert_eq!(scene.sampler.count, Count::Total(1_000_000));
    let scene = read(&["Crate.min=(0, 0, 0)", "Crate.max=(1, 2, 3)"]);
    let Shape::Box(Cuboid { max, .. }) = scene.objects[1].shape else {
        panic!("{scene:?}");
    };
    assert_eq!(max, DVec3::new(1.0, 2.0, 3.0));
    assert_problem(&["Crate.min=(0, 0, 0)"], "missing_field", 0, "box");
}

#[test]
fn fields_exclude_each_other_in_their_own_block_only() {
    assert_eq!(
        problems(SCENE, &["Ball.center=(0, 2, 0)", "Ball.min=(0, 0, 0)"]),
        [("unknown_field".to_owned(), 2, "min".to_owned())]
    );
    let text = "camera { eye (0, 2, 8) lookat (0, 1, 0) } sphere Ball { radius 2 }";
    assert_eq!(
        problems(text, &["Ball.center=(0, 2, 0)", "Ball.min=(0, 0, 0)"]),
        [("unknown_field".to_owned(), 2, "min".to_owned())]
    );
}

#[test]
fn of_two_objects_of_one_name_the_first_is_set() {
    let text = "camera { eye (0, 2, 8) lookat (0, 1, 0) }
        sphere S { center (0, 0, 0) }
        sphere S { center (1, 0, 0) }";
    assert_eq!(
        problems(text, &["S.center=(0, 2, 0)"]),
        [("duplicate_name".to_owned(), 0, "S".to_owned())]
    );
}

#[test]
fn what_is_replaced_is_not_judged() {
    let text = "camera { eye (0, 2, 8) lookat nothing }
        sphere Ball { center (0, 0, 0) radius red }
        let a = 1/0";
    assert_eq!(problems(text, &[]).len(), 3);
    let sets = ["camera.direction=(0, 0, -1)", "Ball.radius=a", "a=2"];
    assert_eq!(problems(text, &sets), []);
    let text = "camera { eye (0, 2, 8) lookat (0, 1, 0) } sphere Ball { center (0, 0 radius 2 }";
    assert_eq!(
        problems(text, &["Ball.center=(0, 0, 0)"])[0].0,
        "unclosed_parenthesis"
    );
}

#[test]
fn a_value_sees_the_names_before_its_place() {
    assert_eq!(
        ball(&read(&["Ball.radius=late"])).1,
        7.0,
        "a field sees all"
    );
    assert_eq!(read(&["late=h + 1"]).objects.len(), 3);
    assert_problem(&["h=late"], "used_before_definition", 1, "late");
    assert_problem(&["h=h"], "used_before_definition", 1, "h");
}

#[test]
fn mistakes_point_into_the_argument() {
    assert_problem(&["camera.roll"], "bad_set", 1, "camera.roll");
    assert_problem(&["h=2", "Bal.center=(0, 2, 0)"], "no_such_target", 2, "Bal");
    assert_problem(&["hh=2"], "no_such_target", 1, "hh");
    assert_problem(&["Ball.radus=2"], "unknown_field", 1, "radus");
    assert_problem(&["Ball.radius=-2"], "out_of_range", 1, "-2");
    assert_problem(&["Ball.radius=2m"], "bad_number", 1, "2m");
    assert_problem(&["Ball.radius="], "missing_value", 1, "=");
    assert_problem(&["Ball.radius=2 3"], "missing_operator", 1, "3");
    assert_problem(&["Ball.center=(0, 1"], "unclosed_parenthesis", 1, "(");
    assert_problem(&["camera.roll=30"], "bare_angle", 1, "30");
    assert_problem(&["sampler.method=jitered"], "unknown_method", 1, "jitered");
    assert_problem(
        &["camera.lookat=(0, 2, 8)"],
        "view_undefined",
        1,
        "(0, 2, 8)",
    );
    assert_problem(&["Ball.radius=}"], "unexpected", 1, "}");
    let deep = format!("h={}1{}", "(".repeat(257), ")".repeat(257));
    assert_problem(&[&deep], "too_deep", 1, "(");
}

#[test]
fn a_camera_can_come_from_the_arguments_alone() {
    let text = "sphere { center (0, 0, 0) }";
    let sets = ["camera.eye=(0, 0, 5)", "camera.lookat=(0, 0, 0)"];
    assert_eq!(problems(text, &sets), []);
    let expected = ("missing_field".to_owned(), 1, "camera".to_owned());
    assert_eq!(problems(text, &["camera.eye=(0, 0, 5)"]), [expected]);
}

#[test]
fn help_names_the_nearest() {
    for (set, help) in [
        (
            "Bal.center=1",
            "did you mean `Ball`? The scene has Ball and Crate.",
        ),
        ("midle=1", "did you mean `middle`?"),
        ("roll=30deg", "did you mean `camera.roll`?"),
        ("Ball=1", "name a field of it as well: `Ball.FIELD=…`"),
        (
            "Ball.raduis=1",
            "did you mean `radius`? A sphere takes center, radius and color.",
        ),
        (
            "Camera.roll=1",
            "did you mean `camera`? The scene has Ball and Crate.",
        ),
    ] {
        let found = scene::read(&sources(&[set])).diagnostics;
        assert_eq!(found[0].help.as_deref(), Some(help), "{set}");
    }
}

#[test]
fn the_file_comes_before_the_arguments() {
    let text =
        "camera { eye (0, 2, 8) lookat (0, 1, 0) } sphere Ball { center (0, 0, 0) color olvie }";
    let found = problems(text, &["Ball.radius=red", "x=1"]);
    let order: Vec<usize> = found.iter().map(|problem| problem.1).collect();
    assert_eq!(order, [0, 1, 2]);
}
