//! The table of blocks and their fields.

use super::{
    rows::{Block, Choice, Condition, Field, Kind, Literal, Preset, Spread},
    types::Type,
};

/// A field without conditions or alternatives; rows start from it.
const FIELD: Field = Field {
    name: "",
    takes: Type::Number,
    preset: Preset::Required,
    must: &[],
    help: "",
    also_tried: &[],
    doubled: &[],
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
        choices: &[],
        together: &[],
        spreads: &[Spread {
            words: &["resolution", "size", "dimensions"],
            fields: &["width", "height"],
        }],
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
                also_tried: &[
                    "position",
                    "pos",
                    "from",
                    "center",
                    "centre",
                    "origin",
                    "location",
                    "look_from",
                ],
                example: "(0, 2, 8)",
                ..FIELD
            },
            Field {
                name: "lookat",
                takes: Type::Vector,
                preset: Preset::Alternative,
                help: "the point that it looks at",
                also_tried: &["look_at", "target", "at", "to"],
                ..FIELD
            },
            Field {
                name: "direction",
                takes: Type::Vector,
                preset: Preset::Alternative,
                must: &[Condition::NotZero],
                help: "the direction that it looks in, of any length",
                also_tried: &["dir", "forward"],
                example: "(0, 0, -1)",
                ..FIELD
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
                help: "the angle that the window's height takes up, instead of d",
                also_tried: &["field_of_view", "vfov", "yfov"],
                example: "40deg",
                ..FIELD
            },
            Field {
                name: "hfov",
                takes: Type::Angle,
                preset: Preset::Nothing,
                must: &[Condition::LessThanHalfTurn],
                help: "the angle that the window's width takes up, instead of d or fov",
                also_tried: &["angle", "xfov", "horizontal_fov"],
                example: "60deg",
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
        choices: &[
            Choice {
                ways: &[&["lookat"], &["direction"]],
                why: "either a point or a direction says where the camera looks",
            },
            Choice {
                ways: &[&["d"], &["fov"], &["hfov"]],
                why: "one of d, fov and hfov says how much the camera sees",
            },
        ],
        together: &["lookat ≠ eye", "near < far"],
        spreads: &[],
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
        choices: &[Choice {
            ways: &[&["per_pixel"], &["total"]],
            why: "either one says how many samples there are",
        }],
        spreads: &[],
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
                doubled: &["diameter"],
                ..FIELD
            },
            color("olive"),
        ],
        choices: &[],
        together: &[],
        spreads: &[],
        also_tried: &["ball", "circle", "globe"],
    },
    Block {
        kind: Kind::Triangle,
        name: "triangle",
        noun: "a triangle",
        is_object: true,
        help: "a triangle, by centroid, normal and the lengths of its sides or by its vertices",
        fields: &[
            Field {
                name: "centroid",
                takes: Type::Vector,
                preset: Preset::Alternative,
                help: "the mean of its vertices",
                also_tried: &[
                    "center", "centre", "position", "pos", "at", "middle", "location",
                ],
                ..FIELD
            },
            Field {
                name: "normal",
                takes: Type::Vector,
                preset: Preset::Alternative,
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
            vertex("v0", "(-1, 0, 0)", &["a", "p0", "vertex0"]),
            vertex("v1", "(1, 0, 0)", &["b", "p1", "vertex1"]),
            vertex("v2", "(0, 1, 0)", &["c", "p2", "vertex2"]),
            color("teal"),
        ],
        choices: &[Choice {
            ways: &[
                &["centroid", "normal", "sides", "spin"],
                &["v0", "v1", "v2"],
            ],
            why: "a triangle is given by centroid, normal and sides, or by v0, v1 and v2",
        }],
        spreads: &[Spread {
            words: &["vertices", "points", "corners", "vertex"],
            fields: &["v0", "v1", "v2"],
        }],
        together: &[
            "the sides form a triangle: each is shorter than the two others together",
            "v0, v1 and v2 do not lie on one line",
        ],
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
                help: "its centre",
                also_tried: POSITION,
                ..FIELD
            },
            Field {
                name: "size",
                takes: Type::Vector,
                preset: Preset::Value(Literal::Vector([0.5, 1.5, 2.0])),
                must: &[Condition::EachMoreThanZero],
                help: "its extents along x, y and z",
                also_tried: &["sides", "dimensions", "extent"],
                ..FIELD
            },
            Field {
                name: "min",
                takes: Type::Vector,
                preset: Preset::Alternative,
                help: "its corner of least coordinates, together with max",
                example: "(-1, 0, -1)",
                ..FIELD
            },
            Field {
                name: "max",
                takes: Type::Vector,
                preset: Preset::Alternative,
                help: "its corner of greatest coordinates, together with min",
                example: "(1, 1, 1)",
                ..FIELD
            },
            color("orange"),
        ],
        choices: &[Choice {
            ways: &[&["center", "size"], &["min", "max"]],
            why: "a box is given by center and size, or by min and max",
        }],
        spreads: &[],
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
        choices: &[],
        together: &[],
        spreads: &[],
        also_tried: &["plane", "floor", "ground", "checker", "chessboard", "board"],
    },
];

const PIXELS: &[Condition] = &[
    Condition::Whole,
    Condition::AtLeast(1.0),
    Condition::AtMostTwoTo(20),
];

const POSITION: &[&str] = &["position", "pos", "at", "centroid", "middle", "location"];

const fn vertex(
    name: &'static str,
    example: &'static str,
    also_tried: &'static [&'static str],
) -> Field {
    Field {
        name,
        takes: Type::Vector,
        preset: Preset::Alternative,
        help: "one of its vertices, together with the two others",
        also_tried,
        example,
        ..FIELD
    }
}

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
