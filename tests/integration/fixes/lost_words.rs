//! Checks that safe fixes keep every number and every name. A fix may replace a name by a similar
//! known name, and may add only keywords, units and punctuation. A separate scanner reads the words
//! of a text, also those in comments, so that lost comments are noticed.

use pinhole::{
    diagnostic::Applicability,
    scene,
    schema::{self, BLOCKS},
    source::{Source, Sources},
    suggest,
};

use crate::random::Random;

/// Spellings of units, separated by spaces. Each row also has the factor by which a number with
/// such a unit is multiplied before it is compared. So lengths are compared in metres, and gons
/// become degrees. Degrees and radians have the factor 1, so their numbers are compared as written.
const UNITS: [(&str, f64); 9] = [
    ("cm", 0.01),
    ("mm", 0.001),
    ("km", 1000.0),
    ("ft feet foot", 0.3048),
    ("in inch inches", 0.0254),
    ("m metre metres meter meters px pixel pixels f", 1.0),
    ("deg degs degree degrees °", 1.0),
    ("rad rads radian radians", 1.0),
    ("grad grads gon", 0.9),
];

/// Numbers and names of a text, in order. Each number is multiplied by the factor of its unit.
#[derive(Debug, Default)]
struct Words {
    numbers: Vec<f64>,
    names: Vec<String>,
}

impl Words {
    /// Reads the words of `text`. If `is_two` is set, a field's name that is joined to its value,
    /// such as `radius2`, is read as two words. A word such as `centerball` is split only if `ball`
    /// is also a word of the whole text `all`.
    fn of(text: &str, all: &str, is_two: bool) -> Self {
        let mut words = Self::default();
        // A zero-width space is invisible and not part of a number, so it is removed.
        let text = &text.replace('\u{200b}', "");
        let mut rest = text.as_str();
        let mut is_number_before = false;
        while let Some(first) = rest.chars().next() {
            if starts_number(rest) {
                let length = number_length(rest);
                let digits = rest[..length].replace('_', "");
                words.numbers.push(digits.parse().unwrap());
                rest = &rest[length..];
                is_number_before = true;
                continue;
            }
            if is_letter(first) || (first == '°' && is_number_before) {
                let length = match first {
                    '°' => first.len_utf8(),
                    _ => rest
                        .find(|c: char| !(is_letter(c) || c.is_ascii_digit()))
                        .unwrap_or(rest.len()),
                };
                // In `0.5x1.5x2`, the `x` means multiplication and is skipped.
                let is_times = rest.starts_with(['x', 'X'])
                    && starts_number(&rest[1..])
                    && text[..text.len() - rest.len()].ends_with(|c: char| c.is_ascii_digit());
                if is_times {
                    rest = &rest[1..];
                    continue;
                }
                let field = joined_field(&rest[..length], all).filter(|_| is_two);
                let length = field.unwrap_or(length);
                let word = &rest[..length];
                rest = &rest[length..];
                let is_it = |row: &&(&str, f64)| {
                    row.0.split(' ').any(|unit| unit.eq_ignore_ascii_case(word))
                };
                match UNITS.iter().find(is_it).filter(|_| is_number_before) {
                    Some((_, factor)) => {
                        *words.numbers.last_mut().unwrap() *= factor;
                        // A unit may be written twice, as in `30deg degrees`, so the next word may
                        // be a unit, too.
                        continue;
                    }
                    None => words.names.push(word.to_owned()),
                }
            } else {
                rest = &rest[first.len_utf8()..];
            }
            is_number_before &= first.is_whitespace() && first != '\n';
        }
        words
    }
}

/// If `word` is a field's name joined with a value, returns the length of the field's name.
/// Examples are `radius2`, and `centerball` if the whole text `all` contains the word `ball`.
/// Returns `None` if `word` is itself a field's name or does not start with one.
fn joined_field(word: &str, all: &str) -> Option<usize> {
    if BLOCKS.iter().any(|block| block.field(word).is_some()) {
        return None;
    }
    let is_value = |rest: &str| {
        rest.starts_with(|c: char| c.is_ascii_digit())
            || schema::css::color(rest).is_some()
            || ["deg", "rad", "rgb"].contains(&rest)
            || all
                .split(|c: char| !is_letter(c) && !c.is_ascii_digit())
                .any(|other| other == rest)
    };
    let mut fields = BLOCKS.iter().flat_map(|block| block.field_names());
    let found = fields.find(|field| word.strip_prefix(field).is_some_and(is_value));
    found.map(str::len)
}

fn starts_number(text: &str) -> bool {
    let digits = text.strip_prefix('.').unwrap_or(text);
    digits.starts_with(|c: char| c.is_ascii_digit())
}

fn is_letter(c: char) -> bool {
    c.is_alphabetic() || c == '_'
}

/// Returns the length, in bytes, of the number at the start of a text.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let is_digit = |at: usize| bytes.get(at).is_some_and(u8::is_ascii_digit);
    let digits = |mut at: usize| {
        while is_digit(at) || (bytes.get(at) == Some(&b'_') && is_digit(at + 1)) {
            at += 1;
        }
        at
    };
    let mut end = digits(0);
    if bytes.get(end) == Some(&b'.') {
        end = digits(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        if is_digit(end + 1 + sign) {
            end = digits(end + 1 + sign);
        }
    }
    end
}

/// Returns the words of the language, including units.
fn keywords() -> impl Iterator<Item = &'static str> {
    let blocks = BLOCKS.iter().map(|block| block.name);
    let fields = BLOCKS.iter().flat_map(|block| block.field_names());
    blocks
        .chain(fields)
        .chain(["let", "for", "rgb", "deg", "rad"])
}

/// Returns whether the spellings of two words are similar.
fn is_near(new: &str, old: &str) -> bool {
    suggest::nearest(old, [new]).is_some() || suggest::is_among(old, new)
}

/// Returns whether a fix may replace `old` by `new`, a word of the scene language, because both
/// mean the same. `old` is a word of another program's language, or `new` in another notation, such
/// as `0xff` for `ff`.
fn is_known_for(new: &str, old: &str) -> bool {
    let is_tried = |block: &schema::BlockRow| {
        let field = block.field_tried(old);
        let mut several = block.several.iter();
        field.is_some_and(|field| field.name == new)
            || (block.name == new && suggest::is_among(old, block.also_tried))
            || several.any(|(words, fields)| suggest::is_among(old, words) && fields.contains(&new))
    };
    BLOCKS.iter().any(is_tried)
        || schema::nearest_method(old) == Some(new)
        || old.strip_prefix("0x") == Some(new)
}

/// Applies the safe fixes to `text`. Returns the new text, and a complaint about each number or
/// name that was lost or added.
pub fn fix_safely(text: &str) -> (String, Vec<String>) {
    let sources = Sources::new(Source::from_text("a.scn", text));
    let fixed = scene::fix_all(&sources, Applicability::Safe);
    let words = |of: &str, is_two| Words::of(of, text, is_two);
    let (before, after) = (words(text, true), words(&fixed.text, true));
    let removed = fixed.done.iter().filter(|done| {
        done.title.starts_with("remove this `let") || done.title.starts_with("keep the first")
    });
    let has_removed = removed.count() > 0;
    let mut complaints = Vec::new();
    let is_same = |a: f64, b: f64| a == b || (a - b).abs() <= 1e-9 * a.abs();
    let mut left = after.numbers.iter();
    let mut lost = Vec::new();
    let mut next = left.next();
    for &number in &before.numbers {
        match next {
            Some(&other) if is_same(number, other) => next = left.next(),
            _ => lost.push(number),
        }
    }
    let is_elsewhere = |lost: &f64| after.numbers.iter().any(|&other| is_same(*lost, other));
    if next.is_some() {
        complaints.push(format!("a number is new: {next:?}"));
    }
    let is_listed = has_removed && lost.iter().all(is_elsewhere);
    if !lost.is_empty() && !is_listed {
        complaints.push(format!("numbers are lost: {lost:?}"));
    }
    // A fix may join two successive names to a known word: `look at` becomes `lookat`. From the
    // names alone, it is not known which pairs a fix has joined. Therefore, the last four pairs
    // that may have been joined are compared both joined and separate, in all combinations. The
    // combination with the fewest lost and added names is used.
    const WAYS: i32 = 1 << 4;
    let read = |of| [true, false].map(|is_two| words(of, is_two).names);
    let (before, after) = (read(text), read(&fixed.text));
    let all = |apart| {
        let read = before.iter().map(move |before| (apart, before));
        let after = &after;
        read.flat_map(move |(apart, before)| after.iter().map(move |it| (apart, before, it)))
    };
    let size = |(lost, new): &(Vec<String>, Vec<String>)| lost.len() + new.len();
    let mut least: Option<(Vec<String>, Vec<String>)> = None;
    for (apart, before, after) in (0..WAYS).flat_map(all) {
        if least.as_ref().is_some_and(|least| size(least) == 0) {
            break;
        }
        let way = unmatched_names(before, after, !apart);
        if least.as_ref().is_none_or(|least| size(&way) < size(least)) {
            least = Some(way);
        }
    }
    let (lost, new) = least.unwrap();
    let is_listed = has_removed && lost.iter().all(|name| after[0].contains(name));
    if !lost.is_empty() && !is_listed {
        complaints.push(format!("names are lost: {lost:?}"));
    }
    if !new.is_empty() {
        complaints.push(format!("names are new: {new:?}"));
    }
    let titles: Vec<&str> = fixed.done.iter().map(|done| done.title.as_str()).collect();
    for complaint in &mut complaints {
        *complaint += &format!("\n{titles:?}\n{text}\n--\n{}", fixed.text);
    }
    (fixed.text, complaints)
}

/// Returns the names of `before` that are not in `after`, and the names of `after` that are not in
/// `before`.
///
/// A fix may have joined two successive names of `before` to a known word: `look at` becomes
/// `lookat`. Each pair that may have been joined has a bit of `joins`, beginning with the lowest
/// bit for the last pair in the text. If the bit is 1, the pair is compared as one name. The sign
/// bit, which shifting repeats, stands for all earlier pairs.
fn unmatched_names(
    before: &[String],
    after: &[String],
    mut joins: i32,
) -> (Vec<String>, Vec<String>) {
    let (mut names, mut new) = (before.to_vec(), after.to_vec());
    // A fix joins two words only if the result is a known word, such as `lookat`.
    let is_known = |word: &String| {
        BLOCKS.iter().any(|block| block.field(word).is_some())
            || schema::css::color(word).is_some()
            || schema::method(word).is_some()
    };
    let times = |all: &[String], word: &String| all.iter().filter(|other| *other == word).count();
    for at in (1..names.len()).rev() {
        let Some([one, two]) = names.get(at - 1..=at) else {
            continue;
        };
        let joined = [format!("{one}{two}"), format!("{one}_{two}")];
        let is_joined = |word: &&String| is_known(word) && times(&new, word) > times(&names, word);
        if let Some(word) = joined.iter().find(is_joined).cloned() {
            let is_meant = joins & 1 == 1;
            joins >>= 1;
            if !is_meant {
                continue;
            }
            names.drain(at - 1..=at);
            new.remove(new.iter().position(|other| *other == word).unwrap());
        }
    }
    let is_same = |new: &str, old: &str| new == old;
    for is_for in [is_same, is_near, is_known_for] {
        names.retain(|name| {
            let at = new.iter().position(|other| is_for(other, name));
            at.map(|at| new.remove(at)).is_none()
        });
    }
    // The fix of `let Ball = sphere {` makes it a block, and so removes the word `let`.
    names.retain(|name| name != "let");
    new.retain(|name| !keywords().any(|word| word == name));
    (names, new)
}

/// Calls `is_tried` with `count` texts. Each is made from one of `texts` by one to four random
/// mistakes. The texts are equal in every run.
pub fn slips(texts: &[String], count: usize, mut is_tried: impl FnMut(&str)) {
    let mut random = Random::new(1);
    for _ in 0..count {
        let mut text = random.one_of(texts).clone();
        for _ in 0..1 + random.below(4) {
            text = slip(&text, &mut random);
        }
        is_tried(&text);
    }
}

/// Returns `text` with one random mistake: for example, a word, number or sign is removed, doubled,
/// misspelled, or followed by another one.
fn slip(text: &str, random: &mut Random) -> String {
    const OTHERS: [&str; 72] = [
        "radius",
        "center",
        "2",
        "-1.5",
        ",",
        "=",
        "(",
        ")",
        "{",
        "}",
        "[",
        "]",
        "<1, 2, 3>",
        "let",
        "red",
        "-",
        "*",
        "^2",
        "deg",
        "#",
        "\"",
        ";",
        ":",
        "+",
        "//",
        "/* c */",
        "#ff8800",
        "0.785",
        "R",
        "vec3(1, 2, 3)",
        "(1, 2)",
        "[3, 4, 5]",
        "rgb",
        "cm",
        "30 degrees",
        "1,5",
        "x",
        "\u{200b}",
        "\u{a0}",
        "let a = 2",
        "let a = 3",
        "radius 2",
        "radius 2",
        "color <1, 0, 0>",
        "color 255 0 0",
        "camera { eye (1, 2, 3)  lookat (0, 0, 0) }",
        "sphere { <1, 2, 3>, R }",
        "look (0, 0, -1)",
        "fov 45",
        "fov 0.785",
        "d 3",
        "aspect 16/9",
        "width 640",
        "zoom 2",
        "size 2",
        "2 pi",
        "4x4",
        "0.5x1.5x2",
        "var b = 7",
        "b = 7",
        "Ball = sphere {",
        "look at",
        "diameter 3",
        "1e3",
        ".5",
        "position",
        "colour",
        "samples 16",
        "# note 5",
        "-- note 6",
        "sin 30",
        "1 000",
    ];
    let pieces = pieces(text);
    if pieces.is_empty() {
        return text.to_owned();
    }
    let piece = random.one_of(&pieces).clone();
    let (before, word, after) = (
        &text[..piece.start],
        &text[piece.clone()],
        &text[piece.end..],
    );
    let other = *random.one_of(&OTHERS);
    let some = text[random.one_of(&pieces).clone()].to_owned();
    let letters: Vec<char> = word.chars().collect();
    let at = random.below(letters.len());
    let word_of = |letters: Vec<char>| letters.into_iter().collect::<String>();
    let changed = match random.below(12) {
        0 => String::new(),
        1 => format!("{word} {word}"),
        2 => other.to_owned(),
        3 => format!("{word} {other}"),
        4 => format!("{other} {word}"),
        5 => some,
        6 => format!("{word} {some}"),
        7 => format!("{word}{other}"),
        8 => word_of([&letters[..at], &letters[at + 1..]].concat()),
        9 => word_of([&letters[..=at], &letters[at..]].concat()),
        10 => {
            let mut letters = letters;
            let next = (at + 1) % letters.len();
            letters.swap(at, next);
            word_of(letters)
        }
        _ => format!("{word}\n{other}\n"),
    };
    format!("{before}{changed}{after}")
}

/// Returns the ranges of the words, numbers and signs of a text.
fn pieces(text: &str) -> Vec<std::ops::Range<usize>> {
    let mut pieces = Vec::new();
    let mut at = 0;
    while let Some(first) = text[at..].chars().next() {
        let is_word = |c: char| is_letter(c) || c.is_ascii_digit() || c == '.';
        let end = if is_word(first) {
            text[at..]
                .find(|c| !is_word(c))
                .map_or(text.len(), |to| at + to)
        } else {
            at + first.len_utf8()
        };
        if !first.is_whitespace() {
            pieces.push(at..end);
        }
        at = end;
    }
    pieces
}
