//! Error against time and against samples, as SVG.
//!
//! Both axes are logarithmic. A line is labelled at its end, so that nobody has to look up a legend, and its marker and dash say in
//! black and white what its colour says otherwise. Black is written as the current colour, so that a page may be dark.

use std::ops::Range;

use plotters::{
    coord::Shift,
    element::DashedPathElement,
    prelude::{
        BLACK, BindKeyPoints, ChartBuilder, Color, DrawingArea, DrawingBackend, IntoDrawingArea,
        IntoFont, IntoLogRange, PathElement, SVGBackend, Text,
    },
    style::{
        TextStyle,
        text_anchor::{HPos, Pos, VPos},
    },
};

use super::{
    line_style::{Drawn, LineStyle, Place},
    notation::asked_error,
    results::{Measurement, Point, Times},
    summary::printable,
};
use crate::numbers;

/// The size in pixels: small, so that the letters are still legible on a telephone, whose screen is 400 of its pixels wide.
const SIZE: (u32, u32) = (560, 440);

/// Room at the right for the labels, the longest of which is `multi_jittered`.
const LABELS: i32 = 162;

/// Labels are at least so far apart.
const LABEL_HEIGHT: i32 = 21;

/// The size of letters.
const LETTERS: f64 = 18.0;

/// What a chart shows.
struct Chart {
    title: &'static str,
    x_name: &'static str,
    write_x: fn(f64) -> String,
    lines: Vec<Line>,
    /// Errors that are asked for.
    wanted: Vec<f64>,
    /// The exact method's time: its error is off the scale.
    exact: Option<f64>,
}

struct Line {
    style: LineStyle,
    label: &'static str,
    points: Vec<(f64, f64)>,
}

/// The chart of error against CPU time. The exact method, whose error is off the scale, is a vertical line.
pub fn against_time(measured: &Measurement) -> String {
    let chart = Chart {
        title: "Error against CPU time",
        x_name: "CPU time of a render",
        write_x: |time| match time < 0.9995 {
            true => format!("{} ms", numbers::short(time * 1e3)),
            false => format!("{} s", numbers::short(time)),
        },
        lines: lines(measured, |point| point.times.cpu()),
        wanted: shown_errors(measured),
        exact: measured.exact.as_ref().map(Times::cpu),
    };
    draw(&chart, &measured.subject.name)
}

/// The errors that are asked for, but for those that are far away from all that were measured.
pub fn shown_errors(measured: &Measurement) -> Vec<f64> {
    let points = measured.series.iter().flat_map(|series| &series.points);
    let found: Vec<_> = points.map(Point::error).collect();
    let is_near = |wanted: &f64| {
        let mut found = found.iter();
        found.any(|error| (error / 30.0..error * 30.0).contains(wanted))
    };
    measured.errors.iter().copied().filter(is_near).collect()
}

/// The chart of error against samples per pixel.
pub fn against_samples(measured: &Measurement) -> String {
    let chart = Chart {
        title: "Error against samples",
        x_name: "samples per pixel",
        write_x: numbers::short,
        lines: lines(measured, |point| point.per_pixel as f64),
        wanted: shown_errors(measured),
        exact: None,
    };
    draw(&chart, &measured.subject.name)
}

fn lines(measured: &Measurement, x: fn(&Point) -> f64) -> Vec<Line> {
    let line = measured.series.iter().map(|series| {
        let points = series.points.iter().map(|point| (x(point), point.error()));
        Line {
            style: LineStyle::of(series.method),
            label: series.method.name(),
            // What has no logarithm has no place.
            points: points.filter(|&(x, y)| x > 0.0 && y > 0.0).collect(),
        }
    });
    line.filter(|line| !line.points.is_empty()).collect()
}

fn draw(chart: &Chart, name: &str) -> String {
    let mut svg = String::new();
    // Into a string: nothing can go wrong but the layout of text, and no text is laid out.
    let area = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
    let done = draw_on(area, chart);
    debug_assert!(done.is_ok(), "{done:?}");
    let title = format!("{}: {}", chart.title, escaped(&printable(name)));
    let opening = format!("<svg class=\"chart\" role=\"img\" aria-label=\"{title}\" ");
    let style = "<style>.chart{color:#111;background:#fff;font-variant-numeric:tabular-nums}\
                 @media(prefers-color-scheme:dark){.chart{color:#ddd;background:#181818}}\
                 @media print{.chart{color:#000;background:#fff}}</style>\n";
    let head = format!(">\n<title>{title}</title>\n{style}");
    svg.replace("#000000", "currentColor")
        .replacen("<svg ", &opening, 1)
        .replacen(">\n", &head, 1)
}

/// Text as it stands in XML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

fn draw_on<DB: DrawingBackend>(area: DrawingArea<DB, Shift>, chart: &Chart) -> Drawn<DB> {
    let points = || chart.lines.iter().flat_map(|line| &line.points);
    let x_axis = Axis::around(
        points()
            .map(|point| point.0)
            .chain(chart.exact.filter(|&x| x > 0.0)),
    );
    let errors = points().map(|point| point.1);
    let y_axis = Axis::around(errors.chain(chart.wanted.iter().copied()));
    let mut plot = ChartBuilder::on(&area)
        .margin_top(36)
        .margin_right(LABELS)
        .margin_left(10)
        .margin_bottom(2)
        .x_label_area_size(52)
        .y_label_area_size(76)
        .build_cartesian_2d(x_axis.scale(), y_axis.scale())?;
    plot.configure_mesh()
        .x_label_formatter(&|x| (chart.write_x)(*x))
        .y_label_formatter(&|y| numbers::short(*y))
        .label_style(letters())
        .axis_desc_style(letters())
        .x_desc(chart.x_name)
        .y_desc("error (RMSE)")
        .axis_style(BLACK.mix(0.6))
        .bold_line_style(BLACK.mix(0.2))
        .light_line_style(BLACK.mix(0.07))
        .draw()?;
    let (columns, rows) = plot.plotting_area().get_pixel_range();
    let title = TextStyle::from(("sans-serif", 20.0).into_font());
    area.draw(&Text::new(chart.title, (columns.start, 10), title))?;
    let place = |x: f64, y: f64| plot.backend_coord(&(x, y));
    for &wanted in &chart.wanted {
        let (_, y) = place(x_axis.ends.start, wanted);
        let ends = [(columns.start, y), (columns.end, y)];
        area.draw(&DashedPathElement::new(ends, 4, 4, BLACK.mix(0.6)))?;
        write(&area, asked_error(wanted), (columns.start + 5, y - 10))?;
    }
    if let Some(time) = chart.exact.filter(|time| time.is_finite() && *time > 0.0) {
        let (x, _) = place(time, y_axis.ends.start);
        exact(&area, x, &columns, &rows)?;
    }
    let places = |line: &Line| line.points.iter().map(|&(x, y)| place(x, y)).collect();
    let lines: Vec<Vec<Place>> = chart.lines.iter().map(places).collect();
    let ends = lines.iter().filter_map(|places| places.last());
    let ends: Vec<Place> = ends.copied().collect();
    let heights = spread_out(&ends, &rows);
    let labels = ends.iter().zip(heights);
    for ((line, places), (end, height)) in chart.lines.iter().zip(&lines).zip(labels) {
        line.style.line(&area, places)?;
        let marker = (columns.end + 20, height);
        for &place in places.iter().chain([&marker]) {
            line.style.marker(&area, place)?;
        }
        let start = (end.0 + 7, end.1);
        let leader = vec![start, (columns.end + 5, height), (marker.0 - 8, height)];
        area.draw(&PathElement::new(leader, line.style.color.mix(0.45)))?;
        write(&area, line.label.to_owned(), (marker.0 + 10, height))?;
    }
    area.present()
}

/// The vertical line of the exact method, with an arrow to where its error lies; its name stands where the lines of the others are not, which
/// come from the top left and go to the bottom right.
fn exact<DB: DrawingBackend>(
    area: &DrawingArea<DB, Shift>,
    x: i32,
    columns: &Range<i32>,
    rows: &Range<i32>,
) -> Drawn<DB> {
    let end = rows.end - 2;
    let style = BLACK.stroke_width(2);
    let head = vec![(x - 6, end - 10), (x, end), (x + 6, end - 10)];
    area.draw(&PathElement::new(vec![(x, rows.start), (x, end)], style))?;
    area.draw(&PathElement::new(head, style))?;
    let place = match x < (columns.start + columns.end) / 2 {
        true => (x + 9, rows.end - 14),
        false => (x - 54, rows.start + 12),
    };
    write(area, "exact".to_owned(), place)
}

fn write<DB: DrawingBackend>(area: &DrawingArea<DB, Shift>, text: String, at: Place) -> Drawn<DB> {
    let style = letters().pos(Pos::new(HPos::Left, VPos::Center));
    area.draw(&Text::new(text, at, style))
}

fn letters() -> TextStyle<'static> {
    TextStyle::from(("sans-serif", LETTERS).into_font())
}

/// A logarithmic axis.
struct Axis {
    ends: Range<f64>,
    /// Where numbers stand.
    major: Vec<f64>,
    /// Where lines are drawn besides.
    minor: Vec<f64>,
}

impl Axis {
    /// An axis for these values, with numbers at 1, 2 and 5 times powers of ten, or at the powers alone where those would be many.
    fn around(values: impl Iterator<Item = f64>) -> Self {
        let wider = |(low, high): (f64, f64), value| (low.min(value), high.max(value));
        let (low, high) = values.fold((f64::INFINITY, 0.0), wider);
        // Nothing to show: any axis will do.
        let (low, high) = if low <= high { (low, high) } else { (0.1, 1.0) };
        let ends = low / 1.5..high * 1.5;
        let powers = libm::log10(ends.start).floor() as i32..=libm::log10(ends.end).ceil() as i32;
        let within = |steps: &[f64]| -> Vec<f64> {
            let power = |power: i32| libm::exp10(f64::from(power));
            let ticks = powers.clone().map(power);
            let ticks = ticks.flat_map(|power| steps.iter().map(move |step| step * power));
            ticks.filter(|tick| ends.contains(tick)).collect()
        };
        let many = within(&[1.0, 2.0, 5.0]);
        Self {
            major: match many.len() > 5 {
                true => within(&[1.0]),
                false => many,
            },
            minor: within(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]),
            ends,
        }
    }

    fn scale(
        &self,
    ) -> impl plotters::coord::ranged1d::Ranged<
        ValueType = f64,
        FormatOption = plotters::coord::ranged1d::DefaultFormatting,
    > + use<> {
        let scale = self.ends.clone().log_scale();
        scale
            .with_key_points(self.major.clone())
            .with_light_points(self.minor.clone())
    }
}

/// Heights for labels near the ends of their lines, in the order of the ends, none upon another.
fn spread_out(ends: &[Place], rows: &Range<i32>) -> Vec<i32> {
    let mut order: Vec<_> = (0..ends.len()).collect();
    order.sort_by_key(|&at| ends[at].1);
    let mut heights = vec![0; ends.len()];
    // Down from the top, each as high as it may be, ...
    let mut free = rows.start;
    for &at in &order {
        heights[at] = ends[at].1.max(free);
        free = heights[at] + LABEL_HEIGHT;
    }
    // ... and up from the bottom, where they hang out.
    let mut free = rows.end;
    for &at in order.iter().rev() {
        heights[at] = heights[at].min(free);
        free = heights[at] - LABEL_HEIGHT;
    }
    heights
}
