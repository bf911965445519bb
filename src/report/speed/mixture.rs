//! Counts the pixels of a picture that show several colours. Distinguishes pixels that an edge
//! crosses from pixels that show only a checkerboard.

use crate::{
    exact::Integrator,
    scene::{Scene, Shape},
    tracer::{GRID, World},
};

/// Maximum work of counting the pixels with several colours. One unit is about 50 ns, so counting
/// takes at most about two seconds. Pixels that are not reached within this limit are treated as
/// having a single colour. With a smaller limit, more pixels would not be reached. With a larger
/// one, a report, which usually takes 45 s, would take noticeably longer.
const MAX_WORK: u64 = 40_000_000;

/// Fractions, from 0 to 1, of a picture's pixels in which sampling methods can err.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mixture {
    /// Fraction of the picture's pixels that show an edge, i.e. several objects, several faces of a
    /// box with coloured faces, or an object and the background. The colours on both sides of an
    /// edge may be equal.
    pub edges: f64,
    /// Fraction of the picture's pixels that show only a checkerboard, in both of its colours.
    pub board: f64,
    /// Whether all pixels were reached within the work limit. If not, both fractions may be too
    /// small.
    pub is_complete: bool,
}

impl Mixture {
    /// Computes the fractions for the picture of a scene.
    pub fn of(scene: &Scene) -> Self {
        let surfaces = Mixed::among(&World::by_surface(scene), MAX_WORK);
        let is_board = |shape: &Shape| matches!(shape, Shape::Checkerboard(_));
        let has_board = scene.objects.iter().any(|object| is_board(&object.shape));
        let colors = if has_board {
            Mixed::among(&World::new(scene), MAX_WORK.saturating_sub(surfaces.work))
        } else {
            Mixed::default()
        };
        let edges = surfaces.pixels.iter().filter(|has_edge| **has_edge);
        // If a pixel shows several colours of a single surface, the surface is a checkerboard.
        let both = surfaces.pixels.iter().zip(&colors.pixels);
        let board = both.filter(|(has_edge, has_colors)| **has_colors && !**has_edge);
        let share = |count: usize| count as f64 / surfaces.pixels.len() as f64;
        Self {
            edges: share(edges.count()),
            board: share(board.count()),
            is_complete: surfaces.work + colors.work <= MAX_WORK,
        }
    }
}

/// Result of searching a picture for pixels that show several entries of a world's palette. An
/// entry is a colour or, in a world made by [`World::by_surface`], a surface.
#[derive(Default)]
struct Mixed {
    /// Whether each pixel shows several entries of the palette, i.e. several colours or surfaces.
    /// Pixels are in row order.
    pixels: Vec<bool>,
    /// Work that was spent, in units of about 50 ns.
    work: u64,
}

impl Mixed {
    /// Finds the pixels of a world's picture that show several colours, or several surfaces if the
    /// world was made by [`World::by_surface`]. When the work exceeds `limit`, the remaining pixels
    /// are treated as showing only one.
    fn among(world: &World, limit: u64) -> Self {
        let whole = world.picture();
        let integrator = Integrator::for_values(world, |_| []).with_work_limit(limit);
        let mut pixels = vec![false; whole.pixels() as usize];
        for tile in whole.tiles(2 * GRID) {
            integrator.shares(tile, |area, shares| {
                // Fractions of a pixel's area of at most 1e-9 may be rounding errors, so they are
                // ignored.
                let seen = shares.iter().filter(|(_, share)| *share > 1e-9);
                if seen.count() > 1 {
                    pixels[whole.index(area.x, area.y)] = true;
                }
            });
        }
        let work = integrator.work();
        Self { pixels, work }
    }
}
