//! Mistakes that students make, as changes of a correct program.

use glam::{DVec3, dvec3};
use image::{RgbImage, imageops};

use super::{
    scenes::{shift, turn},
    textbook::{
        Axes, Behind, Encoding, Object, Program, Roots, Shape, Squares, Visible, light, sharpened,
        with_stride,
    },
};

/// A mistake that the program of a student may have.
pub struct Mistake {
    /// Answers of `diff` that are accepted for the mistake, separated by bars. An answer is either
    /// the name of a mistake, or the target of a `--set` argument, such as `camera.roll`. After the
    /// name of a mistake, a part of its message may follow.
    pub name: &'static str,
    change: Change,
}

/// The change of a correct program, or of its picture, that makes the mistake.
enum Change {
    /// Changes the program. Does nothing if the scene lacks the object that the mistake is about.
    Program(fn(&mut Program)),
    /// Changes the bytes of each pixel after rendering.
    Pixels(fn([u8; 3]) -> [u8; 3]),
    /// Changes the whole picture after all of its pixels are converted to bytes.
    Picture(fn(&RgbImage) -> RgbImage),
}

impl Mistake {
    /// Returns the name that stands for the mistake in the title of a picture: the first of the
    /// accepted answers.
    pub fn title(&self) -> &'static str {
        self.name.split('|').next().unwrap_or_default()
    }

    /// Puts the mistake into a program.
    pub fn make(&self, program: &mut Program) {
        match self.change {
            Change::Program(change) => change(program),
            Change::Pixels(change) => program.change = change,
            Change::Picture(change) => program.afterwards = Some(change),
        }
    }
}

const fn row(name: &'static str, change: fn(&mut Program)) -> Mistake {
    let change = Change::Program(change);
    Mistake { name, change }
}

const fn pixels(name: &'static str, change: fn([u8; 3]) -> [u8; 3]) -> Mistake {
    let change = Change::Pixels(change);
    Mistake { name, change }
}

const fn picture(name: &'static str, change: fn(&RgbImage) -> RgbImage) -> Mistake {
    let change = Change::Picture(change);
    Mistake { name, change }
}

/// All mistakes with which the grading is tested, grouped by what they affect.
pub const GROUPS: [&[Mistake]; 5] = [
    OF_THE_PICTURE,
    OF_THE_CAMERA,
    OF_THE_BOARD,
    OF_THE_OBJECTS,
    OTHERS,
];

/// Mistakes of a student's program in the encoding, the exposure or the position of the whole
/// picture.
const OF_THE_PICTURE: &[Mistake] = &[
    picture("mirrored", imageops::flip_horizontal),
    picture("upside_down", imageops::flip_vertical),
    picture("turned_180|up_negated", imageops::rotate180),
    pixels("channels", |[r, g, b]| [b, g, r]),
    pixels("gray", |color| gray(color, [0.299, 0.587, 0.114])),
    row("not_encoded", |p| p.encoding = Encoding::None),
    row("encoded_twice", |p| p.encoding = Encoding::Twice),
    pixels("gamma_22", |color| color.map(|byte| power(byte, 2.2))),
    pixels("gamma_2", |color| color.map(|byte| power(byte, 2.0))),
    row("gamma_22_averaged", |p| p.encoding = Encoding::Power(2.2)),
    row("averaged_encoded", |p| p.averages_encoded = true),
    row("cut_off", |p| p.cuts_bytes = true),
    pixels("inverted", |color| color.map(|byte| 255 - byte)),
    pixels("not_decoded", |color| {
        color.map(|byte| (255.0 * (f64::from(byte) / 255.0).sqrt()).round() as u8)
    }),
    row("not_divided light is multiplied by about 2", |p| {
        p.gain = 2.0
    }),
    row("not_divided half", |p| p.gain = 0.5),
    row("half_pixel", |p| p.offset = 0.5),
];

/// Mistakes of a student's program in the camera: in its axes, its rays or its lens.
const OF_THE_CAMERA: &[Mistake] = &[
    row("aspect its window is 4:3", |p| p.aspect = 0.75),
    row("aspect twice as wide", |p| p.aspect = 2.0),
    row("roll_new_u", |p| p.axes = Axes::NewU),
    row("up_not_orthogonal", |p| p.axes = Axes::UpAsV),
    row("w_not_normalised", |p| p.axes = Axes::LongW),
    row("parallel_rays", |p| p.axes = Axes::Parallel),
    // If the eye is not subtracted, the picture may show nothing of the scene. The only possible
    // answer of `diff` is then `nothing_seen`.
    row("eye_not_subtracted|nothing_seen", |p| {
        p.axes = Axes::WithoutEye
    }),
    row("near_far_distance", |p| p.clips_distances = true),
    row("roll_sign|camera.roll", |p| p.roll = -p.roll),
    row("roll_unit|camera.roll", |p| {
        p.roll = p.roll.to_degrees().round()
    }),
    row("roll_ignored|camera.roll", |p| p.roll = 0.0),
    row("fov_of_width|camera.d|camera.fov", |p| p.is_wide = true),
    row("up_ignored|camera.up", |p| p.up = DVec3::Z),
    row("behind_seen", |p| p.behind = Behind::ByDistance),
    row("camera.d|camera.fov", |p| p.distance *= 0.8),
    row("camera.eye", |p| p.eye += dvec3(0.4, -0.3, 0.5)),
    row("camera.lookat", |p| p.lookat += dvec3(0.3, 0.2, -0.1)),
    // The following mistakes are numbers that are slightly wrong.
    row("roll has a wrong value|camera.roll", |p| {
        p.roll += 1_f64.to_radians()
    }),
    row("d has a wrong value|camera.d|camera.fov", |p| {
        p.distance += 0.05
    }),
    row("eye has a wrong value", |p| p.eye.y += 0.1),
    row("lookat has a wrong value", |p| p.lookat.z += 0.3),
];

/// Mistakes of a student's program in the position, the squares or the colours of the checkerboard.
const OF_THE_BOARD: &[Mistake] = &[
    row("board_swapped", |p| p.parity = 1),
    row("board_truncated", |p| p.squares = Squares::Truncated),
    row("board_rounded", |p| p.squares = Squares::Rounded),
    row("board_sum", |p| p.squares = Squares::Sum),
    row("board_moved", |p| p.squares = Squares::Moved),
    row("board_stripes", |p| p.squares = Squares::Stripes),
    row("board_sines", |p| p.squares = Squares::Sines),
    row("Floor.square", |p| board(p, |_, square, _| *square *= 2.0)),
    row("Floor.y", |p| board(p, |y, _, _| *y -= 0.3)),
    row("Floor.colors", |p| {
        board(p, |_, _, color| *color = [192, 192, 160])
    }),
];

/// Mistakes of a student's program in the sphere, the triangle or the box.
pub const OF_THE_OBJECTS: &[Mistake] = &[
    row("object_missing Ball", |p| {
        p.objects.retain(|object| object.name != "Ball")
    }),
    row("object_missing Sail", |p| {
        p.objects.retain(|object| object.name != "Sail")
    }),
    row("object_missing Crate", |p| {
        p.objects.retain(|object| object.name != "Crate")
    }),
    row("object_extra", |p| {
        let shape = Shape::Sphere(dvec3(0.6, 0.5, 2.0), 0.5);
        let color = [200, 30, 60];
        p.objects.push(Object {
            name: "",
            shape,
            color,
        });
    }),
    row("depth_ignored", |p| p.visible = Visible::Last),
    row("sphere_near_root", |p| p.roots = Roots::Lesser),
    row("triangle_anchor", |p| {
        if let Some(&mut Shape::Triangle([a, b, c])) = p.shape("Sail") {
            shift(p, "Sail", (b + c - 2.0 * a) / 3.0);
        }
    }),
    row("triangle_parallelogram Sail", |p| p.is_parallelogram = true),
    row("triangle_edge Sail", |p| p.misses_edge = true),
    row("box_axis x|box_axis y|box_axis z", |p| p.misses_axis = true),
    row("faces_exchanged across x and y", |p| exchange(p, [1, 0, 2])),
    row("faces_exchanged across x and z", |p| exchange(p, [2, 1, 0])),
    row("faces_exchanged across y and z", |p| exchange(p, [0, 2, 1])),
    row("box_corner|Crate.center", |p| stretch(p, [0.5, 0.5])),
    row("Ball.color", |p| color(p, "Ball", [128, 0, 0])),
    row("Sail.color", |p| color(p, "Sail", [0, 64, 255])),
    row("Crate.color", |p| color(p, "Crate", [255, 200, 40])),
    row("Ball.center", |p| shift(p, "Ball", dvec3(0.2, 0.3, -0.3))),
    row("Crate.center", |p| shift(p, "Crate", dvec3(-0.3, 0.1, 0.2))),
    row("Sail.centroid", |p| shift(p, "Sail", dvec3(-0.2, 0.3, 0.1))),
    row("Ball.radius", |p| {
        if let Some(Shape::Sphere(_, radius)) = p.shape("Ball") {
            *radius *= 1.2;
        }
    }),
    row("Crate.size", |p| {
        if let Some(Shape::Box(_, greatest)) = p.shape("Crate") {
            greatest.y += 0.4;
        }
    }),
    row("Sail.spin", |p| turn(p, |corner| -corner)),
    row("Sail.normal", |p| {
        turn(p, |DVec3 { x, y, z }| {
            dvec3(0.8 * x + 0.6 * z, y, 0.8 * z - 0.6 * x)
        })
    }),
];

/// Mistakes of a student's program that fit no other group. Some of them change only few scenes.
const OTHERS: &[Mistake] = &[
    picture("transposed", |picture| {
        imageops::flip_horizontal(&imageops::rotate90(picture))
    }),
    picture("turned_90 quarter, clockwise", imageops::rotate90),
    picture("turned_90 anticlockwise", imageops::rotate270),
    row("squeezed", |p| p.is_squeezed = true),
    pixels("channels red, blue, green", |[r, g, b]| [r, b, g]),
    pixels("channels green, red, blue", |[r, g, b]| [g, r, b]),
    pixels("channels green, blue, red", |[r, g, b]| [g, b, r]),
    pixels("channels blue, red, green", |[r, g, b]| [b, r, g]),
    pixels("channels the red channel", |[_, g, b]| [0, g, b]),
    pixels("channels the green channel", |[r, _, b]| [r, 0, b]),
    pixels("channels the blue channel", |[r, g, _]| [r, g, 0]),
    row("parallel_rays the point that it looks at", |p| {
        p.axes = Axes::ParallelFromLookat
    }),
    row("triangle_normal Sail", |p| {
        let normal = dvec3(0.3, 0.0, 1.0).normalize();
        let across = DVec3::Y.cross(normal);
        turn(p, |corner| corner - 2.0 * corner.dot(across) * across)
    }),
    pixels("gray the mean of their encoded values", |color| {
        gray(color, [1.0; 3])
    }),
    pixels("gray weighted as light", |color| {
        gray(color, [0.2126, 0.7152, 0.0722])
    }),
    row("half_pixel up and left", |p| p.offset = -0.5),
    row("half_pixel through the window's border", |p| {
        p.reaches_borders = true
    }),
    row("half_pixel upper left quarter", |p| {
        (p.offset, p.pixel) = (-0.25, 0.5)
    }),
    row("half_pixel a whole pixel too far down and right", |p| {
        p.offset = 1.0
    }),
    row("window_one_less", |p| {
        let height = f64::from(p.size[1]);
        p.distance *= (height - 1.0) / height;
    }),
    row("wider_pixel", |p| p.pixel = 2.0),
    row("samples_narrow", |p| p.pixel = 0.5),
    row("samples_shifted right", |p| p.offset = 0.16),
    row("not_divided light is multiplied by about 1.3", |p| {
        p.gain = 1.3
    }),
    row("not_divided sixteen", |p| p.gain = 16.0),
    pixels("bytes_scaled bytes are multiplied by about 0.8", |color| {
        scaled(color, 0.8)
    }),
    pixels("bytes_scaled bytes are multiplied by about 1.3", |color| {
        scaled(color, 1.3)
    }),
    picture("stride further right", |picture| with_stride(picture, -1)),
    picture("stride further left", |picture| with_stride(picture, 1)),
    row("shaded the ray", |p| {
        p.shade = |normal, ray| normal.dot(ray).abs()
    }),
    row("shaded (1, 1, 1)", |p| {
        p.shade = |normal, _| lit(normal, DVec3::ONE)
    }),
    row("shaded (0, 1, 0)", |p| {
        p.shade = |normal, _| lit(normal, DVec3::Y)
    }),
    row("sphere_far_root", |p| p.roots = Roots::Greater),
    row("sphere_times_a", |p| {
        (p.axes, p.roots) = (Axes::LongRays, Roots::TimesA)
    }),
    row("board_finite", |p| p.reach = 5.0),
    row("board_turned", |p| p.squares = Squares::Turned),
    row("board_upright", |p| p.is_upright = true),
    row("board_truncated the coordinate x", |p| {
        p.squares = Squares::TruncatedX
    }),
    row("board_stripes z alone", |p| p.squares = Squares::StripesZ),
    row("board_moved along z", |p| p.squares = Squares::MovedZ),
    pixels("gamma_18", |color| color.map(|byte| power(byte, 1.8))),
    pixels("decoded_twice", |color| color.map(decoded_twice)),
    picture("sharpened", sharpened),
    pixels("video_range", |color| {
        color.map(|byte| (16.0 + f64::from(byte) * 219.0 / 255.0).round() as u8)
    }),
    row("bytes_wrap", |p| {
        p.change = |color| color.map(|byte| if byte == 255 { 0 } else { byte })
    }),
    row("board_both", |p| p.squares = Squares::BothEven),
    row("roll_u_alone", |p| p.axes = Axes::RolledU),
    row("fisheye", |p| p.axes = Axes::Fisheye),
    row("sphere_unit_rays", |p| p.axes = Axes::LongRays),
    row("u_not_normalised|camera.d", |p| {
        let w = (p.eye - p.lookat).normalize();
        p.distance /= p.up.normalize().cross(w).length();
    }),
    row("sphere_radius_root", |p| {
        for object in &mut p.objects {
            if let Shape::Sphere(_, radius) = &mut object.shape {
                *radius = radius.sqrt();
            }
        }
    }),
    row("eye_lookat_exchanged", |p| {
        (p.eye, p.lookat) = (p.lookat, p.eye)
    }),
    // The field of view is 40°. The program takes its half, 20°, for 20 radians.
    row("fov_unit", |p| p.distance = 1.0 / libm::tan(20.0)),
    row("colors_exchanged", |p| {
        let colors = ["Ball", "Crate"].map(|name| p.object(name).map(|object| object.color));
        if let [Some(ball), Some(crate_)] = colors {
            color(p, "Ball", crate_);
            color(p, "Crate", ball);
        }
    }),
    row("Crate.max|max", |p| {
        if let Some(Shape::Box(_, greatest)) = p.shape("Crate") {
            greatest.x = 1.9;
        }
    }),
    row("up_ignored (0, 1, 0)", |p| p.up = DVec3::Y),
    row("up_negated|turned_180", |p| p.up = -p.up),
    row("fov_halved", |p| p.distance *= 2.0),
    row("fov_doubled", |p| p.distance *= 0.5),
    row("looks_back", |p| p.lookat = 2.0 * p.eye - p.lookat),
    row("near_ignored", |p| p.near = 0.0),
    row("far_ignored", |p| p.far = f64::INFINITY),
    row("view_height_ignored", |p| p.view_height = 2.0),
    row("behind_seen sky: hits", |p| p.behind = Behind::First),
    row("board_remainder sum", |p| p.squares = Squares::Remainder),
    row("board_remainder by their remainders", |p| {
        p.squares = Squares::Remainders
    }),
    row("depth_ignored first", |p| p.visible = Visible::First),
    row("depth_ignored farthest", |p| p.visible = Visible::Farthest),
    row("box_corner its greatest corner", |p| {
        stretch(p, [-0.5, -0.5])
    }),
    row("box_doubled Crate", |p| stretch(p, [-0.5, 0.5])),
    row("box_base Crate", |p| {
        shift(p, "Crate", dvec3(0.0, 0.75, 0.0))
    }),
];

/// Decodes an sRGB byte to light. Then encodes it with the exponent 1/`power` instead of the sRGB
/// curve.
fn power(byte: u8, power: f64) -> u8 {
    (255.0 * libm::pow(light(f64::from(byte) / 255.0), 1.0 / power)).round() as u8
}

fn decoded_twice(byte: u8) -> u8 {
    (255.0 * light(light(f64::from(byte) / 255.0))).round() as u8
}

/// Multiplies the bytes of a colour by the factor `by`.
fn scaled(color: [u8; 3], by: f64) -> [u8; 3] {
    color.map(|byte| (by * f64::from(byte)).round() as u8)
}

/// Returns the fraction of a distant lamp's light that a surface gets: the cosine of the angle
/// between its normal and the light's direction, or 0 if the lamp is behind the surface.
fn lit(normal: DVec3, light: DVec3) -> f64 {
    normal.dot(light.normalize()).max(0.0)
}

/// Returns a gray: the weighted mean of the encoded channels of a colour.
fn gray(color: [u8; 3], weights: [f64; 3]) -> [u8; 3] {
    let sum: f64 = weights.iter().sum();
    let parts = color.iter().zip(weights);
    let parts = parts.map(|(&byte, weight)| weight * f64::from(byte));
    [(parts.sum::<f64>() / sum).round() as u8; 3]
}

fn board(program: &mut Program, change: impl Fn(&mut f64, &mut f64, &mut [u8; 3])) {
    if let Some(Shape::Board(y, square, second)) = program.shape("Floor") {
        change(y, square, second);
    }
}

/// Moves the least and the greatest corner of the box, each by a multiple of the box's size.
fn stretch(program: &mut Program, by: [f64; 2]) {
    if let Some(Shape::Box(least, greatest)) = program.shape("Crate") {
        let size = *greatest - *least;
        (*least, *greatest) = (*least + by[0] * size, *greatest + by[1] * size);
    }
}

fn color(program: &mut Program, name: &str, color: [u8; 3]) {
    if let Some(object) = program.object(name) {
        object.color = color;
    }
}

fn exchange(program: &mut Program, order: [usize; 3]) {
    program.faces = program.faces.map(|faces| order.map(|axis| faces[axis]));
}
