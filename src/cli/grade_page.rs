//! What was said of a class's pictures as one page of HTML, which stands alone.

use std::{fmt::Write, io};

use base64::{Engine, prelude::BASE64_STANDARD};
use pinhole::film::{self, Film, HEAT_LEGEND, Tolerance};

use super::{
    grade::{Graded, Judged},
    judge::quoted,
};

const STYLE: &str = include_str!("grade_page.css");
const SCRIPT: &str = include_str!("grade_page.js");

/// The widest thumbnail, in pixels.
const WIDEST: u32 = 320;

/// The page.
pub fn page(scene: &str, graded: &[Graded]) -> io::Result<String> {
    let mut html = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>Pictures of {scene}</title>\n<style>\n{STYLE}</style>\n\
         </head>\n<body>\n<h1>Pictures of {scene}</h1>\n<p>{} pictures, compared with the exact one. Point at a picture to see where it differs; \
         press a heading to sort. The map of differences is {HEAT_LEGEND}.</p>\n<table>\n<thead><tr><th>picture<th>name<th>verdict<th>error<th>samples</tr></thead>\n<tbody>\n",
        graded.len(),
        scene = escaped(scene)
    );
    for one in graded {
        let [name, verdict, error, samples] = one.cells().map(|cell| escaped(&cell));
        let (mut pictures, mut sets, mut word) = (String::new(), String::new(), "error");
        if let Ok(Judged {
            verdict,
            thumbnails,
            ..
        }) = &one.result
        {
            word = verdict.kind.word();
            if let Some(Thumbnails { picture, heat }) = thumbnails {
                pictures = format!(
                    "<img alt=\"\" src=\"{picture}\"><img alt=\"where it differs\" class=\"heat\" src=\"{heat}\">"
                );
            }
            for set in verdict.mistakes.iter().flat_map(|mistake| &mistake.set) {
                write!(sets, "<br><code>--set {}</code>", escaped(&quoted(set)))
                    .map_err(io::Error::other)?;
            }
        }
        writeln!(
            html,
            "<tr class=\"{word}\"><td class=\"picture\">{pictures}<td>{name}<td>{verdict}{sets}<td>{error}<td>{samples}</tr>"
        )
        .map_err(io::Error::other)?;
    }
    write!(
        html,
        "</tbody>\n</table>\n<script>\n{SCRIPT}</script>\n</body>\n</html>\n"
    )
    .map_err(io::Error::other)?;
    Ok(html)
}

/// A picture and its heat map, as `data:` URIs.
pub struct Thumbnails {
    picture: String,
    heat: String,
}

impl Thumbnails {
    /// Of a picture and the exact one.
    pub fn new(film: &Film, exact: &Film, tolerance: Tolerance) -> io::Result<Self> {
        let heat = film::heat_map(film, exact, tolerance).map_err(io::Error::other)?;
        Ok(Self {
            picture: data(film)?,
            heat: data(&heat)?,
        })
    }
}

/// A picture as a `data:` URI, of some pixels' means where it is large.
fn data(film: &Film) -> io::Result<String> {
    let factor = film.width().div_ceil(WIDEST);
    let (width, height) = (film.width() / factor, (film.height() / factor).max(1));
    let small = Film::from_fn(width, height, |x, y| {
        let mut sum = [0.0; 3];
        let mut count = 0.0;
        for row in (y * factor..(y + 1) * factor).take_while(|row| *row < film.height()) {
            for column in x * factor..(x + 1) * factor {
                let pixel = film.pixel(column, row);
                sum = [0, 1, 2].map(|i| sum[i] + pixel[i]);
                count += 1.0;
            }
        }
        sum.map(|sum| sum / count)
    });
    let small = small.map_err(io::Error::other)?;
    let mut png = Vec::new();
    film::write_plain_png(&small, &mut png)?;
    Ok(format!(
        "data:image/png;base64,{}",
        BASE64_STANDARD.encode(png)
    ))
}

fn escaped(text: &str) -> String {
    pinhole::diagnostic::visible(text)
        .replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}
