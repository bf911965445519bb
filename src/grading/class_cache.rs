//! What is made once for all pictures of a class: what programs show that have the scene's own numbers.

use std::{
    collections::HashMap,
    sync::{Arc, Mutex, OnceLock, PoisonError},
};

use super::{grid::Grid, made::Made};

/// A grid, and the mistake that a program has on it, if it has one.
type Key = ([u32; 5], Option<usize>, String);

/// What was made, or nothing if it was cancelled or took too much work, and the work.
type Slot = Arc<OnceLock<(Option<Arc<Made>>, f64)>>;

/// All that was made.
#[derive(Default)]
pub struct ClassCache(Mutex<HashMap<Key, Slot>>);

impl ClassCache {
    /// What a program with a mistake, or without one, shows on a grid, and the work of it, which counts for each who asks. Who asks while it is made waits for it.
    pub fn get(
        &self,
        grid: &Grid,
        samples: Option<usize>,
        mistake: &str,
        make: impl FnOnce() -> (Option<Made>, f64),
    ) -> (Option<Arc<Made>>, f64) {
        let cells = grid.cells;
        let key = [grid.factor, cells.x, cells.y, cells.width, cells.height];
        let slot = {
            let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            Arc::clone(all.entry((key, samples, mistake.to_owned())).or_default())
        };
        let make = || {
            let (made, work) = make();
            (made.map(Arc::new), work)
        };
        slot.get_or_init(make).clone()
    }
}
