//! Error against time and against samples, as SVG.
//!
//! Both axes are logarithmic. A line is labelled at its end, so that nobody has to look up a legend, and its marker and dash say in
//! black and white what its colour says otherwise. Black is written as the current colour, so that a page may be dark.

use plotters::{
    coord::Shift,
    element::DashedPathElement,
    prelude::{
        BLACK, BindKeyPoints, ChartBuilder, Color, DrawingArea, DrawingAreaErrorKind,
        DrawingBackend, IntoDrawingArea, IntoFont, IntoLogRange, PathElement, SVGBackend, Text,
    },
    style::{
        TextStyle,
        text_anchor::{HPos, Pos, VPos},
    },
};

use super::{
    fit::median,
    marker::{Look, Place},
    measure::{Measurement, Point},
    table::{error, marked_slope, seconds},
    ticks::{Ticks, ends, tick},
};
use crate::numbers;

/// What drawing yields.
pub(super) type Drawn<DB> = Result<(), DrawingAreaErrorKind<<DB as DrawingBackend>::ErrorType>>;

/// The size of a chart in pixels.
const SIZE: (u32, u32) = (860, 540);

/// Room at the right for a label of so many characters.
fn label_room(characters: usize) -> i32 {
    44 + 8 * characters as i32
}

/// Labels are at least so far apart.
const LABEL_HEIGHT: i32 = 18;

/// Above the plot, for the title.
const TOP: i32 = 44;

const SMALL: f64 = 15.0;

/// A letter of a small text is about so wide.
const LETTER: i32 = 7;

/// What a chart shows.
struct Chart {
    title: String,
    /// For those who cannot see it.
    description: String,
    x_name: &'static str,
    x_ticks: Ticks,
    y_ticks: Ticks,
    write_x: fn(f64) -> String,
    lines: Vec<Line>,
    /// Errors that are asked for.
    wanted: Vec<f64>,
    /// The exact method's time and label.
    exact: Option<(f64, String)>,
}

struct Line {
    look: Look,
    label: String,
    /// Those that the line goes through.
    points: Vec<(f64, f64)>,
    /// Single tries, which have a marker each.
    tries: Vec<(f64, f64)>,
}

impl Line {
    /// All that has a marker.
    fn marked(&self) -> impl Iterator<Item = (f64, f64)> {
        self.points.iter().chain(&self.tries).copied()
    }
}

/// The chart of error against time. The exact method, whose error is off the scale, is a vertical line.
pub fn against_time(measured: &Measurement) -> String {
    let lines = lines(measured, Point::seconds, |measured, at| {
        measured.series[at].method.name().to_owned()
    });
    let exact = measured.exact.as_ref().map(|exact| {
        let time = median(&exact.times);
        let bound = numbers::at_most(measured.reference.bound());
        (time, format!("exact: {}, within {bound}", seconds(time)))
    });
    let times = lines
        .iter()
        .flat_map(|line| line.marked().map(|point| point.0));
    let x_ticks = Ticks::round(times.chain(exact.iter().map(|exact| exact.0)));
    let summary = exact
        .as_ref()
        .map_or(String::new(), |(_, label)| format!(" {label}."));
    draw(&Chart {
        title: "Error against time".to_owned(),
        description: format!(
            "Error against rendering time of {}, both logarithmic, a line for each sampling method.{summary}",
            measured.subject.name
        ),
        x_name: "time of a render (median)",
        x_ticks,
        y_ticks: y_ticks(measured, &lines),
        write_x: |time| match time < 0.9995 {
            true => format!("{} ms", tick(time * 1e3)),
            false => format!("{} s", tick(time)),
        },
        lines,
        wanted: measured.errors.clone(),
        exact,
    })
}

/// The chart of error against samples per pixel, with the slopes.
pub fn against_samples(measured: &Measurement) -> String {
    let lines = lines(
        measured,
        |point| point.per_pixel as f64,
        |measured, at| {
            let series = &measured.series[at];
            format!("{}  {}", series.method.name(), marked_slope(series))
        },
    );
    let rungs: Vec<_> = measured.rungs.iter().map(|&rung| rung as f64).collect();
    let samples = lines.iter().flat_map(Line::marked);
    let most = samples.map(|point| point.0).fold(0.0, f64::max);
    draw(&Chart {
        title: "Error against samples, with the slopes".to_owned(),
        description: format!(
            "Error against samples per pixel of {}, both logarithmic, a line for each sampling method.",
            measured.subject.name
        ),
        x_name: "samples per pixel",
        x_ticks: Ticks::at(&rungs, most),
        y_ticks: y_ticks(measured, &lines),
        write_x: |samples| format!("{samples}"),
        lines,
        wanted: measured.errors.clone(),
        exact: None,
    })
}

fn lines(
    measured: &Measurement,
    x: fn(&Point) -> f64,
    label: fn(&Measurement, usize) -> String,
) -> Vec<Line> {
    let line = |at: usize| {
        let series = &measured.series[at];
        // An error of 0 has no place on a logarithmic axis.
        let place = |point: &Point| Some((x(point), point.error())).filter(|&(_, y)| y > 0.0);
        Line {
            look: Look::of(series.method),
            label: label(measured, at),
            points: series.points.iter().filter_map(place).collect(),
            tries: series
                .tries
                .iter()
                .filter_map(|it| place(&it.point))
                .collect(),
        }
    };
    (0..measured.series.len())
        .map(line)
        .filter(|line| !line.points.is_empty())
        .collect()
}

/// The axis of the errors shows also those that are asked for, unless they are far away.
fn y_ticks(measured: &Measurement, lines: &[Line]) -> Ticks {
    let errors: Vec<_> = lines
        .iter()
        .flat_map(|line| line.marked().map(|point| point.1))
        .collect();
    let (low, high) = ends(errors.iter().copied());
    let near = |&&wanted: &&f64| wanted > low / 30.0 && wanted < high * 30.0;
    let wanted = measured.errors.iter().filter(near);
    Ticks::round(errors.iter().chain(wanted).copied())
}

fn draw(chart: &Chart) -> String {
    let mut svg = String::new();
    // Into a string: nothing can go wrong but the layout of text, and no text is laid out.
    let done = draw_on(
        SVGBackend::with_string(&mut svg, SIZE).into_drawing_area(),
        chart,
    );
    debug_assert!(done.is_ok(), "{done:?}");
    let opening = format!(
        "<svg class=\"chart\" role=\"img\" aria-label=\"{}\" ",
        escaped(&chart.description)
    );
    let style = "<style>.chart{color:#111;background:#fff;font-variant-numeric:tabular-nums}\
                 @media(prefers-color-scheme:dark){.chart{color:#ddd;background:#181818}}\
                 @media print{.chart{color:#000;background:#fff}}</style>\n";
    svg.replacen("<svg ", &opening, 1)
        .replacen(
            ">\n",
            &format!(">\n<title>{}</title>\n{style}", escaped(&chart.title)),
            1,
        )
        .replace("#000000", "currentColor")
}

/// Text as it stands in XML.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

fn draw_on<DB: DrawingBackend>(area: DrawingArea<DB, Shift>, chart: &Chart) -> Drawn<DB> {
    let axis = |ticks: &Ticks| {
        (ticks.ends.0..ticks.ends.1)
            .log_scale()
            .with_key_points(ticks.major.clone())
            .with_light_points(ticks.minor.clone())
    };
    let labels = chart.lines.iter().map(|line| line.label.chars().count());
    let longest = labels.max().unwrap_or(0);
    let mut plot = ChartBuilder::on(&area)
        .margin_top(TOP)
        .margin_right(label_room(longest))
        .margin_left(4)
        .margin_bottom(4)
        .x_label_area_size(48)
        .y_label_area_size(70)
        .build_cartesian_2d(axis(&chart.x_ticks), axis(&chart.y_ticks))?;
    plot.configure_mesh()
        .x_label_formatter(&|x| (chart.write_x)(*x))
        .y_label_formatter(&|y| tick(*y))
        .label_style(text(SMALL))
        .axis_desc_style(text(SMALL))
        .x_desc(chart.x_name)
        .y_desc("error (RMSE, linear light)")
        .axis_style(BLACK.mix(0.6))
        .bold_line_style(BLACK.mix(0.18))
        .light_line_style(BLACK.mix(0.07))
        .draw()?;
    let (columns, rows) = plot.plotting_area().get_pixel_range();
    area.draw(&Text::new(
        chart.title.clone(),
        (columns.start, 12),
        TextStyle::from(("sans-serif", 20.0).into_font()),
    ))?;
    let place = |x: f64, y: f64| plot.backend_coord(&(x, y));
    for &wanted in &chart.wanted {
        let (low, high) = chart.y_ticks.ends;
        if (low..=high).contains(&wanted) {
            let (_, y) = place(chart.x_ticks.ends.0, wanted);
            let ends = [(columns.start, y), (columns.end, y)];
            area.draw(&dashed(ends))?;
            let label = text(SMALL).pos(Pos::new(HPos::Left, VPos::Bottom));
            area.draw(&Text::new(error(wanted), (columns.start + 6, y), label))?;
        }
    }
    if let Some((time, label)) = &chart.exact {
        let (x, _) = place(*time, chart.y_ticks.ends.0);
        draw_exact(&area, x, label, &columns, &rows)?;
    }
    let lines: Vec<Vec<Place>> = chart
        .lines
        .iter()
        .map(|line| line.points.iter().map(|&(x, y)| place(x, y)).collect())
        .collect();
    for (line, places) in chart.lines.iter().zip(&lines) {
        line.look.line(&area, places)?;
        let tries = line.tries.iter().map(|&(x, y)| place(x, y));
        for place in places.iter().copied().chain(tries) {
            line.look.marker(&area, place)?;
        }
    }
    let ends: Vec<_> = lines
        .iter()
        .filter_map(|places| places.last().copied())
        .collect();
    let heights = spread_out(&ends, &rows);
    for ((line, &end), height) in chart.lines.iter().zip(&ends).zip(heights) {
        let marker = (columns.end + 22, height);
        let leader = vec![
            (end.0 + 7, end.1),
            (columns.end + 6, height),
            (marker.0 - 8, height),
        ];
        area.draw(&PathElement::new(leader, line.look.color.mix(0.45)))?;
        line.look.marker(&area, marker)?;
        let label = text(SMALL).pos(Pos::new(HPos::Left, VPos::Center));
        area.draw(&Text::new(
            line.label.clone(),
            (marker.0 + 10, height),
            label,
        ))?;
    }
    area.present()
}

/// The vertical line of the exact method, with an arrow to where its error lies, and the label where the lines of the others are not:
/// they come from the top left and go to the bottom right.
fn draw_exact<DB: DrawingBackend>(
    area: &DrawingArea<DB, Shift>,
    x: i32,
    label: &str,
    columns: &std::ops::Range<i32>,
    rows: &std::ops::Range<i32>,
) -> Drawn<DB> {
    area.draw(&PathElement::new(
        vec![(x, rows.start), (x, rows.end - 2)],
        BLACK.stroke_width(2),
    ))?;
    let arrow = vec![
        (x - 6, rows.end - 12),
        (x, rows.end - 2),
        (x + 6, rows.end - 12),
    ];
    area.draw(&PathElement::new(arrow, BLACK.stroke_width(2)))?;
    let is_left = x < (columns.start + columns.end) / 2;
    let y = if is_left {
        rows.end - 22
    } else {
        rows.start + 14
    };
    let width = LETTER * label.chars().count() as i32;
    let (side, dx) = match x - columns.start > width + 10 {
        true => (HPos::Right, -10),
        false => (HPos::Left, 10),
    };
    let style = text(SMALL).pos(Pos::new(side, VPos::Center));
    area.draw(&Text::new(label.to_owned(), (x + dx, y), style))
}

fn dashed(ends: [Place; 2]) -> DashedPathElement<std::array::IntoIter<Place, 2>, i32> {
    DashedPathElement::new(ends, 4, 4, BLACK.mix(0.6))
}

fn text(size: f64) -> TextStyle<'static> {
    TextStyle::from(("sans-serif", size).into_font())
}

/// Heights for labels near the ends of their lines, in the order of the ends, none upon another.
fn spread_out(ends: &[Place], rows: &std::ops::Range<i32>) -> Vec<i32> {
    let mut order: Vec<_> = (0..ends.len()).collect();
    order.sort_by_key(|&at| ends[at].1);
    let mut heights: Vec<i32> = order.iter().map(|&at| ends[at].1).collect();
    // Groups of labels that touch are centred on the mean of their ends, until no two touch.
    let mut groups: Vec<(f64, usize)> = Vec::new();
    for &height in &heights {
        groups.push((f64::from(height), 1));
        while let [.., (above, n), (below, m)] = groups[..] {
            let distance = f64::from(LABEL_HEIGHT) * (n + m) as f64 / 2.0;
            if below - above >= distance {
                break;
            }
            let mean = (above * n as f64 + below * m as f64) / (n + m) as f64;
            groups.truncate(groups.len() - 2);
            groups.push((mean, n + m));
        }
    }
    let mut at = 0;
    for (mean, count) in groups {
        for k in 0..count {
            let offset = k as f64 - (count as f64 - 1.0) / 2.0;
            heights[at] = (mean + offset * f64::from(LABEL_HEIGHT)) as i32;
            at += 1;
        }
    }
    // Those that hang out at the bottom move up.
    let mut limit = rows.end - 4;
    for height in heights.iter_mut().rev() {
        *height = (*height).min(limit);
        limit = *height - LABEL_HEIGHT;
    }
    let mut result = vec![0; ends.len()];
    for (&at, height) in order.iter().zip(heights) {
        result[at] = height;
    }
    result
}
