//! The output of `probe` as JSON: one object.

use serde_json::{Value, json};

use super::Probe;

impl Probe {
    /// Returns the JSON object that `pinhole probe` prints.
    #[doc(hidden)]
    pub fn to_json(&self) -> Value {
        let hits = self.hits.iter().map(|(hit, object)| {
            let mut facts = json!({
                "object": object.name,
                "index": hit.object,
                "kind": object.shape.kind(),
                "t": hit.t,
                "depth": hit.depth,
                "point": hit.point.to_array(),
                "color": hit.color.to_string(),
                "visible": hit.visible,
            });
            if !object.indices.is_empty() {
                facts["indices"] = json!(object.indices);
            }
            facts
        });
        json!({
            "pixel": self.pixel.to_array(),
            "ray": {
                "origin": self.origin.to_array(),
                "direction": self.direction.to_array(),
            },
            "hits": hits.collect::<Vec<_>>(),
            "color": self.color.to_string(),
        })
    }
}
