//! `sheet`: writes a contact sheet: one picture with the pictures of several scenes, each with its
//! name.

use std::{
    path::{Path, PathBuf},
    sync::atomic::AtomicBool,
};

use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

use super::{
    Status, Trouble,
    args::SheetArgs,
    input::{SceneInput, check_standard, is_standard, shown, unwritable},
    interrupt::Interrupt,
    output,
    picture::{KeptPixels, PictureOutput, RenderedPicture, picture},
};
use crate::{
    area::Area,
    diagnostic::visible_line,
    files::{self, Purpose},
    film::{self, Film},
    render::RenderError,
    scene::{self, Count, Scene},
    source::Source,
    tracer::World,
};

/// A cell of the sheet: a scene, whose picture is already reduced to its size on the sheet, and its
/// caption.
type SheetCell = (Scene, String);

/// Gap between two cells of the sheet, and around all cells, in pixels.
const GAP: u32 = 12;
/// Colour of the frame around each picture, in sRGB bytes.
const FRAME: [u8; 3] = [192; 3];
/// Height of the letters of captions, in pixels.
const LETTERS: RasterHeight = RasterHeight::Size16;
/// Height of a line of captions, in pixels, including the space around the letters.
const LINE: u32 = 22;
const REGULAR: FontWeight = FontWeight::Regular;

/// Renders the scenes and writes the contact sheet.
pub fn run(args: &SheetArgs, interrupt: &Interrupt) -> Result<Status, Trouble> {
    check_standard(&args.scenes)?;
    check_output(args)?;
    let mut status = Status::Done;
    let mut scenes = Vec::new();
    for path in &args.scenes {
        match scenes_of(path, args)? {
            Some(found) => scenes.extend(found),
            None => status = Status::SceneErrors,
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
    let sheet = match sheet(&cells, args.columns, cancel) {
        Ok(sheet) => sheet,
        Err(RenderError::Cancelled) => return Ok(Status::Interrupted),
        Err(error) => return Err(Trouble(error.to_string())),
    };
    let written = if is_standard(&args.output) {
        files::write_stream(output::StandardOutput::new(), cancel, |out| {
            film::write_png(&sheet, None, out)
        })
    } else {
        files::write(&args.output, Purpose::Named, cancel, |out| {
            film::write_png(&sheet, None, out)
        })
    };
    match written {
        Err(_) if interrupt.pressed() => Ok(Status::Interrupted),
        Err(error) => Err(unwritable(&args.output, &error)),
        Ok(()) => Ok(Status::Done),
    }
}

/// Rejects an output that is not a PNG, is one of the scenes, or cannot be written.
fn check_output(args: &SheetArgs) -> Result<(), Trouble> {
    let path = &args.output;
    let is_png = path
        .extension()
        .is_some_and(|it| it.eq_ignore_ascii_case("png"));
    if !is_png && !is_standard(path) {
        let path = shown(path);
        return Err(Trouble(format!(
            "a sheet is a PNG: {path} should end in .png"
        )));
    }
    let output = |scene: &PathBuf| PictureOutput::of(scene, Some(path))?.check(scene);
    args.scenes.iter().try_for_each(output)
}

/// Returns the scene of a file with its caption. With `--sweep`, returns all scenes of the sweep
/// with their captions. Returns `None` if a scene has errors, which are reported.
fn scenes_of(path: &Path, args: &SheetArgs) -> Result<Option<Vec<(Scene, String)>>, Trouble> {
    let input = SceneInput::read(path, &args.overrides)?;
    let Some(sweep) = &args.sweep else {
        return Ok(input
            .scene()
            .scene
            .map(|scene| vec![(scene, name(path, args))]));
    };
    let with = |set: String| {
        let mut sources = input.sources.clone();
        let name = format!("{}, --sweep", sources.file.name());
        sources.sets.push(Source::from_text(name, set));
        SceneInput { sources, ..input }
    };
    // The problems of the first scene are always reported; those of the last scene only if it has
    // errors.
    let [first, last] = sweep.ends().map(with);
    if first.scene().scene.is_none() {
        return Ok(None);
    }
    let reading = scene::read(&last.sources);
    if reading.scene.is_none() {
        output::to_people(&last.report(&reading));
        return Ok(None);
    }
    let mut scenes = Vec::new();
    for step in sweep.steps(&input.sources)? {
        let input = with(step.set);
        let reading = scene::read(&input.sources);
        let Some(scene) = reading.scene else {
            output::to_people(&input.report(&reading));
            return Ok(None);
        };
        let name = match args.scenes.len() {
            1 => step.label,
            _ => format!("{} {}", name(path, args), step.label),
        };
        scenes.push((scene, name));
    }
    Ok(Some(scenes))
}

/// Returns the caption of a scene's file: its name without folders and extension, or its path if
/// another file has the same name.
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

/// Returns the scene with its picture scaled down to at most `side` pixels in width and height. The
/// number of samples per pixel does not change.
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
    let world = World::new_unless(scene, cancel).map_err(|_| RenderError::Cancelled)?;
    match picture(scene, &world, whole, KeptPixels::Bytes, cancel)? {
        RenderedPicture::Bytes(bytes) => Ok(bytes.into_film()),
        RenderedPicture::Light(_) | RenderedPicture::Floats(_) => {
            unreachable!("bytes were asked for")
        }
    }
}

/// Renders the pictures and places them on white, row by row, in `columns` columns. If `columns` is
/// `None`, there are about as many columns as rows.
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
    // The memory is allocated before rendering, so that a lack of memory is noticed early.
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

/// Shortens a caption to `width` pixels. The caption of a step of a sweep first loses the target,
/// which is the same in all steps. Then it loses the start of the value, since the steps differ at
/// its end.
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

/// Writes a line of black text on white at the pixel (x, y).
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
