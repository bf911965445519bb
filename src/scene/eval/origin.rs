//! Determines the unit of a number that is written without a unit where an angle is required. A
//! number derived from `pi`, for example, is probably in radians.
//!
//! In: the tree of a value, and the [`UnitOrigin`]s of the names that it uses. Out: the
//! [`UnitOrigin`] of the value, which follows from its formula.

use crate::{
    schema::predefined,
    syntax::tree::{self, Operator, Unit, ValueKind},
};

/// Unit in which the author of an expression probably means a number that has no unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnitOrigin {
    /// Unknown: the formula consists of numbers without a unit and without `pi`.
    Plain,
    /// The number is meant in this unit.
    In(Unit),
    /// Uncertain: parts of the formula suggest different units.
    Unclear,
}

use UnitOrigin::{In, Plain, Unclear};

/// First digits of pi, 2 pi, pi/2 and pi/180, as people write them. A number that starts with one
/// of these texts suggests radians.
const LIKE_PI: [&str; 5] = ["3.14", "6.28", "1.57", "0.0174", ".0174"];

impl UnitOrigin {
    /// Returns the unit in which the numbers of a value are meant. `known` returns this unit for a
    /// name that the value uses, or `None` if the name is undefined.
    pub fn of(value: &tree::Value<'_>, known: &impl Fn(&str) -> Option<Self>) -> Self {
        let all = || {
            let parts = value.parts().into_iter();
            parts.fold(Plain, |sum, part| sum.plus(Self::of(part, known)))
        };
        match &value.kind {
            ValueKind::Number(text) if LIKE_PI.iter().any(|digits| text.starts_with(digits)) => {
                In(Unit::Radians)
            }
            ValueKind::Name("pi") => In(Unit::Radians),
            ValueKind::Name(name) => match known(name) {
                Some(origin) => origin,
                None if predefined(name).is_some() => Plain,
                None => Unclear,
            },
            ValueKind::Call(call) => match (call.function.text, all()) {
                ("sin" | "cos" | "tan", _) => Plain,
                ("sqrt", In(_)) => Unclear,
                (_, all) => all,
            },
            ValueKind::Chain { first, rest }
                if rest.iter().all(|it| it.operator.is_of_product()) =>
            {
                let first = (Self::of(first, known), is_half_turn(first));
                let product = rest.iter().fold(first, |(left, by_turn), step| {
                    let (operand, right) = (&step.operand, Self::of(&step.operand, known));
                    let unit = match &operand.kind {
                        ValueKind::Angle { unit, .. } => Some(*unit),
                        ValueKind::Name("deg") => Some(Unit::Degrees),
                        ValueKind::Name("rad") => Some(Unit::Radians),
                        _ => None,
                    };
                    let by_turn = by_turn || is_half_turn(operand);
                    let product = match (left, step.operator, right, unit) {
                        (_, Operator::Divide, _, Some(unit)) => In(unit),
                        // The product `x * 180 / pi` converts radians to degrees, so it is in
                        // degrees.
                        (Plain | In(Unit::Radians), Operator::Divide, In(Unit::Radians), _)
                            if by_turn =>
                        {
                            In(Unit::Degrees)
                        }
                        (left, _, Plain, _) => left,
                        (Plain, Operator::Multiply, right, _) => right,
                        _ => Unclear,
                    };
                    (product, by_turn)
                });
                product.0
            }
            _ => all(),
        }
    }

    /// Returns the unit in which a sum is meant. `self` and `other` are the units of its terms.
    fn plus(self, other: Self) -> Self {
        match (self, other) {
            (Plain, it) | (it, Plain) => it,
            (a, b) if a == b => a,
            _ => Unclear,
        }
    }
}

/// Returns whether a factor is 180 or 360, the degrees of a half or a whole turn.
fn is_half_turn(factor: &tree::Value<'_>) -> bool {
    matches!(factor.kind, ValueKind::Number("180" | "360"))
}
