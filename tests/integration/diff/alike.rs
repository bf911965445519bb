//! Right pictures whose samples are at the same places in all pixels, as programs without a sampler of their own have them; and mistakes
//! in such pictures.

use std::fmt::Write;

use glam::DVec2;
use pinhole::{
    film::Film,
    sampling::CounterRng,
    scene::{Lens, Scene, Shape},
    tracer::World,
};
use rand::{RngExt, SeedableRng};

use super::{
    SCENE,
    right::{DOT, DOTS, LEVEL, Subject},
};
use crate::effort::{Effort, sampled_and_exhaustive};
use crate::exact::{example, examples, read};

/// Boxes whose edges lie along pixels' sides, and a ball.
const STEPS: &str = "image { background navy }
camera { eye (0, 0, 20) lookat (0, 0, 0) view_height 9 d 20 }
box One { min (-5, -3, -1) max (-1, 2, 0) color orange }
box Other { min (1, -2, -1) max (6, 1, 0) color teal }
sphere { center (3, 2, 1) radius 1 color olive }
";

/// Some samples in a pixel, from its left and upper edge.
type Set = (String, Vec<DVec2>);

fn radical_inverse(mut index: u64, base: u64) -> f64 {
    let (mut inverse, mut digit) = (0.0, 1.0);
    while index > 0 {
        digit /= base as f64;
        inverse += digit * (index % base) as f64;
        index /= base;
    }
    inverse
}

/// Random numbers between 0 and 1.
fn chance(seed: u64) -> impl FnMut() -> f64 {
    let mut rng = CounterRng::seed_from_u64(seed);
    move || rng.random()
}

fn hammersley(samples: u64) -> Set {
    let point = |i| DVec2::new(i as f64 / samples as f64, radical_inverse(i, 2));
    (
        format!("hammersley {samples}"),
        (0..samples).map(point).collect(),
    )
}

fn halton(samples: u64) -> Set {
    let point = |i| DVec2::new(radical_inverse(i, 2), radical_inverse(i, 3));
    (
        format!("halton {samples}"),
        (1..=samples).map(point).collect(),
    )
}

fn random(samples: u64) -> Set {
    let mut chance = chance(samples);
    let points = (0..samples).map(|_| DVec2::new(chance(), chance()));
    (format!("random {samples}"), points.collect())
}

fn jittered(side: u64) -> Set {
    let mut chance = chance(side);
    let points = (0..side * side).map(|cell| {
        let corner = DVec2::new((cell % side) as f64, (cell / side) as f64);
        (corner + DVec2::new(chance(), chance())) / side as f64
    });
    (format!("jittered {}", side * side), points.collect())
}

fn corners(side: u64) -> Set {
    let cells = 0..side * side;
    let points = cells.map(|cell| DVec2::new((cell % side) as f64, (cell / side) as f64));
    (
        format!("corners {}", side * side),
        points.map(|point| point / side as f64).collect(),
    )
}

/// Hammersley's first sample is at a pixel's corner, and sees what is beyond an edge that runs along a side.
fn sets() -> Vec<Set> {
    vec![
        hammersley(16),
        random(4),
        jittered(4),
        halton(9),
        random(9),
        hammersley(64),
        random(16),
        halton(100),
        jittered(2),
        halton(16),
        hammersley(25),
        random(64),
        halton(256),
        random(36),
    ]
}

/// The picture of a scene with these samples in each pixel.
fn picture(scene: &Scene, samples: &[DVec2]) -> Film {
    let world = World::new(scene);
    let colors = world.palette().iter().map(|color| color.to_linear());
    let colors: Vec<_> = colors.collect();
    Film::from_fn(scene.image.width, scene.image.height, |x, y| {
        let mut mean = [0.0; 3];
        for sample in samples {
            let color = colors[world.slot_at(x, y, *sample - 0.5)];
            for (mean, light) in mean.iter_mut().zip(color) {
                *mean += light / samples.len() as f64;
            }
        }
        mean
    })
    .unwrap()
}

/// Pictures that are hard to tell from a mistake: whose edges run along pixels' sides, with a sample on one, or of which the pixels that are
/// wrong are few, and all see the same object.
const HARD: [(&str, &str); 9] = [
    ("in_a_faces_plane.scn", "hammersley 16"),
    ("in_the_floors_plane.scn", "hammersley 16"),
    ("in_the_floors_plane.scn", "jittered 16"),
    ("in_the_floors_plane.scn", "halton 9"),
    ("on_the_surface.scn", "random 16"),
    ("straight_down.scn", "hammersley 64"),
    ("straight_up.scn", "hammersley 25"),
    ("vanishing_point.scn", "hammersley 25"),
    ("level", "hammersley 16"),
];

sampled_and_exhaustive!(nobody_is_blamed_for_samples_at_the_same_places_in_all_pixels);

/// `PINHOLE_SEEDS=1` grades each scene with all sets of samples, some four hundred pictures; without it each has one, beside those that are
/// hard. A sample is one scene.
fn nobody_is_blamed_for_samples_at_the_same_places_in_all_pixels(effort: Effort) {
    let names = examples().into_iter();
    let mut scenes: Vec<_> = names.map(|name| (example(&name, 1, 1), name)).collect();
    for (name, text) in [("dot", DOT), ("dots", DOTS), ("level", LEVEL)] {
        scenes.push((read(text), name.to_owned()));
    }
    if effort == Effort::Sample {
        scenes.retain(|(_, name)| name == "dot");
    }
    let is_all = std::env::var("PINHOLE_SEEDS").is_ok();
    let sets = sets();
    let (mut blamed, mut pictures) = (String::new(), 0);
    for (at, (scene, name)) in scenes.iter().enumerate() {
        let size = [[160, 90], [240, 135]][at % 2];
        let subject = Subject::new(scene, size);
        for (place, (set, samples)) in sets.iter().enumerate() {
            let is_its_turn = place == at % sets.len();
            let is_hard = HARD.contains(&(name, set));
            if !is_all && !is_its_turn && !is_hard {
                continue;
            }
            pictures += 1;
            let found = subject.graded(&picture(subject.scene(), samples));
            let Some(found) = found else { continue };
            let words = match found.likely.first() {
                Some(first) => {
                    let is_corner = first.message.contains("corners of its cells");
                    match first.mistake == "noise" && !is_corner {
                        true => continue,
                        false => first.message.clone(),
                    }
                }
                None if found.may_be_noise || found.is_thin => continue,
                None => "no simple mistake explains it".to_owned(),
            };
            writeln!(blamed, "{name} {size:?} {set}: {words}").unwrap();
        }
    }
    assert!(
        blamed.is_empty(),
        "{} of {pictures} pictures:\n{blamed}",
        blamed.lines().count()
    );
}

/// Programs that round see what is on an edge on one side of it or on the other.
#[test]
#[ignore = "exhaustive"]
fn nobody_is_blamed_for_what_is_seen_on_an_edge() {
    let subject = Subject::new(&read(STEPS), [160, 90]);
    for (right, down) in [(-1e-12, -1e-12), (1e-12, -1e-12), (-1e-12, 1e-12)] {
        let (set, mut samples) = hammersley(16);
        for sample in &mut samples {
            *sample += DVec2::new(right, down);
        }
        let found = subject.graded(&picture(subject.scene(), &samples)).unwrap();
        let accused = found
            .likely
            .first()
            .filter(|first| first.mistake != "noise");
        let words = accused.map(|first| &first.message);
        assert_eq!(words, None, "{set}, {right} {down}");
        assert!(
            found.may_be_noise || !found.likely.is_empty(),
            "{set}, {right} {down}"
        );
    }
}

#[test]
#[ignore = "exhaustive"]
fn samples_at_the_corners_of_their_cells_are_named() {
    let subject = Subject::new(&example("figure_9_9.scn", 1, 1), [160, 90]);
    for side in [2, 4] {
        let (set, samples) = corners(side);
        for is_lower in [false, true] {
            let samples: Vec<_> = (samples.iter())
                .map(|sample| match is_lower {
                    true => DVec2::new(sample.x, (1.0 - sample.y).min(1.0f64.next_down())),
                    false => *sample,
                })
                .collect();
            let found = subject.graded(&picture(subject.scene(), &samples)).unwrap();
            let words = format!(
                "{} samples in each pixel, a grid at the same places in all of them, at the {} left corners",
                side * side,
                if is_lower { "lower" } else { "upper" }
            );
            let message = &found.likely[0].message;
            assert!(message.contains(&words), "{set}: {message}");
        }
    }
}

sampled_and_exhaustive!(mistakes_are_named_in_pictures_of_the_same_samples_in_all_pixels);

fn mistakes_are_named_in_pictures_of_the_same_samples_in_all_pixels(effort: Effort) {
    let subject = Subject::new(&read(SCENE), [160, 90]);
    type Wrong = fn(&mut Scene);
    let cases: [(&str, Wrong); 5] = [
        ("roll_sign", |scene| scene.camera.roll = -scene.camera.roll),
        // That is half a turn.
        ("turned_180", |scene| scene.camera.up = -scene.camera.up),
        ("distance", |scene| scene.camera.lens = Lens::Distance(2.1)),
        ("object_place", |scene| {
            for object in &mut scene.objects {
                if let Shape::Sphere(sphere) = &mut object.shape {
                    sphere.center.x += 0.1;
                }
            }
        }),
        ("color", |scene| {
            for object in &mut scene.objects {
                if let Shape::Sphere(sphere) = &mut object.shape {
                    sphere.color.srgb = [255.0, 0.0, 0.0];
                }
            }
        }),
    ];
    let mut said = String::new();
    for (mistake, wrong) in effort.of(cases) {
        let mut scene = subject.scene().clone();
        wrong(&mut scene);
        for (set, samples) in effort.of([hammersley(16), random(4), random(16), halton(25)]) {
            let found = subject.graded(&picture(&scene, &samples)).unwrap();
            let first = found.likely.first();
            // Beside a number what the samples displace may be told, too; and where they are few, or by chance, a place may not be told at all.
            let is_right = match (mistake, first) {
                ("distance", Some(first)) => first.message.contains("d were 2.1 "),
                ("object_place", None) => set.starts_with("random"),
                (_, first) => first.is_some_and(|first| first.mistake == mistake),
            };
            if !is_right {
                let words = first.map_or("nothing", |first| &first.message);
                writeln!(said, "{mistake}, {set}: {words}").unwrap();
            }
        }
    }
    assert!(said.is_empty(), "{said}");
}
