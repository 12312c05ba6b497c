//! Signals that end the process: nothing unfinished stays on the disk.

/// Removes unfinished files on SIGINT, SIGTERM and SIGHUP and ends the process with the exit code of a
/// program that the signal ended, 128 and its number; a second signal ends it at once.
///
/// A file that is larger than the system allows (SIGXFSZ) becomes an error of writing.
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
            let end = move || std::process::exit(128 + signal);
            if std::mem::replace(&mut is_ending, true) {
                end();
            }
            std::thread::spawn(move || {
                sunfleck::output::clean_up();
                end();
            });
        }
    };
    std::thread::Builder::new().name("signals".to_owned()).spawn(ends).map(drop)
}

/// Elsewhere the system ends the process; the next run removes what that leaves.
#[cfg(not(unix))]
pub(crate) fn watch() -> std::io::Result<()> {
    Ok(())
}
