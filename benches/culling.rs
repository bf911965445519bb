//! Measures how much time culling saves: `cargo bench --bench culling`. Culling tests the samples
//! of a pixel only against the objects that may be seen in the pixel. See README.md beside this
//! file.
#![allow(
    clippy::disallowed_methods,
    reason = "a benchmark reads and writes files of its own"
)]

mod clock;
mod one_by_one;

use std::{env, fs, hint::black_box, num::NonZero, sync::atomic::AtomicBool};

use glam::DVec2;
use pinhole::{
    area::Area,
    math::SimdWidth,
    reference::textbook::Textbook,
    render::{Control, render, render_exact},
    sampling::{Points, Sampling},
    scene::{self, Count, Method, Scene},
    source::{Source, Sources},
    tracer::World,
};

use self::one_by_one::one_by_one;

/// Number of times that each picture is rendered in each way. The shortest CPU time is used, since
/// other work on the machine only makes a render slower. With fewer rounds, the results would
/// scatter more; more rounds would take longer.
const ROUNDS: usize = 3;

/// Way in which the samples of a picture are traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    /// Each sample is traced alone. The quadtree finds the objects that its ray may hit.
    OneByOne,
    /// The samples of a pixel are traced together, against only the objects that may be seen in the
    /// pixel. The command `render` uses this way.
    Culled,
}

const WAYS: [Way; 2] = [Way::OneByOne, Way::Culled];

/// Names of the examples that are rendered in both ways ([`Way`]). In some of these scenes, culling
/// saves much time; in others, little.
const SCENES: [&str; 5] = [
    "scatter",
    "near_and_far",
    "in_a_faces_plane",
    "inside_the_sphere",
    "one_vanishing_point",
];

fn main() {
    // `cargo test` runs this program without `--bench`. The program contains no tests, so it ends
    // here.
    if !env::args().any(|argument| argument == "--bench") {
        return;
    }
    let arguments: Vec<_> = env::args().collect();
    if let Some(at) = arguments.iter().position(|argument| argument == "--once") {
        once(&arguments[at + 1..]);
        return;
    }
    if arguments.iter().any(|argument| argument == "--price") {
        price();
        return;
    }
    if arguments.iter().any(|argument| argument == "--exact") {
        exact();
        return;
    }
    println!(
        "one thread; millions of samples a second one by one, and how many times as fast culling is"
    );
    println!("{:40} {:>10} {:>10}", "", "one by one", "culled");
    let figure = example("figure_9_9");
    for method in Method::SAMPLED {
        ratios(
            &format!("figure 9.9, {}", method.name()),
            &sized(&figure, 640, method, 64),
        );
    }
    for per_pixel in [1, 4, 16] {
        let scene = sized(&figure, 640, Method::Hammersley, per_pixel);
        ratios(
            &format!("figure 9.9, hammersley, {per_pixel} a pixel"),
            &scene,
        );
    }
    for name in SCENES {
        ratios(name, &sized(&example(name), 640, Method::Hammersley, 16));
    }
    ratios(
        "squares too small to be seen",
        &sized(&read(DENSE), 640, Method::Hammersley, 16),
    );
    ratios(
        "300 tiny spheres",
        &sized(&read(&tiny(300)), 320, Method::Hammersley, 16),
    );
    ratios(
        "3000 tiny spheres",
        &sized(&read(&tiny(3000)), 96, Method::Hammersley, 4),
    );
    for per_pixel in [1, 16, 64] {
        ratios(
            &format!("3000 slivers, {per_pixel} a pixel"),
            &sized(&read(&slivers(3000)), 320, Method::Hammersley, per_pixel),
        );
    }

    price();
    exact();
}

/// Scene with a checkerboard whose squares are so small that nearly every pixel sees many of them.
const DENSE: &str = "camera { eye (0.3, 2, 5) lookat (7, 1.8, -30) } checkerboard { square 0.001 }";

/// Returns an element of a Weyl sequence: the fractional part of `index`·`step`, for an irrational
/// `step`, scaled to the range from −`size`/2 to `size`/2.
fn place(index: u32, step: f64, size: f64) -> f64 {
    ((f64::from(index) * step).fract() - 0.5) * size
}

/// Returns the centre of the object with the index `index`. The centres of successive objects
/// spread evenly over the whole picture.
fn center(index: u32) -> [f64; 3] {
    [
        place(index, 0.618_033_988_749_895, 12.0),
        place(index, 0.754_877_666_246_693, 7.0),
        place(index, 0.569_840_290_998_053, 4.0),
    ]
}

/// Returns a scene of `count` spheres that spread over the whole picture. Each is about a pixel in
/// size.
fn tiny(count: u32) -> String {
    let mut text = String::from("camera { eye (0, 0, 9) lookat (0, 0, 0) }\n");
    for i in 0..count {
        let [x, y, z] = center(i);
        text += &format!("sphere {{ center ({x}, {y}, {z}) radius 0.02 }}\n");
    }
    text
}

/// Returns a scene of `count` overlapping triangles with all orientations. Each is two hundred
/// times as long as it is wide. Even a small part of the picture shows many of them, so culling
/// excludes few objects. Rendering with culling may then take three times as long as tracing each
/// sample alone.
fn slivers(count: u32) -> String {
    let mut text = String::from("camera { eye (0, 0, 9) lookat (0, 0, 0) }\n");
    for i in 0..count {
        let [x, y, z] = center(i);
        let (nx, ny) = (
            place(i, 0.414_213_562_373_095, 1.0),
            place(i, 0.732_050_807_568_877, 1.0),
        );
        let spin = place(i, 0.236_067_977_499_79, 360.0);
        text += &format!(
            "triangle {{ centroid ({x}, {y}, {z}) normal ({nx}, {ny}, 1) sides (4, 4, 0.02) spin {spin}deg }}\n"
        );
    }
    text
}

fn read(text: &str) -> Scene {
    let sources = Sources::new(Source::from_text("a.scn", text));
    scene::read(&sources)
        .scene
        .expect("a scene without mistakes")
}

fn example(name: &str) -> Scene {
    let path = format!("{}/examples/{name}.scn", env!("CARGO_MANIFEST_DIR"));
    read(&fs::read_to_string(path).expect("the example is there"))
}

/// Returns the scene with a picture that is `width` pixels wide, has an aspect ratio of 16:9, and
/// has `per_pixel` samples per pixel.
fn sized(scene: &Scene, width: u32, method: Method, per_pixel: u64) -> Scene {
    let mut scene = scene.clone();
    (scene.image.width, scene.image.height) = (width, width * 9 / 16);
    (scene.sampler.method, scene.sampler.count) = (method, Count::PerPixel(per_pixel));
    scene
}

fn control(threads: Option<NonZero<usize>>) -> Control<'static> {
    static CANCEL: AtomicBool = AtomicBool::new(false);
    Control {
        threads,
        progress: &|_| {},
        cancel: &CANCEL,
    }
}

/// Returns a function that renders the scene in the way `way` on one thread.
fn picture(scene: &Scene, way: Way) -> impl Fn() + use<> {
    let [width, height] = [scene.image.width, scene.image.height];
    let (world, sampling) = (
        World::new(scene),
        Sampling::new(&scene.sampler, width, height),
    );
    move || {
        let whole = Area::whole(width, height);
        let film = match way {
            Way::OneByOne => Ok(one_by_one(&world, &sampling, whole)),
            Way::Culled => render(&world, &sampling, whole, &control(NonZero::new(1))),
        };
        black_box(film.expect("there is memory for it"));
    }
}

/// Measures how much time it costs to decide without rounding errors which surface a ray hits.
/// Compares the rays per CPU second of three ways: textbook formulas, whose rounding errors cause
/// some wrong decisions; exact decisions with each sample traced alone; and exact decisions with
/// culling. All three include the time to generate the sample points.
fn price() {
    const SECONDS: f64 = 2.0;
    let scene = sized(&example("figure_9_9"), 640, Method::MultiJittered, 64);
    let rays = f64::from(640 * 360 * 64);
    let names = ["a textbook's formulas", "one by one", "culled"];
    let ways: [Box<dyn Fn()>; 3] = [
        Box::new(textbook(&scene)),
        Box::new(picture(&scene, Way::OneByOne)),
        Box::new(picture(&scene, Way::Culled)),
    ];
    let mut best = [0.0_f64; 3];
    for _ in 0..ROUNDS {
        for (way, best) in ways.iter().zip(&mut best) {
            let (start, mut pictures, mut seconds) = (clock::cpu_seconds(), 0.0, 0.0);
            while seconds < SECONDS {
                way();
                pictures += 1.0;
                seconds = clock::cpu_seconds() - start;
            }
            *best = best.max(pictures * rays / seconds);
        }
    }
    for (name, rate) in names.iter().zip(best) {
        println!(
            "{name:40} {:10.1} million rays a CPU second, {:.2} of a textbook's time",
            rate / 1e6,
            best[0] / rate
        );
    }
}

/// Returns a function that traces each sample with the formulas of a textbook.
fn textbook(scene: &Scene) -> impl Fn() {
    let [width, height] = [scene.image.width, scene.image.height];
    let (textbook, objects) = (Textbook::new(scene), scene.objects.len());
    let sampling = Sampling::new(&scene.sampler, width, height);
    move || {
        let mut points = Points::default();
        let mut seen = vec![0_u64; 2 * objects];
        for (x, y) in Area::whole(width, height).iter() {
            let count = sampling.count(x, y);
            sampling.place(SimdWidth::Widest, [x, y], count, 0..count, &mut points);
            for offset in points.iter() {
                let middle = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                if let Some(hit) = textbook.seen(middle + offset) {
                    seen[2 * hit.object + usize::from(hit.odd)] += 1;
                }
            }
        }
        black_box(seen);
    }
}

/// Measures the time to compute the exact mean colour of each pixel (`render_exact`) in the example
/// scene `figure_9_9`, with and without a far plane. Compares it with the time of tracing 1, 2 and
/// 4 samples per pixel, each sample alone. The measurements alternate, so that other work on the
/// machine affects all of them.
fn exact() {
    const FEW: [u64; 3] = [1, 2, 4];
    println!("one thread; exact by the time of so many samples a pixel one by one, random");
    println!("{:40} {:>10} {:>7} {:>7} {:>7}", "", "s", 1, 2, 4);
    for ([width, height], far) in [
        ([512, 512], Some(100.0)),
        ([512, 512], Some(1000.0)),
        ([512, 512], None),
        ([1280, 720], None),
    ] {
        let mut scene = example("figure_9_9");
        (scene.image.width, scene.image.height, scene.camera.far) = (width, height, far);
        let world = World::new(&scene);
        let certain = || {
            let whole = Area::whole(width, height);
            let exact = render_exact(&world, whole, &control(NonZero::new(1)));
            black_box(exact.expect("there is memory for it"));
        };
        let sampled = FEW.map(|per_pixel| {
            (scene.sampler.method, scene.sampler.count) =
                (Method::Random, Count::PerPixel(per_pixel));
            picture(&scene, Way::OneByOne)
        });
        let seconds = |work: &dyn Fn()| {
            let start = clock::cpu_seconds();
            work();
            clock::cpu_seconds() - start
        };
        let (mut least, mut of_samples) = (f64::MAX, [f64::MAX; FEW.len()]);
        for _ in 0..10 {
            least = least.min(seconds(&certain));
            for (picture, least) in sampled.iter().zip(&mut of_samples) {
                *least = least.min(seconds(picture));
            }
        }
        let far = far.map_or("endless".to_owned(), |far| format!("far {far}"));
        let [one, two, four] = of_samples.map(|seconds| least / seconds);
        println!(
            "{:40} {least:10.3} {one:7.2} {two:7.2} {four:7.2}",
            format!("figure 9.9, {width} × {height}, {far}")
        );
    }
}

/// Renders the example scene `figure_9_9` on one thread and prints the CPU time. The program then
/// ends, so an outside tool can measure the whole process.
///
/// `arguments` are the way of tracing, the sampling method, the picture's width, the samples per
/// pixel, and the number of pictures. If the way is not the name of a [`Way`], nothing is rendered:
/// an outside tool then measures the preparation alone.
fn once(arguments: &[String]) {
    let [way, method, numbers @ ..] = arguments else {
        panic!("--once WAY METHOD WIDTH SAMPLES TIMES");
    };
    let number = |at: usize| -> u32 { numbers[at].parse().expect("a number") };
    let mut methods = Method::SAMPLED.into_iter();
    let method = methods.find(|known| known.name() == method);
    let scene = sized(
        &example("figure_9_9"),
        number(0),
        method.expect("a method's name"),
        u64::from(number(1)),
    );
    let known = WAYS.into_iter().find(|known| format!("{known:?}") == *way);
    let picture = picture(&scene, known.unwrap_or(Way::Culled));
    if known.is_none() {
        return;
    }
    let start = clock::cpu_seconds();
    (0..number(2)).for_each(|_| picture());
    let seconds = clock::cpu_seconds() - start;
    let samples = f64::from(number(0)) * f64::from(number(0) * 9 / 16) * f64::from(number(1));
    println!(
        "{way}: {:.2} CPU s a picture, {:.1} million samples a CPU second",
        seconds / f64::from(number(2)),
        samples * f64::from(number(2)) / seconds / 1e6
    );
}

/// Measures the time to render a scene with culling, and to trace each of its samples alone. Prints
/// the ratio of the times. The measurements alternate, so that other work on the machine slows down
/// both.
fn ratios(name: &str, scene: &Scene) {
    let pictures = WAYS.map(|way| picture(scene, way));
    let mut best = [f64::MAX; WAYS.len()];
    for _ in 0..ROUNDS {
        for (picture, best) in pictures.iter().zip(&mut best) {
            let start = clock::cpu_seconds();
            picture();
            *best = best.min(clock::cpu_seconds() - start);
        }
    }
    let [one, culled] = best;
    let sampling = Sampling::new(&scene.sampler, scene.image.width, scene.image.height);
    let rate = sampling.total() as f64 / one / 1e6;
    println!("{name:40} {rate:10.1} {:10.2}", one / culled);
}
