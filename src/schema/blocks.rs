//! The table of blocks and their fields.

use super::{
    row_types::{Block, Choice, Condition, Field, Kind, Preset, Spread},
    types::Type,
};

/// A block without alternatives; rows start from it.
const BLOCK: Block = Block {
    kind: Kind::Image,
    name: "",
    noun: "",
    is_object: false,
    help: "",
    fields: &[],
    choices: &[],
    together: &[],
    spreads: &[],
    also_tried: &[],
};

/// Every block of the language.
pub const BLOCKS: &[Block] = &[
    Block {
        kind: Kind::Image,
        name: "image",
        noun: "an image",
        help: "the picture's size, and what is seen where nothing is hit",
        fields: &[
            Field::new("width", Type::Number)
                .help("the columns of pixels")
                .preset(Preset::Value("800"))
                .must(PIXELS)
                .tried(&["columns", "w"]),
            Field::new("height", Type::Number)
                .help("the rows of pixels")
                .preset(Preset::Value("450"))
                .must(PIXELS)
                .tried(&["rows", "h"]),
            Field::new("background", Type::Color)
                .help("the colour where nothing is hit")
                .preset(Preset::Value("black"))
                .tried(&["bg", "color", "colour", "sky"]),
        ],
        spreads: &[Spread {
            words: &["resolution", "size", "dimensions"],
            fields: &["width", "height"],
        }],
        also_tried: &["picture", "window", "film", "output"],
        ..BLOCK
    },
    Block {
        kind: Kind::Camera,
        name: "camera",
        noun: "a camera",
        help: "the pinhole camera: where it stands, where it looks, how much it sees",
        fields: &[
            Field::new("eye", Type::Vector)
                .help("the point that all rays pass through")
                .tried(&[
                    "position",
                    "pos",
                    "from",
                    "center",
                    "centre",
                    "origin",
                    "location",
                    "look_from",
                ])
                .like("(0, 2, 8)"),
            Field::new("lookat", Type::Vector)
                .help("the point that it looks at")
                .preset(Preset::Alternative)
                .tried(&["look_at", "target", "at", "to"]),
            Field::new("direction", Type::Vector)
                .help("the direction that it looks in, of any length")
                .preset(Preset::Alternative)
                .must(&[Condition::NotZero])
                .tried(&["dir", "forward"])
                .like("(0, 0, -1)"),
            Field::new("up", Type::Vector)
                .help("what is up in the picture")
                .preset(Preset::Value("(0, 1, 0)"))
                .must(&[Condition::NotZero]),
            Field::new("roll", Type::Angle)
                .help("the turn about the view direction; positive dips the right side")
                .preset(Preset::Value("0deg"))
                .tried(&["tilt", "rotation"]),
            Field::new("d", Type::Number)
                .help("the distance from the eye to the view plane")
                .preset(Preset::Value("2"))
                .must(&[Condition::MoreThan(0.0)])
                .tried(&["distance", "focal_length"]),
            Field::new("view_height", Type::Number)
                .help("the height of the window in the view plane")
                .preset(Preset::Value("2"))
                .must(&[Condition::MoreThan(0.0)])
                .tried(&["height"]),
            Field::new("fov", Type::Angle)
                .help("the angle that the window's height takes up, instead of d")
                .preset(Preset::Nothing)
                .must(&[Condition::LessThanHalfTurn])
                .tried(&["field_of_view", "vfov", "yfov"])
                .like("40deg"),
            Field::new("hfov", Type::Angle)
                .help("the angle that the window's width takes up, instead of d or fov")
                .preset(Preset::Nothing)
                .must(&[Condition::LessThanHalfTurn])
                .tried(&["angle", "xfov", "horizontal_fov"])
                .like("60deg"),
            Field::new("near", Type::Number)
                .help("nothing at this depth or nearer is seen")
                .preset(Preset::Value("0"))
                .must(&[Condition::AtLeast(0.0)]),
            Field::new("far", Type::Number)
                .help("nothing at this depth or farther is seen")
                .preset(Preset::Nothing),
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
        also_tried: &["cam", "view", "viewer", "eye"],
        ..BLOCK
    },
    Block {
        kind: Kind::Sampler,
        name: "sampler",
        noun: "a sampler",
        help: "where in a pixel samples are taken, and how many",
        fields: &[
            Field::new("method", Type::Method)
                .help("the sampling technique")
                .preset(Preset::Value("multi_jittered"))
                .tried(&["technique", "type", "kind", "pattern"]),
            Field::new("per_pixel", Type::Number)
                .help("the samples in each pixel")
                .preset(Preset::Value("16"))
                .must(&[Condition::Whole, Condition::AtLeast(1.0)])
                .tried(&["samples", "spp", "count", "n"]),
            Field::new("total", Type::Number)
                .help("the samples in the whole picture, instead of per_pixel")
                .preset(Preset::Nothing)
                .must(&[
                    Condition::Whole,
                    Condition::AtLeast(1.0),
                    Condition::AtMostTwoTo(53),
                ])
                .like("1_000_000"),
            Field::new("seed", Type::Number)
                .help("another seed gives other random samples")
                .preset(Preset::Value("0"))
                .must(&[
                    Condition::Whole,
                    Condition::AtLeast(0.0),
                    Condition::LessThanTwoTo(53),
                ]),
        ],
        choices: &[Choice {
            ways: &[&["per_pixel"], &["total"]],
            why: "either one says how many samples there are",
        }],
        together: &["per_pixel times the number of pixels is at most 2^53"],
        also_tried: &["sampling", "samples", "antialiasing"],
        ..BLOCK
    },
    Block {
        kind: Kind::Sphere,
        name: "sphere",
        noun: "a sphere",
        is_object: true,
        help: "a sphere",
        fields: &[
            Field::new("center", Type::Vector)
                .help("its centre")
                .tried(POSITION),
            Field::new("radius", Type::Number)
                .help("its radius")
                .preset(Preset::Value("1"))
                .must(&[Condition::MoreThan(0.0)])
                .tried(&["r", "size"])
                .doubled(&["diameter"]),
            color("olive"),
        ],
        also_tried: &["ball", "circle", "globe"],
        ..BLOCK
    },
    Block {
        kind: Kind::Triangle,
        name: "triangle",
        noun: "a triangle",
        is_object: true,
        help: "a triangle, by centroid, normal and the lengths of its sides or by its vertices",
        fields: &[
            Field::new("centroid", Type::Vector)
                .help("the mean of its vertices")
                .preset(Preset::Alternative)
                .tried(&[
                    "center", "centre", "position", "pos", "at", "middle", "location",
                ]),
            Field::new("normal", Type::Vector)
                .help("what its plane is perpendicular to, of any length")
                .preset(Preset::Alternative)
                .must(&[Condition::NotZero])
                .tried(&["direction", "facing"])
                .like("(0, 0, 1)"),
            Field::new("sides", Type::Vector)
                .help("the lengths of its left side, its right side and its base")
                .preset(Preset::Value("(2, 2, 1)"))
                .must(&[Condition::EachMoreThanZero])
                .tried(&["size", "lengths", "edges"]),
            Field::new("spin", Type::Angle)
                .help("its turn in its plane, counter-clockwise seen from the tip of the normal")
                .preset(Preset::Value("0deg"))
                .tried(&["roll", "rotation", "turn"]),
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
            Field::new("center", Type::Vector)
                .help("its centre")
                .preset(Preset::Alternative)
                .tried(POSITION),
            Field::new("size", Type::Vector)
                .help("its extents along x, y and z")
                .preset(Preset::Value("(0.5, 1.5, 2)"))
                .must(&[Condition::EachMoreThanZero])
                .tried(&["sides", "dimensions", "extent"]),
            Field::new("min", Type::Vector)
                .help("its corner of least coordinates, together with max")
                .preset(Preset::Alternative)
                .like("(-1, 0, -1)"),
            Field::new("max", Type::Vector)
                .help("its corner of greatest coordinates, together with min")
                .preset(Preset::Alternative)
                .like("(1, 1, 1)"),
            color("orange"),
        ],
        choices: &[Choice {
            ways: &[&["center", "size"], &["min", "max"]],
            why: "a box is given by center and size, or by min and max",
        }],
        together: &["min < max on every axis"],
        also_tried: &["cube", "cuboid", "block", "crate", "brick"],
        ..BLOCK
    },
    Block {
        kind: Kind::Checkerboard,
        name: "checkerboard",
        noun: "a checkerboard",
        is_object: true,
        help: "the infinite checkered floor in a horizontal plane",
        fields: &[
            Field::new("y", Type::Number)
                .help("the height of its plane")
                .preset(Preset::Value("0"))
                .tried(&["height", "level"]),
            Field::new("square", Type::Number)
                .help("the side of a square")
                .preset(Preset::Value("1"))
                .must(&[Condition::MoreThan(0.0)])
                .tried(&["size", "side", "squares"]),
            Field::new("colors", Type::Colors)
                .help("the colours of the even and of the odd squares")
                .preset(Preset::Value("(gray, white)"))
                .tried(&["color", "colour", "colours"]),
        ],
        also_tried: &["plane", "floor", "ground", "checker", "chessboard", "board"],
        ..BLOCK
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
    Field::new(name, Type::Vector)
        .help("one of its vertices, together with the two others")
        .preset(Preset::Alternative)
        .tried(also_tried)
        .like(example)
}

const fn color(preset: &'static str) -> Field {
    Field::new("color", Type::Color)
        .help("its colour")
        .preset(Preset::Value(preset))
        .tried(&["fill", "material"])
}
