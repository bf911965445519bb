//! Writes a scene as a text, and checks a scene that was made or changed in code.
//!
//! The text has a block for each part of the scene, and states every field's value. Numbers are
//! written with enough digits that reading the text returns exactly the same scene. To check a
//! scene, its text is read, which finds most mistakes. Invalid names and numbers that are not
//! finite are reported earlier, while the text is written. A text with such a name or number might
//! be read as another scene without any mistake, or cause misleading error messages.

use std::{collections::HashSet, fmt, sync::Arc};

use super::{
    error::error,
    lower::read,
    model::{Camera, Count, Image, Lens, Object, Sampler, Scene, View},
};
use crate::{
    color::Color,
    diagnostic::{Mistakes, Problems},
    math::Angle,
    schema::Value,
    source::{Source, SourceId, Sources, Span},
    syntax::{self, shorten},
};

impl Scene {
    /// Checks that the scene meets the language's conditions: a radius is more than 0, the camera
    /// does not look at its own eye, names are unique, and so on.
    ///
    /// # Errors
    ///
    /// Returns the mistakes that are found in the [text](#impl-Display-for-Scene) of the scene. If
    /// an object's name is not allowed in the language, or a number is not finite, only mistakes of
    /// these two kinds are returned.
    pub fn check(&self) -> Result<(), Mistakes> {
        let sources = Sources::new(Source::from_text("scene", self.text()?));
        let reading = read(&sources);
        match reading.scene {
            Some(_) => Ok(()),
            None => Err(Mistakes::new(Arc::new(sources), reading.diagnostics)),
        }
    }

    /// Returns the text of the scene.
    ///
    /// # Errors
    ///
    /// Returns an error if an object's name is not allowed in the language, or if a number is not
    /// finite. A text with such a name or number would describe another scene, or its parser errors
    /// would be misleading.
    pub(crate) fn text(&self) -> Result<String, Mistakes> {
        let Writer { text, problems } = Writer::of(self);
        if problems.is_empty() {
            return Ok(text);
        }
        let sources = Sources::new(Source::from_text("scene", text));
        Err(Mistakes::new(Arc::new(sources), problems.into()))
    }
}

/// Writes the scene as a text of the language. An object that `for` repeats is written as separate
/// objects: `Ball[3, 1]` is called `Ball_3_1`. If the scene breaks a condition of the language, the
/// text is not valid, or describes another scene; [`check`](Scene::check) finds such scenes.
impl fmt::Display for Scene {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&Writer::of(self).text)
    }
}

/// Writer of a scene's text. It also collects the problems with names and numbers that the language
/// cannot express, such as an infinite radius.
#[derive(Default)]
struct Writer {
    text: String,
    problems: Problems,
}

impl Writer {
    /// Writes a scene.
    fn of(scene: &Scene) -> Self {
        let mut writer = Self::default();
        writer.image(&scene.image);
        writer.camera(&scene.camera);
        writer.sampler(&scene.sampler);
        let names = scene.objects.iter().filter_map(|it| it.name.clone());
        let mut taken: HashSet<String> = names.collect();
        for object in scene.objects.iter() {
            writer.object(object, &mut taken);
        }
        writer
    }

    fn image(&mut self, image: &Image) {
        let Image {
            width,
            height,
            background,
        } = *image;
        self.text += &format!("image {{ width {width}  height {height}  ");
        self.field("background", Value::Color(background));
        self.text += " }\n";
    }

    fn camera(&mut self, camera: &Camera) {
        let Camera {
            eye,
            view,
            up,
            roll,
            lens,
            view_height,
            near,
            far,
        } = *camera;
        let view = match view {
            View::Lookat(point) => ("lookat", Value::Vector(point)),
            View::Direction(direction) => ("direction", Value::Vector(direction)),
        };
        let lens = match lens {
            Lens::Distance(d) => ("d", Value::Number(d)),
            Lens::Fov(angle) => ("fov", Value::Angle(angle)),
            Lens::HorizontalFov(angle) => ("hfov", Value::Angle(angle)),
        };
        let fields = [
            ("eye", Value::Vector(eye)),
            view,
            ("up", Value::Vector(up)),
            ("roll", Value::Angle(roll)),
            lens,
            ("view_height", Value::Number(view_height)),
            ("near", Value::Number(near)),
        ];
        let far = far.map(|far| ("far", Value::Number(far)));
        self.text += "camera {\n";
        for (name, value) in fields.into_iter().chain(far) {
            self.text += "  ";
            self.field(name, value);
            self.text += "\n";
        }
        self.text += "}\n";
    }

    fn sampler(&mut self, sampler: &Sampler) {
        let Sampler {
            method,
            count,
            seed,
        } = *sampler;
        let count = match count {
            Count::PerPixel(count) => format!("per_pixel {count}"),
            Count::Total(count) => format!("total {count}"),
        };
        self.text += &format!("sampler {{ method {method}  {count}  seed {seed} }}\n");
    }

    fn object(&mut self, object: &Object, taken: &mut HashSet<String>) {
        self.text += object.shape.kind();
        if let Some(name) = &object.name {
            self.text += " ";
            self.name(name, object, taken);
        }
        self.text += " { ";
        for (name, value) in object.shape.fields() {
            self.field(name, value);
            self.text += "  ";
        }
        self.text += "}\n";
    }

    fn name(&mut self, name: &str, object: &Object, taken: &mut HashSet<String>) {
        let start = self.text.len();
        self.text += &name_in_text(name, object, taken);
        if is_name(name, &object.indices) {
            return;
        }
        let message = match shorten(name).as_str() {
            "" => "an empty text cannot be a name".to_owned(),
            name => format!("`{name}` cannot be a name"),
        };
        let span = Span::new(SourceId::File, start, self.text.len());
        error("bad_name", message)
            .at(span, "the name of an object")
            .help(
                "a name is made of the letters a to z, digits and `_`, \
                and does not start with a digit",
            )
            .report(&mut self.problems);
    }

    fn field(&mut self, name: &str, value: Value) {
        self.text += name;
        self.text += " ";
        let start = self.text.len();
        self.text += &Exactly(value).to_string();
        if is_finite(&value) {
            return;
        }
        let span = Span::new(SourceId::File, start, self.text.len());
        error("not_finite", format!("`{name}` is not finite"))
            .at(span, "infinite, or not a number")
            .help("all numbers of a scene are finite")
            .report(&mut self.problems);
    }
}

/// Returns whether an object with the indices `indices` may have the name `name`. An object that
/// `for` repeats has its indices in the name, such as `Ball[3, 1]`.
fn is_name(name: &str, indices: &[u32]) -> bool {
    let word = match indices {
        [] => name,
        _ => {
            let suffix = format!("{indices:?}");
            name.strip_suffix(suffix.as_str()).unwrap_or_default()
        }
    };
    syntax::is_name(word) && !matches!(word, "let" | "for")
}

fn is_finite(value: &Value) -> bool {
    let are_finite = |numbers: &[f64]| numbers.iter().all(|number| number.is_finite());
    let is_color = |color: &Color| are_finite(&color.srgb);
    match value {
        Value::Number(number) => number.is_finite(),
        Value::Angle(Angle { degrees, radians }) => are_finite(&[*degrees, *radians]),
        Value::Vector(vector) => vector.is_finite(),
        Value::Color(color) => is_color(color),
        Value::Colors(colors) => colors.iter().all(is_color),
        Value::FaceColors(colors) => colors.iter().all(is_color),
        Value::Method(_) => true,
    }
}

/// Returns the name under which an object is written in a text. An object that `for` repeats has a
/// name with brackets, such as `Ball[3, 1]`, which becomes `Ball_3_1`. If this name is taken,
/// underscores are appended.
fn name_in_text(name: &str, object: &Object, taken: &mut HashSet<String>) -> String {
    if object.indices.is_empty() {
        return name.to_owned();
    }
    let mut plain = name.replace(['[', ']'], " ").replace(',', "");
    plain = plain.split_whitespace().collect::<Vec<_>>().join("_");
    while !taken.insert(plain.clone()) {
        plain.push('_');
    }
    plain
}

/// Wrapper that formats a value in the language's notation, with enough digits that reading the
/// text returns exactly the same value.
struct Exactly(Value);

impl fmt::Display for Exactly {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Value::Number(number) => f.write_str(&digits(number)),
            Value::Angle(Angle { degrees, radians }) => match (degrees, radians) {
                (degrees, 0.0) => write!(f, "{}deg", digits(degrees)),
                (0.0, radians) => write!(f, "{}rad", digits(radians)),
                _ => write!(f, "{}deg + {}rad", digits(degrees), digits(radians)),
            },
            Value::Vector(vector) => {
                let [x, y, z] = vector.to_array().map(digits);
                write!(f, "({x}, {y}, {z})")
            }
            Value::Color(color) if color.srgb.map(|it| f64::from(it as u8)) == color.srgb => {
                write!(f, "{color}")
            }
            Value::Color(color) => {
                let [r, g, b] = color.srgb.map(digits);
                write!(f, "rgb({r}, {g}, {b})")
            }
            Value::Colors(colors) => {
                let [first, second] = colors.map(|color| Self(Value::Color(color)));
                write!(f, "({first}, {second})")
            }
            Value::FaceColors(colors) => {
                let [x, y, z] = colors.map(|color| Self(Value::Color(color)));
                write!(f, "({x}, {y}, {z})")
            }
            Value::Method(method) => f.write_str(method.name()),
        }
    }
}

/// Formats a number with the fewest digits from which exactly the same number is read back. The
/// exponent form, such as `1e300`, is used if it is shorter than the plain form and the plain form
/// has more than 12 characters.
fn digits(number: f64) -> String {
    let [plain, power] = [format!("{number}"), format!("{number:e}")];
    if plain.len() <= power.len().max(12) {
        plain
    } else {
        power
    }
}
