//! Draws the figure `roll`. It shows the edge of the picture before and after the camera's roll.

use glam::DVec2;

use super::{
    canvas::{Canvas, WIDTH, number},
    outside::{draw_objects, draw_within, fit, visible_overlays},
};
use crate::{
    math::Angle,
    projection::Projection,
    scene::{Camera, Scene},
};

/// Height of the figure, in SVG units, before empty space is cropped. The figure's width is 680.
/// The pictures are scaled to fit, so they would be smaller in a lower figure.
const HEIGHT: f64 = 400.0;

/// Number of straight segments by which the arc of the roll's angle is drawn. With 24 segments, the
/// arc looks round.
const ARC: u32 = 24;

/// Draws the figure for the roll of the scene's camera, and returns it as SVG.
pub fn draw(scene: &Scene) -> String {
    let mut canvas = Canvas::new(HEIGHT);
    let roll = scene.camera.roll;
    let degrees = number(roll.in_degrees());
    let turned = match roll.in_degrees() {
        0.0 => "by nothing",
        degrees if degrees > 0.0 => "clockwise, so that its right side dips",
        _ => "counter-clockwise, so that its left side dips",
    };
    before_and_after(&mut canvas, scene);
    picture(&mut canvas, scene);
    canvas.finish_cropped(
        "The camera's roll",
        &format!(
            "On the left the picture's frame before the roll, dashed, with u and v, and after it, with u′ and v′, seen from the eye: \
            a roll of {degrees} degrees turns the frame {turned}. \
            On the right the picture in its frame, as outlines of the objects that are seen: the content has turned the other way."
        ),
    )
}

/// Draws the picture of the camera without roll. Over it, draws the edges of this picture and of
/// the rolled picture.
fn before_and_after(canvas: &mut Canvas, scene: &Scene) {
    let rolled = |roll: Angle| {
        let camera = Camera {
            roll,
            ..scene.camera
        };
        (camera, Projection::new(&camera, &scene.image))
    };
    let (level_camera, level) = rolled(Angle::default());
    let roll = scene.camera.roll;
    // Maps a point of the picture with the roll `roll` to the point of the picture without roll
    // that lies in the same direction from the eye.
    let seen = |roll: Angle, point: DVec2| {
        let (_, view) = rolled(roll);
        level.projected(view.at_depth(point, 1.0))
    };
    let (size, middle) = (level.size, level.size / 2.0);
    let corners = [
        DVec2::ZERO,
        size.with_y(0.0),
        size,
        size.with_x(0.0),
        DVec2::ZERO,
    ];
    let after = corners.map(|corner| seen(roll, corner));
    let panel = [DVec2::new(24.0, 24.0), DVec2::new(396.0, HEIGHT - 24.0)];
    let (scale, offset) = fit(&[corners, after].concat(), panel);
    let place = |at: DVec2| at * scale + offset;

    let scene = Scene {
        camera: level_camera,
        ..scene.clone()
    };
    let found = visible_overlays(&scene);
    draw_objects(canvas, &scene, &found, place, panel);
    if let Some(horizon) = found.horizon {
        draw_within(canvas, "faint", &horizon.map(place), panel);
    }
    canvas.line("ink dash", &corners.map(place));
    canvas.line("blue", &after.map(place));
    let reach = 0.45 * size.min_element();
    let axes = [(DVec2::X, ["*u*", "*u*′"]), (DVec2::NEG_Y, ["*v*", "*v*′"])];
    for (axis, names) in axes {
        let tips = [Angle::default(), roll].map(|roll| place(seen(roll, middle + axis * reach)));
        for ((tip, name), class) in tips.into_iter().zip(names).zip(["ink", "blue"]) {
            if class == "blue" && tips[0].distance(tips[1]) < 1.0 {
                continue;
            }
            canvas.arrow(class, place(middle), tip);
            canvas.label(class, [tip, place(middle)], name);
        }
    }
    let on_arc = |i: u32| {
        let part = roll * (f64::from(i) / f64::from(ARC));
        place(seen(part, middle + DVec2::X * (0.85 * reach)))
    };
    let arc: Vec<DVec2> = (0..=ARC).map(on_arc).collect();
    canvas.line("red", &arc);
    let degrees = number(roll.in_degrees());
    let eye = place(middle);
    canvas.label(
        "red",
        [arc[ARC as usize / 2], eye],
        format!("roll {degrees}°"),
    );
    let lowest = |corners: &[DVec2]| {
        let places = corners.iter().map(|corner| place(*corner));
        places
            .reduce(|a, b| if b.y > a.y { b } else { a })
            .unwrap_or_default()
    };
    canvas.label("ink", [place(corners[0]), eye], "before");
    canvas.label("blue", [lowest(&after), eye], "after");
}

/// Draws the rolled picture with a level frame, as a viewer sees it.
fn picture(canvas: &mut Canvas, scene: &Scene) {
    let found = visible_overlays(scene);
    let size = DVec2::from(found.size.map(f64::from));
    let room = [
        DVec2::new(424.0, 24.0),
        DVec2::new(WIDTH - 24.0, HEIGHT - 60.0),
    ];
    let (scale, offset) = fit(&[DVec2::ZERO, size], room);
    let place = |at: DVec2| at * scale + offset;
    let panel = [place(DVec2::ZERO), place(size)];
    draw_objects(canvas, scene, &found, place, panel);
    if let Some(horizon) = found.horizon {
        draw_within(canvas, "faint", &horizon.map(place), panel);
    }
    let [min, max] = panel;
    let frame = [
        min,
        DVec2::new(max.x, min.y),
        max,
        DVec2::new(min.x, max.y),
        min,
    ];
    canvas.line("blue", &frame);
    let below = DVec2::new(min.midpoint(max).x, max.y + 26.0);
    canvas.text("blue", "middle", below, "the picture’s outlines");
}
