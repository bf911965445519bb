//! Grading: pictures of the corpus judged by the library, and the command `grade`.

mod command;
mod corpus;
mod mistakes;
mod textbook;

use std::{fs, io::Cursor, sync::atomic::AtomicBool};

use image::ImageFormat;
use pinhole::{
    area::Area,
    film::{self, Tolerance},
    grading::{self, Jpeg, Reference},
    render::{self, Control},
    tracer::World,
};
use rayon::prelude::*;
use serde_json::Value;

use self::corpus::{Case, Judgement, SIZES, cases, samplings};
use crate::exact::read;

/// Pictures of all kinds, a title of the corpus in each line of this file: right ones by every method, and mistakes that a class makes.
const TITLES: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/tests/integration/grade/titles.txt"
);

#[test]
fn the_mistakes_of_a_class_are_named() {
    let all: Vec<Case> = (0..4)
        .flat_map(|count| SIZES.map(|size| (count, size)))
        .flat_map(|(count, size)| {
            samplings().flat_map(move |sampling| cases(count, size, sampling))
        })
        .collect();
    let text = fs::read_to_string(TITLES).unwrap();
    let titles: Vec<&str> = text.lines().collect();
    let judged: Vec<String> = titles
        .par_iter()
        .filter_map(|title| {
            let case = all.iter().find(|case| case.title == *title);
            let case = case.unwrap_or_else(|| panic!("{title} is no case"));
            assert!(case.is_seen(), "{title}");
            let answer = answer(case);
            let judgement = case.judge(&answer);
            (judgement != Judgement::Right)
                .then(|| format!("{title}: {judgement:?}: {}", answer["line"]))
        })
        .collect();
    assert!(judged.is_empty(), "{}", judged.join("\n"));
}

/// What is said of a case's picture.
fn answer(case: &Case) -> Value {
    let scene = read(&case.right.scene());
    let part = Area::whole(scene.image.width, scene.image.height);
    let cancel = AtomicBool::new(false);
    let control = Control {
        threads: None,
        progress: &|_| {},
        cancel: &cancel,
    };
    let exact = render::render_exact(&World::new(&scene), part, &control).unwrap();
    let mut file = Cursor::new(Vec::new());
    case.picture()
        .write_to(&mut file, ImageFormat::Png)
        .unwrap();
    let picture = film::read_picture(file.get_ref()).unwrap();
    let tolerance = Tolerance {
        steps: picture.rounding.steps(),
        bounds: Some(&exact.bounds),
    };
    let comparison = film::compare(&picture.film, &exact.film, tolerance).unwrap();
    let verdict = Reference::new(&scene, part)
        .judge(
            &picture.film,
            Jpeg::of(file.get_ref()),
            &comparison,
            &cancel,
        )
        .unwrap();
    Value::Object(grading::json(&verdict))
}
