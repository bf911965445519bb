//! An HTML page about measurements: for each scene, recommended methods, charts, a table and
//! pictures.
//!
//! The page is a single file without scripts: its charts are inline SVG, and its pictures are
//! `data:` URIs. It is also well-formed XML.

use std::{fmt::Write, io};

use upon::{Engine, Value, fmt, value};

use super::{
    chart::{against_samples, against_time, shown_errors},
    notation::{error, plural, seconds},
    reasons::reasons,
    results::{Measurement, MethodPicture, Run},
    summary::{heading, notes, printable, table, verdicts},
};
use crate::{
    diagnostic::escaped,
    film::{self, Film, Tolerance},
    numbers,
};

/// Maximum width and height of the whole picture on the page, in pixels. A larger picture is
/// reduced, so that the file stays small. At this size, objects are still seen clearly.
const WHOLE: [u32; 2] = [640, 480];

/// Returns the HTML page. It has a section for each scene.
///
/// # Errors
///
/// Fails if there is not enough memory for the pictures.
pub fn page(measurements: &[Measurement]) -> io::Result<String> {
    let sections = measurements.iter().map(section);
    let sections = sections.collect::<io::Result<Vec<_>>>()?;
    let mut engine = Engine::new();
    // Text is escaped unless the template marks it as HTML.
    engine.set_default_formatter(&write_escaped);
    engine.add_formatter("html", fmt::default);
    let template = engine.compile(include_str!("page.html"));
    let template = template.map_err(io::Error::other)?;
    let values = value! {
        sections: sections,
        style: include_str!("page.css"),
        version: env!("CARGO_PKG_VERSION"),
    };
    let page = template.render_from(&engine, &values).to_string();
    page.map_err(io::Error::other)
}

fn write_escaped(out: &mut fmt::Formatter<'_>, value: &Value) -> fmt::Result {
    match value {
        Value::String(text) => Ok(out.write_str(&escaped(text))?),
        value => fmt::default(out, value),
    }
}

/// Returns the values that the page's template needs for the section about a scene.
fn section(measured: &Measurement) -> io::Result<Value> {
    let summary = table(measured, &measured.errors);
    let overrides = measured.subject.overrides.iter().map(|set| printable(set));
    let slopes = || measured.series.iter().filter_map(|series| series.slope());
    let charts = if measured.series.is_empty() {
        Vec::new()
    } else {
        vec![against_time(measured), against_samples(measured)]
    };
    let Pictures {
        part,
        white,
        pictures,
    } = pictures(measured)?;
    let only_method = match shown_methods(measured)[..] {
        [(name, _)] => name,
        _ => "",
    };
    Ok(value! {
        name: printable(&measured.subject.name),
        heading: heading(measured),
        overrides: overrides.collect::<Vec<_>>().join("; "),
        verdicts: verdicts(measured),
        charts: charts,
        has_dashed_lines: !shown_errors(measured).is_empty(),
        has_exact: measured.exact.is_some(),
        has_slopes: slopes().next().is_some(),
        has_slope_errors: slopes().any(|slope| slope.error.is_some()),
        heads: summary.heads.iter().map(|head| head.replace('\n', " ")).collect::<Vec<_>>(),
        rows: summary.rows,
        notes: notes(measured),
        reasons: reasons(measured),
        white: numbers::short(white.ceil()),
        most: measured.rungs.last().copied().unwrap_or_default(),
        part: part,
        only_method: only_method,
        pictures: pictures,
        whole: whole(measured)?,
    })
}

/// Returns the methods for which a picture was rendered: their names and pictures.
fn shown_methods(measured: &Measurement) -> Vec<(&'static str, &MethodPicture)> {
    let series = measured.series.iter();
    let shown = series.filter_map(|series| Some((series.method.name(), series.picture.as_ref()?)));
    shown.collect()
}

/// Pictures for comparing the methods. All show the same area of the scene's picture.
#[derive(Default)]
struct Pictures {
    /// Description of the area that is shown.
    part: String,
    /// Difference that heat maps show as white, in steps of 8-bit sRGB. It is the largest
    /// difference in the area that is shown, so that differences are seen even if all are small.
    white: f64,
    /// The exact picture, followed by a picture for each method. The list is empty if no method has
    /// a picture.
    pictures: Vec<Value>,
}

fn pictures(measured: &Measurement) -> io::Result<Pictures> {
    let shown = shown_methods(measured);
    let Some(&(first, &MethodPicture { part, .. })) = shown.first() else {
        return Ok(Pictures::default());
    };
    let exact = measured.reference.film.part(part);
    let exact = exact.map_err(io::Error::other)?;
    let largest = |(_, shown): &(_, &MethodPicture)| {
        let found = film::compare(&shown.film, &exact, EVERY_DIFFERENCE);
        found.map(|found| found.largest.steps)
    };
    let largest = shown.iter().map(largest).collect::<Result<Vec<_>, _>>();
    let largest = largest.map_err(io::Error::other)?;
    let white = largest.into_iter().fold(1.0, f64::max);
    let time = measured.exact.as_ref();
    let time = time.map_or(String::new(), |times| {
        format!(", {}", seconds(Run::typical(times).cpu, 2))
    });
    let mut pictures = vec![picture(&exact, None, "exact", format!("no error{time}"))?];
    for (name, shown) in shown {
        let about = format!(
            "error {}, {}, {} per pixel",
            error(shown.rmse),
            seconds(shown.cpu, 2),
            plural(shown.per_pixel as usize, "sample")
        );
        let difference = film::heat_map_up_to(white, &shown.film, &exact, EVERY_DIFFERENCE);
        let difference = difference.map_err(io::Error::other)?;
        pictures.push(picture(&shown.film, Some(&difference), name, about)?);
    }
    let part = format!(
        "{} × {} pixels, {} from the left and {} from the top, where {first} errs most at an edge",
        part.width, part.height, part.x, part.y
    );
    Ok(Pictures {
        part,
        white,
        pictures,
    })
}

/// Tolerance for differences from the exact picture. It is 0, so that heat maps show even the
/// smallest difference.
const EVERY_DIFFERENCE: Tolerance<'_> = Tolerance {
    steps: 0.0,
    bounds: None,
};

fn whole(measured: &Measurement) -> io::Result<Value> {
    let film = film::reduced(&measured.reference.film, WHOLE).map_err(io::Error::other)?;
    let (width, height) = (film.width(), film.height());
    let about = if width == measured.whole().width {
        "the whole picture".to_owned()
    } else {
        format!("the whole picture, reduced to {width} × {height} pixels")
    };
    picture(&film, None, "the exact picture as a whole", about)
}

/// Factor by which the page magnifies the pictures that compare the methods. With 5, single pixels
/// are visible, and pictures of 48 pixels are 240 CSS pixels wide, so that several fit beside each
/// other.
const MAGNIFIED: u32 = 5;

/// Returns the values that the page's template needs for a picture with the title `name` and the
/// caption `about`. `difference` is a heat map of the differences from the exact picture, which is
/// shown below the picture if it is given.
fn picture(film: &Film, difference: Option<&Film>, name: &str, about: String) -> io::Result<Value> {
    let difference = difference.map(film::data_uri).transpose()?;
    Ok(value! {
        uri: film::data_uri(film)?,
        difference: difference.unwrap_or_default(),
        width: MAGNIFIED * film.width(),
        height: MAGNIFIED * film.height(),
        name: name,
        about: about,
    })
}
