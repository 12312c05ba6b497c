//! World to [`Stage`]: what this run needs, flat and immutable, and nothing else.

mod inventory;
mod light;
mod stage;
mod thermal;

use std::collections::BTreeMap;
use std::sync::Arc;

use hecs::World;

use crate::accel::{self, Boundary, BuildError, Domain, InstanceInput, MeshInput};
use crate::components::{
    MaterialId, Mesh, Name, PartMaterials, Placement, SceneId, SurfaceOptics, TerrainPatch,
};
use crate::scattering::SurfaceModels;

pub use inventory::{Face, Inventory, Standing};
pub use light::{Beam, Disc, Dome, Light};
pub use stage::{Rules, Stage};
pub use thermal::{SurfaceBlackBody, Thermal};

/// What the document decides beyond entities.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// Number of spectral bands.
    pub bands: usize,
    /// What lies beyond the terrain's rectangle.
    pub boundary: Boundary,
    /// How paths are traced.
    pub rules: Rules,
}

/// Builds the stage of a world. Reads every component; of sensors, whether they ask for the inventory.
///
/// `built` is the geometry of a stage that was extracted from the same meshes, instances and terrain;
/// without it, the ray engine's trees are built.
///
/// Entities are taken in document order, because a `World` has none. Prototypes that nothing
/// instantiates and materials that no used part wears do not reach the stage.
///
/// # Errors
/// A mesh that the ray engine refuses.
///
/// # Panics
/// If the world holds no terrain, or an instance of a prototype that it does not hold: spawning
/// guarantees both.
pub fn extract(
    world: &World,
    setting: &Setting,
    built: Option<Arc<accel::Scene>>,
) -> Result<Stage, BuildError> {
    let mut terrains = world.query::<&TerrainPatch>();
    let terrain = terrains.iter().next().expect("a scene has a terrain");
    let mut placements: Vec<Placement> = world.query::<&Placement>().iter().copied().collect();
    placements.sort_unstable_by_key(|placement| placement.id);
    let used: BTreeMap<u32, u32> = {
        let mut prototypes: Vec<u32> = placements.iter().map(|p| p.prototype.0).collect();
        prototypes.sort_unstable();
        prototypes.dedup();
        // Mesh 0 of the stage is the ground.
        prototypes.into_iter().zip(1..).collect()
    };
    let mut query = world.query::<(&SceneId, &Mesh, &PartMaterials)>();
    let mut prototypes: Vec<_> = query.iter().filter(|(id, ..)| used.contains_key(&id.0)).collect();
    prototypes.sort_unstable_by_key(|&(id, ..)| *id);
    assert_eq!(prototypes.len(), used.len(), "every instance has its prototype");

    let mut surfaces = SurfaceIds::default();
    let ground_surfaces: Vec<u32> = terrain.materials.0.iter().map(|&id| surfaces.id(id)).collect();
    let part_surfaces: Vec<Vec<u32>> = prototypes
        .iter()
        .map(|(_, _, materials)| materials.0.iter().map(|&id| surfaces.id(id)).collect())
        .collect();
    let mut instances = vec![InstanceInput {
        mesh: 0,
        linear: terrain.world_from_object(),
        translation: terrain.origin(),
    }];
    instances.extend(placements.iter().map(|placement| InstanceInput {
        mesh: used[&placement.prototype.0],
        linear: placement.world_from_object(),
        translation: placement.position,
    }));
    let build = || {
        let mut meshes = vec![MeshInput { mesh: &terrain.mesh, surfaces: &ground_surfaces }];
        meshes.extend(
            prototypes
                .iter()
                .zip(&part_surfaces)
                .map(|(&(_, mesh, _), surfaces)| MeshInput { mesh, surfaces }),
        );
        let domain = Domain {
            min: terrain.corner,
            max: terrain.corner + terrain.size,
            boundary: setting.boundary,
        };
        accel::Scene::build(&meshes, &instances, domain)
    };
    let geometry = match built {
        Some(geometry) => geometry,
        None => Arc::new(build()?),
    };
    let (mut models, surface_names) = surfaces.models(world, setting.bands);
    let thermal = Thermal::from_world(world, &surfaces.ordered, &mut models.spectra);
    let light = Light::from_world(world, &mut models.spectra);
    Ok(Stage {
        bands: setting.bands,
        rules: setting.rules,
        corner: terrain.corner,
        size: terrain.size,
        ground: terrain.lowest(),
        mean_ground: terrain.mean_height(),
        has_holes: terrain.has_holes(),
        first_cut: terrain.first_cut,
        periodic: setting.boundary == Boundary::Periodic,
        thermal,
        models,
        surface_names,
        light,
        inventory: Inventory::of(
            world,
            terrain,
            (&placements, &instances),
            &prototypes.iter().map(|&(id, mesh, _)| (id, mesh)).collect::<Vec<_>>(),
        )
        .map(Arc::new),
        geometry,
    })
}

/// Ids of surfaces: materials, numbered in the order in which parts ask for them.
#[derive(Default)]
struct SurfaceIds {
    ids: BTreeMap<MaterialId, u32>,
    ordered: Vec<MaterialId>,
}

impl SurfaceIds {
    fn id(&mut self, material: MaterialId) -> u32 {
        *self.ids.entry(material).or_insert_with(|| {
            self.ordered.push(material);
            self.ordered.len() as u32 - 1
        })
    }

    /// Models and names of the surfaces, in the order of their ids.
    fn models(&self, world: &World, bands: usize) -> (SurfaceModels, Vec<String>) {
        let mut query = world.query::<(&SceneId, &Name, &SurfaceOptics)>();
        let materials: BTreeMap<_, _> =
            query.iter().map(|(id, name, optics)| (MaterialId(id.0), (name, optics))).collect();
        let mut models = SurfaceModels::new(bands);
        let add = |id| {
            let (name, optics): &(&Name, &SurfaceOptics) = &materials[id];
            models.add(optics);
            name.0.clone()
        };
        let names = self.ordered.iter().map(add).collect();
        (models, names)
    }
}
