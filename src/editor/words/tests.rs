//! What the reader says of each word by its place is what the tree says, in scenes whose values are called like everything
//! there is.

use proptest::prelude::*;

use super::{Role, Token, read, tokens};
use crate::{
    editor::{Analysis, rename},
    scene::{self, Scene},
    source::{Source, Sources},
};

/// Names that blocks, fields and methods have, and that `let`s may have, too.
const NAMES: &[&str] = &[
    "image",
    "camera",
    "sampler",
    "sphere",
    "triangle",
    "box",
    "checkerboard",
    "eye",
    "lookat",
    "radius",
    "center",
    "size",
    "color",
    "y",
    "square",
    "method",
    "total",
    "seed",
    "width",
    "regular",
    "jittered",
    "sobol",
    "exact",
    "a",
    "Ball",
];

const BREAKS: &[&str] = &[" ", "\n", "\n\n", " // let x\n", " /* box { */ ", "\t"];

/// A number, made of the names that are defined so far and of literals.
fn number(defined: &[&'static str]) -> BoxedStrategy<String> {
    let mut leaves: Vec<String> = defined.iter().map(ToString::to_string).collect();
    leaves.extend(["1", "2", ".5", "3."].map(str::to_owned));
    let leaf = prop::sample::select(leaves);
    let tight = || prop::sample::select(vec!["", " ", "\n"]);
    leaf.prop_recursive(2, 6, 2, move |inner| {
        prop_oneof![
            (inner.clone(), tight(), inner.clone(), tight())
                .prop_map(|(a, s, b, t)| format!("{a}{s}+{t}{b}")),
            (inner.clone(), tight(), inner.clone())
                .prop_map(|(a, s, b)| format!("max({s}{a},{s}{b})")),
            inner.prop_map(|a| format!("({a})")),
        ]
    })
    .boxed()
}

/// Blocks that numbers stand in, each as a list of words.
fn block(defined: &[&'static str], index: usize) -> BoxedStrategy<Vec<String>> {
    let name = prop::sample::select(vec![None, Some(format!("N{index}"))]);
    let words = |words: &[&str]| words.iter().map(ToString::to_string).collect::<Vec<_>>();
    let number = || number(defined);
    prop_oneof![
        Just(Vec::new()),
        (name.clone(), number(), number()).prop_map(move |(name, a, b)| {
            let center = format!("({a}, 1, {b})");
            let mut block = words(&["sphere"]);
            block.extend(name);
            block.extend(words(&[
                "{", "radius", &a, "center", &center, "color", "red", "}",
            ]));
            block
        }),
        (name, number(), number()).prop_map(move |(name, a, b)| {
            let mut block = words(&["box"]);
            block.extend(name);
            block.extend(words(&[
                "{",
                "center",
                &format!("({a},{b},0)"),
                "size",
                &a,
                "}",
            ]));
            block
        }),
        (number(), number()).prop_map(move |(a, b)| words(&[
            "checkerboard",
            "{",
            "y",
            &a,
            "square",
            &b,
            "}"
        ])),
        Just(words(&["sampler", "{", "method", "regular", "}"])),
    ]
    .boxed()
}

prop_compose! {
    /// A scene whose `let`s have names that are words elsewhere, and those names.
    fn scenes()(names in prop::sample::subsequence(NAMES.to_vec(), 4).prop_shuffle())(
        values in [number(&[]), number(&names[..1]), number(&names[..2]), number(&names[..3])],
        blocks in [
            block(&names[..1], 1), block(&names[..2], 2), block(&names[..3], 3), block(&names, 4),
        ],
        breaks in prop::collection::vec(prop::sample::select(BREAKS), 16..64),
        names in Just(names),
    ) -> (String, Vec<&'static str>) {
        let mut words = vec!["camera { eye (0, 1, 5) lookat (0, 0, 0) }".to_owned()];
        for ((name, value), block) in names.iter().zip(values).zip(blocks) {
            words.extend(["let".to_owned(), (*name).to_owned(), "=".to_owned(), value]);
            words.extend(block);
        }
        let text = words.iter().zip(breaks.iter().cycle());
        let text = text.map(|(word, space)| format!("{word}{space}")).collect();
        (text, names)
    }
}

fn sources(text: &str) -> Sources {
    Sources::new(Source::from_text("test.scn", text))
}

/// What a scene means, without the places of what it says.
fn meaning(scene: &Scene) -> String {
    let objects = scene.objects.iter();
    let objects = objects.map(|object| format!("{:?} {:?}", object.name, object.shape));
    let objects: Vec<String> = objects.collect();
    format!(
        "{:?} {:?} {objects:?}",
        scene.camera.eye, scene.sampler.method
    )
}

fn shown(text: &str, tokens: &[Token]) -> Vec<(String, Role)> {
    let tokens = tokens.iter();
    let shown = tokens.map(|token| (super::slice(text, token.span).to_owned(), token.role));
    shown.collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 256, max_global_rejects: 16_384, ..ProptestConfig::default() })]

    #[test]
    fn the_reader_and_the_tree_agree((text, _) in scenes()) {
        let sources = sources(&text);
        let survey = scene::analyze(&sources);
        prop_assume!(survey.parts.clone().into_scene().is_some() && survey.parsed.problems.is_empty());
        prop_assert_eq!(shown(&text, &read(&text, &survey.parsed.comments)), shown(&text, &tokens(&survey)), "{}", text);
    }

    #[test]
    fn a_new_name_changes_nothing_else(
        (text, names) in scenes(),
        which in 0..4_usize,
        new in prop::sample::select(NAMES),
    ) {
        let before = sources(&text);
        let analysis = Analysis::new(&before);
        let scene = scene::read(&before).scene;
        prop_assume!(scene.is_some() && !names.contains(&new));
        let defined = analysis.tokens.iter().filter(|token| token.role == Role::Defined);
        let at = defined.skip(which).map(|token| token.span.start).next();
        let spans = rename(&analysis, at.unwrap_or_default(), new);
        prop_assert!(spans.is_ok(), "{}: {:?}", text, spans);
        let mut renamed = text.clone();
        for span in spans.unwrap_or_default().into_iter().rev() {
            renamed.replace_range(span.range(), new);
        }
        let after = scene::read(&sources(&renamed)).scene;
        prop_assert_eq!(
            scene.as_ref().map(meaning),
            after.as_ref().map(meaning),
            "{} as {} in {}", names[which], new, text
        );
    }
}
