//! The same pictures on other processors, for which QEMU has to be there: `cargo test -- --ignored processors`, with `qemu-x86_64` on the path.
//!
//! Which vectors there are is asked at run time, so the program goes other ways on a processor that has none.

use std::process::Command;

use pinhole::scene::Method;

use crate::program::{Folder, words};

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
    let folder = Folder::with([]);
    let picture = |command: &mut Command| {
        let output = command.output().expect("the program is on the path");
        assert!(output.status.success(), "{output:?}");
        folder.read("a.exr")
    };
    for scene in SCENES {
        for method in Method::SAMPLED.into_iter().chain([Method::Exact]) {
            let line = format!(
                "render '{}/examples/{scene}.scn' -o a.exr --set image.width=32 --set image.height=24 --set sampler.method={}",
                env!("CARGO_MANIFEST_DIR"),
                method.name()
            );
            let here = picture(&mut folder.command(&line));
            for processor in PROCESSORS {
                let there = picture(
                    Command::new("qemu-x86_64")
                        .args(["-cpu", processor, env!("CARGO_BIN_EXE_pinhole")])
                        .args(words(&line))
                        .current_dir(folder.path(".")),
                );
                assert!(here == there, "{line}, {processor}");
            }
        }
    }
}
