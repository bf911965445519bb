//! Which of very many waves are nearly in step from line to line.
//!
//! The angle nα of wave n is within h of whole turns at n = 0, and from any wave where it is so again after a, b or a + b: the first
//! numbers of waves after which it has gone up, or down, by less than that window's 2h (the theorem of three gaps, Slater 1967). They are
//! found as Euclid finds a common divisor, by taking the shorter step off the longer one. Angles are whole numbers of
//! 2^−128 turns, so that nothing is rounded. Only odd waves are wanted.

use crate::math::Double;

/// No wave is of a higher number.
const LAST: u64 = 1 << 52;
/// Where the angles all but repeat, only even waves may be in step for very long.
const PATIENCE: u32 = 1 << 22;

/// The odd waves that are in step, in order.
pub(super) struct Resonances {
    angle: u128,
    /// The wave at hand, and its angle.
    wave: u64,
    place: u128,
    window: Window,
    /// What the window is to be from the first wave on that is in there.
    narrower: Option<Window>,
    /// How many even waves may still be passed.
    patience: u32,
}

/// What is in step: an angle of less than `half` either way; and what leads from one wave there to the next.
#[derive(Clone, Copy)]
struct Window {
    half: u128,
    up: Step,
    down: Step,
}

/// A step of so many waves, and by what it changes the angle.
#[derive(Clone, Copy)]
struct Step {
    waves: u64,
    angle: u128,
}

impl Resonances {
    /// Of waves each of which turns by so many half turns, at most 1, more than the one before: from wave 0 on those within so many half
    /// turns of a whole turn.
    pub(super) fn new(half_turns: &Double, within: f64) -> Self {
        let fixed = |x: f64| ((x * (1u128 << 126) as f64) as i128 as u128) << 1;
        let angle = fixed(half_turns.hi).wrapping_add(fixed(half_turns.lo));
        Self {
            angle,
            wave: 0,
            place: 0,
            window: Window::new(angle, within),
            narrower: None,
            patience: PATIENCE,
        }
    }

    /// Up to which wave none was left out.
    pub(super) fn reached(&self) -> f64 {
        match self.patience {
            0 => self.wave as f64,
            _ => f64::INFINITY,
        }
    }

    /// Only those within so many half turns, which must be no more than before; from the first one on that is.
    pub(super) fn narrow(&mut self, within: f64) {
        self.narrower = Some(Window::new(self.angle, within));
    }
}

impl Iterator for Resonances {
    type Item = u64;

    fn next(&mut self) -> Option<u64> {
        loop {
            let step = match self.wave % 2 {
                0 => self.window.past_even(self.place)?,
                _ => self.window.step(self.place),
            };
            self.wave += step.waves;
            self.place = self.place.wrapping_add(step.angle);
            if self.wave >= LAST {
                self.wave = LAST;
                return None;
            }
            if let Some(window) = self.narrower.filter(|window| window.holds(self.place)) {
                (self.window, self.narrower) = (window, None);
            }
            if self.wave % 2 == 1 {
                return Some(self.wave);
            }
            self.patience = self.patience.checked_sub(1)?;
        }
    }
}

impl Window {
    fn new(angle: u128, half_turns: f64) -> Self {
        let half = (half_turns.clamp(0.0, 0.5) * (1u128 << 127) as f64) as u128;
        let half = half.max(1);
        let whole = 2 * half;
        let step = |angle| Step { waves: 1, angle };
        let (mut up, mut down) = (step(angle), step(angle.wrapping_neg()));
        while up.angle.max(down.angle) >= whole && up.waves.max(down.waves) < LAST {
            let (long, short) = match up.angle >= down.angle {
                true => (&mut up, &down),
                false => (&mut down, &up),
            };
            if short.angle == 0 {
                // All that are in step come back to the same angle, and the other way never does.
                long.waves = LAST;
                break;
            }
            // As often as it goes, but not further than into the window.
            let often = (long.angle / short.angle).min((long.angle - whole) / short.angle + 1);
            long.angle -= often * short.angle;
            let waves = u64::try_from(often).unwrap_or(LAST);
            long.waves += waves.saturating_mul(short.waves).min(LAST);
        }
        Self { half, up, down }
    }

    /// Whether an angle is within it.
    fn holds(&self, place: u128) -> bool {
        place.wrapping_add(self.half) < 2 * self.half
    }

    /// From the angle of an even wave within it to the next one, or as far as only even ones come; `None` if there are no odd ones.
    fn past_even(&self, place: u128) -> Option<Step> {
        let is_even = |step: &Step| step.waves.is_multiple_of(2);
        if is_even(&self.up) && is_even(&self.down) {
            return None;
        }
        let step = self.step(place);
        let shorter = self.up.waves.min(self.down.waves);
        if step.waves != shorter || !is_even(&step) {
            return Some(step);
        }
        // As often as it stays within: the shorter of both is taken wherever it does.
        let above = place.wrapping_add(self.half);
        let often = match step.angle == self.up.angle {
            true => (2 * self.half - 1 - above).checked_div(self.up.angle)?,
            false => above.checked_div(self.down.angle)?,
        };
        let often = often.clamp(1, LAST.into());
        let waves = u64::try_from(often)
            .unwrap_or(LAST)
            .saturating_mul(step.waves);
        Some(Step {
            waves: waves.min(LAST),
            angle: step.angle.wrapping_mul(often),
        })
    }

    /// From an angle within it to the next one.
    fn step(&self, place: u128) -> Step {
        let Step { waves, angle } = self.down;
        let down = Step {
            waves,
            angle: angle.wrapping_neg(),
        };
        let leads_back = |step: &Step| self.holds(place.wrapping_add(step.angle));
        let both = Step {
            waves: self.up.waves + down.waves,
            angle: self.up.angle.wrapping_add(down.angle),
        };
        [self.up, down]
            .into_iter()
            .filter(leads_back)
            .min_by_key(|step| step.waves)
            .unwrap_or(both)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Real;
    use proptest::prelude::*;

    /// The same by asking every odd wave.
    fn by_trial(half_turns: f64, within: f64, most: u32) -> Vec<u64> {
        (1..most)
            .step_by(2)
            .map(f64::from)
            .filter(|n| {
                let angle = n * half_turns;
                (angle - 2.0 * (0.5 * angle).round_ties_even()).abs() < within
            })
            .map(|n| n as u64)
            .collect()
    }

    proptest! {
        #[test]
        fn they_are_those_in_step(
            // So many digits that products with the waves are exact.
            fraction in -(1i32 << 30)..(1i32 << 30),
            within in 0.0005..0.5f64,
            coarse in 0u32..31,
        ) {
            let fraction = f64::from(fraction >> coarse << coarse) / f64::from(1 << 30);
            let most = 20_000;
            let found: Vec<u64> = Resonances::new(&Double::from_f64(fraction), within)
                .take_while(|&n| n < u64::from(most))
                .collect();
            // A window holds its lower end, which is next to never met.
            prop_assert_eq!(found, by_trial(fraction, within, most));
        }

        #[test]
        fn a_narrower_window_leaves_some_out(fraction in -1.0..1.0f64) {
            let mut waves = Resonances::new(&Double::from_f64(fraction), 0.5);
            let first: Vec<u64> = waves.by_ref().take(50).collect();
            waves.narrow(0.01);
            let from = first[49];
            let mut all = by_trial(fraction, 0.01, 50_000);
            all.retain(|&n| n > from);
            let first = all.first().copied().unwrap_or(50_000);
            let found: Vec<u64> = waves.skip_while(|&n| n < first).take_while(|&n| n < 50_000).collect();
            prop_assert_eq!(found, all);
        }
    }

    #[test]
    fn waves_that_do_not_turn_are_all_in_step() {
        let still = Resonances::new(&Double::from_f64(0.0), 1e-9);
        assert!(still.take(3).eq([1, 3, 5]));
        // Half a turn each: every even one.
        assert_eq!(Resonances::new(&Double::from_f64(1.0), 1e-9).next(), None);
        // Next to half a turn: even ones for very long.
        let turning = Resonances::new(&Double::from_f64(1.0 - 1e-9), 1e-3).next();
        assert!(
            turning.is_some_and(|wave| (wave as f64 - 0.999e9).abs() < 200.0),
            "{turning:?}"
        );
        // Every fourth is in step, always an even one, as far as one can tell.
        let mut quarters = Resonances::new(&Double::from_f64(0.5), 0.2);
        assert_eq!(quarters.next(), None);
        assert!(quarters.reached() > 2e5);
        let slowly = Resonances::new(&Double::from_f64(1e-30), 0.4);
        assert!(slowly.take(3).eq([1, 3, 5]));
    }
}
