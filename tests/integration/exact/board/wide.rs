//! The board in views of nearly 180 degrees: the bound is honest there, however large it is.

use super::{super::adds_up, *};

/// Boards in views so wide that a pixel may see thousands of squares one behind another, a strip narrower than a square, all lines of the board in one
/// point, or a billion rows.
const VIEWS: &str = "
    width 3 height 3 -> eye (0.3, 1.7, 8) direction (1, 0, -2) fov 179.9999999deg -> 0,1,3,1
    width 3 height 3 -> eye (0.3, 1.7, 8) direction (3, -1, -1) roll 20deg d 5e-324 -> 0,1,3,1
    width 6 height 4 -> eye (0, 157.4019629802236, 0) direction (-0.24392, 0, 0.14156) d 5.394e-6 far 11.7184 -> 0,2,6,1
    width 6 height 4 -> eye (3.4158975, 0.0422285609, -1.3490885) direction (1, 0, -1) d 3.1924e-4 -> 0,3,2,1
    width 12000 height 2000 -> eye (0.3, 0.8, 0.2) direction (1, -0.4, 0.7) d 1e-8 -> 11996,999,3,3
    width 6000 height 2000 -> eye (0.3, 0.8, 0.2) direction (0.64, -0.1, -0.8) roll 20.762deg d 9e-14 -> 5628,2,3,3
    width 6 height 4 -> eye (3.67781, 0.4274597778298454, 4.73775) direction (-0.69039717130416323, -1.4522932231249908, 0.72343053975845528) roll 114.989deg d 7.4402685803163599e-10 far 67.84454308348414 -> 2,1,2,1
    width 4 height 2 -> eye (4.87134, 18.40485726953807, 4.46713) direction (1, 0.71976775250559488, 1) d 1.3171781702432199e-11 far 797.58757025253317 -> 1,0,1,2
    width 4 height 2 -> eye (0.225893, 0.26353742865178387, 4.97195) direction (5, 0.66067817927256389, 7) d 2.2123853269590468e-13 far 6254.97292550573 -> 1,0,1,2
    width 40 height 8 -> eye (0.3, 0.8, 0.2) direction (0.87, 0.64, 0.34) d 1e-20 -> 20,4,1,1
    width 3 height 2 -> eye (4.74, 15.74, -4.32) direction (1, -0.3, 1) roll 96.3deg d 1 view_height 1202818974.9410524 -> 0,1,3,1
    width 6 height 5 -> eye (0, 0.0288, 5) direction (-0.985, -0.328, -1) roll 118.4deg fov 179.99999999deg -> 1,0,1,1
    width 16 height 12 -> eye (0.3, 2, 0.1) direction (3, -0.5, -1) fov 179.5deg -> 7,6,2,1
    width 6 height 4 -> eye (1, 2, 3) direction (-0.3, 0, 1) d 2e-9 far 4e6 -> 0,2,1,1
";

sampled_and_exhaustive!(four_quarters_are_the_pixel_of_the_widest_views);

fn four_quarters_are_the_pixel_of_the_widest_views(effort: Effort) {
    for [image, camera, area] in effort.of(rows(VIEWS)) {
        // The smallest by so little that hardly any of what is computed is left to the mean colour.
        for square in ["6.3", "0.013", "1e-300"] {
            let scene = read(&format!(
                "image {{ {image} }} camera {{ {camera} }}
                 checkerboard {{ y 0 square {square} }}"
            ));
            part_adds_up(&scene, area.parse().unwrap());
        }
    }
}

sampled_and_exhaustive!(outlines_at_a_wide_horizon);

/// Where a sphere's outline meets the horizon in the widest views.
fn outlines_at_a_wide_horizon(effort: Effort) {
    for [camera, square, sphere] in effort.of(rows("
        eye (137257.85, 0.0847, 0.2587) direction (-1, 1e-6, -1) roll 1deg fov 179.98935deg -> 687411.158 -> center (137257.906, 0.0115, 0.288) radius 0.0909
        eye (-2737810.5, 0.5214, 9.76) direction (1, 1.7e-5, -1) fov 179.99996deg -> 359.93 -> center (-2737810.49, 0.6, 9.85) radius 0.0303
    ")) {
        let scene = read(&format!(
            "image {{ width 6 height 6 }}
             camera {{ {camera} }}
             checkerboard {{ y 0 square {square} }}
             sphere {{ {sphere} color red }}"
        ));
        adds_up(&scene);
    }
}
