//! Tests of grading. The library judges pictures that an independent ray tracer renders, and the
//! command `grade` judges classes.

mod archives;
mod case;
mod classes;
mod command;
mod forms;
mod hits;
mod mistakes;
mod scenes;
mod textbook;

use std::sync::atomic::AtomicBool;

use pinhole::{
    area::Area,
    film::{self, Film, Jpeg, Picture, Rounding},
    grading::{self, Reference},
    render::Control,
    scene,
    source::{Source, Sources},
};
use png::{BitDepth, ColorType};
use rayon::prelude::*;
use serde_json::Value;

use self::case::Case;
use crate::{
    effort::{Effort, sampled_and_exhaustive},
    images,
};

/// Titles of pictures, one per line: correct pictures by every way of sampling, and pictures with
/// the mistakes that students make. Each picture has enough samples per pixel for its mistake to
/// stand out from the noise; a mistake that changes the whole picture only slightly needs many.
const PICTURES: &str = include_str!("pictures.txt");

sampled_and_exhaustive!(the_mistakes_of_a_class_are_named);

fn the_mistakes_of_a_class_are_named(effort: Effort) {
    let cases: Vec<Case> = PICTURES.lines().map(Case::of).collect();
    for id in grading::mistake_ids() {
        let mistakes = cases.iter().flat_map(|case| &case.mistakes);
        let mut words = mistakes.flat_map(|mistake| mistake.name.split(['|', ' ']));
        assert!(words.any(|word| word == id), "{id} is nowhere");
    }
    let cases: Vec<&Case> = effort.first(8, &cases).collect();
    let judged: Vec<String> = cases.into_par_iter().filter_map(wrongly_judged).collect();
    assert!(judged.is_empty(), "{}", judged.join("\n"));
}

/// Makes each mistake in each scene. This must not panic, even if the scene lacks the object that
/// the mistake is about.
#[test]
fn every_mistake_can_be_made_in_every_scene() {
    for name in [
        "figure",
        "street",
        "clipped",
        "cut",
        "lens",
        "low",
        "painted",
        "sunk",
        "backwards",
        "leaning",
        "level",
        "empty",
    ] {
        let (mut right, _) = scenes::scene(name);
        if name == "empty" {
            right.objects.clear();
        }
        for mistake in mistakes::GROUPS.into_iter().flatten() {
            mistake.make(&mut right.clone());
        }
    }
}

/// Judges the picture of a case. If the verdict is wrong, returns the title of the case and the
/// verdict.
fn wrongly_judged(case: &Case) -> Option<String> {
    let picture = case.picture();
    let size = picture.dimensions().into();
    let file = images::png(size, ColorType::Rgb, BitDepth::Eight, picture.as_raw());
    let answer = answer(&case.text, &[], &file);
    // The mistake `half_pixel` shifts all samples by half a pixel. If it is really there, it
    // explains most of the difference between the pictures. A `half_pixel` that explains less than
    // half of the difference is therefore a wrong answer.
    let is_half = |one: &Value| one["id"] == "half_pixel" && one["explains"].as_f64() < Some(0.5);
    let mut mistakes = answer["mistakes"].as_array().unwrap().iter();
    if !case.is_judged_correctly(&answer) || mistakes.any(is_half) {
        return Some(format!("{}: {}", case.title, answer["line"]));
    }
    // With the reported `--set` arguments, the picture of the scene must be equal to the judged
    // picture.
    let sets = answer["mistakes"].as_array().unwrap().iter();
    let sets: Vec<Vec<&str>> = sets
        .map(|one| {
            let set = one["set"].as_array().unwrap().iter();
            set.filter_map(Value::as_str).collect()
        })
        .collect();
    if sets.is_empty() || sets.iter().any(Vec::is_empty) {
        return None;
    }
    let told = self::answer(&case.text, &sets.concat(), &file);
    let is_right = told["verdict"] == "right" || told["verdict"] == "noise";
    (!is_right).then(|| format!("{}: with {sets:?}: {}", case.title, told["line"]))
}

sampled_and_exhaustive!(random_samples_that_all_pixels_share_are_no_other_mistake);

/// A program uses the same few random samples in every pixel. Their mean position is not the middle
/// of the pixel, so all edges in the picture are shifted. The scene itself is right, so `diff` may
/// report only a shift of the samples.
fn random_samples_that_all_pixels_share_are_no_other_mistake(effort: Effort) {
    let names = ["figure", "street", "lens"].into_iter();
    let cases = names.flat_map(|name| [4, 8, 16].map(|samples| (name, samples)));
    let cases: Vec<_> = cases
        .flat_map(|(name, samples)| (1..=6).map(move |seed| (name, samples, seed)))
        .collect();
    let cases: Vec<_> = effort.first(6, &cases).copied().collect();
    let accused = |(name, samples, seed)| {
        let (mut program, text) = scenes::scene(name);
        (program.size, program.samples) = ([160, 90], samples);
        program.sampling = textbook::Sampling::SharedRandom(seed);
        let picture = program.render();
        let size = picture.dimensions().into();
        let file = images::png(size, ColorType::Rgb, BitDepth::Eight, picture.as_raw());
        let text = text.replace("WIDTH", "160").replace("HEIGHT", "90");
        let answer = answer(&text, &[], &file);
        let mut mistakes = answer["mistakes"].as_array().unwrap().iter();
        let is_shift = |one: &Value| one["id"] == "samples_shifted" || one["id"] == "half_pixel";
        let is_accused = !mistakes.all(is_shift);
        is_accused.then(|| format!("{name} {samples} {seed}: {}", answer["line"]))
    };
    let accused: Vec<String> = cases.into_par_iter().filter_map(accused).collect();
    assert!(accused.is_empty(), "{}", accused.join("\n"));
}

/// Judges the picture `file` against the scene `text` with the `--set` arguments `sets`. Returns
/// the verdict as JSON.
fn answer(text: &str, sets: &[&str], file: &[u8]) -> Value {
    let mut sources = Sources::new(Source::from_text("a.scn", text));
    sets.iter().for_each(|set| sources.push_set(set));
    let scene = scene::read(&sources).scene.unwrap();
    let part = Area::whole(scene.image.width, scene.image.height);
    let cancel = AtomicBool::new(false);
    let control = Control {
        threads: None,
        progress: &|_| {},
        cancel: &cancel,
    };
    let picture = film::read_picture(file).unwrap();
    let reference = Reference::new(&scene, part, picture.rounding, &control).unwrap();
    let comparison = reference.compare(&picture.film, 0.5).unwrap();
    let verdict = reference.judge(&picture, Jpeg::of(file), &comparison, &cancel);
    Value::Object(verdict.unwrap().to_json())
}

/// Judges a picture with two mistakes: it is mirrored, and a sphere has a wrong radius. Only a part
/// of the picture is handed in. This part is not symmetric, so its mirror image shows an area that
/// is partly outside of it.
#[test]
fn a_part_of_a_mirrored_picture_with_one_more_mistake() {
    let scene = |sets: &[&str]| {
        let text = include_str!("../../../examples/figure_9_9.scn");
        let mut sources = Sources::new(Source::from_text("a.scn", text));
        let size = ["image.width=96", "image.height=54"];
        size.iter()
            .chain(sets)
            .for_each(|set| sources.push_set(set));
        scene::read(&sources).scene.unwrap()
    };
    let cancel = AtomicBool::new(false);
    let control = Control {
        threads: None,
        progress: &|_| {},
        cancel: &cancel,
    };
    let reference = |scene, part| Reference::new(scene, part, Rounding::Byte, &control).unwrap();
    let wrong = scene(&["Ball.radius=1.3"]);
    let whole = reference(&wrong, Area::whole(96, 54)).exact.film;
    let part = Area {
        x: 12,
        y: 2,
        width: 64,
        height: 50,
    };
    let mut film = Film::new(part.width, part.height).unwrap();
    for (pixel, (x, y)) in film.pixels_mut().iter_mut().zip(part.iter()) {
        *pixel = whole.pixel(95 - x, y);
    }
    let right = scene(&[]);
    let reference = reference(&right, part);
    let comparison = reference.compare(&film, 0.5).unwrap();
    let picture = Picture::new(film, Rounding::Byte);
    let verdict = reference
        .judge(&picture, None, &comparison, &cancel)
        .unwrap();
    let mut ids: Vec<_> = verdict.mistakes.iter().map(|one| one.id).collect();
    ids.sort_unstable();
    assert_eq!(ids, ["mirrored", "radius"], "{}", verdict.line());
}
