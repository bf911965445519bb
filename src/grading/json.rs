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
            ("verdict", json!(self.kind.word())),
            ("line", json!(self.line())),
            ("samples_per_pixel", json!(self.samples)),
            ("mistakes", json_of(&self.mistakes)),
            ("guesses", json_of(&self.guesses)),
            ("objects", objects.collect()),
        ];
        let rest = self.rest.map(|rest| ("rest", json!(rest)));
        let fields = fields.into_iter().chain(rest);
        fields
            .chain([("limited", json!(self.is_cut))])
            .map(|(name, value)| (name.to_owned(), value))
            .collect()
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
