//! The result of grading a student's submission.
//!
//! The verdict is stored as the JSON that programs get. All other formats take their values from
//! it, so that all formats agree.

use serde_json::{Map, Value, json};

use super::thumbnails::Pictures;
use crate::cli::Status;

/// A student, with the results of the submitted pictures.
pub struct GradedStudent {
    pub name: String,
    /// Number that Moodle gives the submission; `None` if Moodle did not collect it.
    pub number: Option<String>,
    /// Path of the student's folder or file, for output.
    pub place: String,
    /// The pictures that were compared, the best one first.
    pub compared: Vec<ComparedPicture>,
    /// The pattern of file names in `--picture`.
    pub chosen: Option<String>,
    /// Files of the student that were not compared, some with the reason.
    pub not_compared: Vec<String>,
    /// Names of other students whose best picture equals this student's in every pixel.
    pub equal_to: Vec<String>,
    /// The student's points; `None` if there is no scheme of points, or the picture is wrong for
    /// unknown reasons.
    pub score: Option<f64>,
}

/// A picture that was compared.
pub struct ComparedPicture {
    /// Path of the picture within the student's submission.
    pub path: String,
    /// Path of the picture, starting with the argument on the command line, for output.
    pub shown: String,
    pub result: Result<JudgedPicture, String>,
}

/// The result of judging a picture.
pub struct JudgedPicture {
    /// Fields of the verdict in the JSON output.
    pub fields: Map<String, Value>,
    /// A warning if the file's format changes colours.
    pub warning: Option<&'static str>,
    /// SHA-256 of the picture's width and pixels.
    pub hash: [u8; 32],
    /// Pictures that the HTML page shows; `None` if no page is written.
    pub pictures: Option<Pictures>,
}

/// A mistake that explains differences, or a guess at one.
pub struct Finding<'j> {
    pub id: &'j str,
    pub message: &'j str,
    pub help: &'j str,
    pub set: Vec<&'j str>,
    /// Share of the difference that the mistake explains: the squared difference from the exact
    /// picture, without the part that noise explains.
    pub explains: f64,
}

impl JudgedPicture {
    fn text(&self, key: &str) -> &str {
        self.fields
            .get(key)
            .and_then(Value::as_str)
            .unwrap_or_default()
    }

    /// Returns the verdict as a word: `right`, `noise`, `wrong` or `unknown`.
    pub fn word(&self) -> &str {
        self.text("verdict")
    }

    /// Returns the verdict as a sentence.
    pub fn line(&self) -> &str {
        self.text("line")
    }

    /// Returns whether the picture is right, except for sampling noise.
    pub fn is_right(&self) -> bool {
        matches!(self.word(), "right" | "noise")
    }

    pub fn rmse(&self) -> f64 {
        let rmse = self.fields.get("rmse").and_then(Value::as_f64);
        rmse.unwrap_or_default()
    }

    /// Returns the number of independent samples per pixel with which a picture is as noisy as this
    /// one. Returns `None` if this picture is wrong, because its mistakes would count as noise.
    pub fn samples(&self) -> Option<f64> {
        let samples = self.fields.get("samples_per_pixel")?.as_f64();
        samples.filter(|_| self.is_right())
    }

    /// Returns the share of the difference that neither the mistakes nor the guesses explain.
    pub fn rest(&self) -> Option<f64> {
        self.fields.get("rest")?.as_f64()
    }

    /// Returns whether the picture carries a scene's text, as the pictures that Pinhole writes do.
    pub fn is_ours(&self) -> bool {
        self.fields.get("rendered_by_pinhole") == Some(&Value::Bool(true))
    }

    /// Returns whether the search for mistakes ended at its limit of work.
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
    /// Returns the key by which a student's pictures are sorted; a better picture has a smaller
    /// key. The first one after sorting is graded.
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
    /// Returns the result of the best picture, or the reason why there is no result.
    pub fn best(&self) -> Result<&JudgedPicture, String> {
        match self.compared.first() {
            Some(best) => best.result.as_ref().map_err(Clone::clone),
            None => Err(match &self.chosen {
                Some(glob) => format!("there is no picture called `{glob}` in what was handed in"),
                None => "there is no picture in what was handed in".to_owned(),
            }),
        }
    }

    /// Returns the path of the best picture, or that of the submission if no picture was compared.
    pub fn file(&self) -> &str {
        self.compared
            .first()
            .map_or(&self.place, |best| &best.shown)
    }

    /// Returns the verdict as a word; `error` if no picture was judged.
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

    /// Returns a note in parentheses that says which of several pictures the verdict is about;
    /// empty if there is only one.
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

    /// Returns the exit status for this student: [`Status::Done`] if the best picture is right.
    pub fn status(&self) -> Status {
        match self.best() {
            Ok(judged) if judged.is_right() => Status::Done,
            _ => Status::SceneErrors,
        }
    }

    /// Returns the JSON object of the student.
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

    /// Returns the comment on the picture that the student gets to read.
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

/// Formats a share in whole per cent. A share below 1 % becomes `less than 1 %`.
pub fn percent(share: f64) -> String {
    match 100.0 * share {
        few if few < 1.0 => "less than 1 %".to_owned(),
        many => format!("{many:.0} %"),
    }
}
