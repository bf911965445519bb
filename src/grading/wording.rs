//! The words for a mistake: an identifier, a message with its numbers, and advice.

use super::hypotheses::{Mistake, Owner};
use crate::{
    color::{Color, linear_to_srgb},
    numbers::{short, significant},
    scene::Scene,
};

const FILTER: &str = "a pixel is the mean of light over its own square: its samples lie evenly in it, and nowhere else";

const SHIFT: &str = "if all pixels have the same few random samples, edges move by the mean of these: make new ones for each pixel, or spread them evenly";

impl Mistake {
    /// Returns the mistake's identifier, for programs.
    pub fn id(&self) -> &'static str {
        match self {
            Self::Row(row, _) => row.id,
            Self::Numbers(parameter, _) => match parameter.fields[..] {
                [field] => field,
                _ => "eye_and_lookat",
            },
            Self::Patch(..) => "object_extra",
            Self::Filter(width) if *width < 1.0 => "samples_narrow",
            Self::Filter(_) => "wider_pixel",
            Self::Shift(_) => "samples_shifted",
            Self::ColorsExchanged(..) => "colors_exchanged",
        }
    }

    /// Returns advice on how to correct the mistake.
    pub fn help(&self, scene: &Scene) -> String {
        match self {
            Self::Row(row, _) => row.help.to_owned(),
            Self::Numbers(parameter, _) => match parameter.arguments(scene).join(" and ") {
                none if none.is_empty() && parameter.fields == ["far"] => {
                    "nothing is too far to be seen".to_owned()
                }
                none if none.is_empty() => "compare it with the scene".to_owned(),
                set => format!("the scene says {set}"),
            },
            Self::Patch(..) => "the scene has nothing of the kind there".to_owned(),
            Self::Filter(_) => FILTER.to_owned(),
            Self::Shift(_) => SHIFT.to_owned(),
            Self::ColorsExchanged(..) => {
                "an object keeps its own colour beside its shape".to_owned()
            }
        }
    }

    /// Returns a message that says what is wrong.
    pub fn message(&self, scene: &Scene) -> String {
        let (parameter, numbers) = match self {
            Self::Row(row, None) => return row.message.to_owned(),
            Self::Row(row, Some(object)) => {
                return format!("{} {}", Owner::Object(*object).name(scene), row.message);
            }
            Self::ColorsExchanged(one, other) => {
                let [one, other] = [*one, *other].map(|at| Owner::Object(at).name(scene));
                return format!("{one} and {other} have each other's colours");
            }
            Self::Shift(by) => {
                return format!(
                    "samples lie on average {} of a pixel's middle",
                    direction(*by)
                );
            }
            Self::Filter(width) if *width < 1.0 => {
                return format!(
                    "samples lie in the middle of each pixel alone, in a part about {width:.1} times as wide: the filter is too narrow"
                );
            }
            Self::Filter(width) => {
                return format!(
                    "pixels are seen as if through a pixel about {width:.1} times as wide: a wider filter, a blur, or a smaller picture that was enlarged"
                );
            }
            Self::Patch(light, [least, most]) => {
                let color = Color {
                    srgb: light.map(|light| 255.0 * linear_to_srgb(light)),
                };
                let [x, y] = [0, 1].map(|i| (least[i] + most[i]) / 2.0);
                return format!(
                    "there is something too many, of the colour {color}, around the pixel ({x:.0}, {y:.0})"
                );
            }
            Self::Numbers(parameter, numbers) => (parameter, numbers),
        };
        let name = parameter.owner_name(scene);
        let (before, after) = (parameter.numbers(scene), parameter.put(scene, numbers));
        let is = after.map_or_else(Vec::new, |after| parameter.values(&after));
        let ([field], [is], [should]) =
            (&parameter.fields[..], &is[..], &parameter.values(scene)[..])
        else {
            if let ["far"] = parameter.fields[..] {
                let far = short(numbers[0]);
                return format!("the camera has a far plane at {far}, and the scene has none");
            }
            let places: Vec<_> = is.iter().map(ToString::to_string).collect();
            return format!(
                "{name} stands and looks elsewhere: at {}",
                places.join(" towards ")
            );
        };
        let kind = match *field {
            "color" | "colors" | "background" => "wrong colour",
            "center" | "centroid" => {
                let by = numbers[1] - before[1];
                let is_same = [0, 2].iter().all(|&i| numbers[i] == before[i]);
                if is_same && by != 0.0 {
                    let way = if by > 0.0 { "high" } else { "low" };
                    return format!("{name} is {} too {way}", short(significant(by.abs(), 3)));
                }
                "wrong place"
            }
            "radius" | "size" | "sides" | "square" => "wrong size",
            _ => "wrong value",
        };
        let verb = match *field {
            "sides" | "colors" => "are",
            _ => "is",
        };
        format!("{name} has a {kind}: its {field} {verb} {is} instead of {should}")
    }
}

/// Describes a shift in words. `by` contains its parts to the right and down, in pixels.
fn direction(by: [f64; 2]) -> String {
    let words = [["left", "right"], ["above", "below"]];
    let one = |i: usize| {
        let word = words[i][usize::from(by[i] > 0.0)];
        (by[i] != 0.0).then(|| format!("{} pixels {word}", short(by[i].abs())))
    };
    let [x, y] = [one(0), one(1)];
    let both = [x, y].into_iter().flatten();
    both.collect::<Vec<_>>().join(" and ")
}
