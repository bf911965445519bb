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
/// first. Pressed again after [`GRACE`], Ctrl-C ends the process in any case.
#[derive(Clone)]
pub struct Interrupt(Arc<Flags>);

#[derive(Default)]
struct Flags {
    /// Whether a command watches the flag `pressed` and ends itself.
    watched: AtomicBool,
    pressed: AtomicBool,
    first: OnceLock<Instant>,
    then: OnceLock<Box<dyn Fn() + Send + Sync>>,
}

/// Time after the first Ctrl-C from which on another one ends the process at once. Until then, a
/// command can clean up. Removing a temporary file and stopping threads take a small part of it.
const GRACE: Duration = Duration::from_secs(2);

impl Interrupt {
    /// Installs the handler of Ctrl-C, which sets the flag.
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

    /// Returns the flag that Ctrl-C sets. After this call, Ctrl-C only sets the flag, and the
    /// caller must end the command when it is set.
    pub fn watch(&self) -> &AtomicBool {
        self.0.watched.store(true, Ordering::SeqCst);
        &self.0.pressed
    }

    /// Registers `what`, which is called when Ctrl-C is pressed, or at once if it already was.
    /// `what` must make the command end.
    pub fn then(&self, what: impl Fn() + Send + Sync + 'static) {
        let _ = self.0.then.set(Box::new(what));
        // Ctrl-C may have been pressed before `what` was registered, so `what` is called here.
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
