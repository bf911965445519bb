//! The machine on which times were measured.

use std::{num::NonZero, thread};

use crate::files::read_system_text;

/// Properties of a machine that affect the time of renders.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Machine {
    /// Name of the processor's model. If the system does not report it, the processor's
    /// architecture.
    pub processor: String,
    /// Number of processors that this process may use.
    pub processors: usize,
}

impl Machine {
    /// Returns the properties of this machine.
    pub fn here() -> Self {
        Self {
            processor: model().unwrap_or_else(|| std::env::consts::ARCH.to_owned()),
            processors: thread::available_parallelism().map_or(1, NonZero::get),
        }
    }
}

/// Returns the name of the processor's model from `/proc/cpuinfo`, or `None` if the file does not
/// contain one. Systems other than Linux do not have the file.
fn model() -> Option<String> {
    let table = read_system_text("/proc/cpuinfo")?;
    let line = table.lines().find(|line| line.starts_with("model name"))?;
    let name = line.split_once(':')?.1.trim();
    (!name.is_empty()).then(|| name.to_owned())
}
