//! Plain data of the world's entities, one file a subject.
//!
//! Kinds of entity and what they carry:
//!
//! | entity | components |
//! |---|---|
//! | mesh prototype | [`Name`], [`SceneId`], [`Mesh`], [`PartMaterials`] |
//! | material | [`Name`], [`SceneId`], [`SurfaceOptics`], [`BlackBody`] where it emits |
//! | instance | [`Placement`] (it holds its own scene id: there are millions of them) |
//! | terrain | [`SceneId`], [`TerrainPatch`] |
//! | sun, sky | [`Sun`], [`Sky`] |
//! | emission | [`Emission`], where a sensor measures it |
//! | sensor | [`Name`], [`SceneId`], [`Sensor`] |

mod camera;
mod identity;
mod light;
mod mesh;
mod optics;
mod placement;
mod sensor;
mod terrain;
mod thermal;

pub use camera::{
    Channels, Fisheye, Footprint, Look, Mapping, Optics, Orthographic, Perspective, Picture, Stand,
};
pub use identity::{MaterialId, Name, PrototypeId, SceneId};
pub use light::{Sky, Sun};
pub use mesh::{Disc, Mesh, MeshError, Part, PartMaterials};
pub use optics::{EnergyGain, SurfaceOptics};
pub use placement::Placement;
pub use sensor::{
    Cone, Directions, ImageMeasure, ImageSamples, ImageSensor, Layers, Per, PhotonMeasure, Photons,
    Sensor, Stop, System, View, VirtualPlane,
};
pub use terrain::{Projection, TerrainPatch};
pub use thermal::{BlackBody, Emission};
