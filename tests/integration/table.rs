//! Reads tables of test cases in a text: one row per line, with cells separated by `->`.

/// Returns the cells of each line, without the white space around them. In a cell, `\n`, `\r`, `\t`
/// and `\u{feff}` are escapes as in a Rust string. Empty lines and lines that begin with `--` are
/// skipped.
pub fn lines(table: &'static str) -> Vec<Vec<&'static str>> {
    let lines = table.lines().map(str::trim);
    let lines = lines.filter(|line| !line.is_empty() && !line.starts_with("--"));
    // The memory of cells is never freed, so that cells live until the test process ends.
    let cell = |cell: &'static str| -> &'static str { unescaped(cell).leak() };
    let cells = |line: &'static str| line.split("->").map(move |text| cell(text.trim()));
    lines.map(|line| cells(line).collect()).collect()
}

/// Returns the rows of a table. Panics if a row does not have `CELLS` cells.
pub fn rows<const CELLS: usize>(table: &'static str) -> Vec<[&'static str; CELLS]> {
    let rows = lines(table).into_iter();
    let row = |cells: Vec<_>| {
        cells
            .try_into()
            .unwrap_or_else(|cells| panic!("not {CELLS}: {cells:?}"))
    };
    rows.map(row).collect()
}

/// Returns the lines of a table that has one cell per line.
pub fn list(table: &'static str) -> Vec<&'static str> {
    rows(table).into_iter().map(|[cell]| cell).collect()
}

/// Escapes in a cell, each with the character that it stands for.
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
