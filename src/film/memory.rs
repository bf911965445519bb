//! Checks whether there is enough memory for a picture before it is allocated.

use std::path::Path;

use thiserror::Error;

use crate::files::read_system_text;

/// Error: there is not enough memory for a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error(
    "a picture of {width} × {height} pixels needs {} of memory, {}",
    size(*.needed),
    .available.map_or("more than there is".to_owned(), |there| format!("and {} are available", size(there)))
)]
pub struct TooLarge {
    /// Width of the picture, in pixels.
    pub width: u32,
    /// Height of the picture, in pixels.
    pub height: u32,
    /// Number of bytes that the picture needs.
    pub needed: u64,
    /// Number of bytes of memory that are available; `None` if the system does not report it.
    pub available: Option<u64>,
}

/// Returns the number of bytes that a picture needs. Fails if this is more than the available
/// memory.
pub fn check(width: u32, height: u32, bytes_per_pixel: u64) -> Result<u64, TooLarge> {
    let pixels = u64::from(width) * u64::from(height);
    let needed = pixels.saturating_mul(bytes_per_pixel);
    match available() {
        Some(available) if needed > available => Err(TooLarge {
            width,
            height,
            needed,
            available: Some(available),
        }),
        _ => Ok(needed),
    }
}

/// Checks that a picture's memory is available. The system may nevertheless refuse the allocation,
/// so the function also tries to allocate the memory, and frees it at once.
///
/// # Errors
///
/// There is too little memory, or the system refuses the allocation.
pub fn reserve(width: u32, height: u32, bytes_per_pixel: u64) -> Result<(), TooLarge> {
    let needed = check(width, height, bytes_per_pixel)?;
    let fits = |bytes| Vec::<u8>::new().try_reserve_exact(bytes).is_ok();
    if usize::try_from(needed).is_ok_and(fits) {
        return Ok(());
    }
    Err(TooLarge {
        width,
        height,
        needed,
        available: None,
    })
}

/// Returns the number of bytes that this process may still allocate: the machine's available
/// memory, or less if the process's control group has a limit. Returns `None` if the system does
/// not report the number; only Linux does. The check is needed because Linux may grant more memory
/// than exists, and later kill the process.
fn available() -> Option<u64> {
    [machine(), control_group()].into_iter().flatten().min()
}

fn machine() -> Option<u64> {
    let table = read_system_text("/proc/meminfo")?;
    // The numbers in `/proc/meminfo` are in KiB.
    Some(entry(&table, "MemAvailable:")? * 1024)
}

/// Returns the number of bytes that this process may still allocate within the limits of its
/// control groups, which are nested. Returns `None` if there is no limit.
fn control_group() -> Option<u64> {
    const ROOT: &str = "/sys/fs/cgroup";
    let groups = read_system_text("/proc/self/cgroup")?;
    let group = groups.lines().find_map(|line| line.strip_prefix("0::/"))?;
    Path::new(ROOT)
        .join(group)
        .ancestors()
        .take_while(|folder| folder.starts_with(ROOT))
        .filter_map(left)
        .min()
}

/// Returns the number of bytes that a control group may still allocate, or `None` if it has no
/// limit. The group's usage includes cached file pages. They are subtracted, since the system frees
/// them on demand.
fn left(group: &Path) -> Option<u64> {
    let read = |name| read_system_text(group.join(name));
    // A group without a limit has the word `max` in the file `memory.max`. It is not a number, so
    // `None` is returned.
    let limit: u64 = read("memory.max")?.trim().parse().ok()?;
    let usage: u64 = read("memory.current")?.trim().parse().ok()?;
    let cache = entry(&read("memory.stat").unwrap_or_default(), "inactive_file ").unwrap_or(0);
    Some(limit.saturating_sub(usage.saturating_sub(cache)))
}

/// Returns the number after `name` in the first line that begins with `name`. `table` is the text
/// of a system file such as `/proc/meminfo`. Returns `None` if there is no such number.
fn entry(table: &str, name: &str) -> Option<u64> {
    let entry = table.lines().find_map(|line| line.strip_prefix(name))?;
    entry.split_whitespace().next()?.parse().ok()
}

/// Formats a number of bytes with a binary unit, such as `1.5 GiB`.
fn size(bytes: u64) -> String {
    const UNITS: [&str; 7] = ["bytes", "KiB", "MiB", "GiB", "TiB", "PiB", "EiB"];
    let power = bytes.max(1).ilog2() / 10;
    let scaled = bytes as f64 / (1_u64 << (10 * power)) as f64;
    let digits = usize::from(power > 0);
    format!("{scaled:.digits$} {}", UNITS[power as usize])
}
