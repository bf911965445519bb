//! Checks whether there is enough memory for a picture before it is allocated.

use std::path::Path;

use thiserror::Error;

use crate::files::read_system_text;

/// Error of a picture for which there is not enough memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error(
    "a picture of {width} × {height} pixels needs {} of memory, {}",
    size(*.needed),
    .available.map_or("more than there is".to_owned(), |there| format!("and {} are available", size(there)))
)]
#[non_exhaustive]
pub struct TooLarge {
    /// Width of the picture, in pixels.
    pub width: u32,
    /// Height of the picture, in pixels.
    pub height: u32,
    /// Number of bytes that the picture needs.
    pub needed: u64,
    /// Number of bytes of memory that are available; `None` if it is unknown.
    pub available: Option<u64>,
}

/// Returns the number of bytes that a picture needs. Fails if more than the available memory is
/// needed.
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

/// Checks the available memory, then tries to allocate the needed bytes, and frees them at once.
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

/// Returns the number of bytes that this process may still allocate: the smaller of the machine's
/// available memory and the rest of its control group's limit. Without this check, a system that
/// overcommits memory would kill the process later. Returns `None` if neither is known, as on
/// systems other than Linux; there, only a failing allocation shows that memory is short.
fn available() -> Option<u64> {
    [machine(), control_group()].into_iter().flatten().min()
}

fn machine() -> Option<u64> {
    let table = read_system_text("/proc/meminfo")?;
    // The numbers in `/proc/meminfo` are in KiB.
    Some(entry(&table, "MemAvailable:")? * 1024)
}

/// Returns how many bytes the control groups around this process still allow it to allocate: the
/// least number of all groups. Returns `None` if no group has a limit.
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

/// Returns the number of bytes that a control group may still allocate. Cached file pages count as
/// its usage, but are reclaimed on demand, so they are added. Returns `None` if the group has no
/// limit.
fn left(group: &Path) -> Option<u64> {
    let read = |name| read_system_text(group.join(name));
    // Without a limit, the file contains the word `max`, which is not a number.
    let limit: u64 = read("memory.max")?.trim().parse().ok()?;
    let usage: u64 = read("memory.current")?.trim().parse().ok()?;
    let cache = entry(&read("memory.stat").unwrap_or_default(), "inactive_file ").unwrap_or(0);
    Some(limit.saturating_sub(usage.saturating_sub(cache)))
}

/// Returns the number after `name` in the first line of `table` that begins with `name`. `table` is
/// the text of a system file such as `/proc/meminfo`.
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
