//! What was said of a class's pictures, as tables for people and for programs.

use std::iter;

use serde_json::{Map, Value, json};

use super::{Status, judge::quoted, thumbnails::Thumbnails};
use crate::{
    diagnostic::visible_line,
    film::Comparison,
    grading::{Kind, Verdict},
    numbers::short,
};

/// A picture that was judged, or why it could not be.
pub struct Graded {
    pub name: String,
    pub result: Result<Judged, String>,
}

/// What is known of a picture.
pub struct Judged {
    pub comparison: Comparison,
    pub verdict: Verdict,
    /// What there is for programs.
    pub fields: Map<String, Value>,
    /// What its format does to colours.
    pub warning: Option<&'static str>,
    /// Whether it carries the text that Pinhole writes into its pictures.
    pub is_ours: bool,
    /// If there will be a page.
    pub thumbnails: Option<Thumbnails>,
}

impl Graded {
    /// Its name and what is known of it, if it was judged.
    pub fn judged(&self) -> Option<(&str, &Judged)> {
        let judged = self.result.as_ref().ok()?;
        Some((&self.name, judged))
    }

    /// What it makes of the exit status.
    pub fn status(&self) -> Status {
        match &self.result {
            Err(_) => Status::Trouble,
            Ok(judged) => match judged.verdict.kind {
                Kind::Right | Kind::Noise => Status::Done,
                Kind::Wrong | Kind::Unknown => Status::SceneErrors,
            },
        }
    }

    /// Its line for programs.
    pub fn json(&self) -> Value {
        let mut fields = Map::new();
        fields.insert("file".to_owned(), json!(self.name));
        match &self.result {
            Err(error) => {
                fields.insert("error".to_owned(), json!(error));
            }
            Ok(judged) => fields.extend(judged.fields.clone()),
        }
        Value::Object(fields)
    }

    /// Its cells in a table: name, verdict, error, samples.
    pub fn cells(&self) -> [String; 4] {
        match &self.result {
            Err(error) => [
                self.name.clone(),
                format!("not compared: {error}"),
                String::new(),
                String::new(),
            ],
            Ok(judged) => {
                let flag = if judged.is_ours {
                    " (rendered by Pinhole)"
                } else {
                    ""
                };
                let samples = judged.verdict.samples;
                [
                    self.name.clone(),
                    judged.verdict.line() + flag,
                    format!("{:.5}", judged.comparison.rmse),
                    samples.map_or_else(String::new, |samples| {
                        short((10.0 * samples).round() / 10.0)
                    }),
                ]
            }
        }
    }
}

/// A table for people.
pub fn table(graded: &[Graded]) -> String {
    let rows: Vec<[String; 4]> = graded
        .iter()
        .map(|one| one.cells().map(|cell| visible_line(&cell).into_owned()))
        .collect();
    let widest = rows
        .iter()
        .map(|row| row[0].chars().count())
        .max()
        .unwrap_or(0)
        .max("picture".len());
    let line = |[name, verdict, error, samples]: [&str; 4]| {
        format!("{name:<widest$}  {error:>8}  {samples:>8}  {verdict}\n")
    };
    let head = line(["picture", "verdict", "error", "samples"]);
    let rows = rows
        .iter()
        .map(|row| line(row.each_ref().map(String::as_str)));
    iter::once(head).chain(rows).collect()
}

/// A table for other programs.
pub fn csv(graded: &[Graded]) -> String {
    let row = |one: &Graded| {
        let [name, _, error, samples] = one.cells();
        let mut known = [const { String::new() }; 4];
        let (verdict, line, set) = match &one.result {
            Err(error) => ("error", error.clone(), String::new()),
            Ok(judged) => {
                known = of_mistakes(&judged.verdict);
                let sets = judged
                    .verdict
                    .mistakes
                    .iter()
                    .flat_map(|mistake| &mistake.set);
                let sets: Vec<_> = sets.map(|set| quoted(set)).collect();
                (
                    judged.verdict.kind.word(),
                    judged.verdict.line(),
                    sets.join(" "),
                )
            }
        };
        let [rest, limited, explains, help] = known;
        format!(
            "{},{verdict},{error},{samples},{},{},{rest},{limited},{},{}\n",
            text_cell(&name),
            text_cell(&line),
            text_cell(&set),
            text_cell(&explains),
            text_cell(&help)
        )
    };
    let rows = graded.iter().map(row);
    iter::once(
        "file,verdict,rmse,samples_per_pixel,line,set,rest,limited,explains,help\n".to_owned(),
    )
    .chain(rows)
    .collect()
}

/// What mistakes or guesses leave, whether the search came to its bound, what each explains, and the way out of each.
fn of_mistakes(verdict: &Verdict) -> [String; 4] {
    let all = || verdict.mistakes.iter().chain(&verdict.guesses);
    let explains: Vec<_> = all().map(|one| format!("{:.3}", one.explains)).collect();
    let help: Vec<_> = all().map(|one| &one.help[..]).collect();
    [
        verdict
            .rest
            .map_or_else(String::new, |rest| format!("{rest:.3}")),
        verdict.is_cut.to_string(),
        explains.join("; "),
        help.join("; "),
    ]
}

/// A text as a cell of a CSV file: what a program that opens it would take for a formula begins
/// with a `'`, and is a text to it so.
fn text_cell(text: &str) -> String {
    let guard =
        match text.starts_with(['=', '+', '-', '@', '＝', '＋', '－', '＠', '\t', '\r', '\n']) {
            true => "'",
            false => "",
        };
    format!("\"{guard}{}\"", visible_line(text).replace('"', "\"\""))
}
