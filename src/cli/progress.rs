//! The progress bar on standard error.

use std::{
    num::NonZero,
    sync::{
        atomic::{AtomicBool, AtomicU64, Ordering},
        mpsc,
    },
    thread,
    time::Duration,
};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::output;
use crate::render::Control;

/// Time before the progress bar appears, so that short work shows none. With a shorter time, the
/// bar would flash up for work that ends soon; with a longer one, the user would wonder whether
/// anything happens.
const PATIENCE: Duration = Duration::from_millis(500);

/// Interval between updates of the progress bar. Ten updates per second look smooth and take almost
/// no time. With a much longer interval, the bar would seem to stand still.
const INTERVAL: Duration = Duration::from_millis(100);

/// Runs `work`, which counts its progress up to `total`. Meanwhile, a bar shows the progress and
/// the remaining time, if standard error is a terminal. Returns the result of `work`.
pub fn watched<T>(total: u64, work: impl FnOnce(&AtomicU64) -> T) -> T {
    let done = AtomicU64::new(0);
    if !output::is_watched() {
        return work(&done);
    }
    thread::scope(|scope| {
        let (finished, wait) = mpsc::channel::<()>();
        scope.spawn({
            let done = &done;
            move || show(total, done, &wait)
        });
        let result = work(&done);
        drop(finished);
        result
    })
}

/// Runs `work`, which renders `total` samples, or `total` pixels if it renders without samples. The
/// work stops when `cancel` is set. Meanwhile, a bar shows the progress, if standard error is a
/// terminal.
pub fn rendering<T>(
    total: u64,
    threads: Option<NonZero<usize>>,
    cancel: &AtomicBool,
    work: impl FnOnce(&Control) -> T,
) -> T {
    watched(total, |done| {
        work(&Control {
            threads,
            progress: &|more| {
                done.fetch_add(more, Ordering::Relaxed);
            },
            cancel,
        })
    })
}

/// Shows a progress bar until the sender of the channel `wait` is dropped.
fn show(total: u64, done: &AtomicU64, wait: &mpsc::Receiver<()>) {
    let goes_on = |time| wait.recv_timeout(time) == Err(mpsc::RecvTimeoutError::Timeout);
    if !goes_on(PATIENCE) {
        return;
    }
    let bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::stderr());
    bar.set_style(
        ProgressStyle::with_template("{wide_bar} {percent:>3} %, {eta} left")
            .unwrap_or_else(|_| ProgressStyle::default_bar()),
    );
    loop {
        bar.set_position(done.load(Ordering::Relaxed));
        if !goes_on(INTERVAL) {
            break;
        }
    }
    bar.finish_and_clear();
}
