//! Points for pictures: a right picture gets the total, and each mistake subtracts points.

use std::{collections::BTreeMap, path::Path};

use serde_json::Value;

use super::{criteria, graded::JudgedPicture};
use crate::{
    cli::{CommandError, input::unreadable},
    files,
    grading::Kind,
};

/// Maximum length of the file in `--points`, in bytes. A longer file is an error. A scheme of
/// points is a short text, so the limit only keeps a wrong file from filling the memory.
const LIMIT: u64 = 1 << 20;

/// Key in the JSON object `mistakes`. Its value is the number of points for each mistake that has
/// no key of its own.
const OTHERS: &str = "*";

/// A scheme of points, read from the file in `--points`.
#[derive(Debug)]
pub struct PointScheme {
    /// Points for a right picture.
    pub total: f64,
    /// Points that are subtracted once for each wrong object, for all its mistakes whose ids are
    /// not in `mistakes`. A mistake whose id is in `mistakes` costs the points given there in
    /// addition. If this is `None`, each mistake whose id is not in `mistakes` costs the points of
    /// [`OTHERS`].
    object: Option<f64>,
    /// Points that each mistake costs, by the mistake's id. The key [`OTHERS`] gives the points of
    /// the ids that are not listed.
    mistakes: BTreeMap<String, f64>,
}

impl PointScheme {
    /// Reads a scheme of points from a JSON file such as
    /// `{"total": 20, "object": 2, "mistakes": {"roll_sign": 3, "*": 2}}`.
    ///
    /// # Errors
    ///
    /// Returns an error if the file has another form, or names an unknown mistake.
    pub fn read(path: &Path) -> Result<Self, CommandError> {
        let bytes = files::read(path, LIMIT).map_err(|error| unreadable(path, &error))?;
        let value: Value =
            serde_json::from_slice(&bytes).map_err(|error| unreadable(path, &error))?;
        Self::of(&value).map_err(|why| unreadable(path, &why))
    }

    fn of(value: &Value) -> Result<Self, String> {
        let form =
            "points are {\"total\": 20, \"object\": 2, \"mistakes\": {\"roll_sign\": 3, \"*\": 2}}";
        let fields = value.as_object().ok_or(form)?;
        let number = |name: &str, value: &Value| match value.as_f64() {
            Some(points) if points >= 0.0 && points.is_finite() => Ok(points),
            _ => Err(format!(
                "`{name}` is {value}, and points are numbers from 0 on"
            )),
        };
        if let Some(other) = fields
            .keys()
            .find(|key| !["total", "object", "mistakes"].contains(&&***key))
        {
            return Err(format!("there is no `{other}` among points: {form}"));
        }
        let total = fields
            .get("total")
            .ok_or("`total` is missing: what a right picture gets")?;
        let object = fields.get("object").map(|value| number("object", value));
        let empty = serde_json::Map::new();
        let listed = match fields.get("mistakes") {
            Some(listed) => listed.as_object().ok_or(form)?,
            None => &empty,
        };
        let mut mistakes = BTreeMap::new();
        for (id, value) in listed {
            if id != OTHERS && !criteria::is_id(id) {
                let near = crate::suggest::nearest(id, criteria::ids());
                let near =
                    near.map_or_else(String::new, |near| format!(": did you mean `{near}`?"));
                return Err(format!("there is no mistake `{id}`{near}"));
            }
            mistakes.insert(id.clone(), number(id, value)?);
        }
        if !mistakes.contains_key(OTHERS) {
            return Err(
                "`mistakes` has no `*`, which says what any other mistake takes off".to_owned(),
            );
        }
        Ok(Self {
            total: number("total", total)?,
            object: object.transpose()?,
            mistakes,
        })
    }

    /// Returns the points of a picture; `None` if the picture is wrong for unknown reasons.
    pub fn score(&self, judged: &JudgedPicture) -> Option<f64> {
        match judged.verdict.kind {
            Kind::Right | Kind::Noise => Some(self.total),
            Kind::Wrong => {
                let off: f64 = self.taken_off(judged).iter().sum();
                Some((self.total - off).max(0.0))
            }
            Kind::Unknown => None,
        }
    }

    /// Returns the points that each mistake of a picture costs, in the order of the mistakes.
    fn taken_off(&self, judged: &JudgedPicture) -> Vec<f64> {
        let mut objects = Vec::new();
        let mistakes = &judged.verdict.mistakes;
        let points = mistakes.iter().map(|mistake| {
            let listed = self.mistakes.get(mistake.id).copied();
            match (listed, mistake.object, self.object) {
                (Some(points), ..) => points,
                (None, Some(object), Some(_)) if objects.contains(&object) => 0.0,
                (None, Some(object), Some(points)) => {
                    objects.push(object);
                    points
                }
                _ => self.mistakes[OTHERS],
            }
        });
        points.collect()
    }
}
