//! `--set`, on the command line's terms.

use pinhole::{
    diagnostic::Diagnostic,
    scene,
    source::{Source, Sources},
};

use crate::{
    diagnostics::found,
    table::{lines, rows},
};

const SCENE: &str = "let h = 1
let middle = (0, h, 0)
camera { eye (0, 2, 8) lookat middle d 3 }
sphere Ball { center middle radius h }
let late = 7
box Crate { center middle size (1, 1, 1) }
checkerboard { }
";

/// What is wrong: each with its code, its argument (counted from 1; 0 is the file), and the text of its first label.
fn problems(text: &str, sets: &[&str]) -> String {
    let sources = Sources::new(Source::from_text("test.scn", text)).with_sets(sets);
    let found = scene::read(&sources).diagnostics.into_iter();
    let problem = |diagnostic: Diagnostic| {
        let span = diagnostic.labels[0].span;
        let source = sources.sets().position(|(id, _)| id == span.source);
        let source = source.map_or(0, |index| index + 1);
        let code = diagnostic.code.replace("pinhole::", "");
        format!("{code} {source} {}", sources.text(span))
    };
    found.map(problem).collect::<Vec<_>>().join("; ")
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
    let meaning = |text: &str, sets: &[&str]| {
        let sources = Sources::new(Source::from_text("test.scn", text));
        let reading = scene::read(&sources.with_sets(sets));
        let scene = reading
            .scene
            .unwrap_or_else(|| panic!("{sets:?}: {:#?}", reading.diagnostics));
        let shapes: Vec<_> = scene.objects.iter().map(|object| object.shape).collect();
        format!(
            "{:?} {:?} {:?} {shapes:?}",
            scene.image, scene.camera, scene.sampler
        )
    };
    for [sets, before, after] in rows(table) {
        assert!(SCENE.contains(before), "{before}");
        let written = meaning(&SCENE.replacen(before, after, 1), &[]);
        let sets: Vec<&str> = sets.split("; ").collect();
        assert_eq!(meaning(SCENE, &sets), written, "{sets:?}");
    }
}

/// Rows of what is set in the scene, or in a text that stands before it, and what is wrong.
#[test]
fn mistakes_point_into_the_argument() {
    for row in lines("
        late=2; camera.roll -> bad_set 2 camera.roll
        late=2; Bal.center=(0, 2, 0) -> no_such_target 2 Bal
        late=2; hh=2 -> no_such_target 2 hh
        late=2; Ball.radus=2 -> unknown_field 2 radus
        late=2; Ball.radius=-2 -> out_of_range 2 -2
        late=2; Ball.radius=2m -> bad_number 2 2m
        late=2; Ball.radius= -> missing_value 2 =
        late=2; Ball.radius=2 3 -> missing_operator 2 3
        late=2; Ball.center=(0, 1 -> unclosed_parenthesis 2 (
        late=2; Ball.radius=} -> unexpected 2 }
        late=2; camera.roll=30 -> bare_angle 2 30
        late=2; sampler.method=jitered -> unknown_method 2 jitered
        late=2; camera.lookat=(0, 2, 8) -> view_undefined 2 (0, 2, 8)
        Crate.min=(0, 0, 0) -> missing_field 0 box
        -- A value sees the names before its place.
        late=2; h=late -> used_before_definition 2 late
        late=2; h=h -> used_before_definition 2 h
        -- What is replaced is judged for its syntax only.
        h=2 +; h=3 -> missing_operand 1 +
        camera { eye (0, 2, 8) lookat nothing } sphere Ball { center (0, 0, 0) radius red } let a = 1/0 -> camera.direction=(0, 0, -1); Ball.radius=a; a=2 ->
        camera { eye (0, 2, 8) lookat (0, 1, 0) } sphere Ball { center (0, 0 radius 2 } -> Ball.center=(0, 0, 0) -> unclosed_parenthesis 0 (
        -- Fields exclude each other in their own block only.
        Ball.center=(0, 2, 0); Ball.min=(0, 0, 0) -> unknown_field 2 min
        camera { eye (0, 2, 8) lookat (0, 1, 0) } sphere Ball { radius 2 } -> Ball.center=(0, 2, 0); Ball.min=(0, 0, 0) -> unknown_field 2 min
        -- Of two objects of one name the first is set.
        camera { eye (0, 2, 8) lookat (0, 1, 0) } sphere S { center (0, 0, 0) } sphere S { center (1, 0, 0) } -> S.center=(0, 2, 0) -> duplicate_name 0 S
        -- A camera can come from the arguments alone.
        sphere { center (0, 0, 0) } -> camera.eye=(0, 0, 5); camera.lookat=(0, 0, 0) ->
        sphere { center (0, 0, 0) } -> camera.eye=(0, 0, 5) -> missing_field 1 camera
        -- The file comes before the arguments.
        camera { eye (0, 2, 8) lookat (0, 1, 0) } sphere Ball { center (0, 0, 0) color olvie } -> Ball.radius=red; x=1 -> unknown_color 0 olvie; wrong_type 1 red; no_such_target 2 x
    ") {
        let [text @ .., sets, expected] = &row[..] else {
            panic!("{row:?}");
        };
        let sets: Vec<&str> = sets.split("; ").collect();
        let text = text.first().copied().unwrap_or(SCENE);
        assert_eq!(problems(text, &sets), *expected, "{row:?}");
    }
    let deep = format!("h={}1{}", "(".repeat(257), ")".repeat(257));
    assert_eq!(problems(SCENE, &[&deep]), "too_deep 1 (");
}

#[test]
fn help_names_the_nearest() {
    for [set, help] in rows(
        "
        Bal.center=1 -> did you mean `Ball`? The scene has Ball and Crate.
        midle=1 -> did you mean `middle`?
        roll=30deg -> did you mean `camera.roll`?
        Ball=1 -> name a field of it as well: `Ball.FIELD=…`
        Ball.raduis=1 -> did you mean `radius`? A sphere takes center, radius and color.
        Camera.roll=1 -> did you mean `camera`? The scene has Ball and Crate.
    ",
    ) {
        assert_eq!(found(SCENE, &[set])[0].help.as_deref(), Some(help), "{set}");
    }
}
