//! The command-line program. The library's module `cli` does all of its work.

use std::process::ExitCode;

fn main() -> ExitCode {
    pinhole::cli::run()
}
