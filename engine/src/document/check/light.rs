//! Sun and sky.

use super::super::scene::{Scene, Sky};
use super::Report;
use super::spectrum::{Quantity, check_band_count, check_spectrum};

pub(super) fn check_sun(scene: &Scene, report: &mut Report<'_>) {
    let Some(sun) = &scene.sun else { return };
    report.zenith("sun.zenith_deg", sun.zenith_deg);
    report.azimuth("sun.azimuth_deg", sun.azimuth_deg);
    check_spectrum("sun.irradiance", &sun.irradiance, Quantity::Irradiance, scene, report);
}

pub(super) fn check_sky(scene: &Scene, report: &mut Report<'_>) {
    let sun_is_known = report.is_readable("sun");
    match &scene.sky {
        Sky::None if scene.sun.is_none() && sun_is_known => {
            let help = "write `sun: (zenith_deg: 30.0)` or `sky: Isotropic(irradiance: ..)`";
            report.error("sky", "nothing lights the scene: it has neither sun nor sky", help);
        }
        Sky::None => {}
        Sky::Fraction(shares) => {
            if scene.sun.is_none() && sun_is_known {
                let message = "`Fraction` is a share of the sun's irradiance, and there is no sun";
                let help =
                    "write `sun: (zenith_deg: 30.0)` too, or `sky: Isotropic(irradiance: ..)`";
                report.error("sky", message, help);
            }
            check_band_count("sky", "Fraction", shares.len(), scene, report);
            for (index, share) in shares.iter().enumerate() {
                report.fraction(&format!("sky[{index}]"), *share);
            }
        }
        Sky::Isotropic { irradiance } => {
            check_spectrum("sky.irradiance", irradiance, Quantity::Irradiance, scene, report);
        }
    }
}
