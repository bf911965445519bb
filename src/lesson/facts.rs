//! The numbers of a scene that the conditions of a lesson look at.

use std::cell::OnceCell;

use glam::DVec2;
use serde_json::Value;

use crate::{
    area::Area,
    film,
    inspect::{inspect, total_samples},
    probe::probe,
    render::{self, Control},
    sampling::Sampling,
    scene::{Count, Sampler, Scene},
    source::Source,
    tracer::World,
};

/// Width and height of the pictures whose difference is the error of a scene.
const SIZE: [u32; 2] = [160, 90];

/// Maximum number of samples with which the error is computed, about 580 per pixel, i.e. about a
/// second on one processor. With more, a page would wait too long for its answer.
const MOST_SAMPLES: u64 = 1 << 23;

/// Numbers of one scene, computed when a condition needs them.
#[derive(Debug)]
pub struct Facts<'s> {
    scene: &'s Scene,
    source: &'s Source,
    inspected: OnceCell<Value>,
    error: OnceCell<Option<f64>>,
}

impl<'s> Facts<'s> {
    /// Makes the facts of a scene without errors, which was read from `source`.
    pub fn new(scene: &'s Scene, source: &'s Source) -> Self {
        Self {
            scene,
            source,
            inspected: OnceCell::new(),
            error: OnceCell::new(),
        }
    }

    pub(super) fn inspected(&self) -> &Value {
        self.inspected
            .get_or_init(|| inspect(self.scene, self.source).to_json())
    }

    pub(super) fn probed(&self, point: DVec2) -> Value {
        probe(self.scene, point).to_json()
    }

    /// Returns the root mean square of the differences, in linear light, between a small picture of
    /// the scene with its own samples and the exact one. A sampler with a total keeps its number of
    /// samples per pixel. Returns `None` if there are too many samples.
    pub(super) fn error(&self) -> Option<f64> {
        *self.error.get_or_init(|| {
            let [width, height] = SIZE;
            let (small, mut scene) = (Area::whole(width, height), self.scene.clone());
            let share = small.pixels() as f64
                / Area::whole(scene.image.width, scene.image.height).pixels() as f64;
            (scene.image.width, scene.image.height) = (width, height);
            let count = match scene.sampler.count {
                Count::Total(total) => Count::Total((total as f64 * share).round().max(1.0) as u64),
                per_pixel => per_pixel,
            };
            if total_samples(count, &scene.image) > MOST_SAMPLES {
                return None;
            }
            let sampling = Sampling::new(
                &Sampler {
                    count,
                    ..scene.sampler
                },
                width,
                height,
            );
            let (world, control) = (World::new(&scene), Control::default());
            let sampled = render::render(&world, &sampling, small, &control).ok()?;
            let exact = render::render_exact(&world, small, &control).ok()?;
            film::rmse(&sampled, &exact.film).ok()
        })
    }
}

/// Returns the value at a JSON pointer. Unlike a pointer of RFC 6901, it may name an object of the
/// scene or an axis instead of its index in a list.
pub fn at<'v>(value: &'v Value, pointer: &str) -> Option<&'v Value> {
    pointer.split('/').skip(1).try_fold(value, |value, token| {
        let token = token.replace("~1", "/").replace("~0", "~");
        match value {
            Value::Object(fields) => fields.get(&token),
            Value::Array(list) => match token.parse::<usize>() {
                Ok(index) => list.get(index),
                Err(_) => {
                    let is_called = |it: &&Value| it["name"] == *token || it["axis"] == *token;
                    list.iter().find(is_called)
                }
            },
            _ => None,
        }
    })
}
