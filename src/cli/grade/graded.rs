//! The result of grading a student's submission. All output formats take their values from it, so
//! that they agree.

use serde_json::{Map, Value, json};

use super::thumbnails::Pictures;
use crate::{
    cli::Status,
    grading::{Kind, NamedMistake, Verdict},
};

/// A student, with the results of the submitted pictures.
pub struct GradedStudent {
    pub name: String,
    /// Number that Moodle gives the submission; `None` if Moodle did not collect it.
    pub number: Option<String>,
    /// Path of the student's folder or file, as it is printed.
    pub place: String,
    /// The pictures that were compared, the best one first.
    pub compared: Vec<ComparedPicture>,
    /// The file-name pattern in `--picture`, if it was given.
    pub chosen: Option<String>,
    /// Files of the student that were not compared. Some are followed by the reason in parentheses.
    pub not_compared: Vec<String>,
    /// Names of the other students whose best picture equals this student's best picture in every
    /// pixel.
    pub equal_to: Vec<String>,
    /// The student's points. `None` without `--points`, if no picture was judged, or if the picture
    /// is wrong for unknown reasons.
    pub score: Option<f64>,
}

/// A picture that was compared.
pub struct ComparedPicture {
    /// Path of the picture within the student's submission.
    pub path: String,
    /// Path of the picture as it is printed. It starts with the argument on the command line.
    pub shown: String,
    pub result: Result<JudgedPicture, String>,
}

/// The result of judging a picture.
pub struct JudgedPicture {
    pub verdict: Verdict,
    /// Root mean square of the differences from the exact picture, in linear light.
    pub rmse: f64,
    /// Whether the file contains the scene that Pinhole stores in its pictures. If so, Pinhole
    /// rendered the picture, not the student's program.
    pub is_ours: bool,
    /// Fields of the verdict in the JSON output.
    pub fields: Map<String, Value>,
    /// A warning if the file's format changes colours.
    pub warning: Option<&'static str>,
    /// SHA-256 of the picture's width and pixels.
    pub hash: [u8; 32],
    /// Pictures that the HTML page shows; `None` if no page is written.
    pub pictures: Option<Pictures>,
}

impl JudgedPicture {
    /// Returns the verdict as a word: `right`, `noise`, `wrong` or `unknown`.
    pub fn word(&self) -> &'static str {
        self.verdict.kind.word()
    }

    /// Returns whether the picture is right, except for sampling noise.
    pub fn is_right(&self) -> bool {
        matches!(self.verdict.kind, Kind::Right | Kind::Noise)
    }

    /// Returns the number of independent samples per pixel that would cause as much noise as the
    /// picture has. Returns `None` if the picture is wrong, since its mistakes would be measured as
    /// noise.
    pub fn samples(&self) -> Option<f64> {
        self.verdict.samples.filter(|_| self.is_right())
    }
}

impl ComparedPicture {
    /// Returns the sort key of a picture. The student's picture with the smallest key is graded.
    /// The order of verdicts is right, noise, wrong, unknown; an unreadable picture comes last.
    /// Among pictures with the same verdict, the one with the smallest error comes first.
    pub fn rank(&self) -> (u8, f64) {
        let Ok(judged) = &self.result else {
            return (4, 0.0);
        };
        let rank = match judged.verdict.kind {
            Kind::Right => 0,
            Kind::Noise => 1,
            Kind::Wrong => 2,
            Kind::Unknown => 3,
        };
        (rank, judged.rmse)
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

    /// Returns the path of the best picture, or of the submission if no picture was compared.
    pub fn file(&self) -> &str {
        self.compared
            .first()
            .map_or(&self.place, |best| &best.shown)
    }

    /// Returns the verdict as a word: `right`, `noise`, `wrong`, `unknown`, or `error` if no
    /// picture was judged.
    pub fn word(&self) -> &str {
        match self.compared.first().map(|best| &best.result) {
            Some(Ok(judged)) => judged.word(),
            _ => "error",
        }
    }

    /// Returns the verdict as a sentence, or the reason why no picture was compared.
    pub fn line(&self) -> String {
        let line = match self.best() {
            Ok(judged) => judged.verdict.line(),
            Err(error) => format!("not compared: {error}"),
        };
        line + &self.note()
    }

    /// Returns a note that says which picture was graded, if several were compared; otherwise an
    /// empty text.
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
            _ => Status::Negative,
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
                    json!({ "file": one.shown, "verdict": judged.word(), "line": judged.verdict.line() })
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

    /// Returns a comment on the picture, for the student to read.
    pub fn comment(&self) -> String {
        let judged = match self.best() {
            Ok(judged) => judged,
            Err(error) => return format!("Your picture could not be compared: {error}."),
        };
        let verdict = &judged.verdict;
        let mut text = match verdict.kind {
            Kind::Right => "Your picture is right: it is equal to the exact one.".to_owned(),
            Kind::Noise => {
                "Your picture is right; it differs from the exact one by sampling noise alone."
                    .to_owned()
            }
            Kind::Wrong => {
                "Your picture differs from the exact one, and this explains it:".to_owned()
            }
            Kind::Unknown => {
                "Your picture differs from the exact one, and it is not known why.".to_owned()
            }
        };
        let listed = |one: &NamedMistake| format!("\n- {}\n  {}", one.message, one.help);
        text.extend(verdict.mistakes.iter().map(listed));
        if !verdict.guesses.is_empty() {
            text.push_str("\nThis comes nearest, but is only a guess");
            if let Some(rest) = verdict.rest {
                text += &format!(
                    ": it leaves {} of the difference unexplained",
                    percent(rest)
                );
            }
            text.push('.');
            text.extend(verdict.guesses.iter().map(listed));
        } else if let Some(rest) = verdict.rest.filter(|_| verdict.kind == Kind::Wrong) {
            text += &format!("\n{} of the difference is something else.", percent(rest));
        }
        if verdict.is_cut {
            text.push_str("\nNot all mistakes were tried.");
        }
        text
    }
}

/// Formats a share as a whole percentage. A share below 1 % becomes `less than 1 %`.
pub fn percent(share: f64) -> String {
    match 100.0 * share {
        few if few < 1.0 => "less than 1 %".to_owned(),
        many => format!("{many:.0} %"),
    }
}
