//! Draws the figure `triangle`. It shows a triangle with its sides, centroid, normal, and spin,
//! i.e. its rotation in its plane.

use glam::{DVec2, DVec3};

use super::{
    canvas::{Canvas, WIDTH, number},
    outside::Outside,
};
use crate::{
    math::Angle,
    numbers::short_vector,
    scene::{CenteredTriangle, Triangle, TriangleOutline},
    tracer::vertices,
};

/// Height of the figure, in SVG units, before empty space is cropped. The figure's width is 680.
/// The triangle is scaled to fit, so it would be smaller in a lower figure.
const HEIGHT: f64 = 430.0;

/// Number of straight segments by which the arc of the spin is drawn. With 24 segments, the arc
/// looks round.
const ARC: u32 = 24;

/// Draws the figure of a triangle, and returns it as SVG.
pub fn draw(triangle: &Triangle) -> String {
    let corners = vertices(triangle);
    let [left, right, apex] = corners;
    let centroid = triangle.outline.centroid();
    let spun = |spin: Angle| match triangle.outline {
        TriangleOutline::Centered(own) => vertices(&Triangle {
            outline: TriangleOutline::Centered(CenteredTriangle { spin, ..own }),
            ..*triangle
        }),
        TriangleOutline::Vertices(vertices) => vertices,
    };
    let (normal, spin) = match triangle.outline {
        TriangleOutline::Centered(own) => (own.normal, own.spin),
        TriangleOutline::Vertices(_) => ((right - left).cross(apex - left), Angle::default()),
    };
    let longest = [
        left.distance(apex),
        right.distance(apex),
        left.distance(right),
    ];
    let longest = longest.into_iter().fold(0.0, f64::max);
    let unit = normal.normalize_or(DVec3::Y);
    let tip = centroid + unit * (0.6 * longest);
    let unspun = spun(Angle::default());
    let base = (unspun[1] - unspun[0]).normalize_or(DVec3::X);
    let top = unit.cross(base).normalize_or(DVec3::Y);

    let mut points = vec![left, right, apex, centroid, tip];
    points.extend(unspun);
    let side = unit * 0.72 + base * 0.5 + top * 0.35;
    let panel = [
        DVec2::new(130.0, 40.0),
        DVec2::new(WIDTH - 130.0, HEIGHT - 40.0),
    ];
    let outside = Outside::new(&points, [side, top], panel);

    let mut canvas = Canvas::new(HEIGHT);
    canvas.fill(
        "fill",
        triangle.color,
        &corners.map(|corner| outside.at(corner)),
    );
    let is_spun = spin.in_degrees() != 0.0;
    let start = centroid.midpoint(unspun[1]);
    if is_spun {
        let [a, b, c] = unspun;
        outside.line(&mut canvas, "faint dash", &[a, b, c, a]);
        // The arc is the path of one point while the triangle is rotated: the midpoint between the
        // centroid and the right end of the base.
        let on_way = |i: u32| {
            let [_, right, _] = spun(spin * (f64::from(i) / f64::from(ARC)));
            outside.at(centroid.midpoint(right))
        };
        let arc: Vec<DVec2> = (0..=ARC).map(on_way).collect();
        canvas.line("blue", &arc[..arc.len() - 1]);
        canvas.arrow("blue", arc[arc.len() - 2], arc[arc.len() - 1]);
        outside.line(&mut canvas, "faint dash", &[centroid, start]);
        outside.line(&mut canvas, "faint", &[centroid, centroid.midpoint(right)]);
        let degrees = number(spin.in_degrees());
        let middle = arc[ARC as usize / 2];
        canvas.label(
            "blue",
            [middle, outside.at(centroid)],
            format!("spin {degrees}°"),
        );
    }
    outside.line(&mut canvas, "ink", &[left, right, apex, left]);
    canvas.arrow("red", outside.at(centroid), outside.at(tip));
    canvas.dot("ink", outside.at(centroid), 5.0);
    let center = outside.at(centroid);
    canvas.label("ink", [center, outside.at(tip)], "centroid");
    canvas.label("red", [outside.at(tip), center], "normal");

    let names = match triangle.outline {
        TriangleOutline::Centered(_) => ["left end", "right end", "apex"],
        TriangleOutline::Vertices(_) => ["v0", "v1", "v2"],
    };
    for (name, corner) in names.into_iter().zip(corners) {
        canvas.dot("ink", outside.at(corner), 4.0);
        canvas.label("ink", [outside.at(corner), center], name);
    }
    let measured = [("a", left, apex), ("b", right, apex), ("c", left, right)];
    let mut told = Vec::new();
    for (side, from, to) in measured {
        let length = number(from.distance(to));
        let base = if side == "c" { ", the base" } else { "" };
        let middle = outside.at(from.midpoint(to));
        canvas.label(
            "ink",
            [middle, center],
            format!("*{side}* = {length}{base}"),
        );
        told.push(format!("{side} = {length}"));
    }
    let about = match (is_spun, triangle.outline) {
        (_, TriangleOutline::Vertices(_)) => {
            "It is written by its vertices, v0, v1 and v2.".to_owned()
        }
        (false, _) => "It is not spun: its base is level.".to_owned(),
        (true, _) => format!(
            "The dashed triangle has no spin; spin turns it by {} degrees in its plane, counter-clockwise seen from the normal's tip.",
            number(spin.in_degrees())
        ),
    };
    canvas.finish_cropped(
        "The measures of a triangle",
        &format!(
            "A triangle with the sides {}; c is the base, a leads from its left end to the apex, b from its right end. \
            The centroid is {}, the mean of the vertices; the normal {} stands on it. {about}",
            told.join(", "),
            short_vector(centroid),
            short_vector(normal)
        ),
    )
}
