//! Compares exact pictures with exact pictures of twice the resolution, and with samples.

use super::*;

#[test]
fn quarters_add_up_to_the_pixel_in_every_example() {
    for name in example_names() {
        assert_adds_up(&example(&name, 48, 32));
    }
}

/// Compares exact pictures of generated scenes, whose objects intersect one another, with pictures
/// of twice the resolution and with samples.
#[test]
fn generated_scenes_add_up_by_quarters_and_agree_with_samples() {
    for scene in ordinary([24, 18], 7).take(24) {
        let computed = assert_part_adds_up(&scene, whole(&scene));
        assert_agrees_with_samples(&scene, &computed, 1024);
    }
}

/// A pixel shows rows of tilted triangles. The planes of the triangles intersect everywhere in the
/// pixel, but the triangles themselves are side by side and do not hide one another.
#[test]
fn quarters_add_up_for_tilted_triangles_side_by_side() {
    let mut random = Random::new(71);
    for rows in [3, 5, 8] {
        let mut text = String::from(
            "image { width 1 height 1 } camera { eye (0, 0, 20) lookat (0, 0, 0) d 20 }\n",
        );
        let step = 2.0 / f64::from(rows);
        for (x, y) in Area::whole(rows, rows).iter() {
            let [x, y] = [x, y].map(|at| (f64::from(at) + 0.5) * step - 1.0);
            let [tilt, turn] = [0.3, 0.3].map(|most| random.within(-most, most));
            let _ = writeln!(
                text,
                "triangle {{ centroid ({x}, {y}, 0) normal ({tilt}, {turn}, 1) sides 0.6 * {step} * (1, 1, 1) }}"
            );
        }
        assert_adds_up(&read(&text));
    }
}

/// Boxes and triangles pierce one another only partly. A face of a box and a triangle then
/// intersect in a segment that ends at an edge of one of the two.
#[test]
fn quarters_add_up_for_partly_piercing_objects() {
    let mut random = Random::new(72);
    for _ in 0..20 {
        let mut text = String::from(
            "image { width 2 height 2 } camera { eye (0.3, 0.2, 20) lookat (0, 0, 0) d 20 }\n",
        );
        for color in ["red", "lime", "blue", "gold", "cyan", "white"] {
            let [center, half, centroid, normal] = [1.0, 0.5, 1.0, 2.0].map(|size| {
                let [x, y, z] = random.vector(size).to_array();
                format!("({x}, {y}, {z})")
            });
            let _ = writeln!(
                text,
                "box {{ center 0.7 * {center} size (0.6, 0.6, 0.6) + {half} color {color} }}
                 triangle {{ centroid 0.6 * {centroid} normal {normal} + (0, 0, 2) sides (1.6, 1.5, 0.4) color {color} }}"
            );
        }
        assert_adds_up(&read(&text));
    }
}

sampled_and_exhaustive!(quarters_add_up_for_extreme_cameras);

/// Tests a scene of the textbook, figure 9.9, with cameras that have extremely large or small
/// numbers.
fn quarters_add_up_for_extreme_cameras(effort: Effort) {
    let figure = example_text("figure_9_9").replace("checkerboard ", "checkerboard Floor ");
    let size = ["image.width=24", "image.height=16"];
    for sets in effort.first(
        15,
        lines(
            "
            camera.d=0.1
            camera.d=0.02
            camera.d=1e-3
            camera.d=1e5
            Floor.square=1e-3
            Floor.square=1e-6
            Floor.square=1e-100
            Floor.square=1e6
            Floor.square=1e300
            camera.eye=(3, 1e-6, 8)
            camera.eye=(3, 1e8, 8)
            image.width=1 -> image.height=1
            image.width=60 -> image.height=1
            image.width=1 -> image.height=60
            camera.d=1e-12 -> camera.direction=(0, 0, -1)
            -- It takes seconds.
            camera.d=1e-5 -> image.width=6 -> image.height=4
        ",
        ),
    ) {
        assert_adds_up(&read_with(&figure, size.into_iter().chain(sets)));
    }
}

/// A sphere intersects a face of the box in a circle. The eye is hardly above the plane of the
/// face, so that the circle appears as an ellipse that is nearly a line.
#[test]
fn quarters_add_up_where_a_circle_is_seen_edge_on() {
    let face = "box { min (-100, -50, -100) max (100, 0, 100) color black }";
    let board = "checkerboard { square 1e-4 colors (white, black) }";
    let view = |eye: &str, size: u32, below: &str| {
        read(&format!(
            "image {{ width {size} height {size} background blue }}
             camera {{ eye {eye} direction (0, 0, -1) roll 45deg d 1 view_height 0.3333333333333333 }}
             sphere {{ center (0, 0, 0) radius 1 color red }}
             {below}"
        ))
    };
    let mut random = Random::new(9);
    for exponent in 6..28 {
        let height = libm::ldexp(random.within(1.0, 2.0), -2 * exponent);
        let eye = format!("({}, {height:e}, 3)", random.within(-0.5, 0.5));
        for below in [face, board] {
            let scene = view(&eye, 2, below);
            let bound = assert_part_adds_up(&scene, whole(&scene)).bound();
            assert!(bound <= 1e-9, "{eye}: {bound:e}");
        }
    }
    // The expected value was computed with 50 digits, as an integral along x. The integral is split
    // where the silhouette crosses the sides of the pixel.
    let scene = view("(0.26249413893393775, 3.1572076715858895e-08, 3)", 1, face);
    let ([red, ..], bound) = pixel(&exact(&scene), 0, 0);
    let off = (red - 0.500_000_064_227_617_3).abs();
    assert!(off <= bound && bound < 1e-9, "{off:e}");
}
