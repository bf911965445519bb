//! A convex object with flat faces: what a triangle, a box and a checkerboard's plane are to a ray.
//!
//! In: linear forms over the view plane. Out: a ray's crossings; over a rectangle, the intervals of
//! their inverse depths. A ray meets the object where no edge's form is negative: the edge
//! functions of Olano and Greer ("Triangle scan conversion using 2D homogeneous coordinates",
//! 1997). There it enters through the farthest of the planes that the eye sees from outside, and
//! leaves through the nearest of the others: the slabs of Kay and Kajiya ("Ray tracing complex
//! scenes", 1986) in inverse depths, which are linear forms. Errors: each form has its own bound.

use std::cmp::Ordering;

use super::{
    camera::{Direction, Window},
    crossing::{Crossing, SurfacePart},
    form::Form,
    interval::{Cover, Interval},
    local_form::Patch,
};
use crate::math::{Double, Doubt, Radius, Real, UP};

/// A face: the number of its plane, and its inverse depth as a form.
pub type Face<T> = (u8, Form<T>);

/// A convex object with flat faces, prepared for one picture.
#[derive(Clone, Debug)]
pub struct Convex<T: Real> {
    /// First the forms of the edges, each ≥ 0 on the object's side; then the inverse depths of the
    /// faces that rays meet first, and of the faces behind them.
    forms: Vec<Form<T>>,
    /// Number of edges.
    edges: u8,
    /// Number of edges and first faces together.
    firsts: u8,
    /// Numbers of the faces' planes.
    planes: [u8; 6],
    /// Whether the eye is inside, so that a ray first meets the nearest of the first faces'
    /// planes, not the farthest.
    is_inside: bool,
}

impl<T: Real> Convex<T> {
    /// Builds an object from its edges and its faces, at most six: those that the eye sees from
    /// outside, and those that it sees from inside.
    pub fn new(edges: Vec<Form<T>>, fronts: Vec<Face<T>>, backs: Vec<Face<T>>) -> Self {
        let is_inside = fronts.is_empty();
        let firsts = if is_inside { backs.len() } else { fronts.len() };
        let mut convex = Self {
            edges: edges.len() as u8,
            firsts: (edges.len() + firsts) as u8,
            planes: [0; 6],
            is_inside,
            forms: edges,
        };
        convex.forms.reserve_exact(fronts.len() + backs.len());
        for (place, (plane, form)) in convex
            .planes
            .iter_mut()
            .zip(fronts.into_iter().chain(backs))
        {
            *place = plane;
            convex.forms.push(form);
        }
        convex
    }

    /// An object that no ray meets, such as one that is seen edge-on.
    pub fn nothing() -> Self {
        Self::new(Vec::new(), Vec::new(), Vec::new())
    }

    fn edges(&self) -> &[Form<T>] {
        &self.forms[..usize::from(self.edges)]
    }

    /// The inverse depths of the faces where rays first meet the object.
    pub fn firsts(&self) -> &[Form<T>] {
        &self.forms[usize::from(self.edges)..usize::from(self.firsts)]
    }

    /// The inverse depths of the faces where rays from outside leave the object.
    pub fn seconds(&self) -> &[Form<T>] {
        &self.forms[usize::from(self.firsts)..]
    }

    /// Forms that are all ≥ 0 where rays meet the object, and one of which is 0 on its outline.
    pub fn bounds(&self) -> &[Form<T>] {
        if self.is_inside {
            return self.edges();
        }
        &self.forms[..usize::from(self.firsts)]
    }

    /// Whether the eye is inside, so that of several faces' planes the nearest one is seen.
    pub fn is_inside(&self) -> bool {
        self.is_inside
    }

    /// Returns the surface part of a face, by its index among all faces, the first ones before the
    /// others.
    pub fn part(&self, face: usize) -> SurfacePart {
        SurfacePart::Plane(self.planes[face])
    }

    /// Returns the inverse depth of a part.
    pub fn face(&self, part: SurfacePart) -> Option<&Form<T>> {
        let mut faces = self.forms[usize::from(self.edges)..].iter().enumerate();
        faces.find_map(|(face, form)| (self.part(face) == part).then_some(form))
    }

    /// Returns the nearest crossing in front of the eye: where the ray enters the closed object or,
    /// from inside, leaves it.
    #[inline]
    pub fn first(&self, r: &Direction<T>) -> Result<Option<Crossing<T>>, Doubt> {
        // In the last precision, an object of which no edge's form is positive is too small or too
        // nearly edge-on to be distinguished from nothing.
        let (mut doubt, mut is_met) = (false, self.is_inside || self.edges == 0);
        for edge in self.edges() {
            match edge.at(r).sign() {
                Ok(Ordering::Less) => return Ok(None),
                Ok(sign) => is_met |= sign.is_gt(),
                Err(Doubt) => doubt = true,
            }
        }
        let which = if self.is_inside {
            Ordering::Greater
        } else {
            Ordering::Less
        };
        let Some(crossing) = self.extreme(0, self.firsts(), r, which) else {
            return Ok(None);
        };
        match crossing.inverse_depth.sign() {
            Ok(Ordering::Greater) => {}
            Ok(_) => return Ok(None),
            Err(Doubt) => doubt = true,
        }
        if doubt {
            return Err(Doubt);
        }
        Ok(is_met.then_some(crossing))
    }

    /// Returns the crossing behind the first one.
    pub fn second(&self, r: &Direction<T>) -> Option<Crossing<T>> {
        self.extreme(self.firsts().len(), self.seconds(), r, Ordering::Greater)
    }

    /// Returns the least or the greatest inverse depth of some faces. If two of them are not
    /// clearly apart, the centre of the least ball need not be the least number, but is within the
    /// larger radius of it. The crossing is assigned to a plane only if that is certain: just
    /// outside of an edge, a ray meets one plane slightly before it meets the box in the other.
    #[inline]
    fn extreme(
        &self,
        start: usize,
        faces: &[Form<T>],
        r: &Direction<T>,
        which: Ordering,
    ) -> Option<Crossing<T>> {
        let mut crossings = faces.iter().enumerate().map(|(face, form)| Crossing {
            inverse_depth: form.at(r),
            part: self.part(start + face),
        });
        let first = crossings.next()?;
        Some(crossings.fold(first, |mut extreme, other| {
            let rad = extreme.inverse_depth.rad.max(other.inverse_depth.rad);
            let difference = other.inverse_depth.mid.minus(&extreme.inverse_depth.mid);
            let distance = difference.magnitude();
            if !difference.is_zero() && difference.is_negative() == which.is_lt() {
                extreme = other;
            }
            // NaN, which comes from an overflow, is not clear either.
            let is_clear = distance > rad * (2.0 * UP);
            if !is_clear {
                extreme.part = SurfacePart::Edge;
                let is_number = distance >= T::Radius::ZERO;
                extreme.inverse_depth.rad = if is_number { rad } else { T::Radius::INFINITE };
            }
            extreme
        }))
    }
}

impl Convex<f64> {
    /// Relates the object to a rectangle. Returns `None` if no ray through the rectangle meets it.
    pub fn cover(&self, patch: &Patch) -> Option<Cover> {
        let mut is_whole = true;
        for edge in self.edges() {
            let range = edge.over(patch);
            if range.high < 0.0 {
                return None;
            }
            is_whole &= range.low > 0.0;
        }
        let which = if self.is_inside { f64::max } else { f64::min };
        let faces = self.firsts().iter().map(|face| face.over(patch));
        let inverse_depth = Interval::fold(faces, which)?;
        (inverse_depth.high >= 0.0).then_some(Cover {
            is_whole: is_whole && inverse_depth.low > 0.0,
            inverse_depth,
        })
    }

    /// Returns the inverse depths of the crossings where rays from outside leave the object.
    pub fn behind(&self, patch: &Patch) -> Option<Interval> {
        let faces = self.seconds().iter().map(|face| face.over(patch));
        Interval::fold(faces, f64::max)
    }
}

impl Convex<Double> {
    /// Rounds the object to `f64`.
    pub fn narrowed(&self, window: &Window<f64>) -> Convex<f64> {
        Convex {
            forms: self.forms.iter().map(|f| f.narrowed(window)).collect(),
            edges: self.edges,
            firsts: self.firsts,
            planes: self.planes,
            is_inside: self.is_inside,
        }
    }
}
