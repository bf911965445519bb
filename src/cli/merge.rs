//! `merge`: combines the parts of a picture into one file, which equals the file that a single
//! render writes.

use std::{
    fs::File,
    io::{self, BufReader, Read, Seek},
    path::{Path, PathBuf},
};

use super::{
    CommandError, Status,
    args::MergeArgs,
    command_error,
    input::{self, shown, unreadable},
    interrupt::Interrupt,
    picture::{FileFormat, PictureOutput},
};
use crate::{
    area::Area,
    files,
    film::{self, FileRows, Film, Part, Pixel, Recipe, SIGNATURE},
};

/// Number of rows that are combined at a time. With more rows, a wide picture would need more
/// memory; with fewer, memory would be allocated, and rows would be written, more often.
const ROWS: u32 = 64;

/// A file that contains a part of the picture.
struct PartFile {
    path: PathBuf,
    format: FileFormat,
    part: Part,
    /// The scene and its overrides. `None` if the file is an EXR file, or if the scene was too long
    /// to be stored in the PNG.
    recipe: Option<Recipe>,
}

/// Puts parts together and writes the whole picture.
pub fn run(args: &MergeArgs, interrupt: &Interrupt) -> Result<Status, CommandError> {
    let output = PictureOutput::of(&args.output, Some(&args.output))?;
    let PictureOutput::File(path, format, _) = &output else {
        return Err(command_error(
            "merge writes a file: say with `-o FILE` where it goes",
        ));
    };
    if let Some(part) = args
        .parts
        .iter()
        .find(|part| input::is_same_file(part, path))
    {
        let part = shown(part);
        return Err(command_error(format!(
            "{part} is one of the parts: say with `-o FILE` where the whole picture goes"
        )));
    }
    args.parts.iter().try_for_each(|part| output.check(part))?;
    let mut parts = Vec::new();
    for part in &args.parts {
        parts.push(PartFile::read(part).map_err(|error| unreadable(part, &error))?);
    }
    parts.sort_by_key(|part| (part.part.area.y, part.part.area.x));
    check_alike(&parts, path, *format)?;
    check_overlaps(&parts)?;
    let Some(first) = parts.first() else {
        return Err(command_error("there are no parts"));
    };
    let whole = Area::whole(first.part.size[0], first.part.size[1]);
    if let Some(gap) = gap(&parts, whole) {
        return Err(command_error(format!(
            "no part has the pixels {gap} of the whole picture, X,Y,W,H, which has {} × {} pixels",
            whole.width, whole.height
        )));
    }
    let recipe = first.recipe.clone().map(|recipe| Recipe {
        crop: None,
        size: None,
        ..recipe
    });
    let digest = first.part.digest.clone();
    let mut failed = None;
    let written = output.write(&first.path, interrupt.watch(), |out| match format {
        FileFormat::Png => {
            let mut rows = MergedRows::new(&parts, whole, film::png_rows);
            let bands = std::iter::from_fn(|| rows.band(&mut failed));
            film::write_png_bands([whole.width, whole.height], recipe.as_ref(), out, bands)
        }
        FileFormat::Exr => {
            let mut rows = MergedRows::new(&parts, whole, film::exr_rows);
            let bands = std::iter::from_fn(|| rows.band(&mut failed));
            film::write_exr_bands(whole, whole, Some(&digest), out, bands)
        }
    });
    match failed {
        Some(failed) => Err(failed),
        None => written
            .map(|()| Status::Done)
            .map_err(|error| interrupt.or(error)),
    }
}

impl PartFile {
    fn read(path: &Path) -> io::Result<Self> {
        let mut file = files::open(path)?;
        let mut start = Vec::new();
        file.by_ref()
            .take(input::PICTURE_LIMIT)
            .read_to_end(&mut start)?;
        if start.starts_with(&SIGNATURE) {
            let (part, recipe) = film::read_part(&start).map_err(io::Error::other)?;
            let (path, format) = (path.to_owned(), FileFormat::Png);
            return Ok(Self {
                path,
                format,
                part,
                recipe,
            });
        }
        file.rewind()?;
        let place = film::read_exr_place(BufReader::new(file))
            .map_err(|_| io::Error::other("it is neither a PNG nor an EXR file of a part"))?;
        // A file that shows the whole picture is accepted, too: `--shard 1/1` writes such a file.
        // Pinhole stores a digest of the scene in each file that it renders, so a file without a
        // digest is not from Pinhole.
        let Some(digest) = place.digest else {
            let message = "it is no part of a picture that Pinhole rendered";
            return Err(io::Error::other(message));
        };
        Ok(Self {
            path: path.to_owned(),
            format: FileFormat::Exr,
            part: Part {
                area: place.area,
                size: place.size,
                digest,
            },
            recipe: None,
        })
    }
}

/// Rejects parts of different pictures or formats, and an output of another format.
fn check_alike(parts: &[PartFile], output: &Path, format: FileFormat) -> Result<(), CommandError> {
    for (one, other) in parts.iter().zip(parts.iter().skip(1)) {
        let [a, b] = [one, other].map(|part| shown(&part.path));
        if one.format != other.format {
            return Err(command_error(format!(
                "{a} and {b} are files of different formats"
            )));
        }
        if one.part.size != other.part.size {
            let [[w, h], [v, g]] = [one, other].map(|part| part.part.size);
            return Err(command_error(format!(
                "{a} is a part of a picture of {w} × {h} pixels, and {b} of one of {v} × {g}"
            )));
        }
        if one.part.digest != other.part.digest {
            return Err(command_error(format!(
                "{a} and {b} are of different scenes: their texts, their `--set` arguments or the versions of Pinhole differ"
            )));
        }
    }
    match parts.first() {
        Some(part) if part.format != format => Err(command_error(format!(
            "{} has another format than the parts: give it the ending of {}",
            shown(output),
            shown(&part.path)
        ))),
        _ => Ok(()),
    }
}

/// Rejects parts that do not lie in the whole picture, or have pixels in common. `parts` are sorted
/// by their first rows.
fn check_overlaps(parts: &[PartFile]) -> Result<(), CommandError> {
    for (at, one) in parts.iter().enumerate() {
        let [width, height] = one.part.size;
        if one.part.area.pixels() == 0 || !one.part.area.lies_in(Area::whole(width, height)) {
            let (path, area) = (shown(&one.path), one.part.area);
            return Err(command_error(format!(
                "{path} says that it is the part {area} of a picture of {width} × {height} pixels"
            )));
        }
        let end = one.part.area.y + one.part.area.height;
        let beside = parts[at + 1..]
            .iter()
            .take_while(|other| other.part.area.y < end);
        for other in beside {
            if one.part.area.meets(other.part.area) {
                let common = one.part.area.common(other.part.area);
                let [a, b] = [one, other].map(|part| shown(&part.path));
                return Err(command_error(format!(
                    "{a} and {b} overlap: both have the pixels {common}, X,Y,W,H"
                )));
            }
        }
    }
    Ok(())
}

/// Returns the topmost area of the whole picture that is missing from all parts, or `None` if no
/// area is missing. The parts must lie in the picture and not overlap.
fn gap(parts: &[PartFile], whole: Area) -> Option<Area> {
    let covered: u64 = parts.iter().map(|part| part.part.area.pixels()).sum();
    if covered == whole.pixels() {
        return None;
    }
    // `cuts` contains the rows at which parts begin or end. All rows between two neighbouring cuts
    // are covered by the same parts.
    let ends = |part: &PartFile| [part.part.area.y, part.part.area.y + part.part.area.height];
    let mut cuts: Vec<u32> = parts
        .iter()
        .flat_map(ends)
        .chain([0, whole.height])
        .collect();
    cuts.sort_unstable();
    cuts.dedup();
    cuts.windows(2).find_map(|cuts| {
        let (top, end) = (cuts[0], cuts[1]);
        let band = Area {
            y: top,
            height: end - top,
            ..whole
        };
        let areas = parts.iter().map(|part| part.part.area.common(band));
        let mut areas: Vec<Area> = areas.filter(|area| area.pixels() > 0).collect();
        areas.sort_by_key(|area| area.x);
        let mut left = 0;
        for area in areas {
            if area.x > left {
                return Some(Area {
                    x: left,
                    width: area.x - left,
                    ..band
                });
            }
            left = area.x + area.width;
        }
        (left < whole.width).then(|| Area {
            x: left,
            width: whole.width - left,
            ..band
        })
    })
}

/// Function that opens a file to read its rows. Its second argument is the width of the file's
/// picture in pixels.
type OpenRows<P> = fn(BufReader<File>, u32) -> io::Result<FileRows<P>>;

/// The rows of the whole picture, read from the files of its parts. A part's file is open only
/// while its rows are read.
struct MergedRows<'a, P> {
    parts: &'a [PartFile],
    whole: Area,
    open_rows: OpenRows<P>,
    /// Index of the first part whose file has not been opened yet.
    next: usize,
    /// Open files of parts, of which some rows have not been read yet.
    open: Vec<(&'a PartFile, FileRows<P>)>,
    /// Index of the next row.
    y: u32,
}

impl<'a, P: Pixel> MergedRows<'a, P> {
    fn new(parts: &'a [PartFile], whole: Area, open_rows: OpenRows<P>) -> Self {
        Self {
            parts,
            whole,
            open_rows,
            next: 0,
            open: Vec::new(),
            y: 0,
        }
    }

    /// Returns the next rows, or `None` after the last row. If a part cannot be read, returns an
    /// error, and stores its message in `failed`.
    fn band(&mut self, failed: &mut Option<CommandError>) -> Option<io::Result<Film<P>>> {
        let rows = ROWS.min(self.whole.height - self.y);
        if rows == 0 {
            return None;
        }
        let band = self.read(rows);
        Some(band.map_err(|error| {
            *failed = Some(error);
            io::ErrorKind::Other.into()
        }))
    }

    fn read(&mut self, rows: u32) -> Result<Film<P>, CommandError> {
        let film = Film::new(self.whole.width, rows);
        let mut film = film.map_err(|error| command_error(error.to_string()))?;
        for row in film
            .pixels_mut()
            .chunks_exact_mut(self.whole.width as usize)
        {
            while let Some(part) = self
                .parts
                .get(self.next)
                .filter(|it| it.part.area.y == self.y)
            {
                let opened = files::open(&part.path)
                    .and_then(|file| (self.open_rows)(BufReader::new(file), part.part.area.width));
                let opened = opened.map_err(|error| unreadable(&part.path, &error))?;
                self.open.push((part, opened));
                self.next += 1;
            }
            for (part, rows) in &mut self.open {
                let pixels = rows
                    .next()
                    .unwrap_or_else(|| Err(io::Error::other("it has too few rows")));
                let pixels = pixels.map_err(|error| unreadable(&part.path, &error))?;
                row[part.part.area.x as usize..][..pixels.len()].copy_from_slice(&pixels);
            }
            self.y += 1;
            let y = self.y;
            self.open
                .retain(|(part, _)| part.part.area.y + part.part.area.height > y);
        }
        Ok(film)
    }
}
