//! Builds the camera. Warns of probable mistakes, for example if an object is outside of the
//! picture.

use glam::DVec3;

use super::lowering::Lowering;
use crate::{
    diagnostic::{Applicability, Fix},
    math::predicates,
    numbers,
    scene::{
        error::{error, warning},
        lowered_block::{Given, LoweredBlock},
        model::{Camera, Image, Lens, Object, View, level_direction},
        shape::Checkerboard,
        unseen::{LEAST_SINE, Outside, Sight, WhyUnseen, are_squares_lost, why_unseen},
    },
    schema::{CAMERA, CameraFields},
    suggest,
};

/// Maximum number of objects that one warning names. For the remaining objects, it gives only their
/// number. Three keep the message short; any small number would do.
const MOST_NAMED: usize = 3;

impl<'s> Lowering<'s> {
    /// Builds the camera. Returns `None` if a value is missing or wrong.
    pub(super) fn camera(&mut self, block: &LoweredBlock<'s>) -> Option<Camera> {
        let CameraFields {
            eye,
            lookat,
            direction,
            up,
            roll,
            d,
            view_height,
            fov,
            hfov,
            near,
            far,
        } = CAMERA;
        let (eye_place, given_far) = (block.place(eye), block.given(far));
        let (eye, up, near) = (block.value(eye), block.value(up), block.value(near));
        let given_direction = block.given(direction);
        let mut view = match given_direction {
            Some(_) => block.value(direction).map(View::Direction),
            None => block.value(lookat).map(View::Lookat),
        };
        let given_view = block.given(lookat).or(given_direction);
        match (eye, view, given_view) {
            (Some(eye), Some(View::Lookat(point)), Some(given)) if point == eye => {
                let message = "the camera stands on the point that it looks at";
                error("view_undefined", message)
                    .at(given.span, "the same point as the eye")
                    .at(eye_place, "the eye")
                    .help("move one of them, or give a `direction` instead of `lookat`")
                    .report(&mut self.problems);
                // The view direction is undefined. Without a view, no camera is built.
                view = None;
            }
            (Some(eye), Some(view), Some(given)) => {
                self.up_parallel(block, view.ends(eye), up, given)
            }
            _ => {}
        }
        let far = given_far.map(|given| (given, block.value(far)));
        if let (Some(near), Some((given, Some(far)))) = (near, far)
            && near >= far
        {
            self.empty_depth(block, near, far, given);
        }
        let lens = if block.given(fov).is_some() {
            block.value(fov).map(Lens::Fov)
        } else if block.given(hfov).is_some() {
            block.value(hfov).map(Lens::HorizontalFov)
        } else {
            block.value(d).map(Lens::Distance)
        };
        Some(Camera {
            eye: eye?,
            view: view?,
            up: up?,
            roll: block.value(roll)?,
            lens: lens?,
            view_height: block.value(view_height)?,
            near: near?,
            far: match far {
                Some((_, far)) => Some(far?),
                None => None,
            },
        })
    }

    /// Warns of an up vector that is parallel, or nearly parallel, to the view direction.
    fn up_parallel(
        &mut self,
        block: &LoweredBlock<'s>,
        (from, to): (DVec3, DVec3),
        up: Option<DVec3>,
        given_view: Given,
    ) {
        let Some(up) = up else { return };
        let is_parallel = predicates::cross_is_zero(up, from, to);
        // Numbers near the ends of the range of `f64` may overflow or underflow in differences and
        // squares, so vectors are scaled first.
        let unit = |v: DVec3| (v / v.abs().max_element()).normalize();
        let along = if (to - from).is_finite() {
            to - from
        } else {
            0.5 * to - 0.5 * from
        };
        let sine = unit(up).cross(unit(along)).length();
        // The condition is negated so that the function also returns, without a warning, if `sine`
        // is NaN.
        if !(is_parallel || sine < LEAST_SINE) {
            return;
        }
        // Computes `top`, the direction of the picture's top if the camera looks straight along up
        // or in the opposite direction. `across` is the component of `level_direction(up)` that is
        // perpendicular to up. `top` is `-across` if the camera looks along up, and `across` if it
        // looks in the opposite direction. The length of `up` does not matter, so `up` is scaled;
        // otherwise its square could overflow.
        let up = up / up.abs().max_element();
        let level = level_direction(up);
        let across = level * up.dot(up) - up * level.dot(up);
        let along = predicates::dot_sign(up, from, to).is_gt();
        let top = if along { -across } else { across };
        let top = numbers::short_vector(top / top.abs().max_element());
        let given = block.given(CAMERA.up);
        let label = match given {
            _ if !is_parallel => {
                "less than a millionth of a radian off the view direction".to_owned()
            }
            Some(_) => "parallel to the view direction".to_owned(),
            None => {
                let up = numbers::short_vector(up);
                format!("parallel to up, which is {up} if not given")
            }
        };
        let fix = match given {
            Some(given) => Some(Fix::write(given.span, &top)),
            None => {
                let field = format!("up {top}");
                self.add_fields(block, format!("add `{field}`"), &[field])
            }
        };
        let (message, why) = if is_parallel {
            (
                "the camera looks straight along its up vector",
                format!("the top of the picture is towards {top} here"),
            )
        } else {
            (
                "the camera looks all but straight along its up vector",
                "which way is up hangs on the last digits of these numbers".to_owned(),
            )
        };
        warning("up_parallel", message)
            .at(given.map_or(given_view.span, |given| given.span), label)
            .help(format!("{why}; write `up {top}` to say so yourself"))
            .fixes(fix)
            .report(&mut self.problems);
    }

    /// Reports a `far` that is not greater than `near`.
    fn empty_depth(&mut self, block: &LoweredBlock<'s>, near: f64, far: f64, given: Given) {
        let (near, far) = (
            numbers::comparable(near, &[far]),
            numbers::comparable(far, &[near]),
        );
        let problem = error("empty_depth", "`far` must be more than `near`")
            .help(format!(
                "write a number above {near} after `far`, or leave it out"
            ))
            .fixes([Fix::remove_whole(
                "leave `far` out",
                given.field(),
                self.sources,
            )]);
        self.problems.push(match block.given(CAMERA.near) {
            Some(near_given) => problem
                .at(given.span, format!("{far} is not more"))
                .at(near_given.span, format!("than {near}")),
            None => {
                let label = format!("not more than `near`, which is {near} if not given");
                problem.at(given.span, label)
            }
        });
    }

    /// Warns if the camera sees no object, or if named objects are outside of the picture.
    pub(super) fn unseen(
        &mut self,
        block: &LoweredBlock<'s>,
        camera: &Camera,
        image: &Image,
        objects: &[Object],
    ) {
        let Some(why) = why_unseen(camera, image, objects) else {
            return self.outside(camera, image, objects);
        };
        let view_field = match camera.view {
            View::Lookat(_) => CAMERA.lookat.name,
            View::Direction(_) => CAMERA.direction.name,
        };
        let (message, label, field) = match why {
            WhyUnseen::Behind => (
                "everything is behind the camera",
                "away from everything",
                view_field,
            ),
            WhyUnseen::Outside => (
                "the camera sees nothing of the scene",
                "past everything",
                view_field,
            ),
            WhyUnseen::Clipped(field) => {
                let message = "nothing of the scene is between `near` and `far`";
                (message, "depths count along the view direction", field)
            }
        };
        let Some(given) = block.given_by_name(field) else {
            return;
        };
        let problem = warning("nothing_seen", message).at(given.span, label);
        let center = objects.iter().find_map(|object| object.shape.center());
        let towards = center.and_then(|center| towards(camera, center));
        self.problems.push(match (why, towards) {
            (WhyUnseen::Clipped(_), _) => problem
                .help(format!("change `{field}`, or leave it out"))
                .fixes([Fix::remove_whole(
                    format!("leave `{field}` out"),
                    given.field(),
                    self.sources,
                )]),
            (_, Some(towards)) => problem
                .help(format!("look at an object, such as `{field} {towards}`"))
                .writing(given.span, Applicability::Unsafe, [towards]),
            (_, None) => problem.help("turn the camera, or move it"),
        });
    }
}

impl Lowering<'_> {
    /// Warns of named objects, and of named repeated blocks, that lie wholly outside of the
    /// picture.
    fn outside(&mut self, camera: &Camera, image: &Image, objects: &[Object]) {
        let Some(sight) = Sight::new(camera, image) else {
            return;
        };
        let mut outside = Vec::new();
        for block in objects.chunk_by(|one, other| one.span == other.span) {
            let name = block.first().and_then(|object| object.name.as_deref());
            let name = name.map(|name| name.split('[').next().unwrap_or(name));
            let Some((name, &place)) = name.and_then(|it| self.first_names.get_key_value(it))
            else {
                continue;
            };
            let mut places = block.iter().map(|object| sight.outside(&object.shape));
            let Some(first) = places.next().flatten() else {
                continue;
            };
            let others: Option<Vec<Outside>> = places.collect();
            let Some(others) = others else { continue };
            let words = if others.iter().all(|other| *other == first) {
                first.words()
            } else {
                "outside of the picture"
            };
            outside.push((format!("`{name}`"), place, words));
        }
        let Some((first, _, _)) = outside.first() else {
            return;
        };
        let (message, help) = match outside.len() {
            1 => (
                format!("{first} lies outside of the picture"),
                "move it or the camera, or leave it out",
            ),
            count => {
                let listed = outside.iter().take(MOST_NAMED);
                let mut names: Vec<String> = listed.map(|(name, ..)| name.clone()).collect();
                if count > MOST_NAMED {
                    names.push(format!("{} more", count - MOST_NAMED));
                }
                let names = suggest::list(names.iter().map(String::as_str));
                (
                    format!("{names} lie outside of the picture"),
                    "move them or the camera, or leave them out",
                )
            }
        };
        let problem = warning("outside_picture", message).help(help);
        let labels = outside.iter().take(MOST_NAMED);
        let problem = labels.fold(problem, |it, (_, place, words)| it.at(*place, *words));
        self.problems.push(problem);
    }

    /// Warns of checkerboards whose squares look so small from the camera that samples cannot tell
    /// them apart.
    pub(super) fn lost_squares(&mut self, camera: &Camera, image: &Image) {
        let boards = std::mem::take(&mut self.boards);
        // Only the first board of a repeated block is reported.
        let mut reported = None;
        for (board, place) in boards {
            let is_lost =
                |square| are_squares_lost(camera, image, &Checkerboard { square, ..board });
            let is_new = board.colors[0] != board.colors[1] && reported != Some(place);
            if !is_new || !is_lost(board.square) {
                continue;
            }
            reported = Some(place);
            // The suggested side of a square is 1 m. If samples could not tell such squares apart
            // either, the suggestion is the vertical distance of the eye from the board. If this is
            // too small as well, no side is suggested.
            let height = (board.y - camera.eye.y).abs();
            let larger = [1.0, height].into_iter().find(|&square| !is_lost(square));
            let larger = larger.map(numbers::short);
            let exact = "or `method exact`, which shows the mean of all squares in a pixel";
            let help = match &larger {
                Some(larger) => format!("write a larger `square`, such as {larger}, {exact}"),
                None => format!("move the camera nearer, {exact}"),
            };
            let is_given = self.sources.text(place) != "checkerboard";
            warning(
                "squares_too_small",
                "samples cannot tell the squares of this board apart",
            )
            .at(place, "so small from here that all of them get one colour")
            .help(help)
            .writing(place, Applicability::Unsafe, larger.filter(|_| is_given))
            .report(&mut self.problems);
        }
    }
}

/// Returns, as text, the value of `lookat` or `direction` with which the camera looks at `point`.
/// Returns `None` if the view direction would be parallel to up, or if the value is not finite.
fn towards(camera: &Camera, point: DVec3) -> Option<String> {
    let (from, to) = match camera.view {
        View::Lookat(_) => (camera.eye, point),
        View::Direction(_) => (DVec3::ZERO, point - camera.eye),
    };
    let is_one = to.is_finite() && !predicates::cross_is_zero(camera.up, from, to);
    is_one.then(|| numbers::short_vector(to))
}
