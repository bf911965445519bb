//! Compares the tracer with an independent tracer in arithmetic of high precision, the oracle. Most
//! compared points are within a few units in the last place of a boundary between two colours of
//! the picture. The tests of `numerics` cover the catalogue of hard cases.

use glam::{DVec2, DVec3, dvec2, dvec3};
pub use pinhole::reference::scenes::{camera, cuboid, scene, sphere};
use pinhole::{
    color::Color,
    reference::{
        oracle::{ALL_SIZES, Oracle},
        scenes,
    },
    scene::{Camera, Count, Method, Scene, Shape, Triangle, TriangleOutline, View},
    tracer::World,
};

use crate::{
    generated::{Numbers, generated},
    random::Random,
    scenes::{exact, read, resized, sampled, with_samples},
    table::rows,
};

pub fn triangle(centroid: DVec3, normal: DVec3) -> Shape {
    scenes::triangle(centroid, normal, dvec3(2.0, 2.0, 1.0))
}

/// Returns a black triangle with the given vertices.
pub fn by_vertices(vertices: [DVec3; 3]) -> Shape {
    Shape::Triangle(Triangle {
        outline: TriangleOutline::Vertices(vertices),
        color: Color::BLACK,
    })
}

pub fn floor() -> Shape {
    scenes::board(0.0, 1.0)
}

/// Returns whether the camera's up vector determines its orientation. If the camera looks along
/// this vector, the coordinate axes do so instead.
pub fn is_upright(scene: &Scene) -> bool {
    let Camera { eye, view, up, .. } = scene.camera;
    let direction = match view {
        View::Lookat(at) => at - eye,
        View::Direction(direction) => direction,
    };
    direction.cross(up) != DVec3::ZERO
}

/// A scene in Pinhole's tracer and in the oracle, an independent tracer of high precision. Colours
/// tell the objects apart, and also the two kinds of squares of a checkerboard.
struct TracerAndOracle {
    scene: Scene,
    world: World,
    oracle: Oracle,
}

impl TracerAndOracle {
    fn new(original: &Scene) -> Self {
        let shapes: Vec<_> = original.objects.iter().map(|object| object.shape).collect();
        let mut scene = scene(original.camera, &shapes);
        scene.image = original.image;
        scene.image.background = Color::BLACK;
        Self {
            world: World::new(&scene),
            oracle: Oracle::new(&scene, ALL_SIZES),
            scene,
        }
    }

    fn color(&self, x: u32, y: u32, offset: DVec2) -> [f64; 3] {
        self.world.palette()[self.world.color_index_at(x, y, offset)].srgb
    }

    /// Asserts that the tracer and the oracle (an independent tracer of high precision) see the
    /// same colour at an offset in the pixel (x, y). Returns the colour.
    #[track_caller]
    fn check(&self, x: u32, y: u32, offset: DVec2) -> [f64; 3] {
        let expected = match self.oracle.seen(&self.oracle.direction(x, y, offset)) {
            None => [0.0; 3],
            Some(seen) => [seen.object as f64 + 1.0, f64::from(u8::from(seen.odd)), 0.0],
        };
        let found = self.color(x, y, offset);
        let scene = &self.scene;
        assert_eq!(found, expected, "pixel {x}, {y} at {offset:?} of {scene:?}");
        found
    }
}

/// Compares the tracer with the oracle, an independent tracer of high precision, at random points.
/// Then bisects random segments within pixels, and compares both sides of each colour boundary at
/// neighbouring `f64` points. Returns the number of boundaries found, so that a test can require a
/// minimum.
#[track_caller]
fn assert_agrees_with_oracle(scene: &Scene, points: usize) -> usize {
    let both = TracerAndOracle::new(scene);
    let mut random = Random::new(points as u64);
    let mut boundaries = 0;
    for tries in 0..40 * points + 4000 {
        let [x, y] = [scene.image.width, scene.image.height].map(|n| random.bits() as u32 % n);
        let (mut a, mut b) = (random.offset(), random.offset());
        if tries % 16 == 0 {
            both.check(x, y, a);
        }
        // The segment is parallel to x or y, and is bisected down to neighbouring `f64` values.
        let axis = tries % 2;
        b[1 - axis] = a[1 - axis];
        let color = both.color(x, y, a);
        if both.color(x, y, b) == color {
            continue;
        }
        loop {
            let mut middle = a;
            middle[axis] = a[axis] + (b[axis] - a[axis]) / 2.0;
            if middle == a || middle == b {
                break;
            }
            if both.color(x, y, middle) == color {
                a = middle;
            } else {
                b = middle;
            }
        }
        both.check(x, y, a);
        both.check(x, y, b);
        boundaries += 1;
        if boundaries == points {
            break;
        }
    }
    boundaries
}

#[test]
fn scenes_of_random_numbers_agree_with_the_oracle() {
    let scenes = generated(Numbers::Wild(0), [64, 64], 7).map(|(_, scene)| scene);
    let scenes = scenes.filter(is_upright).take(48);
    let found: usize = scenes
        .map(|scene| assert_agrees_with_oracle(&scene, 16))
        .sum();
    assert!(found > 200, "{found}");
}

#[test]
fn scenes_full_of_ties_agree_with_the_oracle() {
    // The sample points are at multiples of 1/8 pixel, so many of them lie exactly on edges.
    let mut random = Random::new(11);
    let scenes = generated(Numbers::MultiplesOf(0.5), [8, 8], 11).map(|(_, scene)| scene);
    for scene in scenes.filter(is_upright).take(150) {
        let both = TracerAndOracle::new(&scene);
        for _ in 0..30 {
            let [x, y] = [(); 2].map(|()| random.bits() as u32 % 8);
            let [right, down] = [(); 2].map(|()| (random.bits() % 8) as f64 / 8.0 - 0.5);
            both.check(x, y, dvec2(right, down));
        }
    }
}

#[test]
fn fans_of_triangles_agree_with_the_oracle() {
    let mut random = Random::new(11);
    let mut found = 0;
    for round in 0..24 {
        let camera = camera(random.vector(4.0), random.vector(1.0));
        // A fan of triangles, small or large, surrounds one vertex.
        let size = [1.0, 1e-3, 1e3][round % 3];
        let middle = random.vector(1.0);
        let rim: Vec<DVec3> = (0..5).map(|_| middle + random.vector(2.0) * size).collect();
        let fan = (0..5).map(|at| by_vertices([middle, rim[at], rim[(at + 1) % 5]]));
        let shapes: Vec<Shape> = fan.chain([floor()]).collect();
        found += assert_agrees_with_oracle(&scene(camera, &shapes), 16);
    }
    assert!(found > 200, "{found}");
}

/// The distances of surfaces from the eye are equal, or close to the smallest or the largest `f64`.
/// The tracer and the oracle must nevertheless see the same surface.
#[test]
fn objects_at_the_limits_of_f64_agree_with_the_oracle() {
    for [scene, values, boundaries] in rows(
        "
        -- A floor as close below the eye, and a box as close before it.
        camera { eye (0.3, $, 5.3) direction (0, -0.3, -1) } checkerboard {} sphere { center (0, 1, 0) } -> 5e-324 | 1e-309 | 1e-300 -> 10
        camera { eye (0, 0.1, 0) direction (0, -0.3, -1) } sphere { center (0, 0, -3) radius 0.5 } box { min (-1, -1, -1) max (1, 1, -$) } checkerboard {} -> 5e-324 | 1e-309 | 1e-300 -> 0
        -- Just inside of a huge sphere, with something else before its far side.
        camera { eye (0, -1, 0) direction (0, 0, -1) } sphere { center (0, -$, 0) radius $ } box { min (-1, -2, -11) max (1, 1, -10) } -> 1e20 | 1e60 | 1e100 -> 10
        -- All of one size.
        let s = $ camera { eye s * (1, 2, 3) lookat (0, 0, 0) } sphere { center (0, 0, 0) radius 0.7 * s } box { min s * (0.1, 0.1, 0.1) max s * (0.6, 0.6, 0.6) } triangle { centroid s * (0.1, 0.4, 0.9) normal s * (0.2, 0.3, 1) sides s * (2, 2, 1) } checkerboard { y -0.5 * s square s } -> 1e-300 | 1e-160 | 1e-5 | 1e160 | 1e300 -> 10
        -- Of a box and of a triangle in its face the first one is seen, whatever the vertices' differences round to.
        camera { eye (0.3, 0.2, 5) lookat (0, 0, 0) } triangle { $ } box { center (0, 0, 0) size (2, 2, 2) } -> v0 (-1, -1, 1) v1 (1, -1, 1) v2 (-1, 1, 1) | v0 (0.1, 0.3, 1) v1 (0.7, 0.2, 1) v2 (0.5, 0.9, 1) -> 10
        camera { eye (0.3, 0.2, 5) lookat (0, 0, 0) } box { center (0, 0, 0) size (2, 2, 2) } triangle { $ } -> v0 (-1, -1, 1) v1 (1, -1, 1) v2 (-1, 1, 1) | v0 (0.1, 0.3, 1) v1 (0.7, 0.2, 1) v2 (0.5, 0.9, 1) -> 10
    ",
    ) {
        for value in values.split('|') {
            let scene = read(&scene.replace('$', value.trim()));
            let found = assert_agrees_with_oracle(&resized(scene, 64, 64), 10);
            assert!(found >= boundaries.parse().unwrap(), "{value}: {found}");
        }
    }
}

#[test]
fn lenses_at_the_limits_of_f64_show_the_right_objects() {
    let mut random = Random::new(4);
    for [lens, seen] in rows(
        "
        d 1e-300 view_height 1e300 -> 0 0 0 0
        d 1e300 view_height 1e-30 -> 1 1 2 2
        d 1e300 view_height 1e300 -> 0 1 2 0
        d 1e-300 view_height 1e-300 -> 0 1 2 0
    ",
    ) {
        let both = TracerAndOracle::new(&read(&format!(
            "image {{ width 64 height 64 }} camera {{ eye (0, 0, 5) direction (0, 0, -1) {lens} }}
             box {{ min (-1, -1, -1) max (0, 1, 0) }} box {{ min (0, -1, -1) max (1, 1, 0) }}"
        )));
        // The red value is 1 for the first box, 2 for the second, and 0 for the background. The
        // boxes touch in a face that is seen edge-on, in the middle of the picture: between the
        // columns 31 and 32.
        for (x, seen) in [0, 31, 32, 63].into_iter().zip(seen.split(' ')) {
            let found = both.color(x, 31, random.offset())[0];
            assert_eq!(found.to_string(), seen, "{lens}: {x}");
        }
    }
}

/// Two triangles are the halves of a square in front of a red background. Their common diagonal
/// passes through the centres of pixels.
#[test]
fn two_halves_of_a_square_leave_no_gap() {
    for other in [
        "v0 (-1, -1, 0) v1 (1, 1, 0) v2 (1, -1, 0)",
        "v0 (1, 1, 0) v1 (-1, -1, 0) v2 (1, -1, 0)",
        "v0 (1, -1, 0) v1 (1, 1, 0) v2 (-1, -1, 0)",
    ] {
        for eye in ["(0, 0, 2)", "(0.1, 0.2, -1.7)", "(1.2, 0.3, 0.9)"] {
            let scene = read(&format!(
                "image {{ width 40 height 40 background red }}
                 camera {{ eye {eye} lookat (0, 0, 0) d 2 view_height 1 }}
                 triangle {{ v0 (-1, -1, 0) v1 (1, 1, 0) v2 (-1, 1, 0) color white }}
                 triangle {{ {other} color white }}"
            ));
            let scene = with_samples(&scene, Method::Regular, Count::PerPixel(1));
            let (sampled, exact) = (sampled(&scene), exact(&scene));
            let mut seen = 0;
            for (sampled, [_, exact, _]) in sampled.pixels().iter().zip(exact.film.pixels()) {
                // If a gap showed the red background, red and green would differ. At the square's
                // edges, where green is below 1, they may differ.
                assert!(sampled[0] == sampled[1] || *exact < 1.0, "from {eye}");
                seen += u32::from(sampled[1] == 1.0);
                if eye == "(0, 0, 2)" {
                    assert!(
                        *sampled == [1.0; 3] && (exact - 1.0).abs() <= 1e-9,
                        "{exact}"
                    );
                }
            }
            assert!(seen > 400, "{seen} from {eye}");
        }
    }
}

#[test]
fn triangles_too_small_or_too_far_away_leave_no_light() {
    for [triangle, direction] in rows(
        "
        centroid (1e10, 1e100, -1e100) sides (1, 1, 1) -> (0.1, 0.7, -1)
        centroid (0.1, 0.2, -1.7) sides (1e-95, 1e-95, 1e-95) -> (0.01, 0, -1)
        centroid (0.1, 0.2, -1.7) sides (2e-300, 2e-300, 1e-300) -> (0.01, 0, -1)
        centroid (0.1, 0.2, -1e160) sides (2, 2, 1) -> (0.01, 0, -1)
    ",
    ) {
        let scene = read(&format!(
            "image {{ width 300 height 200 background black }}
             camera {{ eye (0.1, 0.2, 0.3) direction {direction} }}
             sampler {{ per_pixel 1 }}
             triangle {{ {triangle} normal (-0.3, 0.2, 1) color lime }}"
        ));
        for film in [sampled(&scene), exact(&scene).film] {
            let greens = film.pixels().iter().map(|pixel| pixel[1]);
            let most = greens.fold(0.0, f64::max);
            assert!(most < 1e-12, "{triangle}: {most}");
        }
    }
}
