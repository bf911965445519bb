//! Line styles of the sampling methods in a chart: colours, markers and dashes. Methods whose lines
//! usually lie close to each other differ in colour, marker and dashes.

use std::io;

use plotters::{
    coord::Shift,
    element::DashedPathElement,
    prelude::{
        Color, DrawingArea, DrawingAreaErrorKind, PathElement, Polygon, RGBColor, SVGBackend,
    },
};

use crate::scene::Method;

/// The drawing area of a chart, as SVG.
pub type Canvas<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Result of drawing a part of a chart.
pub type Drawn = Result<(), DrawingAreaErrorKind<io::Error>>;

/// A point of a chart, in pixels from the top left.
pub type CanvasPoint = (i32, i32);

/// Style of a method's line in a chart.
#[derive(Clone, Copy)]
pub struct LineStyle {
    pub color: RGBColor,
    /// Lengths of a dash and of the gap after it, in pixels; `None` for a solid line.
    dash: Option<(u32, u32)>,
    /// The marker's outline, in pixels from its centre, and whether it is filled.
    marker: (&'static [CanvasPoint], bool),
}

const SQUARE: &[CanvasPoint] = &[(-4, -4), (4, -4), (4, 4), (-4, 4), (-4, -5)];
const UP: &[CanvasPoint] = &[(-5, 4), (5, 4), (0, -5)];
const DOWN: &[CanvasPoint] = &[(-5, -4), (5, -4), (0, 5)];
const DIAMOND: &[CanvasPoint] = &[(-5, 0), (0, -5), (5, 0), (0, 5)];
const CROSS: &[CanvasPoint] = &[(-4, -4), (4, 4), (0, 0), (-4, 4), (4, -4)];
const PLUS: &[CanvasPoint] = &[(-5, 0), (5, 0), (0, 0), (0, -5), (0, 5)];
#[rustfmt::skip]
const DISC: &[CanvasPoint] = &[(5, 0), (4, 3), (3, 4), (0, 5), (-3, 4), (-4, 3), (-5, 0), (-4, -3), (-3, -4), (0, -5), (3, -4), (4, -3), (5, 0)];

impl LineStyle {
    pub fn new(method: Method) -> Self {
        let (color, marker, dash) = match method {
            Method::Regular => (0x77_77_77, (SQUARE, true), Some((2, 3))),
            Method::Random => (0xcc_33_11, (CROSS, false), None),
            Method::Jittered => (0x1f_78_b4, (DISC, false), None),
            Method::NRooks => (0xa6_76_1d, (PLUS, false), Some((8, 4))),
            Method::MultiJittered => (0x00_8f_7a, (DISC, true), None),
            Method::Hammersley => (0xd0_2f_84, (UP, true), Some((8, 4))),
            Method::Halton => (0x75_57_c4, (DOWN, true), Some((2, 3))),
            Method::Sobol => (0x2b_8a_2b, (DIAMOND, true), Some((14, 4))),
            Method::Scatter | Method::Exact => (0xe0_7b_00, (SQUARE, false), Some((5, 2))),
        };
        let [_, r, g, b] = u32::to_be_bytes(color);
        let color = RGBColor(r, g, b);
        Self {
            color,
            dash,
            marker,
        }
    }

    /// Draws the method's line through the points `places`.
    pub fn line(self, canvas: &Canvas, places: &[CanvasPoint]) -> Drawn {
        let (places, style) = (places.to_vec(), self.color.stroke_width(2));
        match self.dash {
            None => canvas.draw(&PathElement::new(places, style)),
            Some((dash, gap)) => canvas.draw(&DashedPathElement::new(places, dash, gap, style)),
        }
    }

    /// Draws the method's marker at a point.
    pub fn marker(self, canvas: &Canvas, (x, y): CanvasPoint) -> Drawn {
        let (line, is_filled) = self.marker;
        let line: Vec<_> = line.iter().map(|(dx, dy)| (x + dx, y + dy)).collect();
        if is_filled {
            canvas.draw(&Polygon::new(line, self.color.filled()))
        } else {
            canvas.draw(&PathElement::new(line, self.color.stroke_width(2)))
        }
    }
}
