//! The example scene `figure_9_9`, which many tests and measurements use.

use pinhole::{
    scene::{self, Count, Method, Scene},
    source::{Source, Sources},
};

/// Returns the example scene `figure_9_9` with the given size, method and number of samples.
pub fn figure(width: u32, height: u32, method: Method, count: Count) -> Scene {
    let text = include_str!("../../examples/figure_9_9.scn");
    let sources = Sources::new(Source::from_text("figure_9_9.scn", text));
    let mut scene = scene::read(&sources).scene.expect("the example is right");
    (scene.image.width, scene.image.height) = (width, height);
    (scene.sampler.method, scene.sampler.count) = (method, count);
    scene
}
