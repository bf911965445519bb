//! Blocks → scene: what each part is, once all fields have their values.

use super::{Block, Lowering, fields::Fields, mentions};
use crate::{
    diagnostic::{Diagnostic, Fix},
    scene::{
        self, Image, Object, Shape,
        error::{error, warning},
        fix,
        schema::{self, Kind},
        semantic_model::Parts,
    },
    source::{SourceId, Span},
};

impl<'s> Lowering<'s> {
    /// The parts of the scene; what failed is missing.
    pub(super) fn build(&mut self) -> Parts {
        let blocks = std::mem::take(&mut self.blocks);
        for block in &blocks {
            if !self.is_wanted() {
                break;
            }
            self.missing_fields(block);
        }
        let one = |kind| blocks.iter().find(|block| block.row.kind == kind);
        let image = self.image(one(Kind::Image));
        let sampler = self.sampler(one(Kind::Sampler), image);
        let start = Span::new(SourceId::File, 0, 0);
        let unknown = |name| self.cut || self.bad.iter().any(|text| mentions(text, name));
        let camera = match one(Kind::Camera) {
            Some(block) => self.camera(block),
            None => {
                if !unknown("camera") {
                    let help = "add one, such as `camera { eye (0, 2, 8)  lookat (0, 1, 0) }`";
                    self.problems.push(
                        error("missing_camera", "the scene has no camera")
                            .at(start, "no `camera` in this text")
                            .help(help)
                            .fixes(match self.has_items {
                                true => self.new_block("camera"),
                                false => Some(fix::smallest_scene(self.sources)),
                            }),
                    );
                }
                None
            }
        };
        let mut objects = std::mem::take(&mut self.objects);
        for block in blocks.iter().filter(|block| block.row.is_object) {
            if !self.is_wanted() {
                break;
            }
            objects.extend(self.object(block));
        }
        if !self.has_objects && self.bad.is_empty() && !self.cut {
            let help = "the picture shows the background only; add one, such as `sphere { center (0, 1, 0) }`";
            self.problems.push(
                warning("no_objects", "the scene has no objects")
                    .at(
                        start,
                        "no sphere, triangle, box or checkerboard in this text",
                    )
                    .help(help)
                    .fixes(self.new_block("sphere")),
            );
        }
        if let (Some(image), Some(camera)) = (&image, &camera)
            && let Some(block) = one(Kind::Camera)
            && !self.has_errors()
            && !objects.is_empty()
        {
            self.unseen(block, camera, image, &objects);
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
        all.any(Diagnostic::is_error) || !self.sources.file.invalid_utf8().is_empty()
    }

    /// Adds a block with the fields that it needs.
    fn new_block(&self, name: &str) -> Option<Fix> {
        let row = schema::block(name)?;
        Some(fix::add_block(row, &row.least_fields(), self.sources))
    }

    /// Builds an object at once.
    pub(super) fn build_object(&mut self, block: &Block<'s>) {
        self.missing_fields(block);
        let object = self.object(block);
        self.objects.extend(object);
    }

    fn image(&mut self, block: Option<&Block<'s>>) -> Option<Image> {
        let row = Fields::of(block, Kind::Image);
        Some(Image {
            width: row.number("width")? as u32,
            height: row.number("height")? as u32,
            background: row.color("background")?,
        })
    }

    fn object(&mut self, block: &Block<'s>) -> Option<Object> {
        let fields = Fields::of(Some(block), block.row.kind);
        let shape = match block.row.kind {
            Kind::Sphere => Shape::Sphere(scene::Sphere {
                center: fields.vector("center")?,
                radius: fields.number("radius")?,
                color: fields.color("color")?,
            }),
            Kind::Triangle => self.triangle(block, &fields)?,
            Kind::Box => self.cuboid(block, &fields)?,
            Kind::Checkerboard => Shape::Checkerboard(scene::Checkerboard {
                y: fields.number("y")?,
                square: fields.number("square")?,
                colors: fields.colors("colors")?,
            }),
            Kind::Image | Kind::Camera | Kind::Sampler => return None,
        };
        Some(Object {
            name: block.name.map(|name| name.text.to_owned()),
            shape,
            span: block.span,
        })
    }
}
