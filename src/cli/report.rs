//! `report`: reports how accurate and how fast Pinhole is.

use super::{
    Status, Trouble,
    args::{AnswerFormat, ReportArgs},
    interrupt::Interrupt,
    output, progress,
};
use crate::{render::RenderError, report::numerics};

/// Default number of inputs for each hard case.
const INPUTS: u64 = 10_000;

/// Prints or writes the report that the arguments ask for.
pub fn run(args: &ReportArgs, interrupt: &Interrupt) -> Result<Status, Trouble> {
    if args.numerics {
        return numerics(args, interrupt);
    }
    super::speed::run(args, interrupt)
}

/// Tests the arithmetic in the hard cases. After Ctrl-C, the table covers the inputs that were
/// tested until then.
fn numerics(args: &ReportArgs, interrupt: &Interrupt) -> Result<Status, Trouble> {
    let cancel = interrupt.watch();
    let inputs = args.inputs.unwrap_or(INPUTS);
    let total = inputs.saturating_mul(numerics::cases().count() as u64);
    let table = progress::rendering(total, None, cancel, |control| {
        numerics::run(inputs, control)
    });
    let table = table.map_err(RenderError::from)?;
    match args.format.format {
        AnswerFormat::Human => output::answer(&table.to_string())?,
        AnswerFormat::Json => output::to_programs(format!("{}\n", table.to_json()).as_bytes())?,
    }
    Ok(if table.is_complete() {
        Status::Done
    } else {
        Status::Interrupted
    })
}
