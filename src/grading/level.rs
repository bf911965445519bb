//! A picture and candidates on a grid: what it shows in the cells, and what candidates do.

use std::{
    cell::{OnceCell, RefCell},
    collections::HashMap,
    sync::Arc,
};

use super::{grid::Grid, jpeg::Jpeg, light::Curve, made::Made, score::Model, textbook::Moments};
use crate::{area::Area, film::Film};

/// A grid over a part of a picture.
pub struct Level<'a> {
    pub grid: Grid,
    film: &'a Film,
    /// The part's corner in the film.
    corner: [u32; 2],
    /// What it shows in the cells, as light that was encoded in each way, where that was asked for.
    seen: [OnceCell<Vec<[f64; 3]>>; Curve::ALL.len()],
    /// How many samples a cell has; none if it is computed exactly.
    pub samples: Option<usize>,
    pub jpeg: Option<Jpeg>,
    coded: OnceCell<Vec<[f64; 3]>>,
    /// What a right program makes on it.
    pub right: OnceCell<Arc<Made>>,
}

impl<'a> Level<'a> {
    /// Of a grid over the part of a film that has this corner.
    pub fn new(
        grid: Grid,
        film: &'a Film,
        corner: [u32; 2],
        samples: Option<usize>,
        jpeg: Option<Jpeg>,
    ) -> Self {
        Self {
            grid,
            film,
            corner,
            seen: std::array::from_fn(|_| OnceCell::new()),
            samples,
            jpeg,
            coded: OnceCell::new(),
            right: OnceCell::new(),
        }
    }

    /// What the picture shows in the cells, as light that was encoded in a way.
    pub fn seen(&self, curve: Curve) -> &[[f64; 3]] {
        self.seen[curve as usize].get_or_init(|| {
            let [left, top] = self.corner;
            let pixel = |x, y| self.film.pixel(left + x, top + y);
            if curve == Curve::Right {
                return self.grid.reduce(pixel);
            }
            // Most pixels have one of a few bytes.
            let known: RefCell<HashMap<u64, f64>> = RefCell::default();
            let light = |seen: f64| {
                let mut known = known.borrow_mut();
                *known
                    .entry(seen.to_bits())
                    .or_insert_with(|| curve.light(seen))
            };
            self.grid.reduce(|x, y| pixel(x, y).map(light))
        })
    }

    /// What the cells show of something whose pixels are known, all of those of a part.
    pub fn reduced(&self, pixels: &Moments, part: Area) -> Moments {
        let [left, top] = self.corner;
        let index = |x: u32, y: u32| ((top + y) * part.width + left + x) as usize;
        let mean = self.grid.reduce(|x, y| pixels.mean[index(x, y)]);
        let squares = self.grid.reduce(|x, y| {
            let (mean, variance) = (pixels.mean[index(x, y)], pixels.variance[index(x, y)]);
            [0, 1, 2].map(|i| mean[i] * mean[i] + variance[i])
        });
        let pairs = mean.iter().zip(squares);
        let variance = pairs
            .map(|(mean, squares)| [0, 1, 2].map(|i| (squares[i] - mean[i] * mean[i]).max(0.0)))
            .collect();
        Moments { mean, variance }
    }

    /// What a candidate shows on it.
    pub fn model(&self, made: &Made) -> Model {
        let mut model = made.model(&self.grid, self.seen(made.candidate.curve));
        if let Some(jpeg) = self.jpeg {
            let (width, factor) = (self.grid.width(), self.grid.factor as usize);
            let own = || jpeg.variances(&model.moments, width, factor);
            // On cells of several pixels it is about the same for all candidates.
            let variances = match factor {
                1 => &own(),
                _ => self.coded.get_or_init(own),
            };
            model.doubt.resize(variances.len(), [0.0; 3]);
            for (doubt, more) in model.doubt.iter_mut().zip(variances) {
                *doubt = [0, 1, 2].map(|i| doubt[i] + more[i]);
            }
        }
        model
    }
}
