//! `report`: how right Pinhole is, and how fast.

use std::sync::atomic::Ordering;

use super::{
    Status, Trouble,
    args::{Format, ReportArgs},
    interrupt::Interrupt,
    output, progress,
};
use crate::{
    render::{Control, RenderError},
    report::numerics,
};

/// How many inputs each hard case gets unless it is said.
const INPUTS: u64 = 10_000;

/// Makes the report that is asked for.
pub fn run(args: &ReportArgs, interrupt: &Interrupt) -> Result<Status, Trouble> {
    if args.numerics {
        return numerics(args, interrupt);
    }
    #[cfg(feature = "report")]
    return super::speed::run(args, interrupt);
    #[cfg(not(feature = "report"))]
    Err(Trouble(
        "this pinhole was built without the feature `report`: it can report on the arithmetic only, with `--numerics`"
            .to_owned(),
    ))
}

/// Asks the hard cases. After Ctrl-C, the table is of those inputs that were asked.
fn numerics(args: &ReportArgs, interrupt: &Interrupt) -> Result<Status, Trouble> {
    let cancel = interrupt.watch();
    let inputs = args.inputs.unwrap_or(INPUTS);
    let total = inputs.saturating_mul(numerics::cases().count() as u64);
    let table = progress::watched(total, |done| {
        let control = Control {
            threads: None,
            progress: &|more| {
                done.fetch_add(more, Ordering::Relaxed);
            },
            cancel,
        };
        numerics::run(inputs, &control)
    });
    let table = table.map_err(|error| Trouble(RenderError::from(error).to_string()))?;
    match args.format.format {
        Format::Human => output::answer(&table.to_string())?,
        Format::Json => output::to_programs(format!("{}\n", table.to_json()).as_bytes())?,
    }
    Ok(match table.is_complete() {
        true => Status::Done,
        false => Status::Interrupted,
    })
}
