//! The facts of the language: its blocks and their fields, types, defaults and conditions, with a line of help each.
//!
//! Each fact stands here once. Lowering fills the scene from these rows, nearest names are sought among them, and the
//! language's reference is tested against them.

use std::fmt;

use super::Method;

/// A kind of block.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// The picture.
    Image,
    /// The camera.
    Camera,
    /// The samples.
    Sampler,
    /// A sphere.
    Sphere,
    /// A triangle.
    Triangle,
    /// A box.
    Box,
    /// The checkerboard.
    Checkerboard,
}

/// What there is to know about a kind of block.
#[derive(Debug)]
pub struct Block {
    /// Its kind.
    pub kind: Kind,
    /// The word that it starts with.
    pub name: &'static str,
    /// The word with its article, for messages.
    pub noun: &'static str,
    /// Whether it is an object: it may have a name, and there may be many.
    pub is_object: bool,
    /// What it is, in a line.
    pub help: &'static str,
    /// Its fields.
    pub fields: &'static [Field],
    /// Conditions between fields.
    pub together: &'static [&'static str],
    /// Other words that people try for it.
    pub also_tried: &'static [&'static str],
}

/// What there is to know about a field.
#[derive(Debug)]
pub struct Field {
    /// Its name.
    pub name: &'static str,
    /// What it takes.
    pub takes: Type,
    /// What it is when it is not given.
    pub preset: Preset,
    /// What its value must be.
    pub must: &'static [Condition],
    /// The fields that it excludes.
    pub excludes: &'static [&'static str],
    /// What it is, in a line.
    pub help: &'static str,
    /// Other words that people try for it.
    pub also_tried: &'static [&'static str],
    /// A value that it can have, if neither its default nor any of its type will do.
    pub example: &'static str,
}

/// What a value can be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Type {
    /// A number.
    Number,
    /// A number with a unit.
    Angle,
    /// Three numbers.
    Vector,
    /// An sRGB colour.
    Color,
    /// Two colours.
    Colors,
    /// The name of a sampling technique.
    Method,
}

impl Type {
    /// The type with its article.
    pub fn noun(self) -> &'static str {
        match self {
            Self::Number => "a number",
            Self::Angle => "an angle",
            Self::Vector => "a vector",
            Self::Color => "a colour",
            Self::Colors => "a pair of colours",
            Self::Method => "a method",
        }
    }

    /// Two of the type.
    pub fn two(self) -> &'static str {
        match self {
            Self::Number => "two numbers",
            Self::Angle => "two angles",
            Self::Vector => "two vectors",
            Self::Color => "two colours",
            Self::Colors => "two pairs of colours",
            Self::Method => "two methods",
        }
    }
}

/// What a field is when it is not given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Preset {
    /// It must be given.
    Required,
    /// It, or one of those that it excludes, must be given.
    Alternative,
    /// Nothing.
    Nothing,
    /// This.
    Value(Literal),
}

/// A value as the table writes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Literal {
    /// A number.
    Number(f64),
    /// An angle in degrees.
    Degrees(f64),
    /// A vector.
    Vector([f64; 3]),
    /// A colour's name.
    Color(&'static str),
    /// Two colours' names.
    Colors([&'static str; 2]),
    /// A method's name.
    Method(&'static str),
}

/// As it is written in a scene.
impl fmt::Display for Literal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number}"),
            Self::Degrees(degrees) => write!(f, "{degrees}deg"),
            Self::Vector([x, y, z]) => write!(f, "({x}, {y}, {z})"),
            Self::Color(name) | Self::Method(name) => f.write_str(name),
            Self::Colors([first, second]) => write!(f, "({first}, {second})"),
        }
    }
}

/// What a field's value must be, beyond its type.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Condition {
    /// A number without a fraction.
    Whole,
    /// A number above this one.
    MoreThan(f64),
    /// A number not below this one.
    AtLeast(f64),
    /// A number not above 2 to this power.
    AtMostTwoTo(u32),
    /// A number below 2 to this power.
    LessThanTwoTo(u32),
    /// An angle between 0 and 180 degrees, both excluded.
    LessThanHalfTurn,
    /// A vector other than zero.
    NotZero,
    /// A vector whose three parts are above 0.
    EachMoreThanZero,
}

/// What the value must be, in words.
impl fmt::Display for Condition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Whole => f.write_str("a whole number"),
            Self::MoreThan(bound) => write!(f, "more than {bound}"),
            Self::AtLeast(bound) => write!(f, "at least {bound}"),
            Self::AtMostTwoTo(power) => write!(f, "at most {} (2^{power})", 1_u64 << power),
            Self::LessThanTwoTo(power) => write!(f, "less than 2^{power}"),
            Self::LessThanHalfTurn => f.write_str("more than 0 and less than 180deg"),
            Self::NotZero => f.write_str("other than (0, 0, 0)"),
            Self::EachMoreThanZero => f.write_str("more than 0 in every part"),
        }
    }
}

/// A block's row, found by its word.
pub fn block(name: &str) -> Option<&'static Block> {
    BLOCKS.iter().find(|block| block.name == name)
}

impl Block {
    /// A field's row, found by its name.
    pub fn field(&self, name: &str) -> Option<&'static Field> {
        self.fields.iter().find(|field| field.name == name)
    }

    /// The names of its fields.
    pub fn field_names(&self) -> impl Iterator<Item = &'static str> + use<> {
        self.fields.iter().map(|field| field.name)
    }

    /// The field that was probably meant, if any is near.
    pub fn nearest_field(&self, written: &str) -> Option<&'static str> {
        let tried = |field: &&Field| also(written, field.also_tried);
        let tried = self.fields.iter().find(tried).map(|field| field.name);
        tried.or_else(|| crate::suggest::nearest(written, self.field_names()))
    }

    /// The field whose name another word was joined to: `centerball` is the center and `ball`.
    pub fn joined_field(&self, written: &str) -> Option<&'static str> {
        let joined = |name: &&str| name.len() > 2 && written.starts_with(*name);
        self.field_names()
            .filter(joined)
            .max_by_key(|name| name.len())
    }
}

/// The words that blocks start with.
pub fn block_names() -> impl Iterator<Item = &'static str> {
    BLOCKS.iter().map(|block| block.name)
}

/// The block that was probably meant, if any is near.
pub fn nearest_block(written: &str) -> Option<&'static Block> {
    let tried = BLOCKS.iter().find(|block| also(written, block.also_tried));
    tried.or_else(|| crate::suggest::nearest(written, block_names()).and_then(block))
}

fn also(written: &str, tried: &[&str]) -> bool {
    tried.iter().any(|name| name.eq_ignore_ascii_case(written))
}

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
                ..FIELD
            },
            Field {
                name: "max",
                takes: Type::Vector,
                preset: Preset::Alternative,
                excludes: &["center", "size"],
                help: "its corner of greatest coordinates, together with min",
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

/// Every sampling technique, with a line of help.
pub const METHODS: &[(Method, &str)] = &[
    (Method::Regular, "an even grid, centred"),
    (Method::Random, "independent and uniform"),
    (Method::Jittered, "one at random in each cell of a grid"),
    (Method::NRooks, "one in each row and each column"),
    (Method::MultiJittered, "jittered and n_rooks at once"),
    (
        Method::Hammersley,
        "the Hammersley points, shifted per pixel",
    ),
    (Method::Halton, "the Halton points, shifted per pixel"),
    (
        Method::Sobol,
        "Sobol' points with Owen scrambling, per pixel",
    ),
    (Method::Scatter, "points uniform over the whole picture"),
    (Method::Exact, "no samples: the mean itself, computed"),
];

/// A method, found by its name.
pub fn method(name: &str) -> Option<Method> {
    let mut methods = METHODS.iter().map(|&(method, _)| method);
    methods.find(|method| method.name() == name)
}

/// The names of the methods.
pub fn method_names() -> impl Iterator<Item = &'static str> {
    METHODS.iter().map(|(method, _)| method.name())
}

/// A function's row, found by its name.
pub fn function(name: &str) -> Option<&'static Function> {
    FUNCTIONS.iter().find(|function| function.name == name)
}

/// Every function, with what it takes and gives.
pub const FUNCTIONS: &[Function] = {
    use Type::{Angle, Color, Number, Vector};
    const fn of(
        name: &'static str,
        takes: &'static [Type],
        gives: Type,
        help: &'static str,
    ) -> Function {
        Function {
            name,
            takes,
            more: false,
            gives,
            help,
        }
    }
    &[
        of("sin", &[Angle], Number, "the sine of an angle"),
        of("cos", &[Angle], Number, "the cosine of an angle"),
        of("tan", &[Angle], Number, "the tangent of an angle"),
        of("asin", &[Number], Angle, "the angle of this sine"),
        of("acos", &[Number], Angle, "the angle of this cosine"),
        of("atan", &[Number], Angle, "the angle of this tangent"),
        of(
            "atan2",
            &[Number, Number],
            Angle,
            "the angle of the point (x, y), called atan2(y, x)",
        ),
        of("sqrt", &[Number], Number, "the square root"),
        of("abs", &[Number], Number, "the number without its sign"),
        Function {
            more: true,
            ..of(
                "min",
                &[Number, Number],
                Number,
                "the least of two or more numbers",
            )
        },
        Function {
            more: true,
            ..of(
                "max",
                &[Number, Number],
                Number,
                "the greatest of two or more numbers",
            )
        },
        of("length", &[Vector], Number, "the length of a vector"),
        of("dot", &[Vector, Vector], Number, "the dot product"),
        of("cross", &[Vector, Vector], Vector, "the cross product"),
        of(
            "normalize",
            &[Vector],
            Vector,
            "the vector of length 1 in the same direction",
        ),
        of(
            "rgb",
            &[Number, Number, Number],
            Color,
            "a colour of red, green and blue, 0 to 255 each",
        ),
    ]
};

/// What there is to know about a function.
#[derive(Clone, Copy, Debug)]
pub struct Function {
    /// Its name.
    pub name: &'static str,
    /// The types of its arguments.
    pub takes: &'static [Type],
    /// Whether it takes more of the last type.
    pub more: bool,
    /// The type of its result.
    pub gives: Type,
    /// What it is, in a line.
    pub help: &'static str,
}

/// The predefined names that are neither colours nor functions, with a line of help.
pub const CONSTANTS: &[(&str, &str)] = &[
    ("pi", "the number 3.141592653589793"),
    ("deg", "the angle 1deg"),
    ("rad", "the angle 1rad"),
];
