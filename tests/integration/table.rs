//! Tables of cases in one text: a line each, its cells apart by arrows.

/// The cells of each line. White space around a cell is no part of it; `\n`, `\r`, `\t` and
/// `\u{feff}` in one are what they are in a string of Rust. Empty lines and those that begin with
/// `--` are not rows.
pub fn lines(table: &'static str) -> Vec<Vec<&'static str>> {
    let lines = table.lines().map(str::trim);
    let lines = lines.filter(|line| !line.is_empty() && !line.starts_with("--"));
    // What is left over is kept until the tests end.
    let cell = |cell: &'static str| match cell.contains('\\') {
        true => unescaped(cell).leak(),
        false => cell,
    };
    let cells = |line: &'static str| line.split("->").map(move |text| cell(text.trim()));
    lines.map(|line| cells(line).collect()).collect()
}

/// The rows of a table that all have as many cells.
pub fn rows<const CELLS: usize>(table: &'static str) -> Vec<[&'static str; CELLS]> {
    let rows = lines(table).into_iter();
    let row = |cells: Vec<_>| {
        cells
            .try_into()
            .unwrap_or_else(|cells| panic!("not {CELLS}: {cells:?}"))
    };
    rows.map(row).collect()
}

/// The lines of a table with one cell each.
pub fn list(table: &'static str) -> Vec<&'static str> {
    rows(table).into_iter().map(|[cell]| cell).collect()
}

/// How a text of several lines stands in one.
const ESCAPES: [(&str, &str); 4] = [
    ("\\n", "\n"),
    ("\\r", "\r"),
    ("\\t", "\t"),
    ("\\u{feff}", "\u{feff}"),
];

pub fn unescaped(cell: &str) -> String {
    ESCAPES
        .iter()
        .fold(cell.to_owned(), |cell, (from, to)| cell.replace(from, to))
}

pub fn escaped(text: &str) -> String {
    ESCAPES
        .iter()
        .fold(text.to_owned(), |text, (to, from)| text.replace(from, to))
}
