//! Tests of `pinhole sheet`: the position of each picture, and refused arguments.

use super::*;

/// Returns a folder with three scenes: `a.scn`; `b.scn`, which has another size; and `wrong.scn`,
/// which has errors.
fn folder_with_more_scenes() -> Folder {
    let folder = folder();
    folder.write(
        "b.scn",
        "image { width 30 height 40 } camera { eye (0, 0, 5) lookat (0, 0, 0) } sphere S { center (0, 0, 0) }",
    );
    folder.write("wrong.scn", "sphere {}");
    folder
}

#[test]
fn each_picture_of_a_sheet_equals_the_render_of_its_scene() {
    let folder = folder_with_more_scenes();
    let open = |name: &str| {
        let picture = image::load_from_memory(&folder.read(name));
        picture.unwrap().to_rgb8()
    };
    folder.done("sheet a.scn b.scn a.scn --columns 2 -o sheet.png");
    folder.done("render a.scn");
    folder.done("render b.scn");
    let (sheet, a, b) = (open("sheet.png"), open("a.png"), open("b.png"));
    let width = a.width().max(30);
    let rows = [a.height().max(40), a.height()];
    let size = (
        12 + 2 * (width + 12),
        12 + rows[0] + rows[1] + 2 * (22 + 12),
    );
    assert_eq!(sheet.dimensions(), size);
    let below = 12 + rows[0] + 22 + 12;
    for (picture, x, y) in [(&a, 12, 12), (&b, 24 + width, 12), (&a, 12, below)] {
        let (w, h) = picture.dimensions();
        let part = image::imageops::crop_imm(&sheet, x, y, w, h).to_image();
        assert!(part == *picture, "at {x}, {y}");
        // The name of the picture is printed below it, so there are dark pixels.
        let name = image::imageops::crop_imm(&sheet, x, y + h, 20, 20).to_image();
        assert!(name.pixels().any(|pixel| pixel.0[0] < 99), "at {x}, {y}");
    }
    // The scene's warning is printed only once, although a sweep reads the scene several times.
    folder.write(
        "w.scn",
        "camera { eye (0, 0, 5) lookat (0, 0, 0) } sphere Far { center (99, 0, 0) } sphere for i < 1 { center (0, 0, 0) }",
    );
    let said = folder.run("sheet w.scn --sweep camera.eye=(0,0,5)..(0,0,6)/3 -o x.png");
    let told = said
        .errors
        .matches("warning[pinhole::unused_index]")
        .count();
    assert_eq!((said.status, told), (0, 1), "{}", said.errors);
    // Only `check` warns of objects outside of the picture. If other commands did, a sweep that
    // moves the camera past objects would print the warning for every scene.
    for (command, told) in [("check", 1), ("render", 0), ("inspect", 0), ("probe", 0)] {
        let rest = if command == "probe" { " 1 1" } else { "" };
        let said = folder.run(&format!("{command} w.scn{rest}"));
        let found = said.errors.matches("pinhole::outside_picture").count();
        assert_eq!(found.min(1), told, "{command}: {}", said.errors);
    }
    // A sheet of sweeps of two scenes shows the scenes' names in captions. In this sheet, the
    // pictures in both rows are equal, but their captions differ.
    folder.write("other.scn", folder.read("b.scn"));
    folder.done("sheet b.scn other.scn --columns 2 --sweep S.radius=1..2/2 -o rows.png");
    let rows = open("rows.png");
    let row = |y, height| image::imageops::crop_imm(&rows, 12, y, 30, height).to_image();
    assert!(row(12, 40) == row(86, 40) && row(52, 22) != row(126, 22));
    // Below a picture one pixel wide, the sheet has no room for any letter of the picture's name.
    // The margins around the picture keep their size.
    folder.done("sheet b.scn --set image.width=1 --set image.height=1 -o dot.png");
    assert_eq!(open("dot.png").dimensions(), (25, 47));
    // With `--width`, each picture of the sweep is equal to the picture of a scene with that width.
    folder.done("sheet b.scn --width 20 --sweep S.center=(0,0,0)..(1,2,0)/3 -o swept.png");
    let swept = open("swept.png");
    for (i, x, y) in [
        ("(0,0,0)", 12, 12),
        ("(0.5,1,0)", 39, 12),
        ("(1,2,0)", 12, 66),
    ] {
        folder.done(&format!(
            "render b.scn -o c.png --set image.width=15 --set image.height=20 --set S.center={i}"
        ));
        let part = image::imageops::crop_imm(&swept, x, y, 15, 20).to_image();
        assert!(part == open("c.png"), "{i}");
    }
}

#[test]
fn invalid_sheet_arguments_are_refused_and_nothing_is_written() {
    let folder = folder_with_more_scenes();
    let before = folder.names();
    for (line, status, words) in [
        ("sheet a.scn", 2, "--output"),
        ("sheet a.scn -o a.jpg", 2, "should end in .png"),
        ("sheet a.scn -o a.scn", 2, "should end in .png"),
        ("sheet a.scn missing.scn -o x.png", 2, "missing.scn"),
        ("sheet a.scn wrong.scn -o x.png", 1, "missing_camera"),
        ("sheet - - -o x.png", 2, "twice"),
        ("sheet b.scn -o x.png --columns 0", 2, "--columns"),
        (
            "sheet b.scn -o x.png --sweep S.radius=1",
            2,
            "TARGET=FROM..TO/N",
        ),
        (
            "sheet b.scn -o x.png --sweep S.radius=1../3",
            2,
            "TARGET=FROM..TO/N",
        ),
        (
            "sheet b.scn -o x.png --sweep S.radius=1..2/1",
            2,
            "from 2 to 1000",
        ),
        (
            "sheet b.scn -o x.png --sweep S.radius=1..-2/3",
            1,
            "--sweep:1:10",
        ),
        (
            "sheet b.scn -o x.png --sweep S.color=red..blue/3",
            2,
            "nothing between",
        ),
        (
            "sheet b.scn -o x.png --sweep sampler.per_pixel=1..6/3",
            1,
            "3.5",
        ),
    ] {
        let said = folder.run(line);
        assert_eq!(said.status, status, "{line}: {}", said.errors);
        assert!(said.errors.contains(words), "{line}: {}", said.errors);
        assert_eq!(folder.names(), before, "{line}");
    }
}
