//! Ctrl-C.

use std::{
    process,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
};

use super::{Status, Trouble};

/// Whether the user has pressed Ctrl-C (or the system wants the process to end).
///
/// Ends the process at once unless something has to be put away first; then it says so to whoever does. Pressed again, it ends the
/// process in any case.
#[derive(Clone)]
pub struct Interrupt(Arc<Flags>);

#[derive(Default)]
struct Flags {
    /// Somebody looks at `pressed`.
    watched: AtomicBool,
    pressed: AtomicBool,
}

impl Interrupt {
    /// Starts to listen.
    pub fn listen() -> Result<Self, Trouble> {
        let flags = Arc::new(Flags::default());
        let interrupt = Self(Arc::clone(&flags));
        ctrlc::set_handler(move || {
            let again = flags.pressed.swap(true, Ordering::SeqCst);
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

    /// Whether Ctrl-C was pressed.
    pub fn pressed(&self) -> bool {
        self.0.pressed.load(Ordering::SeqCst)
    }
}
