//! `--set`, on the command line's terms.

use pinhole::{
    scene::{self, Scene},
    source::{Source, Sources},
};

use crate::{scenes, table::rows};

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

/// What is set, which is as if it stood in the text: in place of the second cell the third.
#[test]
fn what_is_set_stands_in_the_text() {
    let table = "
        camera.roll=30deg -> d 3 -> d 3 roll 30deg
        Ball.center=(0, 2, 0) -> Ball { center middle -> Ball { center (0, 2, 0)
        h=1.5 -> let h = 1 -> let h = 1.5
        Ball . radius = h + 1 -> radius h -> radius h + 1
        -- A block that the file leaves out.
        image.width=10 -> let h -> image { width 10 } let h
        -- The last one wins.
        h=2; h=nothing; h=3 -> let h = 1 -> let h = 3
        Ball.radius=2; Ball.radius=red; Ball.radius=3 -> radius h -> radius 3
        -- Alternatives are replaced.
        camera.direction=(0, 0, -1) -> lookat middle -> direction (0, 0, -1)
        camera.fov=40deg -> d 3 -> fov 40deg
        camera.fov=40deg; camera.d=4 -> d 3 -> d 4
        sampler.per_pixel=4; sampler.total=1e6 -> let h -> sampler { total 1e6 } let h
        Crate.min=(0, 0, 0); Crate.max=(1, 2, 3) -> center middle size (1, 1, 1) -> min (0, 0, 0) max (1, 2, 3)
        -- A field sees all names, and a definition those before it.
        Ball.radius=late -> radius h -> radius 7
        late=h + 1 -> let late = 7 -> let late = 2
    ";
    let meaning = |scene: &Scene| {
        let shapes: Vec<_> = scene.objects.iter().map(|object| object.shape).collect();
        format!(
            "{:?} {:?} {:?} {shapes:?}",
            scene.image, scene.camera, scene.sampler
        )
    };
    for [sets, before, after] in rows(table) {
        assert!(SCENE.contains(before), "{before}");
        let written = scenes::read(&SCENE.replacen(before, after, 1));
        let sets: Vec<&str> = sets.split("; ").collect();
        assert_eq!(meaning(&read(&sets)), meaning(&written), "{sets:?}");
    }
    // The text that is replaced is judged for its syntax only.
    assert_problem(&["h=2 +", "h=3"], "missing_operand", 1, "+");
    assert_problem(&["Crate.min=(0, 0, 0)"], "missing_field", 0, "box");
}

#[test]
fn fields_exclude_each_other_in_their_own_block_only() {
    let text = "camera { eye (0, 2, 8) lookat (0, 1, 0) } sphere Ball { radius 2 }";
    for text in [SCENE, text] {
        let found = problems(text, &["Ball.center=(0, 2, 0)", "Ball.min=(0, 0, 0)"]);
        assert_eq!(found, [("unknown_field".to_owned(), 2, "min".to_owned())]);
    }
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
fn mistakes_point_into_the_argument() {
    let table = "
        camera.roll -> bad_set -> camera.roll
        Bal.center=(0, 2, 0) -> no_such_target -> Bal
        hh=2 -> no_such_target -> hh
        Ball.radus=2 -> unknown_field -> radus
        Ball.radius=-2 -> out_of_range -> -2
        Ball.radius=2m -> bad_number -> 2m
        Ball.radius= -> missing_value -> =
        Ball.radius=2 3 -> missing_operator -> 3
        Ball.center=(0, 1 -> unclosed_parenthesis -> (
        Ball.radius=} -> unexpected -> }
        camera.roll=30 -> bare_angle -> 30
        sampler.method=jitered -> unknown_method -> jitered
        camera.lookat=(0, 2, 8) -> view_undefined -> (0, 2, 8)
        -- A value sees the names before its place.
        h=late -> used_before_definition -> late
        h=h -> used_before_definition -> h
    ";
    for [set, code, under] in rows(table) {
        assert_problem(&["late=2", set], code, 2, under);
    }
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
    let table = "
        Bal.center=1 -> did you mean `Ball`? The scene has Ball and Crate.
        midle=1 -> did you mean `middle`?
        roll=30deg -> did you mean `camera.roll`?
        Ball=1 -> name a field of it as well: `Ball.FIELD=…`
        Ball.raduis=1 -> did you mean `radius`? A sphere takes center, radius and color.
        Camera.roll=1 -> did you mean `camera`? The scene has Ball and Crate.
    ";
    for [set, help] in rows(table) {
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
