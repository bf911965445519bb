//! The measurement as text for a terminal.

use comfy_table::{CellAlignment, ContentArrangement, Table, presets::NOTHING};

use super::{
    measurement::Measurement,
    summary::{self, heading, notes, printable, verdict},
};

/// Lines are no longer than this.
const WIDTH: usize = 100;

/// What was measured, the table, which method to use, and how to read that.
pub fn text(measured: &Measurement) -> String {
    let summary = summary::table(measured);
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
    let verdicts = measured
        .errors
        .iter()
        .map(|&error| verdict(measured, error));
    let paragraphs = verdicts.chain(notes(measured));
    let paragraphs: Vec<_> = paragraphs.map(|it| textwrap::fill(&it, WIDTH)).collect();
    format!(
        "{}: {}\n\n{}\n\n{}\n",
        printable(&measured.subject.name),
        heading(measured),
        table.trim_fmt(),
        paragraphs.join("\n")
    )
}
