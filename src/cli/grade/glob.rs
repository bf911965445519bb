//! Patterns of file names. In a pattern, `*` stands for any number of characters except `/`, `?`
//! for one character except `/`, and `**` for any number of any characters.

/// A pattern of file names, stored in lower case.
#[derive(Clone, Debug)]
pub struct Glob(Vec<char>);

impl Glob {
    /// Makes a pattern. Upper and lower case are not distinguished.
    pub fn new(text: &str) -> Self {
        Self(text.to_lowercase().chars().collect())
    }

    /// Returns whether the pattern matches a path. If the pattern has no `/`, only the file name at
    /// the end of the path is compared.
    pub fn matches(&self, path: &str) -> bool {
        let path = path.to_lowercase();
        let name = path.rsplit('/').next().unwrap_or_default();
        let text = if self.0.contains(&'/') { &path } else { name };
        let text: Vec<char> = text.chars().collect();
        // The element `ends[n]` says whether the pattern's first `at` characters match the first n
        // characters of `text`.
        let mut ends = vec![false; text.len() + 1];
        ends[0] = true;
        let mut at = 0;
        while let Some(&letter) = self.0.get(at) {
            let is_double = letter == '*' && self.0.get(at + 1) == Some(&'*');
            at += if is_double { 2 } else { 1 };
            match letter {
                '*' => {
                    for end in 0..text.len() {
                        ends[end + 1] |= ends[end] && (is_double || text[end] != '/');
                    }
                }
                _ => {
                    let fits = |c: char| c == letter || letter == '?' && c != '/';
                    for end in (0..text.len()).rev() {
                        ends[end + 1] = ends[end] && fits(text[end]);
                    }
                    ends[0] = false;
                }
            }
        }
        ends[text.len()]
    }
}

#[cfg(test)]
mod tests {
    use super::Glob;

    #[test]
    fn a_pattern_is_of_a_name_or_of_a_path() {
        for (pattern, path, matches) in [
            ("*.png", "a/b/Render.PNG", true),
            ("*.png", "a/render.png.txt", false),
            ("render?.png", "render1.png", true),
            ("render?.png", "render.png", false),
            ("out/*.png", "out/a.png", true),
            ("out/*.png", "x/out/a.png", false),
            ("out/*.png", "out/a/b.png", false),
            ("**/final.*", "a/b/final.exr", true),
            ("**a*b", "xx/aab", true),
            ("a*", "b", false),
            ("", "", true),
        ] {
            assert_eq!(
                Glob::new(pattern).matches(path),
                matches,
                "{pattern} {path}"
            );
        }
    }
}
