//! Counts the mixed pixels of a picture, which show more than one colour, and tells those that an
//! edge crosses from those of a checkerboard alone.

use crate::{
    exact::Integrator,
    scene::Scene,
    tracer::{GRID, World},
};

/// Maximum work of counting the mixed pixels of a picture, in units of about 50 ns, which is about
/// two seconds. After it is used up, a pixel counts as showing only what is seen at its centre.
const MAX_WORK: u64 = 40_000_000;

/// Shares, from 0 to 1, of the mixed pixels among all pixels of a picture. A mixed pixel shows more
/// than one colour; only there can a sampling method err.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mixture {
    /// Share of the pixels that an edge crosses: several objects, or an object and the background,
    /// are seen there.
    pub edges: f64,
    /// Share of the pixels that show a checkerboard alone, in both of its colours.
    pub board: f64,
}

impl Mixture {
    /// Counts the mixed pixels in the picture of a scene.
    pub fn of(scene: &Scene) -> Self {
        let edges = share_of_mixed(&World::by_object(scene));
        let mixed = share_of_mixed(&World::new(scene));
        Self {
            edges,
            // An edge between objects of one colour crosses pixels that are not mixed, so the
            // difference may be negative.
            board: (mixed - edges).max(0.0),
        }
    }
}

/// Returns the share of the pixels that show several entries of the world's palette, which are
/// objects or colours.
fn share_of_mixed(world: &World) -> f64 {
    let whole = world.picture();
    let integrator = Integrator::for_values(world, |_| []).with_work_limit(MAX_WORK);
    let mut mixed: u64 = 0;
    for tile in whole.tiles(2 * GRID) {
        integrator.shares(tile, |_, shares| {
            // A smaller share may be a rounding error.
            let seen = shares.iter().filter(|(_, share)| *share > 1e-9);
            mixed += u64::from(seen.count() > 1);
        });
    }
    mixed as f64 / whole.pixels() as f64
}
