//! Sun and sky.

use super::super::scene::{Scene, Sky, Sun};
use super::spectrum::{CheckedQuantity, check_band_count, check_spectrum};
use super::thermal::needs_light;
use super::{Report, ScenePath};

pub(super) fn check_sun(scene: &Scene, report: &mut Report<'_>) {
    let Some(sun) = &scene.sun else { return };
    check_position(sun, scene, report);
    let path = ["sun", "irradiance"].into();
    check_spectrum(&path, &sun.irradiance, CheckedQuantity::Irradiance, scene, report);
}

fn check_position(sun: &Sun, scene: &Scene, report: &mut Report<'_>) {
    report.azimuth(["sun", "azimuth_deg"], sun.azimuth_deg);
    match (&sun.zenith_deg, &sun.position) {
        (Some(zenith), None) => report.zenith(["sun", "zenith_deg"], *zenith),
        (None, Some(_)) if sun.azimuth_deg == 0.0 => {}
        (None, None) if report.is_whole("sun") => {
            let help = "write, for example, `zenith_deg: 30.0`";
            report.error("sun", "nothing says where the sun is", help);
        }
        (None, None) => {}
        _ => {
            let message = "the sun's place is given both by angles and by `position`";
            report.error(["sun", "position"], message, "take one of the two out");
        }
    }
    if sun.position.is_some() && report.is_whole(["sun", "position"]) {
        match sun.placed() {
            Err(problem) => report.push(*problem),
            Ok(_) => scene.night().into_iter().for_each(|night| report.push(night)),
        }
    }
    let disc = sun.disc_deg;
    if !(0.0..=10.0).contains(&disc) {
        let message = format!("expected an angular diameter from 0 to 10°, found {disc}");
        report.error(["sun", "disc_deg"], message, "the real sun has 0.533; 0 is a parallel beam");
    } else if let Some((zenith, _)) = sun.angles_deg()
        && zenith < 90.0
        && zenith + 0.5 * disc >= 90.0
    {
        let message = format!("the horizon cuts the disc of a sun at zenith {zenith}°");
        let help = "raise the sun by half the disc, or write `disc_deg: 0.0`";
        report.error(["sun", "disc_deg"], message, help);
    }
}

pub(super) fn check_sky(scene: &Scene, report: &mut Report<'_>) {
    let sun_is_known = report.is_readable("sun");
    match &scene.sky {
        Sky::None if scene.sun.is_none() && sun_is_known && needs_light(scene) => {
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
            check_band_count(&"sky".into(), "Fraction", shares.len(), scene, report);
            for (index, share) in shares.iter().enumerate() {
                report.fraction(ScenePath::from("sky").index(index), *share);
            }
        }
        Sky::Isotropic { irradiance } => {
            let path = ["sky", "irradiance"].into();
            check_spectrum(&path, irradiance, CheckedQuantity::Irradiance, scene, report);
        }
    }
}
