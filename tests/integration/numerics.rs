//! The hard cases: none is decided wrongly, and each is hard.

use std::{
    num::NonZero,
    sync::{
        OnceLock,
        atomic::{AtomicBool, AtomicU64, Ordering},
    },
};

use pinhole::{
    render::Control,
    report::numerics::{self, Table},
};

use crate::effort::{Effort, sampled_and_exhaustive};

/// The inputs of each case in every run.
const INPUTS: u64 = 1_000;

/// The inputs of each case in an exhaustive run.
const MANY_INPUTS: u64 = 10_000;

fn run(inputs: u64, threads: Option<usize>) -> Table {
    let control = Control {
        threads: threads.and_then(NonZero::new),
        ..Control::default()
    };
    numerics::run(inputs, &control).unwrap()
}

/// The table, made once for all tests.
fn table() -> &'static Table {
    static TABLE: OnceLock<Table> = OnceLock::new();
    TABLE.get_or_init(|| run(INPUTS, None))
}

sampled_and_exhaustive!(no_hard_case_is_decided_wrongly);

fn no_hard_case_is_decided_wrongly(effort: Effort) {
    let many;
    let (inputs, table) = match effort {
        Effort::Sample => (INPUTS, table()),
        Effort::Exhaustive => {
            many = run(MANY_INPUTS, None);
            (MANY_INPUTS, &many)
        }
    };
    for row in &table.rows {
        assert_eq!(row.tally.inputs, inputs, "{}", row.case.id);
        assert_eq!(row.tally.wrong[1], 0, "{}: {}", row.case.id, row.case.title);
    }
    assert_eq!(table.wrong(), 0);
}

#[test]
fn numbers_are_within_the_bounds_that_are_claimed() {
    for row in &table().rows {
        let bound = row.case.bound;
        // Rays parallel to the board meet it nowhere.
        let Some(error) = row.tally.error[1] else {
            assert_eq!(row.case.id, "P2");
            continue;
        };
        assert!(error <= bound, "{}: {error} > {bound}", row.case.id);
        // The last bit of a distance is a rounding's: were it never wrong, nothing would have been measured.
        assert!(error > 0.0, "{}", row.case.id);
    }
}

#[test]
fn every_case_breaks_the_textbook() {
    for row in &table().rows {
        let share = row.tally.wrong[0] as f64 / INPUTS as f64;
        if row.case.decides() {
            // Equal spheres and their like are decided alike by the same formula, in any precision.
            let least = if row.case.id == "S7" { 0.002 } else { 0.05 };
            assert!(share >= least, "{}: {share}", row.case.id);
        } else {
            assert!(row.tally.error[0] > Some(10.0), "{}", row.case.id);
        }
    }
}

#[test]
fn the_table_is_the_same_for_any_number_of_threads() {
    let one = run(50, Some(1));
    assert_eq!(run(50, Some(3)).to_json(), one.to_json());
    for row in &one.rows {
        assert_eq!(row.tally.inputs, 50, "{}", row.case.id);
    }
}

#[test]
fn it_can_be_watched_and_cancelled() {
    let (done, cancel) = (AtomicU64::new(0), AtomicBool::new(false));
    let control = Control {
        threads: None,
        progress: &|inputs| {
            done.fetch_add(inputs, Ordering::Relaxed);
            cancel.store(true, Ordering::Relaxed);
        },
        cancel: &cancel,
    };
    let table = numerics::run(1_000_000, &control).unwrap();
    let done = done.load(Ordering::Relaxed);
    assert!((1..10_000).contains(&done));
    // What was asked is there, and nothing else.
    assert_eq!((table.inputs(), table.is_complete()), (done, false));
    assert!(table.rows.iter().all(|row| row.tally.inputs > 0));
    assert!(table.to_string().ends_with(&format!(
        "The table is incomplete: it was interrupted before {}_000_000 inputs were asked.\n",
        numerics::cases().count()
    )));
    assert_eq!(table.to_json()["complete"], false);
}

#[test]
fn the_catalogue_names_every_case_once() {
    let mut ids: Vec<_> = numerics::cases().map(|case| case.id).collect();
    let count = ids.len();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), count);
    for letter in ["S", "P", "B", "T", "C", "K"] {
        assert!(ids.iter().any(|id| id.starts_with(letter)), "{letter}");
    }
}

#[test]
fn the_table_fits_a_terminal_and_a_program() {
    let text = table().to_string();
    for line in text.lines() {
        assert!(line.chars().count() <= 100, "{line}");
    }
    assert!(!text.contains("incomplete"));
    let json = table().to_json();
    assert_eq!(json["complete"], true);
    let rows = json["numerics"].as_array().unwrap();
    assert_eq!(rows.len(), table().rows.len());
    let first = &rows[0];
    assert_eq!(first["case"], "S1a");
    assert_eq!(first["inputs"], INPUTS);
    assert_eq!(first["pinhole"]["wrong"], 0);
    assert_eq!(first["unit"], "ulp");
    assert!(first["pinhole"]["error"].as_f64().unwrap() <= 1.0);
    assert!(first["textbook"]["wrong"].as_u64().unwrap() > 0);
    let axes = rows.iter().find(|row| row["case"] == "C1").unwrap();
    assert!(axes["pinhole"]["wrong"].is_null());
}
