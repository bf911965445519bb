//! A picture with which the grading is tested. Its title lists how it is made: the scene, the size,
//! the samples per pixel, the sampling method, and the mistakes. Pictures with 256 samples per
//! pixel stand for exact pictures.

use image::RgbImage;
use serde_json::Value;

use super::{
    mistakes::{GROUPS, Mistake},
    scenes::scene,
    textbook::{Program, SAMPLINGS},
};

/// A picture by a program with known mistakes.
pub struct Case {
    pub title: String,
    /// The program that renders the picture without any mistake.
    right: Program,
    pub text: String,
    pub mistakes: Vec<&'static Mistake>,
}

impl Case {
    /// Parses the title of a picture, such as `figure 320x180 4 Jittered: Ball.color + Sail.normal`
    /// or `street 96x64 1 Random: right`.
    pub fn of(title: &str) -> Self {
        let (picture, names) = title.split_once(": ").unwrap();
        let [name, size, samples, sampling] = picture.split(' ').collect::<Vec<_>>()[..] else {
            panic!("{title}: a scene, a size, samples and where they lie")
        };
        let (width, height) = size.split_once('x').unwrap();
        let (mut right, text) = scene(name);
        right.size = [width, height].map(|side| side.parse().unwrap());
        right.samples = samples.parse().unwrap();
        let mut samplings = SAMPLINGS.into_iter();
        let found = samplings.find(|one| format!("{one:?}") == sampling);
        right.sampling = found.unwrap();
        let named = |name: &str| {
            let mut all = GROUPS.into_iter().flatten();
            let found = all.find(|one| one.title() == name);
            found.unwrap_or_else(|| panic!("{title}: {name} is no mistake"))
        };
        let names = names.split(" + ").filter(|name| *name != "right");
        Self {
            title: title.to_owned(),
            right,
            text: text.replace("WIDTH", width).replace("HEIGHT", height),
            mistakes: names.map(named).collect(),
        }
    }

    /// Renders the picture with the mistakes in the program.
    pub fn picture(&self) -> RgbImage {
        let mut program = self.right.clone();
        self.mistakes.iter().for_each(|one| one.make(&mut program));
        program.render()
    }

    /// Returns whether `answer`, the output of `diff --format json`, names all mistakes of the
    /// picture and no others.
    pub fn is_judged_correctly(&self, answer: &Value) -> bool {
        let named = answer["mistakes"].as_array().map_or(&[][..], Vec::as_slice);
        if self.mistakes.is_empty() {
            answer["verdict"] == "right" || answer["verdict"] == "noise"
        } else {
            let mut mistakes = self.mistakes.iter();
            named.len() == self.mistakes.len() && mistakes.all(|one| is_named(one, named))
        }
    }
}

/// Returns whether `named`, a list from the output of `diff`, contains an accepted answer for
/// `mistake`.
fn is_named(mistake: &Mistake, named: &[Value]) -> bool {
    mistake.name.split('|').any(|name| {
        let (id, words) = name.split_once(' ').unwrap_or((name, ""));
        named.iter().any(|answer| {
            let sets = answer["set"].as_array().map_or(&[][..], Vec::as_slice);
            let mut targets = sets.iter().filter_map(|set| set.as_str()?.split_once('='));
            let message = answer["message"].as_str().unwrap_or_default();
            targets.any(|(target, _)| target == name)
                || (answer["id"] == id && message.contains(words))
        })
    })
}
