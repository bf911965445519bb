//! A class as JUnit XML, which systems of continuous integration show: a student is a test case, as
//! Ant's junitreport and Jenkins read them.

use super::graded::Graded;
use crate::diagnostic::escaped;

/// The file. A wrong picture is a `failure`, one of an unknown fault is `skipped`, and one that
/// cannot be read or is missing an `error`.
pub fn junit(scene: &str, graded: &[Graded]) -> String {
    let count = |word: &str| graded.iter().filter(|one| one.word() == word).count();
    let counts = format!(
        "tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"{}\"",
        graded.len(),
        count("wrong"),
        count("error"),
        count("unknown")
    );
    let scene = attribute(scene);
    let mut xml = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites {counts}>\n  <testsuite name=\"{scene}\" {counts}>\n"
    );
    for one in graded {
        let name = attribute(&one.name);
        xml += &format!("    <testcase classname=\"{scene}\" name=\"{name}\"");
        let kind = match one.word() {
            "wrong" => "failure",
            "unknown" => "skipped",
            "error" => "error",
            _ => {
                xml += "/>\n";
                continue;
            }
        };
        let message = attribute(&one.line());
        let word = match kind {
            // It has no type.
            "skipped" => String::new(),
            _ => format!(" type=\"{}\"", one.word()),
        };
        let lines: Vec<_> = one.comment().lines().map(attribute).collect();
        let text = lines.join("\n");
        xml += &format!(
            ">\n      <{kind} message=\"{message}\"{word}>{text}</{kind}>\n    </testcase>\n"
        );
    }
    xml + "  </testsuite>\n</testsuites>\n"
}

/// A line as XML may hold it: two characters are none there, not even by number.
fn attribute(text: &str) -> String {
    escaped(text).replace(['\u{fffe}', '\u{ffff}'], "\u{fffd}")
}
