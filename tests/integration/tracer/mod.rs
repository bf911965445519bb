//! The tracer against the oracle, above all within the last bits of every boundary: what is beside the catalogue of hard cases, all of which
//! the tests of `numerics` ask.

mod mesh;
pub mod planes;
mod sizes;

use glam::{DVec2, DVec3, dvec2, dvec3};
pub use pinhole::report::numerics::scenes::{camera, cuboid, scene, sphere};
use pinhole::{
    area::Area,
    color::Color,
    math::Angle,
    render::{Control, render, render_exact},
    report::numerics::{
        oracle::{ALL_SIZES, Oracle},
        scenes::{self, SIZE},
    },
    sampling::{CounterRng, Sampling},
    scene::{CenteredTriangle, Lens, Outline, Scene, Shape, Triangle, View},
    tracer::World,
};
use rand::{Rng, RngExt, SeedableRng};

use crate::exact::read;

pub fn triangle(centroid: DVec3, normal: DVec3) -> Shape {
    scenes::triangle(centroid, normal, dvec3(2.0, 2.0, 1.0))
}

/// A triangle turned about its normal by so many degrees.
pub fn turned(centroid: DVec3, normal: DVec3, sides: DVec3, spin: f64) -> Shape {
    let spin = Angle::from_degrees(spin);
    let triangle = CenteredTriangle {
        centroid,
        normal,
        sides,
        spin,
    };
    Shape::Triangle(Triangle {
        outline: Outline::Centered(triangle),
        color: Color::BLACK,
    })
}

/// A triangle by its vertices.
pub fn by_vertices(vertices: [DVec3; 3]) -> Shape {
    Shape::Triangle(Triangle {
        outline: Outline::Vertices(vertices),
        color: Color::BLACK,
    })
}

pub fn floor() -> Shape {
    scenes::board(0.0, 1.0)
}

/// Reproducible numbers.
pub struct Random(CounterRng);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(CounterRng::seed_from_u64(seed))
    }

    pub fn bits(&mut self) -> u64 {
        self.0.next_u64()
    }

    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.random::<f64>()
    }

    /// A multiple of 1/2, at most `limit` halves from 0.
    fn half(&mut self, limit: i64) -> f64 {
        (self.bits() as i64 % (limit + 1)) as f64 / 2.0
    }

    fn point(&mut self, limit: i64) -> DVec3 {
        dvec3(self.half(limit), self.half(limit), self.half(limit))
    }

    pub fn offset(&mut self) -> DVec2 {
        dvec2(self.within(-0.5, 0.5), self.within(-0.5, 0.5))
    }

    pub fn vector(&mut self, size: f64) -> DVec3 {
        let mut one = || self.within(-size, size);
        dvec3(one(), one(), one())
    }
}

/// The colour that the oracle sees, in the numbering of [`scene`].
fn expected(oracle: &Oracle, x: u32, y: u32, offset: DVec2) -> [f64; 3] {
    match oracle.seen(&oracle.direction(x, y, offset)) {
        None => [0.0; 3],
        Some(seen) => [seen.object as f64 + 1.0, f64::from(u8::from(seen.odd)), 0.0],
    }
}

/// Compares the tracer with the oracle: at random points, and at the points of `f64` on both sides of the boundaries that
/// random segments within pixels cross. Returns how many boundaries it found, so that a test can say that there were some.
fn agrees(scene: &Scene, points: usize) -> usize {
    let world = World::new(scene);
    let oracle = Oracle::new(scene, ALL_SIZES);
    let mut random = Random::new(points as u64);
    let color = |x, y, offset| world.palette()[world.slot_at(x, y, offset)].srgb;
    let check = |x, y, offset: DVec2| {
        assert_eq!(
            color(x, y, offset),
            expected(&oracle, x, y, offset),
            "pixel {x}, {y} at {offset:?} of {scene:?}"
        );
    };
    let mut boundaries = 0;
    let mut tries = 0;
    while boundaries < points && tries < 40 * points + 4000 {
        tries += 1;
        let (x, y) = (random.bits() as u32 % SIZE, random.bits() as u32 % SIZE);
        let (mut a, mut b) = (random.offset(), random.offset());
        if tries % 16 == 0 {
            check(x, y, a);
        }
        if color(x, y, a) == color(x, y, b) {
            continue;
        }
        // Along x or y alone, down to neighbouring numbers.
        let axis = usize::from(tries % 2 == 0);
        let mut corner = a;
        corner[axis] = b[axis];
        if color(x, y, corner) == color(x, y, a) {
            continue;
        }
        b = corner;
        loop {
            let mut middle = a;
            middle[axis] = a[axis] + (b[axis] - a[axis]) / 2.0;
            if middle == a || middle == b {
                break;
            }
            if color(x, y, middle) == color(x, y, a) {
                a = middle;
            } else {
                b = middle;
            }
        }
        check(x, y, a);
        check(x, y, b);
        boundaries += 1;
    }
    boundaries
}

#[test]
fn the_figure_agrees_with_the_oracle() {
    let shapes = [
        sphere(dvec3(-1.6, 1.0, 0.0), 1.0),
        triangle(dvec3(0.2, 1.0, 0.6), dvec3(0.3, 0.0, 1.0)),
        cuboid(dvec3(1.75, 0.0, -1.5), dvec3(2.25, 1.5, 0.5)),
        floor(),
    ];
    for (roll, near, far) in [(0.0, 0.0, None), (90.0, 0.0, None), (33.0, 7.0, Some(10.0))] {
        let mut camera = camera(dvec3(3.0, 3.5, 8.0), dvec3(0.2, 0.8, 0.0));
        camera.roll = Angle::from_degrees(roll);
        (camera.near, camera.far) = (near, far);
        assert_eq!(agrees(&scene(camera, &shapes), 60), 60);
    }
}

#[test]
fn random_objects_agree_with_the_oracle() {
    let mut random = Random::new(7);
    let mut found = 0;
    for round in 0..24 {
        let eye = random.vector(4.0);
        let mut camera = camera(eye, random.vector(1.0));
        camera.up = random.vector(1.0);
        camera.roll = Angle {
            degrees: random.within(-400.0, 400.0),
            radians: random.within(-10.0, 10.0),
        };
        camera.lens = Lens::Fov(Angle::from_degrees(random.within(1.0, 179.0)));
        if round % 2 == 0 {
            (camera.near, camera.far) = (2.0, Some(6.0));
        }
        let mut shapes = vec![floor()];
        for _ in 0..2 {
            let corner = random.vector(2.0);
            shapes.push(sphere(random.vector(2.0), random.within(0.1, 3.0)));
            shapes.push(turned(
                random.vector(2.0),
                random.vector(1.0),
                dvec3(2.0, random.within(1.1, 3.9), 2.0),
                random.within(0.0, 360.0),
            ));
            shapes.push(cuboid(
                corner,
                corner + DVec3::splat(random.within(0.1, 2.0)),
            ));
        }
        found += agrees(&scene(camera, &shapes), 16);
    }
    assert!(found > 200);
}
