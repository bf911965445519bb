//! How the numbers of the page came about, for those who distrust them.

use super::{measure::Measurement, notes::NOISY, page::prose};
use crate::{numbers, render::Exact};

/// The section, as HTML.
pub fn account(measurements: &[Measurement]) -> String {
    let greatest = |of: fn(&Exact) -> f64| {
        let bounds = measurements.iter();
        let bounds = bounds.map(|measured| of(&measured.reference));
        prose(&numbers::at_most(bounds.fold(0.0, f64::max)))
    };
    let [bound, mean] = [Exact::bound, Exact::root_mean_square_bound].map(greatest);
    let noisy = NOISY * 100.0;
    format!(
        "<section>\n<h2>How the numbers came about</h2>\n<ul>\n\
         <li><b>Warm-up.</b> The exact picture is computed and every method renders twice, with few samples, before anything counts. What that took decides how \
         many samples and runs fit into the time; where times turn out to be noisy and time is left, there are more runs.</li>\n\
         <li><b>Runs are interleaved.</b> A round runs every method with every number of samples once, in an order that is shuffled anew in \
         each round by a fixed rule, so that what else the machine does falls on all alike. A run has a seed of its own: that of the scene \
         plus the number of the round; after 2<sup>53</sup> − 1 comes 0.</li>\n\
         <li><b>What is timed</b> is the way from the scene in memory to the picture in memory: preparing objects and samples, starting the \
         threads, rendering. Reading the scene, comparing pictures and writing PNG files are not. Samples per second are all samples divided by that time: most lie in pixels \
         that are certain to show one colour, and are not traced. Rays per second are those that are, by the same time. The time is the median of the runs; \
         combinations whose times spread by more than {noisy} % of it are called noisy above.</li>\n\
         <li><b>The error</b> is the root of the mean squared difference to the exact picture, over all pixels and the three channels, in \
         linear light; that of several runs is the root of the mean of their squares. The reference is not rendered with many samples but \
         computed from the areas that the objects cover in a pixel, with a bound for each pixel that grows with every operation; the \
         greatest bound here is {bound}, and the root of the mean of their squares {mean}: no error that is smaller means anything.</li>\n\
         <li><b>The slope</b> b of error ∝ samples<sup>b</sup> is the least-squares line through the logarithms of samples and error, one \
         point for each number of samples. With residuals r of k points and x = ln samples, its standard error is \
         √(Σr² / (k − 2) / Σ(x − x̄)²) (Draper and Smith, <i>Applied Regression Analysis</i>, 3rd ed. 1998, section 1.4). A few points may \
         lie on a line by luck, so that the error is no less than what the spread of the runs gives it, each of which has a seed of its own: \
         √(Σ(x − x̄)²e²) / Σ(x − x̄)², e being the standard error of the logarithm of a point’s error, √(v/n)/2m by the mean m and the variance v \
         of the n runs’ squared errors. The greater one counts (as the Particle Data Group scales errors). But a curve that bends has no one slope, \
         however well the mean one is known: so the ± is no less than the greatest difference between b and the slope between any two points of the chart, tried ones among them, \
         of which one has at least twice the samples of the other. JSON has all three. From single runs nothing is known of it, and of the slope beyond these points nothing is said.</li>\n\
         <li><b>What an error takes</b> is first where the line through the logarithms comes down to it between the planned points on either side, and its time lies on the straight \
         line between the same. Where no point comes down to it, the line goes on through the last point and another with at most half its samples, and its time with the slope of the line from the first point to the last. Where the samples are left \
         to the program and time is left, that is tried, what takes the least time in all first: single runs, each with the next seed after those of all runs before it, take as many samples as the answer says, and up to a fifth more and fewer. \
         The answer moves to where the tries within a factor of e<sup>0.3</sup> of it lie by the slope of that line (the root of the mean of their squared errors counts, each moved along the slope to the middle of their counts), until there are six, or twelve in all; by no more than a factor of four from their middle. It is rounded up to a whole number of samples, and its time is the median of theirs, each by as much as it has more or fewer samples. \
         What rests on fewer than three where the line was extrapolated is marked so.</li>\n\
         <li><b>× and ÷</b> is said of renders: 19 of 20 with so many times as many samples leave no more than the error, and those with so many times as few no less, in the mean of squares (a single one of a picture with few pixels on edges may hit it by luck). Of k tries, 3 or more, it is Student’s quantile for k − 1 times the deviation of the logarithms of their errors, moved as above, \
         times √(1 + 1/k), by the slope (tries have seeds and counts of their own, but with a prime multi_jittered, whose grid then is a single row, may leave more in each render); and with it, by the root of the sum of squares, the way from their middle to the answer. One or two tries know too little of that: the deviation is no less than that of the runs of the last planned point. \
         Without tries it is the standard error by those of the two points’ errors, |1 − s|·e<sub>1</sub> + s·e<sub>2</sub> (runs of one seed are wrong together), at 1 − s of the first and s of the second in logarithms, and the deviation of a run, by the slope and with Student’s quantile for \
         as many runs; and with it what the truth may be off from that line: between two points what it may sag, 0.8·((x₂ − x₁)/2)², 0.38 between a count and four times as many; \
         beyond the last the greatest difference to what comes out if errors fall further on by any slope between other points, as above, or by −1/2. \
         With fewer than three tries that is known of random and scatter only, whose samples do not know of each other: other methods like powers of two, or squares, better than the counts beside them (?). It is not known of regular, whose grid falls into step with the lines of a picture, unless these very samples were measured; \
         nor where the fewest samples that were measured are enough, if they are more than one (≤), or if one run in 20 may leave more.</li>\n\
         <li><b>The fastest method</b> is named together with all whose time may be the same, within × and ÷ of the samples \
         and half of the spread of the times. That of a single run is the largest of the method's others; where there is none nothing is known of it.</li>\n\
         </ul>\n</section>\n"
    )
}
