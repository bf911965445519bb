//! How a method is drawn: a colour, a marker and a dash, each of which tells it from the others nearby on its own.

use plotters::{
    coord::Shift,
    element::DashedPathElement,
    prelude::{
        Color, DrawingArea, DrawingAreaErrorKind, DrawingBackend, PathElement, Polygon, RGBColor,
    },
};

use crate::scene::Method;

/// What drawing yields.
pub type Drawn<DB> = Result<(), DrawingAreaErrorKind<<DB as DrawingBackend>::ErrorType>>;

/// A place in pixels.
pub type Place = (i32, i32);

/// How a method is drawn.
#[derive(Clone, Copy)]
pub struct LineStyle {
    pub color: RGBColor,
    marker: Marker,
    /// The length of dashes and gaps in pixels; a solid line if there is none.
    dash: Option<(u32, u32)>,
}

/// A shape about a place by its corners: one that is filled, or lines.
#[derive(Clone, Copy)]
enum Marker {
    Filled(&'static [Place]),
    Lines(&'static [&'static [Place]]),
}

const SQUARE: &[Place] = &[(-4, -4), (4, -4), (4, 4), (-4, 4), (-4, -5)];
const UP: &[Place] = &[(-5, 4), (5, 4), (0, -5)];
const DOWN: &[Place] = &[(-5, -4), (5, -4), (0, 5)];
const DIAMOND: &[Place] = &[(-5, 0), (0, -5), (5, 0), (0, 5)];
const CROSS: &[&[Place]] = &[&[(-4, -4), (4, 4)], &[(-4, 4), (4, -4)]];
const PLUS: &[&[Place]] = &[&[(-5, 0), (5, 0)], &[(0, -5), (0, 5)]];
#[rustfmt::skip]
const DISC: &[Place] = &[(5, 0), (4, 3), (3, 4), (0, 5), (-3, 4), (-4, 3), (-5, 0), (-4, -3), (-3, -4), (0, -5), (3, -4), (4, -3), (5, 0)];

impl LineStyle {
    #[rustfmt::skip]
    pub fn of(method: Method) -> Self {
        let (color, marker, dash) = match method {
            Method::Regular => (0x77_77_77, Marker::Filled(SQUARE), Some((2, 3))),
            Method::Random => (0xcc_33_11, Marker::Lines(CROSS), None),
            Method::Jittered => (0x1f_78_b4, Marker::Lines(&[DISC]), None),
            Method::NRooks => (0xa6_76_1d, Marker::Lines(PLUS), Some((8, 4))),
            Method::MultiJittered => (0x00_8f_7a, Marker::Filled(DISC), None),
            Method::Hammersley => (0xd0_2f_84, Marker::Filled(UP), Some((8, 4))),
            Method::Halton => (0x75_57_c4, Marker::Filled(DOWN), Some((2, 3))),
            Method::Sobol => (0x2b_8a_2b, Marker::Filled(DIAMOND), Some((14, 4))),
            Method::Scatter | Method::Exact => (0xe0_7b_00, Marker::Lines(&[SQUARE]), Some((5, 2))),
        };
        let [_, r, g, b] = u32::to_be_bytes(color);
        let color = RGBColor(r, g, b);
        Self { color, marker, dash }
    }

    /// Draws a line through these places.
    pub fn line<DB: DrawingBackend>(
        self,
        area: &DrawingArea<DB, Shift>,
        places: &[Place],
    ) -> Drawn<DB> {
        let (places, style) = (places.to_vec(), self.color.stroke_width(2));
        match self.dash {
            None => area.draw(&PathElement::new(places, style)),
            Some((dash, gap)) => area.draw(&DashedPathElement::new(places, dash, gap, style)),
        }
    }

    /// Draws the marker.
    pub fn marker<DB: DrawingBackend>(
        self,
        area: &DrawingArea<DB, Shift>,
        (x, y): Place,
    ) -> Drawn<DB> {
        let at = |corners: &[Place]| -> Vec<Place> {
            corners.iter().map(|(dx, dy)| (x + dx, y + dy)).collect()
        };
        match self.marker {
            Marker::Filled(corners) => area.draw(&Polygon::new(at(corners), self.color.filled())),
            Marker::Lines(lines) => lines.iter().try_for_each(|line| {
                let style = self.color.stroke_width(2);
                area.draw(&PathElement::new(at(line), style))
            }),
        }
    }
}
