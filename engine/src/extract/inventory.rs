use std::collections::BTreeMap;

use glam::{DMat3, DVec3};
use hecs::World;

use super::InstanceInput;
use crate::components::{
    Instance, Mesh, Name, Per, PhotonMeasure, PhotonProduct, ResolvedSensor, SceneId, TerrainPatch,
};

/// Instances of a scene, for reports of each of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Inventory {
    /// Instances by the id that hits carry, the terrain first.
    pub instances: Vec<PlacedInstance>,
    /// Their meshes, the terrain first; empty unless triangles are reported.
    pub meshes: Vec<Mesh>,
    /// Number of the terrain's triangles that are ground: the rest cuts it out of the earth.
    pub ground: usize,
}

/// Instance with its name and its place.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedInstance {
    /// Name of its mesh, and its number among the instances of this mesh in document order from 0:
    /// `tree[3]`; or `terrain`.
    pub name: String,
    /// Place of its mesh in [`Inventory::meshes`].
    pub mesh: u32,
    /// Linear part of `world_from_object`.
    pub linear: DMat3,
    /// Position of its origin, m, local frame.
    pub origin: DVec3,
}

/// A triangle or a disc of an instance.
#[derive(Clone, Debug, PartialEq)]
pub struct Face {
    /// Corners, m, local frame, counter-clockwise about the front; of a disc eight, of an octagon of
    /// the disc's area.
    pub corners: Vec<DVec3>,
    /// Area, m².
    pub area: f64,
}

impl Inventory {
    /// Inventory of instances, the terrain's first; `meshes` are those after the terrain's.
    pub(super) fn new(
        world: &World,
        terrain: &TerrainPatch,
        placed: &[Instance],
        instances: &[InstanceInput],
        meshes: &[&Mesh],
        per: Per,
    ) -> Self {
        let mut query = world.query::<(&SceneId, &Name, &Mesh)>();
        let names: BTreeMap<u32, &str> =
            query.iter().map(|(id, name, _)| (id.0, name.0.as_str())).collect();
        let mut counts: BTreeMap<u32, u32> = BTreeMap::new();
        let numbered = placed.iter().map(|Instance { placement, .. }| {
            let prototype = placement.prototype;
            let count = counts.entry(prototype.0).or_default();
            *count += 1;
            format!("{}[{}]", names[&prototype.0], *count - 1)
        });
        let names = std::iter::once("terrain".to_owned()).chain(numbered);
        let standing = |(name, one): (String, &InstanceInput)| {
            let InstanceInput { mesh, linear, translation: origin } = *one;
            PlacedInstance { name, mesh, linear, origin }
        };
        let meshes = std::iter::once(&terrain.mesh).chain(meshes.iter().copied());
        let meshes = if per == Per::Triangle { meshes.cloned().collect() } else { Vec::new() };
        Self {
            instances: names.zip(instances).map(standing).collect(),
            meshes,
            ground: terrain.first_cut.min(terrain.mesh.triangles.len() as u32) as usize,
        }
    }

    /// Index of the first primitive of each instance, counted over all instances, and the total number; shape
    /// `[instances + 1]`.
    #[must_use]
    pub fn starts(&self) -> Vec<usize> {
        let mut starts = vec![0];
        let mut end = 0;
        for index in 0..self.instances.len() {
            end += self.faces_of(index);
            starts.push(end);
        }
        starts
    }

    /// Number of triangles and discs of an instance.
    fn faces_of(&self, instance: usize) -> usize {
        if instance == 0 {
            return self.ground;
        }
        let mesh = &self.meshes[self.instances[instance].mesh as usize];
        mesh.triangles.len() + mesh.discs.len()
    }

    /// All triangles and discs, in the order of instances and of the ids that hits carry.
    pub fn faces(&self) -> impl Iterator<Item = Face> + '_ {
        (0..self.instances.len()).flat_map(move |instance| {
            (0..self.faces_of(instance)).map(move |primitive| self.face(instance, primitive))
        })
    }

    fn face(&self, instance: usize, primitive: usize) -> Face {
        let PlacedInstance { mesh, linear, origin, .. } = &self.instances[instance];
        let mesh = &self.meshes[*mesh as usize];
        let corners: Vec<DVec3> = if primitive < mesh.triangles.len() {
            mesh.corners(primitive).iter().map(|corner| corner.as_dvec3()).collect()
        } else {
            octagon(&mesh.discs[primitive - mesh.triangles.len()])
        };
        let mut corners: Vec<DVec3> =
            corners.into_iter().map(|corner| *linear * corner + *origin).collect();
        if linear.determinant() < 0.0 {
            corners.reverse();
        }
        let twice = |pair: &[DVec3]| (pair[0] - corners[0]).cross(pair[1] - corners[0]);
        let area = 0.5 * corners[1..].windows(2).map(twice).sum::<DVec3>().length();
        Face { corners, area }
    }
}

/// Resolution at which sensors report absorbed power, the finest that any asks for; `None` if none does.
pub(super) fn reported_absorption(world: &World) -> Option<Per> {
    let per = |product: &PhotonProduct| match product.measure {
        PhotonMeasure::Absorbed { per } => Some(per),
        _ => None,
    };
    let finest = |sensor: &ResolvedSensor| match sensor {
        ResolvedSensor::Photons(photons) => photons.products.iter().filter_map(per).max(),
        ResolvedSensor::Image(_) | ResolvedSensor::Directions(_) => None,
    };
    world.query::<&ResolvedSensor>().iter().filter_map(finest).max()
}

/// Corners of a regular octagon in place of a disc. That of circumradius `R` has the area
/// `4 R² sin 45°`.
fn octagon(disc: &crate::components::Disc) -> Vec<DVec3> {
    let (u, v) = disc.normal.as_dvec3().normalize_or(DVec3::Z).any_orthonormal_pair();
    let area = std::f64::consts::PI * f64::from(disc.radius).powi(2);
    let radius = (area / (4.0 * std::f64::consts::FRAC_1_SQRT_2)).sqrt();
    let corner = |step: u8| {
        let (sin, cos) = (f64::from(step) * std::f64::consts::FRAC_PI_4).sin_cos();
        disc.center.as_dvec3() + radius * (cos * u + sin * v)
    };
    (0..8).map(corner).collect()
}
