//! The table of mistakes that a class makes: a word for programs, what it is, the way out, and what it does.

use glam::DVec3;

use super::{
    candidate::{Candidate, Cause, Named},
    changes::{
        averaged, behind, channels, encoded, encoded_gray, layout, look, moved, narrowed, roll,
        scaled, shifted, squares, up, visible,
    },
    light::{Average, Curve, Look},
    textbook::{Behind, Squares, Visible},
};
use crate::{
    math::Angle,
    scene::{Lens, Shape, View},
};

/// A row.
pub struct Row {
    /// A word for programs.
    pub id: &'static str,
    /// What it is.
    pub message: &'static str,
    /// The way out.
    pub help: &'static str,
    /// What it does, if it can do anything.
    pub change: fn(&mut Candidate) -> Option<()>,
    /// Where it shows.
    pub shows: Shows,
}

/// Where a mistake shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shows {
    /// In areas of one colour.
    InAreas,
    /// Where colours meet, and nowhere else: it moves nothing by a pixel.
    AtEdges,
    /// In both.
    Everywhere,
}

/// A row about an object.
pub struct ObjectRow {
    /// A word for programs.
    pub id: &'static str,
    /// What it is, after the object's name.
    pub message: &'static str,
    /// The way out.
    pub help: &'static str,
    /// What it does to the object of an index.
    pub change: fn(&mut Candidate, usize) -> Option<()>,
}

impl Row {
    /// As a mistake that was made.
    pub fn named(&self) -> Named {
        Named {
            id: self.id,
            message: self.message.to_owned(),
            help: self.help.to_owned(),
            cause: Cause::Row(self.change),
        }
    }
}

const ENCODE: &str = "encode each channel once, before it is written: 12.92 c up to 0.0031308, else 1.055 c^(1/2.4) − 0.055";
const AVERAGE: &str = "decode a scene's colours to linear light, average there, and encode once";
const NEAREST: &str =
    "keep the least t > 0 of all hits of a ray, and replace it only by a lesser one";
const SQUARES: &str = "a square has the first colour where floor(x/square) + floor(z/square) is even; floor(−0.5) is −1, and −1 % 2 may be −1";
const WINDOW: &str = "the window is view_height tall, and its width is view_height · width/height";

const fn row(
    id: &'static str,
    message: &'static str,
    help: &'static str,
    change: fn(&mut Candidate) -> Option<()>,
) -> Row {
    Row {
        id,
        message,
        help,
        change,
        shows: Shows::InAreas,
    }
}

const fn edge(
    id: &'static str,
    message: &'static str,
    help: &'static str,
    change: fn(&mut Candidate) -> Option<()>,
) -> Row {
    Row {
        id,
        message,
        help,
        change,
        shows: Shows::AtEdges,
    }
}

/// The rows about the picture and the camera.
pub const ROWS: &[Row] = &[
    row(
        "mirrored",
        "the picture is mirrored: left and right are exchanged",
        "u = (up × w)/|up × w| points to the right; w × up points to the left",
        |c| layout(c, [true, false, false]),
    ),
    row(
        "upside_down",
        "the picture is upside down: top and bottom are exchanged",
        "rows are counted from the top, and y_v = s (height/2 − py) falls as they grow",
        |c| layout(c, [false, true, false]),
    ),
    row(
        "turned_180",
        "the picture is turned by 180 degrees",
        "the view plane lies before the eye, at −d w, so the picture stands upright",
        |c| layout(c, [true, true, false]),
    ),
    row(
        "transposed",
        "the picture is transposed: rows and columns are exchanged",
        "a pixel's index is row · width + column",
        |c| {
            (c.scene.image.width == c.scene.image.height).then_some(())?;
            layout(c, [false, false, true])
        },
    ),
    row(
        "squeezed",
        "the picture is stretched: its window is as wide as it is high, though the picture is not",
        WINDOW,
        |c| {
            (c.scene.image.width != c.scene.image.height).then_some(())?;
            c.behaviour.is_squeezed = true;
            Some(())
        },
    ),
    edge(
        "half_pixel",
        "samples lie half a pixel too far up and left: around a pixel's corner, not its middle",
        "the middle of the pixel in column x and row y is at (x + 1/2, y + 1/2)",
        |c| shifted(c, [-1, -1]),
    ),
    edge(
        "half_pixel",
        "samples lie half a pixel too far down and right",
        "the middle of the pixel in column x and row y is at (x + 1/2, y + 1/2)",
        |c| shifted(c, [1, 1]),
    ),
    edge(
        "half_pixel",
        "samples lie half a pixel too far down and left",
        "the middle of the pixel in column x and row y is at (x + 1/2, y + 1/2)",
        |c| shifted(c, [-1, 1]),
    ),
    row(
        "channels",
        "the colour channels are in the order blue, green, red",
        "a picture's channels are in the order red, green, blue",
        |c| channels(c, [2, 1, 0]),
    ),
    row(
        "channels",
        "the colour channels are in the order red, blue, green",
        "a picture's channels are in the order red, green, blue",
        |c| channels(c, [0, 2, 1]),
    ),
    row(
        "channels",
        "the colour channels are in the order green, red, blue",
        "a picture's channels are in the order red, green, blue",
        |c| channels(c, [1, 0, 2]),
    ),
    row(
        "channels",
        "the colour channels are in the order green, blue, red",
        "a picture's channels are in the order red, green, blue",
        |c| channels(c, [1, 2, 0]),
    ),
    row(
        "channels",
        "the colour channels are in the order blue, red, green",
        "a picture's channels are in the order red, green, blue",
        |c| channels(c, [2, 0, 1]),
    ),
    row(
        "gray",
        "the picture is gray: its channels have their luminance",
        "write each channel",
        |c| look(c, Look::Gray([0.2126, 0.7152, 0.0722])),
    ),
    row(
        "gray",
        "the picture is gray: its channels have their mean",
        "write each channel",
        |c| look(c, Look::Gray([1.0 / 3.0; 3])),
    ),
    row(
        "gray",
        "the picture is gray: its channels have the mean of their encoded values",
        "write each channel",
        |c| encoded_gray(c, [1.0 / 3.0; 3]),
    ),
    row(
        "gray",
        "the picture is gray: its channels have the luma of their encoded values",
        "write each channel",
        |c| encoded_gray(c, [0.299, 0.587, 0.114]),
    ),
    row(
        "gray",
        "the picture is gray: its channels have the luma of their encoded values, weighted as light",
        "write each channel",
        |c| encoded_gray(c, [0.2126, 0.7152, 0.0722]),
    ),
    row(
        "not_encoded",
        "the colours are too dark: linear light was written where sRGB is expected",
        ENCODE,
        |c| encoded(c, Curve::Missing),
    ),
    row(
        "encoded_twice",
        "the colours are too bright: they were encoded as sRGB twice, or a scene's sRGB colours were not decoded",
        AVERAGE,
        |c| encoded(c, Curve::Twice),
    ),
    Row {
        id: "gamma_22",
        message: "the colours were encoded with the power 1/2.2, which is near sRGB but not it",
        help: ENCODE,
        change: |c| encoded(c, Curve::Power22),
        shows: Shows::Everywhere,
    },
    row(
        "gamma_2",
        "the colours were encoded with a square root, which is near sRGB but not it",
        ENCODE,
        |c| encoded(c, Curve::Root),
    ),
    edge(
        "averaged_encoded",
        "samples were averaged as sRGB numbers, not as light: flat colours are right, and edges too dark",
        AVERAGE,
        |c| averaged(c, Average::Encoded, Curve::Missing),
    ),
    edge(
        "gamma_22_averaged",
        "colours were decoded with the power 2.2 and encoded with 1/2.2, which is near sRGB but not it: flat colours are right, and edges a little off",
        ENCODE,
        |c| averaged(c, Average::Power22, Curve::Power22),
    ),
    Row {
        id: "cut_off",
        message: "bytes are cut off instead of rounded, as int(255 c) does: they are too dark by up to a step",
        help: "a channel's byte is round(255 c), which is floor(255 c + 0.5), of its encoded colour c",
        change: |c| look(c, Look::CutOff),
        shows: Shows::Everywhere,
    },
    row(
        "depth_ignored",
        "of several objects that a ray hits the last one in the file is seen, though another one may be nearer",
        NEAREST,
        |c| visible(c, Visible::Last),
    ),
    row(
        "depth_ignored",
        "of several objects that a ray hits the first one in the file is seen, though another one may be nearer",
        NEAREST,
        |c| visible(c, Visible::First),
    ),
    row(
        "depth_ignored",
        "of several objects that a ray hits the farthest one is seen, not the nearest",
        NEAREST,
        |c| visible(c, Visible::Farthest),
    ),
    row(
        "behind_seen",
        "what lies behind the eye is seen, as the floor in the sky: hits with t < 0 count",
        "a hit counts only if t > 0",
        |c| behind(c, Behind::First),
    ),
    row(
        "behind_seen",
        "what lies behind the eye is seen, as the floor in the sky, where nothing before it is nearer: hits with t < 0 count",
        "a hit counts only if t > 0",
        |c| behind(c, Behind::ByDistance),
    ),
    row(
        "board_truncated",
        "coordinates on the checkerboard are truncated towards 0, so the squares on both sides of an axis are one",
        SQUARES,
        |c| squares(c, Squares::Truncated),
    ),
    row(
        "board_remainder",
        "a negative odd sum of a checkerboard's coordinates is taken for an even one",
        SQUARES,
        |c| squares(c, Squares::SignedSum),
    ),
    row(
        "board_remainder",
        "a checkerboard's coordinates, one of them negative, are compared by their remainders",
        SQUARES,
        |c| squares(c, Squares::SignedParts),
    ),
    row(
        "board_swapped",
        "the checkerboard's colours are exchanged",
        SQUARES,
        |c| {
            let mut is_swapped = None;
            let count = c.scene.objects.len();
            for object in 0..count {
                if let Shape::Checkerboard(board) = c.shape(object) {
                    board.colors.reverse();
                    is_swapped = Some(());
                }
            }
            is_swapped
        },
    ),
    row(
        "roll_sign",
        "the roll has the wrong sign",
        "u' = cos ψ u − sin ψ v and v' = sin ψ u + cos ψ v: a positive roll dips the right side",
        |c| roll(c, -c.scene.camera.roll),
    ),
    row(
        "roll_ignored",
        "the roll is ignored",
        "turn u and v by the roll about the view direction",
        |c| roll(c, Angle::default()),
    ),
    row(
        "roll_unit",
        "the roll's degrees are taken for radians",
        "sin and cos take radians: 180 degrees are π",
        |c| {
            let degrees = c.scene.camera.roll.degrees;
            // As a number of degrees again, which is what a scene says.
            roll(c, Angle::from_degrees(degrees.to_degrees() % 360.0))
        },
    ),
    row(
        "up_negated",
        "up has the wrong sign",
        "u = (up × w)/|up × w|",
        |c| up(c, -c.scene.camera.up),
    ),
    row(
        "up_ignored",
        "up is ignored: (0, 1, 0) is taken for it",
        "u = (up × w)/|up × w|",
        |c| up(c, DVec3::Y),
    ),
    row(
        "up_ignored",
        "z is taken for up",
        "u = (up × w)/|up × w|",
        |c| up(c, DVec3::Z),
    ),
    row(
        "fov_of_width",
        "the window's height is taken for its width",
        WINDOW,
        |c| {
            let (width, height) = (
                f64::from(c.scene.image.width),
                f64::from(c.scene.image.height),
            );
            (width != height).then_some(())?;
            c.scene.camera.lens = match c.scene.camera.lens {
                Lens::Distance(d) => Lens::Distance(d * width / height),
                Lens::Fov(angle) => narrowed(angle, height / width, Lens::Fov),
                Lens::HorizontalFov(angle) => narrowed(angle, width / height, Lens::HorizontalFov),
            };
            Some(())
        },
    ),
    row(
        "fov_halved",
        "half the field of view is taken for all of it",
        "the window is view_height tall: from −view_height/2 to view_height/2",
        |c| scaled(c, 2.0),
    ),
    row(
        "fov_doubled",
        "the field of view is taken for half of it",
        "the window is view_height tall: from −view_height/2 to view_height/2",
        |c| scaled(c, 0.5),
    ),
    row(
        "looks_back",
        "the camera looks the other way: w has the wrong sign",
        "w = −f/|f|, f being lookat − eye, and rays leave along −d w",
        |c| {
            c.scene.camera.view = match c.scene.camera.view {
                View::Lookat(point) => View::Lookat(2.0 * c.scene.camera.eye - point),
                View::Direction(direction) => View::Direction(-direction),
            };
            Some(())
        },
    ),
    row(
        "near_ignored",
        "the near plane is ignored",
        "a hit counts only if near < depth < far",
        |c| {
            (c.scene.camera.near > 0.0).then_some(())?;
            c.scene.camera.near = 0.0;
            Some(())
        },
    ),
    row(
        "far_ignored",
        "the far plane is ignored",
        "a hit counts only if near < depth < far",
        |c| c.scene.camera.far.take().map(|_| ()),
    ),
    row(
        "view_height_ignored",
        "view_height is ignored: the window is 2 tall",
        WINDOW,
        |c| {
            (c.scene.camera.view_height != 2.0).then_some(())?;
            c.scene.camera.view_height = 2.0;
            Some(())
        },
    ),
];

/// The rows about an object.
pub const OBJECT_ROWS: &[ObjectRow] = &[
    ObjectRow {
        id: "object_missing",
        message: "is missing",
        help: "ask every object of the scene for its hits",
        change: |c, object| std::mem::replace(&mut c.is_drawn[object], false).then_some(()),
    },
    ObjectRow {
        id: "box_corner",
        message: "is placed by its corner: its center is taken for its least corner",
        help: "a box reaches from center − size/2 to center + size/2",
        change: |c, object| moved(c, object, DVec3::splat(0.5)),
    },
    ObjectRow {
        id: "box_corner",
        message: "is placed by its corner: its center is taken for its greatest corner",
        help: "a box reaches from center − size/2 to center + size/2",
        change: |c, object| moved(c, object, DVec3::splat(-0.5)),
    },
    ObjectRow {
        id: "box_base",
        message: "is placed by its base: its center is taken for its bottom's",
        help: "a box reaches from center − size/2 to center + size/2",
        change: |c, object| moved(c, object, DVec3::new(0.0, 0.5, 0.0)),
    },
    ObjectRow {
        id: "box_doubled",
        message: "is twice as large: its size counts on both sides of its center",
        help: "a box reaches from center − size/2 to center + size/2",
        change: |c, object| {
            let Shape::Box(cuboid) = c.shape(object) else {
                return None;
            };
            let half = (cuboid.max - cuboid.min) / 2.0;
            (cuboid.min, cuboid.max) = (cuboid.min - half, cuboid.max + half);
            Some(())
        },
    },
];
