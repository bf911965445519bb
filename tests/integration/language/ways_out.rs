//! What is advised where people write what other languages and books have: the way out that is
//! right, not the one that is near.

use pinhole::scene;

use super::CAMERA;
use crate::{scenes::sources, table::rows};

#[test]
fn the_advice_is_the_way_out() {
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
        triangle { v0 (0,0,0) v1 (1,0,0) v2 (1,1,0) v3 (0,1,0) } -> a triangle has three vertices; a second one with v0, v2 and this makes a quadrilateral of it
        sphere { center ball radius cos a } -> write `cos(a)`
        let r = 6 371 000 sphere { center ball radius r } -> write `6371000`
        sphere { center ball radius 6 371 } -> write `6371`
        box { center ball turn 30deg } -> boxes stand along the axes; a shape that is turned is made of triangles, by v0, v1 and v2
    ";
    for [text, expected] in rows(table) {
        let text = format!("{CAMERA}let ball = (0, 1, 2) let n = 3 let a = 30deg\n{text}");
        let found = scene::read(&sources(&text)).diagnostics;
        let first = found.first().unwrap();
        assert_eq!(first.help.as_deref(), Some(expected), "{text}");
    }
}

#[test]
fn a_floor_that_ends_is_made_of_boxes() {
    let text = format!("{CAMERA}checkerboard {{ size 8 }}");
    let found = scene::read(&sources(&text)).diagnostics;
    let help = found[0].help.clone().unwrap();
    let example = help.split('`').nth(3).unwrap();
    let scene = scene::read(&sources(&(CAMERA.to_owned() + example)));
    assert!(scene.diagnostics.is_empty(), "{example}");
    assert_eq!(scene.scene.unwrap().objects.len(), 64);
}
