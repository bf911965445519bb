//! Builds the objects, image, camera and sampler of a scene from blocks whose fields have values.

use super::{
    fixes,
    lowering::{Lowering, mentions},
};
use crate::{
    diagnostic::{Applicability, Diagnostic, Fix},
    scene::{
        error::{error, warning},
        lowered_block::LoweredBlock,
        model::{Count, Image, Object, SMALLEST, Sampler},
        semantic_model::Parts,
        shape::Shape,
    },
    schema::{self, BlockKind, CHECKERBOARD, IMAGE, ImageFields, Method, SAMPLER, SamplerFields},
    source::{SourceId, Span},
    suggest,
    syntax::shorten,
};

/// Span for problems about blocks that the file lacks: the empty span at the start of the file.
const START: Span = Span {
    source: SourceId::File,
    start: 0,
    end: 0,
};

/// Maximum number of samples of a whole picture: 2^53, because numbers of the language are `f64`s,
/// which represent every whole number up to 2^53. If `per_pixel` times the number of pixels is
/// greater, an error is reported.
const MOST_SAMPLES: u64 = 1 << 53;

impl<'s> Lowering<'s> {
    /// Builds the image, the camera, the sampler and the objects of the scene. An image, camera or
    /// sampler with errors is `None`.
    pub(super) fn build(&mut self) -> Parts {
        let blocks = std::mem::take(&mut self.blocks);
        for block in &blocks {
            self.missing_fields(block);
        }
        let one = |kind| blocks.iter().find(|block| block.row.kind == kind);
        let empty = [BlockKind::Image, BlockKind::Sampler];
        let [image, sampler] = &empty.map(|kind| LoweredBlock::empty(schema::of_kind(kind), START));
        let image = self.image(one(BlockKind::Image).unwrap_or(image));
        let sampler = self.sampler(one(BlockKind::Sampler).unwrap_or(sampler), image);
        let camera = match one(BlockKind::Camera) {
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
            && let Some(block) = one(BlockKind::Camera)
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
        // `names.problems` contains only errors, no warnings, so their severity is not examined.
        all.any(Diagnostic::is_error)
            || !self.names.problems.borrow().is_empty()
            || !self.sources.file.invalid_utf8().is_empty()
    }

    fn missing_camera(&mut self) {
        if self.cut || self.bad.iter().any(|text| mentions(text, "camera")) {
            return;
        }
        let (example, add) = self.new_block(BlockKind::Camera);
        let fix = if self.has_items {
            add
        } else {
            fixes::at_end("write the smallest scene", SMALLEST, self.sources)
        };
        error("missing_camera", "the scene has no camera")
            .at(START, "no `camera` in this text")
            .help(format!("add one, such as `{example}`"))
            .fixes([fix])
            .report(&mut self.problems);
    }

    fn no_objects(&mut self) {
        let (example, add) = self.new_block(BlockKind::Sphere);
        let objects = schema::BLOCKS.iter().filter(|row| row.is_object);
        let kinds = suggest::choice(objects.map(|row| row.name));
        let help = format!("the picture shows the background only; add one, such as `{example}`");
        warning("no_objects", "the scene has no objects")
            .at(START, format!("no {kinds} in this text"))
            .help(help)
            .fixes([add])
            .report(&mut self.problems);
    }

    /// Returns the text of a block with the fields that it needs, and a fix that adds it to the
    /// file.
    fn new_block(&self, kind: BlockKind) -> (String, Fix) {
        let row = schema::of_kind(kind);
        let (example, title) = (row.example(), format!("add {}", row.noun));
        let fix = fixes::at_end(title, &format!("{example}\n"), self.sources);
        (example, fix)
    }

    /// Builds the object of a block. If `for` repeats the block, `indices` contains the values of
    /// its counters for this object. Returns `false`, and builds nothing, if a value is missing or
    /// wrong.
    pub(super) fn object(&mut self, block: &LoweredBlock<'s>, indices: &[u32]) -> bool {
        let Some(shape) = Shape::lower(block, &mut self.problems) else {
            return false;
        };
        if let Shape::Checkerboard(board) = shape {
            self.boards.push((board, block.place(CHECKERBOARD.square)));
        }
        let name = block.name.map(|name| match indices {
            [] => name.text.to_owned(),
            _ => {
                let indices: Vec<String> = indices.iter().map(u32::to_string).collect();
                format!("{}[{}]", name.text, indices.join(", "))
            }
        });
        self.objects.push(Object {
            name,
            indices: indices.into(),
            shape,
            span: block.span,
        });
        true
    }

    /// Builds the image. Returns `None` if a value is missing or wrong.
    fn image(&mut self, block: &LoweredBlock<'s>) -> Option<Image> {
        let ImageFields {
            width,
            height,
            background,
        } = IMAGE;
        Some(Image {
            width: block.value(width)? as u32,
            height: block.value(height)? as u32,
            background: block.value(background)?,
        })
    }

    /// Builds the sampler. Returns `None` if a value is missing or wrong. If `image` is given,
    /// reports a number of samples that is too small or too large for its number of pixels.
    pub(super) fn sampler(
        &mut self,
        block: &LoweredBlock<'s>,
        image: Option<Image>,
    ) -> Option<Sampler> {
        let SamplerFields {
            method,
            per_pixel,
            total,
            seed,
        } = SAMPLER;
        let count = match block.given(total) {
            Some(_) => Count::Total(block.value(total)? as u64),
            None => Count::PerPixel(block.value(per_pixel)? as u64),
        };
        let (total, per_pixel) = (block.given(total), block.given(per_pixel));
        let method = block.value(method);
        let pixels = image.map(|image| u64::from(image.width) * u64::from(image.height));
        match (count, pixels, total.xor(per_pixel)) {
            (Count::Total(total), Some(pixels), Some(given))
                if total < pixels && method != Some(Method::Exact) =>
            {
                let message = format!("{total} samples leave some of the {pixels} pixels empty");
                let help = format!(
                    "a pixel without a sample shows the background; give a `total` of at least {pixels}"
                );
                warning("few_samples", message)
                    .at(given.span, "fewer than there are pixels")
                    .help(help)
                    .writing(given.span, Applicability::Placeholder, [pixels.to_string()])
                    .report(&mut self.problems);
            }
            (Count::PerPixel(count), Some(pixels), Some(given))
                if count > MOST_SAMPLES / pixels =>
            {
                let written = shorten(self.sources.text(given.span));
                let most = MOST_SAMPLES / pixels;
                let message = format!("{written} samples in each of {pixels} pixels are too many");
                let help =
                    format!("at most {most} samples per pixel keep the whole count within 2^53");
                error("too_many_samples", message)
                    .at(given.span, "too many")
                    .help(help)
                    .writing(given.span, Applicability::Placeholder, [most.to_string()])
                    .report(&mut self.problems);
            }
            _ => {}
        }
        Some(Sampler {
            method: method?,
            count,
            seed: block.value(seed)? as u64,
        })
    }
}
