//! The `sunfleck` command: arguments in, a folder of results out.
//!
//! Exit code 0 if all was written, 1 if the scene or the output is at fault, 2 for wrong usage,
//! 128 and the number of a signal that ended it.

mod arguments;
mod bench;
mod columns;
mod commands;
mod compare;
mod console;
mod describe;
mod import;
mod interrupt;
mod plot;
mod progress;
mod report;
mod verify;

use std::io::{self, Write as _};
use std::process::ExitCode;

use clap::Parser as _;
use serde_json::json;

fn main() -> ExitCode {
    let command = match arguments::Command::try_parse() {
        Ok(command) => command,
        Err(error) => return commands::refuse(&error),
    };
    // Without it a signal ends the process all the same, and the next run removes what that leaves.
    drop(interrupt::watch());
    match commands::execute(&command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // If even this cannot be written, the exit code is all that is left to tell.
            let message = commands::message(&error);
            drop(writeln!(io::stderr().lock(), "{message}"));
            command.console().event(&json!({ "event": "error", "text": message }));
            // A run that a signal has ended had nothing else wrong with it.
            interrupt::signal()
                .map_or(ExitCode::FAILURE, |signal| ExitCode::from(128 + signal as u8))
        }
    }
}
