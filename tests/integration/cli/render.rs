//! `render`: its files, formats and pipes, and what it says.

use std::fs;

use super::*;
use crate::program::Said;

#[test]
fn render_writes_a_picture_beside_the_scene() {
    let folder = folder();
    folder.write("sub/b.scene.scn", SCENE);
    assert_eq!(folder.done("render sub/b.scene.scn").text(), "");
    assert_eq!(size(&folder.read("sub/b.scene.png")), (64, 36));
    assert_eq!(folder.names(), ["a.scn", "sub"]);
}

#[test]
fn the_ending_of_the_file_is_its_format() {
    let folder = folder();
    for name in ["b.png", "b.PNG", "b.exr"] {
        folder.done(&format!("render a.scn -o {name}"));
        assert_eq!(size(&folder.read(name)), (64, 36));
    }
    for name in ["b", "b.jpg", "png", "b.png.", "b.png~", "b.png/"] {
        let told = folder.told(&format!("render a.scn --output {name}"), 2);
        let expected = format!(
            "error: the ending of {name} stands for no format: a picture's file ends in .png or .exr\n"
        );
        assert_eq!(told, expected);
    }
}

#[test]
fn scene_and_picture_go_through_pipes() {
    let folder = folder();
    folder.done("render a.scn");
    let picture = folder.read("a.png");
    // The picture that comes out can go in again.
    for input in [SCENE.as_bytes(), &picture] {
        let piped = folder.run_reading("render - -o -", input);
        assert_eq!((piped.status, piped.errors.as_str()), (0, ""));
        assert!(piped.output == picture);
    }
    folder.tells("render - -> 2 -> error: the scene comes from standard input: say with `-o FILE` where the picture goes");
}

#[test]
fn a_picture_renders_its_scene_again() {
    let folder = folder();
    let same = |a: &str, b: &str| assert!(folder.read(a) == folder.read(b), "{a} and {b}");
    let set = "--set 'Ball.center=(0, 1.5, 0)' --set 'h = 2'";
    folder.done(&format!("render a.scn -o b.png {set} --crop 10,5,30,20"));
    folder.done("render b.png -o c.png");
    same("b.png", "c.png");
    assert_eq!(size(&folder.read("c.png")), (30, 20));
    // What is set and cropped now comes after what was set and cropped then.
    let now = "--set h=3 --crop 0,0,64,36";
    folder.done(&format!("render b.png -o d.png {now}"));
    folder.done(&format!("render a.scn -o e.png {set} {now}"));
    same("d.png", "e.png");
    folder.tells(
        "render b.png --set image.width=20 -> 2 -> error: the crop 10,5,30,20, which b.png carries, does not lie within the picture, which has 20 × 36 pixels",
    );
    // The scene need not be there any more, and the picture need not be named as one.
    fs::rename(folder.path("b.png"), folder.path("b.scn")).unwrap();
    folder.done("check b.scn");
}

#[test]
fn a_crop_has_the_pixels_of_the_whole() {
    let folder = folder();
    folder.done("render a.scn");
    folder.done("render a.scn -o b.png --crop 20,10,31,17");
    let open = |name: &str| image::load_from_memory(&folder.read(name)).unwrap();
    let part = open("a.png").crop_imm(20, 10, 31, 17);
    assert!(part.to_rgb8() == open("b.png").to_rgb8());
    folder.done("render a.scn -o b.exr --crop 5,6,20,10");
    let picture = film::read_picture(&folder.read("b.exr")).unwrap();
    assert_eq!(picture.crop, Some("5,6,20,10".parse().unwrap()));
    folder.tells("
        render a.scn --crop 1,0,64,36 -> 2 -> error: the crop 1,0,64,36 does not lie within the picture, which has 64 × 36 pixels
        render a.scn --crop 0,36,1,1 -> 2 -> error: the crop 0,36,1,1 does not lie within the picture, which has 64 × 36 pixels
        render a.scn --crop 64,0,1,1 -> 2 -> error: the crop 64,0,1,1 does not lie within the picture, which has 64 × 36 pixels
        render a.scn --crop 0,0,4294967295,1 -> 2 -> error: the crop 0,0,4294967295,1 does not lie within the picture, which has 64 × 36 pixels
    ");
    let crops = "0,0,0,1 1,2,3 1,2,3,4,5 -1,0,2,2 a 1,1,1,4294967296 ''";
    for (option, wrong) in [("crop", crops), ("threads", "0 -1 1.5 many ''")] {
        for wrong in wrong.split(' ') {
            folder.told(&format!("render a.scn --{option} {wrong}"), 2);
        }
    }
}

#[test]
fn a_scene_of_a_megabyte_is_left_out_of_its_picture_with_a_warning() {
    let folder = folder();
    folder.write("long.scn", format!("{SCENE}//{}\n", " ".repeat(1 << 20)));
    assert_eq!(
        folder.told("render long.scn", 0),
        "warning: the scene and its overrides have more than 1 MiB of text or 1000 overrides, so long.png does not carry them\n"
    );
    folder.told("render long.png -o again.png", 2);
    // An EXR never carries one.
    folder.done("render long.scn -o long.exr");
}

#[cfg(unix)]
#[test]
fn what_killed_runs_leave_is_removed_by_the_next_one() {
    let folder = folder();
    let line = "render a.scn -o a.exr --set image.width=640 --set image.height=480 --set sampler.method=random --set sampler.per_pixel=1";
    let is_writing = || {
        let mut names = folder.names().into_iter();
        names.any(|name| name.starts_with(".pinhole-a.exr-"))
    };
    let mut left = 0;
    for _ in 0..10 {
        let mut child = folder.command(line).spawn().unwrap();
        while child.try_wait().unwrap().is_none() && !is_writing() {
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        child.kill().unwrap();
        child.wait().unwrap();
        left += u32::from(is_writing());
    }
    assert!(left > 0, "no run was killed while it wrote");
    // Of another file, which is not written here.
    folder.write(".pinhole-b.exr-abcdef.tmp", "");
    folder.done(line);
    assert_eq!(
        folder.names(),
        [".pinhole-b.exr-abcdef.tmp", "a.exr", "a.scn"]
    );
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told_of_the_file_that_was_asked_for() {
    let folder = folder();
    std::os::unix::fs::symlink("/dev/full", folder.path("full.png")).unwrap();
    folder.tells("render a.scn -o full.png -> 2 -> error: cannot write to full.png: No space left on device (os error 28)");
    fs::remove_file(folder.path("full.png")).unwrap();
    // A limit on the size of files ends a write as a full disk does.
    let script = "trap '' XFSZ; ulimit -f 8; exec \"$0\" render a.scn -o a.exr --set image.width=640 --set image.height=480";
    let mut shell = std::process::Command::new("sh");
    let shell = shell.args(["-c", script, env!("CARGO_BIN_EXE_pinhole")]);
    let said = Said::from(shell.current_dir(folder.path(".")).output().unwrap());
    assert_eq!(
        (said.status, said.errors.as_str()),
        (
            2,
            "error: cannot write to a.exr: File too large (os error 27)\n"
        )
    );
    assert_eq!(folder.names(), ["a.scn"]);
}

#[test]
fn a_picture_too_large_for_memory_is_refused() {
    let folder = folder();
    let sizes = "--set image.width=1048576 --set image.height=1048576";
    let told = folder.told(&format!("render a.scn {sizes}"), 2);
    let start = "error: a picture of 1048576 × 1048576 pixels needs 3.0 TiB of memory, ";
    let told = told.strip_prefix(start).expect(&told);
    let is_known = told.starts_with("and ") && told.ends_with("iB are available\n");
    assert!(is_known || !cfg!(target_os = "linux"), "{told}");
    assert_eq!(folder.names(), ["a.scn"]);
    folder.done(&format!(
        "render a.scn {sizes} -o part.png --crop 524288,524288,3,2"
    ));
    assert_eq!(size(&folder.read("part.png")), (3, 2));
}

#[test]
fn a_bound_that_is_worth_a_word_gets_one() {
    let wide = "image { width 6 height 3 }
                camera { eye (0.31, 1.7, 2.2) direction (1, 0, -2) }
                sampler { method exact }
                checkerboard { y 0 square 5e-324 }";
    let empty = "image { width 4 height 4 } camera { eye (0, 1, 0) lookat (0, 1, -1) } sampler { method exact }";
    let folder = Folder::with([("wide.scn", wide), ("empty.scn", empty)]);
    let told = folder.told("render wide.scn", 0);
    // The column and the row of the pixel that is known least.
    let place = |told: &str| -> [u32; 2] {
        let start = "known less well than to a millionth, least of all the one at column ";
        let (_, place) = told.split_once(start).expect(told);
        let (column, row) = place.trim().split_once(", row ").expect(told);
        [column, row].map(|number| number.parse().unwrap())
    };
    let [x, y] = place(&told);
    assert!(x > 0 || y > 0, "{told}");
    // A crop tells the place in the whole picture, too.
    let told = folder.told(&format!("render wide.scn --crop {x},{y},1,1"), 0);
    assert!(told.contains("exact: one pixel is known"), "{told}");
    assert_eq!(place(&told), [x, y]);
    folder.tells(r"render empty.scn -> 0 -> …\nexact: every channel is its pixel's only colour; the 8-bit rounding of every pixel is certain");
}
