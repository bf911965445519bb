//! Objects that are drawn in a wrong order, whatever is nearer.
//!
//! Of each object alone there is an exact picture, and one of how much of each pixel it covers. Laid one over the other (Porter and Duff,
//! Compositing digital images, 1984) they are what such a program makes, but for pixels in which the edges of several objects meet.

use glam::DVec3;

use super::{Idea, Make, exact, noise::with_colors};
use crate::{
    color::Color,
    film::Film,
    render::{Control, RenderError},
    scene::{Object, Scene, Shape},
};

/// Which object of several is seen.
#[derive(Clone, Copy, Debug)]
pub enum Order {
    /// The last one in the file.
    Last,
    /// The first one.
    First,
    /// The farthest one: the least distance is looked for by the wrong comparison. Objects are as far as their middles, and boards farther.
    Farthest,
}

/// Of a scene with more objects this is not thought of: each takes two pictures.
const MOST: usize = 48;

/// All of a scene with several objects.
pub fn ideas(scene: &Scene) -> Vec<Idea> {
    if !(2..=MOST).contains(&scene.objects.len()) {
        return Vec::new();
    }
    let idea = |order, message: &str, help: &str| Idea {
        mistake: "depth_ignored",
        message: message.to_owned(),
        help: help.to_owned(),
        make: Make::Ordered(order),
    };
    vec![
        idea(
            Order::Last,
            "of several objects that a ray hits the last one in the file is seen, though another one may be nearer",
            "keep the least t > 0 of all hits of a ray, and replace it only by a lesser one",
        ),
        idea(
            Order::First,
            "of several objects that a ray hits the first one in the file is seen, though another one may be nearer",
            "do not stop at the first object that is hit: ask all of them, and keep the least t > 0",
        ),
        idea(
            Order::Farthest,
            "of several objects that a ray hits the farthest one is seen, not the nearest",
            "keep a hit if its t is less than the least one so far, which starts at infinity",
        ),
    ]
}

/// The picture of a scene whose objects are drawn in an order.
pub fn picture(scene: &Scene, order: Order, control: &Control) -> Result<Film, RenderError> {
    let [width, height] = [scene.image.width, scene.image.height];
    let background = scene.image.background.to_linear();
    let mut film = Film::from_fn(width, height, |_, _| background)?;
    let mut objects: Vec<&Object> = scene.objects.iter().collect();
    match order {
        Order::Last => {}
        Order::First => objects.reverse(),
        Order::Farthest => {
            let squared_distance = |object: &Object| {
                let middle = match object.shape {
                    Shape::Sphere(sphere) => sphere.center,
                    Shape::Triangle(triangle) => triangle.outline.centroid(),
                    Shape::Box(cuboid) => cuboid.min.midpoint(cuboid.max),
                    Shape::Checkerboard(_) => return f64::INFINITY,
                };
                middle.distance_squared(scene.camera.eye)
            };
            objects.sort_by(|one, other| squared_distance(one).total_cmp(&squared_distance(other)));
        }
    }
    for object in objects {
        let alone = |scene: &Scene| {
            let mut scene = scene.clone();
            scene.image.background = gray(0.0);
            exact(&scene, control)
        };
        let mut own = Scene {
            objects: Vec::new(),
            ..scene.clone()
        };
        own.objects.push(object.clone());
        let (light, cover) = (alone(&own)?, alone(&with_colors(&own, |_| gray(255.0)))?);
        film = Film::from_fn(width, height, |x, y| {
            let [below, light, cover] =
                [&film, &light, &cover].map(|film| DVec3::from(film.pixel(x, y)));
            (below * (1.0 - cover) + light).to_array()
        })?;
    }
    Ok(film)
}

fn gray(channel: f64) -> Color {
    Color { srgb: [channel; 3] }
}
