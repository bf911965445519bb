//! Tests that pictures are equal on different processors. The test needs `qemu-x86_64` on the path:
//! `cargo test -- --ignored processors`.
//!
//! The program detects vector instructions at run time. So the same binary runs other code on a
//! processor without these instructions.

use std::{env, fs, io::Cursor, path::Path, process::Command};

use pinhole::{
    film::{Film, write_exr, write_png},
    render::Control,
    scene::Method,
};

use crate::{
    program::Folder,
    scenes::{example, rendered, whole, with_samples},
};

/// Names of processors in QEMU. The first has only vectors of two doubles; the second also has
/// vectors of four doubles. Pinhole runs different code on each.
const PROCESSORS: [&str; 2] = ["qemu64", "Haswell"];

const SCENES: [&str; 5] = [
    "figure_9_9",
    "scatter",
    "near_and_far",
    "one_vanishing_point",
    "inside_the_sphere",
];

/// Name of the environment variable that is set if the test binary runs in QEMU. Its value is a
/// folder. The binary then writes its pictures into this folder and compares nothing.
const FOLDER: &str = "PINHOLE_TEST_PICTURES";

/// Compares the pictures with those that the same test binary draws in QEMU. One process draws all
/// pictures for a processor, because QEMU translates most of the code anew in each process.
#[test]
#[ignore = "needs QEMU"]
fn all_processors_make_the_same_pictures() {
    if let Some(folder) = env::var_os(FOLDER) {
        return draw(Path::new(&folder));
    }
    let [here, there] = [Folder::with([]), Folder::with([])];
    draw(&here.path("."));
    let names = here.names();
    assert_eq!(names.len(), 2 * SCENES.len() * (Method::SAMPLED.len() + 1));
    for processor in PROCESSORS {
        let mut elsewhere = Command::new("qemu-x86_64");
        elsewhere
            .args(["-cpu", processor])
            .arg(env::current_exe().unwrap())
            .args(["--ignored", "all_processors_make_the_same_pictures"])
            .env(FOLDER, there.path("."));
        let output = elsewhere.output().expect("QEMU is on the path");
        assert!(output.status.success(), "{output:?}");
        assert_eq!(there.names(), names);
        for name in &names {
            assert!(here.read(name) == there.read(name), "{name}, {processor}");
            fs::remove_file(there.path(name)).unwrap();
        }
    }
}

/// Writes small pictures of the scenes in [`SCENES`] into a folder: by each method, as PNG and EXR
/// files.
fn draw(folder: &Path) {
    for name in SCENES {
        let scene = example(name, 32, 24);
        for method in Method::SAMPLED.into_iter().chain([Method::Exact]) {
            let scene = with_samples(&scene, method, scene.sampler.count);
            let whole = whole(&scene);
            let film: Film = rendered(&scene, whole, &Control::default()).into_film();
            let mut exr = Cursor::new(Vec::new());
            write_exr(&film, whole, whole, None, &mut exr).unwrap();
            let mut png = Vec::new();
            write_png(&film, None, &mut png).unwrap();
            for (ending, bytes) in [("exr", exr.into_inner()), ("png", png)] {
                let path = folder.join(format!("{name} {}.{ending}", method.name()));
                fs::write(path, bytes).unwrap();
            }
        }
    }
}
