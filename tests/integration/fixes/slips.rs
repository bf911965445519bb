//! What people write, and what is made of it: each row is a text, the codes of its reports, and the text with its fixes.

use pinhole::{diagnostic::apply, source::SourceId};

use super::{Trial, of_scene};
use crate::{
    diagnostics::{codes, found},
    scenes::sources,
    table::rows,
};

/// Beside the rows stand a camera and a board. Where no text is given, nothing is offered.
const ROWS: &str = r#"
    -- Numbers and units.
    sphere { center (0, 1, 0)  radius 10cm } -> bad_number -> sphere { center (0, 1, 0)  radius 0.1 }
    let a = 5mm -> bad_number -> let a = 0.005
    let a = 1km -> bad_number -> let a = 1000
    let a = 3ft -> bad_number -> let a = 0.9144
    let a = 2 in -> bad_number -> let a = 0.0508
    triangle { centroid (0, 1, 0)  normal (0, 0, 1)  spin 100grad } -> bad_number -> triangle { centroid (0, 1, 0)  normal (0, 0, 1)  spin 90deg }
    triangle { centroid (0, 1, 0)  spin 45°  normal (0, 0, 1) } -> bad_number -> triangle { centroid (0, 1, 0)  spin 45deg  normal (0, 0, 1) }
    triangle { centroid (0, 1, 0)  spin 30 deg  normal (0, 0, 1) } -> spaced_unit -> triangle { centroid (0, 1, 0)  spin 30deg  normal (0, 0, 1) }
    let r = 2 let a = 2r -> bad_number -> let r = 2 let a = 2 * r
    sampler { total 1,000,000 } -> decimal_comma -> sampler { total 1_000_000 }
    sphere { center (0, 1, 0)  radius 1,5 } -> decimal_comma -> sphere { center (0, 1, 0)  radius 1.5 }
    box { center (0, 1, 0)  size 0.5x1.5x2 } -> bad_number -> box { center (0, 1, 0)  size (0.5, 1.5, 2) }
    sampler { per_pixel 4x4 } -> bad_number -> sampler { per_pixel 16 }
    box { center (3, 3,5, 8) } -> part_count -> box { center (3, 3.5, 8) }
    -- Vectors and colours.
    sphere { center +(2,0,0) } -> plus_sign -> sphere { center (2,0,0) }
    sphere { center (0, 0, 0) rgb (1, 0, 0) } -> missing_field_name ->
    sphere { center (1, , 3) } -> missing_value ->
    sphere { center <1 2 3> } -> brackets -> sphere { center (1, 2, 3) }
    sphere { center <1, 2, 3 radius 1 } -> unclosed_parenthesis -> sphere { center (1, 2, 3) radius 1 }
    sphere { center 0 1 0 } -> missing_parentheses -> sphere { center (0, 1, 0) }
    sphere { center vec3(1,2,3) } -> foreign_function -> sphere { center (1, 2, 3) }
    sphere { center Point3D(1,2,3) } -> foreign_function -> sphere { center (1, 2, 3) }
    sphere { center (0, 1, 0)  color 255,0,0 } -> missing_parentheses -> sphere { center (0, 1, 0)  color rgb(255, 0, 0) }
    sphere { center (0, 1, 0)  color rgba(255,0,0,1) } -> foreign_function -> sphere { center (0, 1, 0)  color rgb(255, 0, 0) }
    sphere { center (0, 1, 0)  color [128,128,0] } -> brackets -> sphere { center (0, 1, 0)  color rgb(128, 128, 0) }
    sphere { center (0, 1, 0)  color 0xff0000 } -> bad_number -> sphere { center (0, 1, 0)  color #ff0000 }
    sphere { center (0, 1, 0)  color # red } -> bad_color_code -> sphere { center (0, 1, 0)  color red }
    sphere { center (0, 1, 0)  color “red” } -> quoted -> sphere { center (0, 1, 0)  color red }
    sphere { center (0, 1, 0)  color ‘red’ } -> quoted -> sphere { center (0, 1, 0)  color red }
    let a = sin 30deg -> missing_parentheses -> let a = sin(30deg)
    let a = 1) + 2) -> stray_closing stray_closing -> let a = 1 + 2
    -- Fields.
    sphere { center (0, 1, 0)  radius2 } -> missing_space -> sphere { center (0, 1, 0)  radius 2 }
    sphere { colorred  center (0, 1, 0) } -> missing_space -> sphere { color red  center (0, 1, 0) }
    image { backgroundblack } -> missing_space -> image { background black }
    sphere { center (0, 1, 0)  radius 1 radius } -> unexpected ->
    sphere { center = (0, 1, 0), radius = 1, color = red, } -> needless_equals needless_separator -> sphere { center (0, 1, 0) radius 1 color red }
    sphere { center (0, 1, 0)  material { shiny 1 }  radius 2 } -> nested_braces ->
    scene { sphere { center (0, 1, 0) } } -> nested_braces ->
    sphere {<-2,3,14>,3} -> missing_field_name -> sphere {center (-2,3,14)  radius 3}
    sphere { center Ball.center } -> not_in_language ->
    sphere { center (0, p.x, 0) } -> not_in_language ->
    -- Items.
    sphere My Ball { center (0, 1, 0) } -> bad_head -> sphere My_Ball { center (0, 1, 0) }
    let x = 1\nx = x + 1 -> not_in_language ->
    x = x + 1 -> not_in_language ->
    let f(x) = 2 * x -> not_in_language ->
    let a = 1\nif (a > 0) {\n  box { center (0, 1, 0) }\n} -> not_in_language ->
    for i in 0..10 {\n  box { center (i, 1, 0) }\n} -> not_in_language ->
    import "x" -> not_in_language ->
    print(r) -> not_in_language ->
    #include "colors.inc" -> not_in_language ->
    #version 3.7; -> not_in_language ->
    const t = 4; -> missing_let -> let t = 4
    image 640 480 -> unopened_block ->
    image:\n  width 640 -> unopened_block ->
    image(width 640) -> unopened_block -> image {width 640}
    sphere (0, 1, 0) -> unopened_block ->
    /* /* */ c */ -> nested_comment -> /*   c */
    -- Words of other programs and other habits.
    sphere { location (0, 0, 0) } -> unknown_field -> sphere { center (0, 0, 0) }
    sphere { center (0, 0, 0)  diameter 2 } -> unknown_field -> sphere { center (0, 0, 0)  radius 1 }
    sphere { center (0, 0, 0)  color ff0000 } -> unknown_color -> sphere { center (0, 0, 0)  color #ff0000 }
    triangle { center (0, 1, 0)  normal (0, 0, 1) } -> unknown_field -> triangle { centroid (0, 1, 0)  normal (0, 0, 1) }
    triangle { vertices ((0, 0, 0), (1, 0, 0), (0, 1, 0)) } -> unknown_field -> triangle { v0 (0, 0, 0)  v1 (1, 0, 0)  v2 (0, 1, 0) }
    image { resolution (640, 480) } -> unknown_field -> image { width 640  height 480 }
    sampler { total_samples 1_000_000 } -> unknown_field -> sampler { total 1_000_000 }
    sampler { jittered } -> unknown_field -> sampler { method jittered }
    camera { location (0, 0, 9)  lookat (0, 0, 0) } -> unknown_field -> camera { eye (0, 0, 9)  lookat (0, 0, 0) }
    camera { look_from (0, 0, 9)  lookat (0, 0, 0) } -> unknown_field -> camera { eye (0, 0, 9)  lookat (0, 0, 0) }
    camera { eyepoint (0, 0, 9)  lookat (0, 0, 0) } -> unknown_field -> camera { eye (0, 0, 9)  lookat (0, 0, 0) }
    camera { position (0, 0, 9)  lookat (0, 0, 0) } -> unknown_field -> camera { eye (0, 0, 9)  lookat (0, 0, 0) }
    camera { eye (0, 0, 9)  look_at (0, 0, 0) } -> unknown_field -> camera { eye (0, 0, 9)  lookat (0, 0, 0) }
    camera { eye (0, 0, 9)  view_direction (0, 0, -1) } -> unknown_field -> camera { eye (0, 0, 9)  direction (0, 0, -1) }
    camera { eye (0, 0, 9)  lookat (0, 0, 0)  view_distance 3 } -> unknown_field -> camera { eye (0, 0, 9)  lookat (0, 0, 0)  d 3 }
    camera { eye (0, 0, 9)  lookat (0, 0, 0)  view_plane_distance 2 } -> unknown_field -> camera { eye (0, 0, 9)  lookat (0, 0, 0)  d 2 }
    camera { eye (0, 0, 9)  lookat (0, 0, 0)  near_clip 1 } -> unknown_field -> camera { eye (0, 0, 9)  lookat (0, 0, 0)  near 1 }
    camera { eye (0, 0, 9)  lookat (0, 0, 0)  nearClip 1 } -> unknown_field -> camera { eye (0, 0, 9)  lookat (0, 0, 0)  near 1 }
    camera { eye (0, 0, 9)  lookat (0, 0, 0)  fov_axis 40deg } -> unknown_field -> camera { eye (0, 0, 9)  lookat (0, 0, 0)  fov 40deg }
    camera { eye (0, 0, 9)  lookat (0, 0, 0)  angle 90deg } -> unknown_field -> camera { eye (0, 0, 9)  lookat (0, 0, 0)  hfov 90deg }
    camera { eye (0, 0, 9)  lookat (0, 0, 0)  angle 90 } -> unknown_field -> camera { eye (0, 0, 9)  lookat (0, 0, 0)  hfov 90deg }
    camera { eye (0, 0, 9)  lookat (0, 0, 0)  fov 40 } -> bare_angle -> camera { eye (0, 0, 9)  lookat (0, 0, 0)  fov 40deg }
    camera { eye (0, 0, 9)  lookat (0, 0, 0)  fov 40deg  hfov 60deg } -> conflicting_fields -> camera { eye (0, 0, 9)  lookat (0, 0, 0)  fov 40deg }
    camera { eye (0, 0, 9)  lookat (0, 0, 0)  roll pi / 2 } -> bare_angle -> camera { eye (0, 0, 9)  lookat (0, 0, 0)  roll pi / 2 * 1rad }
    sampler { method stratified } -> unknown_method -> sampler { method jittered }
    sampler { method grid } -> unknown_method -> sampler { method regular }
    sampler { method latin_hypercube } -> unknown_method -> sampler { method n_rooks }
    sampler { method monte_carlo } -> unknown_method -> sampler { method random }
    checkerboard { square (1, 1) } -> wrong_type -> checkerboard { square 1 }
    triangle { centroid (0, 0, 0)  normal (0, 0, 1)  sides (3, 4) } -> part_count -> triangle { centroid (0, 0, 0)  normal (0, 0, 1)  sides (3, 4, 4) }
    box { min (-15, 0, -15)  max (15, -1, 15) } -> empty_box -> box { min (-15, -1, -15)  max (15, 0, 15) }
    sphere { center (0, 0, 0)  color (0.5, 0.5, 0) } -> wrong_type -> sphere { center (0, 0, 0)  color rgb(128, 128, 0) }
    sphere { center (0, 0, 0)  color (128, 128, 0) } -> wrong_type -> sphere { center (0, 0, 0)  color rgb(128, 128, 0) }
    sphere { center (0, 0, 0)  color (255, 0, 0, 1) } -> wrong_type -> sphere { center (0, 0, 0)  color rgb(255, 0, 0) }
    sphere { center (0, 0,5, 8) } -> part_count -> sphere { center (0, 0.5, 8) }
    let a = cos(pi/4)\ncheckerboard {} -> bare_angle -> let a = cos(pi/4 * 1rad)\ncheckerboard {}
    let b = (0, 1, 0)\nsphere { center b + 1 } -> operand_types -> let b = (0, 1, 0)\nsphere { center b + (1, 1, 1) }
"#;

#[test]
fn what_people_write_is_understood() {
    let mut trial = Trial::default();
    for [written, expected, right] in rows(ROWS) {
        let mut text = of_scene(written);
        assert_eq!(codes(&text, &[]).join(" "), expected, "{text}");
        trial.type_in(&sources(&text), |_, _| true);
        // One fix at a time: it moves the others.
        let fix = |text: &str| {
            found(text, &[])
                .into_iter()
                .find_map(|d| d.fixes.into_iter().next())
        };
        while let Some(fix) = fix(&text) {
            text = apply(&fix, SourceId::File, &text);
        }
        let right = if right.is_empty() { written } else { right };
        assert_eq!(text, of_scene(right), "{written}");
        let has_error = found(&text, &[]).iter().any(|d| d.is_error());
        assert!(!has_error || right == written, "{text}");
    }
    trial.ends_with_more_than(50);
}

/// Whole files of other programs.
#[test]
fn a_file_of_another_program_is_one_mistake() {
    for text in [
        "{ \"camera\": { \"eye\": [0, 2, 8] },\n  \"objects\": [ { \"sphere\": 1 } ] }",
        "camera:\n  eye: [0, 2, 8]\n  lookat: [0, 1, 0]\nspheres:\n  - center: [0, 1, 0]\n",
        "#version 3.7;\n#include \"colors.inc\"\ncamera { location <0, 2, -3> look_at <0, 1, 2> }\nlight_source { <2, 4, -3> color White }\nsphere { <0, 1, 2>, 2 texture { pigment { color Yellow } } }\n",
        "LookAt 3 4 1.5  0 0 0  0 0 1\nCamera \"perspective\" \"float fov\" 45\nWorldBegin\nShape \"sphere\" \"float radius\" 1\n",
        "<?xml version=\"1.0\"?>\n<scene><sphere radius=\"2\"/></scene>\n",
    ] {
        assert_eq!(codes(text, &[]), ["foreign_file"], "{text}");
    }
}

/// Ten thousand commas in a block are one mistake.
#[test]
fn a_slip_that_goes_through_a_block_is_reported_once() {
    let fields = "radius 1,\n".repeat(10_000);
    let text = of_scene(&format!("sphere {{ center (0, 1, 0),\n{fields} }}"));
    let codes = codes(&text, &[]).into_iter();
    assert_eq!(codes.filter(|code| code == "needless_separator").count(), 1);
}
