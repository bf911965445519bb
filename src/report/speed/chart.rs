//! Charts of error against time and of error against samples, as SVG.
//!
//! Both axes are logarithmic. At the end of each line, the method's name is written, so that no
//! legend is needed. Markers and dashes distinguish the lines even in black and white. Black is
//! written as CSS's `currentColor`, so that black marks become light on a dark page.

use std::ops::Range;

use plotters::{
    coord::combinators::{LogCoord, WithKeyPoints},
    element::DashedPathElement,
    prelude::{
        BLACK, BindKeyPoints, ChartBuilder, Color, IntoDrawingArea, IntoFont, IntoLogRange,
        PathElement, SVGBackend, Text,
    },
    style::{
        TextStyle,
        text_anchor::{HPos, Pos, VPos},
    },
};

use super::{
    line_style::{Canvas, CanvasPoint, Drawn, LineStyle},
    notation::{asked_error, seconds},
    results::{Measurement, Run, SeriesPoint},
    summary::printable,
};
use crate::{diagnostic::escaped, numbers};

/// Width and height of a chart, in pixels. On a phone, whose screen is about 400 CSS pixels wide,
/// the labels of a larger chart could hardly be read.
const SIZE: (u32, u32) = (560, 440);

/// Width of the space for the methods' names at the right of a chart, in pixels. It is chosen so
/// that the longest name, `multi_jittered`, fits.
const LABELS: i32 = 162;

/// Minimum vertical distance between the methods' names at the right of a chart, in pixels. It is a
/// little more than the height of the letters, 18, so that the names do not overlap.
const LABEL_HEIGHT: i32 = 21;

/// The quantity on a chart's horizontal axis, e.g. the CPU time, with its title and number format.
struct HorizontalAxis {
    title: &'static str,
    name: &'static str,
    of: fn(&SeriesPoint) -> f64,
    written: fn(f64) -> String,
    /// The quantity's value for the exact method, for example its CPU time. A vertical line marks
    /// this value, since the exact method's error is too small for the chart. `None` if no line is
    /// drawn.
    exact: Option<f64>,
    /// Slopes that short lines show for comparison, each with its label.
    guides: &'static [(f64, &'static str)],
}

/// Draws the chart of error against CPU time as SVG. The exact method is drawn as a vertical line.
pub fn against_time(measured: &Measurement) -> String {
    let time = HorizontalAxis {
        title: "Error against CPU time",
        name: "CPU time of a render",
        of: |point| point.typical().cpu,
        written: |time| seconds(time, 1),
        exact: measured.exact.as_ref().map(|runs| Run::typical(runs).cpu),
        guides: &[],
    };
    svg(measured, &time)
}

/// Draws the chart of error against samples per pixel as SVG.
pub fn against_samples(measured: &Measurement) -> String {
    let samples = HorizontalAxis {
        title: "Error against samples",
        name: "samples per pixel",
        of: |point| point.per_pixel as f64,
        written: numbers::short,
        exact: None,
        guides: &[(-0.5, "−1/2"), (-0.75, "−3/4")],
    };
    svg(measured, &samples)
}

/// Returns the requested errors that a chart marks. These are within a factor of 30 of a measured
/// error. If others were marked, the range of the chart would be too large.
pub fn shown_errors(measured: &Measurement) -> Vec<f64> {
    let points = measured.series.iter().flat_map(|series| &series.points);
    let found: Vec<_> = points.map(|point| point.typical().error).collect();
    let is_near = |wanted: &f64| {
        let is_close = |error: &f64| (error / 30.0..error * 30.0).contains(wanted);
        found.iter().any(is_close)
    };
    measured.errors.iter().copied().filter(is_near).collect()
}

fn svg(measured: &Measurement, against: &HorizontalAxis) -> String {
    let mut svg = String::new();
    // Drawing to a string fails only if plotters measures text, which it does not here.
    let canvas = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
    let done = draw(canvas, measured, against);
    debug_assert!(done.is_ok(), "{done:?}");
    let name = escaped(&printable(&measured.subject.name));
    let title = format!("{}: {name}", against.title);
    let opening = format!("<svg class=\"chart\" role=\"img\" aria-label=\"{title}\" ");
    let style = "<style>.chart{color:#111;background:#fff;font-variant-numeric:tabular-nums}\
                 @media(prefers-color-scheme:dark){.chart{color:#ddd;background:#181818}}\
                 @media print{.chart{color:#000;background:#fff}}</style>\n";
    let head = format!(">\n<title>{title}</title>\n{style}");
    svg.replace("#000000", "currentColor")
        .replacen("<svg ", &opening, 1)
        .replacen(">\n", &head, 1)
}

fn draw(canvas: Canvas, measured: &Measurement, against: &HorizontalAxis) -> Drawn {
    let wanted = shown_errors(measured);
    // Only positive, finite numbers have a place on a logarithmic axis, so other values are not
    // drawn.
    let exact = against.exact.filter(|x| x.is_finite() && *x > 0.0);
    let lines = measured.series.iter().map(|series| {
        let place = |point: &SeriesPoint| ((against.of)(point), point.typical().error);
        let points = series.points.iter().map(place);
        let points: Vec<_> = points.filter(|&(x, y)| x > 0.0 && y > 0.0).collect();
        (series.method, points)
    });
    let lines: Vec<_> = lines.filter(|(_, points)| !points.is_empty()).collect();
    let points = || lines.iter().flat_map(|(_, points)| points);
    let x_range = around(points().map(|point| point.0).chain(exact));
    let y_range = around(points().map(|point| point.1).chain(wanted.iter().copied()));
    let mut plot = ChartBuilder::on(&canvas)
        .margin_top(36)
        .margin_right(LABELS)
        .margin_left(10)
        .margin_bottom(2)
        .x_label_area_size(52)
        .y_label_area_size(76)
        .build_cartesian_2d(axis(&x_range), axis(&y_range))?;
    plot.configure_mesh()
        .x_label_formatter(&|x| (against.written)(*x))
        .y_label_formatter(&|y| numbers::short(*y))
        .label_style(letters(18.0))
        .axis_desc_style(letters(18.0))
        .x_desc(against.name)
        .y_desc("error (RMSE)")
        .axis_style(BLACK.mix(0.6))
        .bold_line_style(BLACK.mix(0.2))
        .light_line_style(BLACK.mix(0.07))
        .draw()?;
    let (columns, rows) = plot.plotting_area().get_pixel_range();
    let title = Text::new(against.title, (columns.start, 10), letters(20.0));
    canvas.draw(&title)?;
    let place = |x: f64, y: f64| plot.backend_coord(&(x, y));
    for wanted in wanted {
        let (_, y) = place(x_range.start, wanted);
        let ends = [(columns.start, y), (columns.end, y)];
        canvas.draw(&DashedPathElement::new(ends, 4, 4, BLACK.mix(0.6)))?;
        write(&canvas, &asked_error(wanted), (columns.start + 5, y - 10))?;
    }
    if let Some(exact) = exact {
        let (x, _) = place(exact, y_range.start);
        draw_exact(&canvas, x, &columns, &rows)?;
    }
    for &(slope, label) in against.guides {
        let [from, to] = guide(&x_range, &y_range, slope).map(|(x, y)| place(x, y));
        canvas.draw(&PathElement::new(vec![from, to], BLACK.mix(0.6)))?;
        write(&canvas, label, (to.0 + 5, to.1))?;
    }
    let places = lines.iter().map(|(_, points)| {
        let places = points.iter().map(|&(x, y)| place(x, y));
        places.collect::<Vec<_>>()
    });
    let places: Vec<_> = places.collect();
    let ends: Vec<_> = places
        .iter()
        .filter_map(|line| line.last().copied())
        .collect();
    let labels = ends.iter().zip(spread_out(&ends, &rows));
    for (((method, _), places), (end, height)) in lines.iter().zip(&places).zip(labels) {
        let style = LineStyle::new(*method);
        style.line(&canvas, places)?;
        let marker = (columns.end + 20, height);
        for &place in places.iter().chain([&marker]) {
            style.marker(&canvas, place)?;
        }
        let start = (end.0 + 7, end.1);
        let leader = vec![start, (columns.end + 5, height), (marker.0 - 8, height)];
        canvas.draw(&PathElement::new(leader, style.color.mix(0.45)))?;
        write(&canvas, method.name(), (marker.0 + 10, height))?;
    }
    canvas.present()
}

/// Draws the vertical line of the exact method at the column `x`. An arrow at its lower end shows
/// that the exact method's error lies below the chart. The label must avoid the lines of other
/// methods, which run from the upper left to the lower right. So it is placed at the lower end of
/// the line in the left half of the chart, and at the upper end in the right half.
fn draw_exact(canvas: &Canvas, x: i32, columns: &Range<i32>, rows: &Range<i32>) -> Drawn {
    let end = rows.end - 2;
    let head = [(x - 6, end - 10), (x, end), (x + 6, end - 10)];
    for line in [&[(x, rows.start), (x, end)][..], &head] {
        canvas.draw(&PathElement::new(line, BLACK.stroke_width(2)))?;
    }
    let place = if x < (columns.start + columns.end) / 2 {
        (x + 9, rows.end - 14)
    } else {
        (x - 54, rows.start + 12)
    };
    write(canvas, "exact", place)
}

/// Returns the ends of a line that shows a slope, for comparison with the methods' lines. The line
/// lies at the lower left of the chart, where no method's line runs. The lines for all slopes start
/// at the same point. It is high enough that even the steepest line, with the slope −3/4, ends
/// above the lower edge of the chart, where the line of a requested error may be.
fn guide(x: &Range<f64>, y: &Range<f64>, slope: f64) -> [(f64, f64); 2] {
    let at = |part: f64| x.start * libm::pow(x.end / x.start, part);
    let (from, to) = (at(0.18), at(0.5));
    let start = 2.2 * y.start * libm::pow(to / from, 0.75);
    [(from, start), (to, start * libm::pow(to / from, slope))]
}

fn write(canvas: &Canvas, text: &str, at: CanvasPoint) -> Drawn {
    let style = letters(18.0).pos(Pos::new(HPos::Left, VPos::Center));
    canvas.draw(&Text::new(text, at, style))
}

fn letters(size: f64) -> TextStyle<'static> {
    TextStyle::from(("sans-serif", size).into_font())
}

/// Returns a range of an axis that contains `values`, with a margin of a factor of 1.5 at both
/// ends.
fn around(values: impl Iterator<Item = f64>) -> Range<f64> {
    let wider = |(low, high): (f64, f64), value| (low.min(value), high.max(value));
    let (low, high) = values.fold((f64::INFINITY, 0.0), wider);
    if low <= high {
        low / 1.5..high * 1.5
    } else {
        // Without values, any range is suitable.
        0.1..1.0
    }
}

/// Returns a logarithmic axis. Its labels are at 1, 2 and 5 times the powers of ten. If these are
/// more than five labels, they are only at the powers. Grid lines are at 1 to 9 times the powers.
fn axis(ends: &Range<f64>) -> WithKeyPoints<LogCoord<f64>> {
    let marks = |digits: &[i32]| -> Vec<f64> {
        let powers = libm::log10(ends.start).floor() as i32..=libm::log10(ends.end) as i32;
        let marks = powers.flat_map(|power| {
            let power = libm::exp10(f64::from(power));
            digits.iter().map(move |&digit| f64::from(digit) * power)
        });
        marks.filter(|mark| ends.contains(mark)).collect()
    };
    let many = marks(&[1, 2, 5]);
    let numbers = if many.len() > 5 { marks(&[1]) } else { many };
    let scale = ends.clone().log_scale();
    scale
        .with_key_points(numbers)
        .with_light_points(marks(&[1, 2, 3, 4, 5, 6, 7, 8, 9]))
}

/// Returns the vertical positions, in pixels, of the methods' names at the right of a chart. Each
/// name is near the end of its line, which `ends` contains, and no two names overlap.
fn spread_out(ends: &[CanvasPoint], rows: &Range<i32>) -> Vec<i32> {
    let mut order: Vec<_> = (0..ends.len()).collect();
    order.sort_by_key(|&at| ends[at].1);
    let mut heights = vec![0; ends.len()];
    // From the top downwards, each name is placed at the height of its line's end. If it would
    // cover the name above, it is placed directly below that name.
    let mut free = rows.start;
    for &at in &order {
        heights[at] = ends[at].1.max(free);
        free = heights[at] + LABEL_HEIGHT;
    }
    // Names that would extend below the chart are moved up. If they would then overlap the names
    // above, these are moved up, too.
    let mut free = rows.end;
    for &at in order.iter().rev() {
        heights[at] = heights[at].min(free);
        free = heights[at] - LABEL_HEIGHT;
    }
    heights
}
