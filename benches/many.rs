//! Measures how the times of preparation and rendering grow with the number of objects:
//! `cargo bench --bench many`. See README.md beside this file.
//!
//! `-- --write COUNT` writes a scene of COUNT small spheres to standard output instead.
//! `-- --phases COUNT…` prints, for each COUNT, the CPU seconds of each phase and the memory of the
//! prepared scene. With `--cube`, the spheres lie in a cube instead of all over the picture.
#![allow(
    clippy::disallowed_methods,
    reason = "a benchmark reads and writes files of its own"
)]

use std::{env, fs, hint::black_box};

use pinhole::{
    area::Area,
    render::{Control, render, render_exact},
    sampling::Sampling,
    scene::{self, Scene},
    source::{Source, Sources},
    tracer::World,
};

use self::{
    clock::cpu_seconds,
    one_by_one::one_by_one,
    spheres::{crowd, cube},
};

mod clock;
mod one_by_one;
mod spheres;

const ALL: [usize; 4] = [1_000, 10_000, 100_000, 1_000_000];

fn main() {
    let arguments: Vec<String> = env::args().collect();
    let numbers = |after: &str| -> Option<Vec<usize>> {
        let at = arguments.iter().position(|argument| argument == after)?;
        let rest = arguments[at + 1..].iter();
        Some(rest.map_while(|count| count.parse().ok()).collect())
    };
    let text = if arguments.iter().any(|argument| argument == "--cube") {
        cube
    } else {
        crowd
    };
    if let Some(counts) = numbers("--write") {
        counts
            .into_iter()
            .for_each(|count| print!("{}", text(count)));
        return;
    }
    if let Some(counts) = numbers("--phases") {
        counts
            .into_iter()
            .for_each(|count| phases(&read(text(count))));
        return;
    }
    // `cargo test` runs this program without `--bench`. The program contains no tests, so it ends
    // here.
    if !arguments.iter().any(|argument| argument == "--bench") {
        return;
    }
    ALL.into_iter().for_each(|count| phases(&read(text(count))));
}

fn read(text: String) -> Scene {
    let sources = Sources::new(Source::from_text("spheres.scn", text));
    scene::read(&sources)
        .scene
        .expect("a scene without mistakes")
}

fn picture(world: &World, scene: &Scene) {
    let whole = Area::whole(scene.image.width, scene.image.height);
    let sampling = Sampling::new(&scene.sampler, whole.width, whole.height);
    let control = Control::default();
    let film = render(world, &sampling, whole, &control);
    black_box(film).expect("there is memory for it");
}

/// Prints the CPU seconds of preparing and of rendering a scene, and the size of the prepared scene
/// in memory, in bytes per object.
fn phases(scene: &Scene) {
    const RENDERS: u32 = 4;
    let count = scene.objects.len();
    let before = (cpu_seconds(), resident_bytes());
    let world = World::new(scene);
    let after = (cpu_seconds(), resident_bytes());
    (0..RENDERS).for_each(|_| picture(&world, scene));
    let rendered = (cpu_seconds() - after.0) / f64::from(RENDERS);
    let start = cpu_seconds();
    // Renders the picture again without culling, for comparison: each sample is traced alone, and
    // the quadtree finds the objects that its ray may hit.
    let sampling = Sampling::new(&scene.sampler, scene.image.width, scene.image.height);
    let whole = Area::whole(scene.image.width, scene.image.height);
    black_box(one_by_one(&world, &sampling, whole));
    let plain = cpu_seconds() - start;
    let bytes = (after.1 - before.1) / count as f64;
    let start = cpu_seconds();
    let control = Control::default();
    let exact = if env::args().any(|argument| argument == "--exact") {
        black_box(render_exact(&world, whole, &control)).expect("there is memory for it");
        format!(", exact {:.2}", cpu_seconds() - start)
    } else {
        String::new()
    };
    let prepared = after.0 - before.0;
    println!(
        "{count:9} spheres: world {prepared:.2} CPU s and {bytes:.0} bytes each, render {rendered:.3} CPU s, one by one {plain:.3}{exact}"
    );
}

/// Returns the memory that the process occupies (its resident set), in bytes. Returns 0 on systems
/// without `/proc`.
fn resident_bytes() -> f64 {
    let statm = fs::read_to_string("/proc/self/statm").unwrap_or_default();
    let pages = statm.split_whitespace().nth(1);
    pages
        .and_then(|pages| pages.parse::<f64>().ok())
        .unwrap_or_default()
        * 4096.0
}
