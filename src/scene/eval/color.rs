//! Parses a colour from a text.

use std::{str::FromStr, sync::Arc};

use super::{Evaluator, Names};
use crate::{
    color::Color,
    diagnostic::{Diagnostic, Mistakes, Problems},
    scene::error::error,
    schema::{Type, Value},
    source::{Source, SourceId, Sources, Span},
    syntax,
};

/// Reads a colour as the language writes it: `olive`, `#fa0`, `#ffaa00` or `rgb(255, 170, 0)`.
impl FromStr for Color {
    type Err = Mistakes;

    fn from_str(text: &str) -> Result<Self, Mistakes> {
        let sources = Sources::new(Source::from_text("colour", text));
        color(&sources).map_err(|problems| Mistakes::new(Arc::new(sources), problems))
    }
}

/// Parses the text of `sources` as a colour. Returns its problems if it has any.
fn color(sources: &Sources) -> Result<Color, Vec<Diagnostic>> {
    let (tree, mut found) = syntax::parse_value(&sources.file, SourceId::File, 0);
    let (names, mut problems) = (Names::default(), Problems::default());
    let mut evaluator = Evaluator {
        sources,
        names: &names,
        problems: &mut problems,
    };
    let value = evaluator.value(&tree, Some(Type::Color));
    found.extend(Vec::from(problems));
    found.extend(Vec::from(names.problems.take()));
    match value {
        Some(Value::Color(color)) if !found.iter().any(Diagnostic::is_error) => return Ok(color),
        Some(other) if found.is_empty() => {
            let noun = other.kind().noun();
            let whole = Span::new(SourceId::File, 0, sources.file.text().len());
            let message = format!("a colour is wanted, and this is {noun}");
            let problem = error("wrong_type", message).at(whole, noun);
            found.push(problem.help(Type::Color.such_as()));
        }
        _ => {}
    }
    Err(found)
}
