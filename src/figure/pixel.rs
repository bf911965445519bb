//! Draws the figure `pixel`. It shows one pixel with its sample points, the cells of the sampling
//! method, and the colours that the samples see.

use glam::DVec2;

use super::{
    canvas::{Canvas, length},
    methods::{refuse_too_many, strata, tint_strata},
};
use crate::{
    editor::viewport::{PixelSamples, SeenColor, samples, seen_colors},
    scene::{Method, Sampler, Scene},
    tracer::World,
};

/// Top left corner of the square that shows the pixel, in SVG units. It leaves a margin at the edge
/// of the figure.
const CORNER: DVec2 = DVec2::new(16.0, 16.0);

/// Side of the square that shows the pixel, in SVG units. The square takes about half of the
/// figure's width, 680. The rest is for the list of colours.
const SIDE: f64 = 360.0;

/// Number of rows of points at which the pixel's colours are determined, and also the number of
/// columns. Each point is drawn as a small square. The number must divide [`SIDE`], so that
/// rounding lengths to one decimal leaves no gaps between the squares. With 120, the squares have
/// sides of 3 units.
const ROWS: u32 = 120;

/// Maximum number of colours that are listed beside the pixel. If the pixel shows more, those with
/// the largest areas are listed. The figure has no space for many more, and most pixels show fewer.
const COLORS: usize = 4;

/// Draws the figure of the pixel `pixel`. If it is `None`, chooses a pixel with several colours.
pub fn draw(scene: &Scene, pixel: Option<[u32; 2]>) -> Result<String, String> {
    let world = World::new(scene);
    let [x, y] = pixel.unwrap_or_else(|| most_colors(scene, &world));
    let PixelSamples {
        samples: seen,
        color: mean,
        ..
    } = samples(&scene.sampler, &world, [x, y])?;
    refuse_too_many(seen.len() as u64)?;
    let exact = Sampler {
        method: Method::Exact,
        ..scene.sampler
    };
    let exact = samples(&exact, &world, [x, y])?.color;

    let mut canvas = Canvas::new(2.0 * CORNER.y + SIDE + 26.0);
    regions(&mut canvas, &world, [x, y]);
    let mut colors = seen_colors(scene, &world, [x, y]);
    colors.retain(|color| color.at.is_some());
    colors.truncate(COLORS);
    strata(
        &mut canvas,
        scene.sampler.method,
        seen.len() as u64,
        CORNER,
        SIDE,
    );
    let marked = tint_strata(
        &mut canvas,
        scene.sampler.method,
        seen.len() as u64,
        CORNER,
        SIDE,
    );
    let radius = (30.0 / (seen.len().max(1) as f64).sqrt()).clamp(3.0, 9.0);
    for (at, color) in &seen {
        canvas.seen(*color, CORNER + *at * SIDE, radius);
    }
    let method = scene.sampler.method.name();
    let below = CORNER + DVec2::new(0.0, SIDE + 28.0);
    let count = match seen.len() {
        1 => "1 sample".to_owned(),
        count => format!("{count} samples"),
    };
    canvas.text(
        "ink",
        "start",
        below,
        &format!("pixel ({x}, {y}), {method}, {count}"),
    );
    // Below the list of colours, the name of each tinted stratum is written in the stratum's own
    // colour.
    let top = 116.0 + 32.0 * colors.len() as f64;
    for (at, &(class, stratum)) in marked.iter().enumerate() {
        let place = DVec2::new(400.0 + 100.0 * at as f64, top - 22.0);
        canvas.text(class, "start", place, stratum);
    }
    let marked: Vec<_> = marked.iter().map(|(_, stratum)| *stratum).collect();
    let strata = match marked[..] {
        [] => String::new(),
        _ => format!(
            "; lines show the strata, each with one sample, of which are tinted: {}",
            marked.join(", ")
        ),
    };

    let columns = [570.0, 664.0];
    let cell = |canvas: &mut Canvas, column: usize, line: f64, text: &str| {
        canvas.text("ink", "end", DVec2::new(columns[column], line), text);
    };
    cell(&mut canvas, 0, 44.0, "samples");
    cell(&mut canvas, 1, 44.0, "exact");
    let mut told = Vec::new();
    for (
        row,
        &SeenColor {
            color,
            share,
            object,
            ..
        },
    ) in colors.iter().enumerate()
    {
        let name = name(scene, object);
        let count = seen.iter().filter(|(_, seen)| *seen == color).count();
        let share = format!("{} %", crate::numbers::rounded(100.0 * share, 0.1));
        let line = 84.0 + 32.0 * row as f64;
        canvas.seen(color, DVec2::new(408.0, line - 6.0), 8.0);
        canvas.text("ink", "start", DVec2::new(424.0, line), &name);
        let counted = if seen.is_empty() {
            "–".to_owned()
        } else {
            count.to_string()
        };
        cell(&mut canvas, 0, line, &counted);
        cell(&mut canvas, 1, line, &share);
        told.push(format!(
            "{name} ({color}): {count} samples, exactly {share}"
        ));
    }
    canvas.text("ink", "start", DVec2::new(400.0, top + 46.0), "mean");
    for (left, color) in [(472.0, mean), (568.0, exact)] {
        let more = format!(" style=\"fill:{color}\"");
        canvas.raw_path("swatch", &format!("M{left} {top}h96v76h-96z"), &more);
        let below = DVec2::new(left + 48.0, top + 100.0);
        canvas.text("ink", "middle", below, &color.to_string());
    }
    canvas.raw_path("faint", &format!("M472 {top}h192v76h-192z"), "");
    let channels = mean.to_bytes().into_iter().zip(exact.to_bytes());
    let off = channels
        .map(|(a, b)| a.abs_diff(b))
        .max()
        .unwrap_or_default();
    let off = match off {
        0 => "equal in 8 bits".to_owned(),
        off => format!("off by {off} of 255"),
    };
    canvas.text("ink", "end", DVec2::new(columns[1], top + 132.0), &off);
    let told = told.join("; ");
    let means = if seen.is_empty() {
        format!("The mean, in linear light, is {exact}.")
    } else {
        format!(
            "The mean of the samples, in linear light, is {mean}, the exact mean {exact}: {off}."
        )
    };
    Ok(canvas.finish(
        "One pixel and its samples",
        &format!(
            "Pixel ({x}, {y}) has {count} by the method {method}{strata}. Seen there: {told}. \
            {means}"
        ),
    ))
}

/// Fills the square that shows the pixel (x, y) with the pixel's colours.
fn regions(canvas: &mut Canvas, world: &World, [x, y]: [u32; 2]) {
    let offset = |i: u32| (f64::from(i) + 0.5) / f64::from(ROWS) - 0.5;
    let step = SIDE / f64::from(ROWS);
    let mut paths = vec![String::new(); world.palette().len()];
    for j in 0..ROWS {
        let color_index = |i: u32| world.color_index_at(x, y, DVec2::new(offset(i), offset(j)));
        let row: Vec<usize> = (0..ROWS).map(color_index).collect();
        let mut first = 0;
        for run in row.chunk_by(|a, b| a == b) {
            let (color_index, width) = (run[0], run.len());
            let corner = CORNER + DVec2::new(first as f64, f64::from(j)) * step;
            let [left, top, width, height] =
                [corner.x, corner.y, width as f64 * step, step].map(length);
            paths[color_index] += &format!("M{left} {top}h{width}v{height}h-{width}z");
            first += run.len();
        }
    }
    for (path, color) in paths.iter().zip(world.palette()) {
        let more = format!(" style=\"fill:{color}\" shape-rendering=\"crispEdges\"");
        canvas.raw_path("fill", path, &more);
    }
}

/// Returns the name of an object, or "background" for `None`. Names of more than 12 characters are
/// cut.
fn name(scene: &Scene, object: Option<usize>) -> String {
    let Some(object) = object.map(|index| &scene.objects[index]) else {
        return "background".to_owned();
    };
    let name = object.name.as_deref().unwrap_or(object.shape.kind());
    match name.chars().count() {
        0..=12 => name.to_owned(),
        _ => name.chars().take(11).chain("…".chars()).collect(),
    }
}

/// Returns a pixel that suits the figure: the one with the highest score ([`evenness`]). Searches
/// at most 90 rows of the picture, and tries only pixels at which the colour changes along the row.
/// If there are none, returns the pixel in the middle of the picture.
fn most_colors(scene: &Scene, world: &World) -> [u32; 2] {
    let (width, height) = (scene.image.width, scene.image.height);
    let (columns, rows) = (width.min(64), height.min(90));
    let color_index = |x: u32, y: u32| world.color_index_at(x, y, DVec2::ZERO);
    let mut best = (f64::NEG_INFINITY, [width / 2, height / 2]);
    for y in (0..rows).map(|j| (2 * j + 1) * height / (2 * rows)) {
        for i in 1..columns {
            let [mut from, mut to] = [i - 1, i].map(|i| i * (width - 1) / (columns - 1));
            let first = color_index(from, y);
            if first == color_index(to, y) {
                continue;
            }
            while to - from > 1 {
                let middle = from.midpoint(to);
                if color_index(middle, y) == first {
                    from = middle;
                } else {
                    to = middle;
                }
            }
            let score = evenness(world, [to, y]);
            if score > best.0 {
                best = (score, [to, y]);
            }
        }
    }
    best.1
}

/// Returns a score that says how well a pixel suits the figure, from its colours at 8 × 8 points.
/// The score is higher if the pixel shows more colours, up to three, and if their areas are more
/// equal (a low Simpson index). It is lower if the colour changes often from point to point, as
/// near the horizon of a checkerboard.
fn evenness(world: &World, [x, y]: [u32; 2]) -> f64 {
    let at = |i: u32| (f64::from(i) + 0.5) / 8.0 - 0.5;
    let color_index =
        |cell: u32| world.color_index_at(x, y, DVec2::new(at(cell % 8), at(cell / 8)));
    let mut color_indices: Vec<usize> = (0..64).map(color_index).collect();
    let changes = color_indices
        .windows(2)
        .filter(|pair| pair[0] != pair[1])
        .count();
    color_indices.sort_unstable();
    let runs = color_indices
        .chunk_by(|a, b| a == b)
        .map(|run| run.len() as f64);
    let colors = runs.clone().count().min(3) as f64;
    let alike = runs.map(|run| run * run).sum::<f64>() / 4096.0;
    0.2 * colors - alike - 0.02 * changes as f64
}
