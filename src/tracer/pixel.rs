//! Many samples of one pixel at once.
//!
//! In a pixel every boundary is a linear or a quadratic form of the offset from the pixel's centre, and each has one bound on the error
//! of all its values there. So the objects that may be seen in the pixel are written down as a few forms, those that have one sign all
//! over it are left out, and what is left is evaluated for all samples in plain arrays, which the compiler makes vectors of. A form is
//! divided by its error bound: beyond ±1 its sign is certain. A sample that is not certain is asked for again on its own, exactly, so
//! that nothing here can change what is seen: it only says it sooner.

use glam::DVec2;

use super::{
    camera::{Camera, Direction},
    checkerboard::Checkerboard,
    form::Form,
    object::Object,
    outlook::Live,
    sphere::Sphere,
    world::{Level, World},
};
use crate::{
    area::Area,
    math::{Real, UP},
};

/// So many samples are evaluated at a time.
const CHUNK: usize = 64;

/// The widest vectors that loops are padded for.
const LANES: usize = 8;

/// Fewer samples than this are not worth the preparation.
const FEW: usize = 4;

/// A square of a board is told by lines if no more than this many of them pass through the pixel.
const LINES: usize = 6;

/// What is seen where nothing is hit, and where it is not certain; object i of the pixel is 2i + 1, its second colour 2i + 2.
const BACKGROUND: f64 = 0.0;
const DOUBT: f64 = -1.0;

/// A pixel's objects, prepared for many samples. Kept from pixel to pixel for its room.
#[derive(Debug, Default)]
pub struct Pixel {
    /// The candidates.
    live: Vec<Live>,
    x: u32,
    y: u32,
    surfaces: Vec<Surface>,
    /// Of all surfaces.
    lines: Vec<Line>,
    /// How the surfaces lie, if that is to be looked at sample by sample.
    depths: Option<f64>,
    /// Of all surfaces, if they are looked at.
    planes: Vec<Local>,
    /// Whether samples are to be traced one by one.
    is_hard: bool,
    lanes: Lanes,
}

/// The samples of a chunk.
#[derive(Debug)]
struct Lanes {
    x: [f64; CHUNK],
    y: [f64; CHUNK],
    /// What is seen so far.
    seen: [f64; CHUNK],
    /// How deep that lies.
    nearest: [f64; CHUNK],
    /// How certainly a surface is hit.
    margin: [f64; CHUNK],
    /// What is seen of it.
    shown: [f64; CHUNK],
    /// Its inverse depth.
    depth: [f64; CHUNK],
    /// The product of signs.
    sign: [f64; CHUNK],
}

impl Default for Lanes {
    fn default() -> Self {
        let zeros = [0.0; CHUNK];
        Self {
            x: zeros,
            y: zeros,
            seen: zeros,
            nearest: zeros,
            margin: zeros,
            shown: zeros,
            depth: zeros,
            sign: zeros,
        }
    }
}

/// What a pixel shows of an object.
#[derive(Debug)]
struct Surface {
    /// Its place among the candidates.
    place: usize,
    /// Where its boundaries begin among all lines, and where they end: each is ≥ 0 where it is hit.
    edges: [usize; 2],
    /// The boundary of a sphere.
    conic: Option<Conic>,
    pattern: Pattern,
    depth: Depth,
}

/// Which of its colours an object shows.
#[derive(Debug)]
enum Pattern {
    /// The first or the second.
    Plain(f64),
    /// The first where the product of the lines up to `end`, behind the edges, is positive, if not `odd`.
    Lines { end: usize, odd: bool },
    /// Squares by division.
    Squares(Squares),
}

/// Squares of a checkerboard: N₀/ℓ and N₁/ℓ, rounded down.
#[derive(Clone, Copy, Debug)]
struct Squares {
    across: [Local; 2],
    below: Local,
    odd: bool,
}

/// Where the inverse depth of a surface comes from.
#[derive(Debug)]
enum Depth {
    /// It is not asked for.
    Unknown,
    /// The least of some planes'.
    Least([usize; 2]),
    /// The greatest of them.
    Greatest([usize; 2]),
    /// That of the near side of a sphere, (b + √Q) · factor.
    Sphere { q: Conic, b: Local, factor: f64 },
}

/// A linear form of the offset, and a bound on the error of its computed values in the pixel.
#[derive(Clone, Copy, Debug)]
pub struct Local {
    /// Factors of x, y and 1.
    factors: [f64; 3],
    rad: f64,
}

/// A linear form in units of its error.
#[derive(Clone, Copy, Debug)]
struct Line([f64; 3]);

/// A quadratic form of the offset: factors of 1, x, y, x², xy and y²; and a bound on the error of its values.
#[derive(Clone, Copy, Debug)]
pub struct Conic {
    factors: [f64; 6],
    rad: f64,
}

/// A pixel, or a rectangle of pixels; the offsets of its forms are in units of its sides.
#[derive(Clone, Debug)]
pub struct Here {
    /// The ray through its centre.
    pub center: Direction<f64>,
    /// Its sides in units of X and Y.
    pub sides: [f64; 2],
}

/// Where a form stands to 0 all over a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Side {
    Above,
    Below,
    Both,
    /// It has overflowed.
    Unknown,
}

/// Roundings on the way to a value of a local form, generously counted.
const ROUNDINGS: f64 = 16.0 * f64::UNIT;

impl Local {
    /// From its factors, and a bound on what it is off but for the roundings of its evaluation.
    pub fn new(factors: [f64; 3], inherited: f64) -> Self {
        let [a, b, c] = factors.map(f64::abs);
        let rad = (inherited + (a + b + c) * ROUNDINGS + 16.0 * f64::TINY) * UP;
        Self { factors, rad }
    }

    /// Half the difference between its greatest and its least value in the pixel.
    fn spread(&self) -> f64 {
        let [a, b, _] = self.factors;
        0.5 * (a.abs() + b.abs())
    }

    fn side(&self) -> Side {
        side(self.factors[2], self.spread() * UP, self.rad)
    }

    fn line(&self) -> Line {
        Line(self.factors.map(|factor| factor / self.rad))
    }

    fn at(&self, x: f64, y: f64) -> f64 {
        let [a, b, c] = self.factors;
        a * x + b * y + c
    }
}

impl Here {
    fn new(camera: &Camera<f64>, area: Area) -> Self {
        Self {
            center: camera.direction(&camera.middle(area)),
            sides: [area.width, area.height].map(|pixels| f64::from(pixels) * camera.pitch),
        }
    }
}

/// A form's side, from its value at the centre.
fn side(center: f64, spread: f64, rad: f64) -> Side {
    let reach = spread + rad;
    if !(center.abs() + reach).is_finite() {
        Side::Unknown
    } else if center > reach {
        Side::Above
    } else if center < -reach {
        Side::Below
    } else {
        Side::Both
    }
}

impl Form<f64> {
    /// The form in a pixel. Its own error bound counts twice: for its factors, and for its value at the pixel's centre.
    fn local(&self, here: &Here) -> Local {
        let [a, b, _] = *self.factors();
        let [width, height] = here.sides;
        let factors = [a * width, b * height, self.at(&here.center).mid];
        Local::new(factors, 2.0 * self.rad())
    }
}

impl Conic {
    /// From its factors, and a bound on what it is off but for the roundings of its evaluation.
    pub fn new(factors: [f64; 6], inherited: f64) -> Self {
        let sizes: f64 = factors.iter().map(|factor| factor.abs()).sum();
        let rad = (inherited + sizes * ROUNDINGS + 16.0 * f64::TINY) * UP;
        Self { factors, rad }
    }

    fn side(&self) -> Side {
        let [c, x, y, xx, xy, yy] = self.factors;
        let spread = 0.5 * (x.abs() + y.abs()) + 0.25 * (xx.abs() + xy.abs() + yy.abs());
        side(c, spread * UP, self.rad)
    }

    /// The same in units of its error.
    fn certain(&self) -> Self {
        Self {
            factors: self.factors.map(|factor| factor / self.rad),
            rad: 1.0,
        }
    }

    #[inline(always)]
    fn at(&self, x: f64, y: f64) -> f64 {
        let [c, fx, fy, xx, xy, yy] = self.factors;
        c + x * (fx + xx * x + xy * y) + y * (fy + yy * y)
    }
}

/// The preparation has met something that is better traced sample by sample.
struct Hard;

/// Whether an object is seen in the pixel at all.
enum Met {
    Yes,
    No,
}

impl World {
    /// Prepares a pixel, given the objects that may be seen there, in file order.
    pub fn look(&self, x: u32, y: u32, live: &[Live], pixel: &mut Pixel) {
        (pixel.x, pixel.y) = (x, y);
        pixel.live.clear();
        pixel.live.extend_from_slice(live);
        pixel.is_hard = pixel.prepare(self).is_err();
    }

    /// Whether a part of the picture, in which a checkerboard is all that may be seen, shows but one of its squares, and then whether
    /// that has the second colour.
    pub fn only_square(&self, part: Area, object: usize) -> Option<bool> {
        let object = f64::object(self, object);
        let Object::Checkerboard(board) = &*object else {
            return None;
        };
        let here = Here::new(&f64::frame(self).camera, part);
        let squares = Squares::new(board, &here);
        let mut odd = squares.odd;
        for across in &squares.across {
            let (first, last) = squares.range(across)?;
            if first != last {
                return None;
            }
            odd ^= is_odd(first);
        }
        Some(odd)
    }

    /// Counts what the samples at some offsets from the centre of a pixel see: `count` is told slots of the palette, each any number
    /// of times.
    pub fn count(&self, pixel: &mut Pixel, points: &[DVec2], mut count: impl FnMut(usize, u64)) {
        if pixel.is_hard || points.len() < FEW {
            for &point in points {
                count(
                    self.slot_among(pixel.x, pixel.y, point, pixel.live.iter()),
                    1,
                );
            }
            return;
        }
        for points in points.chunks(CHUNK) {
            pixel.chunk(points);
            let seen = &pixel.lanes.seen[..points.len()];
            let mut left = points.len() as u64;
            let mut tell = |code: f64, slot: usize| {
                let lanes = seen.iter().filter(|&&lane| lane == code).count() as u64;
                if lanes > 0 {
                    count(slot, lanes);
                    left -= lanes;
                }
            };
            for surface in &pixel.surfaces {
                let [first, second] = self.slots(pixel.live[surface.place].object);
                match surface.pattern {
                    Pattern::Plain(code) if code == surface.code(true) => tell(code, second),
                    Pattern::Plain(code) => tell(code, first),
                    _ => {
                        tell(surface.code(false), first);
                        tell(surface.code(true), second);
                    }
                }
            }
            tell(BACKGROUND, self.background());
            if left > 0 {
                for (&point, &lane) in points.iter().zip(seen) {
                    if lane == DOUBT {
                        let slot = self.slot_among(pixel.x, pixel.y, point, pixel.live.iter());
                        count(slot, 1);
                    }
                }
            }
        }
    }
}

impl Surface {
    /// What stands for one of its colours.
    fn code(&self, odd: bool) -> f64 {
        (2 * self.place + 1 + usize::from(odd)) as f64
    }
}

impl Pixel {
    fn prepare(&mut self, world: &World) -> Result<(), Hard> {
        let here = Here::new(&f64::frame(world).camera, Area::pixel(self.x, self.y));
        self.surfaces.clear();
        self.lines.clear();
        self.planes.clear();
        for place in 0..self.live.len() {
            self.surface(world, &here, place)?;
        }
        self.order(world, &here)
    }

    /// Writes down a candidate's boundaries and colours.
    fn surface(&mut self, world: &World, here: &Here, place: usize) -> Result<(), Hard> {
        let live = self.live[place];
        let object = &*f64::object(world, live.object);
        let start = self.lines.len();
        let mut surface = Surface {
            place,
            edges: [start; 2],
            conic: None,
            pattern: Pattern::Plain(0.0),
            depth: Depth::Unknown,
        };
        let met = match object {
            Object::EdgeOn => Met::No,
            _ if live.is_whole => Met::Yes,
            Object::Triangle(triangle) => self.edges(triangle.edges.iter(), here)?,
            Object::Checkerboard(board) => self.edges([&board.plane].into_iter(), here)?,
            Object::Cuboid(cuboid) => {
                let sides: Vec<_> = cuboid.sides().collect();
                self.edges(sides.iter(), here)?
            }
            Object::Sphere(sphere) => self.silhouette(sphere, here, &mut surface)?,
        };
        if matches!(met, Met::No) {
            self.lines.truncate(start);
            return Ok(());
        }
        if let Met::No = self.clips(world, here, live, object)? {
            self.lines.truncate(start);
            return Ok(());
        }
        surface.edges[1] = self.lines.len();
        surface.pattern = Pattern::Plain(surface.code(false));
        if let Object::Checkerboard(board) = object {
            let [first, second] = world.slots(live.object);
            if first != second {
                surface.pattern = self.pattern(board, here, &surface)?;
            }
        }
        self.surfaces.push(surface);
        Ok(())
    }

    /// Adds forms that are all ≥ 0 where an object is hit.
    fn edges<'a>(
        &mut self,
        mut forms: impl Iterator<Item = &'a Form<f64>>,
        here: &Here,
    ) -> Result<Met, Hard> {
        forms.try_fold(Met::Yes, |met, form| {
            Ok(match (met, self.edge(form.local(here))?) {
                (Met::Yes, Met::Yes) => Met::Yes,
                _ => Met::No,
            })
        })
    }

    fn edge(&mut self, local: Local) -> Result<Met, Hard> {
        match local.side() {
            Side::Above => Ok(Met::Yes),
            Side::Below => Ok(Met::No),
            Side::Both => {
                self.lines.push(local.line());
                Ok(Met::Yes)
            }
            Side::Unknown => Err(Hard),
        }
    }

    /// Where a sphere is hit: everywhere, by an eye inside.
    fn silhouette(
        &mut self,
        sphere: &Sphere<f64>,
        here: &Here,
        surface: &mut Surface,
    ) -> Result<Met, Hard> {
        if !sphere.is_outside() {
            // On the surface, or too seldom seen in part to be worth a rule of its own.
            return Err(Hard);
        }
        let (q, b) = sphere.local(here);
        match q.side() {
            Side::Above => {}
            Side::Below => return Ok(Met::No),
            Side::Both => surface.conic = Some(q.certain()),
            Side::Unknown => return Err(Hard),
        }
        self.edge(b)
    }

    /// What the near and the far plane leave of an object with a single surface.
    fn clips(
        &mut self,
        world: &World,
        here: &Here,
        live: Live,
        object: &Object<f64>,
    ) -> Result<Met, Hard> {
        let frame = f64::frame(world);
        let plane = match object {
            Object::Triangle(triangle) => Some(&triangle.plane),
            Object::Checkerboard(board) => Some(&board.plane),
            _ => None,
        };
        let mut met = Met::Yes;
        if live.is_cut {
            let (Some(near), Some(plane)) = (&frame.near, plane) else {
                return Err(Hard);
            };
            met = self.edge(near.minus(plane).local(here))?;
        }
        if let Some(far) = &frame.far
            && !live.is_whole
        {
            let depth = far.local(here);
            let is_before =
                live.inverse_depth.low > depth.factors[2] + depth.spread() * UP + depth.rad;
            if !is_before {
                let plane = plane.ok_or(Hard)?;
                if let Met::No = self.edge(plane.minus(far).local(here))? {
                    met = Met::No;
                }
            }
        }
        Ok(met)
    }

    /// Which squares a board shows.
    fn pattern(
        &mut self,
        board: &Checkerboard<f64>,
        here: &Here,
        surface: &Surface,
    ) -> Result<Pattern, Hard> {
        let squares = Squares::new(board, here);
        let Squares { across, below, .. } = squares;
        let sizes = [&below, &across[0], &across[1]].map(|local| local.rad);
        if !sizes.iter().all(|&rad| rad < 1e250) {
            return Err(Hard);
        }
        let Some([(x0, x1), (z0, z1)]) = squares.ranges() else {
            return Ok(Pattern::Squares(squares));
        };
        if (x1 - x0) + (z1 - z0) > LINES as f64 {
            return Ok(Pattern::Squares(squares));
        }
        let mut odd = board.odd ^ is_odd(x0) ^ is_odd(z0);
        for (across, first, last) in [(&across[0], x0, x1), (&across[1], z0, z1)] {
            let mut k = first + 1.0;
            while k <= last {
                let line = across.less(k, &below);
                // Its sign is that of x/square − k, which is ≥ 0 in the upper square: one more odd step.
                match line.side() {
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
    fn order(&mut self, world: &World, here: &Here) -> Result<(), Hard> {
        let live = &self.live;
        let range = |surface: &Surface| live[surface.place].inverse_depth;
        self.surfaces
            .sort_by(|a, b| range(a).low.total_cmp(&range(b).low));
        let is_sorted = self
            .surfaces
            .windows(2)
            .all(|pair| range(&pair[0]).high < range(&pair[1]).low);
        self.depths = None;
        if is_sorted {
            return Ok(());
        }
        let mut rad = 0.0_f64;
        for surface in &mut self.surfaces {
            let start = self.planes.len();
            let object = &*f64::object(world, self.live[surface.place].object);
            surface.depth = match object {
                Object::EdgeOn => return Err(Hard),
                Object::Triangle(triangle) => {
                    self.planes.push(triangle.plane.local(here));
                    Depth::Least([start, start + 1])
                }
                Object::Checkerboard(board) => {
                    self.planes.push(board.plane.local(here));
                    Depth::Least([start, start + 1])
                }
                Object::Cuboid(cuboid) => {
                    self.planes
                        .extend(cuboid.firsts().map(|face| face.local(here)));
                    let range = [start, self.planes.len()];
                    if object.is_seen_from_inside() {
                        Depth::Greatest(range)
                    } else {
                        Depth::Least(range)
                    }
                }
                Object::Sphere(sphere) => {
                    let (factor, error) = sphere.depth_factor().ok_or(Hard)?;
                    let (q, b) = sphere.local(here);
                    let root = q.factors.iter().map(|factor| factor.abs()).sum::<f64>();
                    let size = root.sqrt() + b.factors[2].abs() + b.spread();
                    // |√a − √b| ≤ √|a − b|.
                    let own = b.rad + q.rad.sqrt() + size * (ROUNDINGS + error);
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
        self.depths = Some(apart);
        Ok(())
    }

    /// What the samples of a chunk see.
    fn chunk(&mut self, points: &[DVec2]) {
        let length = points.len().next_multiple_of(LANES).min(CHUNK);
        let lanes = &mut self.lanes;
        for ((x, y), point) in lanes.x.iter_mut().zip(&mut lanes.y).zip(points) {
            (*x, *y) = (point.x, point.y);
        }
        lanes.seen[..length].fill(BACKGROUND);
        if self.depths.is_some() {
            lanes.nearest[..length].fill(f64::NEG_INFINITY);
        }
        for surface in &self.surfaces {
            let [start, end] = surface.edges;
            lanes.margin(&self.lines[start..end], surface.conic.as_ref(), length);
            let shown = match &surface.pattern {
                Pattern::Plain(code) => Some(*code),
                Pattern::Lines { end: last, odd } => {
                    let codes = [*odd, !*odd].map(|odd| surface.code(odd));
                    lanes.between(&self.lines[end..*last], codes, length);
                    None
                }
                Pattern::Squares(squares) => {
                    let codes = [squares.odd, !squares.odd].map(|odd| surface.code(odd));
                    lanes.squares(squares, codes, length);
                    None
                }
            };
            if let Some(code) = shown {
                lanes.shown[..length].fill(code);
            }
            match self.depths {
                None => lanes.cover(length),
                Some(apart) => {
                    lanes.depths(&surface.depth, &self.planes, length);
                    lanes.merge(apart, length);
                }
            }
        }
    }
}

impl Local {
    /// self − k · other, for a whole number k.
    fn less(&self, k: f64, other: &Self) -> Self {
        let sizes: f64 = (0..3)
            .map(|i| self.factors[i].abs() + (k * other.factors[i]).abs())
            .sum();
        let factors = [0, 1, 2].map(|i| self.factors[i] - k * other.factors[i]);
        let inherited = self.rad + k.abs() * other.rad + sizes * ROUNDINGS;
        Self::new(factors, inherited)
    }
}

impl Squares {
    fn new(board: &Checkerboard<f64>, here: &Here) -> Self {
        Self {
            across: board.across.each_ref().map(|form| form.local(here)),
            below: board.below.local(here),
            odd: board.odd,
        }
    }

    /// From which to which square there are any in the pixel, in x and in z.
    fn ranges(&self) -> Option<[(f64, f64); 2]> {
        let [x, z] = &self.across;
        Some([self.range(x)?, self.range(z)?])
    }

    /// The same along one axis: perhaps one square more than there are. `None` if that is not certain.
    fn range(&self, across: &Local) -> Option<(f64, f64)> {
        const CORNERS: [(f64, f64); 4] = [(-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5), (0.5, 0.5)];
        let least = self.below.factors[2] - self.below.spread() * UP;
        if least <= 4.0 * self.below.rad {
            return None;
        }
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        // A ratio of linear forms is the greatest and the least at corners.
        for (x, y) in CORNERS {
            let value = across.at(x, y) / self.below.at(x, y);
            (low, high) = (low.min(value), high.max(value));
        }
        let size = low.abs().max(high.abs());
        let slack = (across.rad + size * self.below.rad) * 4.0 / least + size * ROUNDINGS;
        (slack < 0.25).then(|| ((low - slack).floor(), (high + slack).floor()))
    }
}

fn is_odd(whole: f64) -> bool {
    // `ranges` answers for numbers far below 2^53.
    whole as i64 & 1 == 1
}

impl Lanes {
    /// The least of the boundaries' values, in units of their errors.
    fn margin(&mut self, edges: &[Line], conic: Option<&Conic>, length: usize) {
        let (x, y) = (&self.x[..length], &self.y[..length]);
        let margin = &mut self.margin[..length];
        match conic {
            None => margin.fill(f64::INFINITY),
            Some(conic) => {
                for ((margin, &x), &y) in margin.iter_mut().zip(x).zip(y) {
                    *margin = conic.at(x, y);
                }
            }
        }
        for Line([a, b, c]) in edges {
            for ((margin, &x), &y) in margin.iter_mut().zip(x).zip(y) {
                let value = a * x + b * y + c;
                *margin = if value < *margin { value } else { *margin };
            }
        }
    }

    /// Which side of an odd number of lines a sample is on.
    fn between(&mut self, lines: &[Line], [even, odd]: [f64; 2], length: usize) {
        let (x, y) = (&self.x[..length], &self.y[..length]);
        let (sign, least) = (&mut self.sign[..length], &mut self.shown[..length]);
        sign.fill(1.0);
        least.fill(f64::INFINITY);
        for Line([a, b, c]) in lines {
            let samples = x.iter().zip(y);
            for ((sign, least), (&x, &y)) in sign.iter_mut().zip(&mut *least).zip(samples) {
                let value = a * x + b * y + c;
                *sign *= value;
                let size = value.abs();
                *least = if size < *least { size } else { *least };
            }
        }
        for (&sign, shown) in sign.iter().zip(least) {
            let code = if sign > 0.0 { even } else { odd };
            *shown = if *shown > 1.0 { code } else { DOUBT };
        }
    }

    /// In which squares of a board the samples lie.
    fn squares(&mut self, squares: &Squares, [even, odd]: [f64; 2], length: usize) {
        /// Added and taken away again, it rounds to a whole number, whose last bit is that of the sum.
        const ROUND: f64 = 1.5 * (1u64 << 52) as f64;
        const ONE: u64 = 1.0f64.to_bits();
        let (x, y) = (&self.x[..length], &self.y[..length]);
        let Local { factors: l, rad } = squares.below;
        let [n0, n1] = squares.across.map(|across| across.factors);
        let rads = squares.across.map(|across| across.rad);
        for ((shown, &x), &y) in self.shown[..length].iter_mut().zip(x).zip(y) {
            let below = l[0] * x + l[1] * y + l[2];
            let inverse = 1.0 / below;
            let double = 2.0 * UP * inverse;
            let place = |n: [f64; 3], own: f64| {
                let value = (n[0] * x + n[1] * y + n[2]) * inverse;
                // |N'/ℓ' − N/ℓ| ≤ (|N' − N| + |N/ℓ| |ℓ' − ℓ|)/ℓ', and ℓ' is at least ℓ/2.
                let error = (own + value.abs() * rad) * double + (value.abs() + 1.0) * ROUNDINGS;
                let middle = value - 0.5;
                let rounded = middle + ROUND;
                let room = 0.5 - (middle - (rounded - ROUND)).abs();
                (rounded.to_bits(), room - error * UP)
            };
            let ((bits0, room0), (bits1, room1)) = (place(n0, rads[0]), place(n1, rads[1]));
            let parity = f64::from_bits(ONE | (bits0 ^ bits1) << 63);
            let code = if parity > 0.0 { even } else { odd };
            // Not so for NaN either, and the error of what is too great for the rounding is too great, too.
            let first = if room0 > 0.0 { code } else { DOUBT };
            let second = if room1 > 0.0 { first } else { DOUBT };
            *shown = if below > 2.0 * UP * rad {
                second
            } else {
                DOUBT
            };
        }
    }

    /// Puts a surface in front of all so far.
    fn cover(&mut self, length: usize) {
        let surface = self.margin[..length].iter().zip(&self.shown[..length]);
        for (seen, (&margin, &shown)) in self.seen[..length].iter_mut().zip(surface) {
            let missed = if margin < -1.0 { *seen } else { DOUBT };
            *seen = if margin > 1.0 { shown } else { missed };
        }
    }

    /// The inverse depths of a surface.
    fn depths(&mut self, depth: &Depth, planes: &[Local], length: usize) {
        let (x, y) = (&self.x[..length], &self.y[..length]);
        let out = &mut self.depth[..length];
        match *depth {
            Depth::Unknown => out.fill(f64::NAN),
            Depth::Least([start, end]) => {
                out.fill(f64::INFINITY);
                for plane in &planes[start..end] {
                    for ((out, &x), &y) in out.iter_mut().zip(x).zip(y) {
                        let value = plane.at(x, y);
                        *out = if value < *out { value } else { *out };
                    }
                }
            }
            Depth::Greatest([start, end]) => {
                out.fill(f64::NEG_INFINITY);
                for plane in &planes[start..end] {
                    for ((out, &x), &y) in out.iter_mut().zip(x).zip(y) {
                        let value = plane.at(x, y);
                        *out = if value > *out { value } else { *out };
                    }
                }
            }
            Depth::Sphere { q, b, factor } => {
                for ((out, &x), &y) in out.iter_mut().zip(x).zip(y) {
                    let q = q.at(x, y);
                    let q = if q > 0.0 { q } else { 0.0 };
                    *out = (b.at(x, y) + q.sqrt()) * factor;
                }
            }
        }
    }

    /// Puts a surface before or behind what is seen so far, `apart` being how far depths must differ for that to be certain.
    fn merge(&mut self, apart: f64, length: usize) {
        let surface = self.margin[..length]
            .iter()
            .zip(&self.shown[..length])
            .zip(&self.depth[..length]);
        let so_far = self.seen[..length]
            .iter_mut()
            .zip(&mut self.nearest[..length]);
        for ((seen, nearest), ((&margin, &shown), &depth)) in so_far.zip(surface) {
            let ahead = depth - *nearest;
            let shown = if margin > 1.0 { shown } else { DOUBT };
            let close = if ahead > apart { shown } else { DOUBT };
            let new = if ahead < -apart { *seen } else { close };
            let greatest = if depth > *nearest { depth } else { *nearest };
            *seen = if margin < -1.0 { *seen } else { new };
            *nearest = if margin < -1.0 { *nearest } else { greatest };
        }
    }
}
