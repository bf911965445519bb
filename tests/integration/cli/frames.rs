//! Tests of `pinhole render --sweep`: the bytes and names of its pictures, and `--resume`.

use std::{fs, time::SystemTime};

use pinhole::Picture;

use super::*;
use crate::table::rows;

#[test]
fn each_picture_of_a_sweep_equals_the_render_of_its_value() {
    let folder = folder();
    for [sweep, sets] in rows(
        "
        camera.roll=0deg..90deg/4 -> camera.roll=0deg camera.roll=30deg camera.roll=60deg camera.roll=90deg
        h=1..1.25/2 -> h=1 h=1.25
        camera.eye=(3,3.5,8)..(1,2.5,8)/3 -> camera.eye=(3,3.5,8) camera.eye=(2,3,8) camera.eye=(1,2.5,8)
        ",
    ) {
        for ending in ["png", "exr"] {
            folder.done(&format!("render a.scn --sweep {sweep} -o s-%02d.{ending}"));
            for (i, set) in sets.split(' ').enumerate() {
                folder.done(&format!("render a.scn --set {set} -o one.{ending}"));
                let open = |name: &str| Picture::open(folder.path(name)).unwrap();
                // Compares the pixels rather than the bytes of the files. A file also stores the
                // swept value as computed, for example 29.999deg instead of 30deg, so the files may
                // differ.
                let name = format!("s-{i:02}.{ending}");
                let one = open(&format!("one.{ending}"));
                assert!(open(&name).pixels() == one.pixels(), "{set}: {name}");
            }
        }
    }
}

#[test]
fn names_have_one_place_for_the_number() {
    let folder = folder();
    let sweep = "render a.scn --sweep h=1..2/2 --set image.width=8 --set image.height=4";
    for [pattern, names] in rows(
        "
        a%d.png -> a.scn a0.png a1.png
        %09d.png -> 000000000.png 000000001.png a.scn
        100%%-%01d.png -> 100%-0.png 100%-1.png a.scn
        ",
    ) {
        folder.done(&format!("{sweep} -o {pattern}"));
        assert_eq!(folder.names().join(" "), names, "{pattern}");
        for name in folder.names() {
            if name != "a.scn" {
                fs::remove_file(folder.path(&name)).unwrap();
            }
        }
    }
    for [arguments, about] in rows(
        "
        -> and it takes `-o FILE`
        -o - -> and it takes `-o FILE`
        -o a.png -> a.png has no single place for the number of a picture
        -o %d-%d.png -> has no single place
        -o a%%.png -> has no single place
        -o a%s.png -> has no single place
        -o a%3d.png -> has no single place
        -o a%010d.png -> has no single place
        -o a%0d%.png -> has no single place
        -o a%d.bmp -> a picture's file ends in .png or .exr
        ",
    ) {
        let told = folder.told(&format!("{sweep} {arguments}"), 2);
        assert!(told.contains(about), "{arguments}: {told}");
    }
    let told = folder.told("render a.scn --resume -o a%d.png", 2);
    assert!(told.contains("--sweep"), "{told}");
    assert_eq!(folder.names(), ["a.scn"]);
}

/// With `--resume`, a picture is rendered again only if its file is missing, is not a picture, or
/// was made from another text, with other overrides or with another crop.
#[test]
fn a_resumed_sweep_renders_only_what_is_missing() {
    let folder = folder();
    let long_ago = SystemTime::UNIX_EPOCH;
    for ending in ["png", "exr"] {
        let sweep = |more: &str| {
            folder.done(&format!(
                "render a.scn --sweep h=1..2/4 -o {ending}%d.{ending} {more}"
            ));
        };
        let names: Vec<String> = (0..4).map(|i| format!("{ending}{i}.{ending}")).collect();
        // Sets the modification times of all files to 1970, runs a sweep, and returns the indices
        // of the files that have been written since.
        let written = |more: &str| {
            for name in &names {
                if let Ok(file) = fs::File::options().write(true).open(folder.path(name)) {
                    file.set_modified(long_ago).unwrap();
                }
            }
            sweep(more);
            let is_new = |i: &usize| {
                let found = fs::metadata(folder.path(&names[*i])).unwrap();
                found.modified().unwrap() != long_ago
            };
            (0..4).filter(is_new).collect::<Vec<_>>()
        };
        assert_eq!(written(""), [0, 1, 2, 3]);
        assert_eq!(written("--resume"), [0; 0]);
        assert_eq!(written(""), [0, 1, 2, 3]);
        fs::remove_file(folder.path(&names[1])).unwrap();
        folder.write(&names[2], "no picture");
        assert_eq!(written("--resume"), [1, 2]);
        assert_eq!(written("--resume --set camera.roll=1deg"), [0, 1, 2, 3]);
        assert_eq!(written("--resume --set camera.roll=1deg"), [0; 0]);
        assert_eq!(written("--resume"), [0, 1, 2, 3]);
        folder.done(&format!(
            "render a.scn -o {} --set h=1 --crop 0,0,9,9",
            names[0]
        ));
        assert_eq!(written("--resume"), [0]);
        folder.write("a.scn", format!("{SCENE}// changed\n"));
        assert_eq!(written("--resume"), [0, 1, 2, 3]);
        folder.write("a.scn", SCENE);
    }
}

/// A sweep that is interrupted leaves only complete pictures.
#[cfg(unix)]
#[test]
fn an_interrupted_sweep_leaves_whole_pictures() {
    let folder = folder();
    let line = "render a.scn --sweep h=1..2/100 -o %03d.png --set sampler.per_pixel=256 --set image.width=128";
    interrupted(&mut folder.command(line), 1500);
    let names = folder.names();
    assert!((2..101).contains(&names.len()), "{names:?}");
    for name in names.iter().filter(|name| *name != "a.scn") {
        image::load_from_memory(&folder.read(name))
            .unwrap_or_else(|error| panic!("{name}: {error}"));
    }
}
