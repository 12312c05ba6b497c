//! Plain data of the world's entities, one file a subject.
//!
//! Raw components hold what the author wrote: they are types of [`document`](crate::document), which `spawn` copies
//! into the world. Derived components are written by the [`systems`](crate::systems).
//!
//! | entity | raw components | derived components |
//! |---|---|---|
//! | mesh prototype | [`SceneId`], [`Name`], `document::Prototype` | [`Mesh`], [`PartMaterials`], [`MeshBounds`], [`LeafArea`], [`InstanceCount`] |
//! | material | [`SceneId`], [`Name`], `document::Material` | [`SurfaceOptics`], [`BlackBody`] where it emits |
//! | planting (an entry of `instances`) | [`SceneId`], `document::Instances` | [`ShownMeshes`], [`InstanceRange`], [`PlantingAreas`] if it has polygons |
//! | instance | | [`SceneId`], [`PlantingId`], [`PrototypeId`], [`Position`], [`Yaw`], [`Scale`], [`Lean`] if it is not upright |
//! | terrain | `document::Terrain` | [`TerrainPatch`], `Ground`, `MapFrame` |
//! | sun | `document::Sun` | [`SunLight`] |
//! | sky | `document::Sky`, `document::ThermalSky` | [`SkyLight`], [`Emission`] where a sensor measures it |
//! | sensor | [`SceneId`], [`Name`], `document::Sensor` | [`ResolvedSensor`]; `SensorReport` once it has measured |

mod camera;
mod extents;
mod identity;
mod light;
mod mesh;
mod optics;
mod placement;
mod planting;
mod reflectance_map;
mod sensor;
mod terrain;
mod thermal;

pub use camera::{
    CameraPlacement, Channels, FisheyeOptics, FisheyeProjection, Footprint, LookAt, Optics,
    OrthographicOptics, PerspectiveOptics, PictureColours,
};
pub use extents::{InstanceCount, LeafArea, MeshBounds, SceneExtents};
pub use identity::{MaterialId, Name, PlantingId, PrototypeId, SceneId};
pub use light::{SkyLight, SunLight};
pub use mesh::{Disc, Mesh, MeshError, MeshPart, PartMaterials};
pub use optics::{
    DirectionalOptics, EnergyGain, GlossyOptics, LambertianOptics, LeafCoating, RpvParameters,
    SoilspectParameters, SurfaceOptics,
};
pub use placement::{Instance, InstanceQuery, Lean, Placement, Position, Scale, Yaw};
pub use planting::{InstanceRange, PlantingAreas, ShownMeshes};
pub use reflectance_map::{CellLayout, MappedReflectance, ReflectanceCells};
pub use sensor::{
    Cone, CountingPlane, DirectionSensor, ImageMeasure, ImageSamples, ImageSensor, Layers, Per,
    PhotonMeasure, PhotonProduct, PhotonSensor, ResolvedSensor, StopCriterion, System, View,
};
pub use terrain::{Projection, TerrainPatch};
pub use thermal::{BlackBody, Emission};
