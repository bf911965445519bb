//! Whether culling is ever slower than tracing one by one: `cargo bench --bench sweep`. See README.md beside this file.
//!
//! Scenes of eight kinds, with few and many objects, small and large, in pictures of few and many pixels with few and many samples.

mod clock;
mod spheres;

use std::{env, fmt::Write, hint::black_box, num::NonZero, sync::atomic::AtomicBool};

use pinhole::{
    area::Area,
    film::Film,
    render::{Control, Way, render_in_a_way},
    sampling::Sampling,
    scene::{self, Count, Method, Scene},
    source::{Source, Sources},
    tracer::World,
};

use self::spheres::Random;

/// What a scene is full of.
#[derive(Clone, Copy, Debug)]
enum Kind {
    Spheres,
    /// Long and thin triangles.
    Slivers,
    Triangles,
    Boxes,
    /// Spheres, every tenth of them ten times as large.
    Mixed,
    /// Boards, which have no end.
    Boards,
    /// Triangles that hide each other, nearly.
    Layers,
    /// Triangles at one place.
    Equal,
}

const KINDS: [Kind; 8] = [
    Kind::Spheres,
    Kind::Slivers,
    Kind::Triangles,
    Kind::Boxes,
    Kind::Mixed,
    Kind::Boards,
    Kind::Layers,
    Kind::Equal,
];
const COUNTS: [usize; 7] = [3, 30, 300, 3_000, 12_000, 20_000, 100_000];
/// The pictures' widths.
const WIDTHS: [u32; 3] = [48, 192, 768];
/// The objects' sizes, in heights of the picture.
const SIZES: [f64; 3] = [0.003, 0.03, 0.3];
const SAMPLES: [u64; 8] = [1, 2, 3, 4, 8, 9, 16, 64];

/// A picture with more samples says little that one with fewer does not, and is made of few scenes.
const MOST_SAMPLES: u64 = 1 << 20;
const MOST_SAMPLES_OF_FEW: u64 = 1 << 25;
const FEW: [usize; 2] = [30, 3_000];

/// A way is timed for so many seconds at least, in turns with the other.
const SECONDS: f64 = 0.02;
const ROUNDS: usize = 3;

/// A picture with a lower ratio is timed for longer.
const DOUBTED: f64 = 0.95;

/// What was measured of a scene.
struct Measured {
    name: String,
    /// One by one, over culled.
    ratio: f64,
}

fn main() {
    // `cargo test` builds and runs benchmarks too; there is nothing to test here.
    let arguments: Vec<String> = env::args().collect();
    if !arguments.iter().any(|argument| argument == "--bench") {
        return;
    }
    // All pictures are made by the same thread, not each by one that is started for it.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    pool.expect("there is a thread for it").install(|| {
        match arguments.iter().position(|argument| argument == "--once") {
            Some(at) => once(&arguments[at + 1..]),
            None => compare(&arguments[1..]),
        }
    });
}

/// Compares both ways in all pictures, or in those whose names contain all words that are given.
fn compare(arguments: &[String]) {
    let words = || arguments.iter().filter(|it| !it.starts_with("--"));
    let wanted = |name: &str| words().all(|word| name.contains(word.as_str()));
    let mut all = Vec::new();
    for_each(&wanted, &mut |name, scene, world| {
        let ratio = ratio(scene, world);
        println!("{name:60} {ratio:6.2}");
        all.push(Measured { name, ratio });
    });
    all.sort_unstable_by(|a, b| a.ratio.total_cmp(&b.ratio));
    let below = |limit: f64| all.iter().filter(|measured| measured.ratio < limit).count();
    println!(
        "{} pictures; below 0.9 of one by one: {}, below 1: {}, below 1.5: {}; the worst:",
        all.len(),
        below(0.9),
        below(1.0),
        below(1.5),
    );
    for Measured { name, ratio } in all.iter().take(40) {
        println!("{ratio:6.2} {name}");
    }
}

/// Renders one picture in one way so many times, for those who measure processes.
fn once(arguments: &[String]) {
    let [name, way, times] = arguments else {
        panic!("--once NAME WAY TIMES");
    };
    let way = match way.as_str() {
        "OneByOne" => Way::OneByOne,
        "Culled" => Way::Culled,
        other => panic!("{other} is none of OneByOne and Culled"),
    };
    let times: u32 = times.parse().expect("a number");
    let mut is_known = false;
    for_each(&|known| known == name, &mut |_, scene, world| {
        is_known = true;
        for _ in 0..times {
            picture(scene, world, way);
        }
    });
    assert!(is_known, "there is no picture of this name: {name}");
}

/// Every scene of the sweep in every size whose name is wanted.
fn for_each(wanted: &dyn Fn(&str) -> bool, visit: &mut dyn FnMut(String, &Scene, &World)) {
    for kind in KINDS {
        for count in COUNTS {
            for size in SIZES {
                pictures(kind, count, size, wanted, visit);
            }
        }
    }
}

/// The pictures of one scene.
fn pictures(
    kind: Kind,
    count: usize,
    size: f64,
    wanted: &dyn Fn(&str) -> bool,
    visit: &mut dyn FnMut(String, &Scene, &World),
) {
    let apart = count as f64 * size * size;
    let layers = match kind {
        // Every tenth covers a hundred times as much.
        Kind::Mixed => 11.0 * apart,
        // All are in a ray's way.
        Kind::Boards | Kind::Layers | Kind::Equal => count as f64,
        Kind::Spheres | Kind::Slivers | Kind::Triangles | Kind::Boxes => apart,
    };
    if layers > 300.0 {
        // A ray would meet hundreds of objects.
        return;
    }
    let mut scene = None;
    for width in WIDTHS {
        let height = width * 9 / 16;
        let pixels = u64::from(width) * u64::from(height);
        let most = match FEW.contains(&count) && size == SIZES[1] {
            true => MOST_SAMPLES_OF_FEW,
            false => MOST_SAMPLES,
        };
        let samples = SAMPLES
            .into_iter()
            .filter(|samples| samples * pixels <= most);
        let named = samples.map(|samples| {
            let name =
                format!("{count} {kind:?} of {size} at {width} × {height}, {samples} a pixel");
            (name, samples)
        });
        let named: Vec<_> = named.filter(|(name, _)| wanted(name)).collect();
        if named.is_empty() {
            continue;
        }
        let scene = scene.get_or_insert_with(|| read(scene_text(kind, count, size)));
        (scene.image.width, scene.image.height) = (width, height);
        let world = World::new(scene);
        for (name, samples) in named {
            scene.sampler.method = Method::Hammersley;
            scene.sampler.count = Count::PerPixel(samples);
            visit(name, scene, &world);
        }
    }
}

fn read(text: String) -> Scene {
    let sources = Sources::new(Source::from_text("a.scn", text));
    let reading = scene::read(&sources);
    reading.scene.expect("a scene without mistakes")
}

/// How many times as fast culling is, by the least CPU times of both, taken in turns on one thread.
fn ratio(scene: &Scene, world: &World) -> f64 {
    let seconds = |way: Way| {
        let start = clock::cpu_seconds();
        picture(scene, world, way);
        clock::cpu_seconds() - start
    };
    let [mut one, mut culled] = [Way::OneByOne, Way::Culled].map(seconds);
    let times = (SECONDS / culled).ceil().clamp(1.0, 20.0) as usize;
    for round in 0..4 * ROUNDS * times {
        // What seems to be slower may have met a busy moment.
        if round >= ROUNDS * times && one >= DOUBTED * culled {
            break;
        }
        one = one.min(seconds(Way::OneByOne));
        culled = culled.min(seconds(Way::Culled));
    }
    one / culled
}

fn picture(scene: &Scene, world: &World, way: Way) {
    let [width, height] = [scene.image.width, scene.image.height];
    let sampling = Sampling::new(&scene.sampler, width, height);
    let whole = Area::whole(width, height);
    let film: Result<Film, _> = render_in_a_way(world, &sampling, whole, &control(), way);
    black_box(film.expect("there is memory for it"));
}

fn control() -> Control<'static> {
    static CANCEL: AtomicBool = AtomicBool::new(false);
    Control {
        threads: NonZero::new(1),
        progress: &|_| {},
        cancel: &CANCEL,
    }
}

/// So many objects of a size, all over the picture and at distances from 5 to 50.
fn scene_text(kind: Kind, count: usize, size: f64) -> String {
    let mut random = Random(1);
    let side = 5.0 * size;
    let mut text =
        String::from("camera { eye (0, 0, 0)  direction (0, 0, -1)  d 2  view_height 2 }\n");
    for index in 0..count {
        let depth = 5.0 * libm::exp10(random.between(0.0, 1.0));
        // The picture's height there.
        let height = depth;
        let x = random.between(-0.92, 0.92) * height;
        let y = random.between(-0.52, 0.52) * height;
        let size = random.between(0.6, 1.4) * size * height;
        let color = index % 0xfff;
        let [a, b, c] = [(); 3].map(|()| random.between(-1.0, 1.0));
        let _ = match kind {
            Kind::Spheres | Kind::Mixed => {
                let is_large = matches!(kind, Kind::Mixed) && index % 10 == 0;
                let radius = if is_large { 5.0 * size } else { size / 2.0 };
                writeln!(
                    text,
                    "sphere {{ center ({x}, {y}, -{depth})  radius {radius}  color #{color:03x} }}",
                )
            }
            Kind::Triangles => writeln!(
                text,
                "triangle {{ centroid ({x}, {y}, -{depth})  normal ({a}, {b}, 1)  sides ({size}, {size}, {size})  color #{color:03x} }}",
            ),
            Kind::Slivers => writeln!(
                text,
                "triangle {{ centroid ({x}, {y}, -{depth})  normal ({a}, {b}, 1)  spin {}rad  sides ({size}, {size}, {})  color #{color:03x} }}",
                3.0 * c,
                size / 50.0
            ),
            Kind::Boxes => writeln!(
                text,
                "box {{ center ({x}, {y}, -{depth})  size ({size}, {}, {size})  color #{color:03x} }}",
                size * (1.5 + c)
            ),
            Kind::Boards => writeln!(
                text,
                "checkerboard {{ y {}  square {size}  colors (#{color:03x}, white) }}",
                a * 3.0
            ),
            Kind::Layers => writeln!(
                text,
                "triangle {{ centroid (0, 0, -{depth})  normal (0, 0, 1)  sides ({size}, {size}, {size})  color #{color:03x} }}",
            ),
            Kind::Equal => writeln!(
                text,
                "triangle {{ centroid (0, 0, -5)  normal (0.3, 0, 1)  sides ({side}, {side}, {side})  color #{color:03x} }}",
            ),
        };
    }
    text
}
