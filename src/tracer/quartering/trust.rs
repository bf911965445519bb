//! Whether it is worth a look to see what is in the next area.

/// A look that leaves more than this share of its area to be traced one by one has gained too little to be worth the next: among many small objects
/// looks take about a tenth of what one by one takes. It is a choice; with 3/5 times are the same, with 7/8 crowds take up to 7 % longer than one by one.
const FRUITLESS: f64 = 0.5;

/// No more areas than this are left out after a look that gained nothing: what looks cost falls to a seventeenth then, and is no longer seen.
const MOST: u32 = 16;

/// What the last looks gained.
///
/// Areas come row by row, and where objects are crowded in one they mostly are in the next. After the k-th look in a row that gained nothing k areas
/// are traced one by one without one, up to [`MOST`]. So of n crowded areas about √2n are looked at, of more than a hundred every seventeenth, and no more areas are left
/// out behind them than looks were made.
#[derive(Debug, Default)]
pub struct Trust {
    fruitless: u32,
    rest: u32,
}

impl Trust {
    /// Whether it looks at the next area; goes on to the one after it.
    pub fn takes_a_look(&mut self) -> bool {
        let takes_it = self.rest == 0;
        self.rest = self.rest.saturating_sub(1);
        takes_it
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
            if trust.takes_a_look() {
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
        while !trust.takes_a_look() {}
        trust.learn(32, 64);
        assert!(trust.takes_a_look());
    }
}
