//! The sampler: the method, and how many samples.

use super::{Block, Lowering, fields::Fields};
use crate::{
    scene::{
        Count, Image, Method, Sampler,
        error::{error, warning},
        schema::Kind,
    },
    syntax::shorten,
};

impl<'s> Lowering<'s> {
    pub(super) fn sampler(
        &mut self,
        block: Option<&Block<'s>>,
        image: Option<Image>,
    ) -> Option<Sampler> {
        let fields = Fields::of(block, Kind::Sampler);
        let given = |name| block.and_then(|block| block.given(name));
        let (total, per_pixel) = (given("total"), given("per_pixel"));
        let count = match total {
            Some(_) => Count::Total(fields.number("total")? as u64),
            None => Count::PerPixel(fields.number("per_pixel")? as u64),
        };
        let method = fields.method("method");
        let pixels = image.map(|image| u64::from(image.width) * u64::from(image.height));
        match (count, pixels, total.xor(per_pixel)) {
            (Count::Total(total), Some(pixels), Some(given))
                if total < pixels && method != Some(Method::Exact) =>
            {
                let message = format!("{total} samples leave some of the {pixels} pixels empty");
                let help = format!(
                    "a pixel without a sample shows the background; give a `total` of at least {pixels}"
                );
                self.problems.push(
                    warning("few_samples", message)
                        .at(given.span, "fewer than there are pixels")
                        .help(help)
                        .writing(given.span, [pixels.to_string()]),
                );
            }
            (Count::PerPixel(count), Some(pixels), Some(given)) if count > (1 << 53) / pixels => {
                let written = shorten(self.sources.text(given.span));
                let most = (1_u64 << 53) / pixels;
                let message = format!("{written} samples in each of {pixels} pixels are too many");
                let help =
                    format!("at most {most} samples per pixel keep the whole count within 2^53");
                self.problems.push(
                    error("too_many_samples", message)
                        .at(given.span, "too many")
                        .help(help)
                        .writing(given.span, [most.to_string()]),
                );
            }
            _ => {}
        }
        Some(Sampler {
            method: method?,
            count,
            seed: fields.number("seed")? as u64,
        })
    }
}
