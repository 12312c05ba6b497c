//! Table-driven cases: inputs that people of the field had trouble with, each with what is right.
//!
//! A case is a scene file below `tests/field` and a list of facts that hold for it. [`hold`] runs all
//! cases of a table and reports every fact that does not hold.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use sunfleck::products::Report;
use sunfleck::run::{Options, Unwatched, check_file, run_file};

use crate::Estimate;

/// A scene file and what is right about it.
#[derive(Clone, Copy, Debug)]
pub struct Case<'a> {
    /// Path below `tests/field`.
    pub scene: &'static str,
    /// Facts that hold together.
    pub right: &'a [Right],
}

/// A fact about a scene.
#[derive(Clone, Copy, Debug)]
pub enum Right {
    /// An entry of a product agrees with a known value.
    Value {
        /// Name of the sensor.
        sensor: &'static str,
        /// Name of the product.
        product: &'static str,
        /// Position in the product's values.
        index: usize,
        /// The known value.
        value: f64,
        /// Deviation that is allowed beyond four standard errors: the bias of a method or the digits
        /// of the known value.
        within: f64,
    },
    /// `run` and `check` both warn, in one warning that contains all of these.
    Warns(&'static [&'static str]),
    /// `run` warns, in one warning that contains all of these; `check` cannot know yet.
    WarnsInRun(&'static [&'static str]),
    /// `run` and `check` succeed without any warning.
    Quiet,
    /// `run` and `check` both refuse the scene, with a message that contains all of these.
    Fails(&'static [&'static str]),
    /// `run` refuses the scene with a message that contains all of these; `check` cannot know yet.
    FailsInRun(&'static [&'static str]),
}

/// Folder of the field's inputs.
#[must_use]
pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("field")
}

/// Runs all cases with options.
///
/// # Panics
/// If a fact does not hold; the message lists all that do not.
pub fn hold_with(cases: &[Case<'_>], options: &Options) {
    let mut faults = String::new();
    for case in cases {
        let path = folder().join(case.scene);
        assert!(path.is_file(), "{} is a file", path.display());
        let run = run_file(&path, options, &Unwatched).map_err(|failure| failure.to_string());
        let check = check_file(&path, options).map_err(|failure| failure.to_string());
        for right in case.right {
            if let Err(fault) = right.holds(&run, &check) {
                let _infallible = writeln!(faults, "{}: {fault}", case.scene);
            }
        }
    }
    assert!(faults.is_empty(), "\n{faults}");
}

/// Runs all cases as they are written.
///
/// # Panics
/// If a fact does not hold; the message lists all that do not.
pub fn hold(cases: &[Case<'_>]) {
    hold_with(cases, &Options::default());
}

impl Right {
    /// An entry of a product agrees with a known value within four standard errors.
    #[must_use]
    pub const fn value(
        sensor: &'static str,
        product: &'static str,
        index: usize,
        value: f64,
    ) -> Self {
        Self::Value { sensor, product, index, value, within: 0.0 }
    }

    fn holds(
        self,
        run: &Result<Report, String>,
        check: &Result<Vec<String>, String>,
    ) -> Result<(), String> {
        match self {
            Self::Fails(parts) => {
                fails_with("run", run.as_ref().err(), parts)?;
                fails_with("check", check.as_ref().err(), parts)
            }
            Self::FailsInRun(parts) => fails_with("run", run.as_ref().err(), parts),
            Self::Warns(parts) => {
                let warnings = &run.as_ref().map_err(Clone::clone)?.warnings;
                warns_with("run", warnings, parts)?;
                warns_with("check", check.as_ref().map_err(Clone::clone)?, parts)
            }
            Self::WarnsInRun(parts) => {
                warns_with("run", &run.as_ref().map_err(Clone::clone)?.warnings, parts)
            }
            Self::Quiet => {
                let warnings = &run.as_ref().map_err(Clone::clone)?.warnings;
                let checked = check.as_ref().map_err(Clone::clone)?;
                // `check` tells what was taken or left out too.
                let is_told = |text: &&String| {
                    ["note: ", "skipped: "].iter().any(|head| text.starts_with(head))
                };
                let checked = checked.iter().filter(|text| !is_told(text));
                let all: Vec<_> = warnings.iter().chain(checked).collect();
                if all.is_empty() { Ok(()) } else { Err(format!("warns: {all:?}")) }
            }
            Self::Value { sensor, product, index, value, within } => {
                let report = run.as_ref().map_err(Clone::clone)?;
                let found = estimate(report, sensor, product, index)?;
                let error = if found.error.is_nan() { 0.0 } else { found.error };
                let allowed = 4.0 * error + within + 1e-6 * value.abs();
                if (found.value - value).abs() <= allowed {
                    return Ok(());
                }
                Err(format!("{sensor}.{product}[{index}] is {found:?}, not {value}"))
            }
        }
    }
}

fn fails_with(command: &str, message: Option<&String>, parts: &[&str]) -> Result<(), String> {
    let message = message.ok_or_else(|| format!("{command} accepts it, without {parts:?}"))?;
    match parts.iter().find(|part| !message.contains(**part)) {
        Some(part) => Err(format!("{command} refuses it without {part:?}:\n{message}")),
        None => Ok(()),
    }
}

fn warns_with(command: &str, warnings: &[String], parts: &[&str]) -> Result<(), String> {
    let has_all = |warning: &String| parts.iter().all(|part| warning.contains(part));
    if warnings.iter().any(has_all) {
        return Ok(());
    }
    Err(format!("{command} has no warning with {parts:?}; it has {warnings:#?}"))
}

fn estimate(report: &Report, sensor: &str, name: &str, index: usize) -> Result<Estimate, String> {
    let sensor = report
        .sensors
        .iter()
        .find(|one| one.name == sensor)
        .ok_or_else(|| format!("has no sensor {sensor:?}"))?;
    let product = sensor.products.iter().find(|one| one.name == name).ok_or_else(|| {
        let names: Vec<_> = sensor.products.iter().map(|one| one.name.as_str()).collect();
        format!("reports no {name:?} but {names:?}")
    })?;
    if index >= product.values.len() {
        return Err(format!("{name} has {} values, none at {index}", product.values.len()));
    }
    Ok(Estimate::of(product, index))
}
