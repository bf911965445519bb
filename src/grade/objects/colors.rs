//! Objects of a wrong colour.

use glam::DVec3;

use super::{ENOUGH, OBJECTS, called};
use crate::{
    color::{Color, linear_to_srgb, srgb_to_linear},
    film::Film,
    grade::{Idea, Make},
    scene::{Scene, Shape},
};

/// A colour is another one if it is off by more than this, in steps of 8-bit sRGB; nearer is the same.
const NEAR: f64 = 2.5;

/// Other colours: those that the picture shows where the exact one shows an object alone; last of all of them at once, if there are
/// several.
pub fn colors(a: &Film, exact: &Film, scene: &Scene) -> Vec<Idea> {
    let mut ideas = Vec::new();
    let mut all = scene.clone();
    let mut messages = Vec::new();
    let mut change = |wanted: Color, what: String, set: &dyn Fn(&mut Scene, Color)| {
        let Some(shown) = shown(a, exact, wanted) else {
            return;
        };
        let mut other = scene.clone();
        set(&mut other, shown);
        set(&mut all, shown);
        let message = format!("{what} has the colour {shown} instead of {wanted}");
        messages.push(message.clone());
        ideas.push(Idea {
            mistake: "color",
            message,
            help: "colours are sRGB: the number of a channel, 0 to 255, comes out as it is where nothing else is seen".to_owned(),
            make: Make::Scene(Box::new(other)),
        });
    };
    change(
        scene.image.background,
        "the background".to_owned(),
        &|scene, color| scene.image.background = color,
    );
    for (index, object) in scene.objects.iter().enumerate().take(OBJECTS) {
        let mut shape = object.shape;
        for (slot, wanted) in color(&mut shape).into_iter().enumerate() {
            let what = match (slot, object.shape) {
                (0, Shape::Checkerboard(_)) => {
                    format!("the first kind of squares of {}", called(scene, index))
                }
                (_, Shape::Checkerboard(_)) => {
                    format!("the second kind of squares of {}", called(scene, index))
                }
                _ => called(scene, index),
            };
            change(*wanted, what, &|scene, shown| {
                *color(&mut scene.objects[index].shape)[slot] = shown;
            });
        }
    }
    if messages.len() > 1 {
        ideas.push(Idea {
            mistake: "colors",
            message: messages.join("; "),
            help: "are the colours decoded once and encoded once, and are their channels in the order red, green, blue?".to_owned(),
            make: Make::Scene(Box::new(all)),
        });
    }
    ideas
}

/// What a shape has one of, in its place in the shape; none of a checkerboard, which has two.
pub(super) fn color(shape: &mut Shape) -> Vec<&mut Color> {
    match shape {
        Shape::Sphere(sphere) => vec![&mut sphere.color],
        Shape::Triangle(triangle) => vec![&mut triangle.color],
        Shape::Box(cuboid) => vec![&mut cuboid.color],
        Shape::Checkerboard(board) => board.colors.iter_mut().collect(),
    }
}

/// The colour that a picture shows where the exact one shows this one alone, if it is one colour and another.
fn shown(a: &Film, exact: &Film, wanted: Color) -> Option<Color> {
    let light = wanted.to_linear();
    let seen = a.pixels().iter().zip(exact.pixels());
    let mut found: Vec<_> = seen
        .filter(|(_, q)| **q == light)
        .map(|(p, _)| *p)
        .collect();
    if (found.len() as u64) < ENOUGH {
        return None;
    }
    let middle = found.len() / 2;
    let median = [0, 1, 2].map(|i| {
        found.select_nth_unstable_by(middle, |p, q| p[i].total_cmp(&q[i]));
        found[middle][i]
    });
    let near = Near::to(&median);
    let near = found.iter().filter(|p| near.holds(p)).count();
    let is_one = near * 10 >= found.len() * 8;
    let srgb = median.map(|light| (255.0 * linear_to_srgb(light)).clamp(0.0, 255.0));
    (is_one && !Near::to(&light).holds(&median)).then_some(Color { srgb })
}

/// The light of each channel that is near some colour.
pub(super) struct Near([[f64; 2]; 3]);

impl Near {
    pub(super) fn to(light: &[f64; 3]) -> Self {
        let steps = NEAR / 255.0;
        Self(light.map(|light| {
            let encoded = linear_to_srgb(light);
            [encoded - steps, encoded + steps].map(srgb_to_linear)
        }))
    }

    pub(super) fn holds(&self, pixel: &[f64; 3]) -> bool {
        let pairs = self.0.iter().zip(pixel);
        pairs
            .into_iter()
            .all(|([low, high], light)| low < light && light < high)
    }
}

/// The share of the squared difference in pixels that have a colour in either picture.
pub(super) fn share(a: &Film, exact: &Film, near: &Near) -> f64 {
    let (mut own, mut all) = (0.0, 0.0);
    for (p, q) in a.pixels().iter().zip(exact.pixels()) {
        if p != q {
            let square = (DVec3::from(*p) - DVec3::from(*q)).length_squared();
            all += square;
            if near.holds(p) || near.holds(q) {
                own += square;
            }
        }
    }
    own / all
}
