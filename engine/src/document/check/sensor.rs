//! Sensors.

use std::mem::discriminant;

use super::super::diagnostic::Diagnostic;
use super::super::scene::{
    ImageMeasure, Layers, PhotonMeasure, Scene, Sensor, StopCriterion, Terrain, TerrainPlane, Views,
};
use super::camera::{check_fisheye, check_orthographic, check_perspective};
use super::plane::check_plane;
use super::system::check_system;
use super::thermal::{check_emission, check_photon_emission};
use super::{Report, ScenePath};

/// An image or a map may hold so many values, bands included: 16 GiB as f64.
pub(super) const VALUES: f64 = 2_147_483_648.0;

/// Views that one sensor may have.
const VIEWS: f64 = 100_000.0;

pub(super) fn check_sensors(scene: &Scene, report: &mut Report<'_>) {
    if scene.sensors.is_empty() {
        let help = "write, for example, `sensors: { \"brf\": Directions(views: PrincipalPlane) }`";
        report.error("sensors", "the scene has no sensor: nothing would be measured", help);
    }
    report.own_names("sensors", "a sensor", &scene.sensors);
    for (name, sensor) in &scene.sensors {
        let path = ScenePath::from("sensors").name(name);
        let measure = path.key("measure");
        if let Some(measures) = sensor.image_measures() {
            check_components(&measure, measures, scene, report);
            check_emission(&path, measures, scene, report);
        }
        check_until(&path.key("until"), sensor, report);
        check_system(&path, sensor, scene, report);
        check_plane(&path, sensor.virtual_plane(), scene, report);
        match sensor {
            Sensor::Orthographic(sensor) => {
                check_orthographic(&path, sensor, scene, report);
                check_measures(&measure, &sensor.image.measure, "Brf", report);
            }
            Sensor::Perspective(sensor) => {
                check_perspective(&path, sensor, scene, report);
                check_measures(&measure, &sensor.image.measure, "Radiance", report);
            }
            Sensor::Fisheye(sensor) => {
                check_fisheye(&path, sensor, scene, report);
                check_measures(&measure, &sensor.image.measure, "Radiance", report);
            }
            Sensor::Directions(sensor) => {
                check_views(&path.key("views"), &sensor.views, scene, report);
                check_measures(&measure, &sensor.measure, "Brf", report);
            }
            Sensor::Photons(sensor) => {
                report.above_zero(path.key("per_m2"), sensor.per_m2);
                check_measures(&measure, &sensor.measure, "Albedo", report);
                for (index, one) in sensor.measure.iter().enumerate() {
                    check_photon_measure(&measure.index(index), one, scene, report);
                }
                check_photon_emission(&measure, &sensor.measure, scene, report);
            }
        }
    }
}

fn check_views(path: &ScenePath, views: &Views, scene: &Scene, report: &mut Report<'_>) {
    let (name, max_deg, step_deg) = match views {
        Views::List(views) => {
            if views.is_empty() {
                let help = "write pairs of zenith and azimuth: `List([(30.0, 90.0)])`";
                report.error(path, "the list of views is empty", help);
            }
            for (index, (zenith, azimuth)) in views.iter().enumerate() {
                report.zenith(path.index(index).index(0), *zenith);
                report.azimuth(path.index(index).index(1), *azimuth);
            }
            return;
        }
        Views::PrincipalPlane { max_deg, step_deg } => ("PrincipalPlane", max_deg, step_deg),
        Views::CrossPlane { max_deg, step_deg } => ("CrossPlane", max_deg, step_deg),
    };
    report.zenith(path.key("max_deg"), *max_deg);
    report.above_zero(path.key("step_deg"), *step_deg);
    if *step_deg > 0.0 && 2.0 * max_deg / step_deg > VIEWS {
        let message = format!("steps of {step_deg}° make more than {VIEWS} views");
        report.error(path.key("step_deg"), message, "write a larger step");
    }
    if scene.sun.is_none() && report.is_readable("sun") {
        let message = format!("`{name}` is a plane of the sun, and there is no sun");
        let help = "write the views as pairs of zenith and azimuth: `List([(30.0, 90.0)])`";
        report.error(path, message, help);
    }
}

/// Largest number of samples: at 10⁷ a second they take more than a day.
const MOST_SAMPLES: u64 = 1_000_000_000_000;

fn check_until(path: &ScenePath, sensor: &Sensor, report: &mut Report<'_>) {
    let ends = sensor.until();
    let least = match sensor {
        Sensor::Directions(_) | Sensor::Photons(_) => 32,
        Sensor::Orthographic(_) | Sensor::Perspective(_) | Sensor::Fisheye(_) => 2,
    };
    if ends.is_empty() && sensor.ends().is_some() && report.is_readable(path) {
        report.error(path, "nothing would end the measurement", "write `until: RelError(0.01)`");
    }
    for (index, end) in ends.iter().enumerate() {
        let path = if ends.len() == 1 { path.clone() } else { path.index(index) };
        match end {
            StopCriterion::RelError(error) => check_rel_error(&path, *error, report),
            StopCriterion::RelErrors(errors) => {
                if errors.is_empty() && report.is_whole(&path) {
                    let help = "write `RelErrors({ \"brf\": 0.01 })`, or `RelError(0.01)` for all";
                    report.error(&path, "no product is named", help);
                }
                for (name, error) in errors {
                    check_rel_error(&path.name(name), *error, report);
                }
            }
            StopCriterion::Seconds(seconds) => report.above_zero(path, *seconds),
            StopCriterion::Samples(samples) if *samples < least => {
                let message = format!("expected {least} samples or more, found {samples}");
                report.error(path, message, "fewer give no error estimate");
            }
            StopCriterion::Samples(samples) if *samples > MOST_SAMPLES => {
                let message = format!("expected {MOST_SAMPLES} samples or fewer, found {samples}");
                report.error(path, message, "the first of several ends that holds ends it: `[RelError(0.01), Seconds(60.0)]`");
            }
            StopCriterion::Samples(_) => {}
        }
    }
}

fn check_rel_error(path: &ScenePath, error: f64, report: &mut Report<'_>) {
    if !(error > 0.0 && error < 1.0) {
        let message = format!("expected a relative error above 0 and below 1, found {error}");
        report.error(path, message, "half a percent is `RelError(0.005)`");
    }
}

fn check_photon_measure(
    path: &ScenePath,
    measure: &PhotonMeasure,
    scene: &Scene,
    report: &mut Report<'_>,
) {
    match measure {
        PhotonMeasure::BrfCells(cells) | PhotonMeasure::RadianceCells(cells) => {
            if !(4..=100_000).contains(cells) {
                let message = format!("expected 4 to 100000 cells, found {cells}");
                report.error(path, message, "150 is usual");
            }
        }
        PhotonMeasure::BrfViews(views) | PhotonMeasure::RadianceViews(views) => {
            check_views(path, views, scene, report);
        }
        PhotonMeasure::Albedo
        | PhotonMeasure::Orders
        | PhotonMeasure::Absorbed { .. }
        | PhotonMeasure::Exitance
        | PhotonMeasure::BrightnessTemperature => {}
        PhotonMeasure::BrfCones(cones) | PhotonMeasure::RadianceCones(cones) => {
            check_cones(path, cones, report);
        }
        PhotonMeasure::Fapar { layer_m } => {
            check_layers(&path.key("layer_m"), layer_m, report);
        }
        PhotonMeasure::Fluxes { pixel_m, heights_m } => {
            report.above_zero(path.key("pixel_m"), *pixel_m);
            report.finite(path.key("heights_m"), heights_m);
            if let Terrain::Plane(TerrainPlane { size_m, .. }) = &scene.terrain
                && let Some(problem) = check_maps(path, measure, scene.bands.len(), *size_m)
            {
                report.push(problem);
            }
        }
    }
}

/// Nothing is sunlit without a sun.
fn check_components(
    path: &ScenePath,
    measures: &[ImageMeasure],
    scene: &Scene,
    report: &mut Report<'_>,
) {
    let asked = measures.iter().position(|measure| *measure == ImageMeasure::FourComponents);
    if let Some(index) = asked
        && scene.sun.is_none()
        && report.is_readable("sun")
    {
        let message = "two of the four components are sunlit, and there is no sun";
        let help = "write `sun: (zenith_deg: 30.0)`, or measure `GapFraction` alone";
        report.error(path.index(index), message, help);
    }
}

/// Full angle of the narrowest cone, degrees.
const NARROWEST_DEG: f64 = 1e-3;

fn check_cones(path: &ScenePath, cones: &[(f64, f64, f64)], report: &mut Report<'_>) {
    if cones.is_empty() {
        let help = "write zenith, azimuth and full angle: `[(30.0, 90.0, 5.0)]`";
        report.error(path, "the list of cones is empty", help);
    }
    for (index, (zenith, azimuth, full)) in cones.iter().enumerate() {
        report.zenith(path.index(index).index(0), *zenith);
        report.azimuth(path.index(index).index(1), *azimuth);
        if !(*full >= NARROWEST_DEG && full.is_finite()) {
            let message =
                format!("expected a full angle of at least {NARROWEST_DEG}°, found {full}");
            report.error(path.index(index).index(2), message, "hardly a photon leaves in less");
        }
        if (0.0..90.0).contains(zenith) && zenith + 0.5 * full > 90.0 {
            let message =
                format!("a cone of {full}° about zenith {zenith}° reaches below the horizon");
            let help = format!("write an angle of at most {}", 2.0 * (90.0 - zenith));
            report.error(path.index(index).index(2), message, help);
        }
    }
}

fn check_layers(path: &ScenePath, layers: &Layers, report: &mut Report<'_>) {
    match layers {
        Layers::Thickness(thickness) => report.above_zero(path, *thickness),
        Layers::Borders(borders) => {
            report.finite(path, borders);
            if borders.len() < 2 {
                let help = "write the lower and the upper border: `layer_m: [0.0, 5.0]`";
                report.error(path, "a layer lies between two heights", help);
            }
            for (index, pair) in borders.windows(2).enumerate() {
                if pair[0] >= pair[1] {
                    let message = format!("the border at {} m is not above {} m", pair[1], pair[0]);
                    let help = "write heights upwards, each once";
                    report.error(path.index(index + 1), message, help);
                }
            }
        }
    }
}

/// Checks for at least one measure, each kind once: outputs are named by it.
fn check_measures<T>(path: &ScenePath, measures: &[T], example: &str, report: &mut Report<'_>) {
    if measures.is_empty() && report.is_readable(path) {
        let help = format!("write, for example, `measure: [{example}]`");
        report.error(path, "nothing is measured here", help);
    }
    for (index, measure) in measures.iter().enumerate() {
        let before = measures[..index].iter();
        let repeated = before.enumerate().any(|(earlier, other)| {
            discriminant(other) == discriminant(measure) && report.is_readable(path.index(earlier))
        });
        if repeated {
            let message = "this is measured twice";
            report.error(path.index(index), message, "take one of the two out");
        }
    }
}

/// Checks that maps of fluxes over a scene of this extent, m, are not excessively large.
pub(crate) fn check_maps(
    path: &ScenePath,
    measure: &PhotonMeasure,
    bands: usize,
    (width, height): (f64, f64),
) -> Option<Diagnostic> {
    let PhotonMeasure::Fluxes { pixel_m, heights_m } = measure else { return None };
    let maps = (heights_m.len() + 2) * bands;
    let values = (width / pixel_m).ceil() * (height / pixel_m).ceil() * maps as f64;
    (values > VALUES && *pixel_m > 0.0).then(|| {
        let message = format!("pixels of {pixel_m} m make maps of {values:.0} values");
        Diagnostic::error(path.key("pixel_m"), message)
            .help(format!("write a larger `pixel_m`: at most {VALUES} values"))
    })
}
