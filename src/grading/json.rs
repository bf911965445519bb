//! The verdict as JSON, for programs.

use serde_json::{Map, Value, json};

use super::verdict::{NamedMistake, Verdict};

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
