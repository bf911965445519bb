//! What was said of a class's pictures as one page of HTML, which stands alone.

use std::{fmt::Write, io};

use super::{
    graded::{Graded, Judged},
    judge::quoted,
    thumbnails::Thumbnails,
};
use crate::{diagnostic::escaped, film::HEAT_LEGEND};

const STYLE: &str = include_str!("grade_page.css");
const SCRIPT: &str = include_str!("grade_page.js");

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
