//! Whether a mistake explains a difference, and whether samples alone may.
//!
//! A mistake explains it if what it makes leaves little of it, or nothing but roundings or noise. What the samples of a right picture may do as
//! well needs no mistake.

use super::{
    Case, HOPE, LEFT, Make, alike, evidence,
    noise::{self, Noise},
    order,
};
use crate::{
    film::{Film, Tolerance, compare},
    render::RenderError,
    scene::{Scene, Shape},
};

impl Case<'_> {
    /// Whether what a mistake makes leaves little of the difference, or nothing but roundings or noise.
    pub fn explains(&self, make: &Make, made: &Film, left: f64) -> Result<bool, RenderError> {
        if left < LEFT * self.difference {
            return Ok(!self.is_excused(left) && !self.is_belied_by(make, made)?);
        }
        // The mistake may be small, and the rest rounding.
        if self.is_rounding(made, evidence::APART) {
            return Ok(true);
        }
        // The picture may have the mistake and noise.
        if let Some(is_curved) = self.is_of_light(make, made)? {
            return Ok(is_curved);
        }
        Ok(match self.noise_in(make, made)? {
            // What is little beside noise may hide another mistake.
            Some((variance, noise)) => {
                let is_named = left <= HOPE * self.difference
                    || !self.is_biased(&self.full.a, made, &variance, noise)?;
                // What noise leaves of a mistake it shows where one colour should be seen; and what samples foretell needs no mistake.
                let is_belied = is_named
                    && (self.may_be_places(left)
                        || self.is_excused(left)
                        || alike::is_belied(self, made, &variance, noise.samples));
                if is_belied {
                    self.is_belied.set(true);
                }
                is_named && !is_belied && !self.is_alike()
            }
            None => false,
        })
    }

    /// Whether samples at the same places in all pixels may do as much as a mistake that leaves so much: they may have made the picture, and not
    /// enough is explained. Those that foretell nothing have not.
    fn may_be_places(&self, left: f64) -> bool {
        let is_refuted = self.alike.get().is_some_and(|alike| alike.is_refuted());
        left > alike::LEFT * self.difference && !is_refuted && !self.is_likelier_a_mistake()
    }

    /// Whether samples at the same places leave less than a mistake does.
    fn is_excused(&self, left: f64) -> bool {
        let share = left / self.difference;
        let alike = self.alike.get();
        alike.is_some_and(|alike| alike.leave_less(share * share))
    }

    /// Whether samples at the same places in all pixels foretell the errors.
    pub fn is_alike(&self) -> bool {
        self.alike.get().is_some_and(|alike| alike.is_told)
    }

    /// Whether a mistake that leaves little would show itself in more pixels where one colour should be seen: as when samples at the same places
    /// have their middle beside the pixel's.
    fn is_belied_by(&self, make: &Make, made: &Film) -> Result<bool, RenderError> {
        if self.is_likelier_a_mistake() {
            return Ok(false);
        }
        let Some(variance) = self.variance_of(make, made)? else {
            return Ok(false);
        };
        let samples = noise::samples(&self.full.a, made, &variance);
        let is_belied = alike::is_belied(self, made, &variance, samples);
        if is_belied {
            self.is_belied.set(true);
        }
        Ok(is_belied)
    }

    /// Whether nothing need be wrong with the picture: it is right but for roundings, or may have noise.
    pub fn may_be_right(&self) -> bool {
        let (a, exact) = (&self.full.a, &self.full.exact);
        self.is_rounding(exact, evidence::APART)
            || noise::possible(a, exact, &self.variance).is_some()
    }

    /// Whether samples that hang together may be all that is wrong: there are pixels of one colour, no more of them are wrong than samples make so,
    /// and all is no farther off than a sample in each pixel leaves it; or a mistake was passed over that they belie.
    pub fn may_be_alike(&self) -> bool {
        let variances = || self.variance.pixels().iter();
        let flat = variances().filter(|one| noise::is_flat(one)).count() as u64;
        let one_sample = variances().flatten().map(|one| one.max(0.0)).sum::<f64>();
        let channels = 3.0 * self.variance.pixels().len() as f64;
        let is_little = self.difference * self.difference * channels <= one_sample;
        let may_be_samples = flat >= evidence::FEWEST && is_little && !self.is_likelier_a_mistake();
        may_be_samples || self.is_belied.get() && self.may_be_right()
    }

    /// Whether the picture is another one but for so many steps of 8-bit sRGB.
    pub fn is_rounding(&self, made: &Film, steps: f64) -> bool {
        let tolerance = Tolerance {
            steps,
            bounds: None,
        };
        compare(&self.full.a, made, tolerance).is_ok_and(|found| found.is_equal())
    }

    /// The noise in which alone the picture differs from what a mistake makes, and the variance of one sample.
    pub fn noise_in(&self, make: &Make, made: &Film) -> Result<Option<(Film, Noise)>, RenderError> {
        let a = &self.full.a;
        if let Make::Scene(scene) | Make::Object(scene, _) = make
            && noise::has_strays(a, made, scene, |light| light)
        {
            return Ok(None);
        }
        let Some(variance) = self.variance_of(make, made)? else {
            return Ok(None);
        };
        let Some(variance) = noise::beside_edges(a, made, &variance)? else {
            return Ok(None);
        };
        let noise = noise::judge(a, made, &variance);
        Ok(noise.map(|noise| (variance, noise)))
    }

    /// The variance of one sample in each pixel of what a mistake makes; none of a curve or of single samples.
    fn variance_of(&self, make: &Make, made: &Film) -> Result<Option<Film>, RenderError> {
        let control = &self.control;
        Ok(Some(match make {
            Make::Film(make) => make(&self.variance)?,
            Make::Is(_, variance) => variance.clone(),
            Make::Scene(scene) => noise::variance(scene, made, control)?,
            Make::Object(scene, shapes) => self.variance_with(scene, shapes, made)?,
            Make::Ordered(order) => {
                let squares = noise::squared(&self.full.scene);
                let squares = order::picture(&squares, *order, control)?;
                noise::of_squares(&squares, made)?
            }
            Make::Floor(scene, holds) => {
                let other = noise::variance(scene, &super::exact(scene, control)?, control)?;
                self.full.where_floor(*holds, &other, &self.variance)?
            }
            _ => return Ok(None),
        }))
    }

    /// The variance of one sample in each pixel, with one shape changed.
    fn variance_with(
        &self,
        scene: &Scene,
        shapes: &[Option<Shape>; 2],
        made: &Film,
    ) -> Result<Film, RenderError> {
        let mut variance = self.variance.clone();
        let squared = noise::squared(scene);
        if let Some((part, squares)) = self.full.object(&squared, shapes, &self.control)? {
            let means = Film::from_fn(part.width, part.height, |x, y| {
                made.pixel(part.x + x, part.y + y)
            })?;
            variance.put(part, noise::of_squares(&squares, &means)?.pixels());
        }
        Ok(variance)
    }
}
