//! Writes a comparison of two pictures, and the verdict on one of them, as JSON for programs.

use serde_json::{Map, Value, json};

use super::verdict::{NamedMistake, Verdict};
use crate::film::{CHANNELS, Comparison};

/// Returns the JSON fields for a comparison of two pictures with the sizes `sizes`. If a verdict on
/// the first picture is given, adds its fields. `found` is the comparison, or `None` if the sizes
/// differ. `tolerance` is in steps of 8-bit sRGB.
#[doc(hidden)]
pub fn figures(
    sizes: [[u32; 2]; 2],
    found: Option<&Comparison>,
    tolerance: f64,
    verdict: Option<&Verdict>,
) -> Map<String, Value> {
    let largest = found.map(|found| {
        let largest = found.largest;
        json!({
            "error": plain(largest.steps),
            "x": largest.x,
            "y": largest.y,
            "channel": CHANNELS[largest.channel],
            "a": plain(largest.a),
            "b": plain(largest.b),
        })
    });
    let beyond = found.map(|found| json!({ "pixels": found.beyond, "share": found.share() }));
    let figures = [
        ("width", json!(sizes[0][0])),
        ("height", json!(sizes[0][1])),
        ("size_b", json!(sizes[1])),
        ("rmse", json!(found.map(|found| found.rmse))),
        ("largest", json!(largest)),
        ("beyond", json!(beyond)),
        ("undecided", json!(found.map(|found| found.undecided))),
        ("tolerance", json!(tolerance)),
        ("equal", json!(found.is_some_and(Comparison::is_equal))),
    ];
    let figures = figures.map(|(name, value)| (name.to_owned(), value));
    figures
        .into_iter()
        .chain(verdict.map(Verdict::to_json).unwrap_or_default())
        .collect()
}

/// Rounds `steps`, a difference in steps of 8-bit sRGB, to 9 decimals. This removes the rounding
/// errors that arise when a byte is decoded to light and encoded again.
fn plain(steps: f64) -> f64 {
    (1e9 * steps).round() / 1e9
}

impl Verdict {
    /// Returns the verdict as JSON fields, for programs.
    #[doc(hidden)]
    pub fn to_json(&self) -> Map<String, Value> {
        let objects = self.objects.iter().map(|object| {
            json!({ "index": object.index, "name": object.name, "right": object.is_right, "off": object.off })
        });
        let fields = [
            ("verdict", Some(json!(self.kind.word()))),
            ("line", Some(json!(self.line()))),
            ("samples_per_pixel", Some(json!(self.samples))),
            ("mistakes", Some(json_of(&self.mistakes))),
            ("guesses", Some(json_of(&self.guesses))),
            ("objects", Some(objects.collect())),
            ("rest", self.rest.map(Value::from)),
            ("limited", Some(json!(self.is_cut))),
        ];
        let present = |(name, value): (&str, Option<Value>)| Some((name.to_owned(), value?));
        fields.into_iter().filter_map(present).collect()
    }
}

fn json_of(mistakes: &[NamedMistake]) -> Value {
    let fields = |mistake: &NamedMistake| {
        json!({
            "id": mistake.id,
            "message": mistake.message,
            "help": mistake.help,
            "set": mistake.set,
            "explains": mistake.explains,
        })
    };
    mistakes.iter().map(fields).collect()
}
