//! The tables of predefined words: functions and constants.

use super::types::Type;

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
            parameters: &[],
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
        Function {
            parameters: &["y", "x"],
            ..of(
                "atan2",
                &[Number, Number],
                Angle,
                "the angle of the point (x, y), called atan2(y, x)",
            )
        },
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
        Function {
            parameters: &["red", "green", "blue"],
            ..of(
                "rgb",
                &[Number, Number, Number],
                Color,
                "a colour of red, green and blue, 0 to 255 each",
            )
        },
    ]
};

/// What there is to know about a function.
#[derive(Clone, Copy, Debug)]
pub struct Function {
    /// Its name.
    pub name: &'static str,
    /// The types of its arguments.
    pub takes: &'static [Type],
    /// What its arguments are called; nothing where their types say it all.
    pub parameters: &'static [&'static str],
    /// Whether it takes more of the last type.
    pub more: bool,
    /// The type of its result.
    pub gives: Type,
    /// What it is, in a line.
    pub help: &'static str,
}

impl Function {
    /// The type of an argument, by how many stand before it.
    pub fn parameter(&self, index: usize) -> Option<Type> {
        let last = self.takes.last().filter(|_| self.more);
        self.takes.get(index).or(last).copied()
    }

    /// Arguments that it can have, as they are written.
    pub fn example(&self) -> &'static [&'static str] {
        use Type::{Angle, Number, Vector};
        match self.takes {
            // Of those of the cross product it is 0, which few fields take.
            [Vector, Vector] if self.gives == Number => &["(1, 2, 3)", "(0, 1, 0)"],
            [Vector, Vector] => &["(1, 0, 0)", "(0, 1, 0)"],
            [Vector] => &["(1, 2, 3)"],
            [Angle] => &["30deg"],
            [Number] => &["0.5"],
            [Number, Number] => &["1", "2"],
            _ => &["255", "165", "0"],
        }
    }

    /// Whether it takes so many arguments.
    pub fn accepts(&self, count: usize) -> bool {
        count == self.takes.len() || (self.more && count > self.takes.len())
    }
}

/// The predefined names that are neither colours nor functions, with a line of help.
pub const CONSTANTS: &[(&str, &str)] = &[
    ("pi", "the number 3.141592653589793"),
    ("deg", "the angle 1deg"),
    ("rad", "the angle 1rad"),
];
