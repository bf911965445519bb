//! The camera: what its fields come to, and what it sees.

use glam::DVec3;

use super::{Block, Given, Lowering, fields::Fields};
use crate::{
    diagnostic::Fix,
    math::predicates,
    numbers,
    scene::{
        Camera, Image, Lens, Object, View,
        error::{error, warning},
        level_direction,
        schema::Kind,
        unseen::{self, LEAST_SINE, Unseen, why_unseen},
    },
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
                    let eye = block.given("eye").map_or(block.keyword, |given| given.span);
                    let message = "the camera stands on the point that it looks at";
                    let help = "move one of them, or give a `direction` instead of `lookat`";
                    self.problems.push(
                        error("view_undefined", message)
                            .at(seen.span, "the same point as the eye")
                            .at(eye, "the eye")
                            .help(help),
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
        let top = numbers::short_vector(top / top.abs().max_element());
        let given = block.given("up");
        let label = match given {
            _ if !is_parallel => {
                "less than a millionth of a radian off the view direction".to_owned()
            }
            Some(_) => "parallel to the view direction".to_owned(),
            None => format!(
                "parallel to up, which is {} if not given",
                numbers::short_vector(up)
            ),
        };
        let fix = match given {
            Some(given) => Some(Fix::write(given.span, &top)),
            None => {
                let field = format!("up {top}");
                self.add_fields(block, format!("add `{field}`"), &[field])
            }
        };
        let (message, why) = match is_parallel {
            true => (
                "the camera looks straight along its up vector",
                format!("the top of the picture is towards {top} here"),
            ),
            false => (
                "the camera looks all but straight along its up vector",
                "which way is up hangs on the last digits of these numbers".to_owned(),
            ),
        };
        let help = format!("{why}; write `up {top}` to say so yourself");
        self.problems.push(
            warning("up_parallel", message)
                .at(given.map_or(seen.span, |given| given.span), label)
                .help(help)
                .fixes(fix),
        );
    }

    fn empty_depth(&mut self, block: &Block<'s>, near: f64, far: f64, far_given: Given) {
        let (near, far) = (numbers::beside(near, &[far]), numbers::beside(far, &[near]));
        let problem = error("empty_depth", "`far` must be more than `near`")
            .help(format!(
                "write a number above {near} after `far`, or leave it out"
            ))
            .fixes([Fix::remove_whole(
                "leave `far` out",
                [far_given.field()],
                self.sources,
            )]);
        self.problems.push(match block.given("near") {
            Some(near_given) => problem
                .at(far_given.span, format!("{far} is not more"))
                .at(near_given.span, format!("than {near}")),
            None => {
                let label = format!("not more than `near`, which is {near} if not given");
                problem.at(far_given.span, label)
            }
        });
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
        let given = |names: [&str; 2]| names.into_iter().find_map(|name| block.given(name));
        let (message, label, place) = match why {
            Unseen::Behind => (
                "everything is behind the camera",
                "away from everything",
                given(["lookat", "direction"]),
            ),
            Unseen::Outside => (
                "the camera sees nothing of the scene",
                "past everything",
                given(["lookat", "direction"]),
            ),
            Unseen::Clipped => (
                "nothing of the scene is between `near` and `far`",
                "depths count along the view direction",
                given(["near", "far"]),
            ),
        };
        let span = place.map_or(block.keyword, |given| given.span);
        let problem = warning("nothing_seen", message).at(span, label);
        let middle = objects
            .iter()
            .find_map(|object| unseen::middle(&object.shape));
        let towards = middle.and_then(|middle| towards(camera, middle));
        self.problems.push(match (why, towards) {
            (Unseen::Clipped, _) => {
                let both = ["near", "far"].into_iter();
                let both = both.filter_map(|name| block.given(name));
                problem
                    .help("change `near` or `far`, or leave them out")
                    .fixes([Fix::remove_whole(
                        "leave `near` and `far` out",
                        both.map(|given| given.field()),
                        self.sources,
                    )])
            }
            (_, Some(towards)) => {
                let field = match camera.view {
                    View::Lookat(_) => "lookat",
                    View::Direction(_) => "direction",
                };
                problem
                    .help(format!("look at an object, such as `{field} {towards}`"))
                    .writing(span, [towards])
            }
            (_, None) => problem.help("turn the camera, or move it"),
        });
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
