//! `new`: writes a new file with a minimal scene that shows something.

use super::{
    CommandError, Status,
    args::NewArgs,
    input::{is_standard, unwritable},
    interrupt::Interrupt,
    output,
};
use crate::{
    files::{self, Purpose},
    scene,
};

/// Writes the minimal scene to a new file, or to standard output for `-`. Fails if the file exists.
pub fn run(args: &NewArgs, interrupt: &Interrupt) -> Result<Status, CommandError> {
    if is_standard(&args.file) {
        output::to_programs(scene::SMALLEST.as_bytes())?;
        return Ok(Status::Done);
    }
    files::write(&args.file, Purpose::New, interrupt.watch(), |out| {
        out.write_all(scene::SMALLEST.as_bytes())
    })
    .map_err(|error| unwritable(&args.file, &error))?;
    Ok(Status::Done)
}
