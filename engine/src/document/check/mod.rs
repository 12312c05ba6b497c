//! Checks of a scene that need no file: ranges, shapes and names.

mod camera;
mod crown;
mod ground;
mod instances;
mod light;
mod mesh;
mod pixels;
mod plane;
mod program;
mod range;
mod reflectance_map;
mod sensor;
mod spectrum;
mod system;
mod thermal;

use super::diagnostic::{Diagnostic, unknown_name};
use super::leaves::{LeafValue, visit_leaves};
use super::path::ScenePath;
use super::scene::{Map, Scene, Transport};
use crate::counts::counted;

pub(crate) use pixels::{rounded_up, too_many_pixels};
pub(crate) use range::{HEIGHT, IRRADIANCE, LENGTH, LawfulRange, SCALE};
pub(crate) use sensor::check_maps;

/// No more errors than this are kept: nobody reads them.
const ERRORS: usize = 100;

/// Largest zenith angle: what lies within a millionth of a degree of the horizon is on it.
pub(crate) const LOWEST_DEG: f64 = 90.0 - 1e-6;

/// Faults of a scene that can be found without reading a file.
#[must_use]
pub fn check(scene: &Scene) -> Vec<Diagnostic> {
    check_readable(scene, &[], &[])
}

/// Faults of a scene that was read with errors at the `broken` paths, without those there;
/// `lost` are the namespaces of included files that could not be read.
pub(super) fn check_readable(
    scene: &Scene,
    broken: &[ScenePath],
    lost: &[String],
) -> Vec<Diagnostic> {
    let mut report = Report { broken, lost, found: Vec::new(), dropped: 0 };
    if scene.format != 1 {
        let message = format!("format {} is unknown", scene.format);
        report.push(Diagnostic::error("format", message).help("this version reads `format: 1`"));
    }
    program::check_params(scene, &mut report);
    program::check_sweep(scene, &mut report);
    spectrum::check_bands(scene, &mut report);
    spectrum::check_spectra(scene, &mut report);
    spectrum::check_materials(scene, &mut report);
    check_references(scene, &mut report);
    mesh::check_meshes(scene, &mut report);
    ground::check_frame(scene, &mut report);
    ground::check_terrain(scene, &mut report);
    instances::check_instances(scene, &mut report);
    light::check_sun(scene, &mut report);
    light::check_sky(scene, &mut report);
    thermal::check_thermal_sky(scene, &mut report);
    thermal::check_temperatures(scene, &mut report);
    sensor::check_sensors(scene, &mut report);
    check_transport(&scene.transport, &mut report);
    range::check_ranges(scene, &mut report);
    report.finish()
}

/// Faults found so far.
struct Report<'a> {
    broken: &'a [ScenePath],
    lost: &'a [String],
    found: Vec<Diagnostic>,
    dropped: usize,
}

impl Report<'_> {
    fn push(&mut self, diagnostic: Diagnostic) {
        if !self.is_readable(&diagnostic.path) {
            return;
        }
        if self.found.len() < ERRORS {
            self.found.push(diagnostic);
        } else {
            self.dropped += 1;
        }
    }

    fn error(
        &mut self,
        path: impl Into<ScenePath>,
        message: impl Into<String>,
        help: impl Into<String>,
    ) {
        self.push(Diagnostic::error(path, message).help(help));
    }

    fn warning(
        &mut self,
        path: impl Into<ScenePath>,
        message: impl Into<String>,
        help: impl Into<String>,
    ) {
        self.push(Diagnostic::warning(path, message).help(help));
    }

    fn finish(mut self) -> Vec<Diagnostic> {
        if self.dropped > 0 {
            let message = format!("and {}", counted(self.dropped, "more error"));
            self.found.push(Diagnostic::error(ScenePath::root(), message));
        }
        self.found
    }

    /// Returns whether the value at a path could be read: no error is there or above.
    fn is_readable(&self, path: impl Into<ScenePath>) -> bool {
        let path = path.into();
        !self.broken.iter().any(|broken| path.is_within(broken))
    }

    /// Returns whether no error is below a path either.
    fn is_whole(&self, path: impl Into<ScenePath>) -> bool {
        let path = path.into();
        !self.broken.iter().any(|broken| path.is_within(broken) || broken.is_within(&path))
    }

    /// Returns whether a name belongs to an included file that could not be read.
    fn is_lost(&self, name: &str) -> bool {
        self.lost.iter().any(|lost| name.starts_with(lost))
    }

    fn above_zero(&mut self, path: impl Into<ScenePath>, value: f64) {
        if !(value > 0.0 && value.is_finite()) {
            self.push(Diagnostic::error(path, format!("expected a number above 0, found {value}")));
        }
    }

    fn at_least(&mut self, path: impl Into<ScenePath>, value: f64, least: f64) {
        if !(value >= least && value.is_finite()) {
            let message = format!("expected a number of at least {least}, found {value}");
            self.push(Diagnostic::error(path, message));
        }
    }

    fn within(&mut self, path: impl Into<ScenePath>, value: f64, least: f64, most: f64) {
        if !(least..=most).contains(&value) {
            let message = format!("expected a number from {least} to {most}, found {value}");
            self.push(Diagnostic::error(path, message));
        }
    }

    fn finite(&mut self, path: impl Into<ScenePath>, values: &[f64]) {
        if let Some(value) = values.iter().find(|value| !value.is_finite()) {
            let message = format!("expected a finite number, found {value}");
            self.push(Diagnostic::error(path, message));
        }
    }

    fn fraction(&mut self, path: impl Into<ScenePath>, value: f64) {
        if !(0.0..=1.0).contains(&value) {
            let message = format!("expected a fraction from 0 to 1, found {value}");
            let help = if (2.0..=100.0).contains(&value) {
                // Rounded, for 7.0 / 100.0 is 0.07000000000000001.
                format!("write {value} % as {}", (value * 1e4).round() / 1e6)
            } else {
                "it is a share of the light".to_owned()
            };
            self.error(path, message, help);
        }
    }

    /// Warns of a content of leaves that none has; 0 is always lawful.
    fn warn_implausible(
        &mut self,
        path: &ScenePath,
        key: &'static str,
        value: f64,
        low: f64,
        high: f64,
        help: &str,
    ) {
        if value > high || (value > 0.0 && value < low) {
            let message = format!("`{key}` is {value}; real leaves have {low} to {high}");
            self.push(Diagnostic::warning(path.key(key), message).help(help));
        }
    }

    /// Angle from the vertical, below the horizon's 90°.
    fn zenith(&mut self, path: impl Into<ScenePath>, degrees: f64) {
        if !(0.0..=LOWEST_DEG).contains(&degrees) {
            let message =
                format!("expected an angle from the vertical, 0 up to below 90°, found {degrees}");
            let help = if (LOWEST_DEG..90.0).contains(&degrees) {
                format!("write at most {LOWEST_DEG}: what is lower is on the horizon")
            } else if (-90.0..0.0).contains(&degrees) {
                format!("write {} and turn the azimuth by 180°", -degrees)
            } else {
                "0 is overhead, 90 would be the horizon".to_owned()
            };
            self.error(path, message, help);
        }
    }

    fn azimuth(&mut self, path: impl Into<ScenePath>, degrees: f64) {
        if !(-360.0..=360.0).contains(&degrees) {
            let message = format!("expected an azimuth from -360 to 360°, found {degrees}");
            self.error(path, message, "0 is north, 90 east, 180 south, 270 west");
        }
    }

    /// Names that their own definitions give.
    fn own_names<T>(&mut self, key: &'static str, kind: &str, defined: &Map<T>) {
        if defined.contains_key("") {
            self.error(key, format!("{kind} has no name"), "write a name between the quotes");
        }
    }
}

/// Checks that every name is that of a definition, unless definitions could not be read.
fn check_references(scene: &Scene, report: &mut Report<'_>) {
    visit_leaves(scene, &mut |path, leaf| {
        let LeafValue::Reference { target, name } = leaf else { return };
        let is_known = (target.is_defined)(scene, name);
        if !is_known && report.is_readable(target.key) && !report.is_lost(name) {
            let known = (target.names)(scene);
            report.push(unknown_name(path, target.kind, name, known));
        }
    });
}

fn check_transport(transport: &Transport, report: &mut Report<'_>) {
    let kill = transport.roulette.kill;
    if !(0.0..1.0).contains(&kill) {
        let message = format!("expected a probability from 0 up to below 1, found {kill}");
        report.error(["transport", "roulette", "kill"], message, "with 1 no path would go on");
    }
    match transport.max_order {
        Some(0) => {
            let help = "1 is light that was scattered once; leave the key out for all orders";
            report.error(["transport", "max_order"], "no light would count", help);
        }
        Some(order) if order > 1 && transport.first_order_only => {
            let message = format!("`first_order_only` contradicts `max_order: {order}`");
            report.error(["transport", "max_order"], message, "take one of the two out");
        }
        _ => {}
    }
}
