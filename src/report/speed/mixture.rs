//! Counts the pixels of a picture that show more than one colour. Distinguishes pixels that an edge
//! crosses from those that show only a checkerboard.

use crate::{
    exact::Integrator,
    scene::{Scene, Shape},
    tracer::{GRID, World},
};

/// Maximum work of counting the pixels with several colours. One unit is about 50 ns, so the
/// maximum is about two seconds. The pixels that are not reached within this limit are treated as
/// having a single colour. With a smaller limit, more pixels would remain uncounted; with a larger
/// one, a report, which usually takes 45 s, would take noticeably longer.
const MAX_WORK: u64 = 40_000_000;

/// Fractions, from 0 to 1, of a picture's pixels that show more than one colour. Only in these
/// pixels can a sampling method err.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mixture {
    /// Fraction of the picture's pixels that show an edge: several objects, several faces of a box
    /// with coloured faces, or an object and the background.
    pub edges: f64,
    /// Fraction of the picture's pixels that show only a checkerboard, in both of its colours.
    pub board: f64,
    /// Whether all pixels were reached within the work limit. If not, both fractions may be too
    /// small.
    pub is_complete: bool,
}

impl Mixture {
    /// Counts the pixels that show more than one colour, in the picture of a scene.
    pub fn of(scene: &Scene) -> Self {
        let (edges, reaches_edges) = share_of_mixed(&World::by_surface(scene));
        let is_board = |shape: &Shape| matches!(shape, Shape::Checkerboard(_));
        let has_board = scene.objects.iter().any(|object| is_board(&object.shape));
        let (both, reaches_board) = if has_board {
            share_of_mixed(&World::new(scene))
        } else {
            (edges, true)
        };
        Self {
            edges,
            // An edge between surfaces of the same colour is counted in `edges`, but not in `both`.
            // So the difference may be negative, and is then replaced by 0.
            board: (both - edges).max(0.0),
            is_complete: reaches_edges && reaches_board,
        }
    }
}

/// Returns the fraction of the picture's pixels that show several entries of the world's palette.
/// An entry is a colour or, in a world made by [`World::by_surface`], a surface. Also returns
/// whether all pixels were reached within the work limit.
fn share_of_mixed(world: &World) -> (f64, bool) {
    let whole = world.picture();
    let integrator = Integrator::for_values(world, |_| []).with_work_limit(MAX_WORK);
    let mut mixed: u64 = 0;
    for tile in whole.tiles(2 * GRID) {
        integrator.shares(tile, |_, shares| {
            // Fractions of a pixel's area of at most 1e-9 may be rounding errors, so they are
            // ignored.
            let seen = shares.iter().filter(|(_, share)| *share > 1e-9);
            mixed += u64::from(seen.count() > 1);
        });
    }
    let share = mixed as f64 / whole.pixels() as f64;
    (share, integrator.work() <= MAX_WORK)
}
