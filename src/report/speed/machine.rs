//! What the times were measured on.

use std::{num::NonZero, thread};

use crate::files::read_system_text;

/// A machine, as far as it matters for times.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Machine {
    /// The processor's model, as the system names it; its architecture where the system does not
    /// say.
    pub processor: String,
    /// How many processors this process may use.
    pub processors: usize,
}

impl Machine {
    /// This one.
    pub fn here() -> Self {
        Self {
            processor: model().unwrap_or_else(|| std::env::consts::ARCH.to_owned()),
            processors: thread::available_parallelism().map_or(1, NonZero::get),
        }
    }
}

/// What Linux calls the processor; other systems tell only those who link with them.
fn model() -> Option<String> {
    let table = read_system_text("/proc/cpuinfo")?;
    let line = table.lines().find(|line| line.starts_with("model name"))?;
    let name = line.split_once(':')?.1.trim();
    (!name.is_empty()).then(|| name.to_owned())
}
