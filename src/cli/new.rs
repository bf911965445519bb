//! `new`: the smallest scene that shows something, in a file of its own.

use std::{fs::OpenOptions, io::Write};

use super::{
    Status, Trouble,
    args::NewArgs,
    input::{is_standard, shown},
    output,
};
use crate::scene;

/// Writes the scene, unless the file is there already.
pub fn run(args: &NewArgs) -> Result<Status, Trouble> {
    if is_standard(&args.file) {
        output::to_programs(scene::SMALLEST.as_bytes())?;
        return Ok(Status::Done);
    }
    let file = OpenOptions::new()
        .write(true)
        .create_new(true)
        .open(&args.file);
    let written = file.and_then(|mut file| file.write_all(scene::SMALLEST.as_bytes()));
    match written {
        Ok(()) => Ok(Status::Done),
        Err(error) => Err(Trouble(format!(
            "cannot write {}: {error}",
            shown(&args.file)
        ))),
    }
}
