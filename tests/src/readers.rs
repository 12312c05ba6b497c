//! Readers of other programs: Python scripts of the folder `readers`.

use std::ffi::OsStr;
use std::path::Path;
use std::process::Command;

/// Exit code of a script where a module is missing.
const MISSING: i32 = 77;

/// Outcome of a script.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ScriptOutcome {
    /// It read and compared everything, and said this.
    Passed(String),
    /// Python or a module is missing.
    Skipped(String),
}

/// Runs a script of the folder `readers` by `python3`, or by the Python that `SUNFLECK_PYTHON` names.
///
/// # Panics
/// If the script finds a difference: the message is what it said.
#[must_use]
pub fn run_reader(script: &str, arguments: &[&OsStr]) -> ScriptOutcome {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("readers").join(script);
    let python = std::env::var_os("SUNFLECK_PYTHON").unwrap_or_else(|| "python3".into());
    let Ok(run) = Command::new(python).arg(path).args(arguments).output() else {
        return ScriptOutcome::Skipped("there is no Python".to_owned());
    };
    let [said, wrong] = [&run.stdout, &run.stderr].map(|text| String::from_utf8_lossy(text));
    if run.status.code() == Some(MISSING) {
        return ScriptOutcome::Skipped(said.into_owned());
    }
    assert!(run.status.success(), "{script} {arguments:?}: {said}{wrong}");
    ScriptOutcome::Passed(said.into_owned())
}
