//! Writes a drawing as SVG.
//!
//! In: marks in the order in which they are drawn, and labels with the points that they name. Out:
//! the file. Labels are placed last, so that they cover neither marks nor each other. Every length
//! is written with one decimal, so that the bytes are the same on every machine.
//!
//! The style sheet has no CSS variables, which printing programs such as librsvg do not support.
//! The colours are those of Okabe and Ito. On white they are darkened until letters have a contrast
//! of 4.5 to 1.

use std::fmt::Write;

use glam::DVec2;

use crate::{color::Color, editor::viewport::clip, numbers};

/// Width of every figure, in SVG units. A unit is half a point if a page shows the figure 12 cm
/// wide.
pub const WIDTH: f64 = 680.0;

/// Font size, in SVG units. On a page that shows the figure 12 cm wide, letters have 9 points.
const LETTERS: f64 = 18.0;

/// Width of a letter and height of a line, in SVG units, from which the sizes of labels are
/// estimated. The width is the mean in wide typefaces such as DejaVu Sans.
const LETTER: DVec2 = DVec2::new(10.2, 21.0);

/// Style sheet of every figure, for its CSS classes.
const STYLE: &str = "\
text{font:18px Helvetica,Arial,'DejaVu Sans',sans-serif;fill:currentColor;stroke:#fff;stroke-width:5px;stroke-linejoin:round;paint-order:stroke}\
tspan{font-style:italic}.strong{font-weight:bold}\
path{fill:none;stroke:currentColor;stroke-width:2;stroke-linejoin:round;stroke-linecap:round}\
circle{fill:currentColor}.seen{stroke:currentColor;stroke-width:1.5}\
.fill{stroke:none;fill-opacity:.4}.swatch{stroke:none}\
.paper{fill:#fff}.ink{color:#1b1f24}.faint{color:#59636e}path.faint{stroke-width:.8;stroke-opacity:.5}path.cell{stroke-width:1.6;stroke-opacity:.8}\
.blue{color:#0067a3}.red{color:#b34700}.green{color:#00735a}.dash{stroke-dasharray:6 5}\
@media(prefers-color-scheme:dark){.paper{fill:#15181d}.fill{fill-opacity:.65}text{stroke:#15181d}.ink{color:#eceff4}.faint{color:#a3adb8}\
.blue{color:#6cc0f5}.red{color:#f5a05a}.green{color:#3fcfa5}}";

/// Empty rows that a cropped figure keeps above and below what is drawn, in SVG units.
const MARGIN: f64 = 12.0;

/// Cost of a label that covers one segment of a mark. For comparison, moving a label one step
/// farther away from its point costs 6. A label is placed where its total cost is least.
const MARK: f64 = 40.0;

/// Cost of a label that covers one of a filled polygon's diagonals, about four of which stand for
/// the polygon's area. The cost is a little more than that of one step farther away, so that a
/// label leaves the polygon if there is room near it.
const FILL: f64 = 7.0;

/// A drawing that is being built.
pub struct Canvas {
    size: DVec2,
    /// Top and bottom of what is drawn, except for paths in SVG notation.
    rows: [f64; 2],
    marks: String,
    /// Segments that labels should not cover, each with the cost of covering it.
    obstacles: Vec<([DVec2; 2], f64)>,
    /// Labels beside points. For each: CSS class, point, preferred direction from the point to the
    /// label, and text.
    labels: Vec<(&'static str, DVec2, DVec2, String)>,
}

impl Canvas {
    /// Returns an empty drawing of the given height, in SVG units.
    pub fn new(height: f64) -> Self {
        Self {
            size: DVec2::new(WIDTH, height),
            rows: [height, 0.0],
            marks: String::new(),
            obstacles: Vec::new(),
            labels: Vec::new(),
        }
    }

    /// Draws a polygonal line through `points`, in the CSS class `class`. Labels avoid it.
    pub fn line(&mut self, class: &str, points: &[DVec2]) {
        let cost = if class.contains("faint") { 1.5 } else { MARK };
        let segments = points.windows(2).map(|ends| ([ends[0], ends[1]], cost));
        self.obstacles.extend(segments);
        self.path(class, points, "");
    }

    /// Fills a polygon with a colour of the scene.
    pub fn fill(&mut self, class: &str, color: Color, points: &[DVec2]) {
        let half = points.len() / 2;
        let diagonals = (0..half).step_by((half / 4).max(1));
        let diagonals = diagonals.map(|at| ([points[at], points[at + half]], FILL));
        self.obstacles.extend(diagonals);
        self.path(class, points, &format!(" style=\"fill:{color}\""));
    }

    fn path(&mut self, class: &str, points: &[DVec2], more: &str) {
        points.iter().for_each(|point| self.cover(point.y, point.y));
        let mut path = String::new();
        for (point, command) in points.iter().zip("M".chars().chain(std::iter::repeat('L'))) {
            let _ = write!(path, "{command}{}", pair(*point));
        }
        self.raw_path(class, &path, more);
    }

    /// Draws a path, given in SVG notation. `more` contains further attributes of the SVG element.
    /// Labels may cover the path.
    pub fn raw_path(&mut self, class: &str, path: &str, more: &str) {
        if !path.is_empty() {
            let _ = writeln!(self.marks, "<path class=\"{class}\"{more} d=\"{path}\"/>");
        }
    }

    /// Draws an arrow.
    pub fn arrow(&mut self, class: &str, from: DVec2, to: DVec2) {
        let along = (to - from).normalize_or_zero() * 11.0;
        let side = along.perp() * 0.4;
        self.line(class, &[from, to]);
        let head = class.replace(" dash", "");
        self.line(&head, &[to - along + side, to, to - along - side]);
    }

    /// Draws a dot.
    pub fn dot(&mut self, class: &str, at: DVec2, radius: f64) {
        self.circle(class, at, radius, "");
    }

    /// Draws a dot that is filled with a colour of the scene, and a ring around it.
    pub fn seen(&mut self, color: Color, at: DVec2, radius: f64) {
        self.circle("seen ink", at, radius, &format!(" style=\"fill:{color}\""));
    }

    fn circle(&mut self, class: &str, at: DVec2, radius: f64, more: &str) {
        self.cover(at.y - radius, at.y + radius);
        for across in [DVec2::ONE, DVec2::new(1.0, -1.0)] {
            let ends = [at - across * radius, at + across * radius];
            self.obstacles.push((ends, MARK));
        }
        let [x, y, radius] = [at.x, at.y, radius].map(length);
        let _ = writeln!(
            self.marks,
            "<circle class=\"{class}\"{more} cx=\"{x}\" cy=\"{y}\" r=\"{radius}\"/>"
        );
    }

    /// Adds a label to the point `at`, if possible on the side that points away from `from`. Text
    /// between asterisks is italic.
    pub fn label(&mut self, class: &'static str, [at, from]: [DVec2; 2], text: impl Into<String>) {
        let away = (at - from).normalize_or_zero();
        self.labels.push((class, at, away, text.into()));
    }

    /// Writes a text at a fixed position. `anchor` says whether `at` is the `start`, the `middle`
    /// or the `end` of its base line.
    pub fn text(&mut self, class: &str, anchor: &str, at: DVec2, text: &str) {
        let mut spans = String::new();
        for (part, text) in text.split('*').enumerate() {
            let text = escaped(text);
            spans += &match part % 2 {
                1 => format!("<tspan>{text}</tspan>"),
                _ => text,
            };
        }
        self.cover(at.y - LETTERS, at.y + LETTERS * 0.3);
        let [x, y] = [at.x, at.y].map(length);
        let _ = writeln!(
            self.marks,
            "<text class=\"{class}\" x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\">{spans}</text>"
        );
    }

    /// Extends the rows that are drawn to those from `top` to `bottom`.
    fn cover(&mut self, top: f64, bottom: f64) {
        self.rows = [self.rows[0].min(top), self.rows[1].max(bottom)];
    }

    /// Returns the file as [`finish`](Self::finish) does, without the empty rows at the top and at
    /// the bottom.
    pub fn finish_cropped(mut self, title: &str, description: &str) -> String {
        self.place_labels();
        let [top, bottom] = self.rows;
        self.file([top - MARGIN, bottom + MARGIN], title, description)
    }

    /// Returns the file, with a title and a description for screen readers.
    pub fn finish(mut self, title: &str, description: &str) -> String {
        self.place_labels();
        let height = self.size.y;
        self.file([0.0, height], title, description)
    }

    fn file(self, [top, bottom]: [f64; 2], title: &str, description: &str) -> String {
        let [width, top, height] = [self.size.x, top, bottom - top].map(length);
        let (title, description) = (escaped(title), escaped(description));
        let marks = self.marks;
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 {top} {width} {height}\" width=\"{width}\" height=\"{height}\" role=\"img\" aria-labelledby=\"t d\">\n\
            <title id=\"t\">{title}</title>\n<desc id=\"d\">{description}</desc>\n<style>{STYLE}</style>\n\
            <path class=\"paper swatch\" d=\"M0 {top}h{width}v{height}H0Z\"/>\n{marks}</svg>\n"
        )
    }

    /// Writes each label at the side and the distance from its point with the least cost.
    fn place_labels(&mut self) {
        let mut taken: Vec<[DVec2; 2]> = Vec::new();
        for (class, at, away, text) in std::mem::take(&mut self.labels) {
            let letters = text.chars().filter(|letter| *letter != '*').count();
            let size = DVec2::new(letters as f64, 1.0) * LETTER;
            let mut best = (f64::INFINITY, at, DVec2::ZERO);
            for (far, gap) in [9.0, 18.0, 30.0, 46.0, 66.0].into_iter().enumerate() {
                for (turn, side) in SIDES.into_iter().enumerate() {
                    let side = DVec2::from(side);
                    let middle = at + side * (size / 2.0 + gap);
                    let rectangle = [middle - size / 2.0, middle + size / 2.0];
                    let preferred = 6.0 * far as f64 + 0.1 * turn as f64 - 8.0 * side.dot(away);
                    let cost = self.cost(rectangle, &taken) + preferred;
                    if cost < best.0 {
                        best = (cost, middle, side);
                    }
                }
            }
            let (_, middle, side) = best;
            taken.push([middle - size / 2.0, middle + size / 2.0]);
            let anchor = match side.x {
                x if x > 0.0 => "start",
                x if x < 0.0 => "end",
                _ => "middle",
            };
            let base = DVec2::new(middle.x - side.x * size.x / 2.0, middle.y + LETTERS * 0.36);
            self.text(class, anchor, base, &text);
        }
    }

    /// Returns the cost of placing a label in `rectangle`: very high if the rectangle is partly
    /// outside of the drawing, lower for each label in `taken` that it would cover, and much lower
    /// for each segment in `obstacles`.
    fn cost(&self, rectangle: [DVec2; 2], taken: &[[DVec2; 2]]) -> f64 {
        let [min, max] = rectangle;
        let is_outside = min.cmplt(DVec2::splat(4.0)).any() || max.cmpgt(self.size - 4.0).any();
        let covered = taken
            .iter()
            .filter(|[from, to]| min.cmplt(*to).all() && max.cmpgt(*from).all());
        let crossed = self
            .obstacles
            .iter()
            .filter(|(ends, _)| clip(*ends, rectangle).is_some());
        let crossed: f64 = crossed.map(|(_, cost)| cost).sum();
        1e7 * f64::from(u8::from(is_outside)) + 1e5 * covered.count() as f64 + crossed
    }
}

/// Directions from a point to its label, the preferred ones first.
const SIDES: [[f64; 2]; 8] = [
    [1.0, 0.0],
    [1.0, -0.6],
    [1.0, 0.6],
    [0.0, -1.0],
    [0.0, 1.0],
    [-1.0, 0.0],
    [-1.0, -0.6],
    [-1.0, 0.6],
];

/// Formats a number with four significant digits, for people to read.
pub fn number(x: f64) -> String {
    numbers::short(numbers::significant(x, 4)).replace('-', "−")
}

/// Formats a length with at most one decimal.
pub fn length(x: f64) -> String {
    // The clamp avoids an overflow. Marks with NaN or very large coordinates are not visible
    // anyway.
    let tenths = (x.clamp(-1e6, 1e6) * 10.0).round() as i64;
    let sign = if tenths < 0 { "-" } else { "" };
    match (tenths.abs() / 10, tenths.abs() % 10) {
        (whole, 0) => format!("{sign}{whole}"),
        (whole, tenth) => format!("{sign}{whole}.{tenth}"),
    }
}

fn pair(point: DVec2) -> String {
    format!("{} {}", length(point.x), length(point.y))
}

fn escaped(text: &str) -> String {
    let text = text.replace('&', "&amp;");
    text.replace('<', "&lt;").replace('>', "&gt;")
}
