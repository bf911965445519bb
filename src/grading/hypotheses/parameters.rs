//! The numbers of a scene that a program may have wrong, and the `--set` arguments that change
//! them.
//!
//! In: a scene. Out: the fields that the scene uses, their numbers, and scenes with other numbers.

use std::ops::Range;

use glam::DVec3;

use crate::{
    color::Color,
    math::Angle,
    projection::Projection,
    scene::{FieldOwner as Part, Object, Scene, View},
    schema::{self, FieldRow as Field, Value},
};

/// Part of a scene that has fields.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Owner {
    /// The block `image` of the scene.
    Image,
    /// The block `camera` of the scene.
    Camera,
    /// An object, given by its index. If a block of the scene's file describes several objects, the
    /// first of them represents all.
    Object(usize),
}

/// A field of a scene whose numbers may be wrong, or two fields that are changed together, such as
/// the camera's `eye` and `lookat`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Parameter {
    /// Image, camera or object to which the fields belong.
    pub owner: Owner,
    /// Names of the fields.
    pub fields: Vec<&'static str>,
}

/// Distance of a far plane that cuts off nothing, in metres. It is used for scenes without a far
/// plane, because the fit needs a number to change. Any value far beyond all objects works.
pub const NO_FAR: f64 = 1e9;

/// Returns the fields that can be fitted to a picture. The field `up` is left out, because it turns
/// the picture as `roll` does. The field `view_height` is left out, because it scales the picture
/// as the distance of the view plane does.
pub fn fittable(scene: &Scene) -> Vec<Parameter> {
    let mut fitted = all(scene);
    fitted.retain(|parameter| !matches!(parameter.fields[0], "up" | "view_height"));
    // In a wrong box, only one corner may be wrong. So each corner can be fitted, too.
    let mut corners = fitted.clone();
    corners.retain(|parameter| parameter.fields == ["size"]);
    let of = |it: Parameter| ["min", "max"].map(|corner| Parameter::new(it.owner, &[corner]));
    fitted.extend(corners.into_iter().flat_map(of));
    if scene.camera.far.is_none() {
        fitted.push(Parameter::new(Owner::Camera, &["far"]));
    }
    fitted
}

/// Returns all fields that a scene uses.
fn all(scene: &Scene) -> Vec<Parameter> {
    let is_first = |&at: &usize| at == 0 || !scene.objects[at].is_beside(&scene.objects[at - 1]);
    let firsts = (0..scene.objects.len()).filter(is_first).map(Owner::Object);
    let owners = [Owner::Image, Owner::Camera].into_iter().chain(firsts);
    let mut found: Vec<Parameter> = owners
        .flat_map(|owner| {
            let fields = schema::block(owner.kind(scene)).map_or(&[][..], |block| block.fields);
            // A box has values for its center and size as well as for its corners, `min` and `max`.
            // The corners are left out, so that each box is described only once.
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

/// Returns the fields of the scene `to` whose values differ from those in the scene `from`.
pub fn changed(from: &Scene, to: &Scene) -> Vec<Parameter> {
    let mut changed = all(to);
    changed.retain(|one| one.fields.len() == 1 && one.values(from) != one.values(to));
    changed
}

/// Returns the `--set` arguments that change one scene into another. Changes that no argument can
/// express are left out.
pub fn arguments(from: &Scene, to: &Scene) -> Vec<String> {
    let mut changed = changed(from, to);
    for parameter in &mut changed {
        // If only `center` or only `size` were set, the box's corners would be removed, and the
        // other field would have its default. So both fields are set.
        if parameter.owner.kind(to) == "box" && matches!(parameter.fields[0], "center" | "size") {
            parameter.fields = vec!["center", "size"];
        }
    }
    changed.dedup();
    let arguments = changed.iter().flat_map(|parameter| parameter.arguments(to));
    // No argument can remove a far plane, so the far plane is moved beyond all objects.
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

    /// Returns the indices of the objects after this one that come from the same block of the
    /// scene's file.
    fn others(self, scene: &Scene) -> Range<usize> {
        let Self::Object(index) = self else {
            return 0..0;
        };
        let behind = scene.objects.iter().skip(index + 1);
        let others = behind.take_while(|it| it.is_beside(&scene.objects[index]));
        index + 1..index + 1 + others.count()
    }

    /// Returns a description of the image, camera or object, for messages.
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
    /// Creates a parameter from some fields of the image, the camera or an object.
    pub fn new(owner: Owner, fields: &[&'static str]) -> Self {
        let fields = fields.to_vec();
        Self { owner, fields }
    }

    /// Returns the name of the image, the camera or the object to which the fields belong, for
    /// messages. If the object's block in the file describes several objects, the name mentions the
    /// others, too.
    pub fn owner_name(&self, scene: &Scene) -> String {
        let name = self.owner.name(scene);
        if self.owner.others(scene).is_empty() {
            name
        } else {
            format!("{name}, like the others of its block,")
        }
    }

    /// Returns the values of the parameter's fields.
    pub fn values(&self, scene: &Scene) -> Vec<Value> {
        let part = self.owner.part(scene);
        let fields = self.fields.iter();
        fields.filter_map(|field| part.value(field)).collect()
    }

    /// Returns the value of the parameter's first field. Returns `None` if the scene does not have
    /// this field.
    pub fn value(&self, scene: &Scene) -> Option<Value> {
        self.values(scene).into_iter().next()
    }

    /// Returns the numbers of the parameter's fields. Angles are in degrees, and colour channels
    /// range from 0 to 255.
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

    /// Returns a copy of the scene in which the parameter has the given numbers. Returns `None` if
    /// the numbers are impossible. Other objects of the same block are changed by the same amounts.
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
            // A missing far plane is added here, because only an existing field can be changed.
            if let (Part::Camera(camera), "far") = (&mut part, *field) {
                camera.far = Some(own[0]);
            }
            part = part.with(field, after)?;
        }
        part.is_possible().then(|| {
            match (part, self.owner) {
                (Part::Image(image), _) => changed.image = image,
                (Part::Camera(camera), _) => changed.camera = camera,
                (Part::Shape(shape), Owner::Object(at)) => changed.objects_mut()[at].shape = shape,
                (Part::Shape(_), _) => {}
            }
            changed
        })
    }

    /// Returns the `--set` arguments for the parameter's values. Returns an empty list if the
    /// object has no name, or if the objects of its block have different values.
    pub fn arguments(&self, scene: &Scene) -> Vec<String> {
        let values = self.values(scene);
        let of = |index| Self::new(Owner::Object(index), &self.fields).values(scene);
        if self.owner.others(scene).any(|index| of(index) != values) {
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

    /// Returns for each number by how much it must be changed to move the picture by about `pixels`
    /// pixels. A change of colour moves nothing, so the result for a colour channel is always 8 or
    /// −8, on a scale from 0 to 255. The sign is chosen so that the changed channel stays in this
    /// range.
    pub fn steps(&self, scene: &Scene, pixels: f64) -> Vec<f64> {
        if self.is_color() {
            return self.numbers(scene).into_iter().map(inward).collect();
        }
        let projection = Projection::quick(&scene.camera, &scene.image);
        // Width of a pixel at the distance of a point, in metres.
        let pixel_at =
            |point: DVec3| (point - projection.eye).length().max(1e-9) * projection.pitch;
        let pixel_of = |object: &Object| object.shape.center().map(pixel_at);
        let wide = f64::from(scene.image.width.max(scene.image.height));
        let pixel = match self.owner {
            Owner::Object(index) => pixel_of(&scene.objects[index]).unwrap_or(0.0),
            _ => match scene.camera.view {
                View::Lookat(point) => pixel_at(point),
                // If the camera looks along a direction, the scene gives no point at which a
                // pixel's width can be computed. So the nearest object's center is used.
                View::Direction(_) => {
                    let pixels = scene.objects.iter().filter_map(pixel_of);
                    pixels.reduce(f64::min).unwrap_or(projection.pitch)
                }
            },
        };
        let step = |(field, value): (&&'static str, Value)| match (*field, value) {
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
            _ => Vec::new(),
        };
        let steps = self.fields.iter().zip(self.values(scene)).flat_map(step);
        steps.map(|step| pixels * step).collect()
    }

    /// Returns whether the parameter is a colour. A change of colour does not move anything in the
    /// picture.
    pub fn is_color(&self) -> bool {
        matches!(self.fields[0], "color" | "colors" | "background")
    }
}

/// Returns 8 or −8, whichever keeps a colour channel between 0 and 255 when it is added.
fn inward(channel: f64) -> f64 {
    if channel < 128.0 { 8.0 } else { -8.0 }
}
