//! Tests of the help for notations of other languages and of books. The help says how to write what
//! the author meant. It does not merely suggest the word with the most similar spelling.

use pinhole::scene;

use super::CAMERA;
use crate::{scenes::sources, table::rows};

#[test]
fn notations_of_other_languages_get_the_right_help() {
    let table = "
        sphere { center (ball.x, 1, 0) } -> write `dot(ball, (1, 0, 0))`
        sphere { center (0, ball.y, ball.z) } -> write `dot(ball, (0, 1, 0))`
        sphere { center 2ball } -> write `2 * ball`
        sphere { center 2 ball } -> write `2 * ball`
        sphere { center (n*0.28)ball } -> write `(n*0.28) * ball`
        sphere { center ball radius acos((3 + 0.2) / 3) / 1rad } -> no angle has that; see whether `(3 + 0.2) / 3` is the right way round
        sphere { center ball radius 1 + acos(1.0000000000000002) / 1rad } -> write `acos(max(-1, min(1, 1.0000000000000002)))` to keep it in range
        sphere { center (3 – 2, 1, 0) } -> write `-`
        sphere { center (3 ∗ 2, 1, 0) } -> write `*`
        sphere { center (3, π, 0) } -> write `pi`
        sphere { center (√2, 1, 0) } -> write `sqrt(2)` for the square root of 2
        sphere { center (½, 1, 0) } -> write `0.5`
        sphere { center (2³, 1, 0) } -> write a product, such as `r * r`
        sphere { center (2π, 1, 0) } -> write `* pi`
        sphere { center ball radius 2π } -> write `* pi`
        let r = 2π sphere { center ball radius r } -> write `* pi`
        let r = 2√3 sphere { center ball radius r } -> write `* sqrt(2)` for times the square root of 2
        let r = 3³ sphere { center ball radius r } -> write a product, such as `r * r`
        let r = n² sphere { center ball radius r } -> write a product, such as `r * r`
        sphere { center ball radius (1 + n)² } -> write a product, such as `r * r`
        sphere { center ball radius n² } -> write a product, such as `r * r`
        let r = 2½ sphere { center ball radius r } -> write `+ 0.5`
        let r = 3 — 2 sphere { center ball radius r } -> write `-`
        let r = 3 ⋅ 2 sphere { center ball radius r } -> write `*`
        let r = 3 ⁄ 2 sphere { center ball radius r } -> write `/`
        sphere for k < 4 { center (k, 1, 0) radius 1 + acos(k) / 1rad } -> no angle has that
        triangle { v0 (0,0,0) v1 (1,0,0) v2 (1,1,0) v3 (0,1,0) } -> a triangle has three vertices; a second one with v0, v2 and this makes a quadrilateral of it
        sphere { center ball radius cos a } -> write `cos(a)`
        let r = 6 371 000 sphere { center ball radius r } -> write `6371000`
        sphere { center ball radius 6 371 } -> write `6371`
        let r = cos a sphere { center ball radius r } -> write `cos(a)`
        let r = sqrt n sphere Ball { center ball radius r } -> write `sqrt(n)`
        let r = cos a sphere Ball for k < 3 { center (k, 1, 0) radius r } -> write `cos(a)`
        sphere for k < 3 { center (k, 1, 0) color k % 2 } -> there is no remainder: of objects with indices, a pair of colours, `color (gray, white)`, takes turns, and `for i < 8, j < 2` counts in rows
        sphere { center ball radius 5% } -> write the number itself, such as `0.5`
        sphere { center ball radius 0.3 if n == 3 color red } -> write what holds; `min` and `max` choose between two numbers
        sphere B for k < 3 { center (k, 1, 0) } sphere { center B[2] + (0, 1, 0) } -> define the place with `let`, or write the formula that gives it, and use that in both
        let sizes = (1, 2, 3) sphere for k < 3 { center (k, 1, 0) radius sizes[k] } -> write a block for each value, or compute the value from the index
        let sizes = (1, 2, 3, 4, 5) sphere { center (0, 1, 0) } -> write three numbers, such as `(0, 1, 0)`; the language has no other lists: a block stands for each value, or `for` in its head computes them
        sphere for k < 3 { center (cos(k * n), 1, 0) } -> write `k * n * 1deg` (or `k * n * 1rad`); or write the unit where `n` is defined, as in `let n = 3deg`
        cylinder Column { center ball height 3 } -> the kinds are image, camera, sampler, sphere, triangle, box and checkerboard; other shapes are made of triangles
        box for k < 3 { min (0, 0, -k) max (1, 1, -k - 1) } -> make `max` greater than `min` on every axis
        new sphere { center (0, 1, 0) } -> take `new` away
        ball sphere { center (0, 1, 0) } -> write `sphere ball {`
        sphere for k < 3 { let x = k center (x, 1, 0) } -> write its value where it is used: an index is known within its block alone
        sphere for k < 3 { let x = n center (k, x, 0) } -> write it before the block
        sphere { for k < 3 center (k, 1, 0) } -> write them before the `{`, as in `sphere for i < 8 {`
        sphere { for j < 3, k < j center (k, j, 0) } -> write them before the `{`, as in `sphere for i < 8 {`
        sphere Ball[8] { center (0, 1, 0) } -> write `sphere Ball for i < 8 {`, and use `i` in the values
        sphere k < 8 { center (k, 1, 0) } -> write `for k < 8`
        sphere for k in 0..3 { center (k, 1, 0) } -> write `for k < 3`
        sphere B for k in range(n) { center (k, 1, 0) } -> write `for k < n`
        sphere for k <= 3 { center (k, 1, 0) } -> write `k < 4`: an index begins at 0
        sphere for k <= n { center (k, 1, 0) } -> write `k < n + 1`: an index begins at 0
        box { center ball turn 30deg } -> boxes stand along the axes; a shape that is turned is made of triangles, by v0, v1 and v2
    ";
    for [text, expected] in rows(table) {
        let text = format!("{CAMERA}let ball = (0, 1, 2) let n = 3\nlet a = 30deg\n{text}");
        let found = scene::read(&sources(&text)).diagnostics;
        let first = found.first().unwrap();
        assert!(
            found.iter().all(|other| other.code == first.code),
            "{text}: {found:?}"
        );
        assert_eq!(first.help.as_deref(), Some(expected), "{text}");
    }
}

#[test]
fn the_suggested_finite_floor_is_a_valid_scene() {
    let text = format!("{CAMERA}checkerboard {{ size 8 }}");
    let found = scene::read(&sources(&text)).diagnostics;
    let help = found[0].help.clone().unwrap();
    let example = help.split('`').nth(3).unwrap();
    let scene = scene::read(&sources(&(CAMERA.to_owned() + example)));
    assert!(scene.diagnostics.is_empty(), "{example}");
    assert_eq!(scene.scene.unwrap().objects.len(), 64);
}
