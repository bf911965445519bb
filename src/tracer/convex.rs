//! A convex object with flat faces: the geometry of a triangle, a box, or a checkerboard's plane.
//!
//! In: linear forms over the view plane. Out: the crossings of a ray; over a rectangle, the ranges
//! of the crossings' inverse depths.
//!
//! A ray hits the object if none of the edges' linear forms is negative at the ray. These forms are
//! the edge functions of Olano and Greer ("Triangle scan conversion using 2D homogeneous
//! coordinates", 1997). The ray enters through the farthest of the planes that the eye sees from
//! outside, and leaves through the nearest of the other planes. This is the method of slabs of Kay
//! and Kajiya ("Ray tracing complex scenes", 1986), applied to inverse depths, which are linear
//! forms. Each form has its own error bound.

use std::cmp::Ordering;

use super::{
    camera::{Direction, Window},
    crossing::{Crossing, SurfacePart},
    form::Form,
    interval::{Cover, Interval},
    local_form::Patch,
};
use crate::math::{Double, Doubt, Radius, Real, UP};

/// A face of a convex object: the number of its plane, and its inverse depth as a linear form.
pub type Face<T> = (u8, Form<T>);

/// A convex object with flat faces, prepared for one picture.
#[derive(Clone, Debug)]
pub struct Convex<T: Real> {
    /// Linear forms over the view plane in three groups. First come the forms that bound the
    /// object, each ≥ 0 on the object's side. Then come the inverse depths of the faces where rays
    /// first hit the object. The inverse depths of all other faces come last.
    forms: Vec<Form<T>>,
    /// Number of the forms that bound the object.
    edges: u8,
    /// Number of the forms in the first two groups: those that bound the object, and those of the
    /// faces where rays first hit it. The forms from this index on belong to the other faces.
    firsts: u8,
    /// Numbers that identify the planes of the faces. The faces where rays first hit the object
    /// come before the other faces.
    planes: [u8; 6],
    /// Whether the eye is inside the object. If it is, a ray leaves the object at the nearest of
    /// its crossings with the faces' planes. Otherwise, the ray enters the object at the farthest
    /// of its crossings with the planes of the front faces.
    is_inside: bool,
}

impl<T: Real> Convex<T> {
    /// Builds an object. `edges` are forms that are ≥ 0 on the object's side. `fronts` are the
    /// faces that the eye sees from outside, and `backs` those that it sees from inside; together
    /// they are at most six. Without `fronts`, the eye is inside.
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

    /// Returns an object that no ray hits, such as a triangle that is seen edge-on.
    pub fn nothing() -> Self {
        Self::new(Vec::new(), Vec::new(), Vec::new())
    }

    fn edges(&self) -> &[Form<T>] {
        &self.forms[..usize::from(self.edges)]
    }

    /// Returns the inverse depths of the faces where rays first hit the object.
    pub fn firsts(&self) -> &[Form<T>] {
        &self.forms[usize::from(self.edges)..usize::from(self.firsts)]
    }

    /// Returns the inverse depths of the faces where rays from outside leave the object.
    pub fn seconds(&self) -> &[Form<T>] {
        &self.forms[usize::from(self.firsts)..]
    }

    /// Returns the forms that bound the object: all are ≥ 0 for rays that hit the object, and at
    /// least one is 0 on its silhouette.
    pub fn bounds(&self) -> &[Form<T>] {
        if self.is_inside {
            return self.edges();
        }
        &self.forms[..usize::from(self.firsts)]
    }

    /// Returns whether the eye is inside the object. If it is, a ray hits the object at the nearest
    /// of its crossings with the planes of [`firsts`](Self::firsts); otherwise, at the farthest.
    pub fn is_inside(&self) -> bool {
        self.is_inside
    }

    /// Returns the face with the index `face` as a part of the object's surface. Faces where rays
    /// first hit the object have lower indices than the other faces.
    pub fn part(&self, face: usize) -> SurfacePart {
        SurfacePart::Plane(self.planes[face])
    }

    /// Returns the inverse depth of the face `part` as a linear form. Returns `None` if the object
    /// does not have this face.
    pub fn face(&self, part: SurfacePart) -> Option<&Form<T>> {
        let mut faces = self.forms[usize::from(self.edges)..].iter().enumerate();
        faces.find_map(|(face, form)| (self.part(face) == part).then_some(form))
    }

    /// Returns the nearest crossing in front of the eye. If the eye is inside the object, the ray
    /// leaves the object there; otherwise, it enters. Returns `None` if the ray misses the object,
    /// and a [`Doubt`] if rounding errors leave this uncertain. A ray on an edge hits the object.
    #[inline]
    pub fn first(&self, r: &Direction<T>) -> Result<Option<Crossing<T>>, Doubt> {
        // If the object is very small or almost edge-on, the values of all its edge functions may
        // be 0 even in the highest precision. The ray then misses the object.
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

    /// Returns the second crossing of the ray with the object, where the ray leaves it. The ray
    /// must hit the object. Returns `None` if rays hit the object only once.
    pub fn second(&self, r: &Direction<T>) -> Option<Crossing<T>> {
        self.extreme(self.firsts().len(), self.seconds(), r, Ordering::Greater)
    }

    /// Returns the crossing of the ray with one of the planes of `faces`: the plane with the least
    /// inverse depth, or with the greatest if `which` is `Greater`. `start` is the index of the
    /// first of `faces` among all faces. Returns `None` if there are no faces.
    ///
    /// If another plane's inverse depth cannot be distinguished from the result, within the error
    /// bounds of both, the crossing is assigned to an edge, not to a plane. The larger of the two
    /// error bounds is then the error bound of the crossing.
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
            // If an overflow has left NaN, the comparison is false, so the crossing is assigned to
            // an edge.
            let is_clear = distance > rad * (2.0 * UP);
            if !is_clear {
                // The crossing cannot be assigned to one plane: near an edge, the ray crosses two
                // planes at almost the same depth.
                extreme.part = SurfacePart::Edge;
                let is_number = distance >= T::Radius::ZERO;
                extreme.inverse_depth.rad = if is_number { rad } else { T::Radius::INFINITE };
            }
            extreme
        }))
    }
}

impl Convex<f64> {
    /// Computes how the object covers a rectangle. Returns `None` if no ray through the rectangle
    /// hits the object.
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

    /// Returns the range of the inverse depths at which rays from outside leave the object. Returns
    /// `None` if rays hit the object only once.
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
