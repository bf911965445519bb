//! What is made once for all pictures of a class: what programs show that have the scene's own numbers.

use std::{
    collections::HashMap,
    sync::{Arc, Mutex, OnceLock, PoisonError},
};

use super::{grid::Grid, made::Made};

/// A grid, and the mistake that a program has on it, if it has one.
type Key = ([u32; 5], String);

/// What was made, or nothing if it was cancelled.
type Slot = Arc<OnceLock<Option<Arc<Made>>>>;

/// All that was made.
#[derive(Default)]
pub struct ClassCache(Mutex<HashMap<Key, Slot>>);

impl ClassCache {
    /// What a program with a mistake, or without one, shows on a grid. Who asks while it is made waits for it.
    pub fn get(
        &self,
        grid: &Grid,
        mistake: &str,
        make: impl FnOnce() -> Option<Made>,
    ) -> Option<Arc<Made>> {
        let cells = grid.cells;
        let key = [grid.factor, cells.x, cells.y, cells.width, cells.height];
        let slot = {
            let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            Arc::clone(all.entry((key, mistake.to_owned())).or_default())
        };
        slot.get_or_init(|| make().map(Arc::new)).clone()
    }
}
