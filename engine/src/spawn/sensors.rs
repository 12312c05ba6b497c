use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec2;
use hecs::World;

use super::Spawner;
use crate::components::{
    Cone, Directions, ImageMeasure, Layers, Mesh, Name, Per, PhotonMeasure, Photons, Placement,
    SceneId, Sensor, Stop, System, TerrainPatch, View, VirtualPlane,
};
use crate::document::{self, Diagnostic, Sun, Until, Views};

/// Memory of the sums of one triangle or instance in one band and all that is made of them, bytes.
const ABSORBED_BYTES: usize = 64;

/// Memory that the sums of what absorbs may take, GiB.
const MOST_GIB: f64 = 2.0;

impl Spawner<'_> {
    /// Spawns the sensors.
    pub(super) fn sensors(&mut self, world: &mut World) {
        let scene = self.scene;
        for (index, (name, sensor)) in scene.sensors.iter().enumerate() {
            let path = format!("sensors.{name}");
            if let Some(sensor) = self.sensor(sensor, &path, world) {
                world.spawn((SceneId(index as u32), Name(name.clone()), sensor));
            }
        }
    }

    fn sensor(&mut self, sensor: &document::Sensor, path: &str, world: &World) -> Option<Sensor> {
        Some(match sensor {
            document::Sensor::Orthographic { .. }
            | document::Sensor::Perspective { .. }
            | document::Sensor::Fisheye { .. } => Sensor::Image(self.image(sensor)?),
            document::Sensor::Directions { views, until: _, measure, virtual_plane, system } => {
                Sensor::Directions(Directions {
                    views: self.views(views, &format!("{path}.views"))?,
                    until: stops(sensor),
                    measure: image_measures(measure),
                    plane: self.plane(virtual_plane.as_ref()),
                    system: system.map(system_of),
                })
            }
            document::Sensor::Photons { per_m2, until: _, measure, virtual_plane, system } => {
                let mut measures = Vec::new();
                for (index, measure) in measure.iter().enumerate() {
                    let at = format!("{path}.measure[{index}]");
                    measures.push(match measure {
                        document::PhotonMeasure::BrfCells(cells) => PhotonMeasure::BrfCells(*cells),
                        document::PhotonMeasure::BrfViews(views) => {
                            PhotonMeasure::BrfViews(self.views(views, &at)?)
                        }
                        document::PhotonMeasure::Albedo => PhotonMeasure::Albedo,
                        document::PhotonMeasure::BrfCones(list) => {
                            PhotonMeasure::BrfCones(cones(list))
                        }
                        document::PhotonMeasure::RadianceCells(cells) => {
                            PhotonMeasure::RadianceCells(*cells)
                        }
                        document::PhotonMeasure::RadianceViews(views) => {
                            PhotonMeasure::RadianceViews(self.views(views, &at)?)
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
                            self.check_absorbed(&at, per, world);
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
                let plane = self.plane(virtual_plane.as_ref());
                let until = stops(sensor);
                let system = system_of(*system);
                let (per_area, measure) = (*per_m2, measures);
                Sensor::Photons(Photons { per_area, until, measure, plane, system })
            }
        })
    }

    /// Whether all that absorbs has a place in memory.
    fn check_absorbed(&mut self, path: &str, per: Per, world: &World) {
        let mut faces: BTreeMap<u32, usize> = BTreeMap::new();
        for (id, mesh) in &mut world.query::<(&SceneId, &Mesh)>() {
            faces.insert(id.0, mesh.triangles.len() + mesh.discs.len());
        }
        let mut grounds = world.query::<&TerrainPatch>();
        let ground = grounds.iter().map(|ground| ground.mesh.triangles.len()).sum();
        let (mut instances, mut triangles): (usize, usize) = (1, ground);
        for placement in &mut world.query::<&Placement>() {
            instances += 1;
            triangles += faces.get(&placement.prototype.0).copied().unwrap_or(0);
        }
        let (count, what, help) = match per {
            Per::Instance => (instances, "instances", "measure `Fapar`, by material"),
            Per::Triangle => (triangles, "triangles", "measure `Absorbed(per: Instance)`"),
        };
        let bands = self.scene.bands.len();
        let gib = (count * bands * ABSORBED_BYTES) as f64 / f64::from(1 << 30);
        if gib > MOST_GIB {
            let message = format!(
                "absorption by {count} {what} in {bands} bands takes {gib:.1} GiB; at most {MOST_GIB} are allowed"
            );
            let help = format!("{help}, or fewer bands or trees");
            self.problems.push(Diagnostic::error(path, message).help(help));
        }
    }

    /// A virtual plane; what its author left out is the terrain's.
    pub(super) fn plane(&self, plane: Option<&document::VirtualPlane>) -> Option<VirtualPlane> {
        let (corner, size) = self.rectangle;
        let middle = corner + 0.5 * size;
        plane.map(|plane| VirtualPlane {
            center: plane.center_m.map_or(middle, DVec2::from),
            size: plane.size_m.map_or(size, DVec2::from),
            height: plane.height_m,
        })
    }

    fn views(&mut self, views: &Views, path: &str) -> Option<Vec<View>> {
        let (max_deg, step_deg, turn) = match views {
            Views::List(list) => {
                return Some(list.iter().map(|&(zenith, azimuth)| view(zenith, azimuth)).collect());
            }
            Views::PrincipalPlane { max_deg, step_deg } => (*max_deg, *step_deg, 0.0),
            Views::CrossPlane { max_deg, step_deg } => (*max_deg, *step_deg, FRAC_PI_2),
        };
        let Some(azimuth) = self.scene.sun.as_ref().and_then(Sun::known_azimuth_deg) else {
            self.problems.push(
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
}

/// What ends a measurement.
pub(super) fn stops(sensor: &document::Sensor) -> Vec<Stop> {
    let stop = |end: &Until| match end {
        Until::RelError(limit) => Stop::RelError(*limit),
        Until::RelErrors(limits) => {
            Stop::RelErrors(limits.iter().map(|(name, limit)| (name.clone(), *limit)).collect())
        }
        Until::Seconds(limit) => Stop::Seconds(*limit),
        Until::Samples(limit) => Stop::Samples(*limit),
    };
    sensor.until().iter().map(stop).collect()
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
    }
}
