//! The processors' time, which other work on the machine changes less than it changes the time on
//! the wall.

#[cfg(unix)]
use rustix::time::{ClockId, clock_gettime};

/// User and system time of all threads of the process so far.
#[cfg(unix)]
pub fn cpu_seconds() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// The time on the wall, from the first question on: this system is not asked for more.
#[cfg(not(unix))]
pub fn cpu_seconds() -> f64 {
    static START: std::sync::LazyLock<std::time::Instant> =
        std::sync::LazyLock::new(std::time::Instant::now);
    START.elapsed().as_secs_f64()
}
