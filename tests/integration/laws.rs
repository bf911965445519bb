//! Laws of pictures: what moving, turning, scaling and mirroring a world with its camera does to them, to the bit.
//!
//! Coordinates are multiples of 1/128, so that moving and turning them is exact.

use std::sync::Arc;

use glam::{DVec3, Vec3Swizzles, dvec3};
use pinhole::{
    area::Area,
    math::{Angle, predicates},
    render::{Control, Exact, render_exact},
    scene::{
        Camera, CenteredTriangle, Count, Lens, Method, Outline, Sampler, Scene, Shape, Triangle,
        View,
    },
    tracer::World,
};
use proptest::prelude::*;

use crate::{
    scenes::sampled,
    tracer::{by_vertices, cuboid, floor, scene, sphere, turned},
};

const SIZE: u32 = 24;

/// By which the pictures are sampled whose samples no law moves.
const METHOD: Method = Method::MultiJittered;

/// A camera and some objects.
#[derive(Clone, Debug)]
struct Stage {
    camera: Camera,
    shapes: Vec<Shape>,
}

fn coordinate() -> impl Strategy<Value = f64> {
    (-256..256).prop_map(|n| f64::from(n) / 64.0)
}

fn vector() -> impl Strategy<Value = DVec3> {
    [coordinate(), coordinate(), coordinate()].prop_map(DVec3::from)
}

fn length() -> impl Strategy<Value = f64> {
    (16..256).prop_map(|n| f64::from(n) / 64.0)
}

fn direction() -> impl Strategy<Value = DVec3> {
    vector().prop_filter("not zero", |v| *v != DVec3::ZERO)
}

/// Any camera but those that look straight up or down, whose pictures turn by a rule that knows the world's axes.
fn any_camera() -> impl Strategy<Value = Camera> {
    (vector(), direction(), -360..360, length(), any::<bool>()).prop_map(
        |(eye, direction, roll, d, clipped)| Camera {
            eye: eye + dvec3(0.0, 1.0 / 128.0, 8.0),
            view: View::Lookat(eye + dvec3(0.0, 1.0 / 128.0, 8.0) + direction),
            up: DVec3::Y,
            roll: Angle::from_degrees(f64::from(roll)),
            lens: Lens::Distance(d),
            view_height: 4.0,
            near: if clipped { 1.5 } else { 0.0 },
            far: clipped.then_some(12.0),
        },
    )
}

fn any_shape() -> impl Strategy<Value = Shape> {
    prop_oneof![
        (vector(), length()).prop_map(|(center, radius)| sphere(center, radius)),
        (vector(), [length(), length(), length()])
            .prop_map(|(min, size)| cuboid(min, min + DVec3::from(size))),
        [vector(), vector(), vector()]
            .prop_filter("not on one line", |points| !predicates::are_on_one_line(
                *points
            ))
            .prop_map(by_vertices),
        (vector(), direction(), length(), -180..180).prop_map(|(centroid, normal, size, spin)| {
            turned(
                centroid,
                normal,
                dvec3(1.0, 0.75, 0.5) * size,
                f64::from(spin),
            )
        }),
    ]
}

fn stage() -> impl Strategy<Value = Stage> {
    (any_camera(), prop::collection::vec(any_shape(), 0..4))
        .prop_map(|(camera, mut shapes)| {
            let at = shapes.len() / 2;
            shapes.insert(at, floor());
            Stage { camera, shapes }
        })
        .prop_filter("up is not along the view", |stage| {
            matches!(stage.camera.view, View::Lookat(at) if at.xz() != stage.camera.eye.xz())
        })
}

impl Stage {
    /// The same with all places changed by one map, all directions and lengths by others.
    fn mapped(
        &self,
        place: impl Fn(DVec3) -> DVec3,
        direction: impl Fn(DVec3) -> DVec3,
        scale: f64,
    ) -> Self {
        let mut stage = self.clone();
        let camera = &mut stage.camera;
        camera.eye = place(camera.eye);
        if let View::Lookat(at) = camera.view {
            camera.view = View::Lookat(place(at));
        }
        camera.near *= scale;
        camera.far = camera.far.map(|far| far * scale);
        for shape in &mut stage.shapes {
            match shape {
                Shape::Sphere(sphere) => {
                    sphere.center = place(sphere.center);
                    sphere.radius *= scale;
                }
                Shape::Triangle(triangle) => match &mut triangle.outline {
                    Outline::Centered(triangle) => {
                        triangle.centroid = place(triangle.centroid);
                        triangle.normal = direction(triangle.normal);
                        triangle.sides *= scale;
                    }
                    Outline::Vertices(vertices) => *vertices = vertices.map(&place),
                },
                Shape::Box(cuboid) => {
                    let (a, b) = (place(cuboid.min), place(cuboid.max));
                    (cuboid.min, cuboid.max) = (a.min(b), a.max(b));
                }
                Shape::Checkerboard(board) => {
                    board.y = place(DVec3::Y * board.y).y;
                    board.square *= scale;
                }
            }
        }
        stage
    }

    /// The scene, with the board's colours swapped or not.
    fn scene(&self, method: Method, swapped: bool) -> Scene {
        let mut scene = scene(self.camera, &self.shapes);
        (scene.image.width, scene.image.height) = (SIZE, SIZE);
        scene.sampler = Sampler {
            method,
            count: Count::PerPixel(9),
            seed: 5,
        };
        for object in Arc::make_mut(&mut scene.objects) {
            if let Shape::Checkerboard(board) = &mut object.shape
                && swapped
            {
                board.colors.swap(0, 1);
            }
        }
        scene
    }
}

/// The bits of a picture, row by row.
type Picture = Vec<Vec<[u64; 3]>>;

fn picture(scene: &Scene) -> Picture {
    let film = sampled(scene, Area::whole(scene.image.width, scene.image.height));
    let row = |row| film.row(row).iter();
    let bits = |y| row(y).map(|pixel| pixel.map(f64::to_bits)).collect();
    (0..film.height()).map(bits).collect()
}

/// The pictures of two stages are the same, with the board's colours swapped in the second or not: sampled to the bit, and exactly.
fn same(before: &Stage, after: &Stage, is_swapped: bool) {
    let (before, after) = (before.scene(METHOD, false), after.scene(METHOD, is_swapped));
    assert_eq!(picture(&before), picture(&after));
    agree(&before, &after, false);
}

/// The exact pictures of two scenes are the same, as far as their bounds allow to say so; or one is the other's mirror image.
fn agree(before: &Scene, after: &Scene, is_mirrored: bool) {
    let [before, after] = [before, after].map(exact);
    let width = before.film.width();
    for (index, (mean, bound)) in before.film.pixels().iter().zip(&before.bounds).enumerate() {
        let (x, y) = (index as u32 % width, index as u32 / width);
        let x = if is_mirrored { width - 1 - x } else { x };
        let (other, other_bound) = (
            after.film.pixel(x, y),
            after.bounds[(y * width + x) as usize],
        );
        // A rounding of each, besides.
        let most = f64::from(*bound) + f64::from(other_bound) + f64::EPSILON;
        for channel in 0..3 {
            let error = (mean[channel] - other[channel]).abs();
            assert!(error <= most, "{x}, {y}: {error:e} > {most:e}");
        }
        assert!(*bound <= 1e-6, "{x}, {y}: {bound:e}");
    }
}

/// The exact picture of a scene, with fewer pixels.
fn exact(scene: &Scene) -> Exact {
    const EXACT_SIZE: u32 = 12;
    let mut scene = scene.clone();
    (scene.image.width, scene.image.height) = (EXACT_SIZE, EXACT_SIZE);
    let control = Control::default();
    let whole = Area::whole(EXACT_SIZE, EXACT_SIZE);
    render_exact(&World::new(&scene), whole, &control).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn quarter_turns_about_y_swap_the_boards_colours(stage in stage(), turns in 1..4) {
        // The square at (i, j) becomes that at (j, −1 − i).
        let turn = |v: DVec3| (0..turns).fold(v, |v, _| dvec3(v.z, v.y, -v.x));
        // A normal along the axis does not turn its triangle with it, whose base then is along the world's x: spin does.
        let mut after = stage.mapped(turn, turn, 1.0);
        turn_vertical(&mut after, 90.0 * f64::from(turns));
        same(&stage, &after, turns % 2 == 1);
    }

    #[test]
    fn moving_by_squares_swaps_the_boards_colours_if_they_are_odd(
        stage in stage(), x in -1_000_000..1_000_000, y in coordinate(), z in -1_000_000..1_000_000
    ) {
        let by = dvec3(f64::from(x), y, f64::from(z));
        same(&stage, &stage.mapped(|p| p + by, |v| v, 1.0), (x + z) % 2 != 0);
    }

    #[test]
    fn scaling_by_a_power_of_two_changes_nothing(stage in stage(), exponent in -900..900) {
        let scale = libm::exp2(f64::from(exponent));
        same(&stage, &stage.mapped(|p| p * scale, |v| v * scale, scale), false);
    }

    #[test]
    fn a_mirror_in_x_mirrors_the_picture(stage in stage()) {
        let mirror = |v: DVec3| dvec3(-v.x, v.y, v.z);
        let mut after = stage.mapped(mirror, mirror, 1.0);
        after.camera.roll = -after.camera.roll;
        for triangle in after.shapes.iter_mut().filter_map(centered) {
            std::mem::swap(&mut triangle.sides.x, &mut triangle.sides.y);
            triangle.spin = -triangle.spin;
        }
        let (stage, after) = (stage.scene(Method::Regular, false), after.scene(Method::Regular, true));
        agree(&stage, &after, true);
        let mut after = picture(&after);
        for row in &mut after {
            row.reverse();
        }
        prop_assert_eq!(picture(&stage), after);
    }

    #[test]
    fn a_symmetric_scene_gives_a_symmetric_picture(
        eye in vector(), down in coordinate(), center in vector(), radius in length(), size in length(), count in 1u64..12,
        d in length(), is_lookat in any::<bool>()
    ) {
        let in_plane = |v: DVec3| dvec3(0.0, v.y, v.z);
        let (eye, direction) = (in_plane(eye) + DVec3::Z * 8.0, dvec3(0.0, down / 4.0, -1.0));
        let stage = Stage {
            camera: Camera {
                eye,
                view: match is_lookat {
                    true => View::Lookat(eye + direction),
                    false => View::Direction(direction),
                },
                up: DVec3::Y,
                roll: Angle::default(),
                lens: Lens::Distance(d),
                view_height: 4.0,
                near: 0.5,
                far: Some(20.0),
            },
            shapes: vec![
                sphere(in_plane(center), radius),
                cuboid(dvec3(-size, -1.0, center.x), dvec3(size, center.y.abs(), center.x + radius)),
                turned(dvec3(0.0, center.z, center.x + 1.0), dvec3(0.0, down, 1.0), dvec3(2.0, 2.0, 1.0), 0.0),
            ],
        };
        let mut scene = stage.scene(Method::Regular, false);
        // Odd and even numbers of columns and samples.
        scene.image.width = SIZE - (count as u32 & 1);
        scene.sampler.count = Count::PerPixel(count);
        agree(&scene, &scene, true);
        let picture = picture(&scene);
        for row in &picture {
            let mirrored: Vec<_> = row.iter().rev().copied().collect();
            prop_assert_eq!(row, &mirrored);
        }
    }
}

/// Turns the triangles whose normals are vertical about y, as everything else was.
fn turn_vertical(stage: &mut Stage, degrees: f64) {
    for triangle in stage.shapes.iter_mut().filter_map(centered) {
        if triangle.normal.x == 0.0 && triangle.normal.z == 0.0 {
            triangle.spin =
                triangle.spin + Angle::from_degrees(degrees.copysign(triangle.normal.y));
        }
    }
}

fn centered(shape: &mut Shape) -> Option<&mut CenteredTriangle> {
    match shape {
        Shape::Triangle(Triangle {
            outline: Outline::Centered(triangle),
            ..
        }) => Some(triangle),
        _ => None,
    }
}
