//! The same pictures on other processors, for which QEMU has to be there: `cargo test -- --ignored processors`, with `qemu-x86_64` on the path.
//!
//! Which vectors there are is asked at run time, so the program goes other ways on a processor that has none.

use std::{fs, path::Path, process::Command};

use pinhole::scene::Method;

use crate::program::command;

/// As QEMU calls them: one with the vectors that every processor of the kind has, two numbers wide, and one with four.
const PROCESSORS: [&str; 2] = ["qemu64", "Haswell"];

const SCENES: [&str; 5] = [
    "figure_9_9",
    "scatter",
    "near_and_far",
    "one_vanishing_point",
    "inside_the_sphere",
];

#[test]
#[ignore = "needs QEMU"]
fn all_processors_make_the_same_pictures() {
    let folder = tempfile::tempdir().unwrap();
    let picture = |command: &mut Command| {
        let output = command.output().expect("the program is on the path");
        assert!(output.status.success(), "{output:?}");
        fs::read(folder.path().join("a.exr")).unwrap()
    };
    for scene in SCENES {
        for method in Method::SAMPLED.into_iter().chain([Method::Exact]) {
            let scene = format!("{}/examples/{scene}.scn", env!("CARGO_MANIFEST_DIR"));
            let method = format!("sampler.method={}", method.name());
            let arguments = [
                ["render", &scene],
                ["-o", "a.exr"],
                ["--set", "image.width=48"],
                ["--set", "image.height=36"],
                ["--set", &method],
            ];
            let arguments = arguments.as_flattened();
            let here = picture(&mut command(folder.path(), arguments));
            for processor in PROCESSORS {
                let there = picture(
                    Command::new("qemu-x86_64")
                        .args(["-cpu", processor, env!("CARGO_BIN_EXE_pinhole")])
                        .args(arguments)
                        .current_dir(folder.path()),
                );
                let name = Path::new(&scene).file_stem();
                assert!(here == there, "{name:?}, {method}, {processor}");
            }
        }
    }
}
