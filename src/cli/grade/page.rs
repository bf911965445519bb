//! Writes the results of a class as an HTML page. Small pictures are embedded in the page, and the
//! full ones are files beside it.

use std::collections::BTreeMap;

use super::{
    graded::{GradedStudent, JudgedPicture, percent},
    table::figures,
};
use crate::{
    cli::judge::quoted, diagnostic::escaped, film::HEAT_LEGEND, grading::NamedMistake,
    numbers::short,
};

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

/// Path of the scene's exact picture, relative to the HTML page.
pub const EXACT: &str = "pictures/exact.png";

/// Returns the paths of three pictures of the student with this index: the submitted picture, the
/// heat map that shows how it differs from the exact picture, and the exact picture of the same
/// part of the scene.
pub fn names(index: usize) -> [String; 3] {
    ["", "-difference", "-exact"].map(|what| format!("pictures/{}{what}.png", index + 1))
}

/// Returns the HTML page about a class. `total` is the number of points for a right picture.
pub fn page(scene: &str, graded: &[GradedStudent], total: Option<f64>) -> String {
    let scene = escaped(scene);
    let mut html = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>Pictures of {scene}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<main>\n<h1>Pictures of {scene}</h1>\n{}{}",
        summary(graded),
        mistakes(graded) + &equal(graded)
    );
    html += &format!(
        "<p class=\"hint\">Below a picture stands the map of its differences from the exact one ({HEAT_LEGEND}). Press a picture to see it in full, and a heading to sort. Error: root mean square difference from the exact picture, in linear light. Samples: as many independent random samples in each pixel would be as noisy; a wrong picture has no such number.</p>\n\
         <table>\n<thead><tr>{}</tr></thead>\n<tbody>\n",
        headings(total)
    );
    for (index, one) in graded.iter().enumerate() {
        html += &row(index, one, total.is_some());
    }
    html + "</tbody>\n</table>\n</main>\n<dialog aria-label=\"a picture beside the exact one\"><form method=\"dialog\"><h2></h2><button autofocus>close</button></form><div></div></dialog>\n\
            <script>\n"
        + SCRIPT
        + "</script>\n</body>\n</html>\n"
}

/// Returns a summary, as HTML, that counts the students with each verdict.
fn summary(graded: &[GradedStudent]) -> String {
    let kinds = [
        ("right", "right"),
        ("noise", "right but for noise"),
        ("wrong", "wrong"),
        ("unknown", "wrong for unknown reasons"),
        ("error", "not compared"),
    ];
    let counts = kinds.iter().filter_map(|(word, words)| {
        let count = graded.iter().filter(|one| one.word() == *word).count();
        (count > 0).then(|| format!("<span class=\"{word}\">{count} {words}</span>"))
    });
    let counts: Vec<_> = counts.collect();
    format!("<p>{}: {}</p>\n", students(graded.len()), counts.join(", "))
}

fn students(count: usize) -> String {
    match count {
        1 => "1 student".to_owned(),
        count => format!("{count} students"),
    }
}

/// Returns a list of the mistakes, as HTML, with the number of students who made each one. The most
/// frequent mistake comes first.
fn mistakes(graded: &[GradedStudent]) -> String {
    let mut by_id = BTreeMap::<String, Vec<usize>>::new();
    for (index, one) in graded.iter().enumerate() {
        for mistake in one
            .best()
            .iter()
            .flat_map(|judged| &judged.verdict.mistakes)
        {
            let all = by_id.entry(mistake.id.replace('_', " ")).or_default();
            if all.last() != Some(&index) {
                all.push(index);
            }
        }
    }
    if by_id.is_empty() {
        return String::new();
    }
    let mut counted: Vec<_> = by_id.into_iter().collect();
    counted.sort_by_key(|(_, who)| std::cmp::Reverse(who.len()));
    let line = |(id, who): (String, Vec<usize>)| {
        let link = |&index: &usize| {
            format!(
                "<a href=\"#s{}\">{}</a>",
                index + 1,
                escaped(&graded[index].name)
            )
        };
        let links: Vec<_> = who.iter().map(link).collect();
        format!(
            "<li>{}: <b>{}</b> – {}</li>\n",
            students(who.len()),
            escaped(&id),
            links.join(", ")
        )
    };
    let lines: String = counted.into_iter().map(line).collect();
    format!("<h2>Mistakes</h2>\n<ul class=\"mistakes\">\n{lines}</ul>\n")
}

/// Returns sentences, as HTML, that name the students whose pictures are equal.
fn equal(graded: &[GradedStudent]) -> String {
    let is_first = |(index, one): &(usize, &GradedStudent)| {
        let mut before = graded[..*index].iter();
        !one.equal_to.is_empty() && !before.any(|other| one.equal_to.contains(&other.name))
    };
    let line = |(_, one): (usize, &GradedStudent)| {
        let names = [&one.name].into_iter().chain(&one.equal_to);
        let names: Vec<_> = names.map(|name| escaped(name)).collect();
        let names = names.join(", ");
        format!("<p class=\"mark\">The same in every pixel: {names}.</p>\n")
    };
    let firsts = graded.iter().enumerate().filter(is_first);
    firsts.map(line).collect()
}

fn headings(total: Option<f64>) -> String {
    let points = total.map(|total| format!("points of {}", short(total)));
    let names = ["student", "verdict", "error", "samples"].map(str::to_owned);
    let sorted = names.into_iter().chain(points);
    let heading = |name: String| {
        format!("<th scope=\"col\" aria-sort=\"none\"><button type=\"button\">{name}</button></th>")
    };
    let all: Vec<String> = sorted.map(heading).collect();
    // On the page, the column of pictures comes right after the column of students, so the heading
    // `picture` is inserted after the first heading.
    format!(
        "{}<th scope=\"col\">picture</th>{}",
        all[0],
        all[1..].concat()
    )
}

fn row(index: usize, one: &GradedStudent, has_points: bool) -> String {
    let name = escaped(&one.name);
    let pictures = one
        .best()
        .map_or_else(|_| String::new(), |judged| thumbnail(index, &name, judged));
    let mut who = format!("<b>{name}</b>");
    if let Some(number) = &one.number {
        who += &format!("<br><small>{}</small>", escaped(number));
    }
    if one.file() != one.name {
        who += &format!("<br><small>{}</small>", escaped(one.file()));
    }
    let [error, samples] = figures(one);
    let points = match (has_points, one.score) {
        (false, _) => String::new(),
        (true, score) => format!(
            "<td data-label=\"points\">{}</td>",
            score.map_or_else(String::new, short)
        ),
    };
    format!(
        "<tr class=\"{}\" id=\"s{}\"><th scope=\"row\" data-key=\"{name}\">{who}</th><td class=\"picture\">{pictures}</td>\
         <td data-key=\"{}\">{}</td><td data-label=\"error\">{error}</td><td data-label=\"samples\">{samples}</td>{points}</tr>\n",
        one.word(),
        index + 1,
        escaped(&one.line()),
        verdict(one)
    )
}

/// Returns the HTML of a thumbnail that opens the full picture.
fn thumbnail(index: usize, name: &str, judged: &JudgedPicture) -> String {
    let Some(pictures) = &judged.pictures else {
        return String::new();
    };
    let [whole, heat, own] = names(index);
    let exact = match pictures.exact {
        Some(_) => own,
        None => EXACT.to_owned(),
    };
    let [small, small_heat] = &pictures.thumbnails;
    format!(
        "<button type=\"button\" class=\"open\" data-name=\"{name}\" data-picture=\"{whole}\" data-exact=\"{exact}\" data-difference=\"{heat}\">\
         <img alt=\"the picture of {name}, larger\" src=\"{small}\"><img alt=\"where it differs from the exact picture\" src=\"{small_heat}\"></button>"
    )
}

/// Returns the verdict on a student's submission with all details, as HTML.
fn verdict(one: &GradedStudent) -> String {
    let is_explained = one
        .best()
        .is_ok_and(|judged| !judged.verdict.mistakes.is_empty());
    let line = if is_explained {
        // The page lists the mistakes below this summary, so the summary does not repeat them.
        format!("{}{}", one.word(), one.note())
    } else {
        one.line()
    };
    let mut html = format!("<p class=\"line\">{}</p>", escaped(&line));
    if let Ok(judged) = one.best() {
        html += &findings("", &judged.verdict.mistakes);
        html += &findings("a guess: ", &judged.verdict.guesses);
        if let Some(rest) = judged.verdict.rest {
            html += &format!(
                "<p>{} of the difference is not explained.</p>",
                percent(rest)
            );
        }
        if judged.verdict.is_cut {
            html += "<p>The search stopped at its limit before all mistakes were tried: a greater --effort tries more.</p>";
        }
        if !judged.is_right() {
            html += &objects(judged);
        }
        if let Some(warning) = judged.warning {
            html += &format!("<p>Of the file: {}.</p>", escaped(warning));
        }
        if judged.is_ours {
            html +=
                "<p class=\"mark\">It carries the text that Pinhole writes into its pictures.</p>";
        }
    }
    if !one.equal_to.is_empty() {
        html += &format!(
            "<p class=\"mark\">It is the same in every pixel as that of {}.</p>",
            escaped(&one.equal_to.join(", "))
        );
    }
    if !one.not_compared.is_empty() {
        let files = one.not_compared.iter();
        let files: String = files
            .map(|file| format!("<li>{}</li>", escaped(file)))
            .collect();
        html += &format!(
            "<details><summary>{}, not compared</summary><ul>{files}</ul></details>",
            match one.not_compared.len() {
                1 => "1 other file".to_owned(),
                count => format!("{count} other files"),
            }
        );
    }
    let lines: Vec<_> = one.comment().lines().map(escaped).collect();
    html + &format!(
        "<details class=\"comment\"><summary>a comment for the student</summary><pre>{}</pre><button type=\"button\" class=\"copy\">copy</button></details>",
        lines.join("\n")
    )
}

fn findings(before: &str, all: &[NamedMistake]) -> String {
    if all.is_empty() {
        return String::new();
    }
    let item = |one: &NamedMistake| {
        let sets = one
            .set
            .iter()
            .map(|set| format!(" <code>--set {}</code>", escaped(&quoted(set))));
        format!(
            "<li>{before}{} <small>(explains {})</small><br><span class=\"help\">{}</span>{}</li>",
            escaped(&one.message),
            percent(one.explains),
            escaped(&one.help),
            sets.collect::<String>()
        )
    };
    format!("<ul>{}</ul>", all.iter().map(item).collect::<String>())
}

/// Returns a sentence, as HTML, that names the wrong objects and counts the right ones.
fn objects(judged: &JudgedPicture) -> String {
    let all = judged.verdict.objects.iter();
    let right = all.clone().filter(|one| one.is_right).count();
    let wrong = all.filter(|one| !one.is_right).map(|one| {
        let name = match &one.name {
            Some(name) => escaped(name),
            None => format!("the one with the index {}", one.index),
        };
        match one.off.round() {
            0.0 => name,
            off => format!("{name} (off by {off} pixels)"),
        }
    });
    let wrong: Vec<_> = wrong.take(12).collect();
    if wrong.is_empty() {
        return format!("<p>All {right} objects are right.</p>");
    }
    let rest = match right {
        0 => "None is right".to_owned(),
        1 => "1 is right".to_owned(),
        count => format!("{count} are right"),
    };
    let wrong = wrong.join(", ");
    format!("<p>Objects that are not right: {wrong}. {rest}.</p>")
}
