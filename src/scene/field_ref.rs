//! Reference to the value of a field, whatever its type.

use glam::DVec3;

use crate::{color::Color, math::Angle, schema::Value};

/// Mutable reference to the value of a field, by its type.
pub(super) enum FieldRef<'a> {
    Number(&'a mut f64),
    Angle(&'a mut Angle),
    Vector(&'a mut DVec3),
    Color(&'a mut Color),
    Colors(&'a mut [Color; 2]),
    FaceColors(&'a mut [Color; 3]),
}

impl FieldRef<'_> {
    /// Returns the field's value.
    pub fn get(self) -> Value {
        match self {
            Self::Number(number) => Value::Number(*number),
            Self::Angle(angle) => Value::Angle(*angle),
            Self::Vector(vector) => Value::Vector(*vector),
            Self::Color(color) => Value::Color(*color),
            Self::Colors(colors) => Value::Colors(*colors),
            Self::FaceColors(colors) => Value::FaceColors(*colors),
        }
    }

    /// Sets the field's value. Returns `None` and changes nothing if the new value has another
    /// type.
    pub fn set(self, value: Value) -> Option<()> {
        match (self, value) {
            (Self::Number(field), Value::Number(number)) => *field = number,
            (Self::Angle(field), Value::Angle(angle)) => *field = angle,
            (Self::Vector(field), Value::Vector(vector)) => *field = vector,
            (Self::Color(field), Value::Color(color)) => *field = color,
            (Self::Colors(field), Value::Colors(colors)) => *field = colors,
            (Self::FaceColors(field), Value::FaceColors(colors)) => *field = colors,
            _ => return None,
        }
        Some(())
    }
}
