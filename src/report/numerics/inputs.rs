//! Pseudorandom numbers for the inputs of hard cases.

use glam::DVec3;
use rand::{Rng, RngExt};

use crate::{
    reference::scenes::SIZE,
    sampling::{
        CounterRng,
        rng::{Key, scale},
    },
};

/// A point of a picture. Contains two pairs, for x and y: the pixel's column or row, and the
/// point's offset from the pixel's centre, in pixels.
pub type SamplePoint = [(u32, f64); 2];

/// Coordinates at the middle of a picture of [`SIZE`] × [`SIZE`] pixels, for either axis: the last
/// `f64` before the middle, and the middle itself. As in a [`SamplePoint`], each is given by a
/// pixel's column or row and the offset from the pixel's centre.
pub const MIDDLE: [(u32, f64); 2] = [(SIZE / 2 - 1, 0.5_f64.next_down()), (SIZE / 2, -0.5)];

/// A generator of pseudorandom numbers. The inputs of a case are divided into blocks, each of which
/// is tested by one thread. The random numbers depend only on the case and on the block's index, so
/// the number of threads does not affect them.
#[derive(Clone, Debug)]
pub struct CaseRng(CounterRng);

impl CaseRng {
    /// Makes the random generator for the case named `case` and the block of its inputs with the
    /// index `block`.
    pub fn new(case: &str, block: u64) -> Self {
        let name = case.bytes();
        let name = name.fold(0, |name, byte| name << 8 | u64::from(byte));
        Self(Key::new(name, block).rng())
    }

    /// Returns a uniformly random integer from 0 to `n` − 1.
    pub fn below(&mut self, n: u64) -> u64 {
        scale(self.0.next_u64(), n)
    }

    /// Returns a uniformly random integer from `low` to `high`, both included.
    pub fn whole(&mut self, low: i64, high: i64) -> f64 {
        (low + self.below((high - low + 1) as u64) as i64) as f64
    }

    /// Returns a random column or row of a picture with [`SIZE`] columns and rows.
    pub fn pixel(&mut self) -> u32 {
        self.below(SIZE.into()) as u32
    }

    /// Returns a random element of `things`.
    pub fn pick<T: Copy>(&mut self, things: &[T]) -> T {
        things[self.below(things.len() as u64) as usize]
    }

    /// Returns a uniformly random number between `low` and `high`.
    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.random::<f64>()
    }

    /// Returns 10^p, where p is uniformly random between `low` and `high`.
    pub fn power(&mut self, low: f64, high: f64) -> f64 {
        libm::pow(10.0, self.within(low, high))
    }

    /// Returns −1 or 1 at random.
    pub fn sign(&mut self) -> f64 {
        self.pick(&[-1.0, 1.0])
    }

    /// Returns a uniformly random point of the box from `low` to `high`. If `low` and `high` have
    /// the same coordinate on an axis, no random number is drawn for the axis.
    pub fn between(&mut self, low: [f64; 3], high: [f64; 3]) -> DVec3 {
        DVec3::from([0, 1, 2].map(|axis| {
            let (a, b) = (low[axis], high[axis]);
            if a == b { a } else { self.within(a, b) }
        }))
    }

    /// Returns a random point with integer coordinates in the box from `low` to `high`. If `low`
    /// and `high` have the same coordinate on an axis, no random number is drawn for the axis.
    pub fn wholes(&mut self, low: [i64; 3], high: [i64; 3]) -> DVec3 {
        DVec3::from([0, 1, 2].map(|axis| {
            let (a, b) = (low[axis], high[axis]);
            if a == b { a as f64 } else { self.whole(a, b) }
        }))
    }

    /// Returns a uniformly random point of the cube whose centre is the origin and whose side is 2
    /// · `half`.
    pub fn vector(&mut self, half: f64) -> DVec3 {
        self.between([-half; 3], [half; 3])
    }

    /// Returns a uniformly random unit vector, by scaling a random point of the unit ball to length
    /// 1.
    pub fn unit(&mut self) -> DVec3 {
        loop {
            let v = self.vector(1.0);
            if (0.01..1.0).contains(&v.length_squared()) {
                return v.normalize();
            }
        }
    }

    /// Returns a random point of a picture with [`SIZE`] columns and rows.
    pub fn point(&mut self) -> SamplePoint {
        self.point_of([SIZE; 2])
    }

    /// Returns a random point of a picture of `size` columns and rows.
    pub fn point_of(&mut self, size: [u32; 2]) -> SamplePoint {
        let pixels = size.map(|pixels| self.below(pixels.into()) as u32);
        pixels.map(|pixel| (pixel, self.within(-0.5, 0.5)))
    }
}
