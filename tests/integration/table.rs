//! Tables of cases in one text: a line each, its cells apart by arrows.

/// The cells of each line. White space around a cell is no part of it; `\n`, `\r` and `\t` in one are what they are in a string of Rust.
/// Empty lines and those that begin with `--` are not rows.
pub fn lines(table: &'static str) -> Vec<Vec<&'static str>> {
    let lines = table.lines().map(str::trim);
    let lines = lines.filter(|line| !line.is_empty() && !line.starts_with("--"));
    let cells = |line: &'static str| line.split("->").map(|cell| unescaped(cell.trim()));
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

/// What is left over is kept until the tests end.
fn unescaped(cell: &'static str) -> &'static str {
    match cell.contains('\\') {
        true => cell
            .replace("\\n", "\n")
            .replace("\\r", "\r")
            .replace("\\t", "\t")
            .leak(),
        false => cell,
    }
}
