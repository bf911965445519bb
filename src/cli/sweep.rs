//! `--sweep TARGET=FROM..TO/N`: makes N scenes from one. In them, the target (a field or a `let`)
//! goes from one value to another in equal steps.

use std::str::FromStr;

use super::{CommandError, command_error};
use crate::{
    numbers::{short, short_vector},
    scene::analyze,
    schema::Value,
    source::{Source, Sources},
};

/// Maximum number of scenes in a sweep. More are rejected, because a sheet with more pictures would
/// hardly be readable, and because a mistyped number could take very long.
const MOST: usize = 1000;

/// The argument of `--sweep`: the target, the first and last value, and the number of scenes.
#[derive(Clone, Debug)]
pub struct Sweep {
    target: String,
    from: String,
    to: String,
    count: usize,
}

/// One scene of a sweep.
pub struct SweepStep {
    /// The `--set` argument, with the exact value of the target.
    pub set: String,
    /// The `--set` argument with its value rounded to few digits, for the scene's caption.
    pub label: String,
}

impl FromStr for Sweep {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let form = || "write TARGET=FROM..TO/N, such as `camera.roll=0deg..90deg/10`".to_owned();
        let (target, values) = text.split_once('=').ok_or_else(form)?;
        let (values, count) = values.rsplit_once('/').ok_or_else(form)?;
        let (from, to) = ends(values).ok_or_else(form)?;
        if to.starts_with('.') {
            return Err(format!(
                "two points stand between FROM and TO, and a number such as `0{to}` has a digit before its own"
            ));
        }
        let [target, from, to, count] =
            [target, from, to, count].map(|part| part.trim().to_owned());
        if target.is_empty() || from.is_empty() || to.is_empty() {
            return Err(form());
        }
        match count.parse() {
            Ok(count @ 2..=MOST) => Ok(Self {
                target,
                from,
                to,
                count,
            }),
            _ => Err(format!(
                "`{count}` stands behind the last `/`, where a number of pictures from 2 to {MOST} is wanted"
            )),
        }
    }
}

/// Splits a text at the first `..` outside of parentheses. Returns `None` if there is none.
fn ends(values: &str) -> Option<(&str, &str)> {
    let mut open = 0_usize;
    let at = values.char_indices().find(|&(at, c)| {
        match c {
            '(' => open += 1,
            ')' => open = open.saturating_sub(1),
            _ => {}
        }
        open == 0 && values[at..].starts_with("..")
    });
    let (at, _) = at?;
    Some((&values[..at], &values[at + 2..]))
}

impl Sweep {
    /// Returns the number of scenes.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Returns the `--set` arguments of the first and the last scene, with the values as the user
    /// typed them.
    pub fn ends(&self) -> [String; 2] {
        [&self.from, &self.to].map(|value| format!("{}={value}", self.target))
    }

    /// Returns the scenes of the sweep, with values in equal steps from the first to the last one.
    /// The scene language computes these values: for each of them, a `let` is added to the end of
    /// the text.
    ///
    /// # Errors
    ///
    /// Returns an error if there are no values between the first and the last one, for example
    /// because the values are words or colours.
    pub fn steps(&self, sources: &Sources) -> Result<Vec<SweepStep>, CommandError> {
        let Self {
            from, to, count, ..
        } = self;
        let mut text = sources.file.text().to_owned();
        let mut name = "step".to_owned();
        while text.contains(&name) {
            name += "_";
        }
        for i in 0..*count {
            let between = format!("({from}) + (({to}) - ({from})) * {i} / {}", count - 1);
            text += &format!("\nlet {name}{i} = {between}");
        }
        let mut sources = sources.clone();
        sources.file = Source::from_text(sources.file.name(), text);
        let model = analyze(&sources);
        let first = model.definitions().count().saturating_sub(*count);
        let steps = model.definitions().skip(first);
        let steps = steps.map(|step| self.step(model.defined(step)?));
        let steps: Option<Vec<SweepStep>> = steps.collect();
        steps
            .filter(|steps| steps.len() == *count)
            .ok_or_else(|| self.nothing_between())
    }

    fn step(&self, value: Value) -> Option<SweepStep> {
        let shown = match value {
            Value::Number(number) => short(number),
            Value::Angle(angle) => format!("{}deg", short(angle.in_degrees())),
            Value::Vector(vector) => short_vector(vector),
            Value::Color(_) | Value::Colors(_) | Value::FaceColors(_) | Value::Method(_) => {
                return None;
            }
        };
        let target = &self.target;
        Some(SweepStep {
            set: format!("{target}={value}"),
            label: format!("{target}={shown}"),
        })
    }

    fn nothing_between(&self) -> CommandError {
        let (from, to) = (&self.from, &self.to);
        command_error(format!(
            "--sweep finds nothing between `{from}` and `{to}`: it goes between two numbers, angles or vectors with a finite difference"
        ))
    }
}
