//! Runs the shell transcripts in `tests/cli`. A line that begins with `$` is a command. The lines
//! below it are the expected standard output (`<`), standard error (`!`) and, unless it is 0, exit
//! status (`=`). If the last line of an output has no line end, a `\` follows it. `#` begins a
//! comment. Each transcript runs in a folder of its own, with a small scene in `a.scn`.
//!
//! `PINHOLE_BLESS=1 cargo test` rewrites the expected results.

use std::{fs, path::Path, thread};

use super::folder;
use crate::{program::names, snapshot::assert_file};

fn replayed(transcript: &str) -> String {
    let folder = folder();
    let mut real = String::new();
    for line in transcript
        .lines()
        .filter(|line| !line.starts_with(['<', '!', '=']))
    {
        real += &format!("{line}\n");
        let Some(command) = line.strip_prefix("$ ") else {
            continue;
        };
        let said = folder.shell(command);
        for (sign, text) in [("<", said.text()), ("!", &said.errors)] {
            let lines = text.split_inclusive('\n').map(|line| {
                let marked = match line.strip_suffix('\n') {
                    Some("") => sign.to_owned(),
                    Some(line) => format!("{sign} {line}"),
                    None => format!("{sign} {line}\\"),
                };
                marked + "\n"
            });
            real.extend(lines);
        }
        if said.status != 0 {
            real += &format!("= {}\n", said.status);
        }
    }
    real
}

#[test]
fn cli_transcripts_match_the_program() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cli");
    let is_there = |name: &String| match name.as_str() {
        "full_disk.txt" => cfg!(target_os = "linux"),
        _ => true,
    };
    let names = names(&folder);
    assert!(!names.is_empty());
    thread::scope(|scope| {
        for name in names.into_iter().filter(is_there) {
            let path = folder.join(name);
            scope.spawn(move || {
                let transcript = fs::read_to_string(&path).expect("a transcript");
                assert_file(&path, &replayed(&transcript));
            });
        }
    });
}
