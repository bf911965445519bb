//! The values of a block's fields.

use glam::DVec3;

use super::Block;
use crate::{
    color::Color,
    math::Angle,
    scene::{
        Method, css,
        schema::{self, Kind, Literal, Preset},
        value::Value,
    },
};

/// The values of a block's fields, defaults included. None where a value is missing or failed.
pub(super) struct Fields<'b, 's> {
    block: Option<&'b Block<'s>>,
    kind: Kind,
}

impl<'b, 's> Fields<'b, 's> {
    pub(super) fn of(block: Option<&'b Block<'s>>, kind: Kind) -> Self {
        Self { block, kind }
    }

    fn value(&self, name: &str) -> Option<Value> {
        if let Some(given) = self.block.and_then(|block| block.given(name)) {
            return given.value;
        }
        let row = schema::BLOCKS.iter().find(|row| row.kind == self.kind)?;
        match row.field(name)?.preset {
            Preset::Value(literal) => preset(literal),
            Preset::Required | Preset::Alternative | Preset::Nothing => None,
        }
    }

    pub(super) fn number(&self, name: &str) -> Option<f64> {
        match self.value(name)? {
            Value::Number(number) => Some(number),
            _ => None,
        }
    }

    pub(super) fn angle(&self, name: &str) -> Option<Angle> {
        match self.value(name)? {
            Value::Angle(angle) => Some(angle),
            _ => None,
        }
    }

    pub(super) fn vector(&self, name: &str) -> Option<DVec3> {
        match self.value(name)? {
            Value::Vector(vector) => Some(vector),
            _ => None,
        }
    }

    pub(super) fn color(&self, name: &str) -> Option<Color> {
        match self.value(name)? {
            Value::Color(color) => Some(color),
            _ => None,
        }
    }

    pub(super) fn colors(&self, name: &str) -> Option<[Color; 2]> {
        match self.value(name)? {
            Value::Colors(colors) => Some(colors),
            _ => None,
        }
    }

    pub(super) fn method(&self, name: &str) -> Option<Method> {
        match self.value(name)? {
            Value::Method(method) => Some(method),
            _ => None,
        }
    }
}

fn preset(literal: Literal) -> Option<Value> {
    Some(match literal {
        Literal::Number(number) => Value::Number(number),
        Literal::Degrees(degrees) => Value::Angle(Angle::from_degrees(degrees)),
        Literal::Vector(vector) => Value::Vector(DVec3::from_array(vector)),
        Literal::Color(name) => Value::Color(css::color(name)?),
        Literal::Colors([first, second]) => {
            Value::Colors([css::color(first)?, css::color(second)?])
        }
        Literal::Method(name) => Value::Method(schema::method(name)?),
    })
}
