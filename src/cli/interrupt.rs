//! Handles Ctrl-C.

use std::{
    process,
    sync::{
        Arc, OnceLock,
        atomic::{AtomicBool, Ordering},
    },
    time::{Duration, Instant},
};

use super::{Status, Trouble, trouble};

/// Whether the user has pressed Ctrl-C, or the system has asked the process to end.
///
/// Ctrl-C ends the process at once, unless a command watches the flag because it has to clean up
/// first. If Ctrl-C is pressed again after the grace period, it ends the process in any case.
#[derive(Clone)]
pub struct Interrupt(Arc<Flags>);

#[derive(Default)]
struct Flags {
    /// Whether a command watches `pressed`.
    watched: AtomicBool,
    pressed: AtomicBool,
    first: OnceLock<Instant>,
    then: OnceLock<Box<dyn Fn() + Send + Sync>>,
}

/// Grace period after the first Ctrl-C. Cleaning up (a temporary file, threads) takes a small part
/// of it.
const GRACE: Duration = Duration::from_secs(2);

impl Interrupt {
    /// Installs the handler.
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
        .map_err(|error| trouble(format!("cannot listen for Ctrl-C: {error}")))?;
        Ok(interrupt)
    }

    /// Returns the flag that Ctrl-C sets. After this call, Ctrl-C no longer ends the process by
    /// itself; the caller must.
    pub fn watch(&self) -> &AtomicBool {
        self.0.watched.store(true, Ordering::SeqCst);
        &self.0.pressed
    }

    /// Registers `what`, to be called when Ctrl-C is pressed. It must make the command end.
    #[cfg(feature = "preview")]
    pub fn then(&self, what: impl Fn() + Send + Sync + 'static) {
        let _ = self.0.then.set(Box::new(what));
        // Ctrl-C may have been pressed before `what` was registered.
        if self.watch().load(Ordering::SeqCst)
            && let Some(then) = self.0.then.get()
        {
            then();
        }
    }

    /// Returns whether Ctrl-C was pressed.
    pub fn pressed(&self) -> bool {
        self.0.pressed.load(Ordering::SeqCst)
    }

    /// Returns why a command ended: the trouble, unless Ctrl-C made it.
    pub fn or(&self, trouble: Trouble) -> Trouble {
        if self.pressed() {
            Trouble::Interrupted
        } else {
            trouble
        }
    }
}
