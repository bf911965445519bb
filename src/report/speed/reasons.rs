//! Explains why sampling methods differ in a scene, in sentences with measured numbers.

use super::{
    notation::{asked_error, factor, percent, samples},
    results::Measurement,
};
use crate::scene::Method;

/// Returns sentences that explain why the methods differ in this scene: in which pixels they can
/// err, how the error decreases there, and how the exact method works. If no method was measured,
/// or if all pixels have a single colour, returns only the sentence about the pixels.
pub fn reasons(measured: &Measurement) -> Vec<String> {
    let mixture = measured.mixture;
    let edges = percent(mixture.edges);
    let board = match mixture.board {
        0.0 => String::new(),
        board => format!(
            ", and {} more show a checkerboard alone in both of its colours",
            percent(board)
        ),
    };
    let [least, others] = if mixture.is_complete {
        [
            "",
            "Every other pixel has one colour, which any method finds",
        ]
    } else {
        [
            "at least ",
            "Counting them all would take too long. A pixel's only colour is found by any method",
        ]
    };
    let mut reasons = vec![format!(
        "An edge crosses {least}{edges} of the pixels{board}. {others} with one sample: the error comes from the mixed pixels alone."
    )];
    if measured.series.is_empty() || mixture.edges + mixture.board == 0.0 {
        return reasons;
    }
    let along_edges = "Along an edge, N samples in N cells of a pixel can err only in the cells that the edge cuts, about √N of them, so that the error falls like N^(−3/4). Independent samples can err everywhere, and their error falls like N^(−1/2).";
    let on_board = "Where many squares fall into one pixel, the cells are as mixed as the pixel itself until there are more cells than squares: strata help there only with many samples, and the slope lies between both.";
    if mixture.edges > 0.0 {
        reasons.push(along_edges.to_owned());
    }
    if mixture.board > 0.0 {
        reasons.push(on_board.to_owned());
    }
    reasons.extend(
        measured
            .errors
            .first()
            .and_then(|&error| compared(measured, error)),
    );
    reasons.extend(in_exact_time(measured));
    reasons
}

/// Compares the method that needs the fewest samples for `error` with the method `random`, whose
/// samples are independent. Returns `None` if `random` itself needs the fewest, or has no estimate.
fn compared(measured: &Measurement, error: f64) -> Option<String> {
    let estimates = measured.series.iter().filter_map(|series| {
        let estimate = measured.estimate(series, error)?;
        Some((series.method, estimate, estimate.per_pixel?))
    });
    let estimates: Vec<_> = estimates.collect();
    let (_, random, many) = estimates.iter().find(|it| it.0 == Method::Random)?;
    let (best, least, few) = estimates.iter().min_by(|a, b| a.2.total_cmp(&b.2))?;
    (few < many).then(|| {
        format!(
            "For an error of {}, {} needs {} samples per pixel, and random {}: {} times as many.",
            asked_error(error),
            best.name(),
            samples(least),
            samples(random),
            factor(Some(many / few)),
        )
    })
}

/// Compares the exact method with the fastest sampling method. Says how many samples per pixel the
/// sampling method computes in the CPU time that the exact method needs. Returns `None` if this
/// number is below 1, or if the exact method or all sampling methods were not measured.
fn in_exact_time(measured: &Measurement) -> Option<String> {
    let exact = measured.exact_estimate(1.0)?;
    let most = measured.series.iter().filter_map(|series| {
        let last = series.points.last()?;
        let per_pixel = exact.cpu / last.typical().cpu * last.per_pixel as f64;
        Some((series.method, per_pixel))
    });
    let (method, per_pixel) = most.max_by(|a, b| a.1.total_cmp(&b.1))?;
    (per_pixel.is_finite() && per_pixel >= 1.0).then(|| {
        format!(
            "exact computes the mean of a mixed pixel from its edges, without samples. The whole picture takes it the time of about {} samples per pixel by {}.",
            factor(Some(per_pixel)),
            method.name(),
        )
    })
}
