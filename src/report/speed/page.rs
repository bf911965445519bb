//! The measurements as one page of HTML: for each scene which method to use, the charts, the table and the pictures.
//!
//! The page stands alone: its charts are inline SVG, its pictures `data:` URIs, and it runs nothing. It is well-formed XML as well.

use std::io;

use minijinja::{AutoEscape, Environment, context};
use serde::Serialize;

use super::{
    chart::{against_samples, against_time, shown_errors},
    notation::{asked_error, error, plural, seconds},
    picture::{self, uri},
    results::{Measurement, Shown},
    summary::{heading, listed, notes, printable, table, verdicts},
};

/// What the template fills in for a scene.
#[derive(Serialize)]
struct Section {
    name: String,
    heading: String,
    overrides: Vec<String>,
    verdicts: Vec<String>,
    charts: Vec<Chart>,
    /// What the table shows.
    caption: String,
    heads: Vec<String>,
    rows: Vec<Vec<String>>,
    notes: Vec<String>,
    parts: Option<Parts>,
    whole: Picture,
}

#[derive(Serialize)]
struct Chart {
    /// Not to be escaped.
    svg: String,
    caption: String,
}

/// A part of the picture by every method.
#[derive(Serialize)]
struct Parts {
    title: String,
    /// Where it lies.
    place: String,
    pictures: Vec<Picture>,
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
    Ok(Section {
        name: printable(&measured.subject.name),
        heading: heading(measured),
        overrides: overrides.map(|set| printable(set)).collect(),
        verdicts: verdicts(measured),
        charts: match measured.series.is_empty() {
            true => Vec::new(),
            false => charts(measured),
        },
        caption: caption(measured),
        heads: summary.heads,
        rows: summary.rows,
        notes: notes(measured),
        parts: parts(measured)?,
        whole: whole(measured)?,
    })
}

fn charts(measured: &Measurement) -> Vec<Chart> {
    let errors = shown_errors(measured).into_iter().map(asked_error);
    let errors: Vec<_> = errors.collect();
    let dashed = match errors.as_slice() {
        [] => String::new(),
        [error] => format!(
            " The dashed line is an error of {error}: a method reaches it where its line crosses."
        ),
        errors => format!(
            " Each dashed line is an error, {}: a method reaches it where its line crosses.",
            listed(errors.iter().map(String::as_str))
        ),
    };
    let exact = match measured.exact {
        Some(_) => " Exact makes no error: the vertical line is its time.",
        None => "",
    };
    vec![
        Chart {
            svg: against_time(measured),
            caption: format!("Lower and further to the left is better.{dashed}{exact}"),
        },
        Chart {
            svg: against_samples(measured),
            caption: "How well a method uses its samples: the steeper its line falls, the better. Independent random samples have a slope of −0.5.".to_owned(),
        },
    ]
}

fn caption(measured: &Measurement) -> String {
    let mut fits = measured.series.iter().filter_map(|series| series.fit());
    let slope = match fits.clone().count() {
        0 => "",
        _ if fits.any(|fit| fit.slope_error.is_some()) => {
            " The slope, ± its standard error, says how fast the error falls with the samples."
        }
        _ => " The slope says how fast the error falls with the samples.",
    };
    let samples = match measured.series.is_empty() {
        true => "",
        false => "samples per pixel, ",
    };
    format!("What an error takes: {samples}CPU time and wall time.{slope}")
}

/// The exact picture and those of the methods; nothing if there are none.
fn parts(measured: &Measurement) -> io::Result<Option<Parts>> {
    let shown = measured.series.iter();
    let shown = shown.filter_map(|series| Some((series.method, series.picture.as_ref()?)));
    let shown: Vec<_> = shown.collect();
    let Some(&(first, Shown { part, .. })) = shown.first() else {
        return Ok(None);
    };
    let exact_time = match &measured.exact {
        Some(times) => format!(", {}", seconds(times.cpu(), 2)),
        None => String::new(),
    };
    let mut pictures = vec![Picture {
        uri: uri(&picture::cropped(&measured.reference.film, *part).map_err(io::Error::other)?)?,
        name: "exact",
        about: format!("no error{exact_time}"),
    }];
    for (method, shown) in &shown {
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
    let place = format!(
        "A part of {} × {} pixels, {} from the left and {} from the top, where {} errs most.",
        part.width,
        part.height,
        part.x,
        part.y,
        first.name()
    );
    Ok(Some(match shown.as_slice() {
        [(method, shown)] => Parts {
            title: format!(
                "What {} makes of {} per pixel",
                method.name(),
                plural(shown.per_pixel as usize, "sample")
            ),
            place,
            pictures,
        },
        _ => Parts {
            title: "What each method makes of the same CPU time".to_owned(),
            place: match measured.exact {
                Some(_) => format!("{place} Exact takes a time of its own."),
                None => place,
            },
            pictures,
        },
    }))
}

fn whole(measured: &Measurement) -> io::Result<Picture> {
    let film = picture::reduced(&measured.reference.film).map_err(io::Error::other)?;
    let is_whole = film.width() == measured.whole().width;
    Ok(Picture {
        uri: uri(&film)?,
        name: "the exact picture as a whole",
        about: match is_whole {
            true => "The whole picture.".to_owned(),
            false => format!(
                "The whole picture, reduced to {} × {} pixels.",
                film.width(),
                film.height()
            ),
        },
    })
}
