//! Random numbers for tests. They are equal in every run.

use glam::{DVec2, DVec3, dvec2, dvec3};
use pinhole::sampling::CounterRng;
use rand::{Rng, RngExt, SeedableRng};

/// Generator of random numbers that are equal in every run.
pub struct Random(CounterRng);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(CounterRng::seed_from_u64(seed))
    }

    pub fn bits(&mut self) -> u64 {
        self.0.next_u64()
    }

    /// Returns an integer from 0 to `end` − 1, or 0 if `end` is 0.
    pub fn below(&mut self, end: usize) -> usize {
        (self.bits() % end.max(1) as u64) as usize
    }

    pub fn one_of<'t, T>(&mut self, among: &'t [T]) -> &'t T {
        &among[self.below(among.len())]
    }

    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.random::<f64>()
    }

    pub fn offset(&mut self) -> DVec2 {
        dvec2(self.within(-0.5, 0.5), self.within(-0.5, 0.5))
    }

    pub fn vector(&mut self, size: f64) -> DVec3 {
        let mut one = || self.within(-size, size);
        dvec3(one(), one(), one())
    }
}
