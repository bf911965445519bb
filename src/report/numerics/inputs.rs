//! What inputs are made of: numbers that only look random, and scenes.

use glam::{DVec2, DVec3, dvec2, dvec3};

use crate::{
    color::Color,
    math::Angle,
    sampling::hash::{Key, scale},
    scene::{
        Camera, Checkerboard, Count, Cuboid, Image, Lens, Method, Object, Sampler, Scene, Shape,
        Sphere, Triangle, View,
    },
    source::{SourceId, Span},
};

/// Numbers that are a function of a case and a block of its inputs.
#[derive(Clone, Debug)]
pub struct Random {
    key: Key,
    next: u64,
}

impl Random {
    /// The numbers of a block of a case.
    pub fn new(case: &str, block: u64) -> Self {
        let name = case
            .bytes()
            .fold(0, |name, byte| name << 8 | u64::from(byte));
        Self {
            key: Key::new(name, block),
            next: 0,
        }
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.next += 1;
        self.key.bits(self.next)
    }

    /// A whole number below `n`.
    pub fn below(&mut self, n: u64) -> u64 {
        scale(self.bits(), n)
    }

    /// A whole number from `low` to `high`.
    pub fn whole(&mut self, low: i64, high: i64) -> f64 {
        (low + self.below((high - low + 1) as u64) as i64) as f64
    }

    /// One of some things.
    pub fn pick<T: Copy>(&mut self, things: &[T]) -> T {
        things[self.below(things.len() as u64) as usize]
    }

    /// A number between two others, evenly.
    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// 10 to a power between two others.
    pub fn power(&mut self, low: f64, high: f64) -> f64 {
        libm::pow(10.0, self.within(low, high))
    }

    /// −1 or 1.
    pub fn sign(&mut self) -> f64 {
        self.pick(&[-1.0, 1.0])
    }

    /// A point of a cube about the origin.
    pub fn vector(&mut self, half: f64) -> DVec3 {
        let mut one = || self.within(-half, half);
        dvec3(one(), one(), one())
    }

    /// A vector of length 1.
    pub fn unit(&mut self) -> DVec3 {
        loop {
            let v = self.vector(1.0);
            if (0.01..1.0).contains(&v.length_squared()) {
                return v.normalize();
            }
        }
    }

    /// An offset from the centre of a pixel.
    pub fn offset(&mut self) -> DVec2 {
        dvec2(self.within(-0.5, 0.5), self.within(-0.5, 0.5))
    }
}

/// Columns and rows of the pictures, but where a case says otherwise.
pub const SIZE: u32 = 64;

/// A camera with the language's defaults.
pub fn camera(eye: DVec3, lookat: DVec3) -> Camera {
    Camera {
        eye,
        view: View::Lookat(lookat),
        up: DVec3::Y,
        roll: Angle::default(),
        lens: Lens::Distance(2.0),
        view_height: 2.0,
        near: 0.0,
        far: None,
    }
}

/// A camera that looks along a vector.
pub fn along(eye: DVec3, direction: DVec3) -> Camera {
    Camera {
        view: View::Direction(direction),
        ..camera(eye, DVec3::ZERO)
    }
}

/// A sphere.
pub fn sphere(center: DVec3, radius: f64) -> Shape {
    Shape::Sphere(Sphere {
        center,
        radius,
        color: Color::BLACK,
    })
}

/// A box.
pub fn cuboid(min: DVec3, max: DVec3) -> Shape {
    Shape::Box(Cuboid {
        min,
        max,
        color: Color::BLACK,
    })
}

/// A triangle, not spun.
pub fn triangle(centroid: DVec3, normal: DVec3, sides: DVec3) -> Shape {
    spun(centroid, normal, sides, 0.0)
}

/// A triangle, spun by so many degrees.
pub fn spun(centroid: DVec3, normal: DVec3, sides: DVec3, spin: f64) -> Shape {
    Shape::Triangle(Triangle {
        centroid,
        normal,
        sides,
        spin: Angle::from_degrees(spin),
        color: Color::BLACK,
    })
}

/// A checkerboard.
pub fn board(y: f64, square: f64) -> Shape {
    Shape::Checkerboard(Checkerboard {
        y,
        square,
        colors: [Color::BLACK; 2],
    })
}

/// A scene whose colours tell its objects apart.
pub fn scene(camera: Camera, shapes: &[Shape]) -> Scene {
    let objects = (1..).zip(shapes).map(|(number, shape)| {
        let own = Color::from_bytes([number, 0, 0]);
        let mut shape = *shape;
        match &mut shape {
            Shape::Sphere(Sphere { color, .. })
            | Shape::Triangle(Triangle { color, .. })
            | Shape::Box(Cuboid { color, .. }) => *color = own,
            Shape::Checkerboard(Checkerboard { colors, .. }) => {
                *colors = [own, Color::from_bytes([number, 1, 0])];
            }
        }
        Object {
            name: None,
            shape,
            span: Span::new(SourceId::File, 0, 0),
        }
    });
    Scene {
        image: Image {
            width: SIZE,
            height: SIZE,
            background: Color::BLACK,
        },
        camera,
        sampler: Sampler {
            method: Method::Random,
            count: Count::PerPixel(1),
            seed: 0,
        },
        objects: objects.collect(),
    }
}
