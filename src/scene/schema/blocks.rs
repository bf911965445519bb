//! The table of blocks and their fields.

use super::{Block, Condition, Field, Kind, Literal, Preset, Type};

/// A field without conditions or alternatives; rows start from it.
const FIELD: Field = Field {
    name: "",
    takes: Type::Number,
    preset: Preset::Required,
    must: &[],
    excludes: &[],
    help: "",
    also_tried: &[],
    example: "",
};

const fn number(value: f64) -> Preset {
    Preset::Value(Literal::Number(value))
}

/// Every block of the language.
pub const BLOCKS: &[Block] = &[
    Block {
        kind: Kind::Image,
        name: "image",
        noun: "an image",
        is_object: false,
        help: "the picture's size, and what is seen where nothing is hit",
        fields: &[
            Field {
                name: "width",
                preset: number(800.0),
                must: PIXELS,
                help: "the columns of pixels",
                also_tried: &["columns", "w"],
                ..FIELD
            },
            Field {
                name: "height",
                preset: number(450.0),
                must: PIXELS,
                help: "the rows of pixels",
                also_tried: &["rows", "h"],
                ..FIELD
            },
            Field {
                name: "background",
                takes: Type::Color,
                preset: Preset::Value(Literal::Color("black")),
                help: "the colour where nothing is hit",
                also_tried: &["bg", "color", "colour", "sky"],
                ..FIELD
            },
        ],
        together: &[],
        also_tried: &["picture", "window", "film", "output"],
    },
    Block {
        kind: Kind::Camera,
        name: "camera",
        noun: "a camera",
        is_object: false,
        help: "the pinhole camera: where it stands, where it looks, how much it sees",
        fields: &[
            Field {
                name: "eye",
                takes: Type::Vector,
                help: "the point that all rays pass through",
                also_tried: &["position", "pos", "from", "center", "centre", "origin"],
                example: "(0, 2, 8)",
                ..FIELD
            },
            Field {
                name: "lookat",
                takes: Type::Vector,
                preset: Preset::Alternative,
                excludes: &["direction"],
                help: "the point that it looks at",
                also_tried: &["look_at", "target", "at", "to"],
                ..FIELD
            },
            Field {
                name: "direction",
                takes: Type::Vector,
                preset: Preset::Alternative,
                must: &[Condition::NotZero],
                excludes: &["lookat"],
                help: "the direction that it looks in, of any length",
                also_tried: &["dir", "forward"],
                example: "(0, 0, -1)",
            },
            Field {
                name: "up",
                takes: Type::Vector,
                preset: Preset::Value(Literal::Vector([0.0, 1.0, 0.0])),
                must: &[Condition::NotZero],
                help: "what is up in the picture",
                ..FIELD
            },
            Field {
                name: "roll",
                takes: Type::Angle,
                preset: Preset::Value(Literal::Degrees(0.0)),
                help: "the turn about the view direction; positive dips the right side",
                also_tried: &["tilt", "rotation"],
                ..FIELD
            },
            Field {
                name: "d",
                preset: number(2.0),
                must: &[Condition::MoreThan(0.0)],
                excludes: &["fov"],
                help: "the distance from the eye to the view plane",
                also_tried: &["distance", "focal_length"],
                ..FIELD
            },
            Field {
                name: "view_height",
                preset: number(2.0),
                must: &[Condition::MoreThan(0.0)],
                help: "the height of the window in the view plane",
                also_tried: &["height"],
                ..FIELD
            },
            Field {
                name: "fov",
                takes: Type::Angle,
                preset: Preset::Nothing,
                must: &[Condition::LessThanHalfTurn],
                excludes: &["d"],
                help: "the angle that the window's height takes up, instead of d",
                also_tried: &["field_of_view", "angle", "vfov"],
                ..FIELD
            },
            Field {
                name: "near",
                preset: number(0.0),
                must: &[Condition::AtLeast(0.0)],
                help: "nothing at this depth or nearer is seen",
                ..FIELD
            },
            Field {
                name: "far",
                preset: Preset::Nothing,
                help: "nothing at this depth or farther is seen",
                ..FIELD
            },
        ],
        together: &["lookat ≠ eye", "near < far"],
        also_tried: &["cam", "view", "viewer", "eye"],
    },
    Block {
        kind: Kind::Sampler,
        name: "sampler",
        noun: "a sampler",
        is_object: false,
        help: "where in a pixel samples are taken, and how many",
        fields: &[
            Field {
                name: "method",
                takes: Type::Method,
                preset: Preset::Value(Literal::Method("multi_jittered")),
                help: "the sampling technique",
                also_tried: &["technique", "type", "kind", "pattern"],
                ..FIELD
            },
            Field {
                name: "per_pixel",
                preset: number(16.0),
                must: &[Condition::Whole, Condition::AtLeast(1.0)],
                excludes: &["total"],
                help: "the samples in each pixel",
                also_tried: &["samples", "spp", "count", "n"],
                ..FIELD
            },
            Field {
                name: "total",
                preset: Preset::Nothing,
                must: &[
                    Condition::Whole,
                    Condition::AtLeast(1.0),
                    Condition::AtMostTwoTo(53),
                ],
                excludes: &["per_pixel"],
                help: "the samples in the whole picture, instead of per_pixel",
                example: "1_000_000",
                ..FIELD
            },
            Field {
                name: "seed",
                preset: number(0.0),
                must: &[
                    Condition::Whole,
                    Condition::AtLeast(0.0),
                    Condition::LessThanTwoTo(53),
                ],
                help: "another seed gives other random samples",
                ..FIELD
            },
        ],
        together: &["per_pixel times the number of pixels is at most 2^53"],
        also_tried: &["sampling", "samples", "antialiasing"],
    },
    Block {
        kind: Kind::Sphere,
        name: "sphere",
        noun: "a sphere",
        is_object: true,
        help: "a sphere",
        fields: &[
            Field {
                name: "center",
                takes: Type::Vector,
                help: "its centre",
                also_tried: POSITION,
                ..FIELD
            },
            Field {
                name: "radius",
                preset: number(1.0),
                must: &[Condition::MoreThan(0.0)],
                help: "its radius",
                also_tried: &["r", "size"],
                ..FIELD
            },
            color("olive"),
        ],
        together: &[],
        also_tried: &["ball", "circle", "globe"],
    },
    Block {
        kind: Kind::Triangle,
        name: "triangle",
        noun: "a triangle",
        is_object: true,
        help: "a triangle by its centroid, its normal and the lengths of its sides",
        fields: &[
            Field {
                name: "centroid",
                takes: Type::Vector,
                help: "the mean of its vertices",
                also_tried: &["position", "pos", "at", "middle"],
                ..FIELD
            },
            Field {
                name: "normal",
                takes: Type::Vector,
                must: &[Condition::NotZero],
                help: "what its plane is perpendicular to, of any length",
                also_tried: &["direction", "facing"],
                example: "(0, 0, 1)",
                ..FIELD
            },
            Field {
                name: "sides",
                takes: Type::Vector,
                preset: Preset::Value(Literal::Vector([2.0, 2.0, 1.0])),
                must: &[Condition::EachMoreThanZero],
                help: "the lengths of its left side, its right side and its base",
                also_tried: &["size", "lengths", "edges"],
                ..FIELD
            },
            Field {
                name: "spin",
                takes: Type::Angle,
                preset: Preset::Value(Literal::Degrees(0.0)),
                help: "its turn in its plane, counter-clockwise seen from the tip of the normal",
                also_tried: &["roll", "rotation", "turn"],
                ..FIELD
            },
            color("teal"),
        ],
        together: &["the sides form a triangle: each is shorter than the two others together"],
        also_tried: &["tri", "sail", "polygon"],
    },
    Block {
        kind: Kind::Box,
        name: "box",
        noun: "a box",
        is_object: true,
        help: "a box along the axes, by centre and size or by two corners",
        fields: &[
            Field {
                name: "center",
                takes: Type::Vector,
                preset: Preset::Alternative,
                excludes: &["min", "max"],
                help: "its centre",
                also_tried: POSITION,
                ..FIELD
            },
            Field {
                name: "size",
                takes: Type::Vector,
                preset: Preset::Value(Literal::Vector([0.5, 1.5, 2.0])),
                must: &[Condition::EachMoreThanZero],
                excludes: &["min", "max"],
                help: "its extents along x, y and z",
                also_tried: &["sides", "dimensions", "extent"],
                ..FIELD
            },
            Field {
                name: "min",
                takes: Type::Vector,
                preset: Preset::Alternative,
                excludes: &["center", "size"],
                help: "its corner of least coordinates, together with max",
                example: "(-1, 0, -1)",
                ..FIELD
            },
            Field {
                name: "max",
                takes: Type::Vector,
                preset: Preset::Alternative,
                excludes: &["center", "size"],
                help: "its corner of greatest coordinates, together with min",
                example: "(1, 1, 1)",
                ..FIELD
            },
            color("orange"),
        ],
        together: &["min < max on every axis"],
        also_tried: &["cube", "cuboid", "block", "crate", "brick"],
    },
    Block {
        kind: Kind::Checkerboard,
        name: "checkerboard",
        noun: "a checkerboard",
        is_object: true,
        help: "the infinite checkered floor in a horizontal plane",
        fields: &[
            Field {
                name: "y",
                preset: number(0.0),
                help: "the height of its plane",
                also_tried: &["height", "level"],
                ..FIELD
            },
            Field {
                name: "square",
                preset: number(1.0),
                must: &[Condition::MoreThan(0.0)],
                help: "the side of a square",
                also_tried: &["size", "side", "squares"],
                ..FIELD
            },
            Field {
                name: "colors",
                takes: Type::Colors,
                preset: Preset::Value(Literal::Colors(["gray", "white"])),
                help: "the colours of the even and of the odd squares",
                also_tried: &["color", "colour", "colours"],
                ..FIELD
            },
        ],
        together: &[],
        also_tried: &["plane", "floor", "ground", "checker", "chessboard", "board"],
    },
];

const PIXELS: &[Condition] = &[
    Condition::Whole,
    Condition::AtLeast(1.0),
    Condition::AtMostTwoTo(20),
];

const POSITION: &[&str] = &["position", "pos", "at", "centroid", "middle"];

const fn color(preset: &'static str) -> Field {
    Field {
        name: "color",
        takes: Type::Color,
        preset: Preset::Value(Literal::Color(preset)),
        help: "its colour",
        also_tried: &["fill", "material"],
        ..FIELD
    }
}
