//! Laws of pictures: what moving, turning, scaling and mirroring a world with its camera does to them, to the bit.
//!
//! Coordinates are multiples of 1/128, so that moving and turning them is exact.

use glam::{DVec3, dvec3};
use pinhole::{
    area::Area,
    color::Color,
    film::Film,
    math::{Angle, predicates},
    render::{Control, Exact, render, render_exact},
    sampling::Sampling,
    scene::{
        Camera, CenteredTriangle, Checkerboard, Count, Cuboid, Lens, Method, Outline, Sampler,
        Scene, Shape, Sphere, Triangle, View,
    },
    tracer::World,
};
use proptest::prelude::*;

use crate::tracer::scene;

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
    let color = Color::BLACK;
    prop_oneof![
        (vector(), length()).prop_map(move |(center, radius)| Shape::Sphere(Sphere {
            center,
            radius,
            color
        })),
        (vector(), [length(), length(), length()]).prop_map(move |(min, size)| {
            let max = min + DVec3::from(size);
            Shape::Box(Cuboid { min, max, color })
        }),
        [vector(), vector(), vector()]
            .prop_filter("not on one line", |points| !predicates::are_on_one_line(
                *points
            ))
            .prop_map(move |vertices| Shape::Triangle(Triangle {
                outline: Outline::Vertices(vertices),
                color
            })),
        (vector(), direction(), length(), -180..180).prop_map(
            move |(centroid, normal, size, spin)| Shape::Triangle(Triangle {
                outline: Outline::Centered(CenteredTriangle {
                    centroid,
                    normal,
                    sides: dvec3(1.0, 0.75, 0.5) * size,
                    spin: Angle::from_degrees(f64::from(spin)),
                }),
                color
            })
        ),
    ]
}

fn stage() -> impl Strategy<Value = Stage> {
    (any_camera(), prop::collection::vec(any_shape(), 0..4))
        .prop_map(|(camera, mut shapes)| {
            let at = shapes.len() / 2;
            shapes.insert(at, board(0.0, 1.0));
            Stage { camera, shapes }
        })
        .prop_filter("up is not along the view", |stage| {
            let View::Lookat(at) = stage.camera.view else {
                return false;
            };
            let view = at - stage.camera.eye;
            view.x != 0.0 || view.z != 0.0
        })
}

fn board(y: f64, square: f64) -> Shape {
    Shape::Checkerboard(Checkerboard {
        y,
        square,
        colors: [Color::BLACK; 2],
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
        let mut camera = self.camera;
        camera.eye = place(camera.eye);
        if let View::Lookat(at) = camera.view {
            camera.view = View::Lookat(place(at));
        }
        camera.near *= scale;
        camera.far = camera.far.map(|far| far * scale);
        let shapes = self.shapes.iter().map(|shape| match *shape {
            Shape::Sphere(shape) => Shape::Sphere(Sphere {
                center: place(shape.center),
                radius: shape.radius * scale,
                ..shape
            }),
            Shape::Triangle(shape) => Shape::Triangle(Triangle {
                outline: match shape.outline {
                    Outline::Centered(shape) => Outline::Centered(CenteredTriangle {
                        centroid: place(shape.centroid),
                        normal: direction(shape.normal),
                        sides: shape.sides * scale,
                        ..shape
                    }),
                    Outline::Vertices(vertices) => Outline::Vertices(vertices.map(&place)),
                },
                ..shape
            }),
            Shape::Box(shape) => {
                let (a, b) = (place(shape.min), place(shape.max));
                Shape::Box(Cuboid {
                    min: a.min(b),
                    max: a.max(b),
                    ..shape
                })
            }
            Shape::Checkerboard(shape) => Shape::Checkerboard(Checkerboard {
                y: place(DVec3::Y * shape.y).y,
                square: shape.square * scale,
                ..shape
            }),
        });
        Self {
            camera,
            shapes: shapes.collect(),
        }
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
        for object in &mut scene.objects {
            if let Shape::Checkerboard(board) = &mut object.shape
                && swapped
            {
                board.colors.swap(0, 1);
            }
        }
        scene
    }

    fn picture(&self) -> Picture {
        picture(&self.scene(METHOD, false))
    }
}

/// The bits of a picture, row by row.
type Picture = Vec<Vec<[u64; 3]>>;

fn film(scene: &Scene) -> Film {
    let (width, height) = (scene.image.width, scene.image.height);
    let sampling = Sampling::new(&scene.sampler, width, height);
    let control = Control::default();
    render(
        &World::new(scene),
        &sampling,
        Area::whole(width, height),
        &control,
    )
    .unwrap()
}

fn picture(scene: &Scene) -> Picture {
    let film = film(scene);
    let bits = |row| {
        film.row(row)
            .iter()
            .map(|pixel| pixel.map(f64::to_bits))
            .collect()
    };
    (0..scene.image.height).map(bits).collect()
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
    fn a_half_turn_about_y_changes_nothing(stage in stage()) {
        let turn = |v: DVec3| dvec3(-v.x, v.y, -v.z);
        // A normal along the axis does not turn its triangle with it, whose base then is along the world's x: spin does.
        let mut after = stage.mapped(turn, turn, 1.0);
        turn_vertical(&mut after, 180.0);
        prop_assert_eq!(stage.picture(), after.picture());
        agree(&stage.scene(METHOD, false), &after.scene(METHOD, false), false);
    }

    #[test]
    fn a_quarter_turn_about_y_swaps_the_boards_colours(stage in stage()) {
        // The square at (i, j) becomes that at (j, −1 − i).
        let turn = |v: DVec3| dvec3(v.z, v.y, -v.x);
        let mut after = stage.mapped(turn, turn, 1.0);
        turn_vertical(&mut after, 90.0);
        let after = after.scene(METHOD, true);
        prop_assert_eq!(stage.picture(), picture(&after));
        agree(&stage.scene(METHOD, false), &after, false);
    }

    #[test]
    fn moving_by_an_even_number_of_squares_changes_nothing(
        stage in stage(), x in -1_000_000..1_000_000, y in coordinate(), z in -1_000_000..1_000_000
    ) {
        let even = (x + z) % 2;
        let by = dvec3(f64::from(x - even), y, f64::from(z));
        let after = stage.mapped(|p| p + by, |v| v, 1.0);
        prop_assert_eq!(stage.picture(), after.picture());
        agree(&stage.scene(METHOD, false), &after.scene(METHOD, false), false);
    }

    #[test]
    fn moving_by_an_odd_number_of_squares_swaps_the_boards_colours(
        stage in stage(), x in -1_000_000..1_000_000, z in -1_000_000..1_000_000
    ) {
        let odd = 1 - i32::rem_euclid(x + z, 2);
        let by = dvec3(f64::from(x + odd), 0.0, f64::from(z));
        let after = stage.mapped(|p| p + by, |v| v, 1.0);
        let after = after.scene(METHOD, true);
        prop_assert_eq!(stage.picture(), picture(&after));
        agree(&stage.scene(METHOD, false), &after, false);
    }

    #[test]
    fn scaling_by_a_power_of_two_changes_nothing(stage in stage(), exponent in -900..900) {
        let scale = libm::exp2(f64::from(exponent));
        let after = stage.mapped(|p| p * scale, |v| v * scale, scale);
        prop_assert_eq!(stage.picture(), after.picture());
        agree(&stage.scene(METHOD, false), &after.scene(METHOD, false), false);
    }

    #[test]
    fn a_mirror_in_x_mirrors_the_picture(stage in stage()) {
        let mirror = |v: DVec3| dvec3(-v.x, v.y, v.z);
        let mut after = stage.mapped(mirror, mirror, 1.0);
        after.camera.roll = -after.camera.roll;
        for shape in &mut after.shapes {
            if let Shape::Triangle(triangle) = shape
                && let Outline::Centered(triangle) = &mut triangle.outline
            {
                std::mem::swap(&mut triangle.sides.x, &mut triangle.sides.y);
                triangle.spin = -triangle.spin;
            }
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
                Shape::Sphere(Sphere { center: in_plane(center), radius, color: Color::BLACK }),
                Shape::Box(Cuboid {
                    min: dvec3(-size, -1.0, center.x),
                    max: dvec3(size, center.y.abs(), center.x + radius),
                    color: Color::BLACK,
                }),
                Shape::Triangle(Triangle { outline: Outline::Centered(CenteredTriangle {
                    centroid: dvec3(0.0, center.z, center.x + 1.0),
                    normal: dvec3(0.0, down, 1.0),
                    sides: dvec3(2.0, 2.0, 1.0),
                    spin: Angle::default(),
}), color: Color::BLACK,
}),
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
    for shape in &mut stage.shapes {
        if let Shape::Triangle(triangle) = shape
            && let Outline::Centered(triangle) = &mut triangle.outline
            && triangle.normal.x == 0.0
            && triangle.normal.z == 0.0
        {
            let turn = Angle::from_degrees(degrees.copysign(triangle.normal.y));
            triangle.spin = triangle.spin + turn;
        }
    }
}
