//! A convex object with flat faces: what a triangle, a box and a checkerboard's plane are to a ray.
//!
//! In: linear forms over the view plane. Out: a ray's crossings; over a rectangle, the intervals of
//! their inverse depths. A ray meets the object where no edge's form is negative: the edge
//! functions of Olano and Greer ("Triangle scan conversion using 2D homogeneous coordinates",
//! 1997). Where it does, it enters through the farthest of the planes that the eye looks at from
//! outside and leaves through the nearest of the others: Kay and Kajiya's slabs ("Ray tracing
//! complex scenes", 1986) in inverse depths, which are linear forms. Errors: each form's own bound.

use std::cmp::Ordering;

use super::{
    camera::{Direction, Window},
    crossing::{Crossing, SurfacePart},
    form::Form,
    interval::{Cover, Range},
    local_form::Patch,
};
use crate::math::{Double, Doubt, Radius, Real, UP};

/// A face: the number of its plane, and its inverse depth.
pub type Face<T> = (u8, Form<T>);

/// A convex object with flat faces, prepared for one picture.
#[derive(Clone, Debug)]
pub struct Convex<T: Real> {
    /// Those of the edges, each ≥ 0 on the object's side of it; then the inverse depths of the
    /// faces that rays meet first, and of those behind them.
    forms: Vec<Form<T>>,
    /// How many of the forms are edges', and how many edges' and first faces'.
    edges: u8,
    firsts: u8,
    /// The faces' planes.
    planes: [u8; 6],
    /// The eye is inside, and of the first faces' planes sees the nearest, not the farthest.
    is_inside: bool,
}

impl<T: Real> Convex<T> {
    /// From its edges and those of its faces, six at most, that the eye looks at from outside and
    /// from inside.
    pub fn new(edges: Vec<Form<T>>, fronts: Vec<Face<T>>, backs: Vec<Face<T>>) -> Self {
        let is_inside = fronts.is_empty();
        let firsts = match is_inside {
            true => backs.len(),
            false => fronts.len(),
        };
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

    /// What is seen edge-on: nothing.
    pub fn nothing() -> Self {
        Self::new(Vec::new(), Vec::new(), Vec::new())
    }

    fn edges(&self) -> &[Form<T>] {
        &self.forms[..usize::from(self.edges)]
    }

    /// The inverse depths of the faces where rays meet it first.
    pub fn firsts(&self) -> &[Form<T>] {
        &self.forms[usize::from(self.edges)..usize::from(self.firsts)]
    }

    /// Those of the faces where rays from outside leave it.
    pub fn seconds(&self) -> &[Form<T>] {
        &self.forms[usize::from(self.firsts)..]
    }

    /// Forms that are all ≥ 0 where rays meet it, and one of them 0 at its outline.
    pub fn bounds(&self) -> &[Form<T>] {
        match self.is_inside {
            true => self.edges(),
            false => &self.forms[..usize::from(self.firsts)],
        }
    }

    /// Whether the eye is inside, so that of several faces' planes the nearest is the one that is
    /// seen.
    pub fn is_inside(&self) -> bool {
        self.is_inside
    }

    /// Which part of the object one of its faces is, the first ones before the others.
    pub fn part(&self, face: usize) -> SurfacePart {
        SurfacePart::Plane(self.planes[face])
    }

    /// The inverse depth of a part.
    pub fn face(&self, part: SurfacePart) -> Option<&Form<T>> {
        let mut faces = self.forms[usize::from(self.edges)..].iter().enumerate();
        faces.find_map(|(face, form)| (self.part(face) == part).then_some(form))
    }

    /// The nearest crossing in front of the eye: where the ray enters the closed object or, from
    /// inside, leaves it.
    #[inline]
    pub fn first(&self, r: &Direction<T>) -> Result<Option<Crossing<T>>, Doubt> {
        // What no edge's form is positive of is, in the last precision, too small or too nearly
        // edge-on to be told from nothing.
        let (mut doubt, mut is_met) = (false, self.is_inside || self.edges == 0);
        for edge in self.edges() {
            match edge.at(r).sign() {
                Ok(Ordering::Less) => return Ok(None),
                Ok(sign) => is_met |= sign.is_gt(),
                Err(Doubt) => doubt = true,
            }
        }
        let which = match self.is_inside {
            true => Ordering::Greater,
            false => Ordering::Less,
        };
        let Some(crossing) = self.extreme(0, self.firsts(), r, which) else {
            return Ok(None);
        };
        match crossing.inverse_depth.sign() {
            Ok(Ordering::Greater) => {}
            Ok(_) => return Ok(None),
            Err(Doubt) => doubt = true,
        }
        match doubt {
            true => Err(Doubt),
            false => Ok(is_met.then_some(crossing)),
        }
    }

    /// The crossing behind the first one.
    pub fn second(&self, r: &Direction<T>) -> Option<Crossing<T>> {
        self.extreme(self.firsts().len(), self.seconds(), r, Ordering::Greater)
    }

    /// The least or the greatest inverse depth of some faces. Where two are not clearly apart, the
    /// middle of the least ball need not be the least number, but it is within the greatest
    /// radius of it. In whose plane the crossing lies is said only where it is certain: just
    /// outside of an edge, a ray meets the one plane a little before it meets the box in the
    /// other.
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
            // NaN, from an overflow, is not clear either.
            let is_clear = distance > rad * (2.0 * UP);
            if !is_clear {
                extreme.part = SurfacePart::Edge;
                extreme.inverse_depth.rad = match distance >= T::Radius::ZERO {
                    true => rad,
                    false => T::Radius::INFINITE,
                };
            }
            extreme
        }))
    }
}

impl Convex<f64> {
    /// How it stands to a rectangle; `None` if no ray through it meets the object.
    pub fn cover(&self, patch: &Patch) -> Option<Cover> {
        let mut is_whole = true;
        for edge in self.edges() {
            let range = edge.over(patch);
            if range.high < 0.0 {
                return None;
            }
            is_whole &= range.low > 0.0;
        }
        let which = match self.is_inside {
            true => f64::max,
            false => f64::min,
        };
        let faces = self.firsts().iter().map(|face| face.over(patch));
        let inverse_depth = Range::fold(faces, which)?;
        (inverse_depth.high >= 0.0).then_some(Cover {
            is_whole: is_whole && inverse_depth.low > 0.0,
            inverse_depth,
        })
    }

    /// The inverse depths where rays leave it that enter it.
    pub fn behind(&self, patch: &Patch) -> Option<Range> {
        let faces = self.seconds().iter().map(|face| face.over(patch));
        Range::fold(faces, f64::max)
    }
}

impl Convex<Double> {
    /// The same object for `f64`.
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
