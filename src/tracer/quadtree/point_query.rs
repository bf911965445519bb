//! The point query: the objects that one ray may meet.
//!
//! In: a point in the grid. Out: the objects of the cells that hold it, from the root down, each
//! list ended where the rest is hidden.

use super::{
    grid::{Item, LEVELS, Nearness},
    tree::Tree,
};

impl Tree {
    /// Shows `visit` the objects that the ray through a point may meet, until it fails, but for
    /// those that are not nearer than it last answered.
    #[inline]
    pub(super) fn visit<E>(
        &self,
        at: [u32; 2],
        mut visit: impl FnMut(usize) -> Result<Nearness, E>,
    ) -> Result<(), E> {
        let (mut index, mut level) = (0, LEVELS);
        let mut hidden = Nearness::NONE;
        loop {
            let cell = &self.cells[index as usize];
            if cell.nearest <= hidden {
                return Ok(());
            }
            let list = &self.entries[cell.start as usize..cell.end as usize];
            visit_list(list, at, &mut hidden, &mut visit)?;
            if cell.quarters == 0 {
                return Ok(());
            }
            level -= 1;
            let bit = |axis: usize| at[axis] >> level & 1;
            index = cell.quarters + bit(0) + 2 * bit(1);
        }
    }
}

/// Shows `visit` the objects of one list, the nearest first, that the ray through a point may meet.
#[inline]
pub(super) fn visit_list<E>(
    list: &[Item],
    at: [u32; 2],
    hidden: &mut Nearness,
    visit: &mut impl FnMut(usize) -> Result<Nearness, E>,
) -> Result<(), E> {
    for item in list {
        if item.nearest <= *hidden {
            break;
        }
        if item.bounds.holds(at) {
            *hidden = visit(item.object as usize)?;
        }
    }
    Ok(())
}
