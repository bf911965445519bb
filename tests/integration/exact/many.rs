//! Many objects in one pixel.

use super::*;

/// Tilted triangles in rows, in one pixel: their planes cross each other all over it, but no two of them lie above each other.
fn side_by_side(random: &mut Random, rows: u32) -> String {
    let mut text = String::from(
        "image { width 1 height 1 background black }\ncamera { eye (0, 0, 20) lookat (0, 0, 0) d 20 }\n",
    );
    let step = 2.0 / f64::from(rows);
    for (x, y) in Area::whole(rows, rows).iter() {
        let [x, y] = [x, y].map(|at| (f64::from(at) + 0.5) * step - 1.0);
        let [tilt, turn] = [0.3, 0.3].map(|most| random.within(-most, most));
        let side = 0.6 * step;
        writeln!(
            text,
            "triangle {{ centroid ({x}, {y}, 0) normal ({tilt}, {turn}, 1) sides ({side}, {side}, {side}) }}"
        )
        .unwrap();
    }
    text
}

#[test]
fn objects_side_by_side_add_up() {
    let mut random = Random::new(71);
    for rows in [3, 5, 8] {
        let scene = read(&side_by_side(&mut random, rows));
        adds_up(&scene, &format!("{rows} rows of triangles"));
    }
}

/// Planks that pierce each other along lines that end where the one or the other does.
#[test]
fn objects_that_pierce_each_other_in_part_add_up() {
    let mut random = Random::new(72);
    for which in 0..20 {
        let mut text = String::from(
            "image { width 2 height 2 background black }\ncamera { eye (0.3, 0.2, 20) lookat (0, 0, 0) d 20 }\n",
        );
        for color in ["red", "lime", "blue", "gold", "cyan", "white"] {
            let mut number = |most: f64| random.within(-most, most);
            let center = [number(0.7), number(0.7), number(0.3)];
            let half = [0.3 + number(0.25), 0.3 + number(0.25), 0.3 + number(0.25)];
            let corner = |sign: f64| [0, 1, 2].map(|i| center[i] + sign * half[i]);
            let ([x0, y0, z0], [x1, y1, z1]) = (corner(-1.0), corner(1.0));
            writeln!(
                text,
                "box {{ min ({x0}, {y0}, {z0}) max ({x1}, {y1}, {z1}) color {color} }}"
            )
            .unwrap();
            let [x, y, z] = [number(0.6), number(0.6), number(0.2)];
            let [a, b] = [number(2.0), number(2.0)];
            writeln!(
                text,
                "triangle {{ centroid ({x}, {y}, {z}) normal ({a}, {b}, 1) sides (1.6, 1.5, 0.4) color {color} }}"
            )
            .unwrap();
        }
        adds_up(&read(&text), &format!("planks {which}"));
    }
}
