//! The measurements as one page of HTML: for each scene which method to use, the charts, the table and the pictures.
//!
//! The page stands alone: its charts are inline SVG, its pictures `data:` URIs, and it runs nothing. It is well-formed XML as well.

use std::io;

use minijinja::{AutoEscape, Environment, context};
use serde::Serialize;

use super::{
    chart::{against_samples, against_time, shown_errors},
    notation::{error, plural, seconds},
    picture::{self, uri},
    results::{Measurement, Shown},
    summary::{heading, notes, printable, table, verdicts},
};

/// What the template fills in for a scene.
#[derive(Serialize)]
struct Section {
    name: String,
    heading: String,
    overrides: Vec<String>,
    verdicts: Vec<String>,
    /// SVG, not to be escaped; none without a sampled method.
    charts: Vec<String>,
    /// Whether the charts show errors that are asked for.
    has_dashed_lines: bool,
    /// Whether exact is among the methods.
    has_exact: bool,
    has_slopes: bool,
    has_slope_errors: bool,
    heads: Vec<String>,
    rows: Vec<Vec<String>>,
    notes: Vec<String>,
    /// Which part of the picture is shown of every method.
    part: String,
    /// The exact one first; none without another.
    pictures: Vec<Picture>,
    whole: Picture,
}

#[derive(Serialize)]
struct Picture {
    uri: String,
    name: &'static str,
    about: String,
}

/// The page, with a section for each scene.
pub fn page(measurements: &[Measurement]) -> io::Result<String> {
    let sections = measurements.iter().map(section);
    let sections = sections.collect::<io::Result<Vec<_>>>()?;
    let mut environment = Environment::new();
    environment.set_auto_escape_callback(|_| AutoEscape::Html);
    let context = context! {
        sections,
        style => include_str!("page.css"),
        version => env!("CARGO_PKG_VERSION"),
    };
    let page = environment.render_str(include_str!("page.html"), context);
    page.map_err(io::Error::other)
}

fn section(measured: &Measurement) -> io::Result<Section> {
    let summary = table(measured, &measured.errors);
    let overrides = measured.subject.recipe.overrides.iter();
    let fits = || measured.series.iter().filter_map(|series| series.fit());
    let (part, pictures) = pictures(measured)?;
    Ok(Section {
        name: printable(&measured.subject.name),
        heading: heading(measured),
        overrides: overrides.map(|set| printable(set)).collect(),
        verdicts: verdicts(measured),
        charts: match measured.series.is_empty() {
            true => Vec::new(),
            false => vec![against_time(measured), against_samples(measured)],
        },
        has_dashed_lines: !shown_errors(measured).is_empty(),
        has_exact: measured.exact.is_some(),
        has_slopes: fits().next().is_some(),
        has_slope_errors: fits().any(|fit| fit.slope_error.is_some()),
        heads: summary.heads,
        rows: summary.rows,
        notes: notes(measured),
        part,
        pictures,
        whole: whole(measured)?,
    })
}

/// A part of the picture in words, and as the exact method and the others make it; nothing without the others.
fn pictures(measured: &Measurement) -> io::Result<(String, Vec<Picture>)> {
    let shown = measured.series.iter();
    let shown = shown.filter_map(|series| Some((series.method, series.picture.as_ref()?)));
    let shown: Vec<_> = shown.collect();
    let Some(&(first, &Shown { part, .. })) = shown.first() else {
        return Ok(Default::default());
    };
    let exact = picture::cropped(&measured.reference.film, part).map_err(io::Error::other)?;
    let mut pictures = vec![Picture {
        uri: uri(&exact)?,
        name: "exact",
        about: match &measured.exact {
            Some(times) => format!("no error, {}", seconds(times.cpu(), 2)),
            None => "no error".to_owned(),
        },
    }];
    for (method, shown) in shown {
        pictures.push(Picture {
            uri: uri(&shown.film)?,
            name: method.name(),
            about: format!(
                "error {}, {}, {} per pixel",
                error(shown.rmse),
                seconds(shown.cpu, 2),
                plural(shown.per_pixel as usize, "sample")
            ),
        });
    }
    let part = format!(
        "{} × {} pixels, {} from the left and {} from the top, where {} errs most",
        part.width,
        part.height,
        part.x,
        part.y,
        first.name()
    );
    Ok((part, pictures))
}

fn whole(measured: &Measurement) -> io::Result<Picture> {
    let film = picture::reduced(&measured.reference.film).map_err(io::Error::other)?;
    let (width, height) = (film.width(), film.height());
    Ok(Picture {
        uri: uri(&film)?,
        name: "the exact picture as a whole",
        about: match width == measured.whole().width {
            true => "the whole picture".to_owned(),
            false => format!("the whole picture, reduced to {width} × {height} pixels"),
        },
    })
}
