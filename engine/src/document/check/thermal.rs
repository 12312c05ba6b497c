//! Temperatures, and what is measured of them.

use super::super::scene::{
    Band, BandSource, ImageMeasure, PhotonMeasure, Scene, Temperature, ThermalSky,
};
use super::range::TEMPERATURE;
use super::spectrum::{CheckedQuantity, check_spectrum};
use super::{Report, ScenePath};

pub(super) fn check_thermal_sky(scene: &Scene, report: &mut Report<'_>) {
    match &scene.thermal_sky {
        ThermalSky::None => {}
        ThermalSky::BlackBody(value) => kelvin(&"thermal_sky".into(), *value, report),
        ThermalSky::Radiance(radiance) => {
            check_spectrum(
                &"thermal_sky".into(),
                radiance,
                CheckedQuantity::Irradiance,
                scene,
                report,
            );
        }
    }
}

pub(super) fn check_temperatures(scene: &Scene, report: &mut Report<'_>) {
    let is_measured = scene.measures_emission();
    for (name, material) in &scene.materials {
        let Some(temperature) = material.temperature() else { continue };
        let path = ScenePath::from("materials").name(name).key("temperature");
        match temperature {
            Temperature::Uniform(value) => kelvin(&path, *value, report),
            Temperature::SunlitShaded { sunlit_k, shaded_k } => {
                kelvin(&path.key("sunlit_k"), *sunlit_k, report);
                kelvin(&path.key("shaded_k"), *shaded_k, report);
            }
            Temperature::MeanDelta { mean_k, delta_k } => {
                kelvin(&path.key("mean_k"), *mean_k, report);
                let (sunlit, shaded) = temperature.sunlit_and_shaded();
                if *mean_k >= 0.0 && !(sunlit >= 0.0 && shaded >= 0.0 && delta_k.is_finite()) {
                    let message = format!("{mean_k} ± {delta_k} / 2 reaches below 0 K");
                    let help = "`delta_k` is the sunlit temperature less the shaded one";
                    report.error(path.key("delta_k"), message, help);
                }
            }
        }
        if is_measured
            && temperature.needs_sun()
            && scene.sun.is_none()
            && report.is_readable("sun")
        {
            let message = "the sun tells sunlit from shaded, and there is no sun";
            let help = "write `sun: (zenith_deg: 30.0)` too, or one `temperature: Uniform(300.0)`";
            report.error(path, message, help);
        }
    }
}

/// Checks that a sensor can measure its emission.
pub(super) fn check_emission(
    path: &ScenePath,
    measures: &[ImageMeasure],
    scene: &Scene,
    report: &mut Report<'_>,
) {
    for (index, measure) in measures.iter().enumerate() {
        if *measure == ImageMeasure::BrightnessTemperature {
            check_band(&path.key("measure").index(index), scene, report);
        }
    }
}

/// Checks that photons can measure their emission.
pub(super) fn check_photon_emission(
    path: &ScenePath,
    measures: &[PhotonMeasure],
    scene: &Scene,
    report: &mut Report<'_>,
) {
    let asked = |measure: &PhotonMeasure| matches!(measure, PhotonMeasure::BrightnessTemperature);
    let Some(index) = measures.iter().position(asked) else { return };
    let at = path.index(index);
    check_band(&at, scene, report);
    if !measures.iter().any(PhotonMeasure::is_radiance) && report.is_whole(path) {
        let message = "a brightness temperature is that of a radiance, and none is measured here";
        report.error(at, message, "write, for example, `RadianceViews(List([(0.0, 0.0)]))` too");
    }
}

/// A band that holds emission.
fn check_band(at: &ScenePath, scene: &Scene, report: &mut Report<'_>) {
    if !scene.bands.iter().any(Band::emits) && report.is_whole("bands") {
        let message = "a brightness temperature is that of emitted radiance, and no band holds any";
        let help = "bands beyond 3000 nm hold it, and those with `source: Emission`";
        report.error(at, message, help);
    }
}

/// Returns whether any sensor measures light of sun and sky: gaps exist in the dark too, emission needs
/// no light, and the four components ask for a sun themselves.
pub(super) fn needs_light(scene: &Scene) -> bool {
    let reflects = scene.bands.iter().any(Band::reflects);
    let of_band = |measure: &ImageMeasure| match measure {
        ImageMeasure::Brf | ImageMeasure::Orders => true,
        ImageMeasure::Radiance => reflects,
        ImageMeasure::BrightnessTemperature => {
            scene.bands.iter().any(|band| band.source == BandSource::Both)
        }
        ImageMeasure::FourComponents | ImageMeasure::GapFraction => false,
    };
    let of_photons = |measure: &PhotonMeasure| match measure {
        PhotonMeasure::BrightnessTemperature | PhotonMeasure::Orders => false,
        measure => reflects || !measure.is_absolute(),
    };
    scene.sensors.is_empty()
        || scene.sensors.values().any(|sensor| sensor.any_measure(of_band, of_photons))
}

/// Temperature below which degrees Celsius may have been meant, K.
const COLD: f64 = 100.0;

fn kelvin(path: &ScenePath, value: f64, report: &mut Report<'_>) {
    if value > 0.0 && value < COLD {
        let message = format!("{value} K is {:.2} °C", value - 273.15);
        let help = format!("temperatures are in kelvins: {value} °C is {:.2} K", value + 273.15);
        report.warning(path, message, help);
    }
    if value > 0.0
        && let Some((message, help)) = TEMPERATURE.problem(value)
    {
        report.error(path, message, help);
    } else if !(value >= 0.0 && value.is_finite()) {
        let message = format!("expected a temperature of at least 0 K, found {value}");
        let help = if (-273.15..0.0).contains(&value) {
            format!("{value} °C is {:.2} K", value + 273.15)
        } else {
            "temperatures are in kelvins: 20 °C is 293.15".to_owned()
        };
        report.error(path, message, help);
    }
}
