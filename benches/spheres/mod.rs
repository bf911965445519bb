//! Generates texts of scenes with many small spheres.

use std::fmt::Write;

use pinhole::sampling::CounterRng;
use rand::{Rng, RngExt, SeedableRng};

/// Arrangement of the blocks of a generated text in lines.
#[allow(dead_code, reason = "each benchmark has its own scene")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// Each field of a block is on a line of its own.
    Blocks,
    /// Each block is on a single line.
    Lines,
}

const COLORS: [&str; 8] = [
    "olive",
    "teal",
    "orange",
    "gray",
    "#fa0",
    "#3366cc",
    "rgb(255, 165, 0)",
    "steelblue",
];

/// Returns the text of a scene of `count` spheres as a person might write it, with some names,
/// comments, `let`s and expressions: about 80 bytes per sphere.
#[allow(dead_code, reason = "each benchmark has its own scene")]
pub fn spheres(count: usize, layout: Layout) -> String {
    let (open, between, close) = match layout {
        Layout::Blocks => ("\n  ", "\n  ", "\n}\n\n"),
        Layout::Lines => (" ", "  ", " }\n"),
    };
    let mut random = Random::new(1);
    let mut text = String::from(
        "// Many small spheres.\nlet unit = 0.05\nimage { width 1280  height 720 }\n\
         camera { eye (0, 40, 120)  lookat (0, 0, 0)  d 2.75 }\nsampler { method jittered  per_pixel 4 }\n\n",
    );
    for index in 0..count {
        let [x, y, z] = [(); 3].map(|()| random.between(-100.0, 100.0));
        let row = index / 1000;
        let mut line = String::new();
        if index % 1000 == 0 {
            let _ = writeln!(line, "let row_{row} = {y:.3}");
        }
        if index % 100 == 0 {
            let _ = writeln!(line, "// From {index} on.");
        }
        line.push_str("sphere");
        if index % 10 == 0 {
            let _ = write!(line, " Ball_{index}");
        }
        line.push_str(" {");
        if index % 20 == 0 {
            let _ = write!(line, " /* {} */", index / 20);
        }
        let _ = match index % 7 {
            0 => write!(
                line,
                "{open}center ({x:.3}, row_{row} + {:.3}, {z:.3})",
                y / 100.0
            ),
            _ => write!(line, "{open}center ({x:.3}, {y:.3}, {z:.3})"),
        };
        let _ = match index % 5 {
            0 => write!(
                line,
                "{between}radius {:.3} * unit",
                random.between(1.0, 9.0)
            ),
            _ => write!(line, "{between}radius {:.4}", random.between(0.05, 0.45)),
        };
        let color = COLORS[(random.next() % 8) as usize];
        let _ = write!(line, "{between}color {color}{close}");
        text.push_str(&line);
    }
    text
}

/// Returns the text of a scene of `count` spheres at distances from 5 to 50. The areas of their
/// images add up to one and a half times the picture. Since the spheres lie at random places, about
/// e^−1.5, i.e. more than a fifth, of the picture stays empty for any count.
#[allow(dead_code, reason = "each benchmark has its own scene")]
pub fn crowd(count: usize) -> String {
    const COVERED: f64 = 1.5;
    let (width, height, d) = (1280.0, 720.0, 2.75);
    let pitch = 2.0 / height / d;
    let radius = (COVERED * width * height / count as f64 / std::f64::consts::PI).sqrt();
    let mut random = Random::new(1);
    let mut text = format!(
        "// Spheres all over the picture.\nimage {{ width {width}  height {height} }}\n\
         camera {{ eye (0, 0, 0)  direction (0, 0, -1)  d {d} }}\nsampler {{ method jittered  per_pixel 4 }}\n\n",
    );
    for _ in 0..count {
        let depth = 5.0 * libm::exp10(random.between(0.0, 1.0));
        let x = random.between(-0.52, 0.52) * width * pitch * depth;
        let y = random.between(-0.52, 0.52) * height * pitch * depth;
        let radius = random.between(0.6, 1.4) * radius * pitch * depth;
        let color = COLORS[(random.next() % 8) as usize];
        let _ = writeln!(
            text,
            "sphere {{ center ({x:.5}, {y:.5}, {:.5})  radius {radius:.6}  color {color} }}",
            -depth
        );
    }
    text
}

/// Returns the text of a scene whose `count` spheres fill a cube. The camera sees the whole cube.
/// The cross sections of the spheres add up to one and a half times the area of a face of the cube.
#[allow(dead_code, reason = "each benchmark has its own scene")]
pub fn cube(count: usize) -> String {
    const COVERED: f64 = 1.5;
    const SIDE: f64 = 16.0;
    let radius = SIDE * (COVERED / count as f64 / std::f64::consts::PI).sqrt();
    let mut random = Random::new(1);
    let mut text = String::from(
        "// Spheres in a cube.\nimage { width 1280  height 720 }\n\
         camera { eye (0, 0, 0)  direction (0, 0, -1)  d 2.75 }\nsampler { method jittered  per_pixel 4 }\n\n",
    );
    for _ in 0..count {
        let [x, y, z] = [(); 3].map(|()| random.between(-SIDE / 2.0, SIDE / 2.0));
        let radius = random.between(0.6, 1.4) * radius;
        let color = COLORS[(random.next() % 8) as usize];
        let _ = writeln!(
            text,
            "sphere {{ center ({x:.5}, {y:.5}, {:.5})  radius {radius:.6}  color {color} }}",
            z - 30.0
        );
    }
    text
}

/// Generator of random numbers that are equal in each run and on all systems.
pub struct Random(CounterRng);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(CounterRng::seed_from_u64(seed))
    }

    pub fn next(&mut self) -> u64 {
        self.0.next_u64()
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.random::<f64>()
    }
}
