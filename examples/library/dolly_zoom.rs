//! Renders the frames of a dolly zoom: the camera moves away and zooms in, so that the ball keeps
//! its size while the room behind it changes. A table says how far each frame is from the exact
//! picture.
//!
//! `cargo run --example dolly_zoom -- FOLDER` writes `frame_0.png` and so on, and `errors.csv`.
#![allow(
    clippy::disallowed_methods,
    reason = "only Pinhole itself writes all files by one module"
)]

use std::{error::Error, fmt::Write, fs, path::Path};

use pinhole::{Scene, scene::Lens};

const TEXT: &str = "
image   { width 320  height 180  background lightskyblue }
camera  { eye (0, 1, 4)  lookat (0, 1, 0)  d 1 }
sampler { method sobol  per_pixel 16 }
sphere Ball { center (0, 1, 0)  color tomato }
box Column for side < 2, i < 8 {
  center (6 * side - 3, 2, -3 * i)  size (0.6, 4, 0.6)  color (wheat, tan)
}
checkerboard {}
";

/// Number of frames.
const FRAMES: u32 = 5;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).ok_or("which folder?")?;
    dolly_zoom(Path::new(&folder))
}

/// Writes the frames and the table into a folder.
///
/// # Errors
///
/// A file cannot be written.
pub fn dolly_zoom(folder: &Path) -> Result<(), Box<dyn Error>> {
    let scene = Scene::parse(TEXT)?;
    let mut table = "frame,distance,rmse\n".to_owned();
    for frame in 0..FRAMES {
        let distance = 4.0 + 3.0 * f64::from(frame);
        let mut data = scene.data().clone();
        data.camera.eye.z = distance;
        // The ball's height in the picture is proportional to d / distance.
        data.camera.lens = Lens::Distance(distance / 4.0);
        let scene = Scene::from_data(&data)?;
        let picture = scene.render()?;
        let error = picture.rmse(&scene.render_exact()?.picture)?;
        writeln!(table, "{frame},{distance},{error:.5}")?;
        picture.save(folder.join(format!("frame_{frame}.png")))?;
    }
    fs::write(folder.join("errors.csv"), table)?;
    Ok(())
}
