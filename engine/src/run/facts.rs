//! Contents of a scene, for its author to check.

use glam::{DVec2, DVec3};
use hecs::World;
use serde::Serialize;

use super::Options;
use super::checkpoint::CheckpointStore;
use super::cost::CostEstimate;
use super::sensors::{Begun, MeasureContext, SensorEntity, begin, in_order};
use crate::accel::Ray;
use crate::components::{
    MaterialId, Name, ResolvedSensor, SceneId, StopCriterion, SunLight, SurfaceOptics, TerrainPatch,
};
use crate::counts::counted;
use crate::document::{self, Diagnostic, PhotonMeasure, Scene, ScenePath};
use crate::extract::Stage;
use crate::products::{BandSources, Context};
use crate::queries::{HeightHistogram, MeshStatistics, plant_statistics};
use crate::sampling::Key;

/// Vertical rays along each side of the grid that canopy cover is found with.
const COVER_RAYS: u32 = 64;
/// Square metres of a hectare.
const HECTARE: f64 = 1e4;

/// Contents of a scene.
#[derive(Clone, Debug, Serialize)]
pub struct SceneFacts {
    /// Title of the scene.
    pub title: String,
    /// Hash of the resolved scene and of all files that it reads, as in results of a run, hexadecimal.
    pub hash: String,
    /// The ground.
    pub ground: GroundFacts,
    /// Meshes that stand on it, in the order of the scene.
    pub meshes: Vec<MeshFacts>,
    /// Number of instances.
    pub instances: u64,
    /// Triangles and discs of all instances and of the ground.
    pub faces: u64,
    /// Triangles and discs that are kept in memory.
    pub unique_faces: u64,
    /// Heights of all instances; none without any.
    pub heights: Option<HeightFacts>,
    /// Height of the highest point, m, local frame.
    pub highest_m: f64,
    /// One-sided area of surfaces of `Leaf` materials per area of the ground's rectangle.
    pub leaf_area_index: f64,
    /// Fraction of the ground that is hidden from above.
    pub canopy_cover: f64,
    /// Standard error of the canopy cover.
    pub canopy_cover_error: f64,
    /// The sun, if there is one.
    pub sun: Option<SunFacts>,
    /// Spectral bands.
    pub bands: Vec<BandFacts>,
    /// Sensors.
    pub sensors: Vec<SensorFacts>,
    /// Memory of the geometry, bytes.
    pub geometry_bytes: u64,
}

/// The ground.
#[derive(Clone, Debug, Serialize)]
pub struct GroundFacts {
    /// South-west corner, m, local frame.
    pub corner_m: [f64; 2],
    /// Extent to the east and to the north, m.
    pub size_m: [f64; 2],
    /// Easting, northing and height of the local frame's origin on the map, m.
    pub origin_m: [f64; 3],
    /// Projection of the map, if a raster names one.
    pub projection: Option<String>,
    /// Height of the lowest ground, m, local frame.
    pub lowest_m: f64,
    /// Height of the highest ground, m, local frame.
    pub highest_m: f64,
    /// Number of triangles.
    pub triangles: u64,
    /// True if the rectangle repeats without end.
    pub periodic: bool,
}

/// A mesh and its instances.
#[derive(Clone, Debug, Serialize)]
pub struct MeshFacts {
    /// Name of the mesh.
    pub name: String,
    /// Number of instances.
    pub instances: u64,
    /// Instances per hectare of the ground's rectangle.
    pub per_hectare: f64,
    /// Triangles and discs of one.
    pub faces: u64,
    /// Triangles of one.
    pub triangles: u64,
    /// Discs of one.
    pub discs: u64,
    /// Mean height of the instances, m.
    pub height_m: f64,
    /// Height of the lowest instance, m.
    pub lowest_m: f64,
    /// Height of the highest instance, m.
    pub highest_m: f64,
    /// Mean one-sided area of an instance's surfaces of `Leaf` materials, m².
    pub leaf_area_m2: f64,
    /// Contribution of the instances to the leaf area index of the scene.
    pub leaf_area_index: f64,
}

/// Heights of all instances, each the vertical extent of its mesh times its vertical scale.
#[derive(Clone, Debug, Serialize)]
pub struct HeightFacts {
    /// Height of the lowest instance, m.
    pub lowest_m: f64,
    /// Mean height, m.
    pub mean_m: f64,
    /// Height of the highest instance, m.
    pub highest_m: f64,
    /// Lower end of the first class of the histogram, m.
    pub first_class_m: f64,
    /// Width of a class, m.
    pub class_m: f64,
    /// Number of instances in each class.
    pub counts: Vec<u64>,
}

/// Position of the sun.
#[derive(Clone, Debug, Serialize)]
pub struct SunFacts {
    /// Angle from the vertical, degrees.
    pub zenith_deg: f64,
    /// Clockwise from north, degrees.
    pub azimuth_deg: f64,
    /// True if the angles follow from place and time.
    pub from_place_and_time: bool,
}

/// A spectral band.
#[derive(Clone, Debug, Serialize)]
pub struct BandFacts {
    /// Name.
    pub name: String,
    /// Centre wavelength, nm.
    pub center_nm: f64,
    /// Width, nm.
    pub width_nm: f64,
    /// Irradiance of the horizontal plane by sun and sky, W m⁻² nm⁻¹.
    pub irradiance: f64,
    /// Fraction of it that the sky gives.
    pub diffuse_fraction: f64,
    /// True if it holds what surfaces emit.
    pub emits: bool,
}

/// A sensor.
#[derive(Clone, Debug, Serialize)]
pub struct SensorFacts {
    /// Name.
    pub name: String,
    /// Kind in the scene language.
    pub kind: &'static str,
    /// Quantities that it measures.
    pub measures: Vec<String>,
    /// Number of pixels or views; none of photons.
    pub pixels: Option<u64>,
    /// Paths or photon packets that it traces, where that is fixed.
    pub samples: Option<u64>,
    /// Criterion that ends it.
    pub ends: String,
    /// Memory of the measurement, bytes.
    pub memory_bytes: u64,
}

impl SceneFacts {
    /// Facts of a scene and its stage.
    pub(super) fn new(
        scene: &Scene,
        world: &World,
        measured: MeasureContext<'_>,
        options: &Options,
        hash: String,
    ) -> Self {
        let stage = measured.stage;
        let ground = ground(scene, world);
        let area = ground.size_m[0] * ground.size_m[1];
        let plants = plant_statistics(world);
        let meshes: Vec<MeshFacts> =
            plants.meshes.iter().map(|mesh| mesh_facts(mesh, area)).collect();
        let memory = stage.geometry.memory();
        let (canopy_cover, canopy_cover_error) = canopy_cover(stage);
        Self {
            title: scene.title.clone(),
            hash,
            instances: meshes.iter().map(|mesh| mesh.instances).sum(),
            faces: ground.triangles
                + meshes.iter().map(|mesh| mesh.instances * mesh.faces).sum::<u64>(),
            unique_faces: memory.primitives as u64,
            heights: plants.heights.as_ref().map(height_facts),
            highest_m: stage.top(),
            leaf_area_index: meshes.iter().map(|mesh| mesh.leaf_area_index).sum(),
            canopy_cover,
            canopy_cover_error,
            sun: sun(scene),
            bands: bands(measured.context, world, stage),
            sensors: sensor_facts(scene, world, measured, options),
            geometry_bytes: (memory.mesh_bytes + memory.instance_bytes) as u64,
            ground,
            meshes,
        }
    }
}

/// Reflectance of fresh snow, which no ground exceeds.
const SNOW: f32 = 0.9;
/// Wavelength beyond which surfaces are not known by their brightness, nm.
const VISIBLE_END: f64 = 1100.0;

/// Warns of ground that is brighter than fresh snow.
pub(super) fn warn_bright_ground(context: &Context, world: &World) -> Vec<Diagnostic> {
    let ground: Vec<MaterialId> =
        world.query::<&TerrainPatch>().iter().flat_map(|patch| patch.materials.0.clone()).collect();
    let mut surfaces = world.query::<(&SceneId, &Name, &SurfaceOptics)>();
    let warning = |(id, name, optics): (&SceneId, &Name, &SurfaceOptics)| {
        if !ground.contains(&MaterialId(id.0)) {
            return None;
        }
        let bands = context.bands.iter().zip(&context.sources).zip(optics.lambertian()?.front());
        let bright = bands.filter(|((_, source), _)| source.center_nm < VISIBLE_END);
        let ((band, _), reflectance) = bright.max_by(|a, b| a.1.total_cmp(b.1))?;
        (*reflectance > SNOW).then(|| {
            let message = format!(
                "the ground reflects {:.1} % in band `{band}`: more than fresh snow",
                100.0 * reflectance
            );
            let help = "soil reflects 5 to 40 %: is the spectrum right, and no white reference?";
            Diagnostic::warning(ScenePath::from("materials").name(&name.0), message).help(help)
        })
    };
    surfaces.iter().filter_map(warning).collect()
}

fn ground(scene: &Scene, world: &World) -> GroundFacts {
    let mut patches = world.query::<&TerrainPatch>();
    let patch = patches.iter().next().expect("a scene has a terrain");
    let (x, y, z) = scene.frame.origin_m;
    GroundFacts {
        corner_m: patch.corner.to_array(),
        size_m: patch.size.to_array(),
        origin_m: [x, y, z],
        projection: patch.projection.as_ref().map(|map| format!("{}, {}", map.name, map.rest)),
        lowest_m: patch.lowest(),
        highest_m: patch.highest(),
        triangles: u64::from(patch.first_cut),
        periodic: scene.boundary == document::Boundary::Periodic,
    }
}

fn mesh_facts(mesh: &MeshStatistics, area: f64) -> MeshFacts {
    let MeshStatistics { name, instances, triangles, discs, height, leaf_area } = mesh;
    let count = (*instances as f64).max(1.0);
    MeshFacts {
        name: name.clone(),
        instances: *instances,
        per_hectare: *instances as f64 / area * HECTARE,
        faces: triangles + discs,
        triangles: *triangles,
        discs: *discs,
        height_m: height.mean,
        lowest_m: height.least,
        highest_m: height.most,
        leaf_area_m2: leaf_area / count,
        leaf_area_index: leaf_area / area,
    }
}

fn height_facts(histogram: &HeightHistogram) -> HeightFacts {
    let HeightHistogram { span, start, step, counts } = histogram;
    HeightFacts {
        lowest_m: span.least,
        mean_m: span.mean,
        highest_m: span.most,
        first_class_m: *start,
        class_m: *step,
        counts: counts.clone(),
    }
}

/// Fraction of vertical rays that meet something above the ground, and its standard error.
fn canopy_cover(stage: &Stage) -> (f64, f64) {
    let key = Key::new(stage.rules.seed).path("canopy cover");
    let count = COVER_RAYS * COVER_RAYS;
    let top = stage.top() + 1.0;
    let is_covered = |index: u32| {
        let jitter = key.index(index.into());
        let cell = DVec2::new(f64::from(index % COVER_RAYS), f64::from(index / COVER_RAYS));
        let at = cell + DVec2::new(jitter.uniform(0), jitter.uniform(1));
        let origin = (stage.corner + stage.size * at / f64::from(COVER_RAYS)).extend(top);
        let ray = Ray { origin, direction: DVec3::NEG_Z, from: None };
        stage.geometry.closest(&ray).is_some_and(|hit| !stage.is_ground(&hit))
    };
    let covered = (0..count).filter(|&index| is_covered(index)).count() as f64;
    let fraction = covered / f64::from(count);
    (fraction, (fraction * (1.0 - fraction) / f64::from(count)).sqrt())
}

fn sun(scene: &Scene) -> Option<SunFacts> {
    let sun = scene.sun.as_ref()?;
    let (zenith_deg, azimuth_deg) = sun.angles_deg()?;
    Some(SunFacts { zenith_deg, azimuth_deg, from_place_and_time: sun.position.is_some() })
}

fn bands(context: &Context, world: &World, stage: &Stage) -> Vec<BandFacts> {
    let mut suns = world.query::<&SunLight>();
    let sun = suns.iter().next();
    let facts = |(index, (name, source)): (usize, (&String, &BandSources))| {
        let irradiance = stage.light.irradiance[index];
        let direct = sun.map_or(0.0, |sun| sun.irradiance[index] * sun.direction.z);
        BandFacts {
            name: name.clone(),
            center_nm: source.center_nm,
            width_nm: source.response.width(),
            irradiance,
            diffuse_fraction: if irradiance > 0.0 {
                (1.0 - direct / irradiance).max(0.0)
            } else {
                0.0
            },
            emits: source.emits,
        }
    };
    context.bands.iter().zip(&context.sources).enumerate().map(facts).collect()
}

fn sensor_facts(
    scene: &Scene,
    world: &World,
    measured: MeasureContext<'_>,
    options: &Options,
) -> Vec<SensorFacts> {
    let facts = |SensorEntity { name, sensor, .. }: &SensorEntity| {
        let Begun { mut measurement, convergence } = begin(name, sensor, measured, options.quality);
        let pixels = match sensor {
            ResolvedSensor::Image(image) => Some(u64::from(image.size.x) * u64::from(image.size.y)),
            ResolvedSensor::Directions(directions) => Some(directions.views.len() as u64),
            ResolvedSensor::Photons(_) => None,
        };
        let limit = convergence.until.iter().find_map(|stop| match stop {
            StopCriterion::Samples(samples) => Some(samples.saturating_mul(pixels.unwrap_or(1))),
            _ => None,
        });
        let (kind, measures) = scene.sensors.get(name.as_str()).map(describe).unwrap_or_default();
        SensorFacts {
            name: name.clone(),
            kind,
            measures,
            pixels,
            samples: limit,
            ends: convergence.until.iter().map(ends).collect::<Vec<_>>().join(" or "),
            memory_bytes: CostEstimate::new(
                measurement.as_mut(),
                &CheckpointStore::disabled(),
                &scene.output,
            )
            .memory(),
        }
    };
    in_order(world).iter().map(facts).collect()
}

/// Kind and measures of a sensor as the scene names them.
fn describe(sensor: &document::Sensor) -> (&'static str, Vec<String>) {
    let kind = match sensor {
        document::Sensor::Orthographic(_) => "Orthographic",
        document::Sensor::Perspective(_) => "Perspective",
        document::Sensor::Fisheye(_) => "Fisheye",
        document::Sensor::Directions(_) => "Directions",
        document::Sensor::Photons(_) => "Photons",
    };
    let name_of = |measure: &PhotonMeasure| {
        let text = format!("{measure:?}");
        text.split(|letter: char| !letter.is_alphanumeric()).next().unwrap_or_default().to_owned()
    };
    let measures = match sensor {
        document::Sensor::Photons(photons) => photons.measure.iter().map(name_of).collect(),
        other => {
            let measures = other.image_measures().into_iter().flatten();
            measures.map(|measure| format!("{measure:?}")).collect()
        }
    };
    (kind, measures)
}

fn ends(stop: &StopCriterion) -> String {
    match stop {
        StopCriterion::RelError(limit) => format!("relative error {limit:?}"),
        StopCriterion::RelErrors(limits) => {
            let texts = limits.iter().map(|(name, limit)| format!("{name} {limit:?}"));
            format!("relative error of {}", texts.collect::<Vec<_>>().join(", "))
        }
        StopCriterion::Seconds(limit) => format!("{limit:?} s"),
        StopCriterion::Samples(limit) => counted(limit, "sample"),
    }
}
