//! The numbers of a scene, each of which may be another one in somebody's picture, and writes itself as a `--set`.
//!
//! In: a scene. Out: for each field of the language's table that the scene uses its numbers, and the scene with others in their place.

use std::sync::Arc;

use glam::DVec3;

use super::axes::Axes;
use crate::{
    color::Color,
    math::Angle,
    scene::{Lens, Outline, Scene, Shape, View},
    schema::{self, Value},
};

/// Whose field it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Owner {
    /// The image's.
    Image,
    /// The camera's.
    Camera,
    /// An object's.
    Object(usize),
}

/// One field, or the camera's eye and what it looks at together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Parameter {
    /// Whose it is.
    pub owner: Owner,
    /// Its fields.
    pub fields: Vec<&'static str>,
}

/// Those of a scene that can be told from a picture: up turns it as roll does, and view_height sizes it as d does, so these two are left to them. A plane that is not
/// there may be anywhere that nothing is.
pub fn fitted(scene: &Scene) -> Vec<Parameter> {
    let is_told = |parameter: &Parameter| match parameter.fields[0] {
        "up" | "view_height" => false,
        "near" => scene.camera.near > 0.0,
        _ => true,
    };
    all(scene).into_iter().filter(is_told).collect()
}

/// All of a scene.
fn all(scene: &Scene) -> Vec<Parameter> {
    let owners = [Owner::Image, Owner::Camera].into_iter();
    let owners = owners.chain((0..scene.objects.len()).map(Owner::Object));
    let mut found: Vec<Parameter> = owners
        .flat_map(|owner| {
            let fields = schema::block(owner.kind(scene)).map_or(&[][..], |block| block.fields);
            let used = fields
                .iter()
                .filter(move |field| value(scene, owner, field.name).is_some());
            used.map(move |field| Parameter {
                owner,
                fields: vec![field.name],
            })
        })
        .collect();
    if let View::Lookat(_) = scene.camera.view {
        found.push(Parameter {
            owner: Owner::Camera,
            fields: vec!["eye", "lookat"],
        });
    }
    found
}

/// The `--set` arguments that make one scene of another, where these say it.
pub fn arguments(from: &Scene, to: &Scene) -> Vec<String> {
    if from.objects.len() != to.objects.len() {
        return Vec::new();
    }
    // There is no value for a plane that is not there; nothing that is farther is seen.
    let is_unlimited = from.camera.far.is_some() && to.camera.far.is_none();
    let far = is_unlimited.then(|| "camera.far=1e9".to_owned());
    let all = all(to)
        .into_iter()
        .filter(|parameter| parameter.fields.len() == 1);
    all.filter(|parameter| parameter.values(from) != parameter.values(to))
        .flat_map(|parameter| {
            let beside = match parameter.fields[0] {
                // Either takes the place of min and max, and would leave the other at its default.
                "center" if parameter.is_box(to) => Some("size"),
                "size" => Some("center"),
                _ => None,
            };
            let mut arguments = parameter.arguments(to);
            if let Some(other) = beside {
                arguments.extend(
                    Parameter {
                        owner: parameter.owner,
                        fields: vec![other],
                    }
                    .arguments(to),
                );
            }
            arguments
        })
        .chain(far)
        .fold(Vec::new(), |mut all, argument| {
            if !all.contains(&argument) {
                all.push(argument);
            }
            all
        })
}

impl Owner {
    fn kind(self, scene: &Scene) -> &'static str {
        match self {
            Self::Image => "image",
            Self::Camera => "camera",
            Self::Object(index) => scene.objects[index].shape.kind(),
        }
    }

    /// What it is called.
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
    fn is_box(&self, scene: &Scene) -> bool {
        self.owner.kind(scene) == "box"
    }

    /// Its values.
    pub fn values(&self, scene: &Scene) -> Vec<Value> {
        self.fields
            .iter()
            .filter_map(|field| value(scene, self.owner, field))
            .collect()
    }

    /// Its numbers: angles in degrees, colours from 0 to 255.
    pub fn numbers(&self, scene: &Scene) -> Vec<f64> {
        let numbers = |value: Value| match value {
            Value::Number(number) => vec![number],
            Value::Angle(angle) => vec![angle.degrees + angle.radians.to_degrees()],
            Value::Vector(vector) => vector.to_array().to_vec(),
            Value::Color(color) => color.srgb.to_vec(),
            Value::Colors(colors) => colors.iter().flat_map(|color| color.srgb).collect(),
            Value::Method(_) => Vec::new(),
        };
        self.values(scene).into_iter().flat_map(numbers).collect()
    }

    /// A scene with other numbers, if they can be.
    pub fn put(&self, scene: &Scene, numbers: &[f64]) -> Option<Scene> {
        let mut changed = scene.clone();
        let mut rest = numbers;
        for field in &self.fields {
            let before = value(scene, self.owner, field)?;
            let (own, others) = rest.split_at(match before {
                Value::Vector(_) | Value::Color(_) => 3,
                Value::Colors(_) => 6,
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
                Value::Angle(_) => Value::Angle(Angle::from_degrees(own[0])),
                _ => Value::Number(own[0]),
            };
            set(&mut changed, self.owner, field, after)?;
        }
        is_possible(&changed, self.owner).then_some(changed)
    }

    /// The arguments that set it to what it is in a scene; none where its object has no name.
    pub fn arguments(&self, scene: &Scene) -> Vec<String> {
        let owner = match self.owner {
            Owner::Image => "image",
            Owner::Camera => "camera",
            Owner::Object(index) => match &scene.objects[index].name {
                Some(name) => name,
                None => return Vec::new(),
            },
        };
        let written = |value: Value| match value {
            Value::Number(number) => format!("{number}"),
            Value::Angle(angle) => format!("{}deg", angle.degrees + angle.radians.to_degrees()),
            Value::Vector(v) => format!("({}, {}, {})", v.x, v.y, v.z),
            other => other.to_string(),
        };
        let values = self.fields.iter().zip(self.values(scene));
        values
            .map(|(field, value)| format!("{owner}.{field}={}", written(value)))
            .collect()
    }

    /// By how much each number changes the picture by about a pixel, or a colour by a few steps.
    pub fn steps(&self, scene: &Scene) -> Vec<f64> {
        let axes = Axes::new(&scene.camera, &scene.image);
        let wide = f64::from(scene.image.width.max(scene.image.height));
        let pixel = match self.owner {
            Owner::Object(index) => match middle(&scene.objects[index].shape) {
                Some(middle) => axes.pixel_at(middle),
                None => 0.0,
            },
            _ => match scene.camera.view {
                View::Lookat(point) => axes.pixel_at(point),
                // That of the nearest object.
                View::Direction(_) => {
                    let shapes = scene.objects.iter().map(|object| &object.shape);
                    let middles = shapes.filter_map(middle);
                    let pixels = middles.map(|middle| axes.pixel_at(middle));
                    let nearest = pixels.fold(f64::INFINITY, f64::min);
                    if nearest.is_finite() {
                        nearest
                    } else {
                        1.0 / axes.focal
                    }
                }
            },
        };
        let step = |(field, value): (&&'static str, Value)| match (*field, value) {
            (_, Value::Color(color)) => color.srgb.map(inward).to_vec(),
            (_, Value::Colors(colors)) => colors.map(|color| color.srgb.map(inward)).concat(),
            ("normal", Value::Vector(normal)) => vec![0.03 * normal.length(); 3],
            ("direction", Value::Vector(direction)) => vec![direction.length() / axes.focal; 3],
            (_, Value::Vector(_)) => vec![pixel; 3],
            ("fov" | "hfov", Value::Angle(angle)) => {
                vec![2.0 / wide * (angle.degrees + angle.radians.to_degrees())]
            }
            (_, Value::Angle(_)) => vec![(2.0f64 / wide).to_degrees()],
            ("radius", _) => vec![pixel],
            ("y", Value::Number(y)) => vec![2.0 / wide * (scene.camera.eye.y - y).abs().max(1e-3)],
            (_, Value::Number(number)) => vec![2.0 / wide * number.abs()],
            (_, Value::Method(_)) => Vec::new(),
        };
        self.fields
            .iter()
            .zip(self.values(scene))
            .flat_map(step)
            .collect()
    }

    /// Whether it moves one object that has bounds.
    pub fn is_local(&self, scene: &Scene) -> bool {
        let is_bounded = |index: usize| middle(&scene.objects[index].shape).is_some();
        matches!(self.owner, Owner::Object(index) if is_bounded(index))
    }

    /// Whether it is a colour, which moves nothing.
    pub fn is_color(&self) -> bool {
        matches!(self.fields[0], "color" | "colors" | "background")
    }
}

/// A few steps of a channel that stay between 0 and 255.
fn inward(channel: f64) -> f64 {
    if channel < 128.0 { 8.0 } else { -8.0 }
}

/// The middle of a shape that has one.
pub fn middle(shape: &Shape) -> Option<DVec3> {
    match shape {
        Shape::Sphere(sphere) => Some(sphere.center),
        Shape::Triangle(triangle) => Some(triangle.outline.centroid()),
        Shape::Box(cuboid) => Some(cuboid.min.midpoint(cuboid.max)),
        Shape::Checkerboard(_) => None,
    }
}

/// A field's value, if the scene uses it: of alternatives the one that it is written in.
fn value(scene: &Scene, owner: Owner, field: &str) -> Option<Value> {
    let camera = &scene.camera;
    let index = match owner {
        Owner::Image => {
            return (field == "background").then_some(Value::Color(scene.image.background));
        }
        Owner::Camera => {
            return match (field, camera.view, camera.lens) {
                ("eye", ..) => Some(Value::Vector(camera.eye)),
                ("lookat", View::Lookat(point), _) => Some(Value::Vector(point)),
                ("direction", View::Direction(direction), _) => Some(Value::Vector(direction)),
                ("roll", ..) => Some(Value::Angle(camera.roll)),
                ("up", ..) => Some(Value::Vector(camera.up)),
                ("view_height", _, Lens::Distance(_)) => Some(Value::Number(camera.view_height)),
                ("d", _, Lens::Distance(d)) => Some(Value::Number(d)),
                ("fov", _, Lens::Fov(angle)) | ("hfov", _, Lens::HorizontalFov(angle)) => {
                    Some(Value::Angle(angle))
                }
                ("near", ..) => Some(Value::Number(camera.near)),
                ("far", ..) => camera.far.map(Value::Number),
                _ => None,
            };
        }
        Owner::Object(index) => index,
    };
    match (scene.objects[index].shape, field) {
        (Shape::Sphere(sphere), "center") => Some(Value::Vector(sphere.center)),
        (Shape::Sphere(sphere), "radius") => Some(Value::Number(sphere.radius)),
        (Shape::Sphere(sphere), "color") => Some(Value::Color(sphere.color)),
        (Shape::Triangle(triangle), "color") => Some(Value::Color(triangle.color)),
        (Shape::Triangle(triangle), _) => match (triangle.outline, field) {
            (Outline::Vertices([vertex, _, _]), "v0")
            | (Outline::Vertices([_, vertex, _]), "v1")
            | (Outline::Vertices([_, _, vertex]), "v2") => Some(Value::Vector(vertex)),
            (Outline::Centered(triangle), "centroid") => Some(Value::Vector(triangle.centroid)),
            (Outline::Centered(triangle), "normal") => Some(Value::Vector(triangle.normal)),
            (Outline::Centered(triangle), "sides") => Some(Value::Vector(triangle.sides)),
            (Outline::Centered(triangle), "spin") => Some(Value::Angle(triangle.spin)),
            _ => None,
        },
        (Shape::Box(cuboid), "center") => {
            Some(Value::Vector(tidy(cuboid.min.midpoint(cuboid.max))))
        }
        (Shape::Box(cuboid), "size") => Some(Value::Vector(tidy(cuboid.max - cuboid.min))),
        (Shape::Box(cuboid), "color") => Some(Value::Color(cuboid.color)),
        (Shape::Checkerboard(board), "y") => Some(Value::Number(board.y)),
        (Shape::Checkerboard(board), "square") => Some(Value::Number(board.square)),
        (Shape::Checkerboard(board), "colors") => Some(Value::Colors(board.colors)),
        _ => None,
    }
}

/// Without what the rounding of two corners leaves behind the fifteenth digit.
fn tidy(v: DVec3) -> DVec3 {
    DVec3::from_array(
        v.to_array()
            .map(|x| format!("{x:.14e}").parse().unwrap_or(x)),
    )
}

fn set(scene: &mut Scene, owner: Owner, field: &str, value: Value) -> Option<()> {
    let camera = &mut scene.camera;
    let index = match (owner, field, value) {
        (Owner::Object(index), ..) => index,
        (Owner::Image, "background", Value::Color(color)) => {
            scene.image.background = color;
            return Some(());
        }
        (Owner::Camera, _, value) => {
            match (field, value) {
                ("eye", Value::Vector(eye)) => camera.eye = eye,
                ("lookat", Value::Vector(point)) => camera.view = View::Lookat(point),
                ("direction", Value::Vector(direction)) => camera.view = View::Direction(direction),
                ("roll", Value::Angle(roll)) => camera.roll = roll,
                ("d", Value::Number(d)) => camera.lens = Lens::Distance(d),
                ("fov", Value::Angle(angle)) => camera.lens = Lens::Fov(angle),
                ("hfov", Value::Angle(angle)) => camera.lens = Lens::HorizontalFov(angle),
                ("up", Value::Vector(up)) => camera.up = up,
                ("view_height", Value::Number(height)) => camera.view_height = height,
                ("near", Value::Number(near)) => camera.near = near,
                ("far", Value::Number(far)) => camera.far = Some(far),
                _ => return None,
            }
            return Some(());
        }
        _ => return None,
    };
    let object = &mut Arc::make_mut(&mut scene.objects)[index];
    match (&mut object.shape, field, value) {
        (Shape::Sphere(sphere), "center", Value::Vector(center)) => sphere.center = center,
        (Shape::Sphere(sphere), "radius", Value::Number(radius)) => sphere.radius = radius,
        (Shape::Sphere(sphere), "color", Value::Color(color)) => sphere.color = color,
        (Shape::Triangle(triangle), "color", Value::Color(color)) => triangle.color = color,
        (Shape::Triangle(triangle), _, value) => match (&mut triangle.outline, field, value) {
            (Outline::Vertices(vertices), "v0", Value::Vector(vertex)) => vertices[0] = vertex,
            (Outline::Vertices(vertices), "v1", Value::Vector(vertex)) => vertices[1] = vertex,
            (Outline::Vertices(vertices), "v2", Value::Vector(vertex)) => vertices[2] = vertex,
            (Outline::Centered(own), "centroid", Value::Vector(centroid)) => {
                own.centroid = centroid
            }
            (Outline::Centered(own), "normal", Value::Vector(normal)) => own.normal = normal,
            (Outline::Centered(own), "sides", Value::Vector(sides)) => own.sides = sides,
            (Outline::Centered(own), "spin", Value::Angle(spin)) => own.spin = spin,
            _ => return None,
        },
        (Shape::Box(cuboid), "center", Value::Vector(center)) => {
            let half = (cuboid.max - cuboid.min) / 2.0;
            (cuboid.min, cuboid.max) = (center - half, center + half);
        }
        (Shape::Box(cuboid), "size", Value::Vector(size)) => {
            let center = tidy(cuboid.min.midpoint(cuboid.max));
            (cuboid.min, cuboid.max) = (center - size / 2.0, center + size / 2.0);
        }
        (Shape::Box(cuboid), "color", Value::Color(color)) => cuboid.color = color,
        (Shape::Checkerboard(board), "y", Value::Number(y)) => board.y = y,
        (Shape::Checkerboard(board), "square", Value::Number(square)) => board.square = square,
        (Shape::Checkerboard(board), "colors", Value::Colors(colors)) => board.colors = colors,
        _ => return None,
    }
    Some(())
}

/// Whether the language's conditions hold for a block.
fn is_possible(scene: &Scene, owner: Owner) -> bool {
    let camera = &scene.camera;
    match owner {
        Owner::Image => true,
        Owner::Camera => {
            let looks = match camera.view {
                View::Lookat(point) => point != camera.eye && point.is_finite(),
                View::Direction(direction) => direction != DVec3::ZERO && direction.is_finite(),
            };
            let sees = match camera.lens {
                Lens::Distance(d) => d > 0.0 && d.is_finite(),
                Lens::Fov(angle) | Lens::HorizontalFov(angle) => {
                    let degrees = angle.degrees + angle.radians.to_degrees();
                    degrees > 0.0 && degrees < 180.0
                }
            };
            looks
                && sees
                && camera.eye.is_finite()
                && camera.near >= 0.0
                && camera.far.is_none_or(|far| far > camera.near)
        }
        Owner::Object(index) => match scene.objects[index].shape {
            Shape::Sphere(sphere) => {
                sphere.radius > 0.0 && sphere.radius.is_finite() && sphere.center.is_finite()
            }
            Shape::Triangle(triangle) => match triangle.outline {
                Outline::Vertices([a, b, c]) => (b - a).cross(c - a).length_squared() > 0.0,
                Outline::Centered(own) => {
                    let [a, b, c] = own.sides.to_array();
                    let is_triangle = a < b + c && b < a + c && c < a + b;
                    own.normal.length_squared() > 0.0 && is_triangle && own.centroid.is_finite()
                }
            },
            Shape::Box(cuboid) => {
                cuboid.min.cmplt(cuboid.max).all()
                    && cuboid.min.is_finite()
                    && cuboid.max.is_finite()
            }
            Shape::Checkerboard(board) => {
                board.square > 0.0 && board.square.is_finite() && board.y.is_finite()
            }
        },
    }
}
