//! Signals that end the process: a run that can keep what it has traced ends by itself, and nothing unfinished stays on the
//! disk.

use std::sync::atomic::{AtomicBool, AtomicI32, Ordering};

/// Signal that was received; 0 without one.
static SIGNAL: AtomicI32 = AtomicI32::new(0);

/// True while a run is traced that ends by itself, once it has seen a signal.
static ENDS_BY_ITSELF: AtomicBool = AtomicBool::new(false);

/// Says whether the work at hand looks for [`is_cancelled`] and ends by itself.
pub(crate) fn set_ends_by_itself(ends: bool) {
    ENDS_BY_ITSELF.store(ends, Ordering::Relaxed);
}

/// Returns true once a signal has asked the process to end.
pub(crate) fn is_cancelled() -> bool {
    signal().is_some()
}

/// Signal that has asked the process to end.
pub(crate) fn signal() -> Option<i32> {
    Some(SIGNAL.load(Ordering::Relaxed)).filter(|signal| *signal != 0)
}

/// Ends the process on SIGINT, SIGTERM and SIGHUP with the exit code of a program that the signal ended, 128 and its number.
///
/// A run that can save its state is given the time for that: after a SIGTERM or SIGHUP 20 s, as batch systems kill what
/// has not ended half a minute later. A second signal removes unfinished files and ends the process, a third ends it at
/// once. A file that is larger than the system allows (SIGXFSZ) becomes an error of writing.
///
/// # Errors
/// If the system does not let signals be handled.
#[cfg(unix)]
pub(crate) fn watch() -> std::io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};

    let mut signals = signal_hook::iterator::Signals::new([SIGHUP, SIGINT, SIGTERM, SIGXFSZ])?;
    let ends = move || {
        let mut is_ending = false;
        for signal in signals.forever().filter(|signal| *signal != SIGXFSZ) {
            if is_ending {
                std::process::exit(128 + signal);
            }
            let is_first = SIGNAL.swap(signal, Ordering::Relaxed) == 0;
            if is_first && ENDS_BY_ITSELF.load(Ordering::Relaxed) {
                say_that_it_ends();
                if signal != SIGINT {
                    end(signal, GRACE);
                }
                continue;
            }
            is_ending = true;
            end(signal, std::time::Duration::ZERO);
        }
    };
    std::thread::Builder::new().name("signals".to_owned()).spawn(ends).map(drop)
}

/// Elsewhere the system ends the process; the next run removes what that leaves.
#[cfg(not(unix))]
pub(crate) fn watch() -> std::io::Result<()> {
    Ok(())
}

/// Time that a run has to save its state.
#[cfg(unix)]
const GRACE: std::time::Duration = std::time::Duration::from_secs(20);

/// Removes unfinished files after a time and ends the process.
#[cfg(unix)]
fn end(signal: i32, after: std::time::Duration) {
    std::thread::spawn(move || {
        std::thread::sleep(after);
        sunfleck::output::clean_up();
        std::process::exit(128 + signal);
    });
}

#[cfg(unix)]
fn say_that_it_ends() {
    use std::io::Write as _;

    let text = "ending after this round of samples, to keep what is traced; the same signal again ends at once";
    // A terminal that has gone away is one reason for the signal.
    drop(writeln!(std::io::stderr().lock(), "{text}"));
}
