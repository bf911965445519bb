//! Whether it is worth a look to see what is in the next area.

/// A look that leaves more than this share of its area to be traced one by one has gained nothing.
const FRUITLESS: f64 = 0.875;

/// After so many looks in a row that gained nothing as many areas are left out.
const MOST: u32 = 16;

/// What the last looks gained.
///
/// Areas come row by row, and where objects are crowded in one they mostly are in the next. After the k-th look in a row that gained nothing k areas
/// are traced one by one without one. So of n crowded areas about √2n are looked at, and not many more than those are left out after them.
#[derive(Debug, Default)]
pub struct Trust {
    fruitless: u32,
    rest: u32,
}

impl Trust {
    /// Whether to look at the next area.
    pub fn is_worth_a_look(&mut self) -> bool {
        let is_worth = self.rest == 0;
        self.rest = self.rest.saturating_sub(1);
        is_worth
    }

    /// Takes into account that of so many pixels of an area so many were left to be traced one by one.
    pub fn learn(&mut self, plain: u64, pixels: u64) {
        self.fruitless = match plain as f64 > FRUITLESS * pixels as f64 {
            true => (self.fruitless + 1).min(MOST),
            false => 0,
        };
        self.rest = self.fruitless;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How many of so many areas are looked at, if none gains anything.
    fn looks(trust: &mut Trust, areas: usize) -> usize {
        let mut looks = 0;
        for _ in 0..areas {
            if trust.is_worth_a_look() {
                trust.learn(64, 64);
                looks += 1;
            }
        }
        looks
    }

    #[test]
    fn few_of_many_crowded_areas_are_looked_at() {
        // The k-th look is at area 1 + 2 + … + k, up to the sixteenth; from there on it is every seventeenth.
        assert_eq!(looks(&mut Trust::default(), 3), 2);
        assert_eq!(looks(&mut Trust::default(), 136), 16);
        assert_eq!(looks(&mut Trust::default(), 136 + 17 * 100), 116);
    }

    #[test]
    fn a_look_that_gains_something_is_followed_by_the_next() {
        let mut trust = Trust::default();
        looks(&mut trust, 136);
        while !trust.is_worth_a_look() {}
        trust.learn(56, 64);
        assert!(trust.is_worth_a_look());
    }
}
