//! Reads students' names from Moodle's file names, from Gradescope's metadata file, and from GitHub
//! Classroom's folder names.

use std::collections::BTreeMap;

/// Suffix of the folder into which GitHub Classroom clones all repositories of an assignment. The
/// assignment's name precedes it.
pub const CLONES: &str = "-submissions";

/// Parts of a file or folder name in Moodle's form, `Name_12345_assignsubmission_file_essay.pdf`:
/// the student's name, the submission's number, and the name under which the student submitted the
/// file. The last part is empty for a folder.
#[derive(Debug)]
pub struct MoodleName<'n> {
    pub name: &'n str,
    pub number: &'n str,
    pub file: &'n str,
}

impl MoodleName<'_> {
    /// Returns the student's name, or `Participant` and the number if Moodle hides names.
    pub fn shown(&self) -> String {
        match self.name {
            "" | "Participant" => format!("Participant {}", self.number),
            name => name.replace('_', " "),
        }
    }
}

/// Splits a file or folder name in Moodle's form into its parts. Returns `None` for any other name.
pub fn moodle(text: &str) -> Option<MoodleName<'_>> {
    let (who, what) = text.split_once("_assignsubmission_")?;
    let (name, number) = who.rsplit_once('_')?;
    // Moodle writes the name of the submission plug-in after `assignsubmission_`, for example
    // `file`.
    let (_, file) = what.split_once('_').unwrap_or((what, ""));
    let is_number = !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit());
    is_number.then_some(MoodleName { name, number, file })
}

/// Returns a student's name from the name of the student's folder. Removes GitHub Classroom's
/// prefix (the assignment's name `slug` and a hyphen) and the extension `.zip`.
pub fn of_folder(folder: &str, slug: Option<&str>) -> String {
    let own = slug.and_then(|slug| folder.strip_prefix(slug)?.strip_prefix('-'));
    let own = own.filter(|own| !own.is_empty()).unwrap_or(folder);
    own.strip_suffix(".zip").unwrap_or(own).to_owned()
}

/// Names of the students in a Gradescope export: maps each folder of the export to its students.
#[derive(Debug, Default)]
pub struct Submitters(BTreeMap<String, Vec<String>>);

impl Submitters {
    /// Returns the names of a folder's students, separated by commas, or the folder's own name if
    /// no student is listed. Returns `None` if the folder is not in the export.
    pub fn name(&self, folder: &str) -> Option<String> {
        let names = self.0.get(folder)?;
        Some(match &names[..] {
            [] => folder.to_owned(),
            names => names.join(", "),
        })
    }

    /// Returns all folders of the export, each with the names of its students.
    pub fn all(&self) -> impl Iterator<Item = (&str, String)> {
        let named = |folder: &'_ String| self.name(folder).unwrap_or_default();
        self.0.keys().map(move |folder| (&**folder, named(folder)))
    }
}

/// Reads Gradescope's file `submission_metadata.yml`. Only the part of YAML that Gradescope writes
/// is supported.
///
/// ```yaml
/// submission_409194023:
///   :submitters:
///   - :name: Anna Li
///     :sid: '123'
///     :email: anna@example.org
///   :created_at: 2026-04-26 17:34:00.861687000 Z
/// ```
pub fn submitters(text: &str) -> Submitters {
    let mut all = BTreeMap::<String, Vec<Submitter>>::new();
    let mut of_folder: Option<&mut Vec<Submitter>> = None;
    let mut is_in_list = false;
    for line in text.lines() {
        let content = line.trim_start();
        let indent = line.len() - content.len();
        let (is_item, content) = match content.strip_prefix("- ") {
            Some(content) => (true, content),
            None => (false, content),
        };
        let content = content.trim_start_matches(':');
        let Some((key, value)) = content.split_once(':') else {
            continue;
        };
        match (indent, is_item) {
            (0, false) => {
                is_in_list = false;
                of_folder = Some(all.entry(scalar(key)).or_default());
            }
            (2, false) => is_in_list = key == "submitters",
            _ => {
                let Some(submitters) = of_folder.as_mut().filter(|_| is_in_list) else {
                    continue;
                };
                if is_item {
                    submitters.push(Submitter::default());
                }
                if let Some(submitter) = submitters.last_mut() {
                    submitter.set(key, scalar(value.trim()));
                }
            }
        }
    }
    let called = |all: Vec<Submitter>| all.into_iter().filter_map(Submitter::called).collect();
    let named = all.into_iter().map(|(folder, all)| (folder, called(all)));
    Submitters(named.collect())
}

/// A student's name, e-mail address and student number. Values that Gradescope does not give are
/// empty.
#[derive(Debug, Default)]
struct Submitter([String; 3]);

impl Submitter {
    fn set(&mut self, key: &str, value: String) {
        let keys = ["name", "email", "sid"];
        if let Some(at) = keys.iter().position(|own| *own == key) {
            self.0[at] = value;
        }
    }

    fn called(self) -> Option<String> {
        self.0.into_iter().find(|text| !text.is_empty())
    }
}

/// Returns the text of a YAML scalar (a plain or quoted value), without quotation marks.
fn scalar(text: &str) -> String {
    let inner = |mark: char| text.strip_prefix(mark)?.strip_suffix(mark);
    if let Some(inner) = inner('\'') {
        return inner.replace("''", "'");
    }
    match inner('"') {
        Some(inner) => unescaped(inner).unwrap_or_else(|| text.to_owned()),
        None => text.to_owned(),
    }
}

/// Decodes the escapes in a double-quoted YAML text (YAML 1.2.2, section 5.7). Gradescope escapes
/// all characters above U+FFFF, for example. Returns `None` if an escape is invalid.
fn unescaped(text: &str) -> Option<String> {
    let mut chars = text.chars();
    let mut plain = String::new();
    while let Some(c) = chars.next() {
        if c != '\\' {
            plain.push(c);
            continue;
        }
        let digits = match chars.next()? {
            'x' => 2,
            'u' => 4,
            'U' => 8,
            // Escapes of control characters become spaces, since a name is shown on one line.
            '0' | 'a' | 'b' | 't' | '\t' | 'n' | 'v' | 'f' | 'r' | 'e' | 'N' | '_' | 'L' | 'P' => {
                plain.push(' ');
                continue;
            }
            c @ (' ' | '"' | '/' | '\\') => {
                plain.push(c);
                continue;
            }
            _ => return None,
        };
        let digits: String = chars.by_ref().take(digits).collect();
        plain.push(char::from_u32(u32::from_str_radix(&digits, 16).ok()?)?);
    }
    Some(plain)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_of_moodle_has_a_student_a_number_and_a_file() {
        for (text, name, number, file) in [
            (
                "Anna Li_12345_assignsubmission_file_a_b.png",
                "Anna Li",
                "12345",
                "a_b.png",
            ),
            (
                "Anna_Li_12345_assignsubmission_file_",
                "Anna Li",
                "12345",
                "",
            ),
            (
                "Participant_9_assignsubmission_onlinetext_",
                "Participant 9",
                "9",
                "",
            ),
        ] {
            let found = moodle(text).unwrap();
            assert_eq!(
                (&*found.shown(), found.number, found.file),
                (name, number, file)
            );
        }
        for text in [
            "anna_assignsubmission_file_",
            "a_b_assignsubmission_file_",
            "a_1_b",
        ] {
            assert!(moodle(text).is_none(), "{text}");
        }
    }

    #[test]
    fn an_export_of_gradescope_says_who_handed_in_a_folder() {
        let text = "---
submission_1:
  :submitters:
  - :name: First Last
    :sid: '123'
    :email: first@example.org
  :created_at: 2026-04-26 17:34:00.861687000 Z
  :results:
    output: |-
      submission_9: name
      - :name: nobody
submission_2:
  :submitters:
  - :name: \"Z\\u00fclal \\\"Z\\\" \\U0001F600 \\xC9\"
  - :email: bob@example.org
    :name: 'Bob O''B'
submission_3:
  :submitters:
  - :sid: 333
submission_4:
  :submitters: []
";
        let found = submitters(text);
        let found: Vec<_> = found.all().collect();
        let expected = [
            ("submission_1", "First Last"),
            ("submission_2", "Zülal \"Z\" 😀 É, Bob O'B"),
            ("submission_3", "333"),
            ("submission_4", "submission_4"),
        ];
        assert_eq!(
            found,
            expected.map(|(folder, name)| (folder, name.to_owned()))
        );
    }
}
