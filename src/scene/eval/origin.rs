//! Derives the unit of a number without one from its formula: a number that comes from `pi` counts
//! radians.
//!
//! In: the tree of a value, and the origins of the `let`s that it uses. Out: the unit that was
//! meant, as far as the formula tells.

use crate::{
    schema::predefined,
    syntax::tree::{self, Operator, Unit, ValueKind},
};

/// The unit of a number without one, as far as its formula tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnitOrigin {
    /// Unknown: the formula consists of numbers without `pi`.
    Plain,
    /// The number counts this unit.
    In(Unit),
    /// Parts of the formula speak for both units.
    Unclear,
}

use UnitOrigin::{In, Plain, Unclear};

/// The first digits of pi, of its multiples, and of pi / 180, as people write them.
const LIKE_PI: [&str; 5] = ["3.14", "6.28", "1.57", "0.0174", ".0174"];

impl UnitOrigin {
    /// Returns the origin of a value, given the origins of the names that it uses.
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
                        // `x * 180 / pi`
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

    /// Returns the origin of a sum.
    fn plus(self, other: Self) -> Self {
        match (self, other) {
            (Plain, it) | (it, Plain) => it,
            (a, b) if a == b => a,
            _ => Unclear,
        }
    }
}

/// Whether a factor is the number of degrees of a half or a whole turn.
fn is_half_turn(factor: &tree::Value<'_>) -> bool {
    matches!(factor.kind, ValueKind::Number("180" | "360"))
}
