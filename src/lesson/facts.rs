//! Computes the numbers of a scene that the conditions of a lesson check.

use std::cell::OnceCell;

use glam::DVec2;
use serde_json::Value;

use crate::{
    area::Area,
    exact::Integrator,
    film::{self, Film},
    inspect::{inspect, total_samples},
    probe::probe,
    render::{self, Control},
    sampling::Sampling,
    scene::{Count, Method, Sampler, Scene},
    source::Source,
    suggest,
    tracer::World,
};

/// Width and height, in pixels, of the two pictures whose difference is the error of a scene. The
/// pictures are small so that a page need not wait long for the error.
const SIZE: [u32; 2] = [160, 90];

/// Maximum number of samples with which the error of a scene is computed: about 580 for each pixel
/// of the small picture that is rendered for it, i.e. about a second on one processor. With more, a
/// page would wait too long for its answer.
const MOST_SAMPLES: u64 = 1 << 23;

/// Maximum work on the exact picture with which the error of a scene is computed, in units of about
/// 50 ns, i.e. about a second on one processor. With more, a page would wait too long for its
/// answer.
const MOST_WORK: u64 = 20_000_000;

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

    /// Returns the root mean square difference, in linear light, between two small pictures of the
    /// scene: one is rendered with the scene's own sampler, and the other is exact. If the scene
    /// gives the total number of samples, this number is reduced in proportion to the number of
    /// pixels. The error of a scene that is rendered exactly is 0. Returns `None` if there are more
    /// than [`MOST_SAMPLES`] samples, or if the exact picture needs more than [`MOST_WORK`].
    pub(super) fn error(&self) -> Option<f64> {
        *self.error.get_or_init(|| {
            if self.scene.sampler.method == Method::Exact {
                return Some(0.0);
            }
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
            let integrator = Integrator::new(&world).with_work_limit(MOST_WORK);
            let pixels = integrator.pixels(small, control.cancel)?;
            let mut exact = Film::new(width, height).ok()?;
            exact.put(small, &pixels.iter().map(|it| it.mean).collect::<Vec<_>>());
            let sampled = render::render(&world, &sampling, small, &control).ok()?;
            film::rmse(&sampled, &exact).ok()
        })
    }
}

/// Returns the value at a JSON pointer, or `None` if there is none. Unlike a pointer of RFC 6901,
/// it may name an object of the scene or an axis instead of its index in a list.
pub fn at<'v>(value: &'v Value, pointer: &str) -> Option<&'v Value> {
    tokens(pointer).try_fold(value, |value, token| child(value, &token))
}

/// Finds the first token of a pointer that leads to no value. Returns this token and a similar name
/// that exists. Returns `None` if every token leads to a value, or if no existing name is similar.
pub fn misspelt(mut value: &Value, pointer: &str) -> Option<(String, String)> {
    for token in tokens(pointer) {
        let Some(child) = child(value, &token) else {
            let names: Vec<&str> = match value {
                Value::Object(fields) => fields.keys().map(String::as_str).collect(),
                Value::Array(list) => list.iter().filter_map(|it| it["name"].as_str()).collect(),
                _ => Vec::new(),
            };
            let near = suggest::nearest(&token, names)?.to_owned();
            return Some((token, near));
        };
        value = child;
    }
    None
}

fn tokens(pointer: &str) -> impl Iterator<Item = String> {
    let tokens = pointer.split('/').skip(1);
    tokens.map(|token| token.replace("~1", "/").replace("~0", "~"))
}

fn child<'v>(value: &'v Value, token: &str) -> Option<&'v Value> {
    match value {
        Value::Object(fields) => fields.get(token),
        Value::Array(list) => match token.parse::<usize>() {
            Ok(index) => list.get(index),
            Err(_) => {
                let is_called = |it: &&Value| it["name"] == *token || it["axis"] == *token;
                list.iter().find(is_called)
            }
        },
        _ => None,
    }
}
