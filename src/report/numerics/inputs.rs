//! Numbers that only look random, of which inputs are made.

use glam::DVec3;
use rand::{Rng, RngExt};

use super::scenes::SIZE;
use crate::sampling::{
    CounterRng,
    rng::{Key, scale},
};

/// A point of a picture: along each axis a pixel's column or row, and an offset from its centre.
pub type Point = [(u32, f64); 2];

/// The coordinates on either side of the middle of a picture of the usual size, the second one upon
/// it.
pub const MIDDLE: [(u32, f64); 2] = [(SIZE / 2 - 1, 0.5_f64.next_down()), (SIZE / 2, -0.5)];

/// Numbers that are a function of a case and a block of its inputs.
#[derive(Clone, Debug)]
pub struct Random(CounterRng);

impl Random {
    /// The numbers of a block of a case.
    pub fn new(case: &str, block: u64) -> Self {
        let name = case.bytes();
        let name = name.fold(0, |name, byte| name << 8 | u64::from(byte));
        Self(Key::new(name, block).rng())
    }

    /// A whole number below `n`.
    pub fn below(&mut self, n: u64) -> u64 {
        scale(self.0.next_u64(), n)
    }

    /// A whole number from `low` to `high`.
    pub fn whole(&mut self, low: i64, high: i64) -> f64 {
        (low + self.below((high - low + 1) as u64) as i64) as f64
    }

    /// A column or row of a picture of the usual size.
    pub fn pixel(&mut self) -> u32 {
        self.below(SIZE.into()) as u32
    }

    /// One of some things.
    pub fn pick<T: Copy>(&mut self, things: &[T]) -> T {
        things[self.below(things.len() as u64) as usize]
    }

    /// A number between two others, evenly.
    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.random::<f64>()
    }

    /// 10 to a power between two others.
    pub fn power(&mut self, low: f64, high: f64) -> f64 {
        libm::pow(10.0, self.within(low, high))
    }

    /// −1 or 1.
    pub fn sign(&mut self) -> f64 {
        self.pick(&[-1.0, 1.0])
    }

    /// A point of a box, evenly. An axis along which it has no length takes no number.
    pub fn between(&mut self, low: [f64; 3], high: [f64; 3]) -> DVec3 {
        DVec3::from([0, 1, 2].map(|axis| match low[axis] == high[axis] {
            true => low[axis],
            false => self.within(low[axis], high[axis]),
        }))
    }

    /// A point of a box whose coordinates are whole numbers. An axis along which it has no length
    /// takes no number.
    pub fn wholes(&mut self, low: [i64; 3], high: [i64; 3]) -> DVec3 {
        DVec3::from([0, 1, 2].map(|axis| match low[axis] == high[axis] {
            true => low[axis] as f64,
            false => self.whole(low[axis], high[axis]),
        }))
    }

    /// A point of a cube about the origin.
    pub fn vector(&mut self, half: f64) -> DVec3 {
        self.between([-half; 3], [half; 3])
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

    /// A point of a picture of the usual size.
    pub fn point(&mut self) -> Point {
        self.point_of([SIZE; 2])
    }

    /// A point of a picture of so many columns and rows.
    pub fn point_of(&mut self, size: [u32; 2]) -> Point {
        let pixels = size.map(|pixels| self.below(pixels.into()) as u32);
        pixels.map(|pixel| (pixel, self.within(-0.5, 0.5)))
    }
}
