//! Logarithmic axes: their ends, and where numbers stand.

/// An axis: its ends, and where numbers stand.
pub struct Ticks {
    pub ends: (f64, f64),
    /// Where numbers stand.
    pub major: Vec<f64>,
    /// Where lines are drawn besides.
    pub minor: Vec<f64>,
}

impl Ticks {
    /// An axis for these values, with numbers at 1, 2 and 5 times powers of ten, or at the powers alone where those are many.
    pub fn round(values: impl Iterator<Item = f64>) -> Self {
        let (low, high) = ends(values);
        // Nothing to show: any axis will do.
        let (low, high) = if low <= high { (low, high) } else { (0.1, 1.0) };
        let ends = (low / 1.5, high * 1.5);
        let decades = libm::log10(ends.1 / ends.0);
        let steps: &[f64] = match decades > 3.5 {
            true => &[1.0],
            false => &[1.0, 2.0, 5.0],
        };
        let first = libm::floor(libm::log10(ends.0)) as i32;
        let last = libm::ceil(libm::log10(ends.1)) as i32;
        let within = |steps: &[f64]| -> Vec<f64> {
            (first..=last)
                .flat_map(|power| {
                    steps
                        .iter()
                        .map(move |step| step * libm::exp10(f64::from(power)))
                })
                .filter(|tick| (ends.0..=ends.1).contains(tick))
                .collect()
        };
        Self {
            ends,
            major: within(steps),
            minor: within(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]),
        }
    }

    /// An axis with numbers at these values, which rise, and that goes at least to some value: beyond the last of them numbers stand as far
    /// apart as the last two do.
    pub fn at(values: &[f64], most: f64) -> Self {
        let (low, high) = ends(values.iter().copied());
        let end = high.max(most) * 1.25;
        let mut major = values.to_vec();
        if let [.., before, last] = values
            && last / before >= 1.5
        {
            let next = |value: &f64| Some(value * last / before).filter(|&next| next <= end);
            major.extend(std::iter::successors(next(last), next).map(f64::round));
        }
        Self {
            ends: (low / 1.25, end),
            major,
            minor: Vec::new(),
        }
    }
}

/// The least and the greatest of positive values.
pub fn ends(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, 0.0), |(low, high), value| {
        (value.min(low), value.max(high))
    })
}

/// The number of a tick: one digit, and zeros.
pub fn tick(value: f64) -> String {
    match (1e-4..1e6).contains(&value) {
        // The shortest way to write it, without what the powers of ten were rounded by.
        true => format!("{}", (value * 1e9).round() / 1e9),
        false => format!("{value:.0e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_go_on_beyond_those_that_were_planned() {
        assert_eq!(
            Ticks::at(&[1.0, 4.0, 16.0], 500.0).major,
            [1.0, 4.0, 16.0, 64.0, 256.0]
        );
        assert_eq!(Ticks::at(&[1.0, 4.0, 16.0], 9.0).major, [1.0, 4.0, 16.0]);
        assert_eq!(Ticks::at(&[8.0], 9.0).major, [8.0]);
    }
}
