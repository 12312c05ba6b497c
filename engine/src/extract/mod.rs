//! World to [`Stage`]: the data that a run needs, flat and immutable.

mod inventory;
mod light;
mod optics;
mod stage;
mod thermal;

use std::collections::BTreeMap;
use std::sync::Arc;

use hecs::World;
use rayon::prelude::*;

use crate::accel::{BuildError, Domain, InstanceInput, MeshInput, TwoLevelBvh};
use crate::components::{Instance, MaterialId, Mesh, PartMaterials, SceneId, TerrainPatch};
use crate::scattering::SurfaceModels;

use inventory::reported_absorption;

pub use inventory::{Face, Inventory, PlacedInstance};
pub use light::{Beam, DiscPoint, Dome, Light, SunDisc};
pub use optics::SceneOptics;
pub use stage::{Rules, Stage};
pub use thermal::{SurfaceBlackBody, Thermal};

/// Settings of a scene that belong to no entity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// `true` if the terrain's rectangle repeats without end.
    pub is_periodic: bool,
    /// Rules of transport.
    pub rules: Rules,
}

/// Extracts the stage of a world. Reads all derived components but those of the optics, which may be those of
/// several scenes, joined.
///
/// `built` is the ray engine of the same meshes, instances and terrain; without it, it is built.
///
/// Entities are sorted by document order, because a `World` has none. Prototypes without instances and materials
/// without surfaces are left out.
///
/// # Errors
/// A mesh that the ray engine refuses.
///
/// # Panics
/// If the world holds no terrain, or an instance of a prototype that it does not hold: spawning
/// guarantees both.
pub fn extract(
    world: &World,
    optics: &SceneOptics,
    setting: &Setting,
    built: Option<Arc<TwoLevelBvh>>,
) -> Result<Stage, BuildError> {
    let mut terrains = world.query::<&TerrainPatch>();
    let terrain = terrains.iter().next().expect("a scene has a terrain");
    let placed = Instance::in_order(world);
    let mesh_of = mesh_numbers(&placed);
    let mut query = world.query::<(&SceneId, &Mesh, &PartMaterials)>();
    let mut prototypes: Vec<_> =
        query.iter().filter(|(id, ..)| mesh_of.contains_key(&id.0)).collect();
    prototypes.sort_unstable_by_key(|&(id, ..)| *id);
    assert_eq!(prototypes.len(), mesh_of.len(), "every instance has its prototype");

    let mut surfaces = SurfaceIds::default();
    let ground_surfaces = surfaces.of_parts(&terrain.materials);
    let part_surfaces: Vec<Vec<u32>> =
        prototypes.iter().map(|(_, _, materials)| surfaces.of_parts(materials)).collect();
    let geometry = if let Some(geometry) = built {
        geometry
    } else {
        let of_parts = prototypes.iter().zip(&part_surfaces);
        let ground = MeshInput { mesh: &terrain.mesh, surfaces: &ground_surfaces };
        let meshes: Vec<MeshInput<'_>> = std::iter::once(ground)
            .chain(of_parts.map(|(&(_, mesh, _), surfaces)| MeshInput { mesh, surfaces }))
            .collect();
        let (min, max) = (terrain.corner, terrain.corner + terrain.size);
        let domain = Domain { min, max, is_periodic: setting.is_periodic };
        // Takes the placements, so that their memory is free before the hierarchy is built.
        let instances = instance_inputs(terrain, placed, &mesh_of);
        Arc::new(TwoLevelBvh::build(&meshes, instances, domain)?)
    };
    let meshes: Vec<_> = prototypes.iter().map(|&(_, mesh, _)| mesh).collect();
    let inventory = inventory(world, terrain, &meshes, &mesh_of);
    let (mut models, surface_names) = surfaces.models(optics);
    let thermal = Thermal::new(optics, &surfaces.ordered, &mut models.spectra);
    let light = Light::new(optics, &mut models.spectra);
    models.choose_representatives();
    Ok(Stage {
        bands: optics.bands,
        rules: setting.rules,
        corner: terrain.corner,
        size: terrain.size,
        ground: terrain.lowest(),
        mean_ground: terrain.mean_height(),
        has_holes: terrain.has_holes(),
        first_cut: terrain.first_cut,
        periodic: setting.is_periodic,
        thermal,
        models,
        surface_names,
        light,
        inventory,
        keeps_coefficients: false,
        geometry,
    })
}

/// Instances and their faces, where a sensor reports what each absorbs.
fn inventory(
    world: &World,
    terrain: &TerrainPatch,
    meshes: &[&Mesh],
    mesh_of: &BTreeMap<u32, u32>,
) -> Option<Arc<Inventory>> {
    let per = reported_absorption(world)?;
    let placed = Instance::in_order(world);
    let instances: Vec<_> = instance_inputs(terrain, placed.clone(), mesh_of).collect();
    Some(Arc::new(Inventory::new(world, terrain, &placed, &instances, meshes, per)))
}

/// Number of the stage's mesh for each prototype that has instances; mesh 0 is the ground.
fn mesh_numbers(placed: &[Instance]) -> BTreeMap<u32, u32> {
    let mut prototypes: Vec<u32> = placed.iter().map(|one| one.placement.prototype.0).collect();
    prototypes.sort_unstable();
    prototypes.dedup();
    prototypes.into_iter().zip(1..).collect()
}

/// Transformations of the ground and of all instances.
fn instance_inputs(
    terrain: &TerrainPatch,
    placed: Vec<Instance>,
    mesh_of: &BTreeMap<u32, u32>,
) -> impl IndexedParallelIterator<Item = InstanceInput> {
    let ground = InstanceInput {
        mesh: 0,
        linear: terrain.world_from_object(),
        translation: terrain.origin(),
    };
    let trees = placed.into_par_iter().map(|Instance { placement, .. }| InstanceInput {
        mesh: mesh_of[&placement.prototype.0],
        linear: placement.world_from_object(),
        translation: placement.position,
    });
    rayon::iter::once(ground).chain(trees)
}

/// Ids of surfaces: materials, numbered in the order in which parts ask for them.
#[derive(Default)]
struct SurfaceIds {
    ids: BTreeMap<MaterialId, u32>,
    ordered: Vec<MaterialId>,
}

impl SurfaceIds {
    /// Surface of each part of a mesh.
    fn of_parts(&mut self, materials: &PartMaterials) -> Vec<u32> {
        materials.0.iter().map(|&id| self.id(id)).collect()
    }

    fn id(&mut self, material: MaterialId) -> u32 {
        *self.ids.entry(material).or_insert_with(|| {
            self.ordered.push(material);
            self.ordered.len() as u32 - 1
        })
    }

    /// Models and names of the surfaces, in the order of their ids.
    fn models(&self, optics: &SceneOptics) -> (SurfaceModels, Vec<String>) {
        let mut models = SurfaceModels::new(optics.bands);
        let add = |id| {
            let material = &optics.materials[id];
            models.add(&material.surface);
            material.name.clone()
        };
        let names = self.ordered.iter().map(add).collect();
        (models, names)
    }
}
