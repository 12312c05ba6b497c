//! The `sunfleck` command: arguments in, a folder of results out.
//!
//! Exit code 0 if all was written, 1 if the scene or the output is at fault, 2 for wrong usage,
//! 128 and the number of a signal that ended it.

mod arguments;
mod bench;
mod columns;
mod commands;
mod compare;
mod describe;
mod import_less;
mod interrupt;
mod plot;
mod progress;
mod verify;

use std::io::{self, Write as _};
use std::process::ExitCode;

use clap::Parser as _;

fn main() -> ExitCode {
    let command = arguments::Command::parse();
    // Without it a signal ends the process all the same, and the next run removes what that leaves.
    drop(interrupt::watch());
    match commands::execute(&command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // If even this cannot be written, the exit code is all that is left to tell.
            drop(writeln!(io::stderr().lock(), "{}", commands::message(&error)));
            ExitCode::FAILURE
        }
    }
}
