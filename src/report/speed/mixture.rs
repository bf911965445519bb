//! How many pixels of a picture have more than one colour, and why.

use crate::{
    exact::Integrator,
    scene::Scene,
    tracer::{GRID, World},
};

/// Maximum work of a count, in units of about 50 ns, so about two seconds. In the pixels that come
/// after it, only the centre is looked at.
const MAX_WORK: u64 = 40_000_000;

/// The pixels of a picture that have more than one colour, as shares of all pixels, 0 to 1. Only
/// there can a method err.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mixture {
    /// Share of the pixels that an edge crosses: several objects, or an object and the background,
    /// are seen there.
    pub edges: f64,
    /// Share of the pixels that show a checkerboard alone, in both of its colours.
    pub board: f64,
}

impl Mixture {
    /// Counts the mixed pixels of a scene's picture.
    pub fn of(scene: &Scene) -> Self {
        let edges = share_of_mixed(&World::by_object(scene));
        let mixed = share_of_mixed(&World::new(scene));
        Self {
            edges,
            // Two objects of one colour have an edge, but no mixed pixel.
            board: (mixed - edges).max(0.0),
        }
    }
}

/// Returns the share of the pixels in which several slots of the world's palette are seen.
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
