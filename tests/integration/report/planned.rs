//! What is measured where the number of samples or runs is left open: more runs, and tries.

use std::sync::atomic::AtomicBool;

use pinhole::{
    film::Recipe,
    render::Control,
    report::speed::{self, Plan, Request, Subject, Tries, measure},
    scene::{self, Method, Scene},
    source::{Source, Sources},
};

use super::SCENE;

/// A picture that takes no time.
fn small() -> (Subject, Scene) {
    let text = SCENE.replace("width 48 height 32", "width 12 height 8");
    let sources = Sources::new(Source::from_text("a.scn", text.as_str()));
    let scene = scene::read(&sources).scene.unwrap();
    let subject = Subject {
        name: "a.scn".to_owned(),
        recipe: Recipe {
            scene: text,
            overrides: Vec::new(),
            crop: None,
        },
    };
    (subject, scene)
}

#[test]
fn noisy_times_get_more_runs_where_time_is_left() {
    let (subject, scene) = small();
    let request = Request {
        methods: vec![Method::Sobol, Method::Exact],
        samples: vec![1, 4],
        runs: None,
        errors: Vec::new(),
        budget: std::time::Duration::from_secs(600),
        threads: None,
    };
    let control = Control {
        threads: None,
        progress: &|_| {},
        cancel: &AtomicBool::new(false),
    };
    let plan = Plan::new(&subject, &scene, &request, &control).unwrap();
    let mut measured = measure(&plan, &control).unwrap();
    // There was time for as many as are made at most.
    assert_eq!((measured.runs, measured.rounds()), (9, 9));
    assert_eq!(speed::further(&plan, &measured).0, 0);
    // As if there had been time for three.
    let three = |times: &mut Vec<f64>, slow: f64| *times = vec![0.001, 0.001, 0.001 * slow];
    let mut as_if = |slow| {
        measured.runs = 3;
        for point in &mut measured.series[0].points {
            three(&mut point.times, slow);
            point.rmse.truncate(3);
        }
        three(&mut measured.exact.as_mut().unwrap().times, slow);
        speed::further(&plan, &measured).0
    };
    assert_eq!(as_if(1.1), 0);
    assert_eq!(as_if(1.5), 6);
    speed::measure_further(6, &plan, &control, &mut measured).unwrap();
    assert_eq!((measured.runs, measured.rounds()), (9, 9));
    let points = &measured.series[0].points;
    assert!(points.iter().all(|point| point.rmse.len() == 9));
    // Each has a seed of its own.
    let mut errors = points[1].rmse.clone();
    errors.sort_by(f64::total_cmp);
    errors.dedup();
    assert_eq!(errors.len(), 9);
    // Whoever says how many runs there are gets no others.
    let request = Request {
        runs: Some(3),
        ..request.clone()
    };
    let plan = Plan::new(&subject, &scene, &request, &control).unwrap();
    let mut measured = measure(&plan, &control).unwrap();
    measured.series[0].points[0].times[0] = 9.0;
    assert_eq!(speed::further(&plan, &measured).0, 0);
}

#[test]
#[ignore = "exhaustive"]
fn answers_are_tried_where_time_is_left() {
    let (subject, scene) = small();
    let request = Request {
        methods: vec![Method::Sobol, Method::Exact],
        samples: Vec::new(),
        runs: Some(1),
        errors: vec![2e-4],
        budget: std::time::Duration::from_secs(30),
        threads: None,
    };
    let control = Control {
        threads: None,
        progress: &|_| {},
        cancel: &AtomicBool::new(false),
    };
    let plan = Plan::new(&subject, &scene, &request, &control).unwrap();
    let mut measured = measure(&plan, &control).unwrap();
    let sobol = || {
        measured
            .series
            .iter()
            .find(|series| series.method == Method::Sobol)
    };
    let needed = sobol().unwrap().needed(2e-4).unwrap();
    assert!(
        needed.is_extrapolated && needed.per_pixel > 1024.0,
        "{needed:?}"
    );
    let points = &sobol().unwrap().points;
    let [.., before, last] = points.as_slice() else {
        panic!("{points:?}");
    };
    let between = (before.error() * last.error()).sqrt();
    let line = sobol().unwrap().needed(between).unwrap();
    assert!(!line.is_extrapolated && line.tries == 0, "{line:?}");
    measured.errors.push(between);
    let tries = Tries::new(&plan, &measured);
    assert!(tries.total() > 0);
    tries.run(&mut measured, &control).unwrap();
    let sobol = measured
        .series
        .iter()
        .find(|series| series.method == Method::Sobol)
        .unwrap();
    // What the line says comes first, between two points and beyond the last; then what tries say.
    for (wanted, line) in [(2e-4, needed), (between, line)] {
        let first = sobol.tries_for(wanted).next().unwrap();
        let off = first.point.per_pixel as f64 - line.per_pixel;
        assert!((-1.0..=1.0).contains(&off), "{off}");
        let needed = sobol.needed(wanted).unwrap();
        assert!(needed.tries >= 6 && !needed.is_extrapolated, "{needed:?}");
        assert!(needed.factor.unwrap() < 3.0, "{needed:?}");
    }
    // Each has a seed of its own, which no planned run has.
    let mut seeds: Vec<_> = sobol.tries.iter().map(|it| it.seed).collect();
    seeds.dedup();
    assert_eq!(seeds.len(), sobol.tries.len());
    assert_eq!(seeds[0], measured.seed + measured.runs);
    let text = speed::table(&measured);
    assert!(text.contains(" tries: "), "{text}");
    let check = sobol.tries_for(2e-4).next().unwrap();
    let rmse = check.point.error();
    let json = &speed::to_json(&measured)["methods"];
    let sobol = json
        .as_array()
        .unwrap()
        .iter()
        .find(|method| method["method"] == "sobol");
    assert_eq!(sobol.unwrap()["needed"][0]["tries"][0]["rmse"], rmse);
    // What the charts draw has a row.
    let csv = speed::to_csv(&measured);
    let mut tried = csv.lines().filter(|line| line.ends_with(",0.0002"));
    let row = format!("sobol,{},", check.point.per_pixel);
    assert!(tried.next().unwrap().starts_with(&row), "{csv}");
    assert!(
        speed::page(&[measured])
            .unwrap()
            .contains("tries: samples, errors")
    );
}

#[test]
fn renders_keep_what_the_factor_says() {
    let (subject, mut scene) = small();
    let control = Control {
        threads: None,
        progress: &|_| {},
        cancel: &AtomicBool::new(false),
    };
    let error = 0.01;
    let methods = vec![Method::Random, Method::MultiJittered, Method::Hammersley];
    let mut request = Request {
        methods,
        samples: Vec::new(),
        runs: Some(3),
        errors: vec![error],
        budget: std::time::Duration::from_secs(60),
        threads: None,
    };
    let plan = Plan::new(&subject, &scene, &request, &control).unwrap();
    let mut measured = measure(&plan, &control).unwrap();
    Tries::new(&plan, &measured)
        .run(&mut measured, &control)
        .unwrap();
    // Others' seeds than those that it was found with.
    scene.sampler.seed += 1_000_000;
    request.runs = Some(40);
    for series in &measured.series {
        let needed = series.needed(error).unwrap();
        let factor = needed.factor.unwrap();
        assert!(needed.tries >= 6 && factor < 4.0, "{needed:?}");
        let [few, many] = [needed.per_pixel / factor, needed.per_pixel * factor];
        request.methods = vec![series.method];
        request.samples = vec![few as u64, many.ceil() as u64];
        let plan = Plan::new(&subject, &scene, &request, &control).unwrap();
        let ends = measure(&plan, &control).unwrap();
        let [few, many] = ends.series[0].points.as_slice() else {
            panic!("{:?}", ends.series);
        };
        assert!(few.error() >= error, "{:?} {needed:?}", series.method);
        let kept = many.rmse.iter().filter(|&&left| left <= error).count();
        assert!(kept >= 38, "{:?} {needed:?} {kept}", series.method);
    }
}
