//! The preparation of a pixel: what it shows of its candidates, written down as forms.
//!
//! In: the pixel and its candidates. Out: surfaces with their boundary forms, patterns and depths,
//! sorted from back to front where their depths do not overlap. A form that has one sign all over
//! the pixel by its bound is left out. What is rare or has overflowed is left to the world, sample
//! by sample.

use super::{
    super::{
        candidates::Candidate,
        checker_corners::{Checks, Squares, is_odd},
        checkerboard::Checkerboard,
        form::Form,
        interval::Side,
        local_form::{LOCAL_ROUNDING, LocalForm, Patch},
        object::Object,
        sphere::Sphere,
        world::{Precision, World},
    },
    pixel::{Depth, Pattern, PixelSurface, PreparedPixel},
};
use crate::{area::Area, math::UP};

/// Forms of a board with greater errors than this are left to higher precisions: products with
/// numbers of squares, which are below 2^53, and of a few such factors would be infinite.
const LARGEST: f64 = 1e250;

/// A square of a board is told by lines if no more than this many of them pass through the pixel,
/// else by division. Measured: 3 to 12 make no difference, and division alone makes figure 9.9 a
/// ninth slower.
const LINES: usize = 6;

/// The preparation has met something that is better traced sample by sample.
pub(super) struct Hard;

impl PreparedPixel {
    pub(super) fn prepare(&mut self, world: &World) -> Result<(), Hard> {
        let camera = &f64::frame(&world.geometry).camera;
        let pixel = Patch::new(camera, Area::pixel(self.x, self.y));
        self.clear();
        for index in 0..self.candidates.len() {
            self.surface(world, &pixel, index)?;
        }
        self.order(world, &pixel)
    }

    /// The same where a board is the only candidate and fills the pixel.
    pub(super) fn prepare_checks(&mut self, checks: &Checks) -> Result<(), Hard> {
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

    /// Writes down a candidate's boundaries and colours.
    fn surface(&mut self, world: &World, pixel: &Patch, index: usize) -> Result<(), Hard> {
        let candidate = self.candidates[index];
        let object = &*f64::object(&world.geometry, candidate.object);
        let start = self.lines.len();
        let mut surface = PixelSurface::new(index, start);
        let met = match object.convex() {
            _ if candidate.is_whole => true,
            Ok(convex) => self.edges(convex.bounds(), pixel)?,
            Err(sphere) => self.silhouette(sphere, pixel, &mut surface)?,
        };
        if !met || !self.clips(world, pixel, candidate, object)? {
            self.lines.truncate(start);
            return Ok(());
        }
        surface.edges[1] = self.lines.len();
        surface.pattern = Pattern::Plain(surface.code(false));
        if let Object::Checkerboard(board) = object {
            let [first, second] = world.slots(candidate.object);
            if first != second {
                surface.pattern = self.pattern(board, pixel, &surface)?;
            }
        }
        self.surfaces.push(surface);
        Ok(())
    }

    /// Adds forms that are all ≥ 0 where an object is hit. As all functions down to `clips`, it
    /// says whether the object may be hit at all.
    fn edges(&mut self, forms: &[Form<f64>], pixel: &Patch) -> Result<bool, Hard> {
        for form in forms {
            if !self.edge(form.local(pixel))? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    fn edge(&mut self, local: LocalForm) -> Result<bool, Hard> {
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

    /// Where a sphere is hit: everywhere, by an eye inside.
    fn silhouette(
        &mut self,
        sphere: &Sphere<f64>,
        pixel: &Patch,
        surface: &mut PixelSurface,
    ) -> Result<bool, Hard> {
        if !sphere.is_outside() {
            // On the surface, or too seldom seen in part to be worth a rule of its own.
            return Err(Hard);
        }
        let (q, b) = sphere.local(pixel);
        match q.range().side() {
            Side::Above => {}
            Side::Below => return Ok(false),
            Side::Both => surface.conic = Some(q.certain()),
            Side::Unknown => return Err(Hard),
        }
        self.edge(b)
    }

    /// What the near and the far plane leave of an object with a single surface.
    fn clips(
        &mut self,
        world: &World,
        pixel: &Patch,
        candidate: Candidate,
        object: &Object<f64>,
    ) -> Result<bool, Hard> {
        let prepared = f64::frame(&world.geometry);
        let plane = match object
            .convex()
            .map(|convex| (convex.firsts(), convex.seconds()))
        {
            Ok(([plane], [])) => Some(plane),
            _ => None,
        };
        let mut met = true;
        if candidate.is_cut() {
            let (Some(near), Some(plane)) = (&prepared.near, plane) else {
                return Err(Hard);
            };
            met = self.edge(near.minus(plane).local(pixel))?;
        }
        if let Some(far) = &prepared.far
            && !candidate.is_whole
        {
            let is_before = candidate.inverse_depth.low > far.over(pixel).high;
            if !is_before {
                let plane = plane.ok_or(Hard)?;
                met &= self.edge(plane.minus(far).local(pixel))?;
            }
        }
        Ok(met)
    }

    /// Which squares a board shows.
    fn pattern(
        &mut self,
        board: &Checkerboard<f64>,
        pixel: &Patch,
        surface: &PixelSurface,
    ) -> Result<Pattern, Hard> {
        let squares = Squares::new(&board.local(&pixel.center, &pixel.sides));
        let Squares { across, below, .. } = &squares;
        let sizes = [below, &across[0], &across[1]].map(|local| local.rad);
        if !sizes.iter().all(|&rad| rad < LARGEST) {
            return Err(Hard);
        }
        match squares.ranges() {
            Some(ranges) => self.lines(&squares, ranges, surface),
            None => Ok(Pattern::Squares(squares)),
        }
    }

    /// The lines between a board's squares.
    fn lines(
        &mut self,
        squares: &Squares,
        [(x0, x1), (z0, z1)]: [(f64, f64); 2],
        surface: &PixelSurface,
    ) -> Result<Pattern, Hard> {
        if (x1 - x0) + (z1 - z0) > LINES as f64 {
            return Ok(Pattern::Squares(*squares));
        }
        let Squares { across, below, odd } = squares;
        let mut odd = odd ^ is_odd(x0) ^ is_odd(z0);
        for (across, first, last) in [(&across[0], x0, x1), (&across[1], z0, z1)] {
            let mut k = first + 1.0;
            while k <= last {
                let line = across.less(k, below);
                // Its sign is that of x/square − k, which is ≥ 0 in the upper square: one more odd
                // step.
                match line.range().side() {
                    Side::Above => odd = !odd,
                    Side::Below => {}
                    Side::Both => {
                        self.lines.push(line.line());
                        // Where it is negative the step is not made: count from the other side.
                        odd = !odd;
                    }
                    Side::Unknown => return Err(Hard),
                }
                k += 1.0;
            }
        }
        let end = self.lines.len();
        Ok(if end == surface.edges[1] {
            Pattern::Plain(surface.code(odd))
        } else {
            Pattern::Lines { end, odd }
        })
    }

    /// Sorts the surfaces from back to front, or has them compared at every sample.
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
            surface.depth = match object.convex() {
                Ok(convex) => {
                    let faces = convex.firsts().iter().map(|face| face.local(pixel));
                    self.planes.extend(faces);
                    let range = [start, self.planes.len()];
                    match convex.is_inside() {
                        true => Depth::Greatest(range),
                        false => Depth::Least(range),
                    }
                }
                Err(sphere) => {
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
        // Of both sides of a comparison, and its own rounding is within theirs.
        let apart = 2.0 * rad * UP;
        if !apart.is_finite() {
            return Err(Hard);
        }
        self.apart = Some(apart);
        Ok(())
    }
}
