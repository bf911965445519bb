//! CPU time of the process. Other work on the machine affects it less than wall time.

#[cfg(unix)]
use rustix::time::{ClockId, clock_gettime};

/// Returns the user and system time of all threads of the process so far, in seconds.
#[cfg(unix)]
pub fn cpu_seconds() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// Returns the wall time since the first call, in seconds, on systems for which CPU time is not
/// implemented here.
#[cfg(not(unix))]
pub fn cpu_seconds() -> f64 {
    static START: std::sync::LazyLock<std::time::Instant> =
        std::sync::LazyLock::new(std::time::Instant::now);
    START.elapsed().as_secs_f64()
}
