//! Definitions, uses and new names.

use pinhole::editor::{definition, occurrences, renamable, rename};

use super::at_cursor;
use crate::table::rows;

const SCENE: &str = "let ball = 1\nlet b = ball + ball\nsphere ball { radius ball }\n";

/// The text with the name at the cursor changed; or why it cannot be.
fn renamed(text: &str, new: &str) -> Result<String, String> {
    at_cursor(text, |analysis, at| {
        let mut text = analysis.text().to_owned();
        for span in rename(analysis, at, new)?.into_iter().rev() {
            text.replace_range(span.range(), new);
        }
        Ok(text)
    })
}

#[test]
fn every_use_of_a_definition_is_found_from_everywhere() {
    let ball: &[usize] = &[4, 21, 28, 54];
    for (place, expected) in [
        ("let $0ball", ball),
        ("let ba$0ll", ball),
        ("= ball$0 +", ball),
        ("+ ball$0", ball),
        ("{ radius ball$0 }", ball),
        // The object of the same name is another one.
        ("sphere $0ball", &[40]),
    ] {
        let text = SCENE.replacen(&place.replace("$0", ""), place, 1);
        at_cursor(&text, |analysis, at| {
            let found = occurrences(analysis, at);
            assert!(
                found.iter().map(|it| &it.span.start).eq(expected),
                "{place}"
            );
            assert!(
                found
                    .iter()
                    .map(|it| it.is_definition)
                    .eq(expected.iter().map(|at| at == &expected[0]))
            );
            let definition = definition(analysis, at).map(|span| span.start);
            assert_eq!(definition, Some(expected[0]));
        })
    }
}

#[test]
fn names_change_wherever_they_stand_or_the_reason_is_told() {
    let table = r"
        let a = 1 let b = a + sin(a * 1deg) sphere a { radius a$0 } -> size -> let size = 1 let b = size + sin(size * 1deg) sphere a { radius size }
        let Ball = 1 sphere $0Ball { radius Ball } -> Globe -> let Ball = 1 sphere Globe { radius Ball }
        let a = 1 let $0b = 2 -> b -> let a = 1 let b = 2
        -- Fields and methods may have the name of a definition, and are none.
        let rad$0ius = 2 let sobol = 1 sampler { method sobol } sphere { radius radius } -> r -> let r = 2 let sobol = 1 sampler { method sobol } sphere { radius r }
        -- A value before a block is no block's kind.
        let $0box = 2\nlet c = box\nbox { center (c, 0, 0) } -> crate -> let crate = 2\nlet c = crate\nbox { center (c, 0, 0) }
        let a = 1\nlet b = $0a -> b -> `b` is taken: it stands in line 2
        -- Nothing defines it yet, and it would be another value from then on.
        let $0a = 1\nsphere { center (0, 0, 0) radius q } -> q -> `q` is taken: it stands in line 2
        sphere $0A {} box B {} -> B -> `B` is taken: it stands in line 1
        let $0a = 1 -> Olive -> `Olive` is a colour of the language
        let $0a = 1 -> sin -> `sin` is a function of the language
        let $0a = 1 -> let -> `let` is a word of the language
        let $0a = 1 -> 2x -> `2x` is no name: a name is made of the letters a to z, digits and `_`, and does not start with a digit
        sphere $0A {} -> camera -> `camera` is the name of the camera block
    ";
    for [text, new, expected] in rows(table) {
        let (Ok(found) | Err(found)) = renamed(text, new);
        assert_eq!(found, expected, "{text}");
    }
}

#[test]
fn words_of_the_language_have_no_other_name() {
    let table = "
        sphere { $0radius 1 } -> `radius` is a word of the language
        sphere { color $0olive } -> `olive` is a colour of the language
        sphere { color $0sky } -> `sky` is not defined
        sphere { radius $01 } -> no name stands here
    ";
    for [text, reason] in rows(table) {
        assert_eq!(at_cursor(text, renamable), Err(reason.to_owned()), "{text}");
    }
}
