//! The camera: what its fields come to, and what it sees.

use glam::DVec3;

use super::{
    Block, Given, Lowering,
    field_fixes::{examples, quoted},
    fields::Fields,
};
use crate::{
    diagnostic::{Edit, Fix},
    math::predicates,
    numbers,
    scene::{
        Camera, Image, Lens, Object, View,
        error::Problem,
        level_direction,
        schema::Kind,
        unseen::{self, LEAST_SINE, Unseen, why_unseen},
    },
    source::{SourceId, Span},
};

impl<'s> Lowering<'s> {
    pub(super) fn camera(&mut self, block: &Block<'s>) -> Option<Camera> {
        let fields = Fields::of(Some(block), Kind::Camera);
        let eye = fields.vector("eye");
        let up = fields.vector("up");
        let direction = block.given("direction");
        let mut view_is_defined = true;
        let view = match direction {
            Some(_) => fields.vector("direction").map(View::Direction),
            None => fields.vector("lookat").map(View::Lookat),
        };
        let seen = block.given("lookat").or(direction);
        if let (Some(eye), Some(view), Some(seen)) = (eye, view, seen) {
            match view {
                View::Lookat(point) if point == eye => {
                    self.problems.push(
                        Problem::ViewUndefined {
                            lookat: seen.span,
                            eye: block.given("eye").map_or(block.keyword, |given| given.span),
                        }
                        .with(direction_for(block, seen.field())),
                    );
                    // A camera that looks nowhere is none, for those too who show what there is of a broken scene.
                    view_is_defined = false;
                }
                _ => self.up_parallel(block, eye, view, up, seen),
            }
        }
        let near = fields.number("near");
        let far = block
            .given("far")
            .map(|given| (given, fields.number("far")));
        if let (Some(near), Some((given, Some(far)))) = (near, far)
            && near >= far
        {
            self.empty_depth(block, near, far, given);
        }
        let lens = if block.given("fov").is_some() {
            fields.angle("fov").map(Lens::Fov)
        } else if block.given("hfov").is_some() {
            fields.angle("hfov").map(Lens::HorizontalFov)
        } else {
            fields.number("d").map(Lens::Distance)
        };
        Some(Camera {
            eye: eye?,
            view: view.filter(|_| view_is_defined)?,
            up: up?,
            roll: fields.angle("roll")?,
            lens: lens?,
            view_height: fields.number("view_height")?,
            near: near?,
            far: match far {
                Some((_, far)) => Some(far?),
                None => None,
            },
        })
    }

    fn up_parallel(
        &mut self,
        block: &Block<'s>,
        eye: DVec3,
        view: View,
        up: Option<DVec3>,
        seen: Given,
    ) {
        let Some(up) = up else { return };
        let (from, to) = view.ends(eye);
        let is_parallel = predicates::cross_is_zero(up, from, to);
        let sine = up.normalize().cross((to - from).normalize()).length();
        // What is not a number is not less.
        if !(is_parallel || sine < LEAST_SINE) {
            return;
        }
        // Against up, the top of the picture is the part of the level direction across up; along up, the opposite.
        // The scale of up does not matter, and its square could be too large.
        let up = up / up.abs().max_element();
        let level = level_direction(up);
        let across = level * up.dot(up) - up * level.dot(up);
        let along = predicates::dot_sign(up, from, to).is_gt();
        let top = if along { -across } else { across };
        let vector = numbers::short_vector(top / top.abs().max_element());
        let shown = axis_name(top).unwrap_or_else(|| format!("towards {vector}"));
        let suggested = axis_vector(top).unwrap_or(vector);
        let given = block.given("up");
        let looks = match view {
            _ if !is_parallel => {
                "less than a millionth of a radian off the view direction".to_owned()
            }
            View::Lookat(_) if given.is_some() => "parallel to the view direction".to_owned(),
            View::Lookat(_) => format!(
                "straight along up, which is {} if not given",
                numbers::short_vector(up)
            ),
            View::Direction(_) if given.is_some() => "parallel to the view direction".to_owned(),
            View::Direction(_) => format!(
                "parallel to up, which is {} if not given",
                numbers::short_vector(up)
            ),
        };
        let up = match given {
            Some(given) => Some(Fix::write(given.span, &suggested)),
            None => self.add_fields(
                block,
                format!("add `up {suggested}`"),
                &[format!("up {suggested}")],
            ),
        };
        self.problems.push(Problem::UpParallel {
            message: match is_parallel {
                true => "the camera looks straight along its up vector",
                false => "the camera looks all but straight along its up vector",
            },
            help: match is_parallel {
                true => format!(
                    "the top of the picture is {shown} here; give another `up`, such as `up {suggested}`, to say so yourself"
                ),
                false => format!(
                    "which way is up hangs on the last digits of these numbers; give another `up`, such as `up {suggested}`"
                ),
            },
            span: given.map_or(seen.span, |given| given.span),
            label: looks,
        }.with(up));
    }

    fn empty_depth(&mut self, block: &Block<'s>, near: f64, far: f64, given: Given) {
        let near_given = block.given("near");
        let (shown_near, shown_far) =
            (numbers::beside(near, &[far]), numbers::beside(far, &[near]));
        let text = |given: Given| self.sources.text(given.span);
        let fix = match near_given {
            Some(near_given) if far > 0.0 && near > far => Fix::new(
                "exchange `near` and `far`",
                [
                    Edit::new(near_given.span, text(given)),
                    Edit::new(given.span, text(near_given)),
                ],
            ),
            _ => Fix::remove_whole("leave `far` out", [given.field()], self.sources),
        };
        self.problems.push(
            Problem::EmptyDepth {
                help: match near_given {
                    Some(_) if far > 0.0 && near > far => {
                        format!("exchange them: `near {shown_far}  far {shown_near}`")
                    }
                    _ => format!("write a number above {shown_near} after `far`, or leave it out"),
                },
                far: given.span,
                far_label: match near_given {
                    Some(_) => format!("{shown_far} is not more"),
                    None => format!("not more than `near`, which is {shown_near} if not given"),
                },
                near: near_given.map(|given| given.span),
                near_label: format!("than {shown_near}"),
            }
            .with([fix]),
        );
    }

    /// Warns where the camera sees nothing of the scene.
    pub(super) fn unseen(
        &mut self,
        block: &Block<'s>,
        camera: &Camera,
        image: &Image,
        objects: &[Object],
    ) {
        let Some(why) = why_unseen(camera, image, objects) else {
            return;
        };
        let span = |name| block.given(name).map(|given| given.span);
        let view = span("lookat")
            .or(span("direction"))
            .unwrap_or(block.keyword);
        let cut = |names: &[&str]| {
            let given: Vec<Given> = names.iter().filter_map(|name| block.given(name)).collect();
            let fix = Fix::remove_whole(
                format!("leave {} out", quoted(names)),
                given.iter().map(|given| given.field()),
                self.sources,
            );
            (given.first().map_or(view, |given| given.span), fix)
        };
        let (message, label, help, (span, fix)) = match why {
            Unseen::Behind | Unseen::Outside => {
                let middle = objects
                    .iter()
                    .find_map(|object| unseen::middle(&object.shape));
                let towards = middle.and_then(|middle| towards(camera, middle));
                let fix = towards.as_ref().map(|towards| Fix::write(view, towards));
                let help = match (camera.view, &towards) {
                    (View::Lookat(_), Some(point)) => {
                        format!("look at an object, such as `lookat {point}`")
                    }
                    (View::Direction(_), Some(way)) => {
                        format!("look at an object, such as by `direction {way}`")
                    }
                    (_, None) => "turn the camera, or move it".to_owned(),
                };
                let (message, label) = match why {
                    Unseen::Behind => ("everything is behind the camera", "away from everything"),
                    _ => ("the camera sees nothing of the scene", "past everything"),
                };
                (message, label, help, (view, fix))
            }
            Unseen::Near | Unseen::Far | Unseen::NearAndFar => {
                let (message, label, names): (_, _, &[&str]) = match why {
                    Unseen::Near => (
                        "everything is nearer than `near`",
                        "beyond everything",
                        &["near"],
                    ),
                    Unseen::Far => (
                        "everything is farther than `far`",
                        "before everything",
                        &["far"],
                    ),
                    _ => (
                        "nothing of the scene is between `near` and `far`",
                        "beyond all that is not too far",
                        &["near", "far"],
                    ),
                };
                let (span, fix) = cut(names);
                let help = format!(
                    "depths count along the view direction: change {0}, or leave {0} out",
                    quoted(names)
                );
                (message, label, help, (span, Some(fix)))
            }
        };
        self.problems.push(
            Problem::NothingSeen {
                message,
                help,
                span,
                label,
            }
            .with(fix),
        );
    }
}

/// What to write for the camera to look at a point, if it can.
fn towards(camera: &Camera, middle: DVec3) -> Option<String> {
    let (from, to) = match camera.view {
        View::Lookat(_) => (camera.eye, middle),
        View::Direction(_) => (DVec3::ZERO, middle - camera.eye),
    };
    let is_one = to.is_finite() && !predicates::cross_is_zero(camera.up, from, to);
    is_one.then(|| numbers::short_vector(to))
}

/// Where the camera looks, as a direction in the place of the point.
fn direction_for(block: &Block<'_>, lookat: Span) -> Vec<Fix> {
    let fields = examples(block, &["direction"]);
    let is_in_file = lookat.source == SourceId::File;
    let fields = fields.into_iter().filter(|_| is_in_file);
    let title = "give a `direction` instead of `lookat`";
    fields
        .map(|field| Fix::new(title, [Edit::new(lookat, field)]))
        .collect()
}

/// A vector along an axis, such as `−z`.
fn axis_name(v: DVec3) -> Option<String> {
    let (axis, part) = axis(v)?;
    let sign = if part < 0.0 { '−' } else { '+' };
    Some(format!("{sign}{axis}"))
}

/// The unit vector along an axis as it is written.
fn axis_vector(v: DVec3) -> Option<String> {
    let (axis, part) = axis(v)?;
    let one = if part < 0.0 { "-1" } else { "1" };
    Some(match axis {
        'x' => format!("({one}, 0, 0)"),
        'y' => format!("(0, {one}, 0)"),
        _ => format!("(0, 0, {one})"),
    })
}

fn axis(v: DVec3) -> Option<(char, f64)> {
    match v.to_array() {
        [x, 0.0, 0.0] if x != 0.0 => Some(('x', x)),
        [0.0, y, 0.0] if y != 0.0 => Some(('y', y)),
        [0.0, 0.0, z] if z != 0.0 => Some(('z', z)),
        _ => None,
    }
}
