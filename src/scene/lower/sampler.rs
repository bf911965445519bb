//! The sampler: the method, and how many samples.

use super::{Block, Lowering, fields::Fields};
use crate::{
    numbers,
    scene::{
        Count, Image, Method, Sampler,
        error::{error, warning},
        schema::Kind,
    },
    source::{SourceId, Span},
};

impl<'s> Lowering<'s> {
    pub(super) fn sampler(
        &mut self,
        block: Option<&Block<'s>>,
        image: Option<Image>,
    ) -> Option<Sampler> {
        let fields = Fields::of(block, Kind::Sampler);
        let pixels = image.map(|image| u64::from(image.width) * u64::from(image.height));
        let total = block.and_then(|block| block.given("total"));
        let count = match total {
            Some(given) => {
                let total = fields.number("total").map(|total| total as u64);
                // Beside a conflict it is not certain that the total is meant.
                let conflict = block.is_some_and(|block| block.given("per_pixel").is_some());
                let is_exact = fields.method("method") == Some(Method::Exact);
                if let (Some(total), Some(pixels)) = (total, pixels)
                    && total < pixels
                    && !conflict
                    && !is_exact
                {
                    let message =
                        format!("{total} samples leave some of the {pixels} pixels empty");
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
                total.map(Count::Total)
            }
            None => {
                let per_pixel = fields.number("per_pixel");
                let most = pixels.map(|pixels| (1 << 53) / pixels);
                if let (Some(per_pixel), Some(most), Some(pixels)) = (per_pixel, most, pixels)
                    && per_pixel > most as f64
                {
                    // The default is never too many.
                    let given = block.and_then(|block| block.given("per_pixel"));
                    let start = Span::new(SourceId::File, 0, 0);
                    let span = given.map_or(start, |given| given.span);
                    let count = match per_pixel < 1e15 {
                        true => per_pixel.to_string(),
                        false => numbers::short(per_pixel),
                    };
                    let message =
                        format!("{count} samples in each of {pixels} pixels are too many");
                    let help = format!(
                        "at most {most} samples per pixel keep the whole count within 2^53"
                    );
                    self.problems.push(
                        error("too_many_samples", message)
                            .at(span, format!("{count} in each pixel"))
                            .help(help)
                            .writing(span, given.map(|_| most.to_string())),
                    );
                }
                per_pixel.map(|count| Count::PerPixel(count as u64))
            }
        };
        Some(Sampler {
            method: fields.method("method")?,
            count: count?,
            seed: fields.number("seed")? as u64,
        })
    }
}
