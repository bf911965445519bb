//! The numbers of a scene that a program may have wrong, and their `--set` arguments.
//!
//! In: a scene. Out: the fields of the language's table that it uses, their numbers, and scenes
//! with other numbers.

use std::{ops::Range, sync::Arc};

use glam::DVec3;

use crate::{
    color::Color,
    math::Angle,
    projection::Projection,
    scene::{Camera, FieldOwner as Part, Object, Scene, View},
    schema::{self, FieldRow as Field, Value},
};

/// Owner of a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Owner {
    /// The image.
    Image,
    /// The camera.
    Camera,
    /// An object, which stands for all objects of its block.
    Object(usize),
}

/// A field of a scene, or the camera's `eye` and `lookat` together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Parameter {
    /// Owner of the fields.
    pub owner: Owner,
    /// Names of the fields.
    pub fields: Vec<&'static str>,
}

/// Far plane that stands for none, in metres.
pub const NO_FAR: f64 = 1e9;

/// Returns the parameters that a picture determines. Without `up`, which turns the picture as
/// `roll` does, and `view_height`, which scales it as `d` does.
pub fn fittable(scene: &Scene) -> Vec<Parameter> {
    let mut fitted = all(scene);
    fitted.retain(|parameter| !matches!(parameter.fields[0], "up" | "view_height"));
    // One corner of a box may be wrong.
    let sizes = fitted
        .iter()
        .filter(|parameter| parameter.fields == ["size"]);
    let owners: Vec<Owner> = sizes.map(|parameter| parameter.owner).collect();
    fitted.extend(
        owners
            .into_iter()
            .flat_map(|owner| ["min", "max"].map(|corner| Parameter::new(owner, &[corner]))),
    );
    if scene.camera.far.is_none() {
        fitted.push(Parameter::new(Owner::Camera, &["far"]));
    }
    fitted
}

/// Returns all parameters of a scene.
fn all(scene: &Scene) -> Vec<Parameter> {
    let owners = [Owner::Image, Owner::Camera].into_iter();
    let blocks = scene.objects.chunk_by(Object::is_beside);
    let firsts = blocks.scan(0, |next, block| {
        *next += block.len();
        Some(*next - block.len())
    });
    let owners = owners.chain(firsts.map(Owner::Object));
    let mut found: Vec<Parameter> = owners
        .flat_map(|owner| {
            let fields = schema::block(owner.kind(scene)).map_or(&[][..], |block| block.fields);
            // A box is described by its center and size, however it is written.
            let is_used = move |field: &&Field| {
                let is_corner = matches!(field.name, "min" | "max");
                !is_corner && owner.part(scene).value(field.name).is_some()
            };
            let used = fields.iter().filter(is_used);
            used.map(move |field| Parameter::new(owner, &[field.name]))
        })
        .collect();
    if let View::Lookat(_) = scene.camera.view {
        found.push(Parameter::new(Owner::Camera, &["eye", "lookat"]));
    }
    found
}

/// Returns the fields in which two scenes differ.
pub fn changed(from: &Scene, to: &Scene) -> Vec<Parameter> {
    let mut changed = all(to);
    changed.retain(|one| one.fields.len() == 1 && one.values(from) != one.values(to));
    changed
}

/// Returns the `--set` arguments that change one scene into another, as far as they can.
pub fn arguments(from: &Scene, to: &Scene) -> Vec<String> {
    let mut changed = changed(from, to);
    for parameter in &mut changed {
        // Setting only one of them replaces min and max, and leaves the other at its default.
        if parameter.owner.kind(to) == "box" && matches!(parameter.fields[0], "center" | "size") {
            parameter.fields = vec!["center", "size"];
        }
    }
    changed.dedup();
    let arguments = changed.iter().flat_map(|parameter| parameter.arguments(to));
    // No value removes the far plane, so it is moved beyond everything.
    let is_unlimited = from.camera.far.is_some() && to.camera.far.is_none();
    let far = is_unlimited.then(|| "camera.far=1e9".to_owned());
    arguments.chain(far).collect()
}

impl Owner {
    fn kind(self, scene: &Scene) -> &'static str {
        match self {
            Self::Image => "image",
            Self::Camera => "camera",
            Self::Object(index) => scene.objects[index].shape.kind(),
        }
    }

    fn part(self, scene: &Scene) -> Part {
        match self {
            Self::Image => Part::Image(scene.image),
            Self::Camera => Part::Camera(scene.camera),
            Self::Object(index) => Part::Shape(scene.objects[index].shape),
        }
    }

    /// Returns the objects of its block that follow it.
    fn others(self, scene: &Scene) -> Range<usize> {
        let Self::Object(index) = self else {
            return 0..0;
        };
        let behind = scene.objects.iter().skip(index + 1);
        let others = behind.take_while(|it| it.is_beside(&scene.objects[index]));
        index + 1..index + 1 + others.count()
    }

    /// Returns the owner's description in messages.
    pub fn name(self, scene: &Scene) -> String {
        match self {
            Self::Image => "the image".to_owned(),
            Self::Camera => "the camera".to_owned(),
            Self::Object(index) => match &scene.objects[index].name {
                Some(name) => format!("the {} {name}", self.kind(scene)),
                None => format!("the {} with the index {index}", self.kind(scene)),
            },
        }
    }
}

impl Parameter {
    /// Creates the parameter of some fields of an owner.
    pub fn new(owner: Owner, fields: &[&'static str]) -> Self {
        let fields = fields.to_vec();
        Self { owner, fields }
    }

    /// Returns the owner's description in messages, including the rest of its block.
    pub fn owner_name(&self, scene: &Scene) -> String {
        let name = self.owner.name(scene);
        if self.owner.others(scene).is_empty() {
            name
        } else {
            format!("{name}, like the others of its block,")
        }
    }

    /// Returns the values of its fields.
    pub fn values(&self, scene: &Scene) -> Vec<Value> {
        let part = self.owner.part(scene);
        let fields = self.fields.iter();
        fields.filter_map(|field| part.value(field)).collect()
    }

    /// Returns the value of its first field.
    pub fn value(&self, scene: &Scene) -> Option<Value> {
        self.values(scene).into_iter().next()
    }

    /// Returns its numbers: angles in degrees, colours from 0 to 255.
    pub fn numbers(&self, scene: &Scene) -> Vec<f64> {
        let numbers = |value: Value| match value {
            Value::Number(number) => vec![number],
            Value::Angle(angle) => vec![angle.in_degrees()],
            Value::Vector(vector) => vector.to_array().to_vec(),
            Value::Color(color) => color.srgb.to_vec(),
            Value::Colors(colors) => colors.map(|color| color.srgb).concat(),
            Value::FaceColors(colors) => colors.map(|color| color.srgb).concat(),
            Value::Method(_) => Vec::new(),
        };
        if self.fields == ["far"] && scene.camera.far.is_none() {
            return vec![NO_FAR];
        }
        self.values(scene).into_iter().flat_map(numbers).collect()
    }

    /// Returns a scene with other numbers. Returns `None` if they are impossible. Differences to
    /// the other objects of a block are kept.
    pub fn put(&self, scene: &Scene, numbers: &[f64]) -> Option<Scene> {
        let mut changed = self.put_one(scene.clone(), numbers)?;
        let before = self.numbers(scene);
        for index in self.owner.others(scene) {
            let other = Self::new(Owner::Object(index), &self.fields);
            let own = other.numbers(scene).into_iter();
            let own = own.zip(before.iter().zip(numbers));
            let moved = own.map(|(own, (before, after))| {
                if own == *before {
                    *after
                } else {
                    own + (after - before)
                }
            });
            changed = other.put_one(changed, &Vec::from_iter(moved))?;
        }
        Some(changed)
    }

    fn put_one(&self, mut changed: Scene, numbers: &[f64]) -> Option<Scene> {
        let mut part = self.owner.part(&changed);
        let mut rest = numbers;
        for field in &self.fields {
            let before = match part.value(field) {
                None if *field == "far" => Value::Number(NO_FAR),
                before => before?,
            };
            let (own, others) = rest.split_at(match before {
                Value::Vector(_) | Value::Color(_) => 3,
                Value::Colors(_) => 6,
                Value::FaceColors(_) => 9,
                _ => 1,
            });
            rest = others;
            let color = |at: usize| Color {
                srgb: [0, 1, 2].map(|i| own[at + i].clamp(0.0, 255.0)),
            };
            let after = match before {
                Value::Vector(_) => Value::Vector(DVec3::from_slice(own)),
                Value::Color(_) => Value::Color(color(0)),
                Value::Colors(_) => Value::Colors([color(0), color(3)]),
                Value::FaceColors(_) => Value::FaceColors([0, 3, 6].map(color)),
                Value::Angle(_) => Value::Angle(Angle::from_degrees(own[0])),
                _ => Value::Number(own[0]),
            };
            part = match (part, *field, after) {
                (Part::Camera(camera), "far", Value::Number(far)) => Part::Camera(Camera {
                    far: Some(far),
                    ..camera
                }),
                (part, field, after) => part.with(field, after)?,
            };
        }
        part.is_possible().then(|| {
            match (part, self.owner) {
                (Part::Image(image), _) => changed.image = image,
                (Part::Camera(camera), _) => changed.camera = camera,
                (Part::Shape(shape), Owner::Object(index)) => {
                    Arc::make_mut(&mut changed.objects)[index].shape = shape
                }
                (Part::Shape(_), _) => {}
            }
            changed
        })
    }

    /// Returns the `--set` arguments for its values. Returns none if its object has no name, or if
    /// the objects of its block have different values.
    pub fn arguments(&self, scene: &Scene) -> Vec<String> {
        let values = self.values(scene);
        let is_same = |index| {
            let part = Owner::Object(index).part(scene);
            let own = self.fields.iter().filter_map(|field| part.value(field));
            own.eq(values.iter().copied())
        };
        if !self.owner.others(scene).all(is_same) {
            return Vec::new();
        }
        let owner = match self.owner {
            Owner::Image => "image",
            Owner::Camera => "camera",
            Owner::Object(index) => match &scene.objects[index].name {
                Some(name) => name.split('[').next().unwrap_or(name),
                None => return Vec::new(),
            },
        };
        let written = |value: Value| match value {
            Value::Number(number) => format!("{number}"),
            Value::Angle(angle) => format!("{}deg", angle.in_degrees()),
            Value::Vector(v) => format!("({}, {}, {})", v.x, v.y, v.z),
            other => other.to_string(),
        };
        let values = self.fields.iter().zip(values);
        values
            .map(|(field, value)| format!("{owner}.{field}={}", written(value)))
            .collect()
    }

    /// Returns for each number the change that moves the picture by about `pixels` pixels, or a
    /// colour by 8 of 255.
    pub fn steps(&self, scene: &Scene, pixels: f64) -> Vec<f64> {
        let projection = Projection::quick(&scene.camera, &scene.image);
        // Size of a pixel at a point, in metres.
        let pixel_at =
            |point: DVec3| (point - projection.eye).length().max(1e-9) * projection.pitch;
        let pixel_of = |object: &Object| object.shape.center().map(pixel_at);
        let wide = f64::from(scene.image.width.max(scene.image.height));
        let pixel = match self.owner {
            Owner::Object(index) => pixel_of(&scene.objects[index]).unwrap_or(0.0),
            _ => match scene.camera.view {
                View::Lookat(point) => pixel_at(point),
                // At the nearest object.
                View::Direction(_) => {
                    let pixels = scene.objects.iter().filter_map(pixel_of);
                    pixels.reduce(f64::min).unwrap_or(projection.pitch)
                }
            },
        };
        let step = |(field, value): (&&'static str, Value)| match (*field, value) {
            (_, Value::Color(color)) => color.srgb.map(inward).to_vec(),
            (_, Value::Colors(colors)) => colors.map(|color| color.srgb.map(inward)).concat(),
            (_, Value::FaceColors(colors)) => colors.map(|color| color.srgb.map(inward)).concat(),
            ("normal", Value::Vector(normal)) => vec![0.03 * normal.length(); 3],
            ("direction", Value::Vector(direction)) => {
                vec![direction.length() * projection.pitch; 3]
            }
            (_, Value::Vector(_)) => vec![pixel; 3],
            ("fov" | "hfov", Value::Angle(angle)) => {
                vec![2.0 / wide * angle.in_degrees()]
            }
            (_, Value::Angle(_)) => vec![(2.0f64 / wide).to_degrees()],
            ("radius", _) => vec![pixel],
            ("y", Value::Number(y)) => vec![2.0 / wide * (scene.camera.eye.y - y).abs().max(1e-3)],
            (_, Value::Number(number)) => vec![2.0 / wide * number.abs()],
            (_, Value::Method(_)) => Vec::new(),
        };
        let steps = self.fields.iter().zip(self.values(scene)).flat_map(step);
        let by = if self.is_color() { 1.0 } else { pixels };
        steps.map(|step| by * step).collect()
    }

    /// Returns whether it is a colour, which moves nothing.
    pub fn is_color(&self) -> bool {
        matches!(self.fields[0], "color" | "colors" | "background")
    }
}

/// Returns a step of a channel that stays between 0 and 255.
fn inward(channel: f64) -> f64 {
    if channel < 128.0 { 8.0 } else { -8.0 }
}
