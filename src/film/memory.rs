//! Whether there is memory for a picture, before it is taken.

use std::{fs, path::Path};

use thiserror::Error;

/// A picture for which there is no memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("a picture of {width} × {height} pixels needs {} of memory, {}", size(*.needed), have(*.available))]
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

/// Refuses a picture for which there is not so much memory.
pub fn check(width: u32, height: u32, bytes_per_pixel: u64) -> Result<(), TooLarge> {
    let pixels = u64::from(width) * u64::from(height);
    let needed = pixels.saturating_mul(bytes_per_pixel);
    let refused = |available| TooLarge {
        width,
        height,
        needed,
        available,
    };
    let available = available();
    if available.is_some_and(|available| needed > available) {
        return Err(refused(available));
    }
    // Given back at once.
    let fits = |bytes| Vec::<u8>::new().try_reserve_exact(bytes).is_ok();
    match usize::try_from(needed).is_ok_and(fits) {
        true => Ok(()),
        false => Err(refused(None)),
    }
}

/// How many bytes this process may still take: what the machine has available and what is left of its control group's limit, the
/// smaller one. A system that hands out memory which it does not have would otherwise end the process halfway. Nothing on systems
/// other than Linux, where the reservation itself has to fail.
fn available() -> Option<u64> {
    [machine(), control_group()].into_iter().flatten().min()
}

fn machine() -> Option<u64> {
    let table = fs::read_to_string("/proc/meminfo").ok()?;
    let line = table
        .lines()
        .find(|line| line.starts_with("MemAvailable:"))?;
    let kibibytes: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kibibytes * 1024)
}

/// What is left of the limits of this process's control group and of the groups around it.
fn control_group() -> Option<u64> {
    const ROOT: &str = "/sys/fs/cgroup";
    let groups = fs::read_to_string("/proc/self/cgroup").ok()?;
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
    let read = |name| fs::read_to_string(group.join(name)).ok();
    // Without a limit there is a word here.
    let limit: u64 = read("memory.max")?.trim().parse().ok()?;
    let usage: u64 = read("memory.current")?.trim().parse().ok()?;
    let table = read("memory.stat").unwrap_or_default();
    let cache = table
        .lines()
        .find_map(|line| line.strip_prefix("inactive_file "));
    let cache: u64 = cache.and_then(|cache| cache.parse().ok()).unwrap_or(0);
    Some(limit.saturating_sub(usage.saturating_sub(cache)))
}

/// A number of bytes for people.
fn size(bytes: u64) -> String {
    const UNITS: [&str; 6] = ["bytes", "KiB", "MiB", "GiB", "TiB", "PiB"];
    let mut scaled = bytes as f64;
    let mut unit = 0;
    while scaled >= 1024.0 && unit + 1 < UNITS.len() {
        scaled /= 1024.0;
        unit += 1;
    }
    let digits = usize::from(unit > 0);
    format!("{scaled:.digits$} {}", UNITS[unit])
}

fn have(available: Option<u64>) -> String {
    match available {
        Some(available) => format!("and {} are available", size(available)),
        None => "more than there is".to_owned(),
    }
}
