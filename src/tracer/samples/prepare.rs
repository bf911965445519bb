//! The preparation of a pixel: what it shows of its candidates, written as forms.
//!
//! In: the pixel and its candidates. Out: surfaces with their boundary forms, patterns and depths,
//! sorted from back to front if their depths do not overlap. A form whose bound gives it one sign
//! all over the pixel is left out. Rare cases and overflows are left to the world, sample by
//! sample.

use super::{
    super::{
        candidates::VisibilityCandidate,
        checker_corners::{CheckerForms, CheckerPixel, is_odd},
        checkerboard::Checkerboard,
        form::Form,
        interval::Side,
        local_form::{LOCAL_ROUNDING, LocalForm, Patch},
        object::{Object, SurfaceKind},
        sphere::Sphere,
        world::{Precision, World},
    },
    pixel::{ColorPattern, Depth, PixelSurface, PreparedPixel},
};
use crate::{area::Area, math::UP};

/// Error bound of a board's form above which the pixel is left to higher precisions: products of a
/// few such factors with numbers of squares, which are below 2^53, would be infinite.
const MAX_ERROR: f64 = 1e250;

/// Maximum number of board lines through a pixel for which squares are decided by lines; beyond it
/// they are decided by division. Measured: 3 to 12 make no difference, and division alone makes
/// figure 9.9 a ninth slower.
const MAX_LINES: usize = 6;

/// Error of a preparation that has met a case which is better traced sample by sample.
pub(super) struct Hard;

impl PreparedPixel {
    pub(super) fn prepare(&mut self, world: &World) -> Result<(), Hard> {
        let camera = &f64::frame(&world.geometry).camera;
        let pixel = Patch::new(camera, Area::pixel(self.x, self.y));
        self.clear();
        for index in 0..self.candidates.len() {
            self.add_surface(world, &pixel, index)?;
        }
        self.order(world, &pixel)
    }

    /// Prepares a pixel that a board fills and in which nothing else may be seen.
    pub(super) fn prepare_checks(&mut self, checks: &CheckerPixel) -> Result<(), Hard> {
        self.clear();
        let mut surface = PixelSurface::new(0, 0);
        surface.pattern = self.lines(&checks.squares, checks.ranges(), &surface)?;
        self.surfaces.push(surface);
        Ok(())
    }

    fn clear(&mut self) {
        self.surfaces.clear();
        self.lines.clear();
        self.planes.clear();
        self.apart = None;
    }

    /// Writes a candidate's boundaries and colours as forms.
    fn add_surface(&mut self, world: &World, pixel: &Patch, index: usize) -> Result<(), Hard> {
        let candidate = self.candidates[index];
        let object = &*f64::object(&world.geometry, candidate.object);
        let start = self.lines.len();
        let mut surface = PixelSurface::new(index, start);
        let met = candidate.is_whole
            || match object.surface_kind() {
                SurfaceKind::Flat(convex) => self.add_boundaries(convex.bounds(), pixel)?,
                SurfaceKind::Round(sphere) => self.add_silhouette(sphere, pixel, &mut surface)?,
            };
        if !met || !self.add_clips(world, pixel, candidate, object)? {
            self.lines.truncate(start);
            return Ok(());
        }
        surface.edges[1] = self.lines.len();
        surface.pattern = ColorPattern::Plain(surface.code(false));
        if let Object::Checkerboard(board) = object {
            let [first, second] = world.slots(candidate.object);
            if first != second {
                surface.pattern = self.pattern(board, pixel, &surface)?;
            }
        }
        self.surfaces.push(surface);
        Ok(())
    }

    /// Adds forms that are all ≥ 0 where an object is met. Returns whether the object may be met at
    /// all.
    fn add_boundaries(&mut self, forms: &[Form<f64>], pixel: &Patch) -> Result<bool, Hard> {
        for form in forms {
            if !self.add_boundary(form.local(pixel))? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    fn add_boundary(&mut self, local: LocalForm) -> Result<bool, Hard> {
        match local.range().side() {
            Side::Above => Ok(true),
            Side::Below => Ok(false),
            Side::Both => {
                self.lines.push(local.line());
                Ok(true)
            }
            Side::Unknown => Err(Hard),
        }
    }

    /// Adds the outline of a sphere. Returns whether the sphere may be met at all.
    fn add_silhouette(
        &mut self,
        sphere: &Sphere<f64>,
        pixel: &Patch,
        surface: &mut PixelSurface,
    ) -> Result<bool, Hard> {
        if !sphere.is_outside() {
            // The eye is on the surface or inside: too rarely seen in part to deserve a rule of its
            // own.
            return Err(Hard);
        }
        let (q, b) = sphere.local(pixel);
        match q.range().side() {
            Side::Above => {}
            Side::Below => return Ok(false),
            Side::Both => surface.conic = Some(q.certain()),
            Side::Unknown => return Err(Hard),
        }
        self.add_boundary(b)
    }

    /// Adds the near and the far plane as boundaries of an object with a single surface. Returns
    /// whether the object may be met at all.
    fn add_clips(
        &mut self,
        world: &World,
        pixel: &Patch,
        candidate: VisibilityCandidate,
        object: &Object<f64>,
    ) -> Result<bool, Hard> {
        let prepared = f64::frame(&world.geometry);
        let plane = match object.surface_kind() {
            SurfaceKind::Flat(convex) => match (convex.firsts(), convex.seconds()) {
                ([plane], []) => Some(plane),
                _ => None,
            },
            SurfaceKind::Round(_) => None,
        };
        let mut met = true;
        if candidate.is_cut() {
            let (Some(near), Some(plane)) = (&prepared.near, plane) else {
                return Err(Hard);
            };
            met = self.add_boundary(near.minus(plane).local(pixel))?;
        }
        if let Some(far) = &prepared.far
            && !candidate.is_whole
        {
            let is_before = candidate.inverse_depth.low > far.over(pixel).high;
            if !is_before {
                let plane = plane.ok_or(Hard)?;
                met &= self.add_boundary(plane.minus(far).local(pixel))?;
            }
        }
        Ok(met)
    }

    /// Decides which squares a board shows.
    fn pattern(
        &mut self,
        board: &Checkerboard<f64>,
        pixel: &Patch,
        surface: &PixelSurface,
    ) -> Result<ColorPattern, Hard> {
        let squares = CheckerForms::new(&board.local(&pixel.center, &pixel.sides));
        let CheckerForms { across, below, .. } = &squares;
        let sizes = [below, &across[0], &across[1]].map(|local| local.rad);
        if !sizes.iter().all(|&rad| rad < MAX_ERROR) {
            return Err(Hard);
        }
        match squares.ranges() {
            Some(ranges) => self.lines(&squares, ranges, surface),
            None => Ok(ColorPattern::Squares(squares)),
        }
    }

    /// Writes the lines between a board's squares as forms.
    fn lines(
        &mut self,
        squares: &CheckerForms,
        [(x0, x1), (z0, z1)]: [(f64, f64); 2],
        surface: &PixelSurface,
    ) -> Result<ColorPattern, Hard> {
        if (x1 - x0) + (z1 - z0) > MAX_LINES as f64 {
            return Ok(ColorPattern::Squares(*squares));
        }
        let CheckerForms { across, below, odd } = squares;
        let mut odd = odd ^ is_odd(x0) ^ is_odd(z0);
        for (across, first, last) in [(&across[0], x0, x1), (&across[1], z0, z1)] {
            let mut k = first + 1.0;
            while k <= last {
                let line = across.less(k, below);
                // Its sign is that of x/square − k, which is ≥ 0 in the upper square: one more
                // change of parity.
                match line.range().side() {
                    Side::Above => odd = !odd,
                    Side::Below => {}
                    Side::Both => {
                        self.lines.push(line.line());
                        // On the negative side there is no change: count from the other side.
                        odd = !odd;
                    }
                    Side::Unknown => return Err(Hard),
                }
                k += 1.0;
            }
        }
        let end = self.lines.len();
        Ok(if end == surface.edges[1] {
            ColorPattern::Plain(surface.code(odd))
        } else {
            ColorPattern::Lines { end, odd }
        })
    }

    /// Sorts the surfaces from back to front, or prepares their depths for a comparison at every
    /// sample.
    fn order(&mut self, world: &World, pixel: &Patch) -> Result<(), Hard> {
        let candidates = &self.candidates;
        let range = |surface: &PixelSurface| candidates[surface.index].inverse_depth;
        self.surfaces
            .sort_by(|a, b| range(a).low.total_cmp(&range(b).low));
        let is_sorted = self
            .surfaces
            .windows(2)
            .all(|pair| range(&pair[0]).high < range(&pair[1]).low);
        if is_sorted {
            return Ok(());
        }
        let mut rad = 0.0_f64;
        for surface in &mut self.surfaces {
            let start = self.planes.len();
            let object = &*f64::object(&world.geometry, self.candidates[surface.index].object);
            surface.depth = match object.surface_kind() {
                SurfaceKind::Flat(convex) => {
                    let faces = convex.firsts().iter().map(|face| face.local(pixel));
                    self.planes.extend(faces);
                    let range = [start, self.planes.len()];
                    if convex.is_inside() {
                        Depth::Greatest(range)
                    } else {
                        Depth::Least(range)
                    }
                }
                SurfaceKind::Round(sphere) => {
                    let (factor, error) = sphere.depth_factor().ok_or(Hard)?;
                    let (q, b) = sphere.local(pixel);
                    let root = q.factors.iter().map(|factor| factor.abs()).sum::<f64>();
                    let size = root.sqrt() + b.factors[2].abs() + b.spread();
                    // |√a − √b| ≤ √|a − b|.
                    let own = b.rad + q.rad.sqrt() + size * (LOCAL_ROUNDING + error);
                    rad = rad.max(own * factor * UP);
                    Depth::Sphere { q, b, factor }
                }
            };
        }
        for plane in &self.planes {
            rad = rad.max(plane.rad);
        }
        // The errors of both sides of a comparison; its own rounding is within theirs.
        let apart = 2.0 * rad * UP;
        if !apart.is_finite() {
            return Err(Hard);
        }
        self.apart = Some(apart);
        Ok(())
    }
}
