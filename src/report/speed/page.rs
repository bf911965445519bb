//! The measurements as one page of HTML: for each scene which method to use, the charts, the table and the pictures.
//!
//! The page stands alone: its charts are inline SVG, its pictures `data:` URIs, and it runs nothing. It is well-formed XML as well.

use std::io;

use minijinja::{AutoEscape, Environment, context};
use serde::Serialize;

use super::{
    chart::{against_samples, against_time},
    measurement::Measurement,
    picture,
    summary::{heading, notes, printable, table, verdict},
    units::{error, plural, seconds},
};

/// What the template fills in for a scene.
#[derive(Serialize)]
struct Section {
    name: String,
    heading: String,
    overrides: Vec<String>,
    verdicts: Vec<String>,
    /// SVG, not to be escaped.
    charts: [String; 2],
    heads: Vec<String>,
    rows: Vec<Vec<String>>,
    notes: Vec<String>,
    /// The part that is shown, in words.
    part: String,
    pictures: Vec<Picture>,
    whole: Picture,
}

#[derive(Serialize)]
struct Picture {
    uri: String,
    name: String,
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
    let summary = table(measured);
    let (part, whole) = (measured.crop, measured.whole());
    let verdicts = measured
        .errors
        .iter()
        .map(|&error| verdict(measured, error));
    let overrides = measured.subject.recipe.overrides.iter();
    let (uri, size) = picture::whole(measured)?;
    Ok(Section {
        name: printable(&measured.subject.name),
        heading: heading(measured),
        overrides: overrides.map(|set| printable(set)).collect(),
        verdicts: verdicts.collect(),
        charts: [against_time(measured), against_samples(measured)],
        heads: summary.heads,
        rows: summary.rows,
        notes: notes(measured),
        part: format!(
            "{} × {} pixels, {} from the left and {} from the top",
            part.width, part.height, part.x, part.y
        ),
        pictures: pictures(measured)?,
        whole: Picture {
            uri,
            name: "exact".to_owned(),
            about: match size == whole {
                true => "the whole picture".to_owned(),
                false => format!(
                    "the whole picture, reduced to {} × {} pixels",
                    size.width, size.height
                ),
            },
        },
    })
}

/// The exact picture and those of the methods, as far as there are any.
fn pictures(measured: &Measurement) -> io::Result<Vec<Picture>> {
    let exact = match &measured.exact {
        Some(times) => format!("no error, {}", seconds(times.cpu(), 2)),
        None => "no error".to_owned(),
    };
    let mut pictures = vec![Picture {
        uri: picture::exact(measured)?,
        name: "exact".to_owned(),
        about: exact,
    }];
    for series in &measured.series {
        let Some(shown) = &series.picture else {
            continue;
        };
        pictures.push(Picture {
            uri: picture::sampled(measured, series.method, shown)?,
            name: series.method.name().to_owned(),
            about: format!(
                "error {}, {}, {} per pixel",
                error(shown.rmse),
                seconds(shown.cpu, 2),
                plural(shown.per_pixel as usize, "sample")
            ),
        });
    }
    Ok(pictures)
}
