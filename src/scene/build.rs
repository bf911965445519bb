//! Blocks → scene.
//!
//! In: blocks, each with what it was given. Out: the scene, or what is wrong between fields: what is missing, and what does
//! not go together. Each value by itself is right already.

use glam::DVec3;

use super::{
    Camera, Count, Image, Lens, Method, Object, Sampler, Scene, Shape, View, css,
    error::Problem,
    field::{example, vector},
    level_direction,
    schema::{self, Kind, Literal, Preset},
    value::Value,
};
use crate::{
    color::Color,
    math::{Angle, exact},
    numbers,
    source::{SourceId, Span},
    suggest,
    syntax::tree::Name,
};

/// A block with what it was given.
pub struct Block<'s> {
    /// Its row of the table.
    pub row: &'static schema::Block,
    /// The place that stands for the block as a whole.
    pub keyword: Span,
    /// All of it.
    pub span: Span,
    /// The name of the object.
    pub name: Option<Name<'s>>,
    /// For each field of the row what it was given.
    pub given: Vec<Option<Given>>,
    /// Fields that were probably meant, by a mistyped name or in what was not understood.
    pub meant: Vec<&'static str>,
    /// Whether a field may have been lost.
    pub unfinished: bool,
}

#[derive(Clone, Copy)]
pub struct Given {
    /// The field's name.
    pub name: Span,
    /// The value's text.
    pub span: Span,
    /// None if it failed.
    pub value: Option<Value>,
}

/// Text that was not understood: what is missing may stand in it.
#[derive(Debug)]
pub struct Unread<'s> {
    /// The items that are none.
    pub items: Vec<&'s str>,
    /// Whether a comment took the end of the text.
    pub cut: bool,
}

impl Unread<'_> {
    fn is_empty(&self) -> bool {
        self.items.is_empty() && !self.cut
    }

    fn mentions(&self, word: &str) -> bool {
        self.cut || self.items.iter().any(|text| mentions(text, word))
    }
}

/// The scene of these blocks.
pub fn scene(
    blocks: &[Block<'_>],
    unread: &Unread<'_>,
    problems: &mut Vec<Problem>,
) -> Option<Scene> {
    for block in blocks {
        missing_fields(block, problems);
    }
    let one = |kind| blocks.iter().find(|block| block.row.kind == kind);
    let image = image(one(Kind::Image));
    let sampler = sampler(one(Kind::Sampler), image, problems);
    let start = Span::new(SourceId::File, 0, 0);
    let camera = match one(Kind::Camera) {
        Some(block) => camera(block, problems),
        None => {
            if !unread.mentions("camera") {
                problems.push(Problem::MissingCamera { span: start });
            }
            None
        }
    };
    let mut objects = Vec::with_capacity(blocks.len());
    for block in blocks.iter().filter(|block| block.row.is_object) {
        objects.extend(object(block, problems));
    }
    let none = !blocks.iter().any(|block| block.row.is_object);
    if none && unread.is_empty() {
        problems.push(Problem::NoObjects { span: start });
    }
    Some(Scene {
        image: image?,
        camera: camera?,
        sampler: sampler?,
        objects,
    })
}

fn missing_fields(block: &Block<'_>, problems: &mut Vec<Problem>) {
    if block.unfinished {
        return;
    }
    let has = |name: &str| block.given(name).is_some() || block.meant.contains(&name);
    let mut missing: Vec<String> = Vec::new();
    let mut examples: Vec<String> = Vec::new();
    let mut half = None;
    for row in block.row.fields {
        if row.preset == Preset::Required && !has(row.name) {
            missing.push(format!("`{}`", row.name));
            examples.push(format!("{} {}", row.name, example(row)));
        }
    }
    if block.row.kind == Kind::Camera && !has("lookat") && !has("direction") {
        missing.push("`lookat` or `direction`".to_owned());
        examples.push("lookat (0, 1, 0)".to_owned());
    }
    if block.row.kind == Kind::Box && !has("center") {
        match (has("min"), has("max")) {
            (true, true) => {}
            (false, false) => {
                missing.push("`center`, or `min` and `max`".to_owned());
                examples.push("center (0, 1, 0)".to_owned());
            }
            (true, false) => {
                missing.push("`max` beside its `min`".to_owned());
                examples.push("max (1, 1, 1)".to_owned());
                half = block.given("min").map(|given| given.name);
            }
            (false, true) => {
                missing.push("`min` beside its `max`".to_owned());
                examples.push("min (-1, 0, -1)".to_owned());
                half = block.given("max").map(|given| given.name);
            }
        }
    }
    if missing.is_empty() {
        return;
    }
    let needed = suggest::list(missing.iter().map(String::as_str));
    problems.push(Problem::MissingField {
        message: format!("{} needs {needed}", block.row.noun),
        help: format!("write `{}`", examples.join("  ")),
        span: block.keyword,
        label: match missing.len() {
            1 => "it is not given".to_owned(),
            _ => "they are not given".to_owned(),
        },
        half,
    });
}

fn image(block: Option<&Block<'_>>) -> Option<Image> {
    let row = Fields::of(block, Kind::Image);
    Some(Image {
        width: row.number("width")? as u32,
        height: row.number("height")? as u32,
        background: row.color("background")?,
    })
}

fn sampler(
    block: Option<&Block<'_>>,
    image: Option<Image>,
    problems: &mut Vec<Problem>,
) -> Option<Sampler> {
    let fields = Fields::of(block, Kind::Sampler);
    let pixels = image.map(|image| u64::from(image.width) * u64::from(image.height));
    let total = block.and_then(|block| block.given("total"));
    let count = match total {
        Some(given) => {
            let total = fields.number("total").map(|total| total as u64);
            if let (Some(total), Some(pixels)) = (total, pixels)
                && total < pixels
            {
                problems.push(Problem::FewSamples {
                    total,
                    pixels,
                    span: given.span,
                });
            }
            total.map(Count::Total)
        }
        None => {
            let per_pixel = fields.number("per_pixel").map(|count| count as u64);
            let most = pixels.map(|pixels| (1 << 53) / pixels);
            if let (Some(per_pixel), Some(most), Some(pixels)) = (per_pixel, most, pixels)
                && per_pixel > most
            {
                // The default is never too many.
                let given = block.and_then(|block| block.given("per_pixel"));
                let start = Span::new(SourceId::File, 0, 0);
                problems.push(Problem::TooManySamples {
                    per_pixel,
                    pixels,
                    most,
                    span: given.map_or(start, |given| given.span),
                });
            }
            per_pixel.map(Count::PerPixel)
        }
    };
    Some(Sampler {
        method: fields.method("method")?,
        count: count?,
        seed: fields.number("seed")? as u64,
    })
}

fn camera(block: &Block<'_>, problems: &mut Vec<Problem>) -> Option<Camera> {
    let fields = Fields::of(Some(block), Kind::Camera);
    let eye = fields.vector("eye");
    let up = fields.vector("up");
    let direction = block.given("direction");
    let view = match direction {
        Some(_) => fields.vector("direction").map(View::Direction),
        None => fields.vector("lookat").map(View::Lookat),
    };
    let seen = block.given("lookat").or(direction);
    if let (Some(eye), Some(view), Some(seen)) = (eye, view, seen) {
        match view {
            View::Lookat(point) if point == eye => problems.push(Problem::ViewUndefined {
                lookat: seen.span,
                eye: block.given("eye").map_or(block.keyword, |given| given.span),
            }),
            _ => up_parallel(block, (eye, view), up, seen, problems),
        }
    }
    let near = fields.number("near");
    let far = block
        .given("far")
        .map(|given| (given, fields.number("far")));
    if let (Some(near), Some((given, Some(far)))) = (near, far)
        && near >= far
    {
        problems.push(empty_depth(block, near, far, given));
    }
    let lens = match block.given("fov") {
        Some(_) => fields.angle("fov").map(Lens::Fov),
        None => fields.number("d").map(Lens::Distance),
    };
    Some(Camera {
        eye: eye?,
        view: view?,
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
    block: &Block<'_>,
    (eye, view): (DVec3, View),
    up: Option<DVec3>,
    seen: Given,
    problems: &mut Vec<Problem>,
) {
    let Some(up) = up else { return };
    let (from, to) = match view {
        View::Lookat(point) => (eye, point),
        View::Direction(direction) => (DVec3::ZERO, direction),
    };
    if !exact::cross_is_zero(up, from, to) {
        return;
    }
    // Against up, the top of the picture is the part of the level direction across up; along up, the opposite.
    // The scale of up does not matter, and its square could be too large.
    let up = up / up.abs().max_element();
    let level = level_direction(up);
    let across = level * up.dot(up) - up * level.dot(up);
    let along = exact::dot_sign(up, from, to).is_gt();
    let top = if along { -across } else { across };
    let shown = axis_name(top).unwrap_or_else(|| {
        let largest = top.abs().max_element();
        match largest > 0.0 && largest.is_finite() {
            true => format!("towards {}", vector(top / largest)),
            false => "across your `up`".to_owned(),
        }
    });
    let suggested = axis_vector(top).unwrap_or_else(|| "(0, 1, 0)".to_owned());
    let given = block.given("up");
    let looks = match view {
        View::Lookat(_) if given.is_some() => "parallel to the view direction".to_owned(),
        View::Lookat(_) => format!("straight along up, which is {} if not given", vector(up)),
        View::Direction(_) if given.is_some() => "parallel to the view direction".to_owned(),
        View::Direction(_) => format!("parallel to up, which is {} if not given", vector(up)),
    };
    problems.push(Problem::UpParallel {
        help: format!(
            "the top of the picture is {shown} here; give another `up`, such as `up {suggested}`, to say so yourself"
        ),
        span: given.map_or(seen.span, |given| given.span),
        label: looks,
    });
}

fn empty_depth(block: &Block<'_>, near: f64, far: f64, given: Given) -> Problem {
    let near_given = block.given("near");
    let (shown_near, shown_far) = (numbers::short(near), numbers::short(far));
    Problem::EmptyDepth {
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
    }
}

fn object(block: &Block<'_>, problems: &mut Vec<Problem>) -> Option<Object> {
    let fields = Fields::of(Some(block), block.row.kind);
    let shape = match block.row.kind {
        Kind::Sphere => Shape::Sphere {
            center: fields.vector("center")?,
            radius: fields.number("radius")?,
            color: fields.color("color")?,
        },
        Kind::Triangle => triangle(block, &fields, problems)?,
        Kind::Box => cuboid(block, &fields, problems)?,
        Kind::Checkerboard => Shape::Checkerboard {
            y: fields.number("y")?,
            square: fields.number("square")?,
            colors: fields.colors("colors")?,
        },
        Kind::Image | Kind::Camera | Kind::Sampler => return None,
    };
    Some(Object {
        name: block.name.map(|name| name.text.to_owned()),
        shape,
        span: block.span,
    })
}

fn triangle(
    block: &Block<'_>,
    fields: &Fields<'_, '_>,
    problems: &mut Vec<Problem>,
) -> Option<Shape> {
    let sides = fields.vector("sides")?;
    if !exact::forms_triangle(sides.to_array()) {
        let [a, b, c] = sides.to_array();
        let (longest, [one, other], place) = if a >= b && a >= c {
            (a, [b, c], "first")
        } else if b >= c {
            (b, [a, c], "second")
        } else {
            (c, [a, b], "third")
        };
        let shown = |x: f64| numbers::short(x);
        problems.push(Problem::NotATriangle {
            a: shown(a),
            b: shown(b),
            c: shown(c),
            help: format!(
                "make the {place} side shorter than the two others together, or each of them longer"
            ),
            span: block
                .given("sides")
                .map_or(block.keyword, |given| given.span),
            label: format!(
                "{} is not less than {} + {}",
                shown(longest),
                shown(one),
                shown(other)
            ),
        });
        return None;
    }
    Some(Shape::Triangle {
        centroid: fields.vector("centroid")?,
        normal: fields.vector("normal")?,
        sides,
        spin: fields.angle("spin")?,
        color: fields.color("color")?,
    })
}

fn cuboid(
    block: &Block<'_>,
    fields: &Fields<'_, '_>,
    problems: &mut Vec<Problem>,
) -> Option<Shape> {
    let corners = block.given("min").or(block.given("max"));
    let (min, max) = match corners {
        Some(_) => (fields.vector("min"), fields.vector("max")),
        None => match (fields.vector("center"), fields.vector("size")) {
            (Some(center), Some(size)) => {
                let (min, max) = exact::box_corners(center, size);
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
        problems.push(Problem::BoxTooLarge { span });
        return None;
    }
    if let Some(&(axis, low, high)) = axes.iter().find(|(_, low, high)| low >= high) {
        let (low, high) = (numbers::short(low), numbers::short(high));
        problems.push(match corners {
            Some(_) => Problem::EmptyBox {
                axis,
                help: format!("make `max` greater than `min` on every axis; along {axis} they are {high} and {low}"),
                span: span("max"),
                label: format!("{high} along {axis}"),
                other: Some(span("min")),
                other_label: format!("{low} along {axis}"),
            },
            None => Problem::EmptyBox {
                axis,
                help: "make it larger: so far from the origin, a number has no digits left for its size".to_owned(),
                span: block.given("size").map_or(span("center"), |g| g.span),
                label: format!("lost in rounding beside {low}"),
                other: None,
                other_label: String::new(),
            },
        });
        return None;
    }
    Some(Shape::Box {
        min,
        max,
        color: color?,
    })
}

impl Block<'_> {
    /// What a field was given.
    pub fn given(&self, name: &str) -> Option<Given> {
        let index = self.row.fields.iter().position(|row| row.name == name)?;
        self.given.get(index).copied().flatten()
    }
}

/// Whether a word stands in a text.
pub fn mentions(text: &str, word: &str) -> bool {
    let other = |c: char| !c.is_ascii_alphanumeric() && c != '_';
    text.split(other).any(|found| found == word)
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

/// A vector along an axis, such as `−z`.
fn axis_name(v: DVec3) -> Option<String> {
    let (axis, part) = axis(v)?;
    let sign = if part < 0.0 { '−' } else { '+' };
    Some(format!("{sign}{axis}"))
}

fn axis_vector(v: DVec3) -> Option<String> {
    let (axis, part) = axis(v)?;
    let one = if part < 0.0 { "-1" } else { "1" };
    Some(match axis {
        'x' => format!("({one}, 0, 0)"),
        'y' => format!("(0, {one}, 0)"),
        _ => format!("(0, 0, {one})"),
    })
}

fn axis(v: DVec3) -> Option<(char, f64)> {
    match v.to_array() {
        [x, 0.0, 0.0] if x != 0.0 => Some(('x', x)),
        [0.0, y, 0.0] if y != 0.0 => Some(('y', y)),
        [0.0, 0.0, z] if z != 0.0 => Some(('z', z)),
        _ => None,
    }
}
