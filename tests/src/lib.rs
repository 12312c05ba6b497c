//! Shared parts of the validation tests: texts of scenes, numbers out of reports, z-scores.

pub mod field;
pub mod fuzz;
pub mod readers;
pub mod scene_text;

use std::path::{Path, PathBuf};

use sunfleck::document;
use sunfleck::products::{Product, Report};
use sunfleck::run::{Options, Unwatched, run};

pub use scene_text::SceneText;

/// The folder of shared data beside the project; `None`, with a note on stderr, where it is absent.
#[must_use]
#[expect(clippy::print_stderr, reason = "a test that skips says so")]
pub fn shared() -> Option<PathBuf> {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared"));
    if path.is_dir() {
        return Some(path.to_owned());
    }
    eprintln!("skipped: needs the folder `shared` beside the project");
    None
}

/// Runs a scene given as text; paths in it are relative to `folder`.
///
/// # Panics
/// If the scene is wrong: the message is what its author would read.
#[must_use]
pub fn measure(text: &str, folder: &Path, options: &Options) -> Report {
    let reading = match document::read_text("test.ron", text, &options.document) {
        Ok(reading) => reading,
        Err(error) => panic!("{error}"),
    };
    let problems = reading.source.render(&reading.diagnostics);
    assert!(problems.is_empty(), "{problems}");
    match run(&reading.scene, folder, options, &Unwatched) {
        Ok(report) => report,
        Err(failure) => panic!("{}", failure.with_source(&reading.source)),
    }
}

/// Optics of a sheet of leaf over soil in a band: reflectance `r` and transmittance `t` of the leaf, reflectance `s`
/// of the soil.
pub type SheetOptics = (f64, f64, f64);

/// Albedo of a number of these sheets by adding layers one by one: `r + t² R / (1 - r R)` over a reflectance `R`.
#[must_use]
pub fn albedo_of_sheets((r, t, s): SheetOptics, count: u32) -> f64 {
    (0..count).fold(s, |below, _| r + t * t * below / (1.0 - r * below))
}

/// A product of a sensor.
///
/// # Panics
/// If the report has none of that name.
#[must_use]
pub fn product<'a>(report: &'a Report, sensor: &str, product: &str) -> &'a Product {
    let sensor = report.sensors.iter().find(|report| report.name == sensor).expect("a sensor");
    sensor.products.iter().find(|p| p.name == product).expect("a product")
}

/// An estimate with its standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Value.
    pub value: f64,
    /// Standard error.
    pub error: f64,
}

impl Estimate {
    /// Entry of a product's values.
    #[must_use]
    pub fn of(product: &Product, index: usize) -> Self {
        Self { value: product.values[index], error: product.standard_error[index] }
    }

    /// Deviation from a known value in standard errors.
    #[must_use]
    pub fn z(self, truth: f64) -> f64 {
        (self.value - truth) / self.error
    }

    /// Deviation from an independent estimate in standard errors of the difference.
    #[must_use]
    pub fn z_against(self, other: Self) -> f64 {
        (self.value - other.value) / self.error.hypot(other.error)
    }
}
