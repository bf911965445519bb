//! Tests of the error bounds in exact pictures. An error bound limits the distance of a computed
//! pixel from the pixel's true mean. Also tests limits of the memory and the time for a pixel.

use std::time::{Duration, Instant};

use glam::DVec3;
use pinhole::film;

use super::*;
use crate::{culling::spheres, program::Folder};

#[test]
fn bounds_stay_below_1e_9_and_certify_nearly_all_bytes() {
    for far in [Some(100.0), Some(1e3), None] {
        let mut scene = example("figure_9_9", 256, 256);
        scene.camera.far = far;
        let exact = exact(&scene);
        assert!(exact.bound() <= 1e-9, "far {far:?}: {:e}", exact.bound());
        let certified = film::certified(&exact.film, &exact.bounds);
        let share = certified as f64 / exact.bounds.len() as f64;
        assert!(share >= 0.99999, "{share}");
    }
}

/// Forty spheres intersect one another within one pixel, and most of their silhouettes are hidden.
/// The error bound of the pixel must still be at most 1e-9.
#[test]
fn a_pixel_of_40_piercing_spheres_is_known_within_1e_9() {
    let heap = spheres(&mut Random::new(7), 40, 20.0, [2.0, 22.0]);
    assert_known(&format!(
        "image {{ width 3 height 3 }} camera {{ eye (0, 0, 100) lookat (0, 0, 0) d 0.33 }}\n{heap}"
    ));
}

/// The horizons of parallel boards coincide, and so do the edges of neighbouring triangles in a
/// fan. A pixel that these lines cross must not be subdivided endlessly.
#[test]
fn coincident_lines_are_known_within_1e_9() {
    let view = "image { width 48 height 27 }
        camera { eye (3, 3.5, 8) lookat (0.2, 0.8, 0) d 2.75 roll 7deg }\n";
    let (mut boards, mut fan) = (view.to_owned(), view.to_owned());
    for index in 0..40 {
        let _ = writeln!(
            boards,
            "checkerboard {{ y -0.1 * {index} square 0.5 + 0.1 * {index} }}"
        );
        let (sin, cos) = libm::sincos(0.08 * f64::from(index));
        let _ = writeln!(
            fan,
            "triangle {{ v0 (0, 0, 0) v1 (0, 2, 0) v2 ({cos}, 1, {sin}) color rgb({index}, 90, 40) }}"
        );
    }
    assert_known(&boards);
    assert_known(&fan);
}

#[test]
fn ten_thousand_objects_are_known_within_1e_9() {
    let spheres = spheres(&mut Random::new(11), 10_000, 3.0, [0.005, 0.03]);
    assert_known(&format!(
        "image {{ width 96 height 64 }} camera {{ eye (2, 3, 6) lookat (0, 0, 0) roll 20deg }}
         checkerboard {{ y -1 }} box {{ center (1, 0, 0) size (1, 2, 1.5) }}\n{spheres}"
    ));
}

/// The silhouettes of two spheres differ by as little as 1e-15. The error bound of each pixel must
/// still be at most 1e-9, and each pixel must be the mean of its four quarters.
#[test]
fn nearly_coincident_outlines_are_known_and_add_up() {
    for gap in ["1e-6", "1e-8", "1e-10", "1e-12", "1e-14", "1e-15"] {
        for center in ["(0, 0.3, 0)", &format!("({gap}, 0.3, 0)")] {
            let text = format!(
                "image {{ width 24 height 16 }}
                 camera {{ eye (0, 1.5, 6) lookat (0, 0.5, 0) }}
                 sphere {{ center (0, 0.3, 0) radius 1 color red }}
                 sphere {{ center {center} radius 1 + {gap} color blue }}"
            );
            assert_known(&text);
            assert_adds_up(&read(&text));
        }
    }
}

/// Many boxes are seen within a small part of one pixel, because they are far away or the view is
/// wide. The program must subdivide only this part, not the whole pixel.
#[test]
fn distant_crowds_in_part_of_a_pixel_are_known_within_1e_9() {
    for (distance, count) in [(1e3, 40), (1e5, 40), (1e5, 100)] {
        let boxes = (0..count).map(|i| {
            let [row, column] = [i / 10, i % 10].map(f64::from);
            let (x, z) = (0.31 * distance + 1.5 * row, 1.5 * column - distance);
            let height = 1.0 + 0.1 * ((7.0 * row + 3.0 * column) % 5.0);
            let color = ["red", "lime", "blue"][(i % 3) as usize];
            format!("box {{ min ({x}, 0, {z}) max ({x} + 1, {height}, {z} + 1) color {color} }}\n")
        });
        let boxes: String = boxes.collect();
        assert_known(&format!(
            "image {{ width 6 height 4 background white }}
             camera {{ eye (0, 1.7, 0) direction (0.3, -0.01, -1) d 2 }}
             {boxes}"
        ));
    }
}

/// Returns the peak memory, in MiB, of the program while it renders the pixel `crop` of `scene`.
#[cfg(target_os = "linux")]
fn memory(scene: &str, crop: &str) -> u64 {
    let folder = Folder::with([("scene.scn", scene)]);
    let line = format!("render scene.scn --threads 1 --crop {crop}");
    let mut child = folder.command(&line).spawn().unwrap();
    let (path, mut most) = (format!("/proc/{}/status", child.id()), 0);
    while child.try_wait().unwrap().is_none() {
        let status = std::fs::read_to_string(&path).unwrap_or_default();
        let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let found = line.and_then(|line| line.trim().strip_suffix(" kB")?.parse().ok());
        most = most.max(found.unwrap_or(0));
        std::thread::sleep(Duration::from_millis(1));
    }
    assert!(child.wait().unwrap().success());
    most >> 10
}

/// Compares the peak memory for a pixel that is hard to compute with the peak memory for an easy
/// one. The difference must be at most 128 MiB.
///
/// In the first scene, nearly all objects are seen at one point of the hard pixel, so the program
/// subdivides the pixel very often. Without a limit, this took 20 GB. In the second scene, the hard
/// pixel shows 65 536 objects, and the easy pixel beside it shows none.
#[cfg(target_os = "linux")]
#[test]
fn a_pixel_takes_bounded_memory() {
    let open = "image { width 1 height 40 background olive }
        camera { eye (3, 2, 0) lookat (-2.9634416336477738, 1.5641245946478231, -4.2344985898528513) fov 179.999999deg }
        triangle { centroid (-0.750461877, 2.27379639, -6.67434178) normal (-5.1451145992126213, -3, -0.475)
          sides (1.37312, 0.585539, 1.32783) color teal }
        triangle { v0 (-1.72639095, 2.11492612, -5.76924793) v1 (-3.4982674, 3.50673188, -3.80347503)
          v2 (-5.80395387, 3.71750855, -6.6929346) color black }
        checkerboard { y -2.4 square 55444.382797137223 colors (white, orange) }
        checkerboard { y 0 square 1.82221 colors (red, teal) }
        box { center (-3.48494606, 2.35211205, -1.3395185) size (0.27574, 1.62986, 0.389944) color blue }
        sampler { method exact }";
    let heap = spheres(&mut Random::new(5), 1 << 16, 3.0, [0.005, 0.03]);
    let heap = format!(
        "image {{ width 3 height 1 }} camera {{ eye (0, 0, 100) lookat (0, 0, 0) d 0.1 }}
        sampler {{ method exact }}\n{heap}"
    );
    let trivial = "camera { eye (0, 1, 5) lookat (0, 0, 0) } sampler { method exact }
        sphere { center (0, 0, 0) }";
    for (scene, crop, beside, beside_crop) in [
        (open, "0,19,1,1", trivial, "0,0,1,1"),
        (&*heap, "1,0,1,1", &*heap, "0,0,1,1"),
    ] {
        let [most, beside] =
            [(scene, crop), (beside, beside_crop)].map(|(scene, crop)| memory(scene, crop));
        assert!(
            most <= beside + 128,
            "{most} MiB, and {beside} MiB beside it"
        );
    }
}

/// One pixel covers half of all directions, and the surfaces of two hundred objects meet at a few
/// points in it. Many of the objects' outlines can be distinguished only in the highest precision.
///
/// In an optimised build, a pixel takes at most a second. The test allows more time, because tests
/// are less optimised and run in parallel.
#[test]
fn a_pixel_takes_bounded_time() {
    for seed in 0..4 {
        let mut random = Random::new(seed);
        let mut text = "image { width 1 height 1 }
            camera { eye (-3.75, 2.5, -2.26) lookat (4, 3.3, -4.7) fov 179.9deg near 1 far 20 }
            sampler { method exact }\n"
            .to_owned();
        let mut point = || random.vector(4.5).round();
        let list = |DVec3 { x, y, z }: DVec3| format!("({x}, {y}, {z})");
        let mut points = || [0; 3].map(|_| point());
        for index in 0..200 {
            let [a, b, c] = points();
            let size = 0.1 + (a - b).length();
            let [p, q, r] = [a, b, c].map(list);
            let _ = match index % 4 {
                0 => writeln!(text, "sphere {{ center {p} radius {size} color red }}"),
                1 => writeln!(
                    text,
                    "box {{ center {p} size (0.3, {size}, 2) color teal }}"
                ),
                2 => writeln!(text, "checkerboard {{ y {} square {size} }}", a.y),
                _ if (b - a).cross(c - a).length() == 0.0 => Ok(()),
                _ => writeln!(text, "triangle {{ v0 {p} v1 {q} v2 {r} color blue }}"),
            };
        }
        let scene = read(&text);
        let start = Instant::now();
        exact(&scene);
        assert!(
            start.elapsed() < Duration::from_secs(4),
            "{seed}: {:?}",
            start.elapsed()
        );
    }
}

/// In each scene of `tests/exact`, the error bounds are at most 1e-9, and each pixel is the mean of
/// its four quarters. If a scene has a comment `// crop`, only the area that the comment gives is
/// tested.
#[test]
fn hard_scene_files_are_known_within_1e_9() {
    for path in scenes("tests/exact") {
        let text = std::fs::read_to_string(&path).unwrap();
        let scene = read(&text);
        let crop = text.lines().find_map(|line| line.strip_prefix("// crop "));
        let area = crop.map_or(whole(&scene), |crop| crop.parse().unwrap());
        let bound = assert_part_adds_up(&scene, area).bound();
        assert!(bound <= 1e-9, "{}: {bound:e}", path.display());
    }
}

/// Even if the error bound of a pixel is large, the interval of its mean ± the bound stays between
/// the darkest and the brightest colour that the pixel can show.
#[test]
fn uncertain_pixels_stay_within_the_range_of_their_colours() {
    let mut vague = 0;
    for (camera, objects, [least, greatest]) in [
        (
            "eye (0.31, 1.7, 2.2) direction (1, 0, -2)",
            "checkerboard { y 0 square 5e-324 colors (#202020, #606060) }",
            ["#000", "#606060"],
        ),
        (
            "eye (0.31, 1.7, 2.2) direction (0, -1, -1)",
            "checkerboard { y 0 square 1e-9 colors (#404040, #808080) }",
            ["#404040", "#808080"],
        ),
        (
            "eye (3, 2, 0) lookat (-2.96, 1.56, -4.23) fov 179.999999deg",
            "checkerboard { y -2.4 square 55444.38 colors (white, #505050) } checkerboard { square 1.82 colors (#303030, #a0a0a0) } sphere { center (-3, 2, -6) color #c0c0c0 }",
            ["#000", "white"],
        ),
    ] {
        let text = format!("image {{ width 5 height 40 }} camera {{ {camera} }} {objects}");
        let exact = exact(&read(&text));
        let [least, greatest] = [least, greatest].map(|color| {
            let scene = read(&format!("camera {{ eye (0, 1, 0) direction (1, 0, 0) }} sphere {{ center (9, 1, 0) color {color} }}"));
            scene.objects[0].shape.colors()[0].to_linear()[0]
        });
        let means = (0..40)
            .flat_map(|y| exact.film.row(y))
            .map(|pixel| pixel[0]);
        for (mean, &bound) in means.zip(&exact.bounds).filter(|(_, bound)| **bound > 1e-6) {
            vague += 1;
            let bound = f64::from(bound);
            let about = 1e-6 * bound;
            assert!(
                mean - bound >= least - about && mean + bound <= greatest + about,
                "{mean} ± {bound}: {text}"
            );
        }
    }
    assert!(vague > 20, "{vague} pixels");
}
