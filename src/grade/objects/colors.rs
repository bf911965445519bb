//! Objects of a wrong colour.

use std::collections::HashMap;

use glam::{DVec2, DVec3};

use super::{ENOUGH, TRIED, called};
use crate::{
    color::{Color, linear_to_srgb, srgb_to_linear},
    film::Film,
    grade::{Case, Idea, Make, level::sampled, noise::with_colors},
    render::RenderError,
    scene::{Scene, Shape},
};

/// A colour is another one if it is off by more than this, in steps of 8-bit sRGB; nearer is the same: both are rounded, and
/// a power in place of the curve makes light colours differ by two.
const NEAR: f64 = 2.5;

/// Other colours: those that the picture shows where the exact one shows an object alone; last of all of them at once, if there are
/// several.
pub fn colors(case: &Case) -> Result<Vec<Idea>, RenderError> {
    let scene: &Scene = &case.full.scene;
    let seen = Seen::new(case)?;
    let background = Near::to(&scene.image.background.to_linear());
    let mut ideas = Vec::new();
    let mut all = scene.clone();
    let mut messages = Vec::new();
    let mut room = TRIED;
    let mut owners = 0..;
    let mut change = |wanted: Color,
                      what: String,
                      set: &dyn Fn(&mut Scene, Color) -> Option<Shape>| {
        let shown = owners.next().and_then(|owner| seen.shown(owner, wanted));
        let Some(shown) = shown else { return };
        if background.holds(&shown.to_linear()) {
            // Where nothing is seen nothing has a colour.
            return;
        }
        let shape = set(&mut all, shown);
        let message = format!("{what} has the colour {shown} instead of {wanted}");
        messages.push(message.clone());
        // Where a colour alone cannot explain it, all of them together may.
        if shape.is_some_and(|shape| room == 0 || case.is_elsewhere(&shape)) {
            return;
        }
        room -= usize::from(shape.is_some());
        let mut other = scene.clone();
        set(&mut other, shown);
        let make = match shape {
            Some(_) => Make::Object(Box::new(other), Box::new([shape, None])),
            None => Make::Scene(Box::new(other)),
        };
        ideas.push(Idea {
            mistake: "color",
            message,
            help: "colours are sRGB: the number of a channel, 0 to 255, comes out as it is where nothing else is seen".to_owned(),
            make,
        });
    };
    change(
        scene.image.background,
        "the background".to_owned(),
        &|scene, color| {
            scene.image.background = color;
            None
        },
    );
    for (index, object) in scene.objects.iter().enumerate() {
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
                let shape = &mut scene.objects[index].shape;
                *color(shape)[slot] = shown;
                Some(*shape)
            });
        }
    }
    if messages.len() > 1 {
        ideas.push(Idea {
            mistake: "colors",
            message: listed(&messages),
            help: "are the colours decoded once and encoded once, and are their channels in the order red, green, blue?".to_owned(),
            make: Make::Scene(Box::new(all)),
        });
    }
    Ok(ideas)
}

/// The first few, and how many more there are.
fn listed(messages: &[String]) -> String {
    const LISTED: usize = 5;
    let (first, rest) = messages.split_at(messages.len().min(LISTED));
    let mut text = first.join("; ");
    if !rest.is_empty() {
        text += &format!(
            "; and {} more are another colour than they should be",
            rest.len()
        );
    }
    text
}

/// What a shape has one of, in its place in the shape; none of a checkerboard, which has two.
pub fn color(shape: &mut Shape) -> Vec<&mut Color> {
    match shape {
        Shape::Sphere(sphere) => vec![&mut sphere.color],
        Shape::Triangle(triangle) => vec![&mut triangle.color],
        Shape::Box(cuboid) => vec![&mut cuboid.color],
        Shape::Checkerboard(board) => board.colors.iter_mut().collect(),
    }
}

/// The colours that a picture shows where the exact one shows one colour alone, by the number of what has it there: the background's is 0,
/// and then come those of the objects. Objects that share a colour are told apart by what the middle of a pixel sees.
struct Seen(Vec<Vec<[f64; 3]>>);

impl Seen {
    fn new(case: &Case) -> Result<Self, RenderError> {
        let scene: &Scene = &case.full.scene;
        let mut colors = Vec::new();
        let numbered = with_colors(scene, |color| {
            let number = colors.len() as u32;
            colors.push(bits(color.to_linear()));
            number_as_color(number)
        });
        let owners = (0..).zip(&colors);
        let owners: HashMap<_, _> = owners
            .map(|(number, own)| {
                let shown = bits(number_as_color(number).to_linear());
                (shown, (number as usize, *own))
            })
            .collect();
        let middles = sampled(&numbered, DVec2::ZERO, &case.control)?;
        let mut seen = vec![Vec::new(); colors.len()];
        let pixels = case.full.a.pixels().iter().zip(case.full.exact.pixels());
        for ((p, q), middle) in pixels.zip(middles.pixels()) {
            if let Some((owner, own)) = owners.get(&bits(*middle))
                && *own == bits(*q)
            {
                seen[*owner].push(*p);
            }
        }
        Ok(Self(seen))
    }

    /// The colour that is shown in place of an owner's, if it is one colour and another.
    fn shown(&self, owner: usize, wanted: Color) -> Option<Color> {
        let light = wanted.to_linear();
        let mut found = self.0.get(owner)?.clone();
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
}

/// A colour for each number: its three lowest bytes.
fn number_as_color(number: u32) -> Color {
    let [_, srgb @ ..] = number.to_be_bytes();
    Color {
        srgb: srgb.map(f64::from),
    }
}

fn bits(light: [f64; 3]) -> [u64; 3] {
    light.map(f64::to_bits)
}

/// The light of each channel that is near some colour.
pub struct Near([[f64; 2]; 3]);

impl Near {
    pub fn to(light: &[f64; 3]) -> Self {
        let steps = NEAR / 255.0;
        Self(light.map(|light| {
            let encoded = linear_to_srgb(light);
            [encoded - steps, encoded + steps].map(srgb_to_linear)
        }))
    }

    pub fn holds(&self, pixel: &[f64; 3]) -> bool {
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
