//! Triangles by their vertices: those that share an edge leave no gap, and all agree with the oracle.

use super::*;

/// The two halves of a square, beside the diagonal that crosses the middles of pixels.
fn halves(order: [usize; 3]) -> String {
    let vertex = ["(-1, -1, 0)", "(1, 1, 0)", "(-1, 1, 0)", "(1, -1, 0)"];
    let other = order.map(|at| if at == 2 { 3 } else { at });
    let triangle = |at: [usize; 3]| {
        let [a, b, c] = at.map(|at| vertex[at]);
        format!("triangle {{ v0 {a}  v1 {b}  v2 {c}  color white }}\n")
    };
    format!("{}{}", triangle([0, 1, 2]), triangle(other))
}

#[test]
fn two_halves_of_a_square_leave_no_gap() {
    let control = Control::default();
    for order in [[0, 1, 2], [1, 0, 2], [2, 1, 0]] {
        for eye in ["(0, 0, 2)", "(0.1, 0.2, -1.7)", "(1.2, 0.3, 0.9)"] {
            let scene = read(&format!(
                "image {{ width 40  height 40  background red }}\n\
                 camera {{ eye {eye}  lookat (0, 0, 0)  d 2  view_height 1 }}\n\
                 sampler {{ method regular  per_pixel 1 }}\n{}",
                halves(order)
            ));
            let world = World::new(&scene);
            let area = Area::whole(40, 40);
            let sampling = Sampling::new(&scene.sampler, 40, 40);
            let sampled = render(&world, &sampling, area, &control).unwrap();
            let exact = render_exact(&world, area, &control).unwrap();
            let mut seen = 0;
            for y in 0..40 {
                for x in 0..40 {
                    let [red, green, _] = sampled.pixel(x, y);
                    let [_, exactly, _] = exact.film.pixel(x, y);
                    // Half of a gap would show; outside of the square both are 0.
                    assert!(green == red || exactly < 1.0, "{x}, {y} from {eye}");
                    seen += u32::from(green == 1.0);
                    if eye == "(0, 0, 2)" {
                        assert_eq!([red, green], [1.0; 2], "{x}, {y}");
                        assert!((exactly - 1.0).abs() <= 1e-9, "{x}, {y}: {exactly}");
                    }
                }
            }
            assert!(seen > 400, "{seen} from {eye}");
        }
    }
}

#[test]
fn meshes_agree_with_the_oracle() {
    let mut random = Random::new(11);
    let mut found = 0;
    for round in 0..24 {
        let eye = random.vector(4.0);
        let mut camera = camera(eye, random.vector(1.0));
        camera.lens = Lens::HorizontalFov(Angle::from_degrees(random.within(20.0, 160.0)));
        // A fan around one vertex, of all sizes.
        let size = [1.0, 1e-3, 1e3][round % 3];
        let middle = random.vector(1.0);
        let rim: Vec<DVec3> = (0..5).map(|_| middle + random.vector(2.0) * size).collect();
        let fan = (0..5).map(|at| by_vertices([middle, rim[at], rim[(at + 1) % 5]]));
        let shapes: Vec<Shape> = fan.chain([floor()]).collect();
        found += agrees(&scene(camera, &shapes), 16);
    }
    assert!(found > 200, "{found}");
}

#[test]
fn a_triangle_in_a_face_ties_with_it() {
    // Of a box and of triangles in its face the first one is seen, whatever the vertices' differences round to.
    let face = [
        [
            dvec3(-1.0, -1.0, 1.0),
            dvec3(1.0, -1.0, 1.0),
            dvec3(-1.0, 1.0, 1.0),
        ],
        [
            dvec3(0.1, 0.3, 1.0),
            dvec3(0.7, 0.2, 1.0),
            dvec3(0.5, 0.9, 1.0),
        ],
    ];
    for vertices in face {
        let both = [by_vertices(vertices), cuboid(-DVec3::ONE, DVec3::ONE)];
        for shapes in [both.to_vec(), both.into_iter().rev().collect()] {
            let camera = camera(dvec3(0.3, 0.2, 5.0), DVec3::ZERO);
            assert_eq!(agrees(&scene(camera, &shapes), 20), 20);
        }
    }
}
