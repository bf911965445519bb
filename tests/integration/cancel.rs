//! What nobody wants any more is given up: reading a long text, in each way that there is to read one, and preparing many objects.

use std::{
    fmt::Write,
    sync::{
        Arc, OnceLock,
        atomic::{AtomicBool, Ordering},
    },
    thread,
    time::Instant,
};

use pinhole::{
    area::Area,
    cancel::Cancelled,
    render::{Control, render_exact},
    scene,
    source::{Source, SourceId, Sources},
    syntax,
    tracer::World,
};

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

fn sources(text: &str) -> Sources {
    Sources::new(Source::from_text("long.scn", text))
}

/// Does something to the end, and has it given up at two early moments by another thread: what is left then takes at least three quarters of
/// the time, and it has to end long before that is done. Other work on the machine may delay either, so one of five tries is enough.
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
fn an_exact_pixel_is_given_up_while_it_is_cut() {
    // All outlines lie within a millionth of a pixel, so that cutting it does not tell them apart.
    let mut text =
        "image { width 2 height 2 } camera { eye (0, 2, 0) direction (0, 0, -1) d 1.5 }\n"
            .to_owned();
    for index in 0..24 {
        let radius = 2.0 + 1e-7 * f64::from(index);
        let _ = writeln!(text, "sphere {{ center (0, 2, -5) radius {radius} }}");
    }
    let scene = scene::read(&sources(&text)).scene.unwrap();
    let world = World::new(&scene);
    check("an exact picture", |cancel| {
        let control = Control {
            threads: None,
            progress: &|_| {},
            cancel,
        };
        render_exact(&world, Area::whole(2, 2), &control).map_err(|_| Cancelled)
    });
}

#[test]
fn a_reading_is_given_up_whichever_way_it_goes() {
    let good = spheres(1_000);
    let mut lets = CAMERA.to_owned();
    for index in 0..1_500 {
        let _ = writeln!(lets, "let a_{index} = 1 + 2 * {index}");
    }
    let texts = [
        ("in parts", good.clone(), ""),
        (
            "without braces",
            format!("{lets}sphere {{ center (0, 0, 0) }}"),
            "",
        ),
        ("as a whole", format!("{good}sphere {{ radus 2 }}"), ""),
        ("with many mistakes", good.replace("radius", "radus"), ""),
        (
            "with an argument",
            format!("{good}sphere Ball {{ center (0, 0, 0) }}"),
            "Ball.radius=2",
        ),
    ];
    for (what, text, set) in texts {
        let sets = Some(set).filter(|set| !set.is_empty());
        let sources = sources(&text).with_sets(sets);
        check(what, |cancel| scene::read_unless(&sources, cancel));
    }
}

#[test]
fn the_preparation_of_objects_is_given_up() {
    let mut scene = scene::read(&sources(&spheres(1))).scene.expect("a scene");
    let one = scene.objects[0].clone();
    let mut objects = vec![one; 200_000];
    for (index, object) in (0u32..).zip(&mut objects) {
        if let scene::Shape::Sphere(sphere) = &mut object.shape {
            let [x, y] = [index % 447, index / 447].map(f64::from);
            sphere.center = glam::DVec3::new(x - 223.0, y - 223.0, -400.0);
        }
    }
    scene.objects = Arc::new(objects);
    check("a world", |cancel| World::new_unless(&scene, cancel));
    let unwanted = World::new_unless(&scene, &AtomicBool::new(true));
    assert_eq!(unwanted.err(), Some(Cancelled));
}

#[test]
fn what_is_unwanted_from_the_start_is_not_begun() {
    let text = format!("// Spheres.\n{}", spheres(100));
    let sources = sources(&text);
    let cancel = AtomicBool::new(true);
    let parsed = syntax::parse_unless(&sources.file, SourceId::File, &cancel);
    assert_eq!(parsed, syntax::Parsed::default());
    let unwanted = syntax::parse_in_parts(&sources.file, SourceId::File, 1, &cancel, |_| {
        unreachable!("nothing is handed over")
    });
    assert!(!unwanted);
    let reading = scene::read_unless(&sources, &cancel);
    assert_eq!(reading.err(), Some(Cancelled));
}

#[test]
fn what_is_wanted_no_more_on_the_way_ends_there() {
    let sources = sources(&spheres(100));
    let cancel = AtomicBool::new(false);
    let mut handed = 0;
    let all = syntax::parse_in_parts(&sources.file, SourceId::File, 1, &cancel, |_| {
        handed += 1;
        cancel.store(true, Ordering::Relaxed);
        true
    });
    assert_eq!((all, handed), (false, 1));
}

#[test]
fn what_is_wanted_is_the_same() {
    let sources = sources(&spheres(2_000));
    let cancel = AtomicBool::new(false);
    let reading = scene::read_unless(&sources, &cancel).expect("a reading");
    let plain = scene::read(&sources);
    assert_eq!(reading.diagnostics, plain.diagnostics);
    assert_eq!(reading.scene, plain.scene);
    let scene = plain.scene.expect("a scene");
    let world = World::new_unless(&scene, &cancel).expect("a world");
    assert_eq!(world.object_count(), scene.objects.len());
}
