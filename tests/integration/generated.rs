//! Generates scenes of random numbers, for tests of properties that hold for every scene.

use std::iter;

use pinhole::{
    scene::{self, Scene},
    schema::BLOCKS,
};

use crate::{random::Random, scenes::sources};

/// Kind of the random numbers in a generated scene.
#[derive(Clone, Copy, PartialEq)]
pub enum Numbers {
    /// Multiples of a unit. With the unit 1/2, exact coincidences are frequent: eyes lie on
    /// surfaces; rays lie in planes and pass through corners and along edges; faces lie in common
    /// planes, or at the near and far depths.
    MultiplesOf(f64),
    /// Random real numbers. Some are rounded to integers or to multiples of 1/8, so that
    /// coincidences occur. The value is the percentage of the numbers that may have any magnitude.
    Wild(u64),
}

/// Generates an endless sequence of valid scenes with up to eleven overlapping objects. Each
/// element is a text and the scene read from it.
pub fn generated(
    numbers: Numbers,
    size: [u32; 2],
    seed: u64,
) -> impl Iterator<Item = (String, Scene)> {
    let mut generator = Generator {
        random: Random::new(seed),
        numbers,
        shared: [1.0; 3],
    };
    let texts = iter::repeat_with(move || generator.scene(size));
    // Texts with mistakes are skipped, for example triangles with impossible sides or directions of
    // length 0.
    texts.filter_map(|text| Some((text.clone(), scene::read(&sources(&text)).scene?)))
}

struct Generator {
    random: Random,
    numbers: Numbers,
    /// Numbers that several objects of a scene use, so that, for example, a vertex lies in the
    /// plane of a face.
    shared: [f64; 3],
}

impl Generator {
    /// Returns a random number of the kind `self.numbers`. Its absolute value is at most `size`,
    /// except for those numbers of [`Numbers::Wild`] that may have any magnitude.
    fn number(&mut self, size: f64) -> f64 {
        let ordinary = self.random.within(-size, size);
        let wild = match self.numbers {
            Numbers::MultiplesOf(unit) => return (ordinary / unit).round() * unit,
            Numbers::Wild(share) => (self.random.below(100) as u64) < share,
        };
        let sign = ordinary.signum();
        match self.random.below(10) {
            0 if wild => sign * 5e-324,
            1 if wild => sign * f64::MIN_POSITIVE,
            2 if wild => sign * f64::MAX,
            3 if wild => sign * 0.0,
            4 if wild => sign * self.random.one_of(&self.shared).next_up(),
            5 if wild => sign * self.random.one_of(&self.shared),
            6 | 7 if wild => sign * libm::exp10(self.random.within(-20.0, 20.0)),
            _ if wild => sign * libm::exp10(self.random.within(-323.0, 308.0)),
            0 | 1 => ordinary.round(),
            2 | 3 => (8.0 * ordinary).round() / 8.0,
            _ => ordinary,
        }
    }

    /// Returns a positive number for a length, since the language does not allow a length of 0.
    fn length(&mut self, size: f64) -> f64 {
        match self.number(size).abs() {
            0.0 => size,
            length => length,
        }
    }

    fn vector(&mut self, size: f64) -> String {
        let [x, y, z] = [(); 3].map(|()| self.number(size));
        format!("({x:?}, {y:?}, {z:?})")
    }

    fn color(&mut self) -> &'static str {
        self.random.one_of::<&str>(&[
            "black", "white", "red", "olive", "#012345", "gold", "cyan", "lime",
        ])
    }

    fn scene(&mut self, [width, height]: [u32; 2]) -> String {
        self.shared = [(); 3].map(|()| self.number(2.0));
        let (background, eye) = (self.color(), self.vector(6.0));
        let view = *self
            .random
            .one_of(&["direction", "lookat", "lookat", "lookat", "lookat"]);
        let mut camera = format!("eye {eye} {view} {}", self.vector(1.0));
        if self.random.below(3) == 0 {
            camera += &format!(" up {}", self.vector(1.0));
        }
        if self.random.below(3) == 0 {
            camera += &format!(" roll {:?}deg", 90.0 * self.number(2.0));
        }
        camera += &match self.random.below(5) {
            0 => format!(" d {:?}", self.length(2.0)),
            1 | 2 => format!(" fov {:?}deg", 70.0 * self.length(2.0)),
            3 => format!(" hfov {:?}deg", 80.0 * self.length(2.0)),
            _ => " view_height 4".to_owned(),
        };
        for (clip, size) in [("near", 3.0), ("far", 12.0)] {
            if self.random.below(5) == 0 {
                camera += &format!(" {clip} {:?}", self.length(size));
            }
        }
        let objects: String = (0..self.random.below(12)).map(|_| self.object()).collect();
        format!(
            "image {{ width {width} height {height} background {background} }} camera {{ {camera} }}\n{objects}"
        )
    }

    fn object(&mut self) -> String {
        let [color, other] = [(); 2].map(|()| self.color());
        let center = self.vector(2.0);
        let shape = match self.random.below(8) {
            0 | 1 => format!("sphere {{ center {center} radius {:?}", self.length(1.25)),
            2 => format!(
                "triangle {{ v0 {center} v1 {} v2 {}",
                self.vector(2.0),
                self.vector(2.0)
            ),
            3 | 4 => {
                let [a, b] = [(); 2].map(|()| self.length(2.5));
                // The first two kinds of triangles have no area, because one side is as long as the
                // other two together. This is the limit of what is allowed. The last kind is
                // isosceles with the height 2 above the side 3, so its vertices can have rational
                // coordinates.
                let sides = match self.random.below(4) {
                    0 => [a, b, a + b],
                    1 => [a, b, (a - b).abs()],
                    2 => [a, b, a.max(b)],
                    _ => [2.5, 2.5, 3.0],
                };
                let (normal, spin) = (self.vector(1.0), 90.0 * self.number(2.0));
                let [a, b, c] = sides;
                format!(
                    "triangle {{ centroid {center} normal {normal} sides ({a:?}, {b:?}, {c:?}) spin {spin:?}deg"
                )
            }
            5 | 6 => {
                let [x, y, z] = [(); 3].map(|()| self.length(2.0));
                format!("box {{ center {center} size ({x:?}, {y:?}, {z:?})")
            }
            _ => {
                let (y, square) = (self.number(2.0), self.length(1.5));
                return format!(
                    "checkerboard {{ y {y:?} square {square:?} colors ({color}, {other}) }}\n"
                );
            }
        };
        format!("{shape} color {color} }}\n")
    }
}

#[test]
fn every_kind_of_object_is_generated() {
    let scenes = generated(Numbers::Wild(0), [8, 8], 1).take(64);
    let objects: Vec<_> = scenes
        .flat_map(|(_, scene)| scene.objects.to_vec())
        .collect();
    for row in BLOCKS.iter().filter(|row| row.is_object) {
        let is_of_kind = |object: &scene::Object| object.shape.kind() == row.name;
        assert!(objects.iter().any(is_of_kind), "{}", row.name);
    }
}
