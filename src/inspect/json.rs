//! Writes the output of `pinhole inspect` as a JSON object.

use std::io::{self, Write};

use serde_json::{Map, Value, json};

use super::{AXES, Inspection, ObjectFacts};
use crate::{
    numbers,
    seen::{LISTED, MIN_AREA, Visibility},
    tracer::vertices,
};

impl Inspection {
    /// Writes the JSON object and a line feed. Scene objects are written one by one, because a
    /// million of them would take more than a gigabyte as JSON values in memory.
    ///
    /// # Errors
    ///
    /// Returns an error if `out` cannot be written to.
    pub fn write_json(&self, mut out: &mut dyn Write) -> io::Result<()> {
        for (key, value) in self.facts() {
            let sign = if key == "image" { '{' } else { ',' };
            write!(out, "{sign}\"{key}\":{value}")?;
        }
        write!(out, ",\"objects\":[")?;
        for (index, object) in self.objects.iter().enumerate() {
            if index > 0 {
                write!(out, ",")?;
            }
            serde_json::to_writer(&mut out, &self.object(index, object))?;
        }
        write!(out, "],\"seen_exactly\":{}", self.is_exact)?;
        if let Some(rest) = self.rest() {
            let facts = json!({
                "objects": rest.objects,
                "seen": rest.seen,
                "pixels": numbers::rounded(rest.pixels, MIN_AREA),
                "outside": rest.outside,
            });
            write!(out, ",\"rest\":{facts}")?;
        }
        writeln!(out, "}}")
    }

    /// Returns the JSON object, without the objects after the first [`LISTED`].
    #[doc(hidden)]
    pub fn to_json(&self) -> Value {
        let facts = self.facts().into_iter();
        let mut facts: Map<_, _> = facts.map(|(key, value)| (key.to_owned(), value)).collect();
        let objects = self.objects.iter().enumerate().take(LISTED);
        let objects = objects.map(|(index, object)| self.object(index, object));
        facts.insert("objects".to_owned(), objects.collect());
        facts.insert("seen_exactly".to_owned(), self.is_exact.into());
        facts.into()
    }

    /// Returns the members of the JSON object, except the list of the scene's objects.
    fn facts(&self) -> [(&'static str, Value); 4] {
        let camera = &self.camera;
        let is_inside = |point: [f64; 2]| {
            let sides = self.size.map(f64::from);
            (0..2).all(|i| (0.0..=sides[i]).contains(&point[i]))
        };
        let point = |(axis, pixel): (&&str, &Option<[f64; 2]>)| {
            let inside = pixel.is_some_and(is_inside);
            json!({ "axis": axis, "pixel": pixel, "inside": inside })
        };
        let points = AXES.iter().zip(&self.vanishing_points).map(point);
        let image = json!({ "width": self.size[0], "height": self.size[1] });
        let camera = json!({
            "eye": camera.eye.to_array(),
            "u": camera.u.to_array(),
            "v": camera.v.to_array(),
            "w": camera.w.to_array(),
            "d": camera.d,
            "view_height": camera.view_height,
            "fov_deg": camera.fov_deg,
            "hfov_deg": camera.hfov_deg,
            "near": camera.near,
            "far": camera.far,
            "looks": camera.looks,
        });
        let sampler = json!({
            "method": self.method.name(),
            "per_pixel": self.per_pixel,
            "total": self.total,
            "seed": self.seed,
        });
        [
            ("image", image),
            ("camera", camera),
            ("sampler", sampler),
            ("vanishing_points", points.collect()),
        ]
    }

    fn object(&self, index: usize, object: &ObjectFacts) -> Value {
        let mut facts = json!({
            "index": index,
            "kind": object.shape.kind(),
            "name": object.name,
            "line": object.line,
        });
        if !object.indices.is_empty() {
            facts["indices"] = json!(object.indices);
        }
        for (key, value) in object.shape.facts(vertices) {
            facts[key] = value;
        }
        if index < LISTED {
            facts["seen"] = self.seen_facts(object.seen);
        }
        facts
    }

    fn seen_facts(&self, seen: Visibility) -> Value {
        match seen {
            Visibility::Part(around, pixels) => {
                let corners = [around.x, around.y, around.width, around.height];
                json!({ "box": corners, "pixels": numbers::rounded(pixels, MIN_AREA) })
            }
            Visibility::Outside(place) => {
                json!({ "box": null, "pixels": 0.0, "outside": place.words() })
            }
            Visibility::HiddenBy(other) => {
                let name = self.objects.get(other).and_then(|it| it.name.as_deref());
                json!({ "box": null, "pixels": 0.0, "hidden_by": name, "hidden_by_index": other })
            }
            Visibility::Nothing => json!({ "box": null, "pixels": 0.0 }),
        }
    }
}
