//! Ray tracer of a textbook: what a ray hits, and the colour that is seen there.

use glam::DVec3;

use super::textbook::{Behind, Object, Program, Roots, Shape, Squares, Visible};

impl Program {
    /// Returns the colour of the surface that a ray sees, and the factor by which shading
    /// multiplies the colour's light. The ray starts at `from`; `view` is the view direction.
    pub fn trace(&self, from: DVec3, ray: DVec3, view: DVec3) -> ([u8; 3], f64) {
        // The parameter t of a hit is negative if the hit is behind the eye. With `Behind::First`,
        // the hit with the least t comes first, and otherwise the hit with the least |t|. With
        // `Behind::ByDistance`, this may be a hit behind the eye. Both variants are mistakes.
        let order = |t: f64| {
            if self.behind == Behind::First {
                t
            } else {
                t.abs()
            }
        };
        let counts = |t: &f64| {
            let along = if self.clips_distances {
                1.0
            } else {
                ray.dot(view)
            };
            let depth = t.abs() * along;
            let is_before = self.behind != Behind::Unseen || *t > 1e-9;
            is_before && depth > self.near && depth < self.far
        };
        let mut seen: Option<(f64, &Object)> = None;
        for object in &self.objects {
            let hits = self.hits(&object.shape, from, ray).into_iter().flatten();
            let first = hits
                .filter(counts)
                .min_by(|a, b| order(*a).total_cmp(&order(*b)));
            let Some(t) = first else {
                continue;
            };
            let is_seen = seen.is_none_or(|(other, _)| match self.visible {
                Visible::Nearest => order(t) < order(other),
                Visible::First => false,
                Visible::Last => true,
                Visible::Farthest => t > other,
            });
            if is_seen {
                seen = Some((t, object));
            }
        }
        seen.map_or((self.background, 1.0), |(t, object)| {
            let at = from + t * ray;
            let normal = object.shape.normal(at);
            let normal = -normal.dot(ray).signum() * normal;
            let light = (self.shade)(normal, ray.normalize());
            (self.color(object, at), light)
        })
    }

    fn color(&self, object: &Object, at: DVec3) -> [u8; 3] {
        let (square, second) = match (&object.shape, self.faces) {
            (Shape::Board(_, square, second), _) => (*square, *second),
            (Shape::Box(least, greatest), Some(faces)) => {
                let off = (at - least).abs().min((at - greatest).abs());
                return faces[off.min_position()];
            }
            _ => return object.color,
        };
        let number = |x: f64| match self.squares {
            Squares::Truncated => (x / square) as i64,
            Squares::Rounded => (x / square).round() as i64,
            _ => (x / square).floor() as i64,
        };
        let moved = if self.squares == Squares::Moved {
            square / 2.0
        } else {
            0.0
        };
        let (x, z) = (at.x, if self.is_upright { at.y } else { at.z });
        let (i, k) = match self.squares {
            Squares::Turned => (
                number((x + z) / 2_f64.sqrt()),
                number((x - z) / 2_f64.sqrt()),
            ),
            Squares::TruncatedX => ((x / square) as i64, number(z)),
            Squares::MovedZ => (number(x), number(z + square / 2.0)),
            _ => (number(x + moved), number(z) + self.parity),
        };
        let is_second = match self.squares {
            Squares::Sum => ((at.x + at.z) / square).floor() as i64 % 2 != 0,
            Squares::BothEven => i % 2 != 0 || k % 2 != 0,
            Squares::Stripes => i % 2 != 0,
            Squares::StripesZ => k % 2 != 0,
            Squares::Sines => libm::sin(at.x / square) * libm::sin(at.z / square) < 0.0,
            Squares::Remainder => (i + k) % 2 == 1,
            Squares::Remainders => i % 2 != k % 2,
            _ => (i + k) % 2 != 0,
        };
        if is_second { second } else { object.color }
    }

    /// Returns the parameters t of the points eye + t·ray at which a ray hits a shape.
    fn hits(&self, shape: &Shape, eye: DVec3, ray: DVec3) -> [Option<f64>; 2] {
        match *shape {
            Shape::Sphere(center, radius) => {
                let from = eye - center;
                let (b, c) = (from.dot(ray), from.length_squared() - radius * radius);
                let a = match self.roots {
                    Roots::TimesA => ray.length_squared(),
                    _ => 1.0,
                };
                let root = (b * b - a * c).sqrt();
                let greater = Some(a * (root - b)).filter(|_| self.roots != Roots::Lesser);
                let lesser = Some(a * (-b - root)).filter(|_| self.roots != Roots::Greater);
                [greater, lesser].map(|t| t.filter(|t| !t.is_nan()))
            }
            Shape::Triangle([a, b, c]) => {
                let (ab, ac) = (b - a, c - a);
                let normal = ab.cross(ac);
                let t = (a - eye).dot(normal) / ray.dot(normal);
                let at = eye + t * ray - a;
                let area = normal.length_squared();
                let beta = at.cross(ac).dot(normal) / area;
                let gamma = ab.cross(at).dot(normal) / area;
                let is_within = if self.is_parallelogram {
                    beta <= 1.0 && gamma <= 1.0
                } else {
                    beta + gamma <= 1.0
                };
                let is_in = beta >= 0.0 && (gamma >= 0.0 || self.misses_edge) && is_within;
                [Some(t).filter(|_| is_in), None]
            }
            Shape::Box(least, greatest) => {
                let far = if self.misses_axis {
                    1e9 * DVec3::Z
                } else {
                    DVec3::ZERO
                };
                let (a, b) = ((least - far - eye) / ray, (greatest + far - eye) / ray);
                let (enter, leave) = (a.min(b).max_element(), a.max(b).min_element());
                [leave, enter].map(|t| Some(t).filter(|_| enter <= leave))
            }
            Shape::Board(y, ..) => {
                let axis = if self.is_upright { 2 } else { 1 };
                let t = (y - eye[axis]) / ray[axis];
                let at = eye + t * ray;
                let is_within = at.x.abs().max(at.z.abs()) < self.reach;
                [Some(t).filter(|t| t.is_finite() && is_within), None]
            }
        }
    }
}

impl Shape {
    /// Returns a unit normal at a point of the shape's surface. It may point to either side.
    fn normal(&self, at: DVec3) -> DVec3 {
        match *self {
            Shape::Sphere(center, _) => (at - center).normalize(),
            Shape::Triangle([a, b, c]) => (b - a).cross(c - a).normalize(),
            Shape::Box(least, greatest) => {
                let off = (at - least).abs().min((at - greatest).abs());
                DVec3::AXES[off.min_position()]
            }
            Shape::Board(..) => DVec3::Y,
        }
    }
}
