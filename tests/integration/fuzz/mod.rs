//! Fuzz tests: for random inputs, nothing panics or takes forever, and stated properties hold.
//!
//! In a normal run, each test tries a few inputs. `PINHOLE_FUZZ=1000000 cargo test fuzz` tries a
//! million per test, starting at the input number `PINHOLE_FUZZ_FIRST`. An input depends only on
//! its number.

mod host;
mod messages;
mod pictures;
mod texts;

use std::{
    env,
    io::{self, Write},
    process,
    sync::{
        LazyLock,
        mpsc::{self, RecvTimeoutError},
    },
    thread,
    time::Duration,
};

use crate::{diagnostics::fixtures, format::all_scenes, random::Random};

/// Maximum time for an input. If a test takes longer, it is regarded as an endless loop. An input
/// takes milliseconds, but a busy machine may pause for seconds. A longer limit would only delay
/// the message.
const PATIENCE: Duration = Duration::from_secs(20);

/// Calls `run` and returns its result. If it takes longer than [`PATIENCE`], prints the text of
/// `what` and aborts the test process, because the thread cannot be stopped.
pub fn ends_soon<T>(what: impl Fn() -> String + Sync, run: impl FnOnce() -> T) -> T {
    let (done, is_done) = mpsc::channel::<()>();
    let what = &what;
    thread::scope(|scope| {
        scope.spawn(move || {
            if is_done.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
                // The test harness would print a test's output only at the end of the test, which
                // is never reached. So the text is written directly to the standard error stream.
                let _ = writeln!(io::stderr(), "this does not end: {}", what());
                process::abort();
            }
        });
        let result = run();
        drop(done);
        result
    })
}

/// Words, numbers and signs that are inserted into random texts. Bars separate them.
const WORDS: &str = "0|-0|1|.5|5.|1e308|-1e308|1e309|1e-320|1e-400|9007199254740993|0x10|NaN|inf|1_000|1__0|90deg|2.5.5|#fff|#12|\
    (|)|{|}|[|]|,|;|:|=|==|+|-|--|*|/|^|'|\"|//|/*|*/|#|$|@|\\|\u{feff}|\u{202e}|\u{a0}|\u{e9}|e\u{301}|\u{1f600}|\0|\r|\r\n|\n|\t|\u{85}|\u{2028}|\
    let|for i < 3|for|<|i|sphere|box|triangle|checkerboard|camera|image|sampler|eye|lookat|direction|fov|d|near|far|up|roll|center|radius|size|color|\
    colors|square|y|v0|v1|v2|normal|sides|method|per_pixel|total|seed|width|height|background|min|max|sqrt|rgb|exact|EYE|radus|pi|x|a";

/// Calls `is_tried` with random generators, one after another. There are `usual` generators, unless
/// the environment variable `PINHOLE_FUZZ` gives another number. Each generator depends only on its
/// index. If a call panics or does not end in time, prints the environment variables with which a
/// run repeats only this call.
pub fn each(usual: u64, mut is_tried: impl FnMut(&mut Random)) {
    struct Number(u64);
    impl Number {
        fn again(&self) -> String {
            format!("PINHOLE_FUZZ_FIRST={} PINHOLE_FUZZ=1", self.0)
        }
    }
    impl Drop for Number {
        fn drop(&mut self) {
            if thread::panicking() {
                eprintln!("{}", self.again());
            }
        }
    }
    let number = |name| Some(env::var(name).ok()?.parse().expect("a whole number"));
    let first = number("PINHOLE_FUZZ_FIRST").unwrap_or(0);
    for input in first..first + number("PINHOLE_FUZZ").unwrap_or(usual) {
        let number = Number(input);
        ends_soon(|| number.again(), || is_tried(&mut Random::new(input)));
        drop(number);
    }
}

/// Returns the texts of all scenes of the repository that are shorter than 4000 bytes, including
/// scenes with mistakes.
fn scenes() -> &'static [String] {
    static SCENES: LazyLock<Vec<String>> = LazyLock::new(|| {
        let wrong = fixtures().map(|(_, sources)| sources.file.text().to_owned());
        let all = all_scenes().into_iter().chain(wrong);
        all.filter(|text| (1..4000).contains(&text.len())).collect()
    });
    &SCENES
}

/// Returns the text of a randomly chosen scene of the repository.
fn any_text(random: &mut Random) -> &'static str {
    random.one_of::<String>(scenes())
}

/// Returns a randomly chosen scene of the repository with a few mistakes: tokens are removed,
/// doubled, moved or replaced, or the end is cut off.
fn scene(random: &mut Random) -> Vec<u8> {
    let text = any_text(random);
    let mut tokens = tokens(text);
    let words: Vec<&str> = WORDS.split('|').collect();
    for _ in 0..=random.below(6) {
        let (at, other) = (
            random.below(tokens.len() + 1),
            random.below(tokens.len() + 1),
        );
        let (from, to) = (at.min(other), at.max(other));
        match random.below(12) {
            0..=3 => {
                let end = tokens.len().min(at + random.below(2));
                tokens.splice(at..end, [*random.one_of(&words)]);
            }
            4..=5 => drop(tokens.drain(at..tokens.len().min(at + 1 + random.below(3)))),
            6 if to < tokens.len() => tokens.swap(from, to),
            7 if at < tokens.len() => {
                let times = [1, 2, 300][random.below(3)];
                let token = tokens[at];
                tokens.splice(at..at, [token].repeat(times));
            }
            8 => {
                let part = tokens[from..to.min(from + 40)].to_vec();
                tokens.splice(at..at, part);
            }
            9 if random.below(4) == 0 => tokens.truncate(at),
            10 => {
                let other = self::tokens(any_text(random));
                let start = random.below(other.len());
                let end = other.len().min(start + 30);
                tokens.splice(at..at, other[start..end].iter().copied());
            }
            _ => {}
        }
    }
    let mut bytes = tokens.concat().into_bytes();
    match random.below(20) {
        0 => bytes.splice(0..0, *b"\xef\xbb\xbf").for_each(drop),
        1 => {
            let text = String::from_utf8_lossy(&bytes).replace('\n', "\r\n");
            bytes = text.into_bytes();
        }
        2 => flip(random, &mut bytes),
        _ => {}
    }
    bytes
}

/// Splits a text into words, numbers, runs of spaces, and single other characters.
fn tokens(text: &str) -> Vec<&str> {
    let kind = |c: char| match c {
        _ if c.is_alphanumeric() || matches!(c, '_' | '.') => 0,
        ' ' => 1,
        _ => 2,
    };
    let mut tokens = Vec::new();
    let mut start = 0;
    let mut last = None;
    for (at, c) in text.char_indices() {
        let this = kind(c);
        if last.is_some_and(|last| last != this || this == 2) {
            tokens.push(&text[start..at]);
            start = at;
        }
        last = Some(this);
    }
    tokens.push(&text[start..]);
    tokens
}

/// Makes one to eight random changes to `bytes`: overwrites bytes and 32-bit numbers, and removes
/// or doubles parts.
fn flip(random: &mut Random, bytes: &mut Vec<u8>) {
    for _ in 0..=random.below(8) {
        let at = random.below(bytes.len());
        let end = bytes.len().min(at + 1 + random.below(16));
        match random.below(8) {
            0 if !bytes.is_empty() => bytes[at] ^= 1 << random.below(8),
            1 if !bytes.is_empty() => bytes[at] = *random.one_of(&[0, 1, 0x7f, 0x80, 0xff]),
            2 => bytes[at..end].fill(*random.one_of(&[0, 0xff])),
            3 => drop(bytes.drain(at..end)),
            4 => {
                let part = bytes[at..end].to_vec();
                bytes.splice(at..at, part);
            }
            5 if random.below(8) == 0 => bytes.truncate(at),
            6 if at + 4 <= bytes.len() => {
                let value = *random.one_of(&[0_u32, 1, 0x7fff_ffff, u32::MAX, 65_536, 1 << 28]);
                let value = match random.below(2) {
                    0 => value.to_be_bytes(),
                    _ => value.to_le_bytes(),
                };
                bytes[at..at + 4].copy_from_slice(&value);
            }
            _ => bytes.extend((0..random.below(9)).map(|_| random.bits() as u8)),
        }
    }
}
