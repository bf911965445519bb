//! Measures the stages from the text of a scene to the input of the tracer:
//! `cargo bench --bench text`. See README.md beside this file.
//!
//! `cargo bench --bench text -- --write COUNT blocks|lines` writes a scene of many spheres to
//! standard output instead.

use std::{
    env,
    hint::black_box,
    time::{Duration, Instant},
};

use pest::Parser;
use pinhole::{
    scene,
    source::{Source, SourceId, Sources},
    syntax,
    tracer::World,
};

use self::{
    grammar::{Grammar, Rule},
    spheres::{Layout, spheres},
};

mod spheres;

/// Parser that the crate pest generates from the grammar of the scene language, for comparison with
/// Pinhole's own parser. All times are printed as multiples of the generated parser's time.
mod grammar {
    #[derive(pest_derive::Parser)]
    #[grammar = "grammar/scn.pest"]
    pub struct Grammar;
}

const OBJECTS: usize = 10_000;

/// Number of times that each stage is run. The shortest time is printed, since other work on the
/// machine only makes a run slower. With fewer runs, the results would scatter more; more runs
/// would take longer.
const ROUNDS: usize = 20;

fn main() {
    let arguments: Vec<String> = env::args().collect();
    if let Some(at) = arguments.iter().position(|argument| argument == "--write") {
        let count = arguments.get(at + 1).and_then(|count| count.parse().ok());
        let layout = match arguments.get(at + 2).map(String::as_str) {
            Some("lines") => Layout::Lines,
            _ => Layout::Blocks,
        };
        print!("{}", spheres(count.unwrap_or(OBJECTS), layout));
        return;
    }
    // `cargo test` runs this program without `--bench`. The program contains no tests, so it ends
    // here.
    if !arguments.iter().any(|argument| argument == "--bench") {
        return;
    }
    for layout in [Layout::Blocks, Layout::Lines] {
        let sources = Sources::new(Source::from_text("spheres.scn", spheres(OBJECTS, layout)));
        let reading = scene::read(&sources)
            .scene
            .expect("a scene without mistakes");
        let stages: [(&str, &dyn Fn()); 5] = [
            ("pest alone", &|| {
                black_box(chunks(sources.file.text()));
            }),
            ("a tree of the whole", &|| {
                black_box(syntax::parse(&sources.file, SourceId::File));
            }),
            ("the scene, through such a tree", &|| {
                black_box(scene::read_in_parts(&sources, usize::MAX));
            }),
            ("the scene, in parts", &|| {
                black_box(scene::read(&sources));
            }),
            ("the tracer's world", &|| {
                black_box(World::new(&reading));
            }),
        ];
        ratios(layout, &stages);
    }
}

/// Parses a text with pest, and returns the number of items. The text is divided into parts of
/// about 4096 bytes, which are parsed one by one, as in Pinhole's own parser.
fn chunks(text: &str) -> usize {
    const CHUNK: usize = 4096;
    let (mut at, mut items) = (0, 0);
    while at < text.len() {
        let end = text.get(at + CHUNK..).and_then(|rest| rest.find('}'));
        let end = end.map_or(text.len(), |end| at + CHUNK + end + 1);
        let chunk = text.get(at..end).unwrap_or_default();
        items += Grammar::parse(Rule::items, chunk).map_or(0, |pairs| pairs.count());
        at = end;
    }
    items
}

/// Measures the stages alternately, so that other work on the machine slows down all of them.
/// Prints the time of each stage as a multiple of the first stage's time.
fn ratios(layout: Layout, stages: &[(&str, &dyn Fn())]) {
    let mut best = vec![Duration::MAX; stages.len()];
    for _ in 0..ROUNDS {
        for ((_, stage), best) in stages.iter().zip(&mut best) {
            let start = Instant::now();
            stage();
            *best = start.elapsed().min(*best);
        }
    }
    println!("{OBJECTS} spheres as {layout:?}: the time of each stage by that of the first");
    for ((name, _), time) in stages.iter().zip(&best) {
        let ratio = time.as_secs_f64() / best[0].as_secs_f64();
        println!("{name:32} {ratio:6.2}   {time:.1?}");
    }
}
