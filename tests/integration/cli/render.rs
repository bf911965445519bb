//! `render`: its files, formats and pipes, and what it says.

use super::*;

#[test]
fn render_writes_a_picture_beside_the_scene() {
    let folder = folder();
    fs::create_dir(folder.path().join("sub")).unwrap();
    fs::write(folder.path().join("sub/b.scene.scn"), SCENE).unwrap();
    assert_eq!(done(&folder, &["render", "sub/b.scene.scn"]), b"");
    assert_eq!(size(&read(&folder, "sub/b.scene.png")), (64, 36));
    assert_eq!(names(&folder), ["a.scn", "sub"]);
}

#[test]
fn the_ending_of_the_file_is_its_format() {
    let folder = folder();
    for name in ["b.png", "b.PNG", "b.exr"] {
        done(&folder, &["render", "a.scn", "-o", name]);
        assert_eq!(size(&read(&folder, name)), (64, 36));
    }
    for name in ["b", "b.jpg", "png", "b.png.", "b.png~", "b.png/"] {
        let errors = fails(&folder, &["render", "a.scn", "--output", name], 2);
        assert_eq!(
            errors,
            format!(
                "error: the ending of {name} stands for no format: a picture's file ends in .png or .exr\n"
            )
        );
    }
}

#[test]
fn scene_and_picture_go_through_pipes() {
    let folder = folder();
    done(&folder, &["render", "a.scn"]);
    let picture = read(&folder, "a.png");
    let piped = pinhole_reading(&folder, SCENE.as_bytes(), &["render", "-", "-o", "-"]);
    assert_eq!((status(&piped), errors(&piped)), (0, String::new()));
    assert!(piped.stdout == picture);
    // The picture that came out can go in again.
    let again = pinhole_reading(&folder, &picture, &["render", "-", "-o", "-"]);
    assert!(again.stdout == picture);
    let nowhere = pinhole_reading(&folder, SCENE.as_bytes(), &["render", "-"]);
    assert_eq!(status(&nowhere), 2);
    assert_eq!(
        errors(&nowhere),
        "error: the scene comes from standard input: say with `-o FILE` where the picture goes\n"
    );
}

#[test]
fn neither_threads_nor_a_second_run_change_a_byte() {
    let folder = folder();
    done(&folder, &["render", "a.scn"]);
    for threads in ["1", "2", "7", "100000"] {
        done(
            &folder,
            &["render", "a.scn", "-o", "b.png", "--threads", threads],
        );
        assert!(read(&folder, "a.png") == read(&folder, "b.png"));
    }
    for threads in ["0", "-1", "1.5", "many", ""] {
        fails(&folder, &["render", "a.scn", "--threads", threads], 2);
    }
}

#[test]
fn a_picture_renders_its_scene_again() {
    let folder = folder();
    let (moved, grown) = (["--set", "Ball.center=(0, 1.5, 0)"], ["--set", "h = 2"]);
    let arguments = [&moved[..], &grown, &["--crop", "10,5,30,20"]].concat();
    let first = [&["render", "a.scn", "-o", "b.png"], &arguments[..]].concat();
    done(&folder, &first);
    done(&folder, &["render", "b.png", "-o", "c.png"]);
    assert!(read(&folder, "b.png") == read(&folder, "c.png"));
    assert_eq!(size(&read(&folder, "c.png")), (30, 20));

    // What is set and cropped now comes after what was set and cropped then.
    let now = ["--set", "h=3", "--crop", "0,0,64,36"];
    done(
        &folder,
        &[&["render", "b.png", "-o", "d.png"], &now[..]].concat(),
    );
    let both = [&["render", "a.scn", "-o", "e.png"], &arguments[..4], &now].concat();
    done(&folder, &both);
    assert!(read(&folder, "d.png") == read(&folder, "e.png"));

    assert_eq!(
        fails(&folder, &["render", "b.png", "--set", "image.width=20"], 2),
        "error: the crop 10,5,30,20, which b.png carries, does not lie within the picture, which has 20 × 36 pixels\n"
    );

    // The scene need not be there any more, and the picture need not be named as one.
    fs::rename(folder.path().join("b.png"), folder.path().join("b.scn")).unwrap();
    assert_eq!(done(&folder, &["check", "b.scn"]), b"");
}

#[test]
fn a_crop_has_the_pixels_of_the_whole() {
    let folder = folder();
    done(&folder, &["render", "a.scn"]);
    done(
        &folder,
        &["render", "a.scn", "-o", "b.png", "--crop", "20,10,31,17"],
    );
    let whole = image::load_from_memory(&read(&folder, "a.png")).unwrap();
    let crop = image::load_from_memory(&read(&folder, "b.png")).unwrap();
    assert!(whole.crop_imm(20, 10, 31, 17).to_rgb8() == crop.to_rgb8());
    for outside in ["1,0,64,36", "0,36,1,1", "64,0,1,1", "0,0,4294967295,1"] {
        assert_eq!(
            fails(&folder, &["render", "a.scn", "--crop", outside], 2),
            format!(
                "error: the crop {outside} does not lie within the picture, which has 64 × 36 pixels\n"
            )
        );
    }
    let wrong = "0,0,0,1 1,2,3 1,2,3,4,5 -1,0,2,2 a 1,1,1,4294967296";
    for wrong in wrong.split(' ').chain([""]) {
        fails(&folder, &["render", "a.scn", "--crop", wrong], 2);
    }
}

#[test]
fn a_scene_is_not_replaced_by_its_picture() {
    let folder = folder();
    fs::write(folder.path().join("a.png"), SCENE).unwrap();
    assert_eq!(
        fails(&folder, &["render", "a.png"], 2),
        "error: a.png is the scene itself: say with `-o FILE` where the picture goes\n"
    );
    assert_eq!(read(&folder, "a.png"), SCENE.as_bytes());
}

#[test]
fn a_scene_of_a_megabyte_is_left_out_of_its_picture_with_a_warning() {
    let folder = folder();
    let long = format!("{SCENE}//{}\n", " ".repeat(1 << 20));
    fs::write(folder.path().join("long.scn"), long).unwrap();
    let output = pinhole(&folder, &["render", "long.scn"]);
    assert_eq!(status(&output), 0);
    assert_eq!(
        errors(&output),
        "warning: the scene and its overrides have more than 1 MiB of text or 1000 overrides, so long.png does not carry them\n"
    );
    fails(&folder, &["render", "long.png", "-o", "again.png"], 2);
    // An EXR never carries one.
    done(&folder, &["render", "long.scn", "-o", "long.exr"]);
}

#[test]
fn a_crop_as_exr_says_where_it_lies() {
    let folder = folder();
    done(
        &folder,
        &["render", "a.scn", "--crop", "5,6,20,10", "-o", "a.exr"],
    );
    let picture = film::read_picture(&read(&folder, "a.exr")).unwrap();
    assert_eq!(picture.crop, Some("5,6,20,10".parse().unwrap()));
}

#[cfg(unix)]
#[test]
fn what_killed_runs_leave_is_removed_by_the_next_one() {
    let folder = folder();
    let arguments = "render a.scn -o a.exr --set image.width=640 --set image.height=480 --set sampler.method=random --set sampler.per_pixel=1";
    let arguments: Vec<&str> = arguments.split(' ').collect();
    let mut left = 0;
    for _ in 0..10 {
        let mut child = command(folder.path(), &arguments).spawn().unwrap();
        let is_writing = || {
            names(&folder)
                .iter()
                .any(|name| name.starts_with(".pinhole-a.exr-"))
        };
        while child.try_wait().unwrap().is_none() && !is_writing() {
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        child.kill().unwrap();
        child.wait().unwrap();
        left += u32::from(is_writing());
    }
    assert!(left > 0, "no run was killed while it wrote");
    // Of another file, which is not written here.
    fs::write(folder.path().join(".pinhole-b.exr-abcdef.tmp"), b"").unwrap();
    done(&folder, &arguments);
    assert_eq!(
        names(&folder),
        [".pinhole-b.exr-abcdef.tmp", "a.exr", "a.scn"]
    );
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told_of_the_file_that_was_asked_for() {
    let folder = folder();
    std::os::unix::fs::symlink("/dev/full", folder.path().join("full.png")).unwrap();
    assert_eq!(
        fails(&folder, &["render", "a.scn", "-o", "full.png"], 2),
        "error: cannot write to full.png: No space left on device (os error 28)\n"
    );
    fs::remove_file(folder.path().join("full.png")).unwrap();
    // A limit on the size of files ends a write as a full disk does.
    let script = "trap '' XFSZ; ulimit -f 8; exec \"$0\" render a.scn -o a.exr --set image.width=640 --set image.height=480";
    let output = std::process::Command::new("sh")
        .args(["-c", script, env!("CARGO_BIN_EXE_pinhole")])
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert_eq!(
        (status(&output), errors(&output)),
        (
            2,
            "error: cannot write to a.exr: File too large (os error 27)\n".to_owned()
        )
    );
    assert_eq!(names(&folder), ["a.scn"]);
}

#[test]
fn a_picture_too_large_for_memory_is_refused() {
    let folder = folder();
    let (width, height) = ("image.width=1048576", "image.height=1048576");
    let huge = ["--set", width, "--set", height];
    let errors = fails(&folder, &[&["render", "a.scn"], &huge[..]].concat(), 2);
    assert!(
        errors
            .starts_with("error: a picture of 1048576 × 1048576 pixels needs 3.0 TiB of memory, "),
        "{errors}"
    );
    assert_eq!(names(&folder), ["a.scn"]);
    let part = ["-o", "part.png", "--crop", "524288,524288,3,2"];
    done(&folder, &[&["render", "a.scn"], &huge[..], &part].concat());
    assert_eq!(size(&read(&folder, "part.png")), (3, 2));
}

#[test]
fn a_bound_that_is_worth_a_word_gets_one() {
    let scene = "image { width 6 height 3 }
                 camera { eye (0.31, 1.7, 2.2) direction (1, 0, -2) }
                 sampler { method exact }
                 checkerboard { y 0 square 5e-324 }";
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("wide.scn"), scene).unwrap();
    let output = pinhole(&folder, &["render", "wide.scn"]);
    let told = errors(&output);
    assert!(output.status.success(), "{told}");
    let place = place(&told);
    assert!(place.iter().any(|&at| at > 0), "{told}");
    // A crop tells the place in the whole picture, too.
    let crop = format!("{},{},1,1", place[0], place[1]);
    let told = errors(&pinhole(&folder, &["render", "wide.scn", "--crop", &crop]));
    assert!(told.contains("exact: one pixel is known"), "{told}");
    assert_eq!(self::place(&told), place);
}

/// The column and the row of the pixel that is told to be known least.
fn place(told: &str) -> [u32; 2] {
    let told = told
        .split_once("known less well than to a millionth, least of all the one at column ")
        .and_then(|(_, place)| place.trim().split_once(", row "));
    let (column, row) = told.unwrap_or_else(|| panic!("no place in {told:?}"));
    [column, row].map(|number| number.parse().unwrap())
}

#[test]
fn a_picture_of_one_colour_is_exactly_right() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(
        folder.path().join("empty.scn"),
        "image { width 4 height 4 } camera { eye (0, 1, 0) lookat (0, 1, -1) } sampler { method exact }",
    )
    .unwrap();
    let told = errors(&pinhole(&folder, &["render", "empty.scn"]));
    let end = "\nexact: every channel is its pixel's only colour; the 8-bit rounding of every pixel is certain\n";
    assert!(told.ends_with(end), "{told}");
}
