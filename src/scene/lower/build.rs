//! Blocks → scene: what each part is, once all fields have their values.

use super::{
    block::Block,
    fixes,
    lowering::{Lowering, mentions},
};
use crate::{
    diagnostic::{Applicability, Diagnostic, Fix},
    scene::{
        error::{error, warning},
        model::{Count, Image, SMALLEST, Sampler},
        semantic_model::Parts,
    },
    schema::{self, Kind, Method},
    source::{SourceId, Span},
    syntax::shorten,
};

/// The place of what is not there.
const START: Span = Span {
    source: SourceId::File,
    start: 0,
    end: 0,
};

/// The most samples of a picture, also where they are given by `per_pixel`.
const MOST_SAMPLES: u64 = 1 << 53;

impl<'s> Lowering<'s> {
    /// The parts of the scene; what failed is missing.
    pub(super) fn build(&mut self) -> Parts {
        let blocks = std::mem::take(&mut self.blocks);
        for block in &blocks {
            self.missing_fields(block);
        }
        let one = |kind| blocks.iter().find(|block| block.row.kind == kind);
        let empty = [Kind::Image, Kind::Sampler];
        let [image, sampler] = &empty.map(|kind| Block::empty(schema::of_kind(kind), START));
        let image = self.image(one(Kind::Image).unwrap_or(image));
        let sampler = self.sampler(one(Kind::Sampler).unwrap_or(sampler), image);
        let camera = match one(Kind::Camera) {
            Some(block) => self.camera(block),
            None => {
                self.missing_camera();
                None
            }
        };
        let objects = std::mem::take(&mut self.objects);
        if !self.has_objects && self.bad.is_empty() && !self.cut {
            self.no_objects();
        }
        if let (Some(image), Some(camera)) = (&image, &camera)
            && let Some(block) = one(Kind::Camera)
            && !self.has_errors()
            && !objects.is_empty()
        {
            self.unseen(block, camera, image, &objects);
            if sampler.is_some_and(|sampler| sampler.method != Method::Exact) {
                self.lost_squares(camera, image);
            }
        }
        Parts {
            image,
            camera,
            sampler,
            objects,
        }
    }

    fn has_errors(&self) -> bool {
        let mut all = self.problems.iter().chain(&self.found);
        // What is reported of names is always an error.
        all.any(Diagnostic::is_error)
            || !self.names.problems.borrow().is_empty()
            || !self.sources.file.invalid_utf8().is_empty()
    }

    fn missing_camera(&mut self) {
        if self.cut || self.bad.iter().any(|text| mentions(text, "camera")) {
            return;
        }
        let (example, add) = self.new_block(Kind::Camera);
        let fix = match self.has_items {
            true => add,
            false => fixes::at_end("write the smallest scene", SMALLEST, self.sources),
        };
        self.problems.push(
            error("missing_camera", "the scene has no camera")
                .at(START, "no `camera` in this text")
                .help(format!("add one, such as `{example}`"))
                .fixes([fix]),
        );
    }

    fn no_objects(&mut self) {
        let (example, add) = self.new_block(Kind::Sphere);
        let none = "no sphere, triangle, box or checkerboard in this text";
        let help = format!("the picture shows the background only; add one, such as `{example}`");
        self.problems.push(
            warning("no_objects", "the scene has no objects")
                .at(START, none)
                .help(help)
                .fixes([add]),
        );
    }

    /// A block with the fields that it needs, and a fix that adds it.
    fn new_block(&self, kind: Kind) -> (String, Fix) {
        let row = schema::of_kind(kind);
        let (example, title) = (row.example(), format!("add {}", row.noun));
        let fix = fixes::at_end(title, &format!("{example}\n"), self.sources);
        (example, fix)
    }

    fn image(&mut self, block: &Block<'s>) -> Option<Image> {
        Some(Image {
            width: block.number("width")? as u32,
            height: block.number("height")? as u32,
            background: block.color("background")?,
        })
    }

    pub(super) fn sampler(&mut self, block: &Block<'s>, image: Option<Image>) -> Option<Sampler> {
        let (total, per_pixel) = (block.given("total"), block.given("per_pixel"));
        let count = match total {
            Some(_) => Count::Total(block.number("total")? as u64),
            None => Count::PerPixel(block.number("per_pixel")? as u64),
        };
        let method = block.method("method");
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
                        .writing(given.span, Applicability::Placeholder, [pixels.to_string()]),
                );
            }
            (Count::PerPixel(count), Some(pixels), Some(given))
                if count > MOST_SAMPLES / pixels =>
            {
                let written = shorten(self.sources.text(given.span));
                let most = MOST_SAMPLES / pixels;
                let message = format!("{written} samples in each of {pixels} pixels are too many");
                let help =
                    format!("at most {most} samples per pixel keep the whole count within 2^53");
                self.problems.push(
                    error("too_many_samples", message)
                        .at(given.span, "too many")
                        .help(help)
                        .writing(given.span, Applicability::Placeholder, [most.to_string()]),
                );
            }
            _ => {}
        }
        Some(Sampler {
            method: method?,
            count,
            seed: block.number("seed")? as u64,
        })
    }
}
