//! Whether there is memory for a picture, before it is taken.

use std::path::Path;

use thiserror::Error;

use crate::files::read_system_text;

/// A picture for which there is no memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error(
    "a picture of {width} × {height} pixels needs {} of memory, {}",
    size(*.needed),
    .available.map_or("more than there is".to_owned(), |there| format!("and {} are available", size(there)))
)]
pub struct TooLarge {
    /// Columns of pixels.
    pub width: u32,
    /// Rows of pixels.
    pub height: u32,
    /// How many bytes it needs.
    pub needed: u64,
    /// How many there are, where the system says so.
    pub available: Option<u64>,
}

/// Refuses a picture for which there is not so much memory, and says how many bytes it needs.
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

/// Refuses a picture also where the system does not hand out as much; what is taken to find that
/// out is given back at once.
pub fn reserve(width: u32, height: u32, bytes_per_pixel: u64) -> Result<(), TooLarge> {
    let needed = check(width, height, bytes_per_pixel)?;
    let fits = |bytes| Vec::<u8>::new().try_reserve_exact(bytes).is_ok();
    match usize::try_from(needed).is_ok_and(fits) {
        true => Ok(()),
        false => Err(TooLarge {
            width,
            height,
            needed,
            available: None,
        }),
    }
}

/// How many bytes this process may still take: what the machine has available and what is left of
/// its control group's limit, the smaller one. A system that hands out memory which it does not
/// have would otherwise end the process halfway. Nothing on systems other than Linux, where the
/// reservation itself has to fail.
fn available() -> Option<u64> {
    [machine(), control_group()].into_iter().flatten().min()
}

fn machine() -> Option<u64> {
    let table = read_system_text("/proc/meminfo")?;
    // In KiB.
    Some(entry(&table, "MemAvailable:")? * 1024)
}

/// What is left of the limits of this process's control group and of the groups around it.
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

/// What a group may still take. Copies of files, which it is charged for, give way on demand.
fn left(group: &Path) -> Option<u64> {
    let read = |name| read_system_text(group.join(name));
    // Without a limit there is a word here.
    let limit: u64 = read("memory.max")?.trim().parse().ok()?;
    let usage: u64 = read("memory.current")?.trim().parse().ok()?;
    let cache = entry(&read("memory.stat").unwrap_or_default(), "inactive_file ").unwrap_or(0);
    Some(limit.saturating_sub(usage.saturating_sub(cache)))
}

/// The number behind a name in a table.
fn entry(table: &str, name: &str) -> Option<u64> {
    let entry = table.lines().find_map(|line| line.strip_prefix(name))?;
    entry.split_whitespace().next()?.parse().ok()
}

/// A number of bytes for people.
fn size(bytes: u64) -> String {
    const UNITS: [&str; 7] = ["bytes", "KiB", "MiB", "GiB", "TiB", "PiB", "EiB"];
    let power = bytes.max(1).ilog2() / 10;
    let scaled = bytes as f64 / (1_u64 << (10 * power)) as f64;
    let digits = usize::from(power > 0);
    format!("{scaled:.digits$} {}", UNITS[power as usize])
}
