//! Writes the results of a class as JUnit XML, which tools for continuous integration read. The
//! format is that of Ant's junitreport and of Jenkins. Each student is a test case.

use super::graded::GradedStudent;
use crate::diagnostic::escaped;

/// Returns the content of the JUnit file. A wrong picture is a `failure`; one that is wrong for
/// unknown reasons is `skipped`; a missing or unreadable picture is an `error`.
pub fn junit(scene: &str, graded: &[GradedStudent]) -> String {
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
            // In JUnit XML, the element `skipped` has no attribute `type`, so nothing is written.
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

/// Escapes a text for an XML attribute. XML forbids the characters U+FFFE and U+FFFF even in
/// escaped form, so they are replaced.
fn attribute(text: &str) -> String {
    escaped(text).replace(['\u{fffe}', '\u{ffff}'], "\u{fffd}")
}
