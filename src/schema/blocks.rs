//! The table of the kinds of blocks and their fields.

use std::marker::PhantomData;

use super::{
    row_types::{Choice, Condition, FieldRow, Preset},
    types::{FieldValue, Type, contents},
};
use Condition::{
    AtLeast, AtMostTwoTo, EachMoreThanZero, LessThanHalfTurn, LessThanTwoTo, MoreThan,
};
use Condition::{NotZero, Whole};

/// Row for a kind of block in the table of the language.
#[derive(Debug)]
#[non_exhaustive]
pub struct BlockRow {
    /// Kind of block.
    pub kind: BlockKind,
    /// The keyword that the block starts with.
    pub name: &'static str,
    /// The keyword with its article, for messages.
    pub noun: &'static str,
    /// Whether the block describes an object. A scene may have many objects, and each may have a
    /// name.
    pub is_object: bool,
    /// One line of help.
    pub help: &'static str,
    /// Rows of the block's fields.
    pub fields: &'static [FieldRow],
    /// Groups of fields that express the same thing in different ways and exclude each other.
    pub choices: &'static [Choice],
    /// Conditions that relate several fields: formulas such as `near < far`, or phrases that name
    /// the fields.
    pub joint_conditions: &'static [&'static str],
    /// Words that people write by mistake to set several fields at once, as in
    /// `resolution (640, 480)`. An element consists of such words, separated by spaces, and the
    /// names of the fields.
    pub several: &'static [(&'static str, &'static [&'static str])],
    /// Groups of words that people use together by mistake, such as `x y z` for the coordinates of
    /// a centre.
    ///
    /// The first part of an entry is a list of groups, such as `x y z|cx cy cz`: `|` separates
    /// groups, and a space separates words. The second part names the fields that were meant: one
    /// field if each word stands for one component of its value, or else one field for each word.
    pub split_words: &'static [(&'static str, &'static [&'static str])],
    /// Words that people use by mistake for the keyword, separated by spaces.
    pub also_tried: &'static str,
    /// Words that name a field in other programs, although this block has no such field. An element
    /// consists of such words, separated by spaces, and help that says what to write instead.
    pub elsewhere: &'static [(&'static str, &'static str)],
    /// Fields that are probably meant by values without names at the start of a block, as in
    /// `sphere { (0, 1, 0) }`. Each list names one field for each value.
    pub nameless: &'static [&'static [&'static str]],
    /// Text of the fields of an object that an editor adds to a scene. The editor replaces `{at}`
    /// by a free place, `{across}` by the direction from this place to the camera, `{size}` by half
    /// of the object's size, `{twice}` by the whole size, and `{below}` by a height below all
    /// objects.
    pub added: &'static str,
}

/// Typed handle of a field, whose values have the Rust type `T`.
///
/// Code refers to a field by a constant of this type, so that a misspelt name does not compile.
#[derive(Clone, Copy, Debug)]
pub struct FieldHandle<T> {
    /// The field's name.
    pub name: &'static str,
    /// The kind of block that has the field.
    pub kind: BlockKind,
    /// Index of the field's row in [`BlockRow::fields`].
    pub index: usize,
    values: PhantomData<T>,
}

impl<T> FieldHandle<T> {
    pub(super) const fn new(name: &'static str, kind: BlockKind, index: usize) -> Self {
        Self {
            name,
            kind,
            index,
            values: PhantomData,
        }
    }
}

impl<T: FieldValue> FieldHandle<T> {
    /// Returns `value` if `name` is the field's name, and otherwise `None`. To find the value for a
    /// name, an object calls this function for each of its fields.
    pub fn of<'a>(self, name: &str, value: &'a mut T) -> Option<&'a mut dyn FieldValue> {
        (name == self.name).then_some(value)
    }
}

/// Defines the kinds of blocks, their rows in the table of the language, and a handle for each
/// field.
///
/// Three words precede the first braces: the kind of block, and the type and the constant of its
/// handles. Each line in the first braces defines a field by its name, its type, its [`Preset`],
/// its help and optional entries of [`FieldRow`]. The second braces contain entries of
/// [`BlockRow`].
macro_rules! blocks {
    ($($kind:ident $handles:ident $constant:ident {
        $($field:ident $takes:ident $preset:ident $(($default:literal))? $help:literal $($more:ident($value:expr))*;)*
    } {
        $($column:ident: $content:expr,)*
    })*) => {
        /// A kind of block.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum BlockKind {
            $(#[doc = concat!("The kind of [`", stringify!($constant), "`].")] $kind,)*
        }

        $(#[doc = concat!("Handles of the fields of `BlockKind::", stringify!($kind), "`.")]
        #[derive(Clone, Copy, Debug)]
        pub struct $handles {
            $(#[doc = $help] pub $field: FieldHandle<contents::$takes>,)*
        }

        #[doc = concat!("Handles of the fields of `BlockKind::", stringify!($kind), "`.")]
        pub const $constant: $handles = {
            #[allow(non_camel_case_types, reason = "the variants are named as the fields are")]
            enum Index { $($field),* }
            $handles {
                $($field: FieldHandle::new(
                    stringify!($field),
                    BlockKind::$kind,
                    Index::$field as usize,
                ),)*
            }
        };)*

        /// The rows of all kinds of blocks, in the order of [`BlockKind`].
        #[allow(clippy::needless_update, reason = "a row may have all columns")]
        pub const BLOCKS: &[BlockRow] = &[$(BlockRow {
            kind: BlockKind::$kind,
            fields: &[$(FieldRow {
                $($more: $value,)*
                ..FieldRow::new(
                    stringify!($field),
                    Type::$takes,
                    Preset::$preset $(($default))?,
                    $help,
                )
            }),*],
            $($column: $content,)*
            ..BLOCK
        }),*];
    };
}

/// Default contents of a row: no fields and no additional words. Each row of the table overrides
/// some of them.
const BLOCK: BlockRow = BlockRow {
    kind: BlockKind::Image,
    name: "",
    noun: "",
    is_object: false,
    help: "",
    fields: &[],
    choices: &[],
    joint_conditions: &[],
    several: &[],
    split_words: &[],
    also_tried: "",
    elsewhere: &[],
    nameless: &[],
    added: "",
};

/// Lists the names of some fields of a block. `$handles` is the constant with the block's field
/// handles, such as `CAMERA`.
macro_rules! names {
    ($handles:ident $($field:ident)*) => {
        &[$($handles.$field.name),*]
    };
}

blocks! {
    Image ImageFields IMAGE {
        width Number Value("800") "the columns of pixels" must(PIXELS) also_tried("columns w");
        height Number Value("450") "the rows of pixels" must(PIXELS) also_tried("rows h");
        background Color Value("black") "the colour where nothing is hit" also_tried("bg color colour sky");
    } {
        name: "image",
        noun: "an image",
        help: "the picture's size, and what is seen where nothing is hit",
        several: &[("resolution size dimensions", names!(IMAGE width height))],
        also_tried: "picture window film output",
    }

    Camera CameraFields CAMERA {
        eye Vector Required "the point that all rays pass through" example("(0, 2, 8)")
            also_tried("position pos from center centre origin location look_from");
        lookat Vector Alternative "the point that it looks at" example("(0, 1, 0)") also_tried("look_at target at to") perhaps("look");
        direction Vector Alternative "the direction that it looks in, of any length" must(&[NotZero])
            example("(0, 0, -1)") also_tried("dir forward") perhaps("look");
        up Vector Value("(0, 1, 0)") "what is up in the picture" must(&[NotZero]);
        roll Angle Value("0deg") "the turn about the view direction; positive dips the right side"
            example("30deg") perhaps("tilt rotation");
        d Number Value("2") "the distance from the eye to the view plane" must(POSITIVE) perhaps("distance");
        view_height Number Value("2") "the height of the window in the view plane" must(POSITIVE);
        fov Angle Nothing "the angle that the window's height takes up, instead of d" must(&[LessThanHalfTurn])
            example("40deg") also_tried("field_of_view vfov yfov") perhaps("angle");
        hfov Angle Nothing "the angle that the window's width takes up, instead of d or fov" must(&[LessThanHalfTurn])
            example("60deg") also_tried("xfov horizontal_fov") perhaps("angle");
        near Number Value("0") "nothing at this depth or nearer is seen" must(&[AtLeast(0.0)]);
        far Number Nothing "nothing at this depth or farther is seen" example("100");
    } {
        name: "camera",
        noun: "a camera",
        help: "the pinhole camera: where it stands, where it looks, how much it sees",
        choices: &[
            Choice {
                ways: &[names!(CAMERA lookat), names!(CAMERA direction)],
                why: "either a point or a direction says where the camera looks",
            },
            Choice {
                ways: &[names!(CAMERA d), names!(CAMERA fov), names!(CAMERA hfov)],
                why: "one of d, fov and hfov says how much the camera sees",
            },
        ],
        joint_conditions: &["lookat ≠ eye", "near < far"],
        also_tried: "cam view viewer eye",
        elsewhere: &[
            ("aspect aspect_ratio ratio right",
             "write the size of the picture, `image { width 1280  height 720 }`: aspect = width / height, here 16 / 9"),
            ("width height resolution size dimensions image_width image_height",
             "write the picture's size in pixels as `image { width 640  height 480 }`; `view_height` is the height of the window in metres"),
            ("zoom zoom_factor scale",
             "write `d`, the distance of the view plane: d = zoom * 2 as `view_height` is 2, and the picture is twice as large for twice the `d`"),
            ("focal_length focal_distance focal lens sensor_width sensor_height film_height film_width",
             "write `d`: d = view_height * focal length / height of the film, such as `d 2 * 35 / 24` for 35 mm and a film of 36 by 24 mm"),
        ],
    }

    Sampler SamplerFields SAMPLER {
        method Method Value("multi_jittered") "the sampling technique" also_tried("technique type kind pattern");
        per_pixel Number Value("16") "the samples in each pixel" must(&[Whole, AtLeast(1.0)])
            also_tried("samples spp") perhaps("count n");
        total Number Nothing "the samples in the whole picture, instead of per_pixel"
            must(&[Whole, AtLeast(1.0), AtMostTwoTo(53)]) example("1_000_000");
        seed Number Value("0") "another seed gives other random samples" must(&[Whole, AtLeast(0.0), LessThanTwoTo(53)]);
    } {
        name: "sampler",
        noun: "a sampler",
        help: "where in a pixel samples are taken, and how many",
        choices: &[Choice {
            ways: &[names!(SAMPLER per_pixel), names!(SAMPLER total)],
            why: "either one says how many samples there are",
        }],
        joint_conditions: &["per_pixel times the number of pixels is at most 2^53"],
        also_tried: "sampling samples antialiasing",
    }

    Sphere SphereFields SPHERE {
        center Vector Required "its centre" example("(0, 1, 0)") also_tried(POSITION);
        radius Number Value("1") "its radius" must(POSITIVE) also_tried("r") perhaps("size") doubled("diameter");
        color Color Value("olive") "its colour" also_tried(COLOR);
    } {
        name: "sphere",
        noun: "a sphere",
        is_object: true,
        help: "a sphere",
        split_words: &[("x y z|cx cy cz", names!(SPHERE center))],
        nameless: &[names!(SPHERE center), names!(SPHERE center radius)],
        added: "center {at}  radius {size}",
        also_tried: "ball circle globe",
    }

    Triangle TriangleFields TRIANGLE {
        centroid Vector Alternative "the mean of its vertices" example("(0, 1, 0)")
            also_tried("center centre position pos at middle location");
        normal Vector Alternative "what its plane is perpendicular to, of any length" must(&[NotZero])
            example("(0, 0, 1)") also_tried("direction facing");
        sides Vector Value("(2, 2, 1)") "the lengths of its left side, its right side and its base" must(&[EachMoreThanZero])
            also_tried("size lengths edges");
        spin Angle Value("0deg") "its turn in its plane, counter-clockwise seen from the tip of the normal"
            example("30deg") also_tried("roll rotation turn");
        v0 Vector Alternative "one of its vertices, together with the two others" example("(-1, 0, 0)") also_tried("a p0 vertex0");
        v1 Vector Alternative "one of its vertices, together with the two others" example("(1, 0, 0)") also_tried("b p1 vertex1");
        v2 Vector Alternative "one of its vertices, together with the two others" example("(0, 1, 0)") also_tried("c p2 vertex2");
        color Color Value("teal") "its colour" also_tried(COLOR);
    } {
        name: "triangle",
        noun: "a triangle",
        is_object: true,
        help: "a triangle, by centroid, normal and the lengths of its sides or by its vertices",
        choices: &[Choice {
            ways: &[names!(TRIANGLE centroid normal sides spin), names!(TRIANGLE v0 v1 v2)],
            why: "a triangle is given by centroid, normal and sides, or by v0, v1 and v2",
        }],
        several: &[("vertices points corners vertex", names!(TRIANGLE v0 v1 v2))],
        added: "centroid {at}  normal {across}  sides ({twice}, {twice}, {size})",
        split_words: &[("v1 v2 v3|p1 p2 p3|vertex1 vertex2 vertex3|point1 point2 point3|corner1 corner2 corner3", names!(TRIANGLE v0 v1 v2))],
        joint_conditions: &[
            "the sides form a triangle: each is shorter than the two others together",
            "v0, v1 and v2 do not lie on one line",
        ],
        also_tried: "tri sail polygon",
        elsewhere: &[("v3 v4 v5 p3 d", "a triangle has three vertices; a second one with v0, v2 and this makes a quadrilateral of it")],
    }

    Box BoxFields BOX {
        center Vector Alternative "its centre" example("(0, 1, 0)") also_tried(POSITION);
        size Vector Value("(0.5, 1.5, 2)") "its extents along x, y and z" must(&[EachMoreThanZero])
            also_tried("sides dimensions extent");
        min Vector Alternative "its corner of least coordinates, together with max" example("(-1, 0, -1)");
        max Vector Alternative "its corner of greatest coordinates, together with min" example("(1, 1, 1)");
        color Color Value("orange") "its colour" also_tried(COLOR);
        colors FaceColors Nothing "the colours of its faces across x, y and z, instead of color" example("(tan, wheat, peru)")
            also_tried("faces colours");
    } {
        name: "box",
        noun: "a box",
        is_object: true,
        help: "a box along the axes, by centre and size or by two corners",
        choices: &[
            Choice {
                ways: &[names!(BOX center size), names!(BOX min max)],
                why: "a box is given by center and size, or by min and max",
            },
            Choice {
                ways: &[names!(BOX color), names!(BOX colors)],
                why: "a box has one colour, or one for its faces across each axis",
            },
        ],
        split_words: &[
            ("corner1 corner2|p1 p2|p0 p1|from to|lower upper|a b", names!(BOX min max)),
            ("width height depth|w h d|size_x size_y size_z", names!(BOX size)),
            ("x y z|cx cy cz", names!(BOX center)),
            ("color1 color2 color3|colour1 colour2 colour3|color_x color_y color_z", names!(BOX colors)),
        ],
        nameless: &[names!(BOX min max)],
        added: "center {at}  size ({twice}, {twice}, {twice})",
        joint_conditions: &["min < max on every axis"],
        also_tried: "cube cuboid block crate brick wall slab",
        elsewhere: &[
            ("width height depth x y z", "write `size (WIDTH, HEIGHT, DEPTH)`, its extents along x, y and z"),
            ("turn rotate rotation rotated roll spin angle tilt yaw pitch",
             "boxes stand along the axes; a shape that is turned is made of triangles, by v0, v1 and v2"),
        ],
    }

    Checkerboard CheckerboardFields CHECKERBOARD {
        y Number Value("0") "the height of its plane" also_tried("height level");
        square Number Value("1") "the side of a square" must(POSITIVE) also_tried("side squares");
        colors Colors Value("(gray, white)") "the colours of the even and of the odd squares" also_tried("color colour colours");
    } {
        name: "checkerboard",
        noun: "a checkerboard",
        is_object: true,
        help: "the infinite checkered floor in a horizontal plane",
        added: "y {below}",
        split_words: &[("color1 color2|colour1 colour2|color_a color_b|even odd", names!(CHECKERBOARD colors))],
        also_tried: "plane floor ground checker chessboard board",
        elsewhere: &[(
            "size width depth length extent extents rows columns",
            "a checkerboard has no end, and `square` is the side of a square; a board that ends is made of boxes, such as `box for i < 8, j < 8 { center (i, 0, j)  size (1, 0.1, 1)  color (gray, white) }`",
        )],
    }
}

/// Conditions on the width or height of the picture in pixels: a whole number from 1 to 2^20.
const PIXELS: &[Condition] = &[Whole, AtLeast(1.0), AtMostTwoTo(20)];

/// Condition on a length, which must be positive.
const POSITIVE: &[Condition] = &[MoreThan(0.0)];

/// Words that people use by mistake for the centre of an object.
const POSITION: &str = "position pos at centroid middle location";

/// Words that people use by mistake for the colour of an object.
const COLOR: &str = "fill material";

/// Shapes that other programs have but this language lacks, separated by spaces. For a word in this
/// list, a message's help says that other shapes are made of triangles.
pub const OTHER_SHAPES: &str = "cylinder cone torus disk disc pyramid quad mesh prism";
