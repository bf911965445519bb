//! Ctrl-C.

use std::{
    process,
    sync::{
        Arc, OnceLock,
        atomic::{AtomicBool, Ordering},
    },
    time::{Duration, Instant},
};

use super::{Status, Trouble};

/// Whether the user has pressed Ctrl-C (or the system wants the process to end).
///
/// Ends the process at once unless something has to be put away first; then it says so to whoever
/// does. Pressed again after that has had its time, it ends the process in any case.
#[derive(Clone)]
pub struct Interrupt(Arc<Flags>);

#[derive(Default)]
struct Flags {
    /// Somebody looks at `pressed`.
    watched: AtomicBool,
    pressed: AtomicBool,
    first: OnceLock<Instant>,
    then: OnceLock<Box<dyn Fn() + Send + Sync>>,
}

/// What has to be put away (a temporary file, threads) takes a small part of this.
const GRACE: Duration = Duration::from_secs(2);

impl Interrupt {
    /// Starts to listen.
    pub fn listen() -> Result<Self, Trouble> {
        let flags = Arc::new(Flags::default());
        let interrupt = Self(Arc::clone(&flags));
        ctrlc::set_handler(move || {
            flags.pressed.store(true, Ordering::SeqCst);
            if let Some(then) = flags.then.get() {
                then();
            }
            let again = flags.first.get_or_init(Instant::now).elapsed() > GRACE;
            if again || !flags.watched.load(Ordering::SeqCst) {
                process::exit(Status::Interrupted as i32);
            }
        })
        .map_err(|error| Trouble(format!("cannot listen for Ctrl-C: {error}")))?;
        Ok(interrupt)
    }

    /// The flag that Ctrl-C sets; from now on somebody looks at it.
    pub fn watch(&self) -> &AtomicBool {
        self.0.watched.store(true, Ordering::SeqCst);
        &self.0.pressed
    }

    /// Has this done when Ctrl-C is pressed, whereupon somebody ends the process.
    #[cfg(feature = "preview")]
    pub fn then(&self, what: impl Fn() + Send + Sync + 'static) {
        let _ = self.0.then.set(Box::new(what));
        // Pressed before, and nobody was told.
        if self.watch().load(Ordering::SeqCst)
            && let Some(then) = self.0.then.get()
        {
            then();
        }
    }

    /// Whether Ctrl-C was pressed.
    pub fn pressed(&self) -> bool {
        self.0.pressed.load(Ordering::SeqCst)
    }
}
