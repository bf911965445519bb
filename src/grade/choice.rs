//! Which of the mistakes that explain a difference is named first, and which beside it.
//!
//! In: explanations, the simplest ones first. One that is less simple is better only if the picture says so: where the two pictures that
//! they make differ, the errors of the simpler one have to go towards the other. Of one object only the best is said.

use super::{LEFT, Make, Verdict, bias::Errors, evidence, extent::ball};
use crate::film::{Film, TooLarge};

/// Of several explanations, those that leave more than so many times what the best one leaves are not named: more than twice its squares.
pub const RIVAL: f64 = 1.5;

/// What rounding to bytes leaves of a picture of light colours, a step of which is 1/255 / √12: less is no difference between explanations.
pub const ROUNDING: f64 = 1e-3;

/// So many explanations are named at most.
const NAMED: usize = 3;

/// Errors that add up beyond so many deviations decide between two explanations: exp(−4.5), by chance once in 90 choices. It is a choice
/// between what is true nearly, not whether something is wrong at all, which takes more.
pub const DOUBT: f64 = 3.0;

/// A mistake that explains a difference.
pub struct Explanation {
    pub verdict: Verdict,
    pub make: Make,
    /// The picture that it makes.
    pub made: Film,
}

impl Explanation {
    fn left(&self) -> f64 {
        self.verdict.rmse.unwrap_or(0.0)
    }

    /// Whether a picture says that this is better than another one.
    fn is_better_than(&self, other: &Self, a: &Film) -> Result<bool, TooLarge> {
        if self.left() >= other.left() {
            return Ok(false);
        }
        let errors = Errors::new(a, &other.made)?;
        let sum = errors.towards(&other.made, &self.made, None);
        Ok(sum.sigmas > DOUBT || evidence::is_enough(a, &other.made, &self.made))
    }

    /// Whether both are about the same thing, of which the better one says enough: they change the same object, or are the same mistake of
    /// other numbers, as of two coordinates of the eye.
    fn is_of_same(&self, other: &Self) -> bool {
        if let (Make::Scene(_), Make::Scene(_)) = (&self.make, &other.make)
            && self.verdict.mistake == other.verdict.mistake
        {
            return true;
        }
        let object = |make: &Make| match make {
            Make::Object(_, shapes) => shapes[0].and_then(|shape| ball(&shape)),
            _ => None,
        };
        let own = object(&self.make);
        own.is_some() && own == object(&other.make)
    }
}

/// The best of some explanations of a picture, best first.
pub fn best(
    mut found: Vec<Explanation>,
    a: &Film,
    difference: f64,
) -> Result<Vec<Explanation>, TooLarge> {
    let Some(least) = found.iter().map(Explanation::left).reduce(f64::min) else {
        return Ok(found);
    };
    found.retain(|one| one.left() <= RIVAL * least.max(ROUNDING));
    // What the best one leaves may be noise, beside which the difference that a mistake makes is small.
    let rest = |left: f64| left * left - least * least;
    found.retain(|one| {
        let own = one.left();
        own <= ROUNDING || rest(own) <= LEFT * LEFT * rest(difference)
    });
    let mut first = 0;
    for other in 1..found.len() {
        if found[other].is_better_than(&found[first], a)? {
            first = other;
        }
    }
    let first = found.remove(first);
    let mut named = vec![first];
    for one in found {
        let is_said = named.iter().any(|other| one.is_of_same(other));
        if named.len() < NAMED && !is_said && !named[0].is_better_than(&one, a)? {
            named.push(one);
        }
    }
    Ok(named)
}
