//! What it may cost to learn what is seen in a part: a small share of what it costs to trace its samples one by one.
//!
//! So a picture takes hardly longer than that, whatever is in it. All is counted in samples that meet few objects on their way.
//! The constants are ratios of times, chosen by what `benches/sweep.rs` measures on pictures of many kinds.

use glam::DVec2;

use crate::{area::Area, tracer::world::World};

/// A part is cut if it has so many samples for each candidate, where these are so few that they may fill it: to look at a candidate in each
/// quarter takes a few hundredths of their time.
const SAMPLES_A_CANDIDATE: f64 = 16.0;

/// Of more candidates, of whose bounds samples could be told instead, it is cut if it has so many: four times as many, as to look at candidates
/// themselves takes longer than at their bounds.
const SAMPLES_A_CROWDED_CANDIDATE: f64 = 64.0;

/// By its candidates' bounds alone a part is cut if it has so many samples for each: each sample that is traced among them afterwards is spared the bounds of the
/// others.
const SAMPLES_A_BOUND: f64 = 5.0;

/// To cut takes as long as to look at so many bounds once more for a sample each: with fewer in all that is what is done.
const BOUNDS_A_CUT: f64 = 128.0;

/// So few candidates are looked at where they could be paid for once: they may fill the part.
pub const FEW_CANDIDATES: usize = 4;

/// In the time in which a pixel is prepared to trace its samples together so many of them are traced one by one.
const SAMPLES_A_PIXEL: f64 = 1.0;

/// Each sample more of a pixel pays for so many candidates: the time that a candidate adds to the preparation.
const CANDIDATES_A_SAMPLE: f64 = 0.7;

/// Where bounds are known it pays for so many forms. A candidate has about two: of a large one most have one sign all over the pixel. But
/// samples among known bounds take about half the time, one by one, so they pay for half as many.
const FORMS_A_SAMPLE: f64 = 0.7;

/// The objects of which a crowd is made have so many forms or more.
const FORMS_AN_OBJECT: f64 = 3.0;

/// In a part that one board fills no more samples than these are traced in less time than it takes to see whether each quarter shows but one
/// square.
const SAMPLES_A_QUARTERING: f64 = 4.0;

/// What a board shows in several pixels is worth knowing from so many samples a pixel on.
const SAMPLES_A_CHECK: f64 = 3.0;

/// A part with fewer samples is not worth a probe.
const SAMPLES_A_PROBE: f64 = 256.0;

/// What an object that a ray asks takes, in parts of what a ray that meets few does.
const SAMPLES_AN_OBJECT: f64 = 0.2;

/// What the samples of a pixel cost, one by one.
#[derive(Clone, Copy, Debug)]
pub struct Budget {
    /// As many samples that meet few objects cost as much.
    samples: f64,
    /// Whether rays were asked what they cost.
    is_probed: bool,
}

impl Budget {
    /// For a picture that is to be known whatever it costs.
    pub const ENDLESS: Self = Self {
        samples: f64::INFINITY,
        is_probed: true,
    };

    /// For so many samples a pixel.
    pub fn of(samples: f64) -> Self {
        Self {
            samples,
            is_probed: false,
        }
    }

    /// Whether there is anything that costs too much.
    pub fn is_limited(self) -> bool {
        self.samples.is_finite()
    }

    /// So many candidates of a part are worth looking at.
    pub fn most(self, area: Area) -> usize {
        let shared = match area.pixels() {
            1 => 0.0,
            pixels => self.samples * pixels as f64 / SAMPLES_A_CANDIDATE,
        };
        self.most_in_a_pixel().max(shared) as usize
    }

    /// So many candidates of a part are worth looking at by their bounds.
    pub fn most_bounds(self, area: Area) -> usize {
        let shared = self.samples * area.pixels() as f64 / SAMPLES_A_BOUND;
        shared.max(self.most(area) as f64) as usize
    }

    /// Whether so many candidates are more than the samples of a part may well look at by their bounds.
    pub fn is_for_a_cut(self, area: Area, candidates: usize) -> bool {
        candidates as f64 * self.samples * area.pixels() as f64 >= BOUNDS_A_CUT
    }

    /// Whether so many are so few that they are looked at themselves, not only at their bounds.
    pub fn is_for_a_look(self, area: Area, candidates: usize) -> bool {
        let samples = match candidates <= FEW_CANDIDATES {
            true => SAMPLES_A_CANDIDATE,
            false => SAMPLES_A_CROWDED_CANDIDATE,
        };
        samples * candidates as f64 <= self.samples * area.pixels() as f64
    }

    /// Whether candidates with so many forms, whose bounds are known, are prepared for the samples of a pixel, to trace them together.
    pub fn is_for_forms(self, forms: usize) -> bool {
        forms as f64 <= self.most_forms()
    }

    /// In a pixel no more objects of a crowd than these can have so few forms.
    pub fn most_in_a_crowd(self) -> usize {
        (self.most_forms() / FORMS_AN_OBJECT) as usize
    }

    /// Whether it is worth to know in which quarters of a part that one board fills but one square is seen.
    pub fn is_for_quarters(self, area: Area) -> bool {
        self.samples * area.pixels() as f64 > SAMPLES_A_QUARTERING
    }

    /// Whether what a board shows in several pixels is worth knowing.
    pub fn is_for_checks(self) -> bool {
        self.samples >= SAMPLES_A_CHECK
    }

    /// The same budget, or a greater one where the rays of a part are found to ask many objects.
    pub fn probed(self, world: &World, area: Area) -> Self {
        if self.is_probed || self.samples * (area.pixels() as f64) < SAMPLES_A_PROBE {
            return self;
        }
        let (mut rays, mut asked) = (0.0, 0);
        for quarter in area.quarters() {
            let Area { x, y, .. } = quarter.middle();
            asked += world.asked(x, y, DVec2::ZERO);
            rays += 1.0;
        }
        Self {
            samples: self.samples * (1.0 + SAMPLES_AN_OBJECT * asked as f64 / rays),
            is_probed: true,
        }
    }

    fn most_forms(self) -> f64 {
        FORMS_A_SAMPLE * (self.samples - SAMPLES_A_PIXEL)
    }

    fn most_in_a_pixel(self) -> f64 {
        CANDIDATES_A_SAMPLE * (self.samples - SAMPLES_A_PIXEL)
    }
}
