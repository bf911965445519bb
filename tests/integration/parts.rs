//! Tests that reading a text in parts yields the same tree, scene and diagnostics as reading it as
//! a whole.
//!
//! The program splits only long texts into parts of many bytes. With a part size of 1 byte, a text
//! is split at every line end after a brace, so that even small texts have many parts.

use std::sync::atomic::AtomicBool;

use pinhole::{scene, source::SourceId, syntax};

use crate::{
    format::all_scenes,
    scenes::sources,
    table::{lines, list},
};

/// Reads `text` as a whole and in parts of about `bytes` bytes, and asserts equal results. Returns
/// whether the text was really parsed in parts.
#[track_caller]
pub fn assert_same_in_parts(text: &str, bytes: usize, sets: &[&str]) -> bool {
    let sources = sources(text).with_sets(sets);
    let whole = syntax::parse(&sources.file, SourceId::File);
    let mut items = Vec::new();
    let (file, wanted) = (&sources.file, AtomicBool::new(false));
    let in_parts = syntax::parse_in_parts(
        file,
        SourceId::File,
        bytes,
        &wanted,
        |it| it,
        |part| {
            items.extend(part);
            true
        },
    );
    let long = text.len() / 2 >= bytes;
    assert!(!in_parts || (long && whole.problems.is_empty()), "{text:?}");
    if in_parts {
        assert_eq!(items, whole.tree.items, "{text:?}");
    }
    let as_parts = scene::read_in_parts(&sources, bytes);
    let as_whole = scene::read_in_parts(&sources, usize::MAX);
    assert_eq!(as_parts.diagnostics, as_whole.diagnostics, "{text:?}");
    assert_eq!(as_parts.scene, as_whole.scene, "{text:?}");
    let [spans, spans_of_whole] = [&as_parts, &as_whole].map(|reading| {
        let objects = reading.scene.iter().flat_map(|it| it.objects.iter());
        objects.map(|object| object.span).collect::<Vec<_>>()
    });
    assert_eq!(spans, spans_of_whole, "{text:?}");
    in_parts
}

#[test]
fn every_scene_means_the_same_when_read_in_parts() {
    let scenes = all_scenes().into_iter();
    let in_parts = scenes
        .filter(|text| assert_same_in_parts(text, 1, &[]))
        .count();
    // A text with syntax errors is not parsed in parts. Many of the scenes have such errors, but at
    // least the examples have none.
    assert!(in_parts >= 20, "{in_parts}");
}

/// The program may parse a long text in parts, which it splits at braces. The tested mistakes are
/// at a brace, or on both sides of the boundary between two parts.
#[test]
fn mistakes_at_a_part_boundary_are_reported_as_in_the_whole_text() {
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
            assert_same_in_parts(&text, 1, &[]);
            let lines = text.replace("} ", "}\n");
            assert_same_in_parts(&lines, 1, &[]);
            assert_same_in_parts(&lines, 20, &["image.width=64"]);
        }
    }
}

#[test]
fn set_arguments_mean_the_same_when_the_text_is_read_in_parts() {
    let text = "let a = 1 camera { eye (0, 2, 8) lookat (0, a, 0) }\nsphere Ball { center (0, a, 0) }\nlet b = 2 sphere { center (b, 1, 0) }\nsphere { center (0, 3, 0) }";
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
        assert!(assert_same_in_parts(text, 1, &sets));
    }
}
