//! The box: three slabs, each the space between two parallel faces.
//!
//! In: the box's corners and the camera. Out: the forms of its faces' inverse depths; for a ray, where it enters and where it leaves. The method
//! is Kay and Kajiya's slabs ("Ray tracing complex scenes", 1986) in inverse depths: with μ = 1/λ a point λr lies between the planes x = lo and
//! x = hi (as seen from the eye) where lo·μ ≤ r_x ≤ hi·μ. On which side of its two planes the eye lies makes of these a greatest and a least μ,
//! each a linear form: no division by r_x, which may be zero. Errors: each form's own bound.

use std::cmp::Ordering;

use super::{
    camera::{Camera, Direction, Window},
    crossing::{Crossing, SurfacePart},
    form::{Form, axis_vector, inverse_depth},
    interval::{Cover, Patch, Range},
};
use crate::{
    math::{Ball3, Double, Doubt, Radius, Real, UP},
    scene,
};

/// A box prepared for one picture.
#[derive(Clone, Debug)]
pub struct Cuboid<T: Real> {
    /// Inverse depths of the planes that the eye looks at from outside: a ray is in the box from the least of them on.
    fronts: Vec<Face<T>>,
    /// Inverse depths of the planes that rays leave through: up to the greatest of them.
    backs: Vec<Face<T>>,
    /// Where the eye lies in a face's plane, that face is seen edge-on and bounds nothing, but a ray must not be on the
    /// outside of it: each of these is ≥ 0.
    inward: Vec<Form<T>>,
}

/// The plane of a face.
#[derive(Clone, Debug)]
struct Face<T: Real> {
    inverse_depth: Form<T>,
    /// Twice the axis, and one more for the greater coordinate.
    index: u8,
}

impl<T: Real> Cuboid<T> {
    /// Prepares a box.
    pub fn new(camera: &Camera<T>, shape: &scene::Cuboid) -> Self {
        let scene::Cuboid { min, max, .. } = *shape;
        let mut cuboid = Self {
            fronts: Vec::new(),
            backs: Vec::new(),
            inward: Vec::new(),
        };
        for axis in 0..3 {
            let eye = camera.eye[axis];
            let normal = axis_vector::<T>(axis);
            let face = |upper: bool| Face {
                inverse_depth: {
                    let at = if upper { max[axis] } else { min[axis] };
                    inverse_depth(camera, &normal, &camera.relative_coordinate(axis, at))
                },
                index: 2 * axis as u8 + u8::from(upper),
            };
            let inward = |sign: f64| {
                let normal = axis_vector::<T>(axis).map(|x| x.times_power(sign));
                Form::new(camera, &camera.turned(&normal))
            };
            match (eye.partial_cmp(&min[axis]), eye.partial_cmp(&max[axis])) {
                (Some(Ordering::Less), _) => {
                    cuboid.fronts.push(face(false));
                    cuboid.backs.push(face(true));
                }
                (_, Some(Ordering::Greater)) => {
                    cuboid.fronts.push(face(true));
                    cuboid.backs.push(face(false));
                }
                (Some(Ordering::Equal), _) => {
                    cuboid.inward.push(inward(1.0));
                    cuboid.backs.push(face(true));
                }
                (_, Some(Ordering::Equal)) => {
                    cuboid.inward.push(inward(-1.0));
                    cuboid.backs.push(face(false));
                }
                _ => {
                    cuboid.backs.push(face(false));
                    cuboid.backs.push(face(true));
                }
            }
        }
        cuboid
    }

    /// The nearest crossing in front of the eye: where the ray enters the closed box or, from inside, leaves it.
    #[inline]
    pub fn first(&self, r: &Direction<T>) -> Result<Option<Crossing<T>>, Doubt> {
        let leave = extreme(&self.backs, r, Ordering::Greater);
        let enter = extreme(&self.fronts, r, Ordering::Less);
        let mut doubt = false;
        if let (Some(enter), Some(leave)) = (&enter, &leave) {
            match leave.inverse_depth.compare(&enter.inverse_depth) {
                Ok(Ordering::Greater) => return Ok(None),
                Ok(_) => {}
                Err(Doubt) => doubt = true,
            }
            match enter.inverse_depth.sign() {
                Ok(Ordering::Greater) => {}
                Ok(_) => return Ok(None),
                Err(Doubt) => doubt = true,
            }
        }
        for form in &self.inward {
            match form.at(r).sign() {
                Ok(Ordering::Less) => return Ok(None),
                Ok(_) => {}
                Err(Doubt) => doubt = true,
            }
        }
        if doubt {
            return Err(Doubt);
        }
        match enter {
            Some(enter) => Ok(Some(enter)),
            None => behind_eye(leave),
        }
    }

    /// The crossing behind the first one.
    pub fn second(&self, r: &Direction<T>) -> Option<Crossing<T>> {
        if self.fronts.is_empty() {
            return None;
        }
        extreme(&self.backs, r, Ordering::Greater)
    }

    /// The form of the face with an index, if the eye sees it from either side.
    pub fn face(&self, index: u8) -> Option<&Form<T>> {
        let mut faces = self.fronts.iter().chain(&self.backs);
        let face = faces.find(|face| face.index == index)?;
        Some(&face.inverse_depth)
    }
}

/// Its eight corners.
pub fn corners<T: Real>(camera: &Camera<T>, shape: &scene::Cuboid) -> [Ball3<T>; 8] {
    let (min, max) = (camera.relative(shape.min), camera.relative(shape.max));
    std::array::from_fn(|corner| {
        camera.turned(&[0, 1, 2].map(|axis| {
            let side = if corner >> axis & 1 == 0 { &min } else { &max };
            side[axis].clone()
        }))
    })
}

/// From inside, a ray along a face's plane may leave at no finite depth only by rounding.
fn behind_eye<T: Real>(leave: Option<Crossing<T>>) -> Result<Option<Crossing<T>>, Doubt> {
    let Some(leave) = leave else { return Ok(None) };
    match leave.inverse_depth.sign()? {
        Ordering::Greater => Ok(Some(leave)),
        _ => Ok(None),
    }
}

impl<T: Real> Cuboid<T> {
    /// Forms that are all ≥ 0 where rays meet the box, and one of them 0 at its outline.
    pub fn sides(&self) -> impl Iterator<Item = Form<T>> {
        let pairs = self.fronts.iter().flat_map(move |front| {
            self.backs
                .iter()
                // Between two parallel faces a ray always is for a while.
                .filter(move |back| back.index / 2 != front.index / 2)
                .map(move |back| front.inverse_depth.minus(&back.inverse_depth))
        });
        let fronts = self.fronts.iter().map(|front| front.inverse_depth.clone());
        pairs.chain(fronts).chain(self.inward.iter().cloned())
    }

    /// The inverse depths of the faces where rays meet the box first.
    pub fn firsts(&self) -> impl Iterator<Item = &Form<T>> {
        self.first_faces().iter().map(|face| &face.inverse_depth)
    }

    /// The index of one of these faces.
    pub fn first_index(&self, at: usize) -> u8 {
        self.first_faces()[at].index
    }

    fn first_faces(&self) -> &[Face<T>] {
        match self.fronts.is_empty() {
            true => &self.backs,
            false => &self.fronts,
        }
    }

    /// The inverse depths of the faces where rays from outside leave it.
    pub fn seconds(&self) -> impl Iterator<Item = &Form<T>> {
        let faces: &[_] = if self.fronts.is_empty() {
            &[]
        } else {
            &self.backs
        };
        faces.iter().map(|face| &face.inverse_depth)
    }
}

impl Cuboid<f64> {
    /// How it stands to a rectangle; `None` if no ray through it meets the box.
    pub fn cover(&self, patch: &Patch) -> Option<Cover> {
        let mut is_whole = true;
        for side in self.sides() {
            let range = side.over(patch);
            if range.high < 0.0 {
                return None;
            }
            is_whole &= range.low > 0.0;
        }
        let firsts = self.firsts().map(|face| face.over(patch));
        let which = if self.fronts.is_empty() {
            f64::max
        } else {
            f64::min
        };
        Some(Cover {
            is_whole,
            inverse_depth: Range::fold(firsts, which)?,
        })
    }

    /// The inverse depths where rays leave it that enter it.
    pub fn behind(&self, patch: &Patch) -> Option<Range> {
        Range::fold(self.seconds().map(|face| face.over(patch)), f64::max)
    }
}

impl Cuboid<Double> {
    /// The same box for `f64`.
    pub fn narrowed(&self, window: &Window<f64>) -> Cuboid<f64> {
        let narrow = |faces: &[Face<Double>]| {
            let face = |face: &Face<Double>| Face {
                inverse_depth: face.inverse_depth.narrowed(window),
                index: face.index,
            };
            faces.iter().map(face).collect()
        };
        Cuboid {
            fronts: narrow(&self.fronts),
            backs: narrow(&self.backs),
            inward: self.inward.iter().map(|f| f.narrowed(window)).collect(),
        }
    }
}

/// The least or the greatest inverse depth of some faces. Where two are not clearly apart, the middle of the least ball need not be the least
/// number, but it is within the greatest radius of it. In whose plane the crossing lies is said only where it is certain: just outside of an
/// edge, a ray meets the one plane a little before it meets the box in the other.
#[inline]
fn extreme<T: Real>(faces: &[Face<T>], r: &Direction<T>, which: Ordering) -> Option<Crossing<T>> {
    let mut extreme: Option<Crossing<T>> = None;
    for face in faces {
        let inverse_depth = face.inverse_depth.at(r);
        let part = SurfacePart::Plane(face.index);
        match &mut extreme {
            None => {
                extreme = Some(Crossing {
                    inverse_depth,
                    part,
                });
            }
            Some(so_far) => {
                let rad = so_far.inverse_depth.rad.max(inverse_depth.rad);
                let difference = inverse_depth.mid.minus(&so_far.inverse_depth.mid);
                // NaN, from an overflow, is not clear either.
                let is_clear = difference.magnitude() > rad * (2.0 * UP);
                if !difference.is_zero() && difference.is_negative() == which.is_lt() {
                    *so_far = Crossing {
                        inverse_depth,
                        part,
                    };
                }
                if !is_clear {
                    so_far.part = SurfacePart::Edge;
                    so_far.inverse_depth.rad = match difference.magnitude() >= T::Radius::ZERO {
                        true => rad,
                        false => T::Radius::INFINITE,
                    };
                }
            }
        }
    }
    extreme
}
