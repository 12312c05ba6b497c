mod images;

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec2;
use hecs::World;

use super::{Resources, set_component};
use crate::components::{
    Cone, Directions, ImageMeasure, Layers, Per, PhotonMeasure, Photons, Sensor, StopCriterion,
    System, TerrainPatch, View, VirtualPlane,
};
use crate::document::{self, Diagnostic, Sun, Until, Views};

use images::image;

/// Data of the scene that sensors refer to.
struct SensorPlace {
    /// South-west corner of the terrain's rectangle, m.
    corner: DVec2,
    /// Extent of the terrain's rectangle, m.
    size: DVec2,
    /// Azimuth of the sun, if it is known, degrees.
    sun_azimuth_deg: Option<f64>,
}

/// Resolves sensors: directions of views, virtual planes, units. Reads `document::Sensor`, `document::Sun` and
/// [`TerrainPatch`]; writes [`Sensor`].
pub(super) fn resolve_sensors(world: &mut World, resources: &mut Resources) {
    let place = {
        let patch = world.get::<&TerrainPatch>(resources.terrain);
        let sun = world.get::<&Sun>(resources.sun).ok();
        let (corner, size) =
            patch.map_or((DVec2::ZERO, DVec2::ONE), |patch| (patch.corner, patch.size));
        SensorPlace { corner, size, sun_azimuth_deg: sun.and_then(|sun| sun.known_azimuth_deg()) }
    };
    let sensors: Vec<_> =
        resources.sensors.iter().map(|(name, &entity)| (name.clone(), entity)).collect();
    for (name, entity) in sensors {
        let resolved = {
            let source = world.get::<&document::Sensor>(entity);
            let source = source.expect("`spawn` gives sensors their source");
            sensor(&source, &format!("sensors.{name}"), &place, resources)
        };
        set_component(world, entity, resolved);
    }
}

/// Sensor of a source that the author wrote; `None` after an error.
fn sensor(
    sensor: &document::Sensor,
    path: &str,
    place: &SensorPlace,
    resources: &mut Resources,
) -> Option<Sensor> {
    Some(match sensor {
        document::Sensor::Orthographic(_)
        | document::Sensor::Perspective(_)
        | document::Sensor::Fisheye(_) => Sensor::Image(image(sensor, place, resources)?),
        document::Sensor::Directions(directions) => {
            let plane = directions.virtual_plane.as_ref();
            let path = format!("{path}.views");
            Sensor::Directions(Directions {
                views: resolve_views(&directions.views, &path, place, resources)?,
                until: stop_criteria(sensor),
                measure: image_measures(&directions.measure),
                plane: resolve_plane(plane, place.corner, place.size),
                system: directions.system.map(system_of),
            })
        }
        document::Sensor::Photons(photons) => {
            let mut measures = Vec::new();
            for (index, measure) in photons.measure.iter().enumerate() {
                let at = format!("{path}.measure[{index}]");
                measures.push(match measure {
                    document::PhotonMeasure::BrfCells(cells) => PhotonMeasure::BrfCells(*cells),
                    document::PhotonMeasure::BrfViews(views) => {
                        PhotonMeasure::BrfViews(resolve_views(views, &at, place, resources)?)
                    }
                    document::PhotonMeasure::Albedo => PhotonMeasure::Albedo,
                    document::PhotonMeasure::BrfCones(list) => PhotonMeasure::BrfCones(cones(list)),
                    document::PhotonMeasure::RadianceCells(cells) => {
                        PhotonMeasure::RadianceCells(*cells)
                    }
                    document::PhotonMeasure::RadianceViews(views) => {
                        PhotonMeasure::RadianceViews(resolve_views(views, &at, place, resources)?)
                    }
                    document::PhotonMeasure::RadianceCones(list) => {
                        PhotonMeasure::RadianceCones(cones(list))
                    }
                    document::PhotonMeasure::Exitance => PhotonMeasure::Exitance,
                    document::PhotonMeasure::BrightnessTemperature => {
                        PhotonMeasure::BrightnessTemperature
                    }
                    document::PhotonMeasure::Orders => PhotonMeasure::Orders,
                    document::PhotonMeasure::Absorbed { per } => {
                        let per = match per {
                            document::Per::Instance => Per::Instance,
                            document::Per::Triangle => Per::Triangle,
                        };
                        PhotonMeasure::Absorbed(per)
                    }
                    document::PhotonMeasure::Fapar { layer_m } => {
                        PhotonMeasure::Fapar(match layer_m {
                            document::Layers::Thickness(m) => Layers::Thickness(*m),
                            document::Layers::Borders(m) => Layers::Borders(m.clone()),
                        })
                    }
                    document::PhotonMeasure::Fluxes { pixel_m, heights_m } => {
                        PhotonMeasure::Fluxes { pixel: *pixel_m, heights: heights_m.clone() }
                    }
                });
            }
            let plane = photons.virtual_plane.as_ref();
            Sensor::Photons(Photons {
                per_area: photons.per_m2,
                until: stop_criteria(sensor),
                measure: measures,
                plane: resolve_plane(plane, place.corner, place.size),
                system: system_of(photons.system),
            })
        }
    })
}

/// Virtual plane; centre and extent are those of the terrain's rectangle if the author wrote none.
pub(super) fn resolve_plane(
    plane: Option<&document::VirtualPlane>,
    corner: DVec2,
    size: DVec2,
) -> Option<VirtualPlane> {
    let middle = corner + 0.5 * size;
    plane.map(|plane| VirtualPlane {
        center: plane.center_m.map_or(middle, DVec2::from),
        size: plane.size_m.map_or(size, DVec2::from),
        height: plane.height_m,
    })
}

/// Directions of views; `None` after an error.
fn resolve_views(
    views: &Views,
    path: &str,
    place: &SensorPlace,
    resources: &mut Resources,
) -> Option<Vec<View>> {
    let (max_deg, step_deg, turn) = match views {
        Views::List(list) => {
            return Some(list.iter().map(|&(zenith, azimuth)| view(zenith, azimuth)).collect());
        }
        Views::PrincipalPlane { max_deg, step_deg } => (*max_deg, *step_deg, 0.0),
        Views::CrossPlane { max_deg, step_deg } => (*max_deg, *step_deg, FRAC_PI_2),
    };
    let Some(azimuth) = place.sun_azimuth_deg else {
        resources.report(
            Diagnostic::error(path, "this plane is the sun's, and the scene has no sun")
                .help("write List([(zenith, azimuth), ..]), or give the scene a sun"),
        );
        return None;
    };
    let azimuth = azimuth.to_radians() + turn;
    // From the far side to the sun's, the nadir once; 75 / 0.1 may round to just below 750.
    let steps = (max_deg / step_deg * (1.0 + 1e-12)).floor() as i64;
    Some(
        (-steps..=steps)
            .map(|step| View {
                zenith: (step.abs() as f64 * step_deg).to_radians(),
                azimuth: if step < 0 { azimuth + PI } else { azimuth },
            })
            .collect(),
    )
}

/// Conditions that end a measurement.
pub(super) fn stop_criteria(sensor: &document::Sensor) -> Vec<StopCriterion> {
    let criterion = |end: &Until| match end {
        Until::RelError(limit) => StopCriterion::RelError(*limit),
        Until::RelErrors(limits) => StopCriterion::RelErrors(
            limits.iter().map(|(name, limit)| (name.clone(), *limit)).collect(),
        ),
        Until::Seconds(limit) => StopCriterion::Seconds(*limit),
        Until::Samples(limit) => StopCriterion::Samples(*limit),
    };
    sensor.until().iter().map(criterion).collect()
}

pub(super) fn view(zenith_deg: f64, azimuth_deg: f64) -> View {
    View { zenith: zenith_deg.to_radians(), azimuth: azimuth_deg.to_radians() }
}

fn cones(list: &[(f64, f64, f64)]) -> Vec<Cone> {
    let cone = |&(zenith, azimuth, full): &(f64, f64, f64)| Cone {
        axis: view(zenith, azimuth),
        half_angle: 0.5 * full.to_radians(),
    };
    list.iter().map(cone).collect()
}

pub(super) fn image_measures(measures: &[document::ImageMeasure]) -> Vec<ImageMeasure> {
    measures
        .iter()
        .map(|measure| match measure {
            document::ImageMeasure::Radiance => ImageMeasure::Radiance,
            document::ImageMeasure::Brf => ImageMeasure::Brf,
            document::ImageMeasure::Orders => ImageMeasure::Orders,
            document::ImageMeasure::BrightnessTemperature => ImageMeasure::BrightnessTemperature,
            document::ImageMeasure::FourComponents => ImageMeasure::FourComponents,
            document::ImageMeasure::GapFraction => ImageMeasure::GapFraction,
        })
        .collect()
}

pub(super) fn system_of(system: document::System) -> System {
    match system {
        document::System::Backward => System::Backward,
        document::System::Forward => System::Forward,
        document::System::Analog => System::Analog,
        document::System::FirstOrder => System::FirstOrder,
        document::System::Reference => System::Reference,
    }
}
