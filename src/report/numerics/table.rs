//! Formats the results of all hard cases as a readable table and as JSON.

use std::fmt;

use serde_json::{Value, json};

use super::{case::Case, trial::CaseTally};
use crate::numbers::grouped;

/// Result of testing a hard case.
#[derive(Clone, Copy, Debug)]
pub struct CaseResult {
    /// The case that was tested.
    pub case: &'static Case,
    /// The numbers of inputs and of wrong answers, and the largest errors.
    pub tally: CaseTally,
}

/// Results of all hard cases.
#[derive(Clone, Debug)]
pub struct NumericsTable {
    /// The results, in the order of the report.
    pub rows: Vec<CaseResult>,
    /// Number of inputs that were planned to be tested, in all cases together.
    pub planned: u64,
}

impl NumericsTable {
    /// Returns the number of inputs for which Pinhole's answer was wrong.
    pub fn wrong(&self) -> u64 {
        self.rows.iter().map(|row| row.tally.wrong[1]).sum()
    }

    /// Returns the number of inputs that were tested.
    pub fn inputs(&self) -> u64 {
        self.rows.iter().map(|row| row.tally.inputs).sum()
    }

    /// Returns whether every planned input was tested.
    pub fn is_complete(&self) -> bool {
        self.inputs() == self.planned
    }

    /// Converts the table to JSON. Infinite errors, for example if a surface was not found, and
    /// numbers that were not measured become null.
    #[doc(hidden)]
    pub fn to_json(&self) -> Value {
        let rows = self.rows.iter().map(|CaseResult { case, tally }| {
            let side = |i: usize| {
                json!({
                    "wrong": case.decides().then_some(tally.wrong[i]),
                    "error": tally.error[i],
                })
            };
            json!({
                "case": case.id,
                "about": case.title,
                "inputs": tally.inputs,
                "textbook": side(0),
                "pinhole": side(1),
                "bound": case.bound,
                "unit": case.unit(),
            })
        });
        json!({ "complete": self.is_complete(), "numerics": rows.collect::<Vec<_>>() })
    }
}

/// Formats the table as readable text.
impl fmt::Display for NumericsTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let heads = [
            ["", "", "wrong", "wrong", "error", "error", "bound"],
            ["case", "", "textbook", "pinhole", "textbook", "pinhole", ""],
        ];
        let heads = heads.map(|head| head.map(str::to_owned)).into_iter();
        for cells in heads.chain(self.rows.iter().map(cells)) {
            let [case, title, one, two, three, four, five] = cells;
            let line =
                format!("{case:<4} {title:<46} {one:>8} {two:>7}  {three:>8} {four:>7} {five:>6}");
            writeln!(f, "{}", line.trim_end())?;
        }
        writeln!(
            f,
            "\n{} inputs; wrong decisions of Pinhole: {}. Textbook: the usual formulas in f64.\n\
             Errors are of the distance and the point seen in ulp, of unit vectors in u = 2^-53.",
            grouped(self.inputs()),
            grouped(self.wrong())
        )?;
        if self.is_complete() {
            Ok(())
        } else {
            writeln!(
                f,
                "The table is incomplete: it was interrupted before {} inputs were asked.",
                grouped(self.planned)
            )
        }
    }
}

/// Returns the cells of a row: the case's name and title, the wrong answers of the textbook
/// formulas and of Pinhole, the largest errors of the two, and the guaranteed bound.
fn cells(CaseResult { case, tally }: &CaseResult) -> [String; 7] {
    let [theirs, ours] = if case.decides() {
        [share(tally.wrong[0], tally.inputs), grouped(tally.wrong[1])]
    } else {
        Default::default()
    };
    let [their_error, our_error] = tally.error.map(size);
    let bound = format!("{} {}", case.bound, case.unit());
    let (id, title) = (case.id.to_owned(), case.title.to_owned());
    [id, title, theirs, ours, their_error, our_error, bound]
}

/// Formats `count` as a percentage of `inputs`. A percentage below 0.1 % is written with an
/// exponent.
fn share(count: u64, inputs: u64) -> String {
    let percent = 100.0 * count as f64 / inputs as f64;
    match count {
        0 => "0".to_owned(),
        _ if percent < 0.1 => format!("{percent:.0e} %"),
        _ => format!("{percent:.1} %"),
    }
}

/// Formats an error with two decimals. Very small and very large errors get one digit and an
/// exponent. An error that was not measured becomes a dash.
fn size(error: Option<f64>) -> String {
    let Some(error) = error else {
        return "-".to_owned();
    };
    match error {
        0.0 => "0".to_owned(),
        _ if error.is_infinite() => "inf".to_owned(),
        0.01..1000.0 => format!("{error:.2}"),
        _ => format!("{error:.0e}"),
    }
}
