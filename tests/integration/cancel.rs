//! What nobody wants any more is given up: reading a long text, in each way that there is to read
//! one, and preparing many objects.

use std::{
    fmt::Write,
    sync::{
        Arc, OnceLock,
        atomic::{AtomicBool, Ordering},
    },
    thread,
    time::Instant,
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

/// A text of many spheres, 55 bytes each.
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

/// Does something to the end, and has it given up at two early moments by another thread: what is
/// left then takes at least three quarters of the time, and it has to end long before that is done.
/// Other work on the machine may delay either, so one of five tries is enough.
#[track_caller]
fn check<T>(what: &str, work: impl Fn(&AtomicBool) -> Result<T, Cancelled> + Sync) {
    for share in [16, 4] {
        let mut tries = (0..5).map(|_| {
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
fn a_reading_is_given_up_whichever_way_it_goes() {
    let good = spheres(1_000);
    let lets = (0..1_500).map(|index| format!("let a_{index} = 1 + 2 * {index}\n"));
    let lets: String = lets.collect();
    let ball = "sphere Ball { center (0, 0, 0) }";
    for (what, text, set) in [
        ("in parts", good.clone(), None),
        ("without braces", format!("{CAMERA}{lets}{ball}"), None),
        ("as a whole", format!("{good}sphere {{ radus 2 }}"), None),
        ("with many mistakes", good.replace("radius", "radus"), None),
        (
            "with an argument",
            format!("{good}{ball}"),
            Some("Ball.radius=2"),
        ),
    ] {
        let sources = sources(&text).with_sets(set);
        check(what, |cancel| scene::read_unless(&sources, cancel));
    }
}

#[test]
fn the_preparation_of_objects_is_given_up() {
    let mut scene = read(&spheres(1));
    let mut objects = vec![scene.objects[0].clone(); 200_000];
    for (index, object) in (0u32..).zip(&mut objects) {
        if let Shape::Sphere(sphere) = &mut object.shape {
            let [x, y] = [index % 447, index / 447].map(f64::from);
            sphere.center = dvec3(x - 223.0, y - 223.0, -400.0);
        }
    }
    scene.objects = Arc::new(objects);
    check("a world", |cancel| World::new_unless(&scene, cancel));
    let unwanted = World::new_unless(&scene, &AtomicBool::new(true));
    assert_eq!(unwanted.err(), Some(Cancelled));
}

#[test]
fn what_is_unwanted_is_not_begun_or_ends_there() {
    let sources = sources(&format!("// Spheres.\n{}", spheres(100)));
    for parts in [0, 1] {
        let cancel = AtomicBool::new(parts == 0);
        let mut handed = 0;
        let all = syntax::parse_in_parts(&sources.file, SourceId::File, 1, &cancel, |_| {
            handed += 1;
            cancel.store(true, Ordering::Relaxed);
            true
        });
        assert_eq!((all, handed), (false, parts));
    }
    let cancel = AtomicBool::new(true);
    let parsed = syntax::parse_unless(&sources.file, SourceId::File, &cancel);
    assert_eq!(parsed, syntax::Parsed::default());
    let reading = scene::read_unless(&sources, &cancel);
    assert_eq!(reading.err(), Some(Cancelled));
}
