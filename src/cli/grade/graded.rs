//! The result of grading a student's submission.
//!
//! The verdict is kept as the JSON that programs get. All other formats take their words from it,
//! so that all formats agree.

use serde_json::{Map, Value, json};

use super::thumbnails::Pictures;
use crate::cli::Status;

/// A student, with the results of the pictures.
pub struct GradedStudent {
    pub name: String,
    /// The number of the submission in Moodle.
    pub number: Option<String>,
    /// The folder or file, to be shown.
    pub place: String,
    /// The pictures that were compared, the best one first.
    pub compared: Vec<ComparedPicture>,
    /// The argument of `--picture`.
    pub chosen: Option<String>,
    /// The other files, with the reasons why they were not compared.
    pub not_compared: Vec<String>,
    /// Names of other students whose picture is equal in every pixel.
    pub equal_to: Vec<String>,
    /// The points, if they are known.
    pub score: Option<f64>,
}

/// A picture that was compared.
pub struct ComparedPicture {
    /// Path in the student's submission.
    pub path: String,
    /// Path from the argument on the command line.
    pub shown: String,
    pub result: Result<JudgedPicture, String>,
}

/// The result of judging a picture.
pub struct JudgedPicture {
    /// The fields of the JSON output.
    pub fields: Map<String, Value>,
    /// A warning if the file's format changes colours.
    pub warning: Option<&'static str>,
    /// SHA-256 of the pixels.
    pub hash: [u8; 32],
    /// The pictures for the page; `None` if no page is written.
    pub pictures: Option<Pictures>,
}

/// A mistake, or a guess.
pub struct Finding<'j> {
    pub id: &'j str,
    pub message: &'j str,
    pub help: &'j str,
    pub set: Vec<&'j str>,
    /// The share of the squared difference beyond noise that the mistake explains.
    pub explains: f64,
}

impl JudgedPicture {
    fn text(&self, key: &str) -> &str {
        self.fields
            .get(key)
            .and_then(Value::as_str)
            .unwrap_or_default()
    }

    /// Returns the word for the verdict.
    pub fn word(&self) -> &str {
        self.text("verdict")
    }

    /// Returns the verdict as a sentence.
    pub fn line(&self) -> &str {
        self.text("line")
    }

    /// Whether the picture is right, except for noise.
    pub fn is_right(&self) -> bool {
        matches!(self.word(), "right" | "noise")
    }

    pub fn rmse(&self) -> f64 {
        let rmse = self.fields.get("rmse").and_then(Value::as_f64);
        rmse.unwrap_or_default()
    }

    pub fn samples(&self) -> Option<f64> {
        self.fields.get("samples_per_pixel")?.as_f64()
    }

    /// Returns the share of the difference that the findings leave unexplained.
    pub fn rest(&self) -> Option<f64> {
        self.fields.get("rest")?.as_f64()
    }

    /// Whether the picture carries the scene text that Pinhole writes into its own pictures.
    pub fn is_ours(&self) -> bool {
        self.fields.get("rendered_by_pinhole") == Some(&Value::Bool(true))
    }

    /// Whether the search for mistakes ended at its limit of work.
    pub fn is_limited(&self) -> bool {
        self.fields.get("limited") == Some(&Value::Bool(true))
    }

    pub fn mistakes(&self) -> Vec<Finding<'_>> {
        self.findings("mistakes")
    }

    pub fn guesses(&self) -> Vec<Finding<'_>> {
        self.findings("guesses")
    }

    fn findings(&self, key: &str) -> Vec<Finding<'_>> {
        let findings = self.fields.get(key).and_then(Value::as_array);
        findings.into_iter().flatten().map(finding).collect()
    }
}

fn finding(one: &Value) -> Finding<'_> {
    let text = |key| one.get(key).and_then(Value::as_str).unwrap_or_default();
    let set = one.get("set").and_then(Value::as_array);
    Finding {
        id: text("id"),
        message: text("message"),
        help: text("help"),
        set: set
            .into_iter()
            .flatten()
            .filter_map(Value::as_str)
            .collect(),
        explains: one
            .get("explains")
            .and_then(Value::as_f64)
            .unwrap_or_default(),
    }
}

impl ComparedPicture {
    /// Returns a rank by which pictures are sorted, smaller for better ones: a student's best
    /// picture counts.
    pub fn rank(&self) -> (u8, f64) {
        let Ok(judged) = &self.result else {
            return (4, 0.0);
        };
        let rank = match judged.word() {
            "right" => 0,
            "noise" => 1,
            "wrong" => 2,
            _ => 3,
        };
        (rank, judged.rmse())
    }
}

impl GradedStudent {
    /// Returns the result of the best picture, or why there is none.
    pub fn best(&self) -> Result<&JudgedPicture, String> {
        match self.compared.first() {
            Some(best) => best.result.as_ref().map_err(Clone::clone),
            None => Err(match &self.chosen {
                Some(glob) => format!("there is no picture called `{glob}` in what was handed in"),
                None => "there is no picture in what was handed in".to_owned(),
            }),
        }
    }

    /// Returns the file of the best picture; the student's place if there is no picture.
    pub fn file(&self) -> &str {
        self.compared
            .first()
            .map_or(&self.place, |best| &best.shown)
    }

    /// Returns the word for the verdict.
    pub fn word(&self) -> &str {
        match self.compared.first().map(|best| &best.result) {
            Some(Ok(judged)) => judged.word(),
            _ => "error",
        }
    }

    /// Returns the verdict as a sentence.
    pub fn line(&self) -> String {
        let line = match self.best() {
            Ok(judged) => judged.line().to_owned(),
            Err(error) => format!("not compared: {error}"),
        };
        line + &self.note()
    }

    /// Returns which of several pictures the verdict is about, in parentheses; an empty text if
    /// there is only one.
    pub fn note(&self) -> String {
        match &self.compared[..] {
            [] | [_] => String::new(),
            [best, ..] => format!(
                " ({}, the best of {} pictures of the same time: --picture chooses)",
                best.path,
                self.compared.len()
            ),
        }
    }

    /// Returns the exit status for this student.
    pub fn status(&self) -> Status {
        match self.best() {
            Ok(judged) if judged.is_right() => Status::Done,
            _ => Status::SceneErrors,
        }
    }

    /// Returns the student's JSON object.
    pub fn json(&self) -> Value {
        let mut fields = Map::new();
        let mut put = |key: &str, value: Value| {
            fields.insert(key.to_owned(), value);
        };
        put("file", json!(self.file()));
        match self.best() {
            Err(error) => put("error", json!(error)),
            Ok(judged) => {
                for (key, value) in &judged.fields {
                    put(key, value.clone());
                }
            }
        }
        put("student", json!(self.name));
        if let Some(number) = &self.number {
            put("number", json!(number));
        }
        if self.compared.len() > 1 {
            let pictures = self.compared.iter().map(|one| match &one.result {
                Ok(judged) => {
                    json!({ "file": one.shown, "verdict": judged.word(), "line": judged.line() })
                }
                Err(error) => json!({ "file": one.shown, "error": error }),
            });
            put("pictures", pictures.collect());
        }
        if !self.not_compared.is_empty() {
            put("not_compared", json!(self.not_compared));
        }
        if !self.equal_to.is_empty() {
            put("equal_to", json!(self.equal_to));
        }
        if let Some(score) = self.score {
            put("score", json!(score));
        }
        Value::Object(fields)
    }

    /// Returns the comment for the student.
    pub fn comment(&self) -> String {
        let judged = match self.best() {
            Ok(judged) => judged,
            Err(error) => return format!("Your picture could not be compared: {error}."),
        };
        let mut text = match judged.word() {
            "right" => "Your picture is right: it is equal to the exact one.".to_owned(),
            "noise" => {
                "Your picture is right; it differs from the exact one by sampling noise alone."
                    .to_owned()
            }
            "wrong" => "Your picture differs from the exact one, and this explains it:".to_owned(),
            _ => "Your picture differs from the exact one, and it is not known why.".to_owned(),
        };
        let listed = |finding: &Finding| format!("\n- {}\n  {}", finding.message, finding.help);
        text.extend(judged.mistakes().iter().map(listed));
        let guesses = judged.guesses();
        if !guesses.is_empty() {
            text.push_str("\nThis comes nearest, but is only a guess");
            if let Some(rest) = judged.rest() {
                text += &format!(
                    ": it leaves {} of the difference unexplained",
                    percent(rest)
                );
            }
            text.push('.');
            text.extend(guesses.iter().map(listed));
        } else if let Some(rest) = judged.rest().filter(|_| judged.word() == "wrong") {
            text += &format!("\n{} of the difference is something else.", percent(rest));
        }
        if judged.is_limited() {
            text.push_str("\nNot all mistakes were tried.");
        }
        text
    }
}

/// Formats a share in per cent.
pub fn percent(share: f64) -> String {
    match 100.0 * share {
        few if few < 1.0 => "less than 1 %".to_owned(),
        many => format!("{many:.0} %"),
    }
}
