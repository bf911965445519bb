//! `report`: reports how accurate and how fast Pinhole is.

use super::{
    CommandError, Status,
    args::{AnswerFormat, ReportArgs},
    interrupt::Interrupt,
    output, progress,
};
use crate::{render::RenderError, report::numerics};

/// Default number of random inputs for each hard case of the arithmetic. A million inputs take half
/// an hour of processor time, so the default is a hundredth of that number.
const INPUTS: u64 = 10_000;

/// Prints or writes the report that the arguments select.
pub fn run(args: &ReportArgs, interrupt: &Interrupt) -> Result<Status, CommandError> {
    if args.numerics {
        return numerics(args, interrupt);
    }
    super::speed::run(args, interrupt)
}

/// Tests the arithmetic of the renderer in hard cases, and prints how often it gave a wrong answer,
/// such as a wrong visible object. After Ctrl-C, only the inputs tested so far are counted.
fn numerics(args: &ReportArgs, interrupt: &Interrupt) -> Result<Status, CommandError> {
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
