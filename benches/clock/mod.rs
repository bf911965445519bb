//! CPU time of the process: the time for which processors execute it. Other programs on the machine
//! affect CPU time less than elapsed time.

#[cfg(unix)]
use rustix::time::{ClockId, clock_gettime};

/// Returns the CPU time of the process so far, in seconds: user and system time, summed over all
/// threads.
#[cfg(unix)]
pub fn cpu_seconds() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// Returns the time since the first call, in seconds. It replaces the CPU time on systems for which
/// reading the CPU time is not implemented.
#[cfg(not(unix))]
pub fn cpu_seconds() -> f64 {
    static START: std::sync::LazyLock<std::time::Instant> =
        std::sync::LazyLock::new(std::time::Instant::now);
    START.elapsed().as_secs_f64()
}
