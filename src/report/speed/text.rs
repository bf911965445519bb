//! Formats a measurement as text for a terminal.

use comfy_table::{CellAlignment, ContentArrangement, Table, presets::NOTHING};

use super::{
    results::Measurement,
    summary::{self, heading, notes, printable, verdict},
};

/// Maximum length of a line of text, in characters. Longer lines are wrapped, because they are hard
/// to read.
const WIDTH: usize = 100;

/// Returns the measurement as text: a line about the scene and the machine; a table and a
/// recommended method for each requested error; and notes.
pub fn text(measured: &Measurement) -> String {
    let filled = |text: &str| textwrap::fill(text, WIDTH) + "\n";
    let mut text = format!(
        "{}: {}\n",
        printable(&measured.subject.name),
        heading(measured)
    );
    for &error in &measured.errors {
        let verdict = filled(&verdict(measured, error));
        text += &format!("\n{}\n\n{verdict}", table(measured, error));
    }
    text.extend(notes(measured).iter().map(|note| filled(note)));
    text
}

fn table(measured: &Measurement, error: f64) -> String {
    let summary = summary::table(measured, &[error]);
    let mut table = Table::new();
    table
        .load_preset(NOTHING)
        .set_content_arrangement(ContentArrangement::Disabled)
        .set_header(summary.heads)
        .add_rows(summary.rows);
    if let Some(methods) = table.column_mut(0) {
        methods.set_padding((0, 1));
    }
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table.trim_fmt()
}
