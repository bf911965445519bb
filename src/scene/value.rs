//! Computes operators and functions on values.
//!
//! The functions here do not know where their operands stand in the text. They return a result, or
//! `None` if the types do not fit. The caller reports the problem with its span. Infinite and NaN
//! results are returned as they are; the caller reports them, too.

use glam::DVec3;

use crate::{
    color::Color,
    math::{Angle, trig},
    schema::Value,
    syntax::tree::Operator,
};

/// Returns `left OPERATOR right`, or `None` if the types do not go together.
pub fn operate(operator: Operator, left: Value, right: Value) -> Option<Value> {
    use Value::{Angle, Number, Vector};
    Some(match (operator, left, right) {
        (Operator::Add, Number(a), Number(b)) => Number(a + b),
        (Operator::Add, Angle(a), Angle(b)) => Angle(a + b),
        (Operator::Add, Vector(a), Vector(b)) => Vector(a + b),
        (Operator::Subtract, Number(a), Number(b)) => Number(a - b),
        (Operator::Subtract, Angle(a), Angle(b)) => Angle(a - b),
        (Operator::Subtract, Vector(a), Vector(b)) => Vector(a - b),
        (Operator::Multiply, Number(a), Number(b)) => Number(a * b),
        (Operator::Multiply, Number(a), Angle(b)) => Angle(b * a),
        (Operator::Multiply, Angle(a), Number(b)) => Angle(a * b),
        (Operator::Multiply, Number(a), Vector(b)) => Vector(a * b),
        (Operator::Multiply, Vector(a), Number(b)) => Vector(a * b),
        (Operator::Divide, Number(a), Number(b)) => Number(a / b),
        (Operator::Divide, Angle(a), Number(b)) => Angle(a / b),
        (Operator::Divide, Angle(a), Angle(b)) => Number(ratio(a, b)),
        // Each coordinate is divided by b, which causes one rounding error. Multiplying by 1/b
        // would cause two.
        (Operator::Divide, Vector(a), Number(b)) => Vector(DVec3::new(a.x / b, a.y / b, a.z / b)),
        _ => return None,
    })
}

/// Returns `-value`, or `None` if the type has no negatives.
pub fn negate(value: Value) -> Option<Value> {
    match value {
        Value::Number(number) => Some(Value::Number(-number)),
        Value::Angle(angle) => Some(Value::Angle(-angle)),
        Value::Vector(vector) => Some(Value::Vector(-vector)),
        Value::Color(_) | Value::Colors(_) | Value::FaceColors(_) | Value::Method(_) => None,
    }
}

/// Returns the quotient of two angles. If both angles are in degrees, or both in radians, their
/// numbers are divided without conversion, to avoid its rounding errors.
fn ratio(a: Angle, b: Angle) -> f64 {
    if a.radians == 0.0 && b.radians == 0.0 {
        return a.degrees / b.degrees;
    }
    if a.degrees == 0.0 && b.degrees == 0.0 {
        return a.radians / b.radians;
    }
    a.in_radians() / b.in_radians()
}

/// Returns the result of a function, or `None` if an argument has another type than the function
/// takes. Does not check that the channels of an `rgb` are between 0 and 255.
pub fn call(function: &str, arguments: &[Value]) -> Option<Value> {
    use Value::{Number, Vector};
    Some(match (function, arguments) {
        ("sin", &[Value::Angle(a)]) => Number(trig::sin(a)),
        ("cos", &[Value::Angle(a)]) => Number(trig::cos(a)),
        ("tan", &[Value::Angle(a)]) => Number(trig::tan(a)),
        ("asin", &[Number(x)]) => Value::Angle(trig::asin(x)),
        ("acos", &[Number(x)]) => Value::Angle(trig::acos(x)),
        ("atan", &[Number(x)]) => Value::Angle(trig::atan(x)),
        ("atan2", &[Number(y), Number(x)]) => Value::Angle(trig::atan2(y, x)),
        ("sqrt", &[Number(x)]) => Number(x.sqrt()),
        ("abs", &[Number(x)]) => Number(x.abs()),
        ("min", numbers) => Number(fold(numbers, f64::min)?),
        ("max", numbers) => Number(fold(numbers, f64::max)?),
        ("length", &[Vector(v)]) => Number(length(v)),
        ("dot", &[Vector(v), Vector(w)]) => Number(v.dot(w)),
        ("cross", &[Vector(v), Vector(w)]) => Vector(v.cross(w)),
        ("normalize", &[Vector(v)]) => Vector(normalize(v)),
        ("rgb", &[Number(r), Number(g), Number(b)]) => Value::Color(Color { srgb: [r, g, b] }),
        _ => return None,
    })
}

/// Returns the minimum or the maximum of all numbers; `choose` returns that of two numbers. Returns
/// `None` if there is no number or if a value is not a number.
fn fold(numbers: &[Value], choose: impl Fn(f64, f64) -> f64) -> Option<f64> {
    let mut chosen = None;
    for number in numbers {
        let &Value::Number(number) = number else {
            return None;
        };
        chosen = Some(chosen.map_or(number, |before| choose(before, number)));
    }
    chosen
}

/// Returns the length of a vector. The vector is scaled first, so that no square overflows or
/// underflows.
fn length(v: DVec3) -> f64 {
    let (scaled, scale) = to_unit_scale(v);
    scaled.dot(scaled).sqrt() * scale
}

/// Returns the unit vector in the direction of `v`; NaN for the zero vector.
fn normalize(v: DVec3) -> DVec3 {
    let (scaled, _) = to_unit_scale(v);
    let length = scaled.dot(scaled).sqrt();
    DVec3::new(scaled.x / length, scaled.y / length, scaled.z / length)
}

/// Scales a vector by a power of two so that its greatest absolute coordinate is in [1, 2). Returns
/// the scaled vector, and the factor that undoes the scaling. Only coordinates that are negligible
/// compared with the greatest are rounded.
fn to_unit_scale(v: DVec3) -> (DVec3, f64) {
    let greatest = v.abs().max_element();
    if greatest == 0.0 || !greatest.is_finite() {
        return (v, 1.0);
    }
    let (_, exponent) = libm::frexp(greatest);
    let exponent = exponent - 1;
    let scaled = |x: f64| libm::ldexp(x, -exponent);
    let vector = DVec3::new(scaled(v.x), scaled(v.y), scaled(v.z));
    (vector, libm::ldexp(1.0, exponent))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_neither_overflow_nor_vanish() {
        assert_eq!(length(DVec3::new(3.0, 4.0, 0.0)), 5.0);
        for exponent in [600, -600] {
            let unit = libm::ldexp(1.0, exponent);
            assert_eq!(length(DVec3::new(3.0, 4.0, 0.0) * unit), 5.0 * unit);
        }
        assert_eq!(length(DVec3::ZERO), 0.0);
        assert_eq!(length(DVec3::X * 5e-324), 5e-324);
        assert_eq!(normalize(DVec3::X * 5e-324), DVec3::X);
        assert!(normalize(DVec3::ZERO).is_nan());
    }
}
