//! Sorts pixels that show nothing but a checkerboard by how many of its lines cross them, so that those that the same numbers of lines cross
//! can be computed together.
//!
//! Which pixels are in a group at the same time does not matter to any of them: what is computed is computed of each by itself.

use multiversion::multiversion;

use super::{
    grid::OUT_OF_REACH,
    polygon::PIXEL,
    together::{Lines, Row, Sums, nearest},
};
use crate::tracer::{PIXELS, Views};

/// At most so many lines cut the pixels into strips, and so many cross those.
pub(super) const STRIPS: usize = 3;
const MOST: usize = 12;

/// In which squares some pixels have their corners.
#[derive(Debug, Default)]
pub(super) struct Corners {
    /// By family and corner, the lower one's number.
    pub squares: [[Row; 4]; 2],
    /// By family, the number of the first square.
    pub first: [Row; 2],
    /// By family, how many lines cross the pixel; infinite where its corners do not show it.
    pub lines: [Row; 2],
}

/// Pixels that the same numbers of lines cross.
#[derive(Debug)]
pub(super) struct Group<P> {
    /// Which pixels they are: no more than are computed together.
    pub pixels: Vec<P>,
    lines: Lines,
    /// How many lines of either family cross each of them, fewer first.
    crossing: [usize; 2],
}

/// All groups there may be.
#[derive(Debug)]
pub(super) struct Groups<P>(Vec<Group<P>>);

impl Corners {
    /// Of pixels that see a board so.
    pub fn look(&mut self, views: &Views) {
        look_widely(views, self);
    }

    #[inline(always)]
    fn see(&mut self, views: &Views) {
        let Views {
            across, below, rad, ..
        } = views;
        let mut levels = [[0.0; PIXELS]; 4];
        // Where it is infinite nothing is known of the pixel.
        let mut doubt = [0.0; PIXELS];
        for (level, at) in levels.iter_mut().zip(PIXEL) {
            for i in 0..PIXELS {
                level[i] = below[0][i] * at.x + below[1][i] * at.y + below[2][i];
                let is_good = (level[i] > 0.0) & (rad[i] < f64::INFINITY);
                doubt[i] += if is_good { 0.0 } else { f64::INFINITY };
            }
        }
        let (mut firsts, mut lasts) = ([[OUT_OF_REACH; PIXELS]; 2], [[-OUT_OF_REACH; PIXELS]; 2]);
        for family in 0..2 {
            let [x, y, z] = &across[family];
            let (first, last) = (&mut firsts[family], &mut lasts[family]);
            for corner in 0..4 {
                let (at, level) = (PIXEL[corner], &levels[corner]);
                let mut squares = [0.0; PIXELS];
                for i in 0..PIXELS {
                    let place = (x[i] * at.x + y[i] * at.y + z[i]) / level[i];
                    doubt[i] += if place.abs() < OUT_OF_REACH {
                        0.0
                    } else {
                        f64::INFINITY
                    };
                    let nearest = nearest(place);
                    let square = nearest - if nearest > place { 1.0 } else { 0.0 };
                    squares[i] = square;
                    first[i] = first[i].min(square);
                    last[i] = last[i].max(square);
                }
                self.squares[family][corner] = squares;
            }
        }
        for family in 0..2 {
            self.first[family] = firsts[family];
            let mut lines = [0.0; PIXELS];
            for i in 0..PIXELS {
                lines[i] = lasts[family][i] - firsts[family][i] + doubt[i];
            }
            self.lines[family] = lines;
        }
    }
}

impl<P> Default for Groups<P> {
    fn default() -> Self {
        let crossings = (0..=STRIPS).flat_map(|few| (0..=MOST).map(move |many| [few, many]));
        let group = |crossing| Group {
            pixels: Vec::new(),
            lines: Lines::default(),
            crossing,
        };
        Self(crossings.map(group).collect())
    }
}

impl<P> Groups<P> {
    /// All of them.
    pub fn all(&mut self) -> impl Iterator<Item = &mut Group<P>> {
        self.0.iter_mut()
    }

    /// Where a pixel goes; none if too many lines cross it.
    pub fn of(&mut self, corners: &Corners, pixel: usize) -> Option<&mut Group<P>> {
        let [a, b] = corners.lines.each_ref().map(|lines| lines[pixel]);
        let (few, many) = if a <= b { (a, b) } else { (b, a) };
        if !(few <= STRIPS as f64 && many <= MOST as f64) {
            return None;
        }
        self.0.get_mut(few as usize * (MOST + 1) + many as usize)
    }
}

impl<P> Group<P> {
    /// Adds a pixel to those of which there are fewer than can be computed together; says whether there is no room for more.
    pub fn push(&mut self, at: P, views: &Views, corners: &Corners, pixel: usize) -> bool {
        self.lines.set(self.pixels.len(), views, corners, pixel);
        self.pixels.push(at);
        self.pixels.len() == PIXELS
    }

    /// The integrals over its pixels.
    pub fn sums(&self) -> Sums {
        self.lines.sums(self.crossing)
    }
}

#[multiversion(targets = "simd")]
fn look_widely(views: &Views, corners: &mut Corners) {
    corners.see(views);
}
