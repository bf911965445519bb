//! What scenes mean, and the language's reference, held against the program.

use std::{fs, path::Path};

use glam::DVec3;
use pinhole::{
    color::Color,
    scene::{
        self, Camera, Checkerboard, Count, Cuboid, Lens, Method, Scene, Shape, Sphere, Triangle,
        View, schema,
    },
    source::{Source, Sources},
};
use proptest::{
    collection::vec,
    prelude::*,
    sample::{select, subsequence},
};

const CAMERA: &str = "camera { eye (0, 2, 8) lookat (0, 1, 0) }\n";

fn sources(text: &str) -> Sources {
    Sources::new(Source::from_text("test.scn", text))
}

/// The codes of a scene's diagnostics, without `pinhole::`.
fn codes(text: &str) -> Vec<String> {
    let found = scene::read(&sources(text)).diagnostics;
    let code = |code: String| code.replace("pinhole::", "");
    found
        .into_iter()
        .map(|diagnostic| code(diagnostic.code))
        .collect()
}

/// A scene without errors; its warnings may be some.
fn read(text: &str) -> Scene {
    let reading = scene::read(&sources(text));
    let found = &reading.diagnostics;
    reading.scene.unwrap_or_else(|| panic!("{found:#?}"))
}

/// The camera of a scene with one sphere.
fn camera(fields: &str) -> Camera {
    read(&format!(
        "camera {{ {fields} }} sphere {{ center (0, 0, 0) }}"
    ))
    .camera
}

/// The x of a sphere's center: what an expression is.
fn number(expression: &str) -> f64 {
    let scene = read(&format!(
        "{CAMERA} sphere {{ center ({expression}, 0, 0) }}"
    ));
    match scene.objects[0].shape {
        Shape::Sphere(Sphere { center, .. }) => center.x,
        _ => unreachable!(),
    }
}

fn color(expression: &str) -> Color {
    let scene = read(&format!(
        "{CAMERA} sphere {{ center (0, 0, 0) color {expression} }}"
    ));
    match scene.objects[0].shape {
        Shape::Sphere(Sphere { color, .. }) => color,
        _ => unreachable!(),
    }
}

fn file(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
    fs::read_to_string(path).expect("the file can be read")
}

#[test]
fn the_reference_has_every_row_of_the_table() {
    let reference = file("grammar/language.md");
    let mut block = String::new();
    let mut rows = Vec::new();
    for line in reference.lines().filter(|line| line.starts_with('|')) {
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        if let [kind, field, takes, preset, must] = cells[..] {
            if !kind.is_empty() {
                block = kind.to_owned();
            }
            rows.push((block.clone(), field, takes, preset, must));
        }
    }
    let mut fields = 0;
    for kind in schema::BLOCKS {
        for field in kind.fields {
            fields += 1;
            let place = format!("{}.{}", kind.name, field.name);
            let row = rows
                .iter()
                .find(|row| row.0 == kind.name && row.1 == field.name);
            let &(_, _, takes, preset, must) = row.unwrap_or_else(|| panic!("no row {place}"));
            let noun = field.takes.noun();
            let takes_noun = noun.trim_start_matches("a ").trim_start_matches("an ");
            assert_eq!(takes, takes_noun, "{place}");
            match field.preset {
                schema::Preset::Value(value) => assert_eq!(preset, value.to_string(), "{place}"),
                schema::Preset::Required => assert_eq!(preset, "required", "{place}"),
                schema::Preset::Nothing => assert_eq!(preset, "none", "{place}"),
                schema::Preset::Alternative => {
                    for other in field.excludes {
                        assert!(preset.contains(other) || must.contains(other), "{place}");
                    }
                }
            }
            for condition in field.must {
                assert!(
                    must.contains(&condition.to_string()),
                    "{place}: {condition}"
                );
            }
            if field.preset != schema::Preset::Alternative && !field.excludes.is_empty() {
                let excludes = format!("not with {}", field.excludes.join(", "));
                assert!(must.contains(&excludes), "{place}: {excludes}");
            }
        }
        for together in kind.together {
            assert!(reference.contains(together), "{together}");
        }
    }
    let header_and_rule = 2;
    assert_eq!(rows.len(), fields + header_and_rule);
}

#[test]
fn the_reference_has_every_method_function_and_name() {
    let reference = file("grammar/language.md");
    for (method, _) in schema::METHODS {
        assert!(reference.contains(&format!("| {} |", method.name())));
    }
    for function in schema::FUNCTIONS {
        assert!(
            reference.contains(&format!("`{}", function.name)),
            "{}",
            function.name
        );
    }
    for (name, _) in schema::CONSTANTS {
        assert!(reference.contains(&format!("`{name}`")));
    }
}

#[test]
fn every_scene_of_the_reference_checks_clean() {
    let reference = file("grammar/language.md");
    let mut scenes = 0;
    for part in reference.split("```scn\n").skip(1) {
        let scene = part.split("```").next().expect("a part");
        assert_eq!(codes(scene), [""; 0], "{scene}");
        scenes += 1;
    }
    assert!(scenes >= 4);
}

#[test]
fn defaults() {
    let scene = read(&format!(
        "{CAMERA} sphere {{ center (0, 1, 0) }} checkerboard {{}} \
        box {{ center (0, 0, 0) }} triangle {{ centroid (0, 0, 0) normal (0, 0, 3) }}"
    ));
    assert_eq!((scene.image.width, scene.image.height), (800, 450));
    assert_eq!(scene.image.background, Color::BLACK);
    assert_eq!(scene.sampler.method, Method::MultiJittered);
    assert_eq!(scene.sampler.count, Count::PerPixel(16));
    assert_eq!(scene.camera.lens, Lens::Distance(2.0));
    assert_eq!(scene.camera.up, DVec3::Y);
    assert_eq!((scene.camera.near, scene.camera.far), (0.0, None));
    let [sphere, board, cuboid, triangle] = &scene.objects[..] else {
        panic!("{scene:?}");
    };
    let olive = Color::from_bytes([128, 128, 0]);
    assert_eq!(
        sphere.shape,
        Shape::Sphere(Sphere {
            center: DVec3::Y,
            radius: 1.0,
            color: olive
        })
    );
    let gray = Color::from_bytes([128; 3]);
    let white = Color::from_bytes([255; 3]);
    assert_eq!(
        board.shape,
        Shape::Checkerboard(Checkerboard {
            y: 0.0,
            square: 1.0,
            colors: [gray, white]
        })
    );
    let half = DVec3::new(0.25, 0.75, 1.0);
    let orange = Color::from_bytes([255, 165, 0]);
    assert_eq!(
        cuboid.shape,
        Shape::Box(Cuboid {
            min: -half,
            max: half,
            color: orange
        })
    );
    let Shape::Triangle(Triangle { sides, normal, .. }) = triangle.shape else {
        panic!("{triangle:?}");
    };
    assert_eq!((sides, normal), (DVec3::new(2.0, 2.0, 1.0), DVec3::Z * 3.0));
}

#[test]
fn numbers() {
    for (text, value) in [
        ("2", 2.0),
        (".5", 0.5),
        ("5.", 5.0),
        ("1e-3", 1e-3),
        ("1E+2", 100.0),
        ("1_000_000", 1e6),
        ("1_0.0_1e1_0", 10.01e10),
        ("5e-324", 5e-324),
        ("1.7976931348623157e308", f64::MAX),
        ("0.1", 0.1),
    ] {
        assert_eq!(number(text), value, "{text}");
    }
    for text in [
        "1__0", "_1", "1_", "1_.5", "1._5", "1e_5", "1.2.3", "0x1", "2e", "1e400",
    ] {
        let scene = format!("{CAMERA} sphere {{ center ({text}, 0, 0) }}");
        assert_eq!(codes(&scene).len(), 1, "{text}: {:?}", codes(&scene));
    }
}

#[test]
fn operators() {
    for (text, value) in [
        ("2 + 3 * 4", 14.0),
        ("(2 + 3) * 4", 20.0),
        ("2 - 3 - 4", -5.0),
        ("24 / 4 / 2", 3.0),
        ("-2 * -3", 6.0),
        ("--2", 2.0),
        ("2 - -2", 4.0),
        ("-(1 + 2)", -3.0),
        ("1 -1", 0.0),
        ("90deg / 30deg", 3.0),
        ("1rad / 1rad", 1.0),
        ("30 * deg / deg", 30.0),
        ("min(3, 1, 2) + max(1, 2)", 3.0),
        ("abs(-2)", 2.0),
        ("sqrt(2) * sqrt(2) - 2", 4.440892098500626e-16),
        ("length((3, 4, 0))", 5.0),
        ("dot((1, 2, 3), (4, 5, 6))", 32.0),
        ("length(cross((1, 0, 0), (0, 1, 0)) - (0, 0, 1))", 0.0),
        ("length(normalize((0, 0, 9)) - (0, 0, 1))", 0.0),
        ("sin(30deg)", 0.5),
        ("cos(90deg)", 0.0),
        ("sin(360000000000180deg)", 0.0),
        ("tan(45deg)", 1.0),
        ("sin(asin(0.5))", 0.5),
        ("pi", std::f64::consts::PI),
        ("atan2(0, 1) / 1rad", 0.0),
        ("1/3", 1.0 / 3.0),
    ] {
        assert_eq!(number(text), value, "{text}");
    }
    for text in [
        "1/0",
        "0/0",
        "sqrt(-1)",
        "asin(2)",
        "tan(90deg)",
        "tan(-270deg)",
        "1e200 * 1e200",
        "1 + red",
        "1 + 1deg",
        "1deg * 1deg",
        "1 / 1deg",
        "30deg",
        "(1, 2, 3)",
        "red",
        "-red",
        "length(normalize((0, 0, 0)))",
        "min(1)",
        "sin(1)",
        "sin",
        "nothing",
        "foo(1)",
        "1deg / 0deg",
    ] {
        let scene = format!("{CAMERA} sphere {{ center ({text}, 0, 0) }}");
        assert_eq!(codes(&scene).len(), 1, "{text}: {:?}", codes(&scene));
    }
}

#[test]
fn colours() {
    let orange = Color::from_bytes([255, 165, 0]);
    for text in [
        "orange",
        "ORANGE",
        "#ffa500",
        "#FFA500",
        "rgb(255, 165, 0)",
        "(orange)",
    ] {
        assert_eq!(color(text), orange, "{text}");
    }
    assert_eq!(color("#fa0"), Color::from_bytes([255, 170, 0]));
    assert_eq!(color("rgb(0.5, 1/3, 0)").srgb, [0.5, 1.0 / 3.0, 0.0]);
    assert_eq!(color("grey"), color("gray"));
    for text in [
        "transparent",
        "#ff",
        "#ffff",
        "rgb(256, 0, 0)",
        "rgb(0, -1, 0)",
        "(1, 2, 3)",
        "rgb(1, 2)",
    ] {
        let scene = format!("{CAMERA} sphere {{ center (0, 0, 0) color {text} }}");
        assert_eq!(codes(&scene).len(), 1, "{text}");
    }
}

#[test]
fn text() {
    let scene = "\u{feff}camera{eye(0,2,8)lookat(0,1,0)}sphere{center(0,1,0)}";
    assert_eq!(codes(scene), [""; 0]);
    let scene = "// a\r\ncamera/* { */{\r\n\teye (0, 2, 8) // (\r\n lookat (0, 1, 0) }/**/sphere\nBall\n{center(0,1,0)}//";
    assert_eq!(codes(scene), [""; 0]);
    assert_eq!(
        codes("/* camera */ // */"),
        ["missing_camera", "no_objects"]
    );
}

#[test]
fn a_kind_may_stand_in_the_line_of_a_value() {
    let ball = "{ center (0, 1, 0) }";
    for scene in [
        "let a = 2 sphere\nB",
        "let a = 2 sphere B",
        "let a = 2\nsphere\nB",
        "let b = 2 let a = b\nsphere",
        "let b = 2 let a = b sphere",
        "let b = 2 let a = b sphere\nbox",
        "let sphere = 2 let a = sphere\nsphere",
        "let sphere = 2 let a = sphere sphere\nsphere",
    ] {
        assert_eq!(
            codes(&format!("{CAMERA}{scene} {ball}")),
            [""; 0],
            "{scene}"
        );
    }
    // Here the text is wrong, and the word is the rest of the value.
    for scene in ["let a = 2 pi\nsphere", "let b = 2 let a = 2 b\nsphere"] {
        let found = codes(&format!("{CAMERA}{scene} {ball}"));
        assert_eq!(found, ["missing_operator"], "{scene}");
    }
    // Neither word is a kind: that is one mistake, not two.
    assert_eq!(
        codes(&format!("{CAMERA}let a = 2 spere\nB {ball}")),
        ["unknown_kind"]
    );
}

proptest! {
    /// White space separates, and otherwise means nothing.
    #[test]
    fn white_space_means_nothing_else(items in shuffled_items(), gaps in vec(gap(), 40)) {
        let plain = items.join(" ");
        let mut text = String::new();
        for (token, gap) in plain.split(' ').zip(gaps.iter().cycle()) {
            text += token;
            // Or else a comment would start with the sign.
            text += if token == "/" { " " } else { "" };
            text += gap;
        }
        prop_assert_eq!(codes(&plain), [""; 0], "{}", plain);
        prop_assert_eq!(codes(&text), [""; 0], "{}", text);
    }
}

fn gap() -> impl Strategy<Value = &'static str> {
    select(vec![
        " ",
        " ",
        "  ",
        "\n",
        "\r\n",
        "\t",
        "\n\n",
        "/**/",
        " /* a\n */ ",
        " // b\n",
    ])
}

/// Items of which a scene can be made in any order. Their names are often those of kinds, and the values of the definitions
/// end in every way that there is.
fn shuffled_items() -> impl Strategy<Value = Vec<&'static str>> {
    let items = vec![
        "let a = 2",
        "let b = 2 * pi",
        "let c = - pi",
        "let d = ( 1 + 2 )",
        "let e = max ( 1 , 2 )",
        "let f = 30deg let g = f let h = - g",
        "let i = #fa0",
        "let j = olive",
        "let sphere = 2 let k = sphere",
        "let box = ( 1 , 2 , 3 ) let camera = box",
        "let radius = 1 let method = radius",
        "image { width 64 height 36 background #000 }",
        "sampler { method sobol per_pixel 4 seed 7 }",
        "sphere { center ( 0 , 1 , 0 ) }",
        "sphere Ball { radius max ( 1 , 2 ) center - ( 0 , 1 , 0 ) color red }",
        "box sphere { min ( 0 , 0 , 0 ) max ( 1 , 1 , 1 ) }",
        "box Crate { center ( 0 , 0 , - 1 ) color gray }",
        "checkerboard box { colors ( gray , white ) y - 1 }",
        "triangle triangle { centroid ( 0 , 1 , 0 ) normal ( 0 , 0 , 1 ) spin 30deg * 2 }",
        "triangle { normal ( 0 , 0 , 1 ) centroid ( 0 , 1 , 0 ) / 2 sides ( 1 , 1 , 1 ) }",
    ];
    let camera = "camera { eye ( 0 , 2 , 8 ) lookat ( 0 , 1 , 0 ) fov 40deg }";
    subsequence(items, 1..20)
        .prop_map(move |mut items| {
            items.push(camera);
            items.push("sphere C { center ( 0 , 1 , 0 ) }");
            items
        })
        .prop_shuffle()
}

#[test]
fn names_are_known_by_their_place() {
    let scene = "let radius = 2 let camera = (0, 2, 8) let sphere = (0, 1, 0) let jittered = 3
        camera { eye camera lookat sphere } sampler { method jittered per_pixel jittered }
        sphere sphere { center sphere radius radius }
        box min { min (0, 0, 0) max (min(1, 2), max(1, 2), 1) }";
    assert_eq!(codes(scene), [""; 0]);
}

#[test]
fn nesting() {
    let ends = |open: &str, inner: &str, close: &str, depth: usize| {
        let value = format!("{}{inner}{}", open.repeat(depth), close.repeat(depth));
        codes(&format!(
            "{CAMERA} sphere {{ center (0, 0, 0) }} let a = {value}"
        ))
    };
    for (open, inner, close) in [
        ("(", "1", ")"),
        ("-", "1", ""),
        ("abs(", "1", ")"),
        ("- ", "(1)", ""),
    ] {
        let levels = 256 - inner.matches('(').count();
        assert_eq!(ends(open, inner, close, levels), [""; 0], "{open}");
        assert_eq!(ends(open, inner, close, levels + 1), ["too_deep"], "{open}");
    }
    // Two levels at a time, and as the value of a field, where the first minus follows a name.
    let field = |signs: usize| {
        codes(&format!(
            "{CAMERA} sphere {{ center (0, 0, 0) radius {}1 }}",
            "-".repeat(signs)
        ))
    };
    assert_eq!(field(256), [""; 0]);
    assert_eq!(field(258), ["too_deep"]);
    assert_eq!(ends("-(", "1", ")", 128), [""; 0]);
    assert_eq!(ends("-(", "1", ")", 129), ["too_deep"]);
    // What stands beside does not add up.
    let wide = vec!["-(1)"; 5000].join(" + ");
    assert_eq!(
        codes(&format!(
            "{CAMERA} sphere {{ center (0, 0, 0) }} let a = {wide}"
        )),
        [""; 0]
    );
}

#[test]
fn alternatives() {
    assert_eq!(
        camera("eye (0, 0, 1) direction (0, 0, -1)").view,
        View::Direction(DVec3::NEG_Z)
    );
    assert_eq!(
        camera("eye (0, 0, 1) lookat (0, 0, 0)").view,
        View::Lookat(DVec3::ZERO)
    );
    assert!(matches!(
        camera("eye (0, 0, 1) lookat (0, 0, 0) fov 40deg").lens,
        Lens::Fov(_)
    ));
    let scene = |fields: &str| format!("{CAMERA} box {{ {fields} }}");
    assert_eq!(codes(&scene("min (0, 0, 0) max (1, 1, 1)")), [""; 0]);
    for fields in [
        "min (0, 0, 0)",
        "size (1, 1, 1)",
        "",
        "min (0, 0, 0) size (1, 1, 1)",
    ] {
        assert!(!codes(&scene(fields)).is_empty(), "{fields}");
    }
}

#[test]
fn conditions_hold_at_their_bounds() {
    let ok = |text: &str| {
        let found = codes(&format!("{text} sphere {{ center (0, 0, 0) }}"));
        assert_eq!(found, [""; 0], "{text}");
    };
    let bad = |text: &str| {
        let found = codes(&format!("{text} sphere {{ center (0, 0, 0) }}"));
        assert_eq!(found.len(), 1, "{text}: {found:?}");
    };
    ok(&format!("{CAMERA} image {{ width 1048576 height 1 }}"));
    bad(&format!("{CAMERA} image {{ width 1048577 height 1 }}"));
    bad(&format!("{CAMERA} image {{ width 0 }}"));
    ok(&format!(
        "{CAMERA} image {{ width 1048576 height 1048576 }} sampler {{ per_pixel 8192 }}"
    ));
    bad(&format!(
        "{CAMERA} image {{ width 1048576 height 1048576 }} sampler {{ per_pixel 8193 }}"
    ));
    ok(&format!("{CAMERA} sampler {{ total 9007199254740992 }}"));
    bad(&format!("{CAMERA} sampler {{ total 9007199254740994 }}"));
    ok(&format!("{CAMERA} sampler {{ seed 9007199254740991 }}"));
    bad(&format!("{CAMERA} sampler {{ seed 9007199254740992 }}"));
    ok("camera { eye (0, 0, 1) lookat (0, 0, 0) fov 3.141592653589793rad }");
    bad("camera { eye (0, 0, 1) lookat (0, 0, 0) fov 3.1415926535897936rad }");
    bad("camera { eye (0, 0, 1) lookat (0, 0, 0) fov 180deg }");
    bad("camera { eye (0, 0, 1) lookat (0, 0, 0) fov 0deg }");
    ok("camera { eye (0, 0, 1) lookat (0, 0, 0) near 0 far 5e-324 }");
    bad("camera { eye (0, 0, 1) lookat (0, 0, 0) far 0 }");
    bad("camera { eye (0, 0, 1) lookat (0, 0, 0) near 2 far 2 }");
    bad("camera { eye (0, -0, 1) lookat (0, 0, 1) }");
    ok(&format!(
        "{CAMERA} triangle {{ centroid (0, 0, 0) normal (0, 0, 1e-300) sides (1, 2, 2.9999999999999996) }}"
    ));
    bad(&format!(
        "{CAMERA} triangle {{ centroid (0, 0, 0) normal (0, 0, 1) sides (1, 2, 3) }}"
    ));
    ok(&format!(
        "{CAMERA} triangle {{ centroid (0, 0, 0) normal (0, 0, 1) sides (1, 5e-17, 1) }}"
    ));
}

#[test]
fn up_along_the_view_is_a_warning_exactly_where_it_is() {
    let camera = |fields: &str| {
        codes(&format!(
            "camera {{ {fields} }} sphere {{ center (0, 0, 0) }}"
        ))
    };
    assert_eq!(
        camera("eye (0.1, 8, 0.3) lookat (0.1, -0.7, 0.3)"),
        ["up_parallel"]
    );
    assert_eq!(
        camera("eye (0.1, 8, 0.3) lookat (0.10000000000000002, -0.7, 0.3)"),
        [""; 0]
    );
    assert_eq!(
        camera("eye (0, 8, 0) direction (1, 2, 3) up (-2, -4, -6)"),
        ["up_parallel"]
    );
    assert_eq!(camera("eye (0, 0, 0) lookat (1e-300, 1e300, 0)"), [""; 0]);
    let help = |fields: &str| {
        let text = format!("camera {{ {fields} }} sphere {{ center (0, 0, 0) }}");
        let found = scene::read(&sources(&text)).diagnostics;
        found[0].help.clone().expect("a help")
    };
    for (fields, top, up) in [
        ("direction (0, -1, 0)", "−z", "(0, 0, -1)"),
        ("direction (0, 1, 0)", "+z", "(0, 0, 1)"),
        ("direction (0, -1, 0) up (0, -1, 0)", "+z", "(0, 0, 1)"),
        ("direction (0, 1, 0) up (0, -1, 0)", "−z", "(0, 0, -1)"),
        ("direction (0, 0, -1) up (0, 0, 1)", "+y", "(0, 1, 0)"),
        ("direction (-1, 0, 0) up (1, 0, 0)", "−z", "(0, 0, -1)"),
        ("direction (0, -1, 0) up (0, 1e300, 0)", "−z", "(0, 0, -1)"),
    ] {
        let help = help(&format!("eye (0, 0, 0) {fields}"));
        assert!(help.contains(top) && help.contains(up), "{fields}: {help}");
    }
}

#[test]
fn a_box_is_rounded_once() {
    let scene = read(&format!(
        "{CAMERA} box {{ center (0.1, 0.2, 0.3) size (0.7, 0.1, 1e-3) }}"
    ));
    let Shape::Box(Cuboid { min, max, .. }) = scene.objects[0].shape else {
        panic!("{scene:?}");
    };
    assert_eq!(min, DVec3::new(0.1 - 0.35, 0.2 - 0.05, 0.3 - 0.0005));
    assert_eq!(max, DVec3::new(0.1 + 0.35, 0.2 + 0.05, 0.3 + 0.0005));
}

#[test]
fn one_mistake_gives_one_report() {
    for (text, expected) in [
        (
            "let r = nothing sphere { center (0, r, 0) radius r + 1 }",
            "unknown_name",
        ),
        (
            "let r = 1/0 let s = r + red sphere { center (0, 0, 0) radius s }",
            "not_finite",
        ),
        ("sphere { cneter (0, 0, 0) }", "unknown_field"),
        ("cube { center (0, 0, 0) size (1, 1, 1) }", "unknown_kind"),
        ("sphere { center (0, 0, 0 }", "unclosed_parenthesis"),
        ("sphere { center (0, 0, 0) radius 2 ", "unclosed_block"),
        ("sphere { center (0, 0, 0) color \"red\" }", "quoted"),
        ("sphere { center (0, 0) }", "part_count"),
        ("sphere { center (1 2 3) }", "missing_comma"),
    ] {
        assert_eq!(codes(&format!("{CAMERA} {text}")), [expected], "{text}");
    }
}

#[test]
fn all_mistakes_are_reported_in_the_order_of_the_text() {
    let text = "camera { eye (0, 2, 8) lookat (0, 1, 0) rol 3deg }
        sphere { center (0, 1, 0), radius -1 }
        let a = 1 + red
        triangle { centroid (0, 0, 0) normal (0, 0 1) color olvie }
        sphere { radius 2 }";
    assert_eq!(
        codes(text),
        [
            "unknown_field",
            "needless_separator",
            "out_of_range",
            "operand_types",
            "missing_comma",
            "unknown_color",
            "missing_field"
        ]
    );
}

/// The first diagnostic of a scene: its message, the text and the words of its first label, and its help.
fn first(text: &str) -> [String; 4] {
    let sources = sources(text);
    let found = scene::read(&sources).diagnostics.swap_remove(0);
    let label = &found.labels[0];
    let under = sources.text(label.span).to_owned();
    [
        found.message,
        under,
        label.message.clone(),
        found.help.unwrap_or_default(),
    ]
}

#[test]
fn angles_of_degrees_and_radians_are_compared_exactly() {
    let view = |fov: &str| {
        codes(&format!(
            "camera {{ eye (0, 2, 8) lookat (0, 1, 0) fov {fov} }} sphere {{ center (0, 0, 0) }}"
        ))
    };
    for fov in [
        "179deg + 0.017453292519943295rad",
        "1e-20deg + 3.141592653589793rad",
        "1deg - 0.017453292519943295rad",
        "3.141592653589793rad",
        "180deg - 1e-300rad",
    ] {
        assert!(view(fov).is_empty(), "{fov}");
    }
    for fov in [
        "1e-10deg + 3.141592653589793rad",
        "1deg - 0.0174532925199433rad",
        "3.1415926535897936rad",
        "180deg + 1e-300rad",
        "180deg + 1rad - 1rad",
    ] {
        assert_eq!(view(fov), ["out_of_range"], "{fov}");
    }
}

#[test]
fn digits_that_decide_are_shown() {
    let sphere = "sphere { center (0, 0, 0) }";
    let camera = "camera { eye (0, 2, 8) lookat (0, 1, 0)";
    for (text, part) in [
        (
            format!("{camera} near 5.0000001 far 5 }} {sphere}"),
            "exchange them: `near 5  far 5.0000001`",
        ),
        (
            format!(
                "{CAMERA} triangle {{ centroid (0, 0, 0) normal (0, 0, 1) sides (0.1, 0.2, 0.30000000000000004) }}"
            ),
            "0.30000000000000004 is not less than 0.1 + 0.2",
        ),
        (
            format!("{CAMERA} {sphere} image {{ width 9e5 + 0.1 }}"),
            "and it is 900000.1",
        ),
        (
            format!("{CAMERA} sphere {{ center (0, 0, 0) color rgb(255.0000001, 0, 0) }}"),
            "this is 255.0000001",
        ),
        (
            format!("{camera} fov 180.00000001deg + 0deg }} {sphere}"),
            "and it is 180.00000001deg",
        ),
        (
            format!("{CAMERA} {sphere} sampler {{ per_pixel 1e300 }}"),
            "1e300 samples in each of",
        ),
        (
            format!("{CAMERA} sphere {{ center (0, 0, 0) radius 1e-400 }}"),
            "and it is 1e-400, which rounds to 0",
        ),
    ] {
        let found = first(&text);
        assert!(found.iter().any(|words| words.contains(part)), "{found:?}");
        assert_eq!(codes(&text).len(), 1, "{text}");
    }
}

#[test]
fn ways_out_are_true() {
    let camera = |fields: &str| {
        format!("camera {{ eye (0, 2, 8) {fields} }} sphere S {{ center (0, 0, 0) }}")
    };
    for (text, help) in [
        (
            camera("direction (3, 3, 3) up (1, 1, 1)"),
            "the top of the picture is towards (-0.5, -0.5, 1) here; give another `up`, such as `up (-0.5, -0.5, 1)`, to say so yourself",
        ),
        (
            camera("direction (0, 0, 0)"),
            "write a vector that points somewhere, such as `(0, 0, -1)`",
        ),
        (
            camera("lookat S"),
            "an object is no value: define its place with `let`, and use that in both",
        ),
        (
            format!("{} let x = 3 - x", camera("lookat (0, 0, 0)")),
            "a `let` cannot use itself: write a value, or the name of an earlier `let`",
        ),
        (
            format!("{} let x = length(1, 2, 3)", camera("lookat (0, 0, 0)")),
            "write `length((1, 2, 3))`",
        ),
        (
            format!("{} let x = rgb((255, 0, 0))", camera("lookat (0, 0, 0)")),
            "write `rgb(255, 0, 0)`",
        ),
        (
            format!("{CAMERA} box {{ center (0, 0, 0) size (1, 2) }}"),
            "write a third number, such as `(1, 2, 1)`",
        ),
    ] {
        let found = first(&text);
        assert!(found[3].contains(help), "{found:?}");
        assert_eq!(codes(&text).len(), 1, "{text}");
    }
    let text = format!("{CAMERA} box {{ center (0, 0, 0) size (1, -2, 3) }}");
    assert_eq!(first(&text)[1..3], ["-2", "not above 0"]);
    let text = format!("{CAMERA} sphere {{ center (0, 0, 0) }} sampler {{ per_pixel 16 total 9 }}");
    assert_eq!(codes(&text), ["conflicting_fields"]);
    let text = camera("up (1e200, 0, 0) direction (1e200, 0, 0)");
    assert!(first(&text)[3].contains("+z here"), "{:?}", first(&text));
    assert_eq!(number("(atan2(sin(180deg), -1) / 1deg)"), 180.0);
}
