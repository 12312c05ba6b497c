//! Transport systems: which sensor can be measured by which.

use super::super::scene::{ImageMeasure, Photons, Scene, Sensor, System};
use super::{Report, ScenePath};

/// Checks that the transport system of a sensor can measure its quantities.
pub(super) fn check_system(
    path: &ScenePath,
    sensor: &Sensor,
    scene: &Scene,
    report: &mut Report<'_>,
) {
    check_denoised(path, sensor, report);
    let Some(system) = sensor.system() else { return };
    if let Sensor::Photons(Photons { measure, .. }) = sensor
        && system == System::Analog
    {
        let views = measure.iter().position(|measure| !measure.is_measured_by(system));
        if let Some(index) = views {
            let help = "measure cones, such as `BrfCones([(30.0, 90.0, 5.0)])`, or take `system: Analog` out";
            report.error(path.key("measure").index(index), WHOLE, help);
        }
    }
    let measures = sensor.image_measures().unwrap_or_default();
    let refused = measures.iter().enumerate().find_map(|(index, measure)| {
        let is_measured = measure.is_measured_by(system, scene);
        refusal(*measure, system, scene).filter(|_| !is_measured).map(|refusal| (index, refusal))
    });
    if let Some((index, (message, help))) = refused {
        report.error(path.key("measure").index(index), message, help);
    }
    if sensor.systems().contains(&system) {
        return;
    }
    let (message, help) = match (sensor, system) {
        (Sensor::Photons(_), _) => (
            "photons come from the sources of light",
            "write `system: Forward` or `system: Analog`",
        ),
        (Sensor::Perspective(_) | Sensor::Fisheye(_), System::Forward) => (
            "photon packets never meet the one point that this camera looks from",
            "take `system: Forward` out; only orthographic images can be drawn forward",
        ),
        _ => (WHOLE, "take `system: Analog` out; it is for `Photons`"),
    };
    report.error(path.key("system"), message, help);
}

/// Checks that there is something to denoise, whose pixels have independent noise.
fn check_denoised(path: &ScenePath, sensor: &Sensor, report: &mut Report<'_>) {
    let Some(image) = sensor.image_options().filter(|image| image.denoised) else { return };
    let at = path.key("denoised");
    if image.system == System::Forward {
        let message = "a photon packet counts in several pixels, and a filter needs pixels whose noise is independent";
        report.error(at, message, "take `denoised: true` or `system: Forward` out");
    } else if !image.measure.iter().any(ImageMeasure::is_light)
        && report.is_whole(path.key("measure"))
    {
        let message = "what this image measures is not light, which alone is denoised";
        report.error(at, message, "measure `Brf` or `Radiance` too, or take `denoised: true` out");
    }
}

/// Message and help for a measure that a transport system does not estimate; `None` for the first surface along each ray, which paths measure beside it, and where another check reports.
fn refusal(measure: ImageMeasure, system: System, scene: &Scene) -> Option<(String, &'static str)> {
    match system {
        System::FirstOrder => {
            let is_of_all_orders = matches!(measure, ImageMeasure::Brf | ImageMeasure::Radiance)
                && scene.transport.most_orders() > 1;
            Some(if is_of_all_orders {
                (
                    format!(
                        "`{measure:?}` is of light of all orders, and `FirstOrder` measures what was scattered once"
                    ),
                    "write `measure: [Orders]` for `brf_uc` and `brf_co_sgl`, or `transport: (first_order_only: true)`",
                )
            } else {
                (
                    format!("`{measure:?}` is not of light that was scattered once"),
                    "measure `Orders`, or take `system: FirstOrder` out",
                )
            })
        }
        System::Reference
            if !matches!(measure, ImageMeasure::FourComponents | ImageMeasure::GapFraction) =>
        {
            Some((
                format!("`Reference` does not measure `{measure:?}` in this scene"),
                "measure `Brf`, or `Radiance` without emission, or take `system: Reference` out",
            ))
        }
        _ => None,
    }
}

const WHOLE: &str =
    "a photon that is followed as a whole never leaves in the very direction of a view";
