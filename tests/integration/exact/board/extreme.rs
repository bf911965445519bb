//! Tests of exact pictures of a checkerboard in fields of view of nearly 180°, and of about a
//! millionth of a degree or less. The error bound of a pixel may then be large, but it must hold.

use super::*;

/// Views to test. Each row has five cells: the image, the camera, the sides of the board's squares
/// with which the view is tested, a further object, and an area. In this area, each pixel is
/// compared with the mean of its four quarters.
const VIEWS: &str = "
    -- Through lenses so long that a pixel next to the horizon begins millions of millions of squares away, where a rounding of a place is as much as the pixel is wide: alone, before a far plane, and next to an outline.
    width 6 height 4 -> eye (-3.8129918102387705, 0.29933186775843634, 5.521568092661159) direction (0.29550764467648694, 2.7116391188331324e-13, -0.9553403749123949) roll -0.6189217287574991deg d 3.227743535403821e12 -> 1 -> -> 1,1,1,3
    width 6 height 4 -> eye (7.1258770808249885, 12113.985539197016, 5.887328052989606) direction (0.7595975955607975, 4.869620325463549e-13, 0.6503933370032746) d 7.253439800872538e11 -> 1 -> -> 1,1,1,3
    width 6 height 4 -> eye (7.1258770808249885, 12113.985539197016, 5.887328052989606) direction (0.7595975955607975, 4.869620325463549e-13, 0.6503933370032746) d 7.253439800872538e11 far 9e16 -> 1 -> -> 1,1,1,3
    width 6 height 4 -> eye (-2.3318247885590555, 4.993210617544962, -3.0751067711600903) direction (-0.6618112240074384, -3.894257679306732e-11, 0.7496705301515968) d 1.7887427203438065e10 -> 67.48587078763939 -> -> 1,1,1,3
    width 6 height 4 -> eye (2.052067170281884, 0.06772658040854719, 0.6815823813346729) direction (0.7965839558772344, 3.0892811389595033e-16, -0.6045279160129632) d 7.772098242578281e12 -> 1 -> sphere { center (3.0521083313962305, 0.06772658040854758, -0.06483719297703988) radius 0.009966941806214522 color red } -> 1,1,1,3
    -- Where a sphere's outline meets the horizon in the widest views.
    width 6 height 6 -> eye (137257.85, 0.0847, 0.2587) direction (-1, 1e-6, -1) roll 1deg fov 179.98935deg -> 687411.158 -> sphere { center (137257.906, 0.0115, 0.288) radius 0.0909 color red } -> 0,0,6,6
    -- So wide that a pixel may see thousands of squares one behind another, a strip narrower than a square, all lines of the board in one point, or a billion rows; the smallest squares by so little that hardly any of what is computed is left to the mean colour.
    width 3 height 3 -> eye (0.3, 1.7, 8) direction (1, 0, -2) fov 179.9999999deg -> 6.3 0.013 1e-300 -> -> 0,1,3,1
    width 3 height 3 -> eye (0.3, 1.7, 8) direction (3, -1, -1) roll 20deg d 5e-324 -> 6.3 0.013 1e-300 -> -> 0,1,3,1
    width 6 height 4 -> eye (3.4158975, 0.0422285609, -1.3490885) direction (1, 0, -1) d 3.1924e-4 -> 6.3 0.013 1e-300 -> -> 0,3,2,1
    width 6 height 4 -> eye (3.67781, 0.4274597778298454, 4.73775) direction (-0.69039717130416323, -1.4522932231249908, 0.72343053975845528) roll 114.989deg d 7.4402685803163599e-10 far 67.84454308348414 -> 6.3 0.013 1e-300 -> -> 2,1,2,1
    width 4 height 2 -> eye (4.87134, 18.40485726953807, 4.46713) direction (1, 0.71976775250559488, 1) d 1.3171781702432199e-11 far 797.58757025253317 -> 6.3 0.013 1e-300 -> -> 1,0,1,2
    width 4 height 2 -> eye (0.225893, 0.26353742865178387, 4.97195) direction (5, 0.66067817927256389, 7) d 2.2123853269590468e-13 far 6254.97292550573 -> 6.3 0.013 1e-300 -> -> 1,0,1,2
    width 40 height 8 -> eye (0.3, 0.8, 0.2) direction (0.87, 0.64, 0.34) d 1e-20 -> 6.3 0.013 1e-300 -> -> 20,4,1,1
    width 3 height 2 -> eye (4.74, 15.74, -4.32) direction (1, -0.3, 1) roll 96.3deg d 1 view_height 1202818974.9410524 -> 6.3 0.013 1e-300 -> -> 0,1,3,1
    width 6 height 5 -> eye (0, 0.0288, 5) direction (-0.985, -0.328, -1) roll 118.4deg fov 179.99999999deg -> 6.3 0.013 1e-300 -> -> 1,0,1,1
    width 16 height 12 -> eye (0.3, 2, 0.1) direction (3, -0.5, -1) fov 179.5deg -> 6.3 0.013 1e-300 -> -> 7,6,2,1
    width 6 height 4 -> eye (1, 2, 3) direction (-0.3, 0, 1) d 2e-9 far 4e6 -> 6.3 0.013 1e-300 -> -> 0,2,1,1
    -- Such as take seconds.
    width 6 height 6 -> eye (-2737810.5, 0.5214, 9.76) direction (1, 1.7e-5, -1) fov 179.99996deg -> 359.93 -> sphere { center (-2737810.49, 0.6, 9.85) radius 0.0303 color red } -> 0,0,6,6
    width 6 height 4 -> eye (0, 157.4019629802236, 0) direction (-0.24392, 0, 0.14156) d 5.394e-6 far 11.7184 -> 6.3 0.013 1e-300 -> -> 0,2,6,1
    width 12000 height 2000 -> eye (0.3, 0.8, 0.2) direction (1, -0.4, 0.7) d 1e-8 -> 6.3 0.013 1e-300 -> -> 11996,999,3,3
    width 6000 height 2000 -> eye (0.3, 0.8, 0.2) direction (0.64, -0.1, -0.8) roll 20.762deg d 9e-14 -> 6.3 0.013 1e-300 -> -> 5628,2,3,3
";

sampled_and_exhaustive!(quarters_add_up_in_extreme_views);

fn quarters_add_up_in_extreme_views(effort: Effort) {
    for [image, camera, squares, object, area] in effort.first(17, rows(VIEWS)) {
        for square in squares.split(' ') {
            let scene = read(&format!(
                "image {{ {image} }} camera {{ {camera} }} checkerboard {{ y 0 square {square} }} {object}"
            ));
            assert_part_adds_up(&scene, area.parse().unwrap());
        }
    }
}

/// The fields of view are less than 2e-6 degrees. The horizon passes the picture's centre at a
/// distance of at most a quarter of the picture's height.
#[test]
#[ignore = "exhaustive"]
fn quarters_add_up_in_random_narrow_views() {
    let mut random = Random::new(29);
    for i in 0..24 {
        let mut number = |low: f64, high: f64| random.within(low, high);
        let d = libm::exp10(number(8.0, 15.0));
        let height = libm::exp10(number(-1.0, 4.0));
        let square = [1.0, height * libm::exp10(number(-2.0, 2.0))][i % 2];
        let [pitch, turn] = [number(-0.5, 0.5) / d, number(0.0, 6.3)];
        let roll = [0.0, number(-180.0, 180.0)][i / 2 % 2];
        let far = height * d * number(0.5, 5.0);
        let far = match i % 3 {
            0 => format!("far {far:e}"),
            _ => String::new(),
        };
        let (sin, cos) = (libm::sin(turn), libm::cos(turn));
        let text = format!(
            "image {{ width 6 height 4 }}
             camera {{ eye (0.3, {height}, 0.2) direction ({cos}, {pitch:e}, {sin}) roll {roll}deg d {d:e} {far} }}
             checkerboard {{ y 0 square {square} }}"
        );
        assert_part_adds_up(&read(&text), "2,1,1,2".parse().unwrap());
    }
}
