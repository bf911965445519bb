//! The progress bar.

use std::{
    sync::{
        atomic::{AtomicU64, Ordering},
        mpsc,
    },
    thread,
    time::Duration,
};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::output;

/// Renders that take less show no bar.
const PATIENCE: Duration = Duration::from_millis(500);

/// How often the bar moves.
const INTERVAL: Duration = Duration::from_millis(100);

/// Does `work`, which counts up what is done to `total`, and shows on a terminal how far it is and
/// how long it will take.
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

/// Shows a bar until the other end of the channel is gone.
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
