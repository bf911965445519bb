//! `sheet`: writes a contact sheet, i.e. one picture that contains small pictures of several scenes
//! with their names.

use std::{
    path::{Path, PathBuf},
    sync::atomic::AtomicBool,
};

use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

use super::{
    CommandError, Status,
    args::SheetArgs,
    command_error,
    input::{SceneInput, check_standard, is_standard, shown, unwritable},
    interrupt::Interrupt,
    output,
    picture::{PictureOutput, render_part},
};
use crate::{
    area::Area,
    diagnostic::visible_line,
    files::{self, Purpose},
    film::{self, Film},
    render::RenderError,
    scene::{Count, Scene},
    tracer::World,
};

/// A cell of the sheet: a scene and its caption. The scene's picture size is already reduced to its
/// size on the sheet.
type SheetCell = (Scene, String);

/// Gap between two cells of the sheet, and around all cells, in pixels. It separates the pictures;
/// any similar width works.
const GAP: u32 = 12;
/// Colour of the frame around each picture, in sRGB bytes. This light gray is visible on the white
/// sheet, but does not distract from the pictures.
const FRAME: [u8; 3] = [192; 3];
/// Height of the letters of captions, in pixels. Chosen among the few heights in which the font
/// exists.
const LETTERS: RasterHeight = RasterHeight::Size16;
/// Height of a caption's line, in pixels. It is 6 more than the height of the letters, 16, so that
/// there is space around them.
const LINE: u32 = 22;
const REGULAR: FontWeight = FontWeight::Regular;

/// Renders the scenes and writes the contact sheet.
pub fn run(args: &SheetArgs, interrupt: &Interrupt) -> Result<Status, CommandError> {
    check_standard(&args.scenes)?;
    check_output(args)?;
    let mut status = Status::Done;
    let mut scenes = Vec::new();
    for path in &args.scenes {
        match scenes_of(path, args) {
            Ok(found) => scenes.extend(found),
            Err(CommandError::SceneErrors) => status = Status::Negative,
            Err(error) => return Err(error),
        }
    }
    if status != Status::Done {
        return Ok(status);
    }
    let cancel = interrupt.watch();
    let cells = scenes
        .into_iter()
        .map(|(scene, name)| (reduced(scene, args.width), name));
    let cells: Vec<SheetCell> = cells.collect();
    let sheet = sheet(&cells, args.columns, cancel)?;
    let written = if is_standard(&args.output) {
        files::write_stream(output::StandardOutput::new(), cancel, |out| {
            film::write_png(&sheet, None, out)
        })
    } else {
        files::write(&args.output, Purpose::Named, cancel, |out| {
            film::write_png(&sheet, None, out)
        })
    };
    written.map_err(|error| interrupt.or(unwritable(&args.output, &error)))?;
    Ok(Status::Done)
}

/// Rejects an output that is not a PNG, is one of the scenes, or cannot be written.
fn check_output(args: &SheetArgs) -> Result<(), CommandError> {
    let path = &args.output;
    let is_png = path
        .extension()
        .is_some_and(|it| it.eq_ignore_ascii_case("png"));
    if !is_png && !is_standard(path) {
        let path = shown(path);
        return Err(command_error(format!(
            "a sheet is a PNG: {path} should end in .png"
        )));
    }
    let output = |scene: &PathBuf| PictureOutput::of(scene, Some(path))?.check(scene);
    args.scenes.iter().try_for_each(output)
}

/// Returns the scene of a file with its caption. With `--sweep`, returns a scene with its caption
/// for each value.
fn scenes_of(path: &Path, args: &SheetArgs) -> Result<Vec<(Scene, String)>, CommandError> {
    let input = SceneInput::read(path, &args.overrides)?;
    let Some(sweep) = &args.sweep else {
        return Ok(vec![(input.scene()?, name(path, args))]);
    };
    let mut scenes = Vec::new();
    for step in input.steps(sweep)? {
        let scene = input.with_set(&step.set).scene_without_warnings()?;
        let name = match args.scenes.len() {
            1 => step.label,
            _ => format!("{} {}", name(path, args), step.label),
        };
        scenes.push((scene, name));
    }
    Ok(scenes)
}

/// Returns the caption of a scene's file: the name without folders and extension, or the whole path
/// if another file has the same name.
fn name(path: &Path, args: &SheetArgs) -> String {
    if is_standard(path) {
        return "standard input".to_owned();
    }
    let is_own = args
        .scenes
        .iter()
        .filter(|it| it.file_stem() == path.file_stem())
        .count()
        == 1;
    let name = match path.file_stem() {
        Some(stem) if is_own => stem.to_string_lossy(),
        _ => path.to_string_lossy(),
    };
    visible_line(&name).into_owned()
}

/// Reduces the scene's picture to at most `side` pixels in width and height. The number of samples
/// per pixel does not change.
fn reduced(mut scene: Scene, side: u32) -> Scene {
    let whole = Area::whole(scene.image.width, scene.image.height);
    let [across, down] = [whole.width, whole.height].map(f64::from);
    let scale = f64::from(side) / across.max(down);
    if scale < 1.0 {
        let scaled = |length: f64| ((length * scale).round() as u32).max(1);
        scene.image.width = scaled(across);
        scene.image.height = scaled(down);
    }
    if let Count::Total(total) = scene.sampler.count {
        let pixels = Area::whole(scene.image.width, scene.image.height).pixels();
        let share = u128::from(total) * u128::from(pixels) / u128::from(whole.pixels());
        scene.sampler.count = Count::Total((share as u64).max(1));
    }
    scene
}

fn rendered(scene: &Scene, cancel: &AtomicBool) -> Result<Film<[u8; 3]>, RenderError> {
    let whole = Area::whole(scene.image.width, scene.image.height);
    let world = World::new_unless(scene, cancel)?;
    Ok(render_part(scene, &world, whole, cancel)?.into_film())
}

/// Renders the scenes and places their pictures on a white sheet, row by row, in `columns` columns.
/// If `columns` is `None`, there are about as many columns as rows.
fn sheet(
    cells: &[SheetCell],
    columns: Option<u32>,
    cancel: &AtomicBool,
) -> Result<Film<[u8; 3]>, RenderError> {
    let count = cells.len() as u32;
    let square = || (1..=count).find(|side| side * side >= count).unwrap_or(1);
    let columns = columns.unwrap_or_else(square).min(count).max(1);
    let width = cells
        .iter()
        .map(|(scene, _)| scene.image.width)
        .max()
        .unwrap_or(0);
    let rows = cells.chunks(columns as usize);
    let height = |row: &[SheetCell]| {
        row.iter()
            .map(|(scene, _)| scene.image.height)
            .max()
            .unwrap_or(0)
    };
    let heights = rows.clone().map(|row| height(row) + LINE + GAP);
    let size = [
        columns * (width + GAP) + GAP,
        heights.clone().fold(GAP, u32::saturating_add),
    ];
    // The memory for the sheet is allocated before rendering, so that a lack of memory is noticed
    // early.
    let mut sheet = Film::from_fn(size[0], size[1], |_, _| [255; 3])?;
    let mut y = GAP;
    for (row, height) in rows.zip(heights) {
        for (column, (scene, name)) in (0..).zip(row) {
            let place = Area {
                x: column * (width + GAP) + GAP,
                y,
                ..Area::whole(scene.image.width, scene.image.height)
            };
            // The frame makes the edge of a white picture visible.
            let frame = Area {
                x: place.x - 1,
                y: place.y - 1,
                ..Area::whole(place.width + 2, place.height + 2)
            };
            sheet.put(frame, &vec![FRAME; frame.pixels() as usize]);
            sheet.put(place, rendered(scene, cancel)?.pixels());
            write(
                &mut sheet,
                [place.x, y + place.height + 4],
                &fitting(name, width),
            );
        }
        y += height;
    }
    Ok(sheet)
}

/// Shortens a caption to `width` pixels. In a caption of a sweep, `target=value`, the target is
/// removed first, since it is the same in all captions of the sweep. If the value alone is still
/// too long, two dots replace its start. In any other caption, two dots replace the end.
fn fitting(name: &str, width: u32) -> String {
    let most = width as usize / get_raster_width(REGULAR, LETTERS);
    if name.chars().count() <= most {
        return name.to_owned();
    }
    let kept = most.saturating_sub(2);
    let dots = "..".chars();
    let Some((target, value)) = name.split_once('=') else {
        return name.chars().take(kept).chain(dots).take(most).collect();
    };
    let short = match target.rsplit_once(' ') {
        Some((scene, _)) => format!("{scene} {value}"),
        None => value.to_owned(),
    };
    match short.chars().count() {
        count if count > most => dots
            .take(most)
            .chain(short.chars().skip(count - kept))
            .collect(),
        _ => short,
    }
}

/// Writes a line of black text on white. Its top left corner is the pixel (x, y).
fn write(sheet: &mut Film<[u8; 3]>, [x, y]: [u32; 2], text: &str) {
    let width = get_raster_width(REGULAR, LETTERS) as u32;
    for (place, letter) in (0..).zip(text.chars()) {
        let unknown = || get_raster('\u{fffd}', REGULAR, LETTERS);
        let Some(letter) = get_raster(letter, REGULAR, LETTERS).or_else(unknown) else {
            continue;
        };
        for (row, inks) in (y..).zip(letter.rows()) {
            let pixels: Vec<[u8; 3]> = inks.iter().map(|ink| [255 - ink; 3]).collect();
            let area = Area {
                x: x + place * width,
                y: row,
                ..Area::whole(pixels.len() as u32, 1)
            };
            sheet.put(area, &pixels);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_tells_names_apart_is_not_cut() {
        for (name, letters, cut) in [
            ("rolled", 6, "rolled"),
            ("three_points", 9, "three_p.."),
            ("S.radius=1.333", 14, "S.radius=1.333"),
            ("S.radius=1.333", 8, "1.333"),
            ("S.radius=1.333", 4, "..33"),
            ("rolled S.radius=2", 8, "rolled 2"),
            ("rolled S.radius=2", 6, "..ed 2"),
            ("S.radius=2", 1, "2"),
            ("S.radius=22", 1, "."),
            ("rolled", 1, "."),
            ("rolled", 0, ""),
        ] {
            let width = get_raster_width(REGULAR, LETTERS) * letters;
            assert_eq!(fitting(name, width as u32), cut, "{name}");
        }
    }
}
