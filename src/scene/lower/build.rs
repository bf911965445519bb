//! Blocks → scene: what each part is, once all fields have their values, and the conditions between several fields.

use glam::DVec3;
use miette::{Diagnostic as _, Severity};

use super::{
    Block, Given, Lowering,
    fixing::{examples, quoted},
    words::{axis_name, axis_vector, mentions},
};
use crate::{
    color::Color,
    diagnostic::{Diagnostic, Edit, Fix},
    math::{Angle, predicates},
    numbers,
    scene::{
        self, Camera, CenteredTriangle, Count, Image, Lens, Method, Object, Outline, Sampler,
        Shape, View, css,
        error::Problem,
        level_direction,
        schema::{self, Kind, Literal, Preset},
        survey::Parts,
        unseen::{self, LEAST_SINE, Unseen, why_unseen},
        value::Value,
    },
    source::{SourceId, Span},
    suggest,
};

const VERTICES: [&str; 3] = ["v0", "v1", "v2"];

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
                    self.problems.push(Problem::MissingCamera {
                        span: start,
                        is_empty: !self.has_items,
                    });
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
            self.problems.push(Problem::NoObjects { span: start });
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
        let is_error = |problem: &Problem| problem.severity() != Some(Severity::Warning);
        self.problems.iter().any(is_error)
            || !self.slips.is_empty()
            || self.found.iter().any(Diagnostic::is_error)
            || !self.sources.file.invalid_utf8().is_empty()
    }

    /// Warns where the camera sees nothing of the scene.
    fn unseen(&mut self, block: &Block<'s>, camera: &Camera, image: &Image, objects: &[Object]) {
        let Some(why) = why_unseen(camera, image, objects) else {
            return;
        };
        let span = |name| block.given(name).map(|given| given.span);
        let view = span("lookat")
            .or(span("direction"))
            .unwrap_or(block.keyword);
        let cut = |names: &[&str]| {
            let given: Vec<Given> = names.iter().filter_map(|name| block.given(name)).collect();
            let fix = Fix::remove_whole(
                format!("leave {} out", quoted(names)),
                given.iter().map(|given| given.field()),
                self.sources,
            );
            (given.first().map_or(view, |given| given.span), fix)
        };
        let (message, label, help, (span, fix)) = match why {
            Unseen::Behind | Unseen::Outside => {
                let middle = objects
                    .iter()
                    .find_map(|object| unseen::middle(&object.shape));
                let towards = middle.and_then(|middle| towards(camera, middle));
                let fix = towards.as_ref().map(|towards| Fix::write(view, towards));
                let help = match (camera.view, &towards) {
                    (View::Lookat(_), Some(point)) => {
                        format!("look at an object, such as `lookat {point}`")
                    }
                    (View::Direction(_), Some(way)) => {
                        format!("look at an object, such as by `direction {way}`")
                    }
                    (_, None) => "turn the camera, or move it".to_owned(),
                };
                let (message, label) = match why {
                    Unseen::Behind => ("everything is behind the camera", "away from everything"),
                    _ => ("the camera sees nothing of the scene", "past everything"),
                };
                (message, label, help, (view, fix))
            }
            Unseen::Near | Unseen::Far | Unseen::NearAndFar => {
                let (message, label, names): (_, _, &[&str]) = match why {
                    Unseen::Near => (
                        "everything is nearer than `near`",
                        "beyond everything",
                        &["near"],
                    ),
                    Unseen::Far => (
                        "everything is farther than `far`",
                        "before everything",
                        &["far"],
                    ),
                    _ => (
                        "nothing of the scene is between `near` and `far`",
                        "beyond all that is not too far",
                        &["near", "far"],
                    ),
                };
                let (span, fix) = cut(names);
                let help = format!(
                    "depths count along the view direction: change {0}, or leave {0} out",
                    quoted(names)
                );
                (message, label, help, (span, Some(fix)))
            }
        };
        self.problems.push(Problem::NothingSeen {
            message,
            help,
            span,
            label,
            fixes: fix.into_iter().collect(),
        });
    }

    /// Builds an object at once.
    pub(super) fn build_object(&mut self, block: &Block<'s>) {
        self.missing_fields(block);
        let object = self.object(block);
        self.objects.extend(object);
    }

    fn missing_fields(&mut self, block: &Block<'s>) {
        if block.unfinished {
            return;
        }
        let has = |name: &&str| block.given(name).is_some() || block.meant.contains(name);
        let rows = block.row.fields.iter();
        let required = rows.filter(|row| row.preset == Preset::Required && !has(&row.name));
        let mut needed: Vec<&'static str> = required.map(|row| row.name).collect();
        let mut missing: Vec<String> = needed.iter().map(|name| format!("`{name}`")).collect();
        // The other ways to give what is missing.
        let mut others: Vec<Vec<&'static str>> = Vec::new();
        let mut half = None;
        for choice in block.row.choices {
            let needs = |way: &&[&'static str]| -> Vec<&'static str> {
                let alternative = |name: &&str| {
                    let row = block.row.field(name);
                    row.is_some_and(|row| row.preset == Preset::Alternative) && !has(name)
                };
                way.iter()
                    .copied()
                    .filter(|name| alternative(name))
                    .collect()
            };
            let taken: Vec<_> = choice
                .ways
                .iter()
                .filter(|way| way.iter().any(has))
                .collect();
            match taken.as_slice() {
                // Without any, one is needed unless the defaults of one are enough.
                [] => {
                    let ways: Vec<_> = choice.ways.iter().map(needs).collect();
                    if ways.iter().any(Vec::is_empty) {
                        continue;
                    }
                    missing.push(either(&ways));
                    let mut ways = ways.into_iter();
                    let kept = needed.clone();
                    needed.extend(ways.next().unwrap_or_default());
                    others = ways.map(|way| [kept.clone(), way].concat()).collect();
                }
                [way] => {
                    let names = needs(way);
                    let given = way.iter().find_map(|name| block.given(name));
                    if let ([_, ..], Some(given)) = (names.as_slice(), given) {
                        half = Some(given.name);
                        let beside = self.sources.text(given.name);
                        missing.push(format!("{} beside its `{beside}`", quoted(&names)));
                    } else {
                        missing.extend(names.iter().map(|name| format!("`{name}`")));
                    }
                    needed.extend(names);
                }
                // They exclude each other, which is reported.
                _ => {}
            }
        }
        if missing.is_empty() {
            return;
        }
        let all = suggest::list(missing.iter().map(String::as_str));
        let ways: Vec<Vec<&str>> = [needed.clone()].into_iter().chain(others).collect();
        let fixes = ways.iter().filter_map(|names| {
            let title = format!("add {}", quoted(names));
            self.add_fields(block, title, &examples(block, names))
        });
        let fixes = fixes.collect();
        self.problems.push(Problem::MissingField {
            message: format!("{} needs {all}", block.row.noun),
            help: format!("write `{}`", examples(block, &needed).join("  ")),
            fixes,
            span: block.keyword,
            label: match missing.len() {
                1 if needed.len() == 1 => "it is not given".to_owned(),
                _ => "they are not given".to_owned(),
            },
            half,
        });
    }

    fn image(&mut self, block: Option<&Block<'s>>) -> Option<Image> {
        let row = Fields::of(block, Kind::Image);
        Some(Image {
            width: row.number("width")? as u32,
            height: row.number("height")? as u32,
            background: row.color("background")?,
        })
    }

    fn sampler(&mut self, block: Option<&Block<'s>>, image: Option<Image>) -> Option<Sampler> {
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
                    self.problems.push(Problem::FewSamples {
                        total,
                        pixels,
                        span: given.span,
                    });
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
                    self.problems.push(Problem::TooManySamples {
                        per_pixel: match per_pixel < 1e15 {
                            true => per_pixel.to_string(),
                            false => numbers::short(per_pixel),
                        },
                        pixels,
                        most,
                        span: given.map_or(start, |given| given.span),
                    });
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

    fn camera(&mut self, block: &Block<'s>) -> Option<Camera> {
        let fields = Fields::of(Some(block), Kind::Camera);
        let eye = fields.vector("eye");
        let up = fields.vector("up");
        let direction = block.given("direction");
        let mut view_is_defined = true;
        let view = match direction {
            Some(_) => fields.vector("direction").map(View::Direction),
            None => fields.vector("lookat").map(View::Lookat),
        };
        let seen = block.given("lookat").or(direction);
        if let (Some(eye), Some(view), Some(seen)) = (eye, view, seen) {
            match view {
                View::Lookat(point) if point == eye => {
                    self.problems.push(Problem::ViewUndefined {
                        lookat: seen.span,
                        eye: block.given("eye").map_or(block.keyword, |given| given.span),
                        fixes: direction_for(block, seen.field()),
                    });
                    // A camera that looks nowhere is none, for those too who show what there is of a broken scene.
                    view_is_defined = false;
                }
                _ => self.up_parallel(block, eye, view, up, seen),
            }
        }
        let near = fields.number("near");
        let far = block
            .given("far")
            .map(|given| (given, fields.number("far")));
        if let (Some(near), Some((given, Some(far)))) = (near, far)
            && near >= far
        {
            self.empty_depth(block, near, far, given);
        }
        let lens = if block.given("fov").is_some() {
            fields.angle("fov").map(Lens::Fov)
        } else if block.given("hfov").is_some() {
            fields.angle("hfov").map(Lens::HorizontalFov)
        } else {
            fields.number("d").map(Lens::Distance)
        };
        Some(Camera {
            eye: eye?,
            view: view.filter(|_| view_is_defined)?,
            up: up?,
            roll: fields.angle("roll")?,
            lens: lens?,
            view_height: fields.number("view_height")?,
            near: near?,
            far: match far {
                Some((_, far)) => Some(far?),
                None => None,
            },
        })
    }

    fn up_parallel(
        &mut self,
        block: &Block<'s>,
        eye: DVec3,
        view: View,
        up: Option<DVec3>,
        seen: Given,
    ) {
        let Some(up) = up else { return };
        let (from, to) = view.ends(eye);
        let is_parallel = predicates::cross_is_zero(up, from, to);
        let sine = up.normalize().cross((to - from).normalize()).length();
        // What is not a number is not less.
        if !(is_parallel || sine < LEAST_SINE) {
            return;
        }
        // Against up, the top of the picture is the part of the level direction across up; along up, the opposite.
        // The scale of up does not matter, and its square could be too large.
        let up = up / up.abs().max_element();
        let level = level_direction(up);
        let across = level * up.dot(up) - up * level.dot(up);
        let along = predicates::dot_sign(up, from, to).is_gt();
        let top = if along { -across } else { across };
        let vector = numbers::short_vector(top / top.abs().max_element());
        let shown = axis_name(top).unwrap_or_else(|| format!("towards {vector}"));
        let suggested = axis_vector(top).unwrap_or(vector);
        let given = block.given("up");
        let looks = match view {
            _ if !is_parallel => {
                "less than a millionth of a radian off the view direction".to_owned()
            }
            View::Lookat(_) if given.is_some() => "parallel to the view direction".to_owned(),
            View::Lookat(_) => format!(
                "straight along up, which is {} if not given",
                numbers::short_vector(up)
            ),
            View::Direction(_) if given.is_some() => "parallel to the view direction".to_owned(),
            View::Direction(_) => format!(
                "parallel to up, which is {} if not given",
                numbers::short_vector(up)
            ),
        };
        let up = match given {
            Some(given) => Some(Fix::write(given.span, &suggested)),
            None => self.add_fields(
                block,
                format!("add `up {suggested}`"),
                &[format!("up {suggested}")],
            ),
        };
        self.problems.push(Problem::UpParallel {
            message: match is_parallel {
                true => "the camera looks straight along its up vector",
                false => "the camera looks all but straight along its up vector",
            },
            fixes: up.into_iter().collect(),
            help: match is_parallel {
                true => format!(
                    "the top of the picture is {shown} here; give another `up`, such as `up {suggested}`, to say so yourself"
                ),
                false => format!(
                    "which way is up hangs on the last digits of these numbers; give another `up`, such as `up {suggested}`"
                ),
            },
            span: given.map_or(seen.span, |given| given.span),
            label: looks,
        });
    }

    fn empty_depth(&mut self, block: &Block<'s>, near: f64, far: f64, given: Given) {
        let near_given = block.given("near");
        let (shown_near, shown_far) =
            (numbers::beside(near, &[far]), numbers::beside(far, &[near]));
        let text = |given: Given| self.sources.text(given.span);
        let fix = match near_given {
            Some(near_given) if far > 0.0 && near > far => Fix::new(
                "exchange `near` and `far`",
                [
                    Edit::new(near_given.span, text(given)),
                    Edit::new(given.span, text(near_given)),
                ],
            ),
            _ => Fix::remove_whole("leave `far` out", [given.field()], self.sources),
        };
        self.problems.push(Problem::EmptyDepth {
            fixes: vec![fix],
            help: match near_given {
                Some(_) if far > 0.0 && near > far => {
                    format!("exchange them: `near {shown_far}  far {shown_near}`")
                }
                _ => format!("write a number above {shown_near} after `far`, or leave it out"),
            },
            far: given.span,
            far_label: match near_given {
                Some(_) => format!("{shown_far} is not more"),
                None => format!("not more than `near`, which is {shown_near} if not given"),
            },
            near: near_given.map(|given| given.span),
            near_label: format!("than {shown_near}"),
        });
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

    fn triangle(&mut self, block: &Block<'s>, fields: &Fields<'_, 's>) -> Option<Shape> {
        let is_given = |name: &&str| block.given(name).is_some();
        let outline = match VERTICES.iter().any(is_given) {
            true => self.vertices(block, fields)?,
            false => self.centered(block, fields)?,
        };
        Some(Shape::Triangle(scene::Triangle {
            outline,
            color: fields.color("color")?,
        }))
    }

    fn vertices(&mut self, block: &Block<'s>, fields: &Fields<'_, 's>) -> Option<Outline> {
        let [a, b, c] = VERTICES.map(|name| fields.vector(name));
        let vertices = [a?, b?, c?];
        if !predicates::are_on_one_line(vertices) {
            return Some(Outline::Vertices(vertices));
        }
        let [a, b, c] = vertices;
        let equal = [
            ("v1", "v0", a == b),
            ("v2", "v0", a == c),
            ("v2", "v1", b == c),
        ];
        let equal = equal.into_iter().find(|(.., are_equal)| *are_equal);
        let [first, second, third] =
            VERTICES.map(|name| block.given(name).map_or(block.keyword, |given| given.span));
        self.problems.push(Problem::OnOneLine {
            message: match equal {
                Some((one, other, _)) => format!("`{one}` and `{other}` are the same point"),
                None => "the vertices lie on one line, and form no triangle".to_owned(),
            },
            span: third,
            second,
            first,
        });
        None
    }

    fn centered(&mut self, block: &Block<'s>, fields: &Fields<'_, 's>) -> Option<Outline> {
        let sides = fields.vector("sides")?;
        if !predicates::forms_triangle(sides.to_array()) {
            let [a, b, c] = sides.to_array();
            let (longest, [one, other], place) = if a >= b && a >= c {
                (a, [b, c], "first")
            } else if b >= c {
                (b, [a, c], "second")
            } else {
                (c, [a, b], "third")
            };
            let long = numbers::beside(longest, &[one + other, one, other]);
            let [one, other] = [(one, other), (other, one)]
                .map(|(x, y)| (x, numbers::beside(x, &[longest - y, longest])));
            let shown = |x: f64| match x {
                x if x == longest => long.clone(),
                x if x == one.0 => one.1.clone(),
                _ => other.1.clone(),
            };
            self.problems.push(Problem::NotATriangle {
                a: shown(a),
                b: shown(b),
                c: shown(c),
                help: format!(
                    "make the {place} side shorter than the two others together, or each of them longer"
                ),
                span: block.given("sides").map_or(block.keyword, |given| given.span),
                label: format!("{long} is not less than {} + {}", one.1, other.1),
            });
            return None;
        }
        Some(Outline::Centered(CenteredTriangle {
            centroid: fields.vector("centroid")?,
            normal: fields.vector("normal")?,
            sides,
            spin: fields.angle("spin")?,
        }))
    }

    fn cuboid(&mut self, block: &Block<'s>, fields: &Fields<'_, 's>) -> Option<Shape> {
        let corners = block.given("min").or(block.given("max"));
        let (min, max) = match corners {
            Some(_) => (fields.vector("min"), fields.vector("max")),
            None => match (fields.vector("center"), fields.vector("size")) {
                (Some(center), Some(size)) => {
                    let (min, max) = predicates::box_corners(center, size);
                    (Some(min), Some(max))
                }
                _ => (None, None),
            },
        };
        let color = fields.color("color");
        let (min, max) = (min?, max?);
        let axes = [
            ("x", min.x, max.x),
            ("y", min.y, max.y),
            ("z", min.z, max.z),
        ];
        let span = |name| block.given(name).map_or(block.keyword, |g: Given| g.span);
        if !min.is_finite() || !max.is_finite() {
            let span = span("center");
            self.problems.push(Problem::BoxTooLarge { span });
            return None;
        }
        if let Some(&(axis, low, high)) = axes.iter().find(|(_, low, high)| low >= high) {
            let (low, high) = (numbers::beside(low, &[high]), numbers::beside(high, &[low]));
            let given = (block.given("min"), block.given("max"));
            self.problems.push(match given {
                (Some(low_given), Some(high_given)) => {
                    let is_greater = axes.map(|(_, low, high)| low > high);
                    let (one, other) = (min.min(max), min.max(max));
                    let can_be_swapped = axes.iter().all(|(_, low, high)| low != high)
                        && (low_given.parts.and(high_given.parts).is_some() || is_greater == [true; 3]);
                    Problem::EmptyBox {
                        axis,
                        help: match can_be_swapped {
                            true => format!(
                                "write the corners in order: `min {}  max {}`",
                                numbers::short_vector(one),
                                numbers::short_vector(other)
                            ),
                            false => format!("make `max` greater than `min` on every axis; along {axis} they are {high} and {low}"),
                        },
                        span: high_given.span,
                        label: format!("{high} along {axis}"),
                        other: Some(low_given.span),
                        other_label: format!("{low} along {axis}"),
                        fixes: match can_be_swapped {
                            true => vec![self.in_order([low_given, high_given], is_greater)],
                            false => Vec::new(),
                        },
                    }
                }
                _ => Problem::EmptyBox {
                    axis,
                    help: "make it larger: so far from the origin, a number has no digits left for its size".to_owned(),
                    span: block.given("size").map_or(span("center"), |g| g.span),
                    label: format!("lost in rounding beside {low}"),
                    other: None,
                    other_label: String::new(),
                    fixes: Vec::new(),
                },
            });
            return None;
        }
        Some(Shape::Box(scene::Cuboid {
            min,
            max,
            color: color?,
        }))
    }
}

/// The ways to give what is missing: `center`, or `min` and `max`.
fn either(ways: &[Vec<&str>]) -> String {
    let separator = match ways.iter().all(|way| way.len() == 1) {
        true => " or ",
        false => ", or ",
    };
    let ways: Vec<String> = ways.iter().map(|way| quoted(way)).collect();
    ways.join(separator)
}

/// The values of a block's fields, defaults included. None where a value is missing or failed.
struct Fields<'b, 's> {
    block: Option<&'b Block<'s>>,
    kind: Kind,
}

impl<'b, 's> Fields<'b, 's> {
    fn of(block: Option<&'b Block<'s>>, kind: Kind) -> Self {
        Self { block, kind }
    }

    fn value(&self, name: &str) -> Option<Value> {
        if let Some(given) = self.block.and_then(|block| block.given(name)) {
            return given.value;
        }
        let row = schema::BLOCKS.iter().find(|row| row.kind == self.kind)?;
        match row.field(name)?.preset {
            Preset::Value(literal) => preset(literal),
            Preset::Required | Preset::Alternative | Preset::Nothing => None,
        }
    }

    fn number(&self, name: &str) -> Option<f64> {
        match self.value(name)? {
            Value::Number(number) => Some(number),
            _ => None,
        }
    }

    fn angle(&self, name: &str) -> Option<Angle> {
        match self.value(name)? {
            Value::Angle(angle) => Some(angle),
            _ => None,
        }
    }

    fn vector(&self, name: &str) -> Option<DVec3> {
        match self.value(name)? {
            Value::Vector(vector) => Some(vector),
            _ => None,
        }
    }

    fn color(&self, name: &str) -> Option<Color> {
        match self.value(name)? {
            Value::Color(color) => Some(color),
            _ => None,
        }
    }

    fn colors(&self, name: &str) -> Option<[Color; 2]> {
        match self.value(name)? {
            Value::Colors(colors) => Some(colors),
            _ => None,
        }
    }

    fn method(&self, name: &str) -> Option<Method> {
        match self.value(name)? {
            Value::Method(method) => Some(method),
            _ => None,
        }
    }
}

fn preset(literal: Literal) -> Option<Value> {
    Some(match literal {
        Literal::Number(number) => Value::Number(number),
        Literal::Degrees(degrees) => Value::Angle(Angle::from_degrees(degrees)),
        Literal::Vector(vector) => Value::Vector(DVec3::from_array(vector)),
        Literal::Color(name) => Value::Color(css::color(name)?),
        Literal::Colors([first, second]) => {
            Value::Colors([css::color(first)?, css::color(second)?])
        }
        Literal::Method(name) => Value::Method(schema::method(name)?),
    })
}

/// What to write for the camera to look at a point, if it can.
fn towards(camera: &Camera, middle: DVec3) -> Option<String> {
    let (from, to) = match camera.view {
        View::Lookat(_) => (camera.eye, middle),
        View::Direction(_) => (DVec3::ZERO, middle - camera.eye),
    };
    let is_one = to.is_finite() && !predicates::cross_is_zero(camera.up, from, to);
    is_one.then(|| numbers::short_vector(to))
}

/// Where the camera looks, as a direction in the place of the point.
fn direction_for(block: &Block<'_>, lookat: Span) -> Vec<Fix> {
    let fields = examples(block, &["direction"]);
    let is_in_file = lookat.source == SourceId::File;
    let fields = fields.into_iter().filter(|_| is_in_file);
    let title = "give a `direction` instead of `lookat`";
    fields
        .map(|field| Fix::new(title, [Edit::new(lookat, field)]))
        .collect()
}
