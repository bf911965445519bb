//! Whether a picture is another one whose light went through a curve: but for roundings before it and after it, and noise.

use super::{Case, Curve, Make, evidence, level, noise};
use crate::{
    color::{linear_to_srgb, srgb_to_linear},
    film::{Film, TooLarge},
    render::RenderError,
};

impl Case<'_> {
    /// Whether the picture is one whose light went through a curve, but for roundings and noise, if a mistake is of that kind.
    pub fn is_of_light(&self, make: &Make, made: &Film) -> Result<Option<bool>, RenderError> {
        let (full, control) = (&self.full, &self.control);
        Ok(Some(match make {
            Make::Light(curve) => self.is_light(*curve, made)?,
            Make::Turned(turn, curve) => {
                let (means, variance) = (turn(&full.exact)?, turn(&self.variance)?);
                self.is_curved(*curve, made, &means, &variance)?
            }
            Make::Curved(scene, curve) => {
                if noise::has_strays(&full.a, made, scene, curve.to) {
                    return Ok(Some(false));
                }
                let means = level::map(made, curve.back)?;
                let variance = noise::variance(scene, &means, control)?;
                self.is_noise_before(*curve, made, &means, &variance)?
            }
            _ => return Ok(None),
        }))
    }

    /// Whether a curve made the picture from the right one, which may have been rounded or have noise.
    pub fn is_light(&self, curve: Curve, made: &Film) -> Result<bool, TooLarge> {
        self.is_curved(curve, made, &self.full.exact, &self.variance)
    }

    /// Whether a curve made the picture from means, which may have been rounded or have noise.
    fn is_curved(
        &self,
        curve: Curve,
        made: &Film,
        means: &Film,
        variance: &Film,
    ) -> Result<bool, TooLarge> {
        Ok(self.is_rounding_before(curve, means)
            || self.is_noise_before(curve, made, means, variance)?)
    }

    /// Whether a curve made the picture from another one's bytes: then it is off by a rounding after the curve and by one before it.
    pub fn is_rounding_before(&self, curve: Curve, means: &Film) -> bool {
        let byte = |light: f64| 255.0 * linear_to_srgb(light);
        let made = |at: f64| byte((curve.to)(srgb_to_linear(at.clamp(0.0, 255.0) / 255.0)));
        let mut pairs = self.full.a.pixels().iter().zip(means.pixels());
        pairs.all(|(p, q)| {
            (0..3).all(|i| {
                let (is, should) = (byte(p[i]), byte(q[i]));
                // With room for light that was rounded, too.
                let half = 0.5 * evidence::APART + 0.01;
                made(should - half) - half <= is && is <= made(should + half) + half
            })
        })
    }

    /// Whether a curve made the picture from means with noise, which is looked at before the curve.
    fn is_noise_before(
        &self,
        curve: Curve,
        made: &Film,
        means: &Film,
        variance: &Film,
    ) -> Result<bool, TooLarge> {
        let a = &self.full.a;
        let before = level::map(a, curve.back)?;
        Ok(noise::judge_through([a, made], [&before, means], variance).is_some())
    }
}
