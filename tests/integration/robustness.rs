//! Tests that reading any text ends soon. If there is no scene, an error is reported, and all
//! labels lie within the text.
//!
//! Exhaustive runs read texts of a megabyte and more; normal runs read some shorter texts.

use std::time::{Duration, Instant};

use crate::{
    effort::{Effort, sampled_and_exhaustive},
    format::{all_scenes, formatted},
    fuzz::ends_soon,
    parts,
    random::Random,
    scenes::{examples, sources},
};
use pinhole::{
    diagnostic::{self, Diagnostic, Drawing, Edit, MOST_PROBLEMS, Report, Style},
    format::format,
    scene,
    schema::BLOCKS,
    source::{Source, Sources, Span},
};

const MEGABYTE: usize = 1 << 20;

const CAMERA: &str = "camera { eye (0, 2, 8) lookat (0, 1, 0) }\n";

/// Reads a text, and formats its diagnostics as JSON and for people. Returns whether the text is a
/// valid scene.
#[track_caller]
pub fn read(bytes: impl Into<Vec<u8>>) -> bool {
    read_with_sets(bytes, &[])
}

/// Reads a text with `--set` arguments, and formats its diagnostics as JSON and for people. Returns
/// whether the result is a valid scene.
#[track_caller]
fn read_with_sets(bytes: impl Into<Vec<u8>>, sets: &[String]) -> bool {
    let bytes = bytes.into();
    let length = bytes.len();
    let start = Instant::now();
    let sources = Sources::new(Source::from_bytes("test.scn", bytes)).with_sets(sets);
    let reading = scene::read(&sources);
    let found = &reading.diagnostics;
    // The command `check` prints at most 1000 diagnostics of a file.
    let written = &found[..found.len().min(1000)];
    let json = diagnostic::json_lines(written, &sources);
    assert_eq!(json.lines().count(), written.len());
    let time = start.elapsed();
    // The limit is two seconds with optimization and ten seconds without. On an idle machine,
    // reading takes about half as long. The rest is for busy machines.
    let bound = Duration::from_secs(if cfg!(debug_assertions) { 10 } else { 2 });
    assert!(time < bound, "{time:?} for {length} bytes");
    for drawing in [Drawing::Unicode, Drawing::Narrated] {
        let style = Style {
            drawing,
            ..Style::default()
        };
        let text = Report::new(&sources, style).human(found);
        assert!(text.len() < MEGABYTE, "{} bytes of reports", text.len());
    }

    let has_error = found.iter().any(|d| d.is_error());
    assert_eq!(reading.scene.is_none(), has_error, "{found:?}");
    assert_places(found, &sources);
    reading.scene.is_some()
}

/// Asserts that all labels and edits begin and end between characters of the text, and that the
/// edits of a fix do not overlap.
#[track_caller]
fn assert_places(found: &[Diagnostic], sources: &Sources) {
    for diagnostic in found {
        assert!(!diagnostic.labels.is_empty(), "{diagnostic:?}");
        let has = |span: Span| sources.get(span.source).text().get(span.range()).is_some();
        let labels = diagnostic.labels.iter().map(|label| label.span);
        let edits = diagnostic.fixes.iter().flat_map(|fix| &fix.edits);
        let mut spans = labels.chain(edits.map(|edit| edit.span));
        assert!(spans.all(has), "{diagnostic:?}");
        for fix in &diagnostic.fixes {
            let is_apart = |pair: &[Edit]| {
                let [before, after] = [pair[0].span, pair[1].span];
                before.source != after.source || before.end <= after.start
            };
            assert!(fix.edits.windows(2).all(is_apart), "{fix:?}");
        }
    }
}

sampled_and_exhaustive!(random_bytes_are_read_soon_and_refused);

fn random_bytes_are_read_soon_and_refused(effort: Effort) {
    let length = effort.part_of(MEGABYTE);
    let mut random = Random::new(1);
    let bytes: Vec<u8> = (0..=255).collect();
    let signs = b" \n{}()+-*/,abcdef0123456789.#=\"let sphere";
    for letters in [&bytes[..], signs, b"(){}[] -,a1", b" "] {
        let letter = |_| letters[(random.bits() % letters.len() as u64) as usize];
        assert!(!read((0..length).map(letter).collect::<Vec<u8>>()));
    }
    let letters = (0..length / 4).map(|_| random.bits() % 0x11_0000);
    let many = letters.filter_map(|letter| char::from_u32(letter as u32));
    assert!(!read(many.collect::<String>()));
}

sampled_and_exhaustive!(every_short_sequence_of_words_is_parsed_to_its_end);

/// Reads every sequence of three words from a short list, in a block. In an exhaustive run, the
/// sequences have four words, and also stand alone or in a list. Asserts that reading ends soon,
/// and that there is a scene unless an error is reported.
fn every_short_sequence_of_words_is_parsed_to_its_end(effort: Effort) {
    let words = "{ } ( ) , = < - for let sphere e 8 # radius // \n";
    let words: Vec<&str> = words.split(' ').collect();
    let length = if effort == Effort::Exhaustive { 4 } else { 3 };
    let try_one = |text: &str| {
        let sources = Sources::new(Source::from_text("test.scn", text));
        let reading = scene::read(&sources);
        let has_error = reading.diagnostics.iter().any(|d| d.is_error());
        assert_eq!(reading.scene.is_none(), has_error, "{text}");
        assert_places(&reading.diagnostics, &sources);
    };
    for before in effort.of(["camera {", "", "sphere { center ("]) {
        for number in 0..words.len().pow(length - 1) {
            let word = |place| words[number / words.len().pow(place) % words.len()];
            let most: Vec<&str> = (0..length - 1).map(word).collect();
            let most = format!("{before} {}", most.join(" "));
            // Each call of `ends_soon` starts a thread, so one call tries several texts.
            ends_soon(
                || format!("{most} and one of {words:?}"),
                || (words.iter()).for_each(|last| try_one(&format!("{most} {last}"))),
            );
        }
    }
}

sampled_and_exhaustive!(a_token_repeated_many_times_is_read_soon);

fn a_token_repeated_many_times_is_read_soon(effort: Effort) {
    let length = effort.part_of(MEGABYTE / 4);
    let pieces = "{|}|(|)|[|-|+|/|/*|*/|//|\"|'|a |a\n|1 |1,|.|#|=|let |let a |a = |sphere |sphere {|sphere {}|a{|a(|a (1\n|let a = (|°|\u{feff}|\0|// nothing";
    for piece in pieces.split('|') {
        assert!(!read(piece.repeat(length / piece.len())), "{piece:?}");
        let within = piece.repeat(length / 4 / piece.len());
        read(format!("{CAMERA} sphere {{ center {within}"));
    }
    assert!(!read(""));
    // Each field is misspelled in its block.
    for block in BLOCKS {
        for field in block.field_names() {
            let piece = format!("x{field} 1\n");
            let within = piece.repeat(4 * length / piece.len());
            read(format!("{CAMERA} {} {{ {within} }}", block.name));
        }
    }
}

/// If a text has too many mistakes, only the first ten thousand are reported. A message then says
/// that the other mistakes are left out.
#[test]
fn reports_stop_at_the_maximum_number_of_problems() {
    let many = |piece: &str| piece.repeat(20_000);
    let names: String = (0..20_000)
        .map(|index| format!("let a = b{index}\n"))
        .collect();
    for text in [
        many("{}"),
        many("sphere {}\n"),
        many("spere {}\n"),
        many(","),
        names,
        format!("{CAMERA} sphere {{ {} }}", many("a 1  ")),
        format!("{CAMERA} let a = {}1", many("sin(1) + ")),
    ] {
        assert!(!read(&*text));
        let found = scene::read(&sources(&text)).diagnostics;
        assert!(
            found.len() <= 3 * (MOST_PROBLEMS + 1),
            "{} of {text:.40}",
            found.len()
        );
        let is_told = |it: &Diagnostic| it.message.contains("the others are left out");
        assert!(found.iter().any(is_told), "{text:.40}");
    }
    // This block has more mistakes than are reported. Its correct fields must not be reported.
    let signs = format!(
        "{CAMERA}sphere {{ center (0, 1, 0) {} radius 1 }}",
        many(", ")
    );
    let found = scene::read(&sources(&signs)).diagnostics;
    let codes: Vec<_> = found.iter().map(|it| &*it.code).collect();
    assert_eq!(
        codes,
        ["pinhole::needless_separator", "pinhole::unexpected"]
    );
    // Needless separators are reported in a single diagnostic. Its fix removes at most
    // [`MOST_PROBLEMS`] separators.
    let spheres = many("sphere { center (0, 1, 0) };\n");
    let found = scene::read(&sources(&format!("{CAMERA}{spheres}"))).diagnostics;
    let signs = found
        .iter()
        .find(|it| it.code == "pinhole::needless_separator");
    assert_eq!(signs.map(|it| it.fixes[0].edits.len()), Some(MOST_PROBLEMS));
}

#[test]
fn deeply_nested_values_are_refused_and_long_sums_accepted() {
    let deep = ["( 1 )", "- 1 ", "abs( 1 )", "(  ", "-(  "].map(|parts| {
        let [open, inner, close] = parts.split(' ').collect::<Vec<_>>()[..] else {
            panic!("{parts}");
        };
        open.repeat(100_000) + inner + &close.repeat(100_000)
    });
    // A delimiter in quotes does not close a list. So the lists in these texts are nested as deeply
    // as if the quotes were not there.
    let quotes = ["( ')' ", "( \"}\" ", "[ ']' + (\n", "(' \" ( ') \" "];
    let quotes = quotes.map(|piece| piece.repeat(100_000)).into_iter();
    let few_quotes = "( \")\" ".repeat(300);
    for value in deep.into_iter().chain(quotes).chain([few_quotes]) {
        assert!(!read(format!("{CAMERA} let a = {value}")));
    }
    // Long sums and long products are not nested deeply, so they are accepted.
    for sign in [" + ", " * "] {
        let long = vec!["1"; 100_000].join(sign);
        assert!(read(format!("{CAMERA} let a = {long}")), "{sign}");
    }
}

sampled_and_exhaustive!(a_line_of_ten_megabytes_is_read_soon);

fn a_line_of_ten_megabytes_is_read_soon(effort: Effort) {
    let ten = effort.part_of(10 * MEGABYTE);
    for (start, long, end, is_right) in [
        ("// ", "long ", "", true),
        ("", " ", "", true),
        ("", "x", "", false),
        ("let ", "x", " = 1 + red", false),
        ("sphere { ", " ", " center (0, 1, 0) radus 2 }", false),
    ] {
        let text = format!("{CAMERA}{start}{}{end}", long.repeat(ten / long.len()));
        assert_eq!(read(text), is_right, "{start}{long}{end}");
    }
}

sampled_and_exhaustive!(many_mistakes_and_many_names_are_read_soon);

/// Returns `count` copies of `line`. In each, `N` is replaced by the number of the copy, and `M` by
/// the next number.
fn numbered(line: &str, count: usize) -> Vec<String> {
    let of = |n: usize| {
        let line = line.replace('N', &n.to_string());
        line.replace('M', &(n + 1).to_string())
    };
    (0..count).map(of).collect()
}

fn many_mistakes_and_many_names_are_read_soon(effort: Effort) {
    let lines = |line: &str| numbered(line, effort.part_of(40_000)).concat();
    for wrong in [
        "let aN = bN\n",
        "let a = N\n",
        "sphere A { center (0, 1, 0) }\n",
        CAMERA,
        "sphere { center (0, 1, 0 }\n",
    ] {
        assert!(!read(format!("{CAMERA}{}", lines(wrong))));
    }
    // A definition that uses a later one is a mistake. To report it, the program examines the text
    // around it. All these mistakes are on one line, so a program that examined the whole line each
    // time would take quadratic time.
    let wrong_order = lines("let aN = bN /* N */ ") + &lines("/* N */ let bN = N ");
    assert!(!read(wrong_order));
    let chain = lines("let aM = aN + 1\n");
    assert!(read(format!("{CAMERA}let a0 = 0\n{chain}")));
}

sampled_and_exhaustive!(many_overrides_are_read_soon);

fn many_overrides_are_read_soon(effort: Effort) {
    let lines = |line: &str| numbered(line, effort.part_of(4_000));
    for (line, set, is_right) in [
        ("let aN = N\n", "aN=2", true),
        ("let aN = N\n", "zzN=2", false),
        ("sphere SN { center (0, 1, 0) }\n", "SN.radius=2", true),
        ("sphere SN { center (0, 1, 0) }\n", "TN.radius=2", false),
        ("sphere SN { center (0, 1, 0) }\n", "SN=2", false),
        ("sphere SN { center (0, 1, 0) }\n", "camera.e=2", false),
    ] {
        let text = format!("{CAMERA}{}", lines(line).concat());
        assert_eq!(read_with_sets(text, &lines(set)), is_right, "{set}");
    }
}

#[test]
fn diagnostics_of_truncated_scenes_point_into_the_text() {
    for text in all_scenes() {
        for (end, _) in text.char_indices().step_by(11) {
            let sources = sources(&text[..end]);
            assert_places(&scene::read(&sources).diagnostics, &sources);
        }
    }
}

#[test]
fn windows_line_ends_and_a_byte_order_mark_are_accepted() {
    for example in examples() {
        assert!(read(format!("\u{feff}{}", example.replace('\n', "\r\n"))));
    }
}

sampled_and_exhaustive!(scenes_with_random_slips_are_read_soon_and_alike_in_parts);

/// Reads texts with random mistakes, as a whole and in parts. A text that cannot be formatted must
/// have an error.
fn scenes_with_random_slips_are_read_soon_and_alike_in_parts(effort: Effort) {
    let mut scenes = all_scenes();
    scenes.retain(|text| (1..1000).contains(&text.len()));
    let slips = b"|(|)|{|}|}}|[|]|,|.|;|:|=|+|*|-|#ff|2.5.5| 2| x| radus | radius| let |let x = 1 |let x = |sphere {|sphere A { |'|\"|/*|*/|//|\xc2\xa0|\xc3\xa9|\xff|\r|\n|\0";
    let slips: Vec<&[u8]> = slips.split(|&byte| byte == b'|').collect();
    let mut random = Random::new(2);
    let texts = match effort {
        Effort::Sample => 300,
        Effort::Exhaustive => 8_000,
    };
    for _ in 0..texts {
        let mut up_to = |end: usize| (random.bits() % end as u64) as usize;
        let mut bytes = scenes[up_to(scenes.len())].clone().into_bytes();
        if up_to(4) == 0 {
            bytes.extend(format!("\n{}", scenes[up_to(scenes.len())]).bytes());
        }
        for _ in 0..up_to(4) {
            let at = up_to(bytes.len() + 1);
            let taken = if up_to(10) == 0 {
                bytes.len()
            } else {
                up_to(4)
            };
            let end = bytes.len().min(at + taken);
            bytes.splice(at..end, slips[up_to(slips.len())].iter().copied());
        }
        if let Ok(text) = str::from_utf8(&bytes) {
            // The result is not used: if the text cannot be formatted, `formatted` itself asserts
            // that at least one diagnostic is an error.
            let _ = formatted(text);
            parts::assert_same_in_parts(text, 1 + up_to(99), &[]);
        }
        read(bytes);
    }
}

sampled_and_exhaustive!(reading_time_grows_linearly_with_the_text);

/// For any kind of line, reading eight times as many lines takes about eight times as long, not 64
/// times.
fn reading_time_grows_linearly_with_the_text(effort: Effort) {
    let few = match effort {
        Effort::Sample => 1_000,
        Effort::Exhaustive => 2_000,
    };
    let sphere = |end: &str| format!("sphere {{ center (1, 2, 3)  radius 0.5  color {end}\n");
    let lines = [
        sphere("#808000 }"),
        sphere("olive } // olive"),
        sphere("olive } # olive"),
        sphere("olive } -- olive"),
        sphere("/* olive */ teal }"),
        sphere("olve }"),
        sphere("olive"),
        "let name = 1 + 2\n".to_owned(),
        "spere {}\n".to_owned(),
    ];
    // The sign `%` is replaced by a number, so that the names of fields, blocks and colours are all
    // different.
    let numbered = [
        "eyf% (0, 0, 1)\n",
        "blok% { x 1 }\n",
        "sphere { color ol% }\n",
    ];
    for line in effort.of(lines.into_iter().chain(numbered.map(str::to_owned))) {
        let read = |source: Source| drop(scene::read(&Sources::new(source)));
        let lay_out = |source: Source| drop(format(&source));
        let is_laid_out = format(&Source::from_text("test.scn", line.as_str())).is_ok();
        let works = [read as fn(Source), lay_out];
        for work in &works[..1 + usize::from(is_laid_out)] {
            let time = |lines: usize| {
                let lines = (0..lines).map(|index| line.replace('%', &index.to_string()));
                let block = if line.starts_with("eyf") { "box {" } else { "" };
                let text = format!("{CAMERA}{block}{}", lines.collect::<String>());
                let start = Instant::now();
                work(Source::from_text("test.scn", text));
                start.elapsed()
            };
            let once = (0..3).map(|_| time(few)).min().unwrap_or_default();
            let many = time(8 * few);
            assert!(many < 32 * once, "{once:?} and {many:?}: {line}");
        }
    }
}
