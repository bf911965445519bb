//! Tests of the hard cases of `report --numerics`, i.e. of scenes in which rounding errors easily
//! cause wrong answers. Pinhole must never be wrong, and the formulas of a textbook must often be
//! wrong.

use std::{
    collections::BTreeSet,
    num::NonZero,
    sync::{
        OnceLock,
        atomic::{AtomicBool, AtomicU64, Ordering},
    },
};

use pinhole::{
    render::Control,
    report::numerics::{self, NumericsTable},
};

use crate::effort::{Effort, sampled_and_exhaustive};

/// Number of inputs with which each hard case is tested in a normal run. An exhaustive run has ten
/// times as many. With fewer inputs, rare wrong decisions would be missed; more inputs take longer.
const INPUTS: u64 = 1_000;

fn run(inputs: u64, threads: Option<usize>) -> NumericsTable {
    let control = Control {
        threads: threads.and_then(NonZero::new),
        ..Control::default()
    };
    numerics::run(inputs, &control).unwrap()
}

/// Returns the table of all hard cases, which is computed once for all tests.
fn table() -> &'static NumericsTable {
    static TABLE: OnceLock<NumericsTable> = OnceLock::new();
    TABLE.get_or_init(|| run(INPUTS, None))
}

sampled_and_exhaustive!(no_hard_case_is_decided_wrongly);

fn no_hard_case_is_decided_wrongly(effort: Effort) {
    let (table, inputs) = match effort {
        Effort::Sample => (table(), INPUTS),
        Effort::Exhaustive => (&run(10 * INPUTS, None), 10 * INPUTS),
    };
    for row in &table.rows {
        assert_eq!(row.tally.inputs, inputs, "{}", row.case.id);
        assert_eq!(row.tally.wrong[1], 0, "{}: {}", row.case.id, row.case.title);
    }
    assert_eq!(table.wrong(), 0);
}

#[test]
fn hard_cases_break_the_textbook_formulas_and_stay_within_the_claimed_bound() {
    for row in &table().rows {
        let (id, tally) = (row.case.id, &row.tally);
        match tally.error[1] {
            // The last bit of a computed distance is sometimes wrong. So an error of 0 would mean
            // that nothing was measured.
            Some(error) => assert!(error > 0.0 && error <= row.case.bound, "{id}: {error}"),
            // In the case P2, no ray hits the board, so no distance is measured.
            None => assert_eq!(id, "P2"),
        }
        if row.case.decides() {
            let share = tally.wrong[0] as f64 / INPUTS as f64;
            // The case S7 has two spheres with the same centre. If their radii are equal, too, the
            // rounding errors are the same for both, and the formulas of the textbook are right. So
            // the fraction of wrong answers is smaller than in other cases.
            let least = if id == "S7" { 0.002 } else { 0.05 };
            assert!(share >= least, "{id}: {share}");
        } else {
            assert!(tally.error[0] > Some(10.0), "{id}");
        }
    }
}

#[test]
fn the_table_is_the_same_for_any_number_of_threads() {
    let one = run(50, Some(1));
    assert_eq!(run(50, Some(3)).to_json(), one.to_json());
    assert!(one.rows.iter().all(|row| row.tally.inputs == 50));
}

#[test]
fn the_numerics_report_shows_progress_and_can_be_cancelled() {
    let (done, cancel) = (AtomicU64::new(0), AtomicBool::new(false));
    let control = Control {
        progress: &|inputs| {
            done.fetch_add(inputs, Ordering::Relaxed);
            cancel.store(true, Ordering::Relaxed);
        },
        cancel: &cancel,
        ..Control::default()
    };
    let table = numerics::run(1_000_000, &control).unwrap();
    let done = done.load(Ordering::Relaxed);
    assert!((1..10_000).contains(&done));
    // The table contains exactly the inputs that were tested before the cancellation.
    assert_eq!((table.inputs(), table.is_complete()), (done, false));
    assert!(table.rows.iter().all(|row| row.tally.inputs > 0));
}

#[test]
fn the_numerics_table_fits_100_columns_and_has_a_json_form() {
    let text = table().to_string();
    assert!(text.lines().all(|line| line.chars().count() <= 100));
    assert!(!text.contains("incomplete"));
    let json = table().to_json();
    assert_eq!(json["complete"], true);
    let rows = json["numerics"].as_array().unwrap();
    let ids = rows.iter().map(|row| row["case"].as_str().unwrap());
    let ids: BTreeSet<_> = ids.collect();
    assert_eq!(ids.len(), numerics::cases().count());
    let families: BTreeSet<_> = ids.iter().map(|id| &id[..1]).collect();
    assert!(families.into_iter().eq(["B", "C", "K", "P", "S", "T"]));
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
