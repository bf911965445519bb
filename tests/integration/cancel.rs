//! Tests of cancellation. Reading a scene ends soon after it is cancelled, even if the text is
//! long. The preparation of the tracer also ends soon, even if the scene has many objects.

use std::{
    fmt::Write,
    sync::{
        Arc, OnceLock,
        atomic::{AtomicBool, Ordering},
    },
    thread,
    time::{Duration, Instant},
};

use glam::dvec3;
use pinhole::{
    cancel::Cancelled,
    scene::{self, Shape},
    source::SourceId,
    syntax,
    tracer::World,
};

use crate::scenes::{read, sources};

const CAMERA: &str = "camera { eye (0, 0, 5)  lookat (0, 0, 0) }\n";

/// Returns the text of a scene with `count` spheres. Each sphere is written with about 55 bytes.
pub fn spheres(count: usize) -> String {
    let mut text = CAMERA.to_owned();
    for index in 0..count {
        let (x, y) = (index % 173, index / 173);
        let _ = writeln!(
            text,
            "sphere {{ center ({x}, {y}, -9.5)  radius 0.25  color olive }}"
        );
    }
    text
}

/// Asserts that `work` stops soon after it is cancelled from another thread. Cancels it after 1/16
/// of its usual time, and in a second run after 1/4. Each run must then end within half of the
/// usual time. Other work on the machine may delay a run, so one success in 50 tries is enough. A
/// pause before each further try lets that work end.
#[track_caller]
fn assert_stops_early<T>(what: &str, work: impl Fn(&AtomicBool) -> Result<T, Cancelled> + Sync) {
    for share in [16, 4] {
        let mut tries = (0..50).map(|failures| {
            thread::sleep(Duration::from_millis(2 * failures));
            let start = Instant::now();
            assert!(work(&AtomicBool::new(false)).is_ok(), "{what}");
            let whole = start.elapsed();
            let cancel = AtomicBool::new(false);
            let set = OnceLock::new();
            let is_given_up = thread::scope(|scope| {
                scope.spawn(|| {
                    thread::sleep(whole / share);
                    cancel.store(true, Ordering::Relaxed);
                    set.get_or_init(Instant::now);
                });
                work(&cancel).is_err()
            });
            is_given_up && set.wait().elapsed() < whole / 2
        });
        assert!(
            tries.any(|in_time| in_time),
            "{what}, given up after 1/{share} of it"
        );
    }
}

#[test]
fn reading_stops_soon_after_cancellation_in_every_mode() {
    // The texts are so long that reading one takes some tens of milliseconds, which is much longer
    // than the start of a thread.
    let good = spheres(20_000);
    let lets = (0..6_000).map(|index| format!("let a_{index} = 1 + 2 * {index}\n"));
    let lets: String = lets.collect();
    let ball = "sphere Ball { center (0, 0, 0) }";
    for (what, text, set) in [
        ("in parts", good.clone(), None),
        ("without braces", format!("{CAMERA}{lets}{ball}"), None),
        ("as a whole", format!("{good}sphere {{ radus 2 }}"), None),
        (
            "with many mistakes",
            spheres(1_000).replace("radius", "radus"),
            None,
        ),
        (
            "with an argument",
            format!("{good}{ball}"),
            Some("Ball.radius=2"),
        ),
    ] {
        let sources = sources(&text).with_sets(set);
        assert_stops_early(what, |cancel| scene::read_unless(&sources, cancel));
    }
}

#[test]
fn building_a_world_stops_soon_after_cancellation() {
    let mut scene = read(&spheres(1));
    let mut objects = vec![scene.objects[0].clone(); 200_000];
    for (index, object) in (0u32..).zip(&mut objects) {
        if let Shape::Sphere(sphere) = &mut object.shape {
            let [x, y] = [index % 447, index / 447].map(f64::from);
            sphere.center = dvec3(x - 223.0, y - 223.0, -400.0);
        }
    }
    scene.objects = Arc::new(objects);
    assert_stops_early("a world", |cancel| World::new_unless(&scene, cancel));
    let unwanted = World::new_unless(&scene, &AtomicBool::new(true));
    assert_eq!(unwanted.err(), Some(Cancelled));
}

#[test]
fn a_cancelled_reading_does_not_start_or_stops_at_the_next_part() {
    let sources = sources(&format!("// Spheres.\n{}", spheres(100)));
    for parts in [0, 1] {
        let cancel = AtomicBool::new(parts == 0);
        let mut handed = 0;
        let all = syntax::parse_in_parts(
            &sources.file,
            SourceId::File,
            1,
            &cancel,
            |it| it,
            |_| {
                handed += 1;
                cancel.store(true, Ordering::Relaxed);
                true
            },
        );
        assert_eq!((all, handed), (false, parts));
    }
    let cancel = AtomicBool::new(true);
    let parsed = syntax::parse_unless(&sources.file, SourceId::File, &cancel);
    assert_eq!(parsed, syntax::Parsed::default());
    let reading = scene::read_unless(&sources, &cancel);
    assert_eq!(reading.err(), Some(Cancelled));
}
