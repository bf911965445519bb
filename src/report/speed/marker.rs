//! How a method is drawn: a colour, a shape and a dash, each of which tells it from the others nearby on its own.

use plotters::{
    coord::Shift,
    element::DashedPathElement,
    prelude::{
        Circle, Color, DrawingArea, DrawingAreaErrorKind, DrawingBackend, PathElement, Polygon,
        RGBColor, ShapeStyle,
    },
};

use crate::scene::Method;

/// What drawing yields.
pub type Drawn<DB> = Result<(), DrawingAreaErrorKind<<DB as DrawingBackend>::ErrorType>>;

/// A place in pixels.
pub type Place = (i32, i32);

/// How a method is drawn.
#[derive(Clone, Copy)]
pub struct Look {
    pub color: RGBColor,
    shape: Shape,
    /// The length of dashes and gaps in pixels; a solid line if there is none.
    dash: Option<(u32, u32)>,
}

#[derive(Clone, Copy)]
enum Shape {
    Disc,
    Ring,
    Square,
    Box,
    Up,
    Down,
    Diamond,
    Cross,
    Plus,
}

impl Look {
    pub fn of(method: Method) -> Self {
        let (color, shape, dash) = match method {
            Method::Regular => ((0x77, 0x77, 0x77), Shape::Square, Some((2, 3))),
            Method::Random => ((0xcc, 0x33, 0x11), Shape::Cross, None),
            Method::Jittered => ((0x1f, 0x78, 0xb4), Shape::Ring, None),
            Method::NRooks => ((0xa6, 0x76, 0x1d), Shape::Plus, Some((8, 4))),
            Method::MultiJittered => ((0x00, 0x8f, 0x7a), Shape::Disc, None),
            Method::Hammersley => ((0xd0, 0x2f, 0x84), Shape::Up, Some((8, 4))),
            Method::Halton => ((0x75, 0x57, 0xc4), Shape::Down, Some((2, 3))),
            Method::Sobol => ((0x2b, 0x8a, 0x2b), Shape::Diamond, Some((14, 4))),
            Method::Scatter | Method::Exact => ((0xe0, 0x7b, 0x00), Shape::Box, Some((5, 2))),
        };
        let (r, g, b) = color;
        Self {
            color: RGBColor(r, g, b),
            shape,
            dash,
        }
    }

    /// Draws a line through these places.
    pub fn line<DB: DrawingBackend>(
        self,
        area: &DrawingArea<DB, Shift>,
        places: &[Place],
    ) -> Drawn<DB> {
        let style = self.color.stroke_width(2);
        match self.dash {
            None => area.draw(&PathElement::new(places.to_vec(), style)),
            Some((dash, gap)) => area.draw(&DashedPathElement::new(
                places.iter().copied(),
                dash,
                gap,
                style,
            )),
        }
    }

    /// Draws the marker.
    pub fn marker<DB: DrawingBackend>(
        self,
        area: &DrawingArea<DB, Shift>,
        (x, y): Place,
    ) -> Drawn<DB> {
        let (filled, open): (ShapeStyle, ShapeStyle) =
            (self.color.filled(), self.color.stroke_width(2));
        let at = |corners: &[Place]| -> Vec<Place> {
            corners.iter().map(|(dx, dy)| (x + dx, y + dy)).collect()
        };
        match self.shape {
            Shape::Disc => area.draw(&Circle::new((x, y), 4, filled)),
            Shape::Ring => area.draw(&Circle::new((x, y), 4, open)),
            Shape::Square => area.draw(&Polygon::new(
                at(&[(-4, -4), (4, -4), (4, 4), (-4, 4)]),
                filled,
            )),
            Shape::Box => area.draw(&PathElement::new(
                at(&[(-4, -4), (4, -4), (4, 4), (-4, 4), (-4, -5)]),
                open,
            )),
            Shape::Up => area.draw(&Polygon::new(at(&[(-5, 4), (5, 4), (0, -5)]), filled)),
            Shape::Down => area.draw(&Polygon::new(at(&[(-5, -4), (5, -4), (0, 5)]), filled)),
            Shape::Diamond => area.draw(&Polygon::new(
                at(&[(-5, 0), (0, -5), (5, 0), (0, 5)]),
                filled,
            )),
            Shape::Cross => {
                area.draw(&PathElement::new(at(&[(-4, -4), (4, 4)]), open))?;
                area.draw(&PathElement::new(at(&[(-4, 4), (4, -4)]), open))
            }
            Shape::Plus => {
                area.draw(&PathElement::new(at(&[(-5, 0), (5, 0)]), open))?;
                area.draw(&PathElement::new(at(&[(0, -5), (0, 5)]), open))
            }
        }
    }
}
