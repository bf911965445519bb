//! The point query: the objects that one ray may hit.
//!
//! In: a point in the grid. Out: the objects of the cells that contain the point, from the root
//! cell down. Each cell lists its objects from the nearest to the farthest. If the ray has hit an
//! object, the search stops reading a list at the first object that is entirely behind this hit.

use super::{
    grid::{BoundedObject, LEVELS, Nearness},
    tree::Cells,
};

impl Cells {
    /// Calls `visit` with the objects that the ray through a point may hit. If `visit` fails, stops
    /// and returns its error. `visit` returns the inverse depth of the nearest crossing so far,
    /// rounded down; objects entirely behind this crossing are skipped.
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

/// Calls `visit` with the objects of one list that the ray through a point may hit, the nearest
/// first. `visit` returns the inverse depth of the nearest crossing so far, rounded down, which is
/// stored in `hidden`. Stops at the first object that is entirely behind this crossing. If `visit`
/// fails, stops and returns its error.
#[inline]
pub(super) fn visit_list<E>(
    list: &[BoundedObject],
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
