mod images;

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec2;
use hecs::World;

use super::{Resources, set_component};
use crate::components::{
    CountingPlane, DirectionSensor, PhotonProduct, PhotonSensor, ResolvedSensor, TerrainPatch, View,
};
use crate::document::{self, Diagnostic, PhotonMeasure, ScenePath, Sun, Views};

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
/// [`TerrainPatch`]; writes [`ResolvedSensor`].
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
            sensor(&source, &ScenePath::from("sensors").name(name), &place, resources)
        };
        set_component(world, entity, resolved);
    }
}

/// Sensor of a source that the author wrote; `None` after an error.
fn sensor(
    sensor: &document::Sensor,
    path: &ScenePath,
    place: &SensorPlace,
    resources: &mut Resources,
) -> Option<ResolvedSensor> {
    let until = sensor.until().to_vec();
    let plane = resolve_plane(sensor.virtual_plane(), place.corner, place.size);
    Some(match sensor {
        document::Sensor::Orthographic(_)
        | document::Sensor::Perspective(_)
        | document::Sensor::Fisheye(_) => ResolvedSensor::Image(image(sensor, place, resources)?),
        document::Sensor::Directions(directions) => {
            let views = resolve_views(&directions.views, &path.key("views"), place, resources)?;
            let (measure, system) = (directions.measure.clone(), directions.system);
            ResolvedSensor::Directions(DirectionSensor { views, until, measure, plane, system })
        }
        document::Sensor::Photons(photons) => {
            let mut products = Vec::new();
            for (index, source) in photons.measure.iter().enumerate() {
                let at = path.key("measure").index(index);
                products.push(PhotonProduct {
                    measure: source.clone(),
                    views: match source {
                        PhotonMeasure::BrfViews(views) | PhotonMeasure::RadianceViews(views) => {
                            resolve_views(views, &at, place, resources)?
                        }
                        _ => Vec::new(),
                    },
                });
            }
            let (per_area, system) = (photons.per_m2, photons.system);
            ResolvedSensor::Photons(PhotonSensor { per_area, until, products, plane, system })
        }
    })
}

/// Virtual plane; centre and extent are those of the terrain's rectangle if the author wrote none.
pub(super) fn resolve_plane(
    plane: Option<&document::VirtualPlane>,
    corner: DVec2,
    size: DVec2,
) -> Option<CountingPlane> {
    let middle = corner + 0.5 * size;
    plane.map(|plane| CountingPlane {
        center: plane.center_m.map_or(middle, DVec2::from),
        size: plane.size_m.map_or(size, DVec2::from),
        height: plane.height_m,
    })
}

/// Directions of views; `None` after an error.
fn resolve_views(
    views: &Views,
    path: &ScenePath,
    place: &SensorPlace,
    resources: &mut Resources,
) -> Option<Vec<View>> {
    let (max_deg, step_deg, turn) = match views {
        Views::List(list) => {
            return Some(
                list.iter().map(|&(zenith, azimuth)| View::from_degrees(zenith, azimuth)).collect(),
            );
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
