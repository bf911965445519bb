//! Writes a scene as a text, and checks a scene that was made or changed in code.
//!
//! The text has a block for each part of the scene, and states every field's value. Numbers are
//! written with enough digits that reading the text returns exactly the same scene.

use std::{collections::HashSet, fmt, sync::Arc};

use super::{
    lower::read,
    model::{Camera, Count, Image, Lens, Object, Sampler, Scene, View},
};
use crate::{
    diagnostic::Mistakes,
    math::Angle,
    schema::Value,
    source::{Source, Sources},
};

impl Scene {
    /// Checks that the scene is one that a text can describe: a radius is more than 0, the camera
    /// does not look at its own eye, names are unique, and so on.
    ///
    /// # Errors
    ///
    /// Returns the mistakes that are found in the [text](#impl-Display-for-Scene) of the scene.
    pub fn check(&self) -> Result<(), Mistakes> {
        let sources = Sources::new(Source::from_text("scene", self.to_string()));
        let reading = read(&sources);
        match reading.scene {
            Some(_) => Ok(()),
            None => Err(Mistakes::new(Arc::new(sources), reading.diagnostics)),
        }
    }
}

/// Writes the scene as a text of the language. An object that `for` repeats is written as separate
/// objects: `Ball[3, 1]` is called `Ball_3_1`.
impl fmt::Display for Scene {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Image {
            width,
            height,
            background,
        } = self.image;
        let background = Exactly(Value::Color(background));
        writeln!(
            f,
            "image {{ width {width}  height {height}  background {background} }}"
        )?;
        write_camera(&self.camera, f)?;
        let Sampler {
            method,
            count,
            seed,
        } = self.sampler;
        let count = match count {
            Count::PerPixel(count) => format!("per_pixel {count}"),
            Count::Total(count) => format!("total {count}"),
        };
        let method = method.name();
        writeln!(f, "sampler {{ method {method}  {count}  seed {seed} }}")?;
        let names = self.objects.iter().filter_map(|it| it.name.clone());
        let mut taken: HashSet<String> = names.collect();
        for object in self.objects.iter() {
            f.write_str(object.shape.kind())?;
            if let Some(name) = &object.name {
                write!(f, " {}", name_in_text(name, object, &mut taken))?;
            }
            f.write_str(" { ")?;
            for (name, value) in object.shape.fields() {
                write!(f, "{name} {}  ", Exactly(value))?;
            }
            f.write_str("}\n")?;
        }
        Ok(())
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

fn write_camera(camera: &Camera, f: &mut fmt::Formatter<'_>) -> fmt::Result {
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
    f.write_str("camera {\n")?;
    for (name, value) in fields.into_iter().chain(far) {
        writeln!(f, "  {name} {}", Exactly(value))?;
    }
    f.write_str("}\n")
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
