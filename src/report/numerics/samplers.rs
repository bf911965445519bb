//! Samples: counts that are no squares, totals that do not come out even, indices beyond 2^32, the digits of radical inverses.
//!
//! What is asked is what a method promises, so the true answer is known without an oracle. The textbook's ways are those of a first
//! program: the greatest grid of n by n, the same number for each pixel, indices of 32 bits, digits gathered in `f64`, the
//! sequence from its second point on, one generator for the whole picture.

use glam::DVec2;

use super::{Case, Claim, inputs::Random, trial::Tally};
use crate::{
    area::Area,
    sampling::{Sampling, radical_inverse_3},
    scene::{Count, Method, Sampler},
};

/// The cases.
pub const CASES: &[Case] = &[
    Case::new(
        "M1",
        "n not a square: one sample in each of n cells",
        Claim::Decisions,
        uneven,
    ),
    Case::new(
        "M2",
        "totals not divisible by the pixel count",
        Claim::Decisions,
        totals,
    ),
    Case::new(
        "M3",
        "sample indices beyond 2^32, one in each cell",
        Claim::Decisions,
        long,
    ),
    Case::new(
        "M4",
        "radical inverses of up to 33 digits",
        Claim::Decisions,
        mirrored,
    ),
    Case::new(
        "M6",
        "first 2^m points: one in each elementary box",
        Claim::Decisions,
        first,
    ),
    Case::new(
        "M7",
        "a sample alone equals the one in sequence",
        Claim::Decisions,
        alone,
    ),
];

/// How many columns and rows the pictures have that questions are asked in.
const SIZE: u32 = 64;

fn sampling(random: &mut Random, method: Method, count: Count, size: [u32; 2]) -> Sampling {
    let seed = random.bits();
    let sampler = Sampler {
        method,
        count,
        seed,
    };
    Sampling::new(&sampler, size[0], size[1])
}

/// The samples of some pixel with these indices, of `n`.
fn points(
    sampling: &Sampling,
    [x, y]: [u32; 2],
    n: u64,
    range: std::ops::Range<u64>,
) -> Vec<DVec2> {
    let mut points = Vec::new();
    sampling.points(x, y, n, range, &mut points);
    points
}

fn pixel(random: &mut Random) -> [u32; 2] {
    [0; 2].map(|_: u32| random.below(SIZE.into()) as u32)
}

/// Which of `n` equal parts of the pixel's width or height an offset lies in; offsets are odd multiples of 2^−54.
fn part(offset: f64, n: u64) -> u64 {
    let units = (offset + 0.5) * (1_u64 << 54) as f64;
    ((u128::from(units as u64) * u128::from(n)) >> 54) as u64
}

/// Whether a column that is an n-th of the pixel holds one of n samples. The textbook has as many rows as columns.
fn uneven(random: &mut Random, count: u64, tally: &mut Tally) {
    let root = 1 + random.below(20);
    let n = root * root + 1 + random.below(2 * root);
    let sampling = sampling(
        random,
        Method::MultiJittered,
        Count::PerPixel(n),
        [SIZE, SIZE],
    );
    let ours = points(&sampling, pixel(random), n, 0..n);
    let textbook: Vec<_> = (0..root * root)
        .map(|i| (i as f64 + random.within(0.0, 1.0)) / (root * root) as f64)
        .collect();
    for _ in 0..count {
        let column = random.below(n);
        let theirs = textbook
            .iter()
            .filter(|&&x| (x * n as f64) as u64 == column);
        let ours = ours.iter().filter(|at| part(at.x, n) == column);
        judge(tally, [theirs.count() == 1, ours.count() == 1]);
    }
}

/// Whether the pixels' samples add up to what was asked for.
fn totals(random: &mut Random, count: u64, tally: &mut Tally) {
    for _ in 0..count {
        let size = [0; 2].map(|_: u32| 1 + random.below(12) as u32);
        let pixels = u64::from(size[0] * size[1]);
        let total = random.below(8 * pixels);
        let method = random.pick(&[Method::Random, Method::Scatter]);
        let sampling = sampling(random, method, Count::Total(total), size);
        let ours: u64 = sampling.counts(Area::whole(size[0], size[1])).iter().sum();
        let textbook = total / pixels * pixels;
        judge(tally, [textbook == total, ours == total]);
    }
}

/// Whether two samples of n = 2^33 … 2^53 lie in two columns of n, where their indices are alike in the last 32 bits.
fn long(random: &mut Random, count: u64, tally: &mut Tally) {
    let n = 1 << (33 + random.below(21));
    let sampling = sampling(random, Method::Sobol, Count::PerPixel(n), [1, 1]);
    for _ in 0..count {
        let blocks = n >> 32;
        let low = random.below(1 << 32);
        let one = random.below(blocks);
        let other = (one + 1 + random.below(blocks - 1)) % blocks;
        let indices = [one, other].map(|block| block << 32 | low);
        let textbook = indices.map(|i| (i as u32).reverse_bits());
        let ours = indices.map(|i| part(points(&sampling, [0, 0], n, i..i + 1)[0].x, n));
        judge(tally, [textbook[0] != textbook[1], ours[0] != ours[1]]);
    }
}

/// In which of 3^k intervals the inverse of a number of k digits lies: that of the mirrored digits, at whose beginning it is.
fn mirrored(random: &mut Random, count: u64, tally: &mut Tally) {
    for _ in 0..count {
        let digits = 1 + random.below(33) as u32;
        let power = 3_u64.pow(digits);
        let i = random.below(power);
        let (mut rest, mut truth) = (i, 0);
        let (mut textbook, mut place) = (0.0, 1.0 / 3.0);
        for _ in 0..digits {
            truth = 3 * truth + rest % 3;
            textbook += (rest % 3) as f64 * place;
            place /= 3.0;
            rest /= 3;
        }
        let textbook = (textbook * power as f64) as u64;
        let ours = (u128::from(radical_inverse_3(i)) * u128::from(power)) >> 64;
        judge(tally, [textbook == truth, ours == u128::from(truth)]);
    }
}

/// Whether one of the first 2^m points of Sobol' lies in a box of 2^−a by 2^(a−m). The textbook leaves out the very first, as many do.
fn first(random: &mut Random, count: u64, tally: &mut Tally) {
    let m = 1 + random.below(8);
    let n = 1 << m;
    let sampling = sampling(random, Method::Sobol, Count::PerPixel(n), [SIZE, SIZE]);
    let ours = points(&sampling, pixel(random), n, 0..n);
    let textbook: Vec<_> = (1..=n).map(sobol).collect();
    for _ in 0..count {
        let columns = 1 << random.below(m + 1);
        let rows = n / columns;
        let (column, row) = (random.below(columns), random.below(rows));
        let theirs = textbook.iter().filter(|at| {
            (at.x * columns as f64) as u64 == column && (at.y * rows as f64) as u64 == row
        });
        let ours = ours
            .iter()
            .filter(|at| part(at.x, columns) == column && part(at.y, rows) == row);
        judge(tally, [theirs.count() == 1, ours.count() == 1]);
    }
}

/// A point of Sobol's first two coordinates: the bits mirrored, and multiplied by Pascal's triangle modulo 2 before.
fn sobol(i: u64) -> DVec2 {
    let mut direction = 1_u64 << 63;
    let (mut rest, mut y) = (i, 0);
    while rest > 0 {
        if rest & 1 == 1 {
            y ^= direction;
        }
        direction ^= direction >> 1;
        rest >>= 1;
    }
    DVec2::new(i.reverse_bits() as f64, y as f64) / libm::exp2(64.0)
}

/// Whether a sample is the same when it is asked for alone. The textbook takes the next numbers of one generator.
fn alone(random: &mut Random, count: u64, tally: &mut Tally) {
    let method = random.pick(&Method::SAMPLED);
    let n = 1 + random.below(64);
    let size = [SIZE, SIZE];
    let sampling = sampling(random, method, Count::PerPixel(n), size);
    let mut stream = random.clone();
    for _ in 0..count {
        let at = pixel(random);
        let n = sampling.count(at[0], at[1]);
        if n == 0 {
            judge(tally, [true; 2]);
            continue;
        }
        let i = random.below(n);
        let after = points(&sampling, at, n, 0..n)[i as usize];
        let ours = points(&sampling, at, n, i..i + 1)[0];
        let textbook = stream.clone().offset();
        let later = (0..=i).fold(DVec2::ZERO, |_, _| stream.offset());
        judge(tally, [textbook == later, ours == after]);
    }
}

fn judge(tally: &mut Tally, is_right: [bool; 2]) {
    tally.inputs += 1;
    for (wrong, is_right) in tally.wrong.iter_mut().zip(is_right) {
        *wrong += u64::from(!is_right);
    }
}
