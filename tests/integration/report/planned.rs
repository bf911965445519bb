//! What is measured where the number of samples or runs is left open: more runs, and tries.

use std::sync::atomic::AtomicBool;

use pinhole::{
    film::Recipe,
    render::Control,
    report::speed::{self, Checks, Plan, Request, Subject, measure},
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
    assert!(!line.is_extrapolated && line.sag > 0.05, "{line:?}");
    measured.errors.push(between);
    let checks = Checks::new(&plan, &measured);
    assert!(checks.total() > 0);
    checks.run(&mut measured, &control).unwrap();
    let sobol = measured
        .series
        .iter()
        .find(|series| series.method == Method::Sobol);
    // A tenth more than the line said; or another try after that.
    let first = &sobol.unwrap().checks[0];
    assert_eq!(first.wanted, 2e-4);
    assert!(first.point.per_pixel as f64 >= 1.1 * needed.per_pixel);
    let needed = sobol.unwrap().needed(2e-4).unwrap();
    let most = sobol.unwrap().curve().last().unwrap().per_pixel;
    assert!(
        !needed.is_extrapolated && needed.per_pixel <= most as f64,
        "{needed:?}"
    );
    // Between two points, what the line says is taken, until a point is close.
    let needed = sobol.unwrap().needed(between).unwrap();
    let tries: Vec<_> = sobol.unwrap().checks.iter().collect();
    let tries: Vec<_> = tries.iter().filter(|it| it.wanted == between).collect();
    assert_eq!(tries[0].point.per_pixel as f64, line.per_pixel);
    assert!(needed.sag <= 0.01 || tries.len() == 3, "{needed:?}");
    assert!(needed.sag < line.sag, "{needed:?}");
    let check = sobol.unwrap().check(2e-4).unwrap();
    let text = speed::table(&measured);
    assert!(text.contains("  tried: "), "{text}");
    let rmse = check.point.error();
    let json = &speed::to_json(&measured)["methods"];
    let sobol = json
        .as_array()
        .unwrap()
        .iter()
        .find(|method| method["method"] == "sobol");
    assert_eq!(sobol.unwrap()["needed"][0]["tried"]["rmse"], rmse);
    // What the charts draw has a row.
    let csv = speed::to_csv(&measured);
    let mut tried = csv.lines().filter(|line| line.ends_with(",0.0002"));
    let row = format!("sobol,{},", check.point.per_pixel);
    assert!(tried.next_back().unwrap().starts_with(&row), "{csv}");
    assert!(
        speed::page(&[measured])
            .unwrap()
            .contains("tried: samples, error, time")
    );
}
