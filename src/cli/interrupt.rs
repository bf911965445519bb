//! Handles Ctrl-C.

use std::{
    process,
    sync::{
        Arc, OnceLock,
        atomic::{AtomicBool, Ordering},
    },
    time::{Duration, Instant},
};

use super::{CommandError, Status, command_error};

/// Record of Ctrl-C, or of a signal that asks the process to end.
///
/// Ctrl-C ends the process at once, unless a command watches for it because it has to clean up
/// first. Even then, pressing Ctrl-C again after two seconds ends the process.
#[derive(Clone, Default)]
pub struct Interrupt(Arc<Flags>);

#[derive(Default)]
struct Flags {
    /// Whether a command checks the flag `pressed` and ends itself when it is set.
    watched: AtomicBool,
    pressed: AtomicBool,
    first: OnceLock<Instant>,
    then: OnceLock<Box<dyn Fn() + Send + Sync>>,
}

/// Time that a command has to clean up after the first Ctrl-C. When this time is over, another
/// Ctrl-C ends the process at once. Removing a temporary file and stopping threads take far less
/// than two seconds.
const GRACE: Duration = Duration::from_secs(2);

impl Interrupt {
    /// Installs a handler that records Ctrl-C. A process can have only one such handler; for a
    /// second one, an error is returned.
    pub(super) fn listen(&self) -> Result<(), CommandError> {
        let interrupt = self.clone();
        ctrlc::set_handler(move || interrupt.press())
            .map_err(|error| command_error(format!("cannot listen for Ctrl-C: {error}")))
    }

    /// Records Ctrl-C. Ends the process if no command watches for it, or if this is a further
    /// Ctrl-C and the command has not ended within two seconds.
    pub fn press(&self) {
        let flags = &self.0;
        flags.pressed.store(true, Ordering::SeqCst);
        if let Some(then) = flags.then.get() {
            then();
        }
        let again = flags.first.get_or_init(Instant::now).elapsed() > GRACE;
        if again || !flags.watched.load(Ordering::SeqCst) {
            process::exit(Status::Interrupted as i32);
        }
    }

    /// Returns the flag that Ctrl-C sets. After this call, the first Ctrl-C only sets the flag, and
    /// the caller must then end the command.
    pub(super) fn watch(&self) -> &AtomicBool {
        self.0.watched.store(true, Ordering::SeqCst);
        &self.0.pressed
    }

    /// Registers a function that makes the command end. The function is called when Ctrl-C is
    /// pressed. If Ctrl-C was pressed already, it is called at once.
    pub(super) fn then(&self, what: impl Fn() + Send + Sync + 'static) {
        let _ = self.0.then.set(Box::new(what));
        // If Ctrl-C was pressed before the function was registered, the handler did not call it, so
        // it is called now.
        if self.watch().load(Ordering::SeqCst)
            && let Some(then) = self.0.then.get()
        {
            then();
        }
    }

    /// Returns whether Ctrl-C was pressed.
    pub(super) fn pressed(&self) -> bool {
        self.0.pressed.load(Ordering::SeqCst)
    }

    /// Returns the error to report for a failed command: [`CommandError::Interrupted`] if Ctrl-C
    /// was pressed, since Ctrl-C is then the cause of the failure, and otherwise `error`.
    pub(super) fn or(&self, error: CommandError) -> CommandError {
        if self.pressed() {
            CommandError::Interrupted
        } else {
            error
        }
    }
}
