//! Writes a drawing as SVG.
//!
//! A drawing consists of marks (lines, arrows and dots) and labels. Marks are drawn in the order in
//! which they are added. A label names a point. Labels are placed after all marks, so that they
//! hide neither marks nor each other. Lengths are rounded to one decimal, so that the file is the
//! same on every machine.
//!
//! The style sheet has no CSS variables, since programs for printing, such as librsvg, do not
//! support them. The colours are those of Okabe and Ito, which colour-blind people can distinguish.
//! For white pages, they are darkened, so that letters have a contrast of 4.5 to 1.

use std::fmt::Write;

use glam::DVec2;

use crate::{color::Color, editor::viewport::clip, numbers};

/// Width of every figure, in SVG units. If a page shows a figure 12 cm wide, as intended, a unit is
/// half a typographic point.
pub const WIDTH: f64 = 680.0;

/// Font size, in SVG units. If a page shows a figure 12 cm wide, as intended, the font size is 9
/// typographic points.
const LETTERS: f64 = 18.0;

/// Assumed width of a letter and height of a line of text, in SVG units. They are used to estimate
/// the sizes of labels. The width is the mean of the letters in a wide typeface such as DejaVu
/// Sans, so the estimate is large enough for narrower typefaces.
const LETTER: DVec2 = DVec2::new(10.2, 21.0);

/// Style sheet of every figure: the appearance of its CSS classes, on light and on dark pages.
const STYLE: &str = "\
text{font:18px Helvetica,Arial,'DejaVu Sans',sans-serif;fill:currentColor;stroke:#fff;stroke-width:5px;stroke-linejoin:round;paint-order:stroke}\
tspan{font-style:italic}.strong{font-weight:bold}\
path{fill:none;stroke:currentColor;stroke-width:2;stroke-linejoin:round;stroke-linecap:round}\
circle{fill:currentColor}.seen{stroke:currentColor;stroke-width:1.5}\
.fill{stroke:none;fill-opacity:.4}.tint{fill:currentColor;fill-opacity:.22}.swatch{stroke:none}\
.paper{fill:#fff}.ink{color:#1b1f24}.faint{color:#59636e}path.faint{stroke-width:.8;stroke-opacity:.5}path.cell{stroke-width:1.6;stroke-opacity:.8}\
.blue{color:#0067a3}.red{color:#b34700}.green{color:#00735a}.dash{stroke-dasharray:6 5}\
@media(prefers-color-scheme:dark){.paper{fill:#15181d}.fill{fill-opacity:.65}text{stroke:#15181d}.ink{color:#eceff4}.faint{color:#a3adb8}\
.blue{color:#6cc0f5}.red{color:#f5a05a}.green{color:#3fcfa5}}";

/// Height of the empty space above and below the marks of a cropped figure, in SVG units. It is
/// large enough that the marks do not touch the text around the figure.
const MARGIN: f64 = 12.0;

/// Cost of a label for each line segment of a mark that it covers. A label is placed where the sum
/// of its costs is least. The farthest place costs only about 24 more than the nearest, so a label
/// is moved rather than placed on a segment. With a smaller cost, labels would cover more marks.
const MARK: f64 = 40.0;

/// Cost of a label for each filled polygon that it overlaps. The farthest place of a label costs
/// only about 24 more than the nearest, so a label is moved out of a polygon if there is free space
/// near it.
const FILL: f64 = 30.0;

/// A drawing, to which marks and labels are added.
pub struct Canvas {
    size: DVec2,
    /// Top and bottom of all marks and texts so far, in SVG units. Paths that are given in SVG
    /// notation are ignored.
    rows: [f64; 2],
    marks: String,
    /// Line segments that labels should not cover, each with the cost of a label that covers it.
    obstacles: Vec<([DVec2; 2], f64)>,
    /// Convex polygons that labels should not cover.
    fills: Vec<Vec<DVec2>>,
    labels: Vec<Label>,
    /// Text below the drawing.
    note: String,
}

/// A text beside a point.
struct Label {
    class: &'static str,
    /// Points beside which the label may be placed, each with the preferred direction from the
    /// point to the label. Of all possible positions, the one with the least cost is used.
    points: Vec<[DVec2; 2]>,
    text: String,
}

impl Canvas {
    /// Makes an empty drawing of the given height, in SVG units.
    pub fn new(height: f64) -> Self {
        Self {
            size: DVec2::new(WIDTH, height),
            rows: [height, 0.0],
            marks: String::new(),
            obstacles: Vec::new(),
            fills: Vec::new(),
            labels: Vec::new(),
            note: String::new(),
        }
    }

    /// Draws a line through `points`, which labels will avoid. `class` contains the line's CSS
    /// classes.
    pub fn line(&mut self, class: &str, points: &[DVec2]) {
        let cost = if class.contains("faint") { 1.5 } else { MARK };
        let segments = points.windows(2).map(|ends| ([ends[0], ends[1]], cost));
        self.obstacles.extend(segments);
        self.path(class, points, "");
    }

    /// Fills a convex polygon with a colour of the scene. Labels will avoid the polygon if
    /// possible.
    pub fn fill(&mut self, class: &str, color: Color, points: &[DVec2]) {
        self.fills.push(points.to_vec());
        self.path(class, points, &format!(" style=\"fill:{color}\""));
    }

    /// Draws the outline of a polygon and tints its inside with the same colour.
    pub fn tint(&mut self, class: &str, points: &[DVec2]) {
        self.path(&format!("{class} tint"), points, "");
    }

    fn path(&mut self, class: &str, points: &[DVec2], more: &str) {
        points.iter().for_each(|point| self.cover(point.y, point.y));
        let mut path = String::new();
        for (point, command) in points.iter().zip("M".chars().chain(std::iter::repeat('L'))) {
            let _ = write!(path, "{command}{}", pair(*point));
        }
        self.raw_path(class, &path, more);
    }

    /// Draws a path, given in SVG notation, with further attributes `more`. Labels may cover the
    /// path.
    pub fn raw_path(&mut self, class: &str, path: &str, more: &str) {
        if !path.is_empty() {
            let _ = writeln!(self.marks, "<path class=\"{class}\"{more} d=\"{path}\"/>");
        }
    }

    /// Draws an arrow from `from` to its tip `to`. Labels will avoid the arrow.
    pub fn arrow(&mut self, class: &str, from: DVec2, to: DVec2) {
        let along = (to - from).normalize_or_zero() * 11.0;
        let side = along.perp() * 0.4;
        self.line(class, &[from, to]);
        let head = class.replace(" dash", "");
        self.line(&head, &[to - along + side, to, to - along - side]);
    }

    /// Draws a dot. Labels will avoid it.
    pub fn dot(&mut self, class: &str, at: DVec2, radius: f64) {
        self.circle(class, at, radius, "");
    }

    /// Draws a dot with a colour of the scene and a ring around it. Labels will avoid the dot.
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

    /// Adds a label for the point `at`. It is preferably placed on the side of `at` that faces away
    /// from the point `from`. In the text, words between asterisks are italic.
    pub fn label(&mut self, class: &'static str, [at, from]: [DVec2; 2], text: impl Into<String>) {
        self.label_any(class, &[at], from, text);
    }

    /// Adds a label for one of the given points. The point is chosen at which the label fits best.
    pub fn label_any(
        &mut self,
        class: &'static str,
        points: &[DVec2],
        from: DVec2,
        text: impl Into<String>,
    ) {
        let with_side = |&at: &DVec2| [at, (at - from).normalize_or_zero()];
        self.labels.push(Label {
            class,
            points: points.iter().map(with_side).collect(),
            text: text.into(),
        });
    }

    /// Sets the text below the drawing. Only [`finish_cropped`](Self::finish_cropped) writes it.
    pub fn note(&mut self, text: impl Into<String>) {
        self.note = text.into();
    }

    /// Writes a text at the position `at`. `anchor` says which point of the text's base line is
    /// there: `start`, `middle` or `end`. Words between asterisks are italic.
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

    /// Records the vertical extent of a mark or text, from `top` to `bottom`.
    fn cover(&mut self, top: f64, bottom: f64) {
        self.rows = [self.rows[0].min(top), self.rows[1].max(bottom)];
    }

    /// Places the labels and returns the SVG file. Empty space at the top and at the bottom is
    /// cropped. The title and the description are for screen readers.
    pub fn finish_cropped(mut self, title: &str, description: &str) -> String {
        self.place_labels();
        if !self.note.is_empty() {
            let below = DVec2::new(MARGIN, self.rows[1] + LETTER.y + MARGIN);
            let note = std::mem::take(&mut self.note);
            self.text("faint", "start", below, &note);
        }
        let [top, bottom] = self.rows;
        self.file([top - MARGIN, bottom + MARGIN], title, description)
    }

    /// Places the labels and returns the SVG file. The title and the description are for screen
    /// readers.
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

    /// Writes each label near one of its points, at the position where its cost is least.
    fn place_labels(&mut self) {
        let mut taken: Vec<[DVec2; 2]> = Vec::new();
        for label in std::mem::take(&mut self.labels) {
            let Label {
                class,
                points,
                text,
            } = label;
            let letters = text.chars().filter(|letter| *letter != '*').count();
            let size = DVec2::new(letters as f64, 1.0) * LETTER;
            let mut best = (f64::INFINITY, DVec2::ZERO, DVec2::ZERO);
            for [at, away] in points {
                for (middle, side, preferred) in places(at, away, size) {
                    let rectangle = [middle - size / 2.0, middle + size / 2.0];
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

    /// Returns the cost of placing a label in `rectangle`. The cost is highest if the label extends
    /// beyond the drawing. It is lower if the label covers other labels (`taken`), and still lower
    /// if it covers segments of marks (`obstacles`) or filled polygons.
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
        let filled = self.fills.iter().filter(|fill| covers(rectangle, fill));
        let filled = FILL * filled.count() as f64;
        1e7 * f64::from(u8::from(is_outside)) + 1e5 * covered.count() as f64 + crossed + filled
    }
}

/// Returns the possible places near the point `at` for a label of the size `size`. A place consists
/// of the label's middle, the direction from the point to the label, and a cost. The cost is least
/// close to the point in the direction `away`.
fn places(at: DVec2, away: DVec2, size: DVec2) -> impl Iterator<Item = (DVec2, DVec2, f64)> {
    let gaps = [9.0, 18.0, 30.0, 46.0, 66.0].into_iter().enumerate();
    gaps.flat_map(move |(far, gap)| {
        SIDES.into_iter().enumerate().map(move |(turn, side)| {
            let side = DVec2::from(side);
            let cost = 6.0 * far as f64 + 0.1 * turn as f64 - 8.0 * side.dot(away);
            (at + side * (size / 2.0 + gap), side, cost)
        })
    })
}

/// Returns whether a rectangle and a convex polygon have a point in common.
fn covers(rectangle: [DVec2; 2], polygon: &[DVec2]) -> bool {
    let ends = || polygon.iter().zip(polygon.iter().cycle().skip(1));
    let is_crossed = ends().any(|(a, b)| clip([*a, *b], rectangle).is_some());
    let sides = ends().map(|(a, b)| (*b - *a).perp_dot(rectangle[0] - *a));
    let [least, most] = sides.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], side| {
        [least.min(side), most.max(side)]
    });
    // If no edge crosses the rectangle, it lies completely inside the polygon or completely
    // outside. It is inside if its first corner lies on the same side of every edge.
    is_crossed || !polygon.is_empty() && (least >= 0.0 || most <= 0.0)
}

/// Directions from a point to its label. Of equally good directions, the first one is used.
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

/// Formats a number for people, with four significant digits.
pub fn number(x: f64) -> String {
    numbers::short(numbers::significant(x, 4)).replace('-', "−")
}

/// Formats a length in SVG units with at most one decimal.
pub fn length(x: f64) -> String {
    // Coordinates are limited to avoid overflow. Marks with such large coordinates, or with NaN,
    // are invisible.
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
