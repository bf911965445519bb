//! Writes the results of a class as a table: as readable text and as CSV.

use std::iter;

use super::graded::{GradedStudent, percent};
use crate::{
    cli::judge::quoted,
    diagnostic::visible_line,
    grading::{NamedMistake, about},
    numbers::short,
};

/// Returns two cells of a student's row: the root mean square error (RMSE) and the number of
/// samples per pixel. Both are empty if no picture was judged.
pub fn figures(one: &GradedStudent) -> [String; 2] {
    match one.best() {
        Err(_) => [String::new(), String::new()],
        Ok(judged) => [
            format!("{:.5}", judged.rmse),
            judged.samples().map_or_else(String::new, about),
        ],
    }
}

/// Returns the readable table: a row for each student, with details below the row.
pub fn table(graded: &[GradedStudent]) -> String {
    let widest = graded
        .iter()
        .map(|one| visible_line(&one.name).chars().count());
    let widest = widest.max().unwrap_or(0).max("student".len());
    let line = |[name, error, samples, verdict]: [&str; 4]| {
        let [name, verdict] = [name, verdict].map(visible_line);
        format!("{name:<widest$}  {error:>8}  {samples:>8}  {verdict}\n")
    };
    let more = |text: &str| format!("{:widest$}  {}\n", "", visible_line(text));
    let row = |one: &GradedStudent| {
        let [error, samples] = figures(one);
        let mut verdict = one.line();
        if one.best().is_ok_and(|judged| judged.is_ours) {
            verdict += " (rendered by Pinhole)";
        }
        if let Some(score) = one.score {
            verdict += &format!("; {} points", short(score));
        }
        let mut text = line([&one.name, &error, &samples, &verdict]);
        if let Ok(judged) = one.best() {
            let guess = |guess: &NamedMistake| more(&format!("a guess: {}", guess.message));
            text.extend(judged.verdict.guesses.iter().map(guess));
            if let Some(rest) = judged.verdict.rest {
                text += &more(&format!(
                    "{} of the difference is not explained",
                    percent(rest)
                ));
            }
            if judged.verdict.is_cut {
                text += &more(
                    "the search stopped at its limit before all mistakes were tried: a greater --effort tries more",
                );
            }
        }
        if !one.equal_to.is_empty() {
            text += &more(&format!(
                "the same in every pixel as that of {}",
                one.equal_to.join(", ")
            ));
        }
        if !one.not_compared.is_empty() {
            text += &more(&format!("not compared: {}", some(&one.not_compared)));
        }
        text
    };
    let head = line(["student", "error", "samples", "verdict"]);
    iter::once(head).chain(graded.iter().map(row)).collect()
}

/// Joins at most six items of a list, and adds how many more there are.
pub fn some(list: &[String]) -> String {
    /// Maximum number of items that are named; the others are counted. Chosen so that the list
    /// takes one or two lines.
    const MOST: usize = 6;
    let first: Vec<&str> = list.iter().take(MOST).map(String::as_str).collect();
    match list.len().saturating_sub(MOST) {
        0 => first.join(", "),
        more => format!("{} and {more} more", first.join(", ")),
    }
}

/// Returns the table as CSV.
pub fn csv(graded: &[GradedStudent]) -> String {
    let row = |one: &GradedStudent| {
        let [error, samples] = figures(one);
        let (mistakes, guesses, rest, limited) = match one.best() {
            Err(_) => Default::default(),
            Ok(judged) => (
                &judged.verdict.mistakes[..],
                &judged.verdict.guesses[..],
                judged
                    .verdict
                    .rest
                    .map_or_else(String::new, |rest| format!("{rest:.4}")),
                judged.verdict.is_cut.to_string(),
            ),
        };
        let line = match one.best() {
            Err(error) => error,
            Ok(_) => one.line(),
        };
        let joined = |findings: &[NamedMistake], text: fn(&NamedMistake) -> String| {
            let texts: Vec<_> = findings
                .iter()
                .map(text)
                .filter(|text| !text.is_empty())
                .collect();
            texts.join("; ")
        };
        let sets = mistakes.iter().flat_map(|mistake| &mistake.set);
        let sets: Vec<_> = sets.map(|set| quoted(set)).collect();
        let explains: f64 = mistakes.iter().map(|mistake| mistake.explains).sum();
        let explains = if mistakes.is_empty() {
            String::new()
        } else {
            format!("{explains:.4}")
        };
        let cells = [
            text_cell(one.file()),
            one.word().to_owned(),
            error,
            samples,
            text_cell(&line),
            text_cell(&sets.join(" ")),
            text_cell(&one.name),
            text_cell(one.number.as_deref().unwrap_or_default()),
            text_cell(&joined(mistakes, |one| one.id.to_owned())),
            explains,
            text_cell(&joined(mistakes, |one| one.help.to_owned())),
            text_cell(&joined(guesses, |one| one.message.to_owned())),
            rest,
            limited,
            text_cell(&one.not_compared.join("; ")),
            text_cell(&one.equal_to.join("; ")),
            one.score.map_or_else(String::new, short),
        ];
        cells.join(",") + "\n"
    };
    iter::once(HEAD.to_owned())
        .chain(graded.iter().map(row))
        .collect()
}

const HEAD: &str = "file,verdict,rmse,samples_per_pixel,line,set,student,number,mistakes,explains,help,guesses,rest,limited,not_compared,equal_to,score\n";

/// Quotes a text as a cell of a CSV file. If a spreadsheet would interpret the text as a formula, a
/// `'` is put before it.
fn text_cell(text: &str) -> String {
    let guard = if text.starts_with(['=', '+', '-', '@', '＝', '＋', '－', '＠', '\t', '\r', '\n'])
    {
        "'"
    } else {
        ""
    };
    format!("\"{guard}{}\"", visible_line(text).replace('"', "\"\""))
}
