//! Tests of pictures that are rendered in parts, by `--shard` or `--crop`, and put together by
//! `merge`.

use super::*;
use crate::table::rows;

#[test]
fn parts_put_together_are_the_file_of_a_single_render() {
    let folder = folder();
    let settings = [
        "",
        "--set sampler.method=exact --set image.width=37 --set image.height=23",
        "--set image.height=9",
    ];
    for settings in settings {
        for ending in ["png", "exr"] {
            // An exact picture prints a note on its accuracy, so standard error need not be empty
            // here.
            let render = |line: &str| folder.told(&format!("render a.scn {line} {settings}"), 0);
            render(&format!("-o whole.{ending}"));
            for count in [1, 2, 3, 9] {
                let mut parts = String::new();
                for i in 1..=count {
                    render(&format!("-o {i}.{ending} --shard {i}/{count}"));
                    // The parts are given in reverse order: their order must not matter.
                    parts = format!("{i}.{ending} {parts}");
                }
                folder.done(&format!("merge {parts} -o merged.{ending}"));
                let is_same = folder.read(&format!("merged.{ending}"))
                    == folder.read(&format!("whole.{ending}"));
                assert!(is_same, "{count} parts, {ending}, {settings}");
            }
        }
    }
}

/// Merges crops of different heights that lie beside each other, so that a row of the whole picture
/// comes from several files.
#[test]
fn crops_count_as_parts() {
    let folder = folder();
    let crops = [
        "0,0,20,36",
        "20,0,44,5",
        "20,5,1,31",
        "21,5,43,30",
        "21,35,43,1",
    ];
    for ending in ["png", "exr"] {
        folder.done(&format!("render a.scn -o whole.{ending}"));
        for (i, crop) in crops.iter().enumerate() {
            folder.done(&format!("render a.scn -o {i}.{ending} --crop {crop}"));
        }
        let parts = (0..crops.len()).map(|i| format!("{i}.{ending} "));
        folder.done(&format!(
            "merge {} -o merged.{ending}",
            parts.collect::<String>()
        ));
        assert!(
            folder.read(&format!("merged.{ending}")) == folder.read(&format!("whole.{ending}"))
        );
    }
}

/// In a PNG file, `render` stores at most 1 MiB of text, and leaves out a longer scene. Even so,
/// `merge` must recognize parts of different scenes.
#[test]
fn parts_of_a_long_scene_are_put_together_without_its_text() {
    let folder = folder();
    let long = format!("{SCENE}// {}\n", "long ".repeat(1 << 18));
    folder.write("long.scn", &long);
    folder.write("other.scn", long.replace("(-1.6, h, 0)", "(-1.5, h, 0)"));
    let warned = |line: &str| {
        let told = folder.told(line, 0);
        assert!(
            told.starts_with("warning: the scene and its overrides have more"),
            "{told}"
        );
    };
    warned("render long.scn -o whole.png");
    for i in 1..=2 {
        warned(&format!("render long.scn -o {i}.png --shard {i}/2"));
        warned(&format!("render other.scn -o other{i}.png --shard {i}/2"));
    }
    folder.done("merge 1.png 2.png -o merged.png");
    assert!(folder.read("merged.png") == folder.read("whole.png"));
    let told = folder.told("merge 1.png other2.png -o mixed.png", 2);
    assert!(told.contains("are of different scenes"), "{told}");
}

#[test]
fn parts_that_do_not_fit_are_refused_by_name() {
    let folder = folder();
    folder.write("b.scn", SCENE.replace("4 seed 7", "4 seed 8"));
    for line in [
        "a.scn -o 1.png --shard 1/3",
        "a.scn -o 2.png --shard 2/3",
        "a.scn -o 3.png --shard 3/3",
        "a.scn -o half.png --shard 2/2",
        "a.scn -o right.png --crop 10,12,54,12",
        "a.scn -o 2.exr --shard 2/3",
        "a.scn -o whole.png",
        "b.scn -o b.png --shard 2/3",
        "a.scn -o set.png --shard 2/3 --set h=1",
        "a.scn -o wide.png --shard 2/3 --set image.width=65",
    ] {
        folder.done(&format!("render {line}"));
    }
    let cut = folder.read("2.png");
    folder.write("cut.png", &cut[..cut.len() - 60]);
    folder.write("head.png", &cut[..90]);
    let before = folder.names();
    for [line, about] in rows(
        "
        1.png 3.png -o x.png -> no part has the pixels 0,12,64,12 of the whole picture
        1.png right.png 3.png -o x.png -> no part has the pixels 0,12,10,12 of the whole picture
        1.png 2.png -o x.png -> no part has the pixels 0,24,64,12 of the whole picture
        2.png -o x.png -> no part has the pixels 0,0,64,12 of the whole picture
        1.png 2.png 2.png 3.png -o x.png -> 2.png and 2.png overlap: both have the pixels 0,12,64,12
        1.png 2.png half.png -o x.png -> 2.png and half.png overlap: both have the pixels 0,18,64,6
        1.png b.png 3.png -o x.png -> 1.png and b.png are of different scenes
        1.png set.png 3.png -o x.png -> 1.png and set.png are of different scenes
        1.png wide.png 3.png -o x.png -> 1.png is a part of a picture of 64 × 36 pixels, and wide.png of one of 65 × 36
        1.png 2.exr 3.png -o x.png -> 1.png and 2.exr are files of different formats
        1.png 2.png 3.png -o x.exr -> x.exr has another format than the parts
        1.png 2.png 3.png -o x.bmp -> a picture's file ends in .png or .exr
        1.png 2.png 3.png -o - -> merge writes a file
        1.png 2.png 3.png -o 3.png -> 3.png is one of the parts
        whole.png -o x.png -> cannot read whole.png: it is no part of a picture
        a.scn -o x.png -> cannot read a.scn: it is neither a PNG nor an EXR file
        none.png -o x.png -> cannot read none.png: there is no such file
        1.png head.png 3.png -o x.png -> cannot read head.png: it begins as a PNG does, but is damaged
        1.png cut.png 3.png -o x.png -> cannot read cut.png: it is damaged or cut off
        ",
    ) {
        let told = folder.told(&format!("merge {line}"), 2);
        assert!(told.contains(about), "{line}: {told}");
        assert_eq!(told.lines().count(), 1, "{told}");
        assert_eq!(folder.names(), before, "{line}");
    }
    for [line, about] in rows(
        "
        --shard 1/2 -> say with `-o FILE` where it goes
        --shard 0/2 -o x.png -> write I/N with I from 1 to N
        --shard 3/2 -o x.png -> write I/N with I from 1 to N
        --shard 2 -o x.png -> write I/N with I from 1 to N
        --shard 1/2 --crop 0,0,2,2 -o x.png -> cannot be used with
        --shard 2/37 -o x.png -> the picture has so many rows
        ",
    ) {
        let told = folder.told(&format!("render a.scn {line}"), 2);
        assert!(told.contains(about), "{line}: {told}");
        assert_eq!(folder.names(), before, "{line}");
    }
}
