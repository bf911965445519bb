//! The preparation of a pixel: the objects that may be seen in it (candidates), described by forms.
//!
//! In: the pixel and its candidates. Out: surfaces, each with its boundary forms, its colour
//! pattern and its depth. They are sorted from back to front if their depths do not overlap. A form
//! is left out if it certainly has one sign in the whole pixel. In rare cases and after overflows,
//! preparation fails, and the samples are traced one by one.

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

/// Maximum error bound of a checkerboard's linear forms in a pixel. The bound covers the rounding
/// errors of the forms' factors, so a factor is at most 2^51 times the bound. With this limit, the
/// product of a factor and the index of a square (below 2^53) cannot overflow. If a bound is
/// larger, the pixel's samples are traced one by one.
const MAX_FORM_ERROR: f64 = 1e250;

/// Maximum number of lines between squares in a pixel for which a sample's colour is found by
/// testing on which side of each line the sample lies. With more lines, a division computes which
/// square a sample hits. By measurement, values from 3 to 12 give equal render times. With division
/// alone, figure 9.9 (the picture of the assignment) takes 11 % longer.
const MAX_LINES: usize = 6;

/// Error of a preparation that fails, so that the pixel's samples must be traced one by one.
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

    /// Prepares a pixel that shows only a checkerboard. Fails if a form has overflowed.
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

    /// Adds the candidate with the index `index` as a surface, with its boundaries and colours as
    /// forms. Adds nothing if the candidate is certainly not seen in the pixel. Fails in rare cases
    /// for which there is no formula, and if a form has overflowed.
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
            let [first, second] = world.color_indices(candidate.object);
            if first != second {
                surface.pattern = self.pattern(board, pixel, &surface)?;
            }
        }
        self.surfaces.push(surface);
        Ok(())
    }

    /// Adds an object's boundary forms, which are all ≥ 0 for rays that hit it, to the pixel's
    /// lines. Leaves out forms that are positive in the whole pixel. Returns `false` if no ray
    /// through the pixel hits the object. Fails if a form has overflowed.
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

    /// Adds the silhouette of a sphere to the surface and to the pixel's lines. Returns `false` if
    /// no ray through the pixel hits the sphere. Fails if the eye is not outside the sphere or a
    /// form has overflowed.
    fn add_silhouette(
        &mut self,
        sphere: &Sphere<f64>,
        pixel: &Patch,
        surface: &mut PixelSurface,
    ) -> Result<bool, Hard> {
        if !sphere.is_outside() {
            // The eye is on the sphere's surface or inside. Pixels that show such a sphere are too
            // rare for a formula of their own.
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

    /// Adds the near and the far plane as boundaries of an object. Returns `false` if a plane
    /// certainly removes the object in the whole pixel. Fails if a plane may cut an object that has
    /// more than one surface, or if a form has overflowed.
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

    /// Returns how the colour of a checkerboard is found at the samples of a pixel. If the pixel
    /// shows only few squares, the colour is found from the signs of linear forms, one for each
    /// line between squares. If there are many squares, or if they could not be determined, a
    /// division computes which square a sample hits. Fails if an error bound exceeds
    /// [`MAX_FORM_ERROR`].
    fn pattern(
        &mut self,
        board: &Checkerboard<f64>,
        pixel: &Patch,
        surface: &PixelSurface,
    ) -> Result<ColorPattern, Hard> {
        let squares = CheckerForms::new(&board.local(&pixel.center, &pixel.sides));
        let CheckerForms {
            numerators,
            denominator,
            ..
        } = &squares;
        let sizes = [denominator, &numerators[0], &numerators[1]].map(|local| local.rad);
        if !sizes.iter().all(|&rad| rad < MAX_FORM_ERROR) {
            return Err(Hard);
        }
        match squares.ranges() {
            Some(ranges) => self.lines(&squares, ranges, surface),
            None => Ok(ColorPattern::Squares(squares)),
        }
    }

    /// Adds the lines between a board's squares to the pixel's lines, except those that certainly
    /// do not cross the pixel. Returns a pattern that finds a sample's colour from the signs of the
    /// lines' forms. If there are more than [`MAX_LINES`] lines, adds none, and returns a pattern
    /// that computes by division which square a sample hits. `x0` to `x1` and `z0` to `z1` are the
    /// ranges of the squares in the pixel. Fails if a form has overflowed.
    fn lines(
        &mut self,
        squares: &CheckerForms,
        [(x0, x1), (z0, z1)]: [(f64, f64); 2],
        surface: &PixelSurface,
    ) -> Result<ColorPattern, Hard> {
        if (x1 - x0) + (z1 - z0) > MAX_LINES as f64 {
            return Ok(ColorPattern::Squares(*squares));
        }
        let CheckerForms {
            numerators,
            denominator,
            odd,
        } = squares;
        let mut odd = odd ^ is_odd(x0) ^ is_odd(z0);
        for (numerator, first, last) in [(&numerators[0], x0, x1), (&numerators[1], z0, z1)] {
            let mut k = first + 1.0;
            while k <= last {
                let line = numerator.less(k, denominator);
                // The form `line` is zero on line number k between squares, and positive beyond it,
                // where x/square or z/square is greater than k. If it is positive in the whole
                // pixel, the whole pixel lies beyond the line, so the parity `odd` is negated.
                match line.range().side() {
                    Side::Above => odd = !odd,
                    Side::Below => {}
                    Side::Both => {
                        self.lines.push(line.line());
                        // The line crosses the pixel. `odd` is the parity of the square in which
                        // the forms of all added lines are positive. This square lies beyond the
                        // line, so `odd` is negated.
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

    /// Sorts the surfaces by depth, from back to front. If their depths overlap, also prepares the
    /// forms of their depths, which are then compared at every sample. Fails if a sphere has no
    /// accurate formula for the depth, or if an error bound has overflowed.
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
                    // q has the error bound `q.rad`. The error of √q is at most the root of this
                    // bound, because |√a − √b| ≤ √|a − b|.
                    let own = b.rad + q.rad.sqrt() + size * (LOCAL_ROUNDING + error);
                    rad = rad.max(own * factor * UP);
                    Depth::Sphere { q, b, factor }
                }
            };
        }
        for plane in &self.planes {
            rad = rad.max(plane.rad);
        }
        // A comparison of two inverse depths is wrong by at most the errors of both, 2 · `rad`.
        // `rad` includes the rounding error of the comparison.
        let apart = 2.0 * rad * UP;
        if !apart.is_finite() {
            return Err(Hard);
        }
        self.apart = Some(apart);
        Ok(())
    }
}
