//! Adds objects to the text: a new one in front of the camera, or a copy of an object beside it.

use std::{borrow::Cow, sync::Arc};

use glam::{DVec2, DVec3};

use super::{
    camera::distance,
    edits::{changes, edits, rounded_in_ratio},
    handles::{Along, handles, moved},
};
use crate::{
    color::Color,
    diagnostic::{Edit, Fix, apply},
    editor::Analysis,
    numbers::{rounded, short, short_vector, significant},
    projection::Projection,
    scene::{FieldOwner, Parts, SMALLEST, Scene},
    schema::{self, Preset, Type, css},
    source::{Source, SourceId, Sources, sort_by_span},
    tracer::vertices,
};

/// Maximum number of rows that are searched for a free position for a new object. A row has seven
/// positions, and each row is farther from the camera than the one before it. If no position is
/// free, an occupied one is used. This is unlikely, since hardly anybody adds 700 objects by hand.
const ROWS: i32 = 100;

/// Names of the colours of new objects, in the order in which they are tried. They differ clearly
/// from each other, and from gray and white, the default colours of checkerboards.
const COLORS: [&str; 10] = [
    "olive",
    "teal",
    "orange",
    "crimson",
    "royalblue",
    "turquoise",
    "purple",
    "limegreen",
    "hotpink",
    "sienna",
];

/// Maximum distance of two similar colours: the Euclidean distance of their sRGB channels, which
/// range from 0 to 255. If possible, a new object gets a colour that is not similar to any other.
/// Chosen by eye: with a smaller distance, colours could be confused; a larger distance would
/// exclude too many.
const ALIKE: f64 = 48.0;

/// A block that is added to the text.
#[derive(Clone, Debug, PartialEq)]
pub struct Added {
    /// The edit that writes the block.
    pub edit: Edit,
    /// Name of the new object. A copy of an object without a name has none.
    pub name: Option<String>,
    /// Offset at which the new block starts in the changed text, in UTF-16 code units.
    pub cursor: usize,
}

/// Adds an object of the kind `kind` at the end of the text. The object is placed in front of the
/// camera, beside the other objects, and on a floor if there is one below the eye. Returns `None`
/// if `kind` is not a kind of object.
pub fn add(analysis: &Analysis<'_>, scene: Option<&Scene>, kind: &str) -> Option<Added> {
    let row = schema::block(kind).filter(|row| row.is_object)?;
    let scene = match scene {
        Some(scene) => Cow::Borrowed(scene),
        None => Cow::Owned(sketch(analysis)?),
    };
    let (place, size) = free_place(&scene);
    let from = scene.camera.eye - place;
    let across = if from.x.abs() > from.z.abs() {
        DVec3::X * from.x.signum()
    } else {
        DVec3::Z * from.z.signum()
    };
    let (at, across, size) = (short_vector(place), short_vector(across), short(size));
    let twice = short(2.0 * size.parse().unwrap_or(1.0));
    let below = short(free_height(&scene));
    let words = [
        ("{at}", at),
        ("{across}", across),
        ("{size}", size),
        ("{twice}", twice),
        ("{below}", below),
    ];
    let mut fields = row.added.to_owned();
    for (word, value) in words {
        fields = fields.replace(word, &value);
    }
    // The new object gets a colour of its own, to distinguish it from others. The colour is written
    // into the text, so that the author can change it with a click.
    let color = row.fields.iter().find(|field| field.takes == Type::Color);
    let color = color.and_then(|field| match field.preset {
        Preset::Value(own) => Some(format!("  {} {}", field.name, free_color(&scene, own))),
        Preset::Required | Preset::Alternative | Preset::Nothing => None,
    });
    fields += color.as_deref().unwrap_or_default();
    let name = free_name(analysis, kind);
    let text = analysis.text();
    let end = text.trim_end().len();
    let gap = if end == 0 { "" } else { "\n" };
    Some(Added {
        edit: Edit::insert(
            SourceId::File,
            end,
            format!("{gap}{kind} {name} {{ {fields} }}"),
        ),
        name: Some(name),
        cursor: text[..end].encode_utf16().count() + gap.len(),
    })
}

/// Returns a colour that is not similar ([`ALIKE`]) to any colour of the scene. Tries `own`, the
/// default colour of the new object's kind, and then [`COLORS`]. If all of these are taken, returns
/// one of [`COLORS`] that depends on the number of objects.
fn free_color(scene: &Scene, own: &'static str) -> &'static str {
    let shapes = scene.objects.iter().flat_map(|it| it.shape.colors());
    let taken: Vec<Color> = shapes.chain([scene.image.background]).collect();
    let is_free = |name: &&str| {
        let color = css::color(name).map(|it| DVec3::from(it.srgb));
        let is_far = |it: &Color| color.is_some_and(|own| own.distance(it.srgb.into()) > ALIKE);
        taken.iter().all(is_far)
    };
    let found = std::iter::once(own).chain(COLORS).find(is_free);
    found.unwrap_or(COLORS[scene.objects.len() % COLORS.len()])
}

/// Returns a scene for a text with errors, so that a new object can be placed in it. The scene
/// contains the objects without errors. If the image, camera or sampler has errors, it is replaced
/// by the default one ([`SMALLEST`]).
fn sketch(analysis: &Analysis<'_>) -> Option<Scene> {
    let smallest = Sources::new(Source::from_text("", SMALLEST));
    let smallest = Analysis::new(&smallest).scene()?;
    let Parts {
        image,
        camera,
        sampler,
        objects,
    } = analysis.model.parts.clone();
    Some(Scene {
        image: image.unwrap_or(smallest.image),
        camera: camera.unwrap_or(smallest.camera),
        sampler: sampler.unwrap_or(smallest.sampler),
        objects: Arc::new(objects),
    })
}

/// Returns the edit that inserts a copy of an object's block in the line after it. The copy is
/// moved to the right by a twentieth of the picture's width. The move changes only numbers within
/// the block. If the position is given by the names of definitions, the copy stays in the same
/// place. Returns `None` if there is no object with the index `index`.
pub fn duplicate(analysis: &Analysis<'_>, scene: &Scene, index: usize) -> Option<Added> {
    let object = scene.objects.get(index)?;
    let block = analysis.blocks().find(|block| block.span == object.span)?;
    let projection = Projection::new(&scene.camera, &scene.image);
    let aside = || {
        let (handle, at) = *handles(&object.shape, &projection, projection.right).first()?;
        let to = projection.point(at?)? + DVec2::new(projection.size.x / 20.0, 0.0);
        let moved = moved(object.shape, handle, to, Some(Along::Floor), &projection).ok()?;
        let changes = changes(block, FieldOwner::Shape(object.shape), moved);
        let (changes, rounding) = rounded_in_ratio(&changes, 1);
        edits(analysis, block, &changes, &rounding)
    };
    let is_own =
        |edit: &Edit| block.span.start <= edit.span.start && edit.span.end <= block.span.end;
    let mut edits = aside().unwrap_or_default();
    edits.retain(is_own);
    let name = block.name.map(|_| free_name(analysis, object.shape.kind()));
    let written = block.name.zip(name.clone());
    edits.extend(written.map(|(old, new)| Edit::new(old.span, new)));
    sort_by_span(&mut edits, |edit| edit.span);
    let text = analysis.text();
    let whole = apply(&Fix::new("", edits), SourceId::File, text);
    let rest = &text[block.span.end..];
    let copy = format!("\n{}", &whole[block.span.start..whole.len() - rest.len()]);
    // A comment after the block belongs to the block, so the copy is inserted after the comment.
    let behind = rest.lines().next().unwrap_or_default();
    let is_comment = behind.trim_start().starts_with("//");
    let end = block.span.end + if is_comment { behind.len() } else { 0 };
    Some(Added {
        edit: Edit::insert(SourceId::File, end, copy),
        name,
        cursor: text[..end].encode_utf16().count() + 1,
    })
}

/// Returns a name that does not occur in the text: the kind followed by the smallest possible
/// number, such as `Sphere2`.
fn free_name(analysis: &Analysis<'_>, kind: &str) -> String {
    let capital = kind[..1].to_uppercase() + &kind[1..];
    let names = (1..).map(|number| format!("{capital}{number}"));
    let is_free = |name: &String| {
        !analysis
            .tokens()
            .iter()
            .any(|it| analysis.slice(it.span) == name)
    };
    names.into_iter().find(is_free).unwrap_or(capital)
}

/// Returns the height of a new checkerboard: 0 or, if necessary, less. The checkerboard must be
/// below the eye, at most as high as the lowest point of any object, and at least 1 below any other
/// checkerboard.
fn free_height(scene: &Scene) -> f64 {
    let below_eye = if scene.camera.eye.y > 0.0 {
        0.0
    } else {
        scene.camera.eye.y.floor() - 1.0
    };
    let bottoms = scene.objects.iter().filter_map(|object| {
        let bottom = object.shape.bounding_box(vertices).map(|[min, _]| min.y);
        bottom.or_else(|| Some(object.shape.checkerboard()?.y - 1.0))
    });
    bottoms.fold(below_eye, f64::min)
}

/// Returns a free place in front of the camera for a new object. The place is a cube for the object
/// to fill, given by its centre and half of its side length.
fn free_place(scene: &Scene) -> (DVec3, f64) {
    let projection = Projection::new(&scene.camera, &scene.image);
    let distance = distance(scene);
    let size = significant(0.15 * projection.size.y * projection.pitch * distance, 1);
    let boards = scene.objects.iter();
    let boards = boards.filter_map(|object| Some(object.shape.checkerboard()?.y));
    let floors = boards.filter(|y| *y < projection.eye.y);
    // If there is no board below the eye, a floor is assumed at the height 0, because a board that
    // is added later usually has this height. This is done only if the view axis passes near that
    // floor.
    let floor = floors.reduce(f64::max).or_else(|| {
        let bottom = projection.eye.y + projection.ahead.y * distance - size;
        (projection.eye.y > 0.0 && bottom.abs() <= size).then_some(0.0)
    });
    let shapes = scene.objects.iter().map(|object| object.shape);
    let shapes = shapes.filter(|shape| shape.checkerboard().is_none());
    let middles =
        shapes.filter_map(|shape| handles(&shape, &projection, projection.right).first()?.1);
    let taken: Vec<DVec3> = middles.collect();
    let place = |floor: Option<f64>, steps: i32, row: i32| {
        // Every other row is shifted by half the distance of its positions, so that its objects are
        // visible between the objects of the row in front of it.
        let aside = f64::from(steps) + 0.5 * f64::from(row % 2);
        let [aside, behind] = [aside, f64::from(row)].map(|steps| 2.5 * size * steps);
        let at = projection.eye + projection.right * aside + projection.ahead * (distance + behind);
        let at = DVec3::from(at.to_array().map(|x| rounded(x, size / 10.0)));
        // An object on a floor must touch it, so its height is not rounded.
        floor.map_or(at, |y| at.with_y(y + size))
    };
    let is_seen = |at: &DVec3| is_seen(*at, size, &projection);
    // Each row has seven positions. Positions on the floor are tried first, and then positions at
    // the height of the view axis.
    let row = |floor, row| [0, 1, -1, 2, -2, 3, -3].map(|steps| place(floor, steps, row));
    let rows = |floor| (0..ROWS).flat_map(move |it| row(floor, it));
    let mut places = rows(floor).chain(rows(None)).filter(is_seen);
    let is_free = |at: &DVec3| taken.iter().all(|it| it.distance(*at) > 1.5 * size);
    let is_apart = |at: DVec3, it: DVec3| {
        let nearest = projection.depth(at).min(projection.depth(it));
        let radius = size / (projection.pitch * nearest);
        let seen = projection.point(at).zip(projection.point(it));
        seen.is_none_or(|(at, it)| at.distance(it) > radius)
    };
    let is_clear = |at: &DVec3| is_free(at) && taken.iter().all(|it| is_apart(*at, *it));
    let found = places.clone().find(is_clear);
    let found = found.or_else(|| places.clone().find(is_free));
    let middle = || projection.eye + projection.ahead * distance;
    let found = found.or_else(|| places.next()).unwrap_or_else(middle);
    (found, size)
}

/// Returns whether a cube with the centre `at` lies within the picture; `size` is half of its side.
fn is_seen(at: DVec3, size: f64, projection: &Projection) -> bool {
    let corner = |index: u8| {
        let sides = [1, 2, 4].map(|bit| if index & bit == 0 { -size } else { size });
        projection.point(at + DVec3::from(sides))
    };
    (0..8).map(corner).all(|corner| {
        corner.is_some_and(|it| it.cmpge(DVec2::ZERO).all() && it.cmple(projection.size).all())
    })
}
