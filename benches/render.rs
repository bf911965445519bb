//! Measures each sampling method: the times for generating sample points, for rendering on one or
//! more threads, for writing files, and for tracing each sample alone. Run it with
//! `cargo bench --bench render`. See README.md beside this file.

use std::{env, hint::black_box, io::Cursor, num::NonZero, thread, time::Instant};

use glam::DVec2;
use pinhole::{
    area::Area,
    film::{Film, Recipe, write_exr, write_png},
    math::SimdWidth,
    render::{Control, render},
    sampling::{Points, Sampling},
    scene::{Count, Method, Scene},
    tracer::World,
};

use self::one_by_one::one_by_one;

mod figure;
mod one_by_one;

const WIDTH: u32 = 1280;
const HEIGHT: u32 = 720;
const PER_PIXEL: u64 = 16;

/// Number of times that each measured function is run. The shortest time is printed, since other
/// work on the machine only makes a run slower. With fewer runs, the results would scatter more;
/// more runs would take longer.
const RUNS: usize = 5;

fn main() {
    // `cargo test` runs this program without `--bench`. The program contains no tests, so it ends
    // here.
    if !env::args().any(|argument| argument == "--bench") {
        return;
    }
    let threads = thread::available_parallelism().map_or(1, NonZero::get);
    println!("figure 9.9, {WIDTH} × {HEIGHT} pixels, {PER_PIXEL} samples each");
    println!("plain: every sample on its own, on one thread; the least of {RUNS} times, in turns");
    println!(
        "                points placed,          rendered on 1 thread,   on {threads} threads,"
    );
    println!(
        "                part of plain's time    times as fast as plain  times as fast as on 1"
    );
    for method in Method::SAMPLED {
        let scene = figure::figure(WIDTH, HEIGHT, method, Count::PerPixel(PER_PIXEL));
        let [plain, points, one, all] = least([
            &mut || {
                black_box(plain(&scene));
            },
            &mut || {
                black_box(points(&scene));
            },
            &mut || {
                black_box(picture(&scene, 1));
            },
            &mut || {
                black_box(picture(&scene, threads));
            },
        ]);
        println!(
            "{:14} {:>21.3} {:>25.1} {:>22.2}",
            method.name(),
            points / plain,
            plain / one,
            one / all,
        );
    }
    let scene = figure::figure(WIDTH, HEIGHT, Method::Random, Count::PerPixel(PER_PIXEL));
    let film = picture(&scene, threads);
    let recipe = Recipe {
        scene: String::new(),
        overrides: Vec::new(),
        crop: None,
        size: None,
    };
    let whole = Area::whole(WIDTH, HEIGHT);
    let [plain, png, exr] = least([
        &mut || {
            black_box(plain(&scene));
        },
        &mut || write_png(&film, Some(&recipe), &mut Vec::new()).expect("a list takes all bytes"),
        &mut || {
            write_exr(&film, whole, whole, None, &mut Cursor::new(Vec::new()))
                .expect("a list takes all bytes");
        },
    ]);
    println!(
        "its files, part of the time of random on the plain path: PNG {:.3}, EXR {:.3}",
        png / plain,
        exr / plain
    );
}

/// Returns the shortest time of each function, in seconds. The functions run alternately, so that
/// other work on the machine affects all of them.
fn least<const N: usize>(mut what: [&mut dyn FnMut(); N]) -> [f64; N] {
    let mut least = [f64::INFINITY; N];
    for _ in 0..RUNS {
        for (least, what) in least.iter_mut().zip(&mut what) {
            let start = Instant::now();
            what();
            *least = least.min(start.elapsed().as_secs_f64());
        }
    }
    least
}

/// Generates all sample points and returns their sum, so that the compiler cannot remove the work.
fn points(scene: &Scene) -> f64 {
    let sampling = Sampling::new(&scene.sampler, WIDTH, HEIGHT);
    let mut sum = DVec2::ZERO;
    let mut points = Points::default();
    for tile in Area::whole(WIDTH, HEIGHT).tiles(64) {
        for ((x, y), count) in tile.iter().zip(sampling.counts(tile)) {
            sampling.place(SimdWidth::Widest, [x, y], count, 0..count, &mut points);
            sum += points.iter().sum::<DVec2>();
        }
    }
    sum.element_sum()
}

/// Renders the scene sample by sample on one thread, without culling.
fn plain(scene: &Scene) -> Film {
    let sampling = Sampling::new(&scene.sampler, WIDTH, HEIGHT);
    one_by_one(&World::new(scene), &sampling, Area::whole(WIDTH, HEIGHT))
}

fn picture(scene: &Scene, threads: usize) -> Film {
    let control = Control {
        threads: NonZero::new(threads),
        ..Control::default()
    };
    let sampling = Sampling::new(&scene.sampler, WIDTH, HEIGHT);
    let part = Area::whole(WIDTH, HEIGHT);
    let world = World::new(scene);
    render(&world, &sampling, part, &control).expect("there is memory for it")
}
