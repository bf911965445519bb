//! The measurements as one page of HTML: charts, tables, pictures, and how the numbers came about.
//!
//! The page stands alone: its charts are inline SVG, its pictures `data:` URIs, and it runs nothing. It is well-formed XML as well.

use std::{fmt::Write, io};

use super::{
    account::account,
    chart::{against_samples, against_time, escaped},
    export::sha256,
    fit::median,
    measure::{Measurement, Point, Series},
    notes::{notes, spread, verdicts},
    picture,
    table::{cells, doubt, error, marked_slope, plural, samples, seconds, time, tried},
};
use crate::{numbers, scene::Method};

const STYLE: &str = include_str!("page.css");

/// The page, with a section for each scene.
pub fn page(measurements: &[Measurement]) -> io::Result<String> {
    let mut html = format!(
        "<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">\n<head>\n<meta charset=\"utf-8\"/>\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<title>Pinhole: speed against error</title>\n\
         <style>\n{STYLE}</style>\n</head>\n<body>\n<header>\n<h1>Speed against error</h1>\n\
         <p class=\"soft\">How fast the sampling methods of Pinhole {} come how near the exact picture.</p>\n</header>\n<main>\n",
        env!("CARGO_PKG_VERSION")
    );
    for (number, measured) in measurements.iter().enumerate() {
        let class = if number == 0 { " class=\"first\"" } else { "" };
        section(&mut html, measured, class)?;
    }
    html += &account(measurements);
    html += "</main>\n</body>\n</html>\n";
    Ok(html)
}

fn section(html: &mut String, measured: &Measurement, class: &str) -> io::Result<()> {
    let name = escaped(&measured.subject.name);
    *html += &format!("<section>\n<h2{class}>{name}</h2>\n");
    for verdict in verdicts(measured) {
        *html += &format!("<p class=\"lead\">{}.</p>\n", prose(&capital(&verdict)));
    }
    let notes = notes(measured);
    if !notes.is_empty() {
        let items = notes
            .iter()
            .map(|note| format!("<li>{}</li>\n", prose(note)));
        *html += &format!("<ul class=\"notes\">\n{}</ul>\n", items.collect::<String>());
    }
    *html += &facts(measured);
    *html += &whole(measured)?;
    *html += &charts(measured);
    *html += "<h3>The numbers</h3>\n";
    *html += &errors(measured);
    *html += &times(measured);
    *html += &needs(measured);
    pictures(html, measured)?;
    *html += "</section>\n";
    Ok(())
}

fn charts(measured: &Measurement) -> String {
    let bound = prose(&numbers::at_most(measured.reference.bound()));
    let is_tried = measured
        .series
        .iter()
        .any(|series| !series.tries.is_empty());
    let tried = match is_tried {
        true => " Markers off the lines are single runs that try what an error takes.",
        false => "",
    };
    format!(
        "<figure>\n<div class=\"wide\">{}</div><figcaption>Error against the time of a render. Lower and further to the left is better. \
         The exact method's error lies below the chart: it is within {bound}.</figcaption>\n</figure>\n\
         <figure>\n<div class=\"wide\">{}</div><figcaption>Error against samples per pixel. The number beside a name is the slope of the \
         straight line through all planned points; its ± covers the slopes between any two points of which one has at least twice the samples of the other. −0.5 is that of \
         independent samples, about −0.75 the best that a slanted edge allows.{tried}</figcaption>\n\
         </figure>\n",
        against_time(measured),
        against_samples(measured)
    )
}

/// Text in which no line's end breaks a number with an exponent.
pub(super) fn prose(text: &str) -> String {
    let whole =
        |word: &str| match word.contains("e-") && word.starts_with(|c: char| c.is_ascii_digit()) {
            true => format!("<span class=\"number\">{word}</span>"),
            false => word.to_owned(),
        };
    let words: Vec<_> = escaped(text).split(' ').map(whole).collect();
    words.join(" ")
}

fn facts(measured: &Measurement) -> String {
    let (whole, machine) = (measured.whole(), &measured.machine);
    let mut facts = vec![
        (
            "scene",
            format!("SHA-256 {}", sha256(&measured.subject.recipe.scene)),
        ),
        (
            "picture",
            format!("{} × {} pixels", whole.width, whole.height),
        ),
        (
            "runs",
            format!(
                "{} of each method and number of samples, with the seeds from {} on",
                measured.rounds(),
                measured.seed
            ),
        ),
        (
            "machine",
            format!(
                "{} on {}, of which the program may use {}",
                plural(measured.threads as u64, "thread"),
                machine.processor,
                plural(machine.processors as u64, "processor")
            ),
        ),
        (
            "reference",
            format!(
                "method exact, every channel within {} of the true mean",
                numbers::at_most(measured.reference.bound())
            ),
        ),
        ("duration", format!("{} in all", seconds(measured.seconds))),
    ];
    if !measured.subject.recipe.overrides.is_empty() {
        facts.insert(1, ("changed", measured.subject.recipe.overrides.join("; ")));
    }
    let items = facts
        .iter()
        .map(|(name, fact)| format!("<dt>{name}</dt><dd>{}</dd>\n", prose(fact)));
    format!("<dl class=\"facts\">\n{}</dl>\n", items.collect::<String>())
}

/// The exact picture as a whole.
fn whole(measured: &Measurement) -> io::Result<String> {
    let (uri, size) = picture::whole(measured)?;
    let whole = measured.whole();
    let scaled = match size == whole {
        true => String::new(),
        false => format!(
            ", at {} × {} of its {} × {} pixels",
            size.width, size.height, whole.width, whole.height
        ),
    };
    Ok(format!(
        "<figure class=\"whole\">{}<figcaption>What is rendered: the exact picture{scaled}.</figcaption></figure>\n",
        image(&uri, "the exact picture as a whole")
    ))
}

fn errors(measured: &Measurement) -> String {
    let rows = measured.series.iter().map(|series| {
        let mut row = cells(measured, series, |point| error(point.error()));
        row.push(error(
            series.points.last().map_or(0.0, |point| point.largest),
        ));
        row.push(marked_slope(series));
        (series.method.name(), row)
    });
    let bound = numbers::at_most(measured.reference.bound());
    let rungs = measured.rungs.len();
    let exact = measured
        .exact
        .as_ref()
        .map(|_| format!("<td colspan=\"{rungs}\"></td><td>≤ {bound}</td><td></td>"));
    let mut names = rung_names(measured);
    names.extend(["largest".to_owned(), "slope".to_owned()]);
    table(
        "Error: the root of the mean squared difference to the exact picture in linear light (white is 1), by samples per pixel; the \
         largest difference of any channel with the most samples; the slope of log error against log samples, whose ± covers its standard error and \
         the slope between any two points of the chart of which one has at least twice the samples of the other.",
        &names,
        rows,
        exact,
    )
}

fn times(measured: &Measurement) -> String {
    let rows = measured.series.iter().map(|series| {
        let mut row = cells(measured, series, |point| ranged(&point.times));
        let last = series.points.last();
        for rate in [Point::samples_per_second, Point::rays_per_second] {
            row.push(format!("{:.1}", last.map_or(0.0, rate) / 1e6));
        }
        (series.method.name(), row)
    });
    let rungs = measured.rungs.len();
    let exact = measured.exact.as_ref().map(|exact| {
        let time = ranged(&exact.times);
        format!("<td class=\"any\" colspan=\"{rungs}\">{time}</td><td></td><td></td>")
    });
    let mut names = rung_names(measured);
    names.extend(["million samples/s", "million rays/s"].map(str::to_owned));
    table(
        "Time: the median of the runs, ± half of the distance from the least to the greatest, by samples per pixel; the rates with \
         the most samples, of all of them, and of those that are traced: where pixels are certain to show one colour, none is. The exact method takes no samples.",
        &names,
        rows,
        exact,
    )
}

/// A median time with half its spread, if there are several.
fn ranged(times: &[f64]) -> String {
    let time = seconds(median(times));
    match times.len() {
        0 | 1 => time,
        _ => format!("{time} ± {:.0} %", spread(times) * 50.0),
    }
}

/// A table for each error that is asked for.
fn needs(measured: &Measurement) -> String {
    let caption = "What an error takes: samples per pixel by the lines between the points, or by tries with about as many, and the factor up to which that holds for \
                   19 renders of 20; and their time. A star marks what lies beyond the measured range; where answers were tried, the last column is what that left of the error.";
    let errors = measured.errors.iter().enumerate();
    let tables = errors.map(|(at, &wanted)| {
        let same = format!("The same for an error of {}.", error(wanted));
        let caption = if at == 0 { caption } else { &same };
        needs_for(measured, wanted, caption)
    });
    tables.collect()
}

fn needs_for(measured: &Measurement, wanted: f64, caption: &str) -> String {
    let is_tried = |series: &Series| series.tries_for(wanted).next().is_some();
    let is_tried = measured.series.iter().any(is_tried);
    let none = || "–".to_owned();
    let cells = |series: &Series| {
        let needed = measured.needed(series, wanted);
        let mark = |text: String| match needed.is_some_and(|needed| needed.is_extrapolated) {
            true => format!("{text}*"),
            false => text,
        };
        let samples =
            needed.map(|needed| mark(format!("{} × ÷ {}", samples(&needed), doubt(&needed))));
        let time = needed.map(|needed| mark(time(&needed)));
        let mut cells = vec![samples.unwrap_or_else(none), time.unwrap_or_else(none)];
        cells.extend(is_tried.then(|| tried(series, wanted).unwrap_or_else(none)));
        cells
    };
    let rows = measured.series.iter();
    let rows = rows.map(|series| (series.method.name(), cells(series)));
    let exact = measured.exact.as_ref().map(|_| {
        let time = measured.exact_seconds(wanted).map_or_else(none, seconds);
        let tried = if is_tried { "<td></td>" } else { "" };
        format!("<td>–</td><td>{time}</td>{tried}")
    });
    let asked = error(wanted);
    let mut names = vec![format!("samples for {asked}"), format!("time for {asked}")];
    names.extend(is_tried.then(|| "tries: samples, errors".to_owned()));
    table(caption, &names, rows, exact)
}

fn rung_names(measured: &Measurement) -> Vec<String> {
    measured.rungs.iter().map(u64::to_string).collect()
}

fn table(
    caption: &str,
    names: &[String],
    rows: impl Iterator<Item = (&'static str, Vec<String>)>,
    exact: Option<String>,
) -> String {
    let mut html = format!(
        "<div class=\"wide\"><table>\n<caption><span>{caption}</span></caption>\n<thead><tr><th scope=\"col\">method</th>"
    );
    for name in names {
        let _ = write!(html, "<th scope=\"col\">{name}</th>");
    }
    html += "</tr></thead>\n<tbody>\n";
    for (name, row) in rows {
        let _ = write!(html, "<tr><th scope=\"row\">{name}</th>");
        for cell in row {
            let _ = write!(html, "<td>{cell}</td>");
        }
        html += "</tr>\n";
    }
    if let Some(cells) = exact {
        let _ = writeln!(
            html,
            "<tr class=\"exact\"><th scope=\"row\">exact</th>{cells}</tr>"
        );
    }
    html + "</tbody>\n</table></div>\n"
}

/// The crops and their errors; those of an interrupted report are shown as far as there are any.
fn pictures(html: &mut String, measured: &Measurement) -> io::Result<()> {
    let part = picture::crop(measured);
    let whole = measured.whole();
    *html += "<h3>The pictures</h3>\n";
    let what = match part == whole {
        true => "The picture".to_owned(),
        false => format!(
            "{} × {} of the {} × {} pixels, {} from the left and {} from the top, where the methods are most wrong,",
            part.width, part.height, whole.width, whole.height, part.x, part.y
        ),
    };
    if measured
        .series
        .iter()
        .any(|series| series.picture.is_some())
    {
        *html += &format!(
            "<p>{what} by each method with {} per pixel (seed {}), and below it where it is wrong: the largest difference of a pixel's \
             channels to the exact picture, on a logarithmic scale.</p>\n",
            plural(measured.shown, "sample"),
            measured.seed
        );
        *html += &scale();
    }
    *html += "<div class=\"pictures\">\n";
    let reference = &measured.reference.film;
    *html += &format!(
        "<figure>{}<figcaption>exact, within {}</figcaption></figure>\n",
        image(
            &picture::shown(measured, reference, Method::Exact, part)?,
            "the exact picture"
        ),
        numbers::at_most(measured.reference.bound())
    );
    for series in &measured.series {
        let Some(film) = &series.picture else {
            continue;
        };
        let name = series.method.name();
        let point = series
            .points
            .iter()
            .find(|point| point.per_pixel == measured.shown);
        let of_first_run = point.and_then(|point| point.rmse.first()).copied();
        *html += &format!(
            "<figure>{}{}<figcaption>{name}, error {} in this run</figcaption></figure>\n",
            image(
                &picture::shown(measured, film, series.method, part)?,
                &format!("the picture by {name}")
            ),
            image(
                &picture::heat(film, reference, part)?,
                &format!(
                    "a map of the errors of {name}: largest along the edges of objects and squares"
                )
            ),
            error(of_first_run.unwrap_or(0.0))
        );
    }
    *html += "</div>\n";
    Ok(())
}

/// What the colours of the errors mean.
fn scale() -> String {
    let items = picture::scale().map(|(name, color)| {
        format!(
            "<li><svg viewBox=\"0 0 10 10\" aria-hidden=\"true\"><rect width=\"10\" height=\"10\" fill=\"{color}\" stroke=\"#888\"/></svg>\
             {name}</li>\n"
        )
    });
    format!("<ul class=\"scale\">\n{}</ul>\n", items.collect::<String>())
}

fn image(uri: &str, text: &str) -> String {
    format!("<img src=\"{uri}\" alt=\"{text}\"/>")
}

fn capital(sentence: &str) -> String {
    let mut letters = sentence.chars();
    match letters.next() {
        Some(first) => first.to_uppercase().chain(letters).collect(),
        None => String::new(),
    }
}
