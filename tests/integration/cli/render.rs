//! Tests of the command `pinhole render`: crops and temporary files.

use super::*;

#[test]
fn a_crop_has_the_pixels_of_the_whole_picture() {
    let folder = folder();
    folder.done("render a.scn");
    folder.done("render a.scn -o b.png --crop 20,10,31,17");
    let open = |name: &str| image::load_from_memory(&folder.read(name)).unwrap();
    let part = open("a.png").crop_imm(20, 10, 31, 17);
    assert!(part.to_rgb8() == open("b.png").to_rgb8());
}

#[cfg(unix)]
#[test]
fn temporary_files_of_killed_runs_are_removed_by_the_next_run() {
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
    // The temporary file belongs to another output file, `b.exr`, so this render must not remove
    // it.
    folder.write(".pinhole-b.exr-abcdef.tmp", "");
    folder.done(line);
    assert_eq!(
        folder.names(),
        [".pinhole-b.exr-abcdef.tmp", "a.exr", "a.scn"]
    );
}
