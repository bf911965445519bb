//! How many rays a second, method by method: `cargo bench`. See README.md beside this file.

use std::{
    env,
    hint::black_box,
    num::NonZero,
    sync::atomic::AtomicBool,
    thread,
    time::{Duration, Instant},
};

use glam::DVec2;
use pinhole::{
    area::Area,
    film::{Film, Recipe, write_exr, write_png},
    render::{Control, render},
    sampling::Sampling,
    scene::{Count, Method, Scene},
    tracer::World,
};

#[path = "../tests/integration/figure.rs"]
mod figure;

const WIDTH: u32 = 1280;
const HEIGHT: u32 = 720;
const PER_PIXEL: u64 = 16;

/// Each number is the best of so many runs: whatever else the machine does only makes them slower.
const RUNS: usize = 5;

fn main() {
    // `cargo test` builds and runs benchmarks too; there is nothing to test here.
    if !env::args().any(|argument| argument == "--bench") {
        return;
    }
    let threads = thread::available_parallelism().map_or(1, NonZero::get);
    println!("figure 9.9, {WIDTH} × {HEIGHT} pixels, {PER_PIXEL} samples each");
    println!(
        "                    points alone    rendered, 1 thread    rendered, {threads} threads"
    );
    for method in Method::SAMPLED {
        let scene = figure::figure(WIDTH, HEIGHT, method, Count::PerPixel(PER_PIXEL));
        let points = best(|| points(&scene));
        let [one, all] = [1, threads].map(|threads| best(|| picture(&scene, threads)));
        println!(
            "{:14} {:>17} {:>21} {:>22}",
            method.name(),
            rate(points),
            rate(one),
            rate(all)
        );
    }
    let scene = figure::figure(WIDTH, HEIGHT, Method::Random, Count::PerPixel(PER_PIXEL));
    let film = picture(&scene, threads);
    let recipe = Recipe {
        scene: String::new(),
        overrides: Vec::new(),
        crop: None,
    };
    let png = best(|| write_png(&film, &recipe, &mut Vec::new()));
    let exr = best(|| write_exr(&film, std::io::Cursor::new(Vec::new())));
    println!("encoded as PNG in {png:.0?}, as EXR in {exr:.0?}");
}

/// The shortest time that something took.
fn best<T>(mut what: impl FnMut() -> T) -> Duration {
    (0..RUNS)
        .map(|_| {
            let start = Instant::now();
            black_box(what());
            start.elapsed()
        })
        .min()
        .unwrap_or_default()
}

fn rate(time: Duration) -> String {
    let samples = u64::from(WIDTH) * u64::from(HEIGHT) * PER_PIXEL;
    let millions = samples as f64 / time.as_secs_f64() / 1e6;
    format!("{millions:.1} million/s")
}

/// Places all points, and does no more with them than must be.
fn points(scene: &Scene) -> f64 {
    let sampling = Sampling::new(&scene.sampler, WIDTH, HEIGHT);
    let mut sum = DVec2::ZERO;
    let mut points = Vec::new();
    for tile in Area::whole(WIDTH, HEIGHT).tiles(64) {
        for ((x, y), count) in tile.iter().zip(sampling.counts(tile)) {
            points.clear();
            sampling.points(x, y, count, 0..count, &mut points);
            sum += points.iter().sum::<DVec2>();
        }
    }
    sum.element_sum()
}

fn picture(scene: &Scene, threads: usize) -> Film {
    let control = Control {
        threads: NonZero::new(threads),
        progress: &|_| {},
        cancel: &AtomicBool::new(false),
    };
    let sampling = Sampling::new(&scene.sampler, WIDTH, HEIGHT);
    let part = Area::whole(WIDTH, HEIGHT);
    render(&World::new(scene), &sampling, part, &control).expect("there is memory for it")
}
