//! Reads text files of the operating system.

use std::{fs::File, io::Read, path::Path};

/// Reads a text file of the system, such as `/proc/meminfo`. Returns `None` if the file cannot be
/// read.
pub fn read_system_text(path: impl AsRef<Path>) -> Option<String> {
    /// Maximum length of the file, in bytes. A longer file is not read. The longest one that is
    /// needed, `/proc/cpuinfo`, has a few thousand bytes per processor, so 16 MiB suffice for
    /// thousands of processors.
    const LIMIT: u64 = 16 << 20;
    let mut text = String::new();
    let mut file = File::open(path).ok()?.take(LIMIT + 1);
    let length = file.read_to_string(&mut text).ok()?;
    (length as u64 <= LIMIT).then_some(text)
}
