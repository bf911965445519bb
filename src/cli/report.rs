//! `report`: how right Pinhole is.

use std::{num::NonZero, sync::atomic::Ordering};

use pinhole::{
    render::{Control, RenderError},
    report::numerics,
};

use super::{
    Status, Trouble,
    args::{Format, ReportArgs},
    interrupt::Interrupt,
    output, progress,
};

/// Makes the report that is asked for.
pub fn run(args: &ReportArgs, interrupt: &Interrupt) -> Result<Status, Trouble> {
    if args.numerics {
        return numerics(args, interrupt);
    }
    Err(Trouble(
        match args.scenes.is_empty() {
            true => "say which SCENE to report on, or ask with `--numerics` about the arithmetic",
            false => "there is no report on scenes yet: ask with `--numerics` about the arithmetic",
        }
        .to_owned(),
    ))
}

/// Asks the hard cases.
fn numerics(args: &ReportArgs, interrupt: &Interrupt) -> Result<Status, Trouble> {
    let cancel = interrupt.watch();
    let total = args.inputs.saturating_mul(numerics::cases().count() as u64);
    let threads = args.threads;
    let threads =
        threads.and_then(|threads| NonZero::new(usize::try_from(threads).unwrap_or(usize::MAX)));
    let table = progress::watched(total, |done| {
        let control = Control {
            threads,
            progress: &|inputs| {
                done.fetch_add(inputs, Ordering::Relaxed);
            },
            cancel,
        };
        numerics::run(args.inputs, &control)
    });
    let table = match table {
        Ok(table) => table,
        Err(RenderError::Cancelled) => return Ok(Status::Interrupted),
        Err(error) => return Err(Trouble(error.to_string())),
    };
    match args.format.format {
        Format::Human => output::to_people(&table.to_string()),
        Format::Json => output::to_programs(format!("{}\n", table.to_json()).as_bytes())?,
    }
    Ok(Status::Done)
}
