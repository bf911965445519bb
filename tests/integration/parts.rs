//! A text that is read in parts means what it means as a whole: the same tree, the same scene, the same diagnostics.
//!
//! Parts of a single byte are taken apart at every brace, so that small texts have many.

use std::{
    fs,
    sync::{LazyLock, atomic::AtomicBool},
};

use pinhole::{scene, source::SourceId, syntax};
use proptest::{prelude::*, sample::select};

use crate::{
    effort::{Effort, sampled_and_exhaustive},
    scenes::{example_text, scenes, sources},
    table::{lines, list},
};

/// Every scene that there is beside the source.
static SCENES: LazyLock<Vec<String>> = LazyLock::new(|| {
    let folders = "examples tests/diagnostics tests/syntax/bad tests/syntax/ok".split(' ');
    let text = |path| String::from_utf8_lossy(&fs::read(path).expect("a scene")).into_owned();
    folders.flat_map(scenes).map(text).collect()
});

/// Compares the two ways; answers whether the text was parsed in parts.
#[track_caller]
fn check(text: &str, bytes: usize, sets: &[&str]) -> bool {
    let sources = sources(text).with_sets(sets);
    let whole = syntax::parse(&sources.file, SourceId::File);
    let mut items = Vec::new();
    let (file, wanted) = (&sources.file, AtomicBool::new(false));
    let in_parts = syntax::parse_in_parts(file, SourceId::File, bytes, &wanted, |part| {
        items.extend(part);
        true
    });
    let long = text.len() / 2 >= bytes;
    assert!(!in_parts || (long && whole.problems.is_empty()), "{text:?}");
    if in_parts {
        assert_eq!(items, whole.tree.items, "{text:?}");
    }
    let as_parts = scene::read_in_parts(&sources, bytes);
    let as_whole = scene::read_in_parts(&sources, usize::MAX);
    assert_eq!(as_parts.diagnostics, as_whole.diagnostics, "{text:?}");
    assert_eq!(as_parts.scene, as_whole.scene, "{text:?}");
    in_parts
}

#[test]
fn every_scene() {
    let in_parts = SCENES.iter().filter(|text| check(text, 1, &[])).count();
    // Those of the examples alone; the others are there for their mistakes.
    assert!(in_parts >= 20, "{in_parts}");
}

sampled_and_exhaustive!(every_prefix_of_a_scene_of_everything);

fn every_prefix_of_a_scene_of_everything(effort: Effort) {
    let text = example_text("language_tour");
    let step = if effort == Effort::Sample { 7 } else { 1 };
    for (end, _) in text.char_indices().step_by(step) {
        check(&text[..end], 1, &[]);
    }
}

/// What is one mistake at a brace, or two across a part's end.
#[test]
fn mistakes_at_the_end_of_a_part() {
    let camera = "camera { eye (0, 2, 8) lookat (0, 1, 0) }\n";
    for text in list(
        r#"
        let a = { sphere { center (0, 1, 0) } }
        sphere { center (0, 1, 0) /* } sphere {} */ }
        sphere { center (0, 1, 0) /* } sphere {}
        sphere { center (0, 1, 0) } /* sphere {}
        sphere { center (0, 1, 0) // }\n} sphere { center (0, 0, 0) }
        sphere { center "}" } sphere { center '}' }
        sphere { center (0, 1, 0) } } sphere { center (0, 1, 0) }
        sphere { center (0, 1, 0) { } } sphere { center (0, 1, 0) }
        sphere { sphere { center (0, 1, 0) } } sphere { center (0, 1, 0) }
        sphere { center (0, 1, 0) } } }
        { center (0, 1, 0) } { center (0, 1, 0) }
        sphere { center (0, 1, 0) let a = 1 } sphere { center (0, a, 0) }
        sphere A { center (0, b, 0) } let b = 1 sphere A { center (0, b, 0) }
        sphere A { center A } sphere B { center (0, 1, 0) radius color }
        sphere { center (0, 1, 0) radius radius } let radius = 1
        sphere { center (0, 1, 0) radius 1e-400 } let radius = 1 sphere { centre (0, 1, 0) }
        sphere { center (0, 1, 0) };\nsphere { center (0, 1, 0) },\n
        let a = 2 pi\nsphere { center (0, 1, 0) }
        let a =\nsphere { center (0, 1, 0) }
        sphere { center (0, 1, 0) } let a = 2 pi\nsphere { center (0, a, 0) }
    "#,
    ) {
        for text in [
            text.to_owned(),
            format!("{camera}{text}"),
            format!("{text}\n{camera}"),
        ] {
            check(&text, 1, &[]);
            check(&text, 20, &["image.width=64"]);
        }
    }
}

#[test]
fn arguments() {
    let text = "let a = 1 camera { eye (0, 2, 8) lookat (0, a, 0) } sphere Ball { center (0, a, 0) } let b = 2 sphere { center (b, 1, 0) }";
    for sets in lines(
        "
        image.width=64
        camera.d=b
        camera.d=Ball
        camera.d=c
        camera.lens=2
        camera.direction=(0, 0, -b)
        a=2
        c=2
        Ball=2
        Ball.radius=b
        Bal.radius=b
        sphere.radius=b
        sampler.total=100
        -- Both of one block, be it in the text or not; and of the objects, the first one is read last.
        camera.eye=(b, 2, 8) -> camera.lens=(2, 4)
        image.width=64 -> image.height=48
        image.width=64 -> image.height=b
        Ball.radius=b -> b=3
        Ball.radius=2 -> Ball.radius=b
    ",
    ) {
        assert!(check(text, 1, &sets));
    }
}

/// A place in a text, how much is taken out there, and what is put in.
type Change = (prop::sample::Index, usize, &'static str);

fn change() -> impl Strategy<Value = Change> {
    let signs = "|/*|*/|//|\"|'|{|}|}}|(|)|[|]|,|;|=|let |let x = 1 |let x = |\n| x| 2| radius|sphere {|sphere A { |\u{a0}";
    let signs: Vec<&str> = signs.split('|').collect();
    let taken = prop_oneof![6 => Just(0), 3 => 1..4_usize, 1 => Just(usize::MAX)];
    (any::<prop::sample::Index>(), taken, select(signs))
}

fn changed(mut text: String, changes: &[Change]) -> String {
    for (place, taken, sign) in changes {
        let boundary = |at: usize| (0..=at).rev().find(|&at| text.is_char_boundary(at));
        let at = boundary(place.index(text.len() + 1)).unwrap_or(0);
        let end = boundary(text.len().min(at.saturating_add(*taken))).unwrap_or(at);
        text.replace_range(at..end, sign);
    }
    text
}

proptest! {
    #[test]
    fn changed_scenes(
        one in select(&SCENES[..]),
        other in select(&SCENES[..]),
        changes in prop::collection::vec(change(), 0..4),
        bytes in 1_usize..100,
    ) {
        check(&changed(format!("{one}\n{other}"), &changes), bytes, &[]);
        check(&changed(one, &changes), bytes, &[]);
    }
}
