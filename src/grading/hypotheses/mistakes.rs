//! The table of mistakes that students make. A row has an identifier, a message, advice, and a
//! function that applies the mistake to a hypothesis about a program.

use std::{f64::consts::FRAC_1_SQRT_2, mem::swap};

use glam::DVec3;

use super::{
    behaviour::{HitFault, Rays, SeenSurface, Shading, Spheres, floor, is_even},
    candidate::{
        Candidate, MistakeRow,
        Shows::{self, AtEdges, Everywhere, InAreas},
    },
    changes::{
        anchor, distance, divide_by_sine_of_up, exchange_colors, exchange_faces, exchange_sides,
        gray_of_encoded, has_board, is_square, lengthen, look_back, map_channels, multiply,
        reverse_normal, set_aspect, set_averaging, set_encoding, set_hit_fault, set_order,
        set_seen_surface, set_sphere_fault, set_square_rule, shapes, shift, sides,
        spread_by_one_less, stretch, twice_arctan, zoom,
    },
    light::{Curve, Effect, NONE},
};
use crate::{
    color::{linear_to_srgb, srgb_to_linear},
    math::Angle,
    scene::{Lens, Shape, View},
};

const ENCODE: &str = "encode each channel once, before it is written: 12.92 c up to 0.0031308, else 1.055 c^(1/2.4) − 0.055";
const AVERAGE: &str = "decode a scene's colours to linear light, average there, and encode once";
const NEAREST: &str =
    "keep the least t > 0 of all hits of a ray, and replace it only by a lesser one";
const AHEAD: &str = "a hit counts only if t > 0";
const CLIPPED: &str = "a hit counts only if near < depth < far";
const SQUARES: &str = "a square has the first colour where floor(x/square) + floor(z/square) is even; floor(−0.5) is −1, and −1 % 2 may be −1";
const WINDOW: &str = "the window is view_height tall, and its width is view_height · width/height";
const PERSPECTIVE: &str = "all rays leave from the eye, along x u + y v − d w";
const HALVES: &str = "the window is view_height tall: from −view_height/2 to view_height/2";
const STRIDE: &str = "a row of a picture has width pixels: a pixel's index is row · width + column, wherever it is read or written";
const MIDDLE: &str = "the middle of the pixel in column x and row y is at (x + 1/2, y + 1/2)";
const ORDER: &str = "a picture's channels are in the order red, green, blue";
const CHANNELS: &str = "write each channel";
const UP: &str = "u = (up × w)/|up × w|";
const DIVIDE: &str = "a pixel's light is the sum of its samples divided by their number";
const EDGES: &str =
    "a point of a triangle's plane lies in it if it is on the inner side of all three edges";
const SLABS: &str =
    "a ray hits a box if it enters the slabs of all three axes before it leaves one of them";
const BOX: &str = "a box reaches from center − size/2 to center + size/2";
const CENTROID: &str = "the centroid is the mean of the three vertices";
const FACES: &str = "the first of the colors is that of the faces across x, the second across y, the third across z";

const fn row(
    id: &'static str,
    shows: Shows,
    message: &'static str,
    help: &'static str,
    change: fn(&mut Candidate, usize),
) -> MistakeRow {
    MistakeRow {
        id,
        shows,
        message,
        help,
        change,
    }
}

/// Expands to a row of the table of mistakes. Rows of one family differ only in a part of the
/// message and in a number or function. The first argument names the family, and the others are the
/// differing parts.
#[rustfmt::skip]
macro_rules! family {
    (window $window:literal, $aspect:expr) => { row("aspect", InAreas, concat!("the picture is stretched: its window is ", $window, ", though the picture is not"), WINDOW, |c, _| set_aspect(c, $aspect)) };
    (channels $order:literal, $channels:expr) => { row("channels", InAreas, concat!("the colour channels are in the order ", $order), ORDER, |c, _| c.effects.push(Effect::Channels($channels))) };
    (without $channel:literal, $channels:expr) => { row("channels", InAreas, concat!("the ", $channel, " channel is 0 everywhere"), CHANNELS, |c, _| c.effects.push(Effect::Channels($channels))) };
    (brighter $light:literal, $factor:expr) => { row("not_divided", InAreas, concat!("the light is ", $light), DIVIDE, |c, _| map_channels(c, |light| ($factor * light).min(1.0))) };
    (finite $reach:literal) => { row("board_finite", InAreas, concat!("the checkerboard ends at ±", $reach, " along x and z"), "a checkerboard is a whole plane: a ray hits it at t = (y − e_y)/d_y, wherever that is", |c, _| if has_board(c) && c.behaviour.board_reach.is_infinite() { c.behaviour.board_reach = f64::from($reach) }) };
    (shaded $light:literal, $shading:expr) => { row("shaded", InAreas, concat!("colours are shaded by the cosine of their surface's angle with ", $light), "an object has its own colour wherever it is seen: multiply it by nothing", |c, _| if c.behaviour.shading == Shading::None { c.behaviour.shading = $shading }) };
    (board $id:literal, $message:literal, $is_first:expr) => { row($id, InAreas, $message, SQUARES, |c, _| set_square_rule(c, $is_first)) };
    (faces $axes:literal, $order:expr) => { row("faces_exchanged", InAreas, concat!("has the colours of its faces across ", $axes, " exchanged"), FACES, |c, object| exchange_faces(c, object, $order)) };
}

/// Rows of the table of mistakes that are not about a single object. In a message, `{gain}`
/// represents the factor by which the program multiplies light, which is estimated from the
/// picture.
#[rustfmt::skip]
pub const ROWS: &[MistakeRow] = &[
    row("stride", InAreas, "each row lies one pixel further right than the one above it: rows are taken for one pixel shorter where they are read, or longer where they are written", STRIDE, |c, _| c.layout.stride -= 1),
    row("stride", InAreas, "each row lies one pixel further left than the one above it: rows are taken for one pixel longer where they are read, or shorter where they are written", STRIDE, |c, _| c.layout.stride += 1),
    row("mirrored", InAreas, "the picture is mirrored: left and right are exchanged", "u = (up × w)/|up × w| points to the right; w × up points to the left", |c, _| c.layout.is_mirrored ^= true),
    row("upside_down", InAreas, "the picture is upside down: top and bottom are exchanged", "rows are counted from the top, and y_v = s (height/2 − py) falls as they grow", |c, _| c.layout.is_upside_down ^= true),
    row("turned_180", InAreas, "the picture is turned by 180 degrees", "the view plane lies before the eye, at −d w, so the picture stands upright", |c, _| { c.layout.is_mirrored ^= true; c.layout.is_upside_down ^= true; }),
    row("transposed", InAreas, "the picture is transposed: rows and columns are exchanged", "a pixel's index is row · width + column", |c, _| c.layout.is_transposed ^= is_square(c)),
    row("turned_90", InAreas, "the picture is turned by a quarter, clockwise", "a pixel's index is row · width + column", |c, _| if is_square(c) { c.layout.is_transposed ^= true; c.layout.is_upside_down ^= true; }),
    row("turned_90", InAreas, "the picture is turned by a quarter, anticlockwise", "a pixel's index is row · width + column", |c, _| if is_square(c) { c.layout.is_transposed ^= true; c.layout.is_mirrored ^= true; }),
    row("squeezed", InAreas, "the picture is stretched: its window is as wide as it is high, though the picture is not", WINDOW, |c, _| set_aspect(c, 1.0)),
    family!(window "4:3", 4.0 / 3.0),
    family!(window "3:2", 1.5),
    family!(window "16:10", 1.6),
    family!(window "16:9", 16.0 / 9.0),
    family!(window "2:1", 2.0),
    row("aspect", InAreas, "the picture is stretched: its window's width is view_height · height/width", WINDOW, |c, _| { let [width, height] = sides(c); set_aspect(c, height / width); }),
    row("aspect", InAreas, "the picture is stretched: its window is twice as wide as it should be", WINDOW, |c, _| { let [width, height] = sides(c); set_aspect(c, 2.0 * width / height); }),
    row("aspect", InAreas, "the picture is stretched: its window is half as wide as it should be", WINDOW, |c, _| { let [width, height] = sides(c); set_aspect(c, 0.5 * width / height); }),
    row("half_pixel", AtEdges, "samples lie half a pixel too far up and left: around a pixel's corner, not its middle", MIDDLE, |c, _| shift(c, [-0.5, -0.5])),
    row("half_pixel", AtEdges, "samples lie half a pixel too far down and right", MIDDLE, |c, _| shift(c, [0.5, 0.5])),
    row("half_pixel", AtEdges, "samples lie half a pixel too far down and left", MIDDLE, |c, _| shift(c, [-0.5, 0.5])),
    row("half_pixel", AtEdges, "samples lie half a pixel too far left", MIDDLE, |c, _| shift(c, [-0.5, 0.0])),
    row("half_pixel", AtEdges, "samples lie half a pixel too far right", MIDDLE, |c, _| shift(c, [0.5, 0.0])),
    row("half_pixel", AtEdges, "samples lie half a pixel too far up", MIDDLE, |c, _| shift(c, [0.0, -0.5])),
    row("half_pixel", AtEdges, "samples lie half a pixel too far down", MIDDLE, |c, _| shift(c, [0.0, 0.5])),
    row("half_pixel", AtEdges, "samples lie a whole pixel too far up and left", MIDDLE, |c, _| shift(c, [-1.0, -1.0])),
    row("half_pixel", AtEdges, "samples lie a whole pixel too far down and right", MIDDLE, |c, _| shift(c, [1.0, 1.0])),
    row("half_pixel", AtEdges, "samples lie a whole pixel too far left", MIDDLE, |c, _| shift(c, [-1.0, 0.0])),
    row("half_pixel", AtEdges, "samples lie a whole pixel too far right", MIDDLE, |c, _| shift(c, [1.0, 0.0])),
    row("half_pixel", AtEdges, "samples lie two whole pixels too far left", MIDDLE, |c, _| shift(c, [-2.0, 0.0])),
    row("half_pixel", AtEdges, "samples lie two whole pixels too far right", MIDDLE, |c, _| shift(c, [2.0, 0.0])),
    row("half_pixel", AtEdges, "samples lie a whole pixel too far up", MIDDLE, |c, _| shift(c, [0.0, -1.0])),
    row("half_pixel", AtEdges, "samples lie a whole pixel too far down", MIDDLE, |c, _| shift(c, [0.0, 1.0])),
    row("half_pixel", AtEdges, "samples lie a quarter of a pixel too far up and left", MIDDLE, |c, _| shift(c, [-0.25, -0.25])),
    row("half_pixel", AtEdges, "samples lie a quarter of a pixel too far down and right", MIDDLE, |c, _| shift(c, [0.25, 0.25])),
    row("half_pixel", AtEdges, "pixels are spread over the window as if it had one less in a row and in a column: (i + r)/(width − 1)", MIDDLE, |c, _| spread_by_one_less(c)),
    row("half_pixel", AtEdges, "the first and the last pixel of a row or column look through the window's border, not half a pixel within it: i/(width − 1)", MIDDLE, |c, _| { spread_by_one_less(c); shift(c, c.behaviour.spread.map(|spread| -0.5 * spread)) }),
    row("half_pixel", AtEdges, "samples lie only in the upper left quarter of each pixel", MIDDLE, |c, _| { shift(c, [-0.25, -0.25]); c.behaviour.pixel = 0.5 }),
    row("window_one_less", AtEdges, "the window is divided by one less than it has rows, so pixels are too large: s = view_height/(height − 1)", MIDDLE, |c, _| { let height = sides(c)[1]; if height > 1.0 { lengthen(c, (height - 1.0) / height) } }),
    family!(channels "blue, green, red", [2, 1, 0]),
    family!(channels "red, blue, green", [0, 2, 1]),
    family!(channels "green, red, blue", [1, 0, 2]),
    family!(channels "green, blue, red", [1, 2, 0]),
    family!(channels "blue, red, green", [2, 0, 1]),
    family!(without "red", [NONE, 1, 2]),
    family!(without "green", [0, NONE, 2]),
    family!(without "blue", [0, 1, NONE]),
    row("gray", InAreas, "the picture is gray: its channels have their luminance", CHANNELS, |c, _| c.effects.push(Effect::Gray([0.2126, 0.7152, 0.0722]))),
    row("gray", InAreas, "the picture is gray: its channels have their mean", CHANNELS, |c, _| c.effects.push(Effect::Gray([1.0 / 3.0; 3]))),
    row("gray", InAreas, "the picture is gray: its channels have the mean of their encoded values", CHANNELS, |c, _| gray_of_encoded(c, [1.0 / 3.0; 3])),
    row("gray", InAreas, "the picture is gray: its channels have the luma of their encoded values", CHANNELS, |c, _| gray_of_encoded(c, [0.299, 0.587, 0.114])),
    row("gray", InAreas, "the picture is gray: its channels have the luma of their encoded values, weighted as light", CHANNELS, |c, _| gray_of_encoded(c, [0.2126, 0.7152, 0.0722])),
    row("not_encoded", InAreas, "the colours are too dark: linear light was written where sRGB is expected", ENCODE, |c, _| set_encoding(c, Curve::Missing)),
    row("encoded_twice", InAreas, "the colours are too bright: they were encoded as sRGB twice, or a scene's sRGB colours were not decoded", AVERAGE, |c, _| set_encoding(c, Curve::Twice)),
    row("gamma_22", Everywhere, "the colours were encoded with the power 1/2.2, which is near sRGB but not it", ENCODE, |c, _| set_encoding(c, Curve::Power22)),
    row("gamma_2", InAreas, "the colours were encoded with a square root, which is near sRGB but not it", ENCODE, |c, _| set_encoding(c, Curve::Root)),
    row("not_decoded", InAreas, "a scene's sRGB numbers are taken for light, and their square root is written: the colours are too bright", AVERAGE, |c, _| map_channels(c, |light| srgb_to_linear(linear_to_srgb(light).sqrt()))),
    row("decoded_twice", InAreas, "the colours are much too dark: light was decoded from sRGB once more instead of encoded", ENCODE, |c, _| map_channels(c, |light| srgb_to_linear(srgb_to_linear(light)))),
    row("gamma_18", InAreas, "the colours were encoded with the power 1/1.8, not as sRGB", ENCODE, |c, _| map_channels(c, |light| srgb_to_linear(libm::pow(light.max(0.0), 1.0 / 1.8)))),
    row("video_range", InAreas, "the colours lie between 16 and 235, as video has them, not between 0 and 255", CHANNELS, |c, _| map_channels(c, |light| srgb_to_linear((16.0 + 219.0 * linear_to_srgb(light)) / 255.0))),
    row("bytes_wrap", InAreas, "full channels are 0: 256 c is kept in a byte, which goes up to 255", "a channel's byte is round(255 c) of its encoded colour c", |c, _| map_channels(c, |light| srgb_to_linear((256.0 * linear_to_srgb(light) + 1e-6).floor() % 256.0 / 255.0))),
    row("inverted", InAreas, "the colours are inverted: each channel is 255 less what it should be", CHANNELS, |c, _| map_channels(c, |light| srgb_to_linear(1.0 - linear_to_srgb(light.min(1.0))))),
    family!(brighter "half of what it should be: the sum of samples is divided by twice their number", 0.5),
    family!(brighter "sixteen times what it should be: the sum of samples is not divided by their number", 16.0),
    row("not_divided", InAreas, "all light is multiplied by about {gain}: the sum of samples is divided by the wrong count", DIVIDE, |c, _| multiply(c, [|light| light; 2])),
    row("bytes_scaled", InAreas, "all bytes are multiplied by about {gain}, after encoding", "a byte is 255 times an encoded colour: look for another factor", |c, _| multiply(c, [linear_to_srgb, srgb_to_linear])),
    row("sharpened", Everywhere, "the picture is sharpened: edges overshoot", "a pixel is the mean of light over its own square, and nothing is done to the picture then", |c, _| if c.effects.is_empty() { c.effects.push(Effect::Sharpened) }),
    row("averaged_encoded", AtEdges, "samples were averaged as sRGB numbers, not as light: flat colours are right, and edges too dark", AVERAGE, |c, _| set_averaging(c, Curve::Missing)),
    row("gamma_22_averaged", AtEdges, "colours were decoded with the power 2.2 and encoded with 1/2.2, which is near sRGB but not it: flat colours are right, and edges a little off", ENCODE, |c, _| set_averaging(c, Curve::Power22)),
    row("cut_off", Everywhere, "bytes are cut off instead of rounded, as int(255 c) does: they are too dark by up to a step", "a channel's byte is round(255 c), which is floor(255 c + 0.5), of its encoded colour c", |c, _| c.effects.push(Effect::CutOff)),
    row("depth_ignored", InAreas, "of several objects that a ray hits the last one in the file is seen, though another one may be nearer", NEAREST, |c, _| set_order(c, SeenSurface::Last)),
    row("depth_ignored", InAreas, "of several objects that a ray hits the first one in the file is seen, though another one may be nearer", NEAREST, |c, _| set_order(c, SeenSurface::First)),
    row("depth_ignored", InAreas, "of several objects that a ray hits the farthest one is seen, not the nearest", NEAREST, |c, _| set_order(c, SeenSurface::Farthest)),
    row("behind_seen", InAreas, "what lies behind the eye is seen, as the floor in the sky: hits with t < 0 count", AHEAD, |c, _| set_seen_surface(c, SeenSurface::Behind)),
    row("behind_seen", InAreas, "what lies behind the eye is seen, as the floor in the sky, where nothing before it is nearer: hits with t < 0 count", AHEAD, |c, _| set_seen_surface(c, SeenSurface::NearestBothWays)),
    family!(board "board_truncated", "coordinates on the checkerboard are truncated towards 0, so the squares on both sides of an axis are one", |x, z| is_even(x as i64, z as i64)),
    family!(board "board_truncated", "the coordinate x on the checkerboard is truncated towards 0", |x, z| is_even(x as i64, floor(z))),
    family!(board "board_truncated", "the coordinate z on the checkerboard is truncated towards 0", |x, z| is_even(floor(x), z as i64)),
    family!(board "board_rounded", "coordinates on the checkerboard are rounded to the nearest whole number, not down", |x, z| is_even(floor(x + 0.5), floor(z + 0.5))),
    family!(board "board_both", "a square of the checkerboard has the first colour only where its row and its column are both even", |x, z| (floor(x) | floor(z)) & 1 == 0),
    family!(board "board_sum", "the checkerboard's coordinates are added before they are rounded down: its squares are diagonal stripes", |x, z| floor(x + z) & 1 == 0),
    family!(board "board_stripes", "the checkerboard has stripes: of its coordinates x alone counts (or y in the place of z)", |x, _| floor(x) & 1 == 0),
    family!(board "board_stripes", "the checkerboard has stripes: of its coordinates z alone counts (or y in the place of x)", |_, z| floor(z) & 1 == 0),
    family!(board "board_moved", "the checkerboard is moved by half a square along x", |x, z| is_even(floor(x + 0.5), floor(z))),
    family!(board "board_moved", "the checkerboard is moved by half a square along z", |x, z| is_even(floor(x), floor(z + 0.5))),
    family!(board "board_turned", "the checkerboard is turned by 45 degrees", |x, z| is_even(floor((x + z) * FRAC_1_SQRT_2), floor((x - z) * FRAC_1_SQRT_2))),
    family!(board "board_turned", "the checkerboard is turned by 45 degrees, and its squares are smaller by √2: its coordinates are x + z and x − z", |x, z| is_even(floor(x + z), floor(x - z))),
    family!(finite 3),
    family!(finite 4),
    family!(finite 5),
    family!(finite 6),
    family!(finite 8),
    family!(finite 10),
    family!(finite 12),
    family!(finite 15),
    family!(finite 20),
    family!(finite 25),
    family!(finite 50),
    family!(finite 100),
    row("board_upright", InAreas, "the checkerboard stands upright: its y is taken for z", "a checkerboard lies at the height y, and a ray hits it at t = (y − e_y)/d_y", |c, _| if has_board(c) { c.behaviour.board_normal = 2 }),
    family!(shaded "the ray", Shading::OfRay),
    family!(shaded "the direction (1, 1, 1)", Shading::To(DVec3::ONE / 3f64.sqrt())),
    family!(shaded "the direction (0, 1, 0)", Shading::To(DVec3::Y)),
    family!(board "board_sines", "the checkerboard's squares are told by sin x · sin z, and have a side of π squares", |x, z| libm::sin(x) * libm::sin(z) >= 0.0),
    family!(board "board_remainder", "a negative odd sum of a checkerboard's coordinates is taken for an even one", |x, z| floor(x).wrapping_add(floor(z)) % 2 != 1),
    family!(board "board_remainder", "a checkerboard's coordinates, one of them negative, are compared by their remainders", |x, z| floor(x) % 2 == floor(z) % 2),
    row("board_swapped", InAreas, "the checkerboard's colours are exchanged, or it is turned by a quarter or moved by a square", SQUARES, |c, _| exchange_colors(c)),
    row("roll_sign", InAreas, "the roll has the wrong sign", "u' = cos ψ u − sin ψ v and v' = sin ψ u + cos ψ v: a positive roll dips the right side", |c, _| c.scene.camera.roll = -c.scene.camera.roll),
    row("roll_ignored", InAreas, "the roll is ignored", "turn u and v by the roll about the view direction", |c, _| c.scene.camera.roll = Angle::default()),
    // A roll of 2 degrees is taken for 2 radians. A scene has angles in degrees, so 2 radians are
    // converted to degrees.
    row("roll_unit", InAreas, "the roll's degrees are taken for radians", "sin and cos take radians: 180 degrees are π", |c, _| c.scene.camera.roll = Angle::from_degrees(c.scene.camera.roll.degrees.to_degrees() % 360.0)),
    row("roll_new_u", InAreas, "the roll is done with the new u in the place of the old one, so the picture is skewed", "keep u before it is changed: v' = sin ψ u + cos ψ v has the old u, and your v is built from the new one", |c, _| if c.scene.camera.roll != Angle::default() { c.behaviour.rays = Rays::NewRight }),
    row("roll_u_alone", InAreas, "u alone is turned by the roll, v is not, so the picture is skewed", "a roll turns both: u' = cos ψ u − sin ψ v and v' = sin ψ u + cos ψ v", |c, _| if c.scene.camera.roll != Angle::default() { c.behaviour.rays = Rays::RightAlone }),
    row("up_not_orthogonal", InAreas, "up itself is taken for v, though it is not at right angles to the view direction", "v = w × u, both of length 1", |c, _| c.behaviour.rays = Rays::UpAsTop),
    row("w_not_normalised", InAreas, "w is not divided by its length, so the view plane is |eye − lookat| times as far", "w = (eye − lookat)/|eye − lookat|", |c, _| if let View::Lookat(point) = c.scene.camera.view { lengthen(c, point.distance(c.scene.camera.eye)) }),
    row("u_not_normalised", InAreas, "u is not divided by its length, so pixels are too small: |up × w| is less than 1", UP, |c, _| divide_by_sine_of_up(c)),
    row("parallel_rays", InAreas, "the rays are parallel: they leave from the window along −w", PERSPECTIVE, |c, _| c.behaviour.rays = Rays::Parallel(distance(c))),
    row("parallel_rays", InAreas, "the rays are parallel: they leave along −w from a window as large as what the camera sees at the point that it looks at", PERSPECTIVE, |c, _| if let View::Lookat(point) = c.scene.camera.view { c.behaviour.rays = Rays::Parallel(point.distance(c.scene.camera.eye)) }),
    row("fisheye", InAreas, "the picture is that of a fish eye: the angle of a ray grows as the distance from the middle does", PERSPECTIVE, |c, _| c.behaviour.rays = Rays::Fisheye),
    row("sphere_unit_rays", InAreas, "spheres are hit by −b ± √(b² − c), which is for rays of length 1, and rays are not: their direction is not divided by its length", "a t² + b t + c = 0 has the roots (−b ± √(b² − 4 a c))/(2 a), a being the square of the ray's length", |c, _| set_sphere_fault(c, Spheres::UnitRays(distance(c)))),
    row("sphere_near_root", InAreas, "of a sphere's two roots only the lesser is tried: where the near plane or the eye is within it, nothing of it is seen", "if the lesser root does not count, the greater may", |c, _| set_sphere_fault(c, Spheres::LesserRoot)),
    row("sphere_far_root", InAreas, "of a sphere's two roots the greater is taken, so what is inside of it or cuts through it hides it", "of the roots that count, the lesser is the nearer", |c, _| set_sphere_fault(c, Spheres::GreaterRoot)),
    row("sphere_times_a", InAreas, "a sphere's roots are multiplied by a: (−b − q)/2*a is ((−b − q)/2)·a", "(−b − q)/(2*a) needs its brackets", |c, _| set_sphere_fault(c, Spheres::TimesA(distance(c)))),
    row("sphere_radius_root", InAreas, "the radius of spheres is not squared: each has its square root", "c = |eye − center|² − radius²", |c, _| for shape in shapes(c) { if let Shape::Sphere(sphere) = shape { sphere.radius = sphere.radius.sqrt() } }),
    row("eye_lookat_exchanged", InAreas, "eye and lookat are exchanged", "w = (eye − lookat)/|eye − lookat|", |c, _| if let View::Lookat(point) = &mut c.scene.camera.view { swap(point, &mut c.scene.camera.eye) }),
    row("eye_not_subtracted", InAreas, "lookat is taken for the view direction: the eye is not subtracted", "w = (eye − lookat)/|eye − lookat|", |c, _| if let View::Lookat(point) = c.scene.camera.view && point != DVec3::ZERO { c.scene.camera.view = View::Direction(point) }),
    row("near_far_distance", InAreas, "near and far are compared with distances from the eye, not with depths", CLIPPED, |c, _| c.behaviour.clips_distances = c.scene.camera.near > 0.0 || c.scene.camera.far.is_some()),
    // Adding zero turns coordinates of −0 into 0, so that messages do not contain `-0`.
    row("up_negated", InAreas, "up has the wrong sign, or u is w × up: the picture is turned by 180 degrees", UP, |c, _| c.scene.camera.up = -c.scene.camera.up + DVec3::ZERO),
    row("up_ignored", InAreas, "up is ignored: (0, 1, 0) is taken for it", UP, |c, _| c.scene.camera.up = DVec3::Y),
    row("up_ignored", InAreas, "z is taken for up", UP, |c, _| c.scene.camera.up = DVec3::Z),
    row("fov_of_width", InAreas, "the window's height is taken for its width", WINDOW, |c, _| exchange_sides(c)),
    row("fov_halved", InAreas, "half the field of view is taken for all of it", HALVES, |c, _| zoom(c, 2.0)),
    row("fov_doubled", InAreas, "the field of view is taken for half of it", HALVES, |c, _| zoom(c, 0.5)),
    row("looks_back", InAreas, "the camera looks the other way: w has the wrong sign", "w = −f/|f|, f being lookat − eye, and rays leave along −d w", |c, _| look_back(c)),
    row("looks_back", InAreas, "the camera looks the other way, mirrored: rays leave along d w", "w = −f/|f|, f being lookat − eye, and rays leave along x u + y v − d w", |c, _| { look_back(c); c.scene.camera.roll = -c.scene.camera.roll; c.layout.is_mirrored ^= true }),
    row("fov_unit", InAreas, "the field of view's degrees are taken for radians", "tan takes radians: 180 degrees are π", |c, _| if let Lens::Fov(angle) | Lens::HorizontalFov(angle) = &mut c.scene.camera.lens { *angle = twice_arctan(libm::tan(angle.in_degrees() / 2.0).abs()) }),
    row("near_ignored", InAreas, "the near plane is ignored", CLIPPED, |c, _| c.scene.camera.near = 0.0),
    row("far_ignored", InAreas, "the far plane is ignored", CLIPPED, |c, _| c.scene.camera.far = None),
    row("view_height_ignored", InAreas, "view_height is ignored: the window is 2 tall", WINDOW, |c, _| c.scene.camera.view_height = 2.0),
];

/// Rows of the table of mistakes that are about a single object.
#[rustfmt::skip]
pub const OBJECT_ROWS: &[MistakeRow] = &[
    row("object_missing", InAreas, "is missing", "ask every object of the scene for its hits", |c, object| c.is_drawn[object] = false),
    row("box_corner", InAreas, "is placed by its corner: its center is taken for its least corner", BOX, |c, object| stretch(c, object, [DVec3::splat(0.5); 2])),
    row("box_corner", InAreas, "is placed by its corner: its center is taken for its greatest corner", BOX, |c, object| stretch(c, object, [DVec3::splat(-0.5); 2])),
    row("box_base", InAreas, "is placed by its base: its center is taken for its bottom's", BOX, |c, object| stretch(c, object, [DVec3::new(0.0, 0.5, 0.0); 2])),
    row("box_doubled", InAreas, "is twice as large: its size counts on both sides of its center", BOX, |c, object| stretch(c, object, [DVec3::splat(-0.5), DVec3::splat(0.5)])),
    family!(faces "x and z", [2, 1, 0]),
    family!(faces "x and y", [1, 0, 2]),
    family!(faces "y and z", [0, 2, 1]),
    row("triangle_anchor", InAreas, "is placed by its first vertex: its centroid is taken for that", CENTROID, |c, object| anchor(c, object, |[left, ..]| left)),
    row("triangle_anchor", InAreas, "is placed by the middle of its base: its centroid is taken for that", CENTROID, |c, object| anchor(c, object, |[left, right, _]| left.midpoint(right))),
    row("triangle_normal", InAreas, "has its normal reversed", "its corners lie counter-clockwise as seen from the tip of its normal: seen from the other side, it is mirrored", reverse_normal),
    row("triangle_parallelogram", InAreas, "is a parallelogram: the test that its two coordinates add to at most 1 is missing", EDGES, |c, object| set_hit_fault(c, object, HitFault::Parallelogram)),
    row("triangle_edge", InAreas, "has no edge against its second vertex", EDGES, |c, object| set_hit_fault(c, object, HitFault::WithoutEdge(0))),
    row("triangle_edge", InAreas, "has no edge against its third vertex", EDGES, |c, object| set_hit_fault(c, object, HitFault::WithoutEdge(1))),
    row("triangle_edge", InAreas, "has no edge against its first vertex", EDGES, |c, object| set_hit_fault(c, object, HitFault::WithoutEdge(2))),
    row("box_axis", InAreas, "has no sides across x", SLABS, |c, object| set_hit_fault(c, object, HitFault::WithoutAxis(0))),
    row("box_axis", InAreas, "has no sides across y", SLABS, |c, object| set_hit_fault(c, object, HitFault::WithoutAxis(1))),
    row("box_axis", InAreas, "has no sides across z", SLABS, |c, object| set_hit_fault(c, object, HitFault::WithoutAxis(2))),
];
