//! Right pictures, in which nothing but their samples differs from the exact one: nobody is blamed for that.

use std::{fmt::Write, sync::atomic::AtomicBool};

use pinhole::{
    area::Area,
    film::{self, Film, Tolerance},
    grade::{self, Grade},
    render::{self, Control},
    sampling::Sampling,
    scene::{Count, Method, Sampler, Scene},
    tracer::World,
};

use crate::{
    effort::{Effort, sampled_and_exhaustive},
    exact::{example, examples, read},
};

/// A single small object: some two dozen pixels see its edge, and all others are right whatever the samples are.
pub const DOT: &str = "image { background black }
camera { eye (0, 0, 8) lookat (0, 0, 0) fov 40deg }
sphere Dot { center (0.5, 0.3, 0) radius 0.15 color red }
";

/// Two of them, which differ from their places in fewer pixels than name a mistake.
pub const DOTS: &str = "image { background black }
camera { eye (0, 0, 8) lookat (0, 0, 0) fov 40deg }
sphere One { center (0.5, 0.3, 0) radius 0.05 color red }
sphere Other { center (-0.5, 0.3, 0) radius 0.04 color red }
";

/// A board's lines that are parallel to the picture's edges, and lie where strata begin.
pub const LEVEL: &str = "camera { eye (0, 8, 0) direction (0, -1, 0) d 2 }
sphere { center (0, 1, -2) color olive }
checkerboard {}
";

const SIZES: [[u32; 2]; 3] = [[60, 34], [160, 90], [240, 135]];
const COUNTS: [u64; 6] = [1, 4, 9, 16, 25, 49];

/// What may be said of such a picture.
const NO_BLAME: [&str; 3] = ["noise", "sample_at_center", "sample_at_corner"];

sampled_and_exhaustive!(nobody_is_blamed_for_samples);

/// `PINHOLE_SEEDS=4` grades each scene in each size by each method with each number of samples and four seeds, some twenty thousand
/// pictures; without it each scene has one picture by each method.
fn nobody_is_blamed_for_samples(effort: Effort) {
    let names = examples().into_iter();
    let mut scenes: Vec<_> = names.map(|name| (example(&name, 1, 1), name)).collect();
    for (name, text) in [("dot", DOT), ("dots", DOTS), ("level", LEVEL)] {
        scenes.push((read(text), name.to_owned()));
    }
    let seeds = std::env::var("PINHOLE_SEEDS").ok();
    let seeds = seeds.map(|seeds| seeds.parse::<u64>().unwrap());
    let (mut blamed, mut pictures) = (String::new(), 0);
    for (at, (scene, name)) in effort.of(scenes.iter().enumerate()) {
        for (place, size) in SIZES.into_iter().enumerate() {
            // A picture of the largest size takes as long as a dozen of the smallest.
            if seeds.is_none() && place != at % 2 {
                continue;
            }
            let subject = Subject::new(scene, size);
            for (row, method) in Method::SAMPLED.into_iter().enumerate() {
                for (column, samples) in COUNTS.into_iter().enumerate() {
                    if seeds.is_none() && column != (at + row) % COUNTS.len() {
                        continue;
                    }
                    for seed in 1..=seeds.unwrap_or(1) {
                        pictures += 1;
                        let Err(words) = subject.grade(method, samples, seed) else {
                            continue;
                        };
                        let [width, height] = size;
                        let line = format!(
                            "{name} {width}x{height} {} {samples} seed {seed}: {words}",
                            method.name()
                        );
                        writeln!(blamed, "{line}").unwrap();
                    }
                }
            }
        }
    }
    assert!(
        blamed.is_empty(),
        "{} of {pictures} pictures:\n{blamed}",
        blamed.lines().count()
    );
}

/// Of two hundred thousand pixels a few have no sample at all where there are eleven in each on an average, and chance has it.
#[test]
#[ignore = "exhaustive"]
fn nobody_is_blamed_for_a_few_pixels_without_samples() {
    let scene = example("figure_9_9.scn", 1, 1);
    let subject = Subject::new(&scene, [640, 360]);
    for (samples, seed) in [(11, 3), (12, 4)] {
        let graded = subject.grade(Method::Scatter, samples, seed);
        assert_eq!(graded, Ok(()), "{samples}, {seed}");
    }
}

/// A scene and its exact picture.
pub struct Subject {
    scene: Scene,
    exact: render::Exact,
}

impl Subject {
    pub fn new(scene: &Scene, [width, height]: [u32; 2]) -> Self {
        let mut scene = scene.clone();
        (scene.image.width, scene.image.height) = (width, height);
        let exact = render::render_exact(
            &World::new(&scene),
            Area::whole(width, height),
            &control(&AtomicBool::new(false)),
        );
        Self {
            scene,
            exact: exact.unwrap(),
        }
    }

    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    pub fn exact(&self) -> &Film {
        &self.exact.film
    }

    /// What is said of a picture's bytes, if they differ by more than rounding.
    pub fn graded(&self, means: &Film) -> Option<Grade> {
        let cancel = AtomicBool::new(false);
        let mut file = Vec::new();
        film::write_plain_png(means, &mut file).unwrap();
        let picture = film::read_picture(&file).unwrap();
        let tolerance = Tolerance {
            steps: picture.rounding.steps(),
            bounds: Some(&self.exact.bounds),
        };
        let compared = film::compare(&picture.film, &self.exact.film, tolerance).unwrap();
        (!compared.is_equal()).then(|| {
            let (exact, control) = (&self.exact.film, control(&cancel));
            grade::scene(&picture.film, &self.scene, exact, &control).unwrap()
        })
    }

    /// What is said of a right picture, if that is an accusation.
    fn grade(&self, method: Method, samples: u64, seed: u64) -> Result<(), String> {
        let sampler = Sampler {
            method,
            count: Count::PerPixel(samples),
            seed,
        };
        let [width, height] = [self.exact.film.width(), self.exact.film.height()];
        let cancel = AtomicBool::new(false);
        let control = control(&cancel);
        let means = render::render(
            &World::new(&self.scene),
            &Sampling::new(&sampler, width, height),
            Area::whole(width, height),
            &control,
        );
        match self.graded(&means.unwrap()) {
            Some(found) => verdict(&found, method, samples),
            None => Ok(()),
        }
    }
}

fn verdict(found: &Grade, method: Method, samples: u64) -> Result<(), String> {
    let Some(first) = found.likely.first() else {
        return match found.is_thin {
            true => Ok(()),
            false => Err("no simple mistake explains it".to_owned()),
        };
    };
    let is_of_grid = first.message.contains("a grid");
    let is_its_grid = method == Method::Regular
        && [samples.to_string(), "a few".to_owned()]
            .iter()
            .any(|many| first.message.contains(&format!("of {many} samples")));
    // Samples of all methods but that one are at other places in each pixel.
    let is_alike = first.message.contains("at the same places in all pixels");
    match NO_BLAME.contains(&first.mistake) && !is_alike && (!is_of_grid || is_its_grid) {
        true => Ok(()),
        false => Err(first.message.clone()),
    }
}

fn control(cancel: &AtomicBool) -> Control<'_> {
    Control {
        threads: None,
        progress: &|_| {},
        cancel,
    }
}
