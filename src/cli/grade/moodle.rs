//! Fills in Moodle's worksheet of grades, a CSV file.
//!
//! A student's row is found by the number at the end of the row's identifier, as in Moodle's
//! importer (`mod/assign/feedback/offline/importgradeslib.php`). A column is found by its heading.
//! Only cells of grades and comments change. Rows that belong to no graded student are copied byte
//! for byte.

use std::path::Path;

use csv::{ByteRecord, QuoteStyle, ReaderBuilder, Terminator, WriterBuilder};

use super::graded::GradedStudent;
use crate::{
    cli::{
        CommandError, command_error,
        input::{shown, unreadable},
        output,
    },
    diagnostic::visible,
    files,
    numbers::short,
    suggest::choice,
};

/// Maximum length of a worksheet, in bytes. A longer file is an error. A worksheet has a row for
/// each student, so real ones are far shorter; the limit only keeps a wrong file from filling the
/// memory.
const LIMIT: u64 = 64 << 20;

/// English headings of the worksheet's columns. The option `--columns` gives their names in other
/// languages. The last two columns may be missing.
const HEADINGS: [&str; 5] = [
    "Identifier",
    "Grade",
    "Feedback comments",
    "Maximum Grade",
    "Grade can be changed",
];

/// Returns the worksheet at `path` with grades and comments filled in. `total` is the number of
/// points for a right picture. If it is `None`, only comments are filled in, and no grades.
///
/// # Errors
///
/// Returns an error if the worksheet cannot be read, lacks a column, or has a maximum grade below
/// `total`.
pub fn filled(
    path: &Path,
    columns: &[String],
    graded: &[GradedStudent],
    total: Option<f64>,
) -> Result<Vec<u8>, CommandError> {
    let failed = |why: &dyn std::fmt::Display| unreadable(path, why);
    let columns = columns.iter().map(|column| renamed(column));
    let columns = columns.collect::<Result<Vec<_>, _>>()?;
    let bytes = files::read(path, LIMIT).map_err(|error| failed(&error))?;
    let mark = if bytes.starts_with(b"\xef\xbb\xbf") {
        3
    } else {
        0
    };
    let text = &bytes[mark..];
    let mut reader = ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .from_reader(text);
    let mut rows = Vec::new();
    let mut row = ByteRecord::new();
    while reader
        .read_byte_record(&mut row)
        .map_err(|error| failed(&error))?
    {
        rows.push(row.clone());
    }
    // After CRLF, the CSV reader reports the position of the line feed as the start of the next
    // row, so the line feed is skipped.
    let start = |row: &ByteRecord| {
        let at = row.position().map_or(0, |at| at.byte() as usize);
        at + usize::from(at > 0 && text.get(at) == Some(&b'\n'))
    };
    let starts: Vec<usize> = rows.iter().map(start).chain([text.len()]).collect();
    let head = rows.first().ok_or_else(|| failed(&"it is empty"))?;
    if head.len() == 1 || bytes.starts_with(b"\xff\xfe") {
        let why = "it is no table with commas between cells: take it as Moodle gave it, or save it as CSV in UTF-8 with commas";
        return Err(failed(&why));
    }
    let find = |english: &str| {
        let own = columns.iter().find(|(name, _)| *name == english);
        let heading = own.map_or(english, |(_, heading)| *heading);
        let is = |cell: &[u8]| cell.trim_ascii().eq_ignore_ascii_case(heading.as_bytes());
        head.iter().position(is)
    };
    let needed = |english: &str| {
        find(english).ok_or_else(|| {
            let all: Vec<_> = head.iter().map(String::from_utf8_lossy).collect();
            let hint = format!(
                "it has no column `{english}` among {}: `--columns '{english}=HEADING'` says how it is called there",
                all.join(", ")
            );
            failed(&hint)
        })
    };
    let [identifier, grade, feedback] = [
        needed(HEADINGS[0])?,
        needed(HEADINGS[1])?,
        needed(HEADINGS[2])?,
    ];
    let [maximum, changeable] = [find(HEADINGS[3]), find(HEADINGS[4])];
    let ends_in_cr = text[..starts[1]].ends_with(b"\r\n");
    let mut out = bytes[..mark].to_vec();
    let mut found = vec![false; graded.len()];
    for (index, row) in rows.iter().enumerate() {
        let raw = &text[starts[index]..starts[index + 1]];
        let number = row.get(identifier).map(number_at_end).filter(|_| index > 0);
        let is_his = |one: &GradedStudent| one.number.is_some() && one.number.as_deref() == number;
        let at = graded.iter().position(is_his);
        let may_change = changeable.and_then(|at| row.get(at)) != Some(b"No");
        let Some((at, one)) = at.map(|at| (at, &graded[at])) else {
            out.extend(raw);
            continue;
        };
        found[at] = true;
        if !may_change {
            out.extend(raw);
            continue;
        }
        let most = maximum.and_then(|at| row.get(at)).and_then(decimal);
        if let (Some(total), Some(most)) = (total, most)
            && total > most
        {
            return Err(failed(&format!(
                "its grades go up to {}, and the points to {}",
                short(most),
                short(total)
            )));
        }
        let cells = row.iter().enumerate().map(|(at, cell)| match at {
            // Without `--points`, there are no grades to fill in, so the cell keeps its content.
            _ if at == grade && total.is_some() => {
                one.score.map_or_else(String::new, short).into_bytes()
            }
            _ if at == feedback => html(&one.comment()).into_bytes(),
            _ => cell.to_vec(),
        });
        let mut writer = WriterBuilder::new()
            .quote_style(QuoteStyle::Necessary)
            .terminator(if ends_in_cr {
                Terminator::CRLF
            } else {
                Terminator::Any(b'\n')
            })
            .from_writer(Vec::new());
        writer.write_record(cells).map_err(|error| failed(&error))?;
        out.extend(writer.into_inner().map_err(|error| failed(&error))?);
    }
    for (one, _) in graded.iter().zip(&found).filter(|(_, found)| !**found) {
        output::warning(&format!("{} has no row for {}", shown(path), one.name));
    }
    Ok(out)
}

/// Parses an argument of `--columns`, such as `Grade=Bewertung`: the English heading, and the
/// heading in the worksheet. Returns an error if the English heading is not in [`HEADINGS`], or if
/// the other heading is missing.
fn renamed(text: &str) -> Result<(&'static str, &str), CommandError> {
    let (name, heading) = text.split_once('=').unwrap_or((text, ""));
    let mut headings = HEADINGS.into_iter();
    match headings.find(|own| own.eq_ignore_ascii_case(name)) {
        Some(name) if !heading.is_empty() => Ok((name, heading)),
        _ => Err(command_error(format!(
            "`--columns {text}` is not COLUMN=HEADING, where COLUMN is {}",
            choice(HEADINGS)
        ))),
    }
}

/// Returns the number at the end of an identifier such as `Participant 12345`, or an empty text if
/// there is none. The word before it depends on Moodle's language.
fn number_at_end(cell: &[u8]) -> &str {
    let digits = cell
        .iter()
        .rev()
        .take_while(|byte| byte.is_ascii_digit())
        .count();
    str::from_utf8(&cell[cell.len() - digits..]).unwrap_or_default()
}

fn decimal(cell: &[u8]) -> Option<f64> {
    str::from_utf8(cell)
        .ok()?
        .trim()
        .replace(',', ".")
        .parse()
        .ok()
}

/// Converts a comment to HTML, the format of Moodle's comments.
fn html(text: &str) -> String {
    visible(text)
        .replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('\n', "<br>")
}
