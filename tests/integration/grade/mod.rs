//! Grading: pictures of the corpus judged by the library, and the command `grade`.

mod command;
mod corpus;
mod mistakes;
mod rarer;
mod textbook;

use std::{fs, io::Cursor, sync::atomic::AtomicBool};

use image::ImageFormat;
use pinhole::{
    area::Area,
    film::{self, Tolerance},
    grading::{self, Jpeg, Reference},
    render::Control,
    scene,
    source::{Source, Sources},
};
use rayon::prelude::*;
use serde_json::Value;

use self::corpus::{Case, Judgement, SIZES, cases, samplings};
use crate::effort::{Effort, sampled_and_exhaustive};

/// Pictures of all kinds, a title of the corpus in each line of this file: right ones by every method, and mistakes that a class makes.
const TITLES: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/tests/integration/grade/titles.txt"
);

sampled_and_exhaustive!(the_mistakes_of_a_class_are_named);

fn the_mistakes_of_a_class_are_named(effort: Effort) {
    let all: Vec<Case> = (0..4)
        .flat_map(|count| SIZES.map(|size| (count, size)))
        .flat_map(|(count, size)| {
            samplings().flat_map(move |sampling| cases(count, size, sampling))
        })
        .collect();
    let text = fs::read_to_string(TITLES).unwrap();
    let titles: Vec<&str> = effort.first(6, text.lines()).collect();
    let judged = titles.par_iter().filter_map(|title| {
        let case = all.iter().find(|case| case.title == *title);
        wrongly_judged(case.unwrap_or_else(|| panic!("{title} is no case")))
    });
    let judged: Vec<String> = judged.collect();
    assert!(judged.is_empty(), "{}", judged.join("\n"));
}

sampled_and_exhaustive!(every_row_of_the_table_is_named);

fn every_row_of_the_table_is_named(effort: Effort) {
    let names = rarer::cases().map(|case| case.title);
    let names: Vec<String> = names
        .chain(corpus::kinds().map(|kind| kind.name.to_owned()))
        .collect();
    for id in grading::mistake_ids() {
        let mut words = names.iter().flat_map(|name| name.split(['|', ' ']));
        assert!(words.any(|word| word == id), "{id} is nowhere");
    }
    let cases: Vec<Case> = effort.first(2, rarer::cases()).collect();
    let judged: Vec<String> = cases.par_iter().filter_map(wrongly_judged).collect();
    assert!(judged.is_empty(), "{}", judged.join("\n"));
}

/// What is said of a case that is judged otherwise than right.
fn wrongly_judged(case: &Case) -> Option<String> {
    let title = &case.title;
    if !case.is_seen() {
        return Some(format!("{title} is not seen"));
    }
    let mut file = Cursor::new(Vec::new());
    case.picture()
        .write_to(&mut file, ImageFormat::Png)
        .unwrap();
    let answer = answer(&[], case, file.get_ref());
    let judgement = case.judge(&answer);
    if judgement != Judgement::Right {
        return Some(format!("{title}: {judgement:?}: {}", answer["line"]));
    }
    // What is told makes the picture.
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
    let told = self::answer(&sets.concat(), case, file.get_ref());
    let is_right = told["verdict"] == "right" || told["verdict"] == "noise";
    (!is_right).then(|| format!("{title}: with {sets:?}: {}", told["line"]))
}

/// What is said of a file with a case's picture, where a scene is set otherwise.
fn answer(sets: &[&str], case: &Case, file: &[u8]) -> Value {
    let text = case.right.scene();
    let mut sources = Sources::new(Source::from_text("a.scn", &text));
    sets.iter().for_each(|set| sources.push_set(set));
    let scene = scene::read(&sources).scene.unwrap();
    let part = Area::whole(scene.image.width, scene.image.height);
    let cancel = AtomicBool::new(false);
    let control = Control {
        threads: None,
        progress: &|_| {},
        cancel: &cancel,
    };
    let reference = Reference::new(&scene, part, &control).unwrap();
    let exact = &reference.exact;
    let picture = film::read_picture(file).unwrap();
    let tolerance = Tolerance {
        steps: picture.rounding.steps(),
        bounds: Some(&exact.bounds),
    };
    let comparison = film::compare(&picture.film, &exact.film, tolerance).unwrap();
    let verdict = reference
        .judge(&picture.film, Jpeg::of(file), &comparison, &cancel)
        .unwrap();
    Value::Object(grading::json(&verdict))
}
