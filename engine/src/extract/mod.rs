//! World to [`Stage`]: what this run needs, flat and immutable, and nothing else.

mod light;
mod stage;
mod thermal;

use std::collections::BTreeMap;

use glam::{DMat3, DVec2, DVec3, Vec3};
use hecs::World;

use crate::accel::{self, Boundary, BuildError, Domain, InstanceInput, MeshInput};
use crate::components::{
    MaterialId, Mesh, Name, Part, PartMaterials, Placement, SceneId, SurfaceOptics, TerrainPatch,
};
use crate::scattering::{BiLambertian, Bsdf};

pub use light::{Beam, Disc, Dome, Light};
pub use stage::{Rules, Stage, Surface};
pub use thermal::{Thermal, Warmth};

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

/// Builds the stage of a world. Reads every component but those of sensors.
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
pub fn extract(world: &World, setting: &Setting) -> Result<Stage, BuildError> {
    let terrain = *world.query::<&TerrainPatch>().iter().next().expect("a scene has a terrain");
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

    let mut surfaces = Surfaces::new(world, terrain.material);
    let ground = ground();
    let ground_surfaces = [surfaces.id(terrain.material)];
    let part_surfaces: Vec<Vec<u32>> = prototypes
        .iter()
        .map(|(_, _, materials)| materials.0.iter().map(|&id| surfaces.id(id)).collect())
        .collect();
    let mut meshes = vec![MeshInput { mesh: &ground, surfaces: &ground_surfaces }];
    meshes.extend(
        prototypes
            .iter()
            .zip(&part_surfaces)
            .map(|(&(_, mesh, _), surfaces)| MeshInput { mesh, surfaces }),
    );
    let mut instances = vec![InstanceInput {
        mesh: 0,
        linear: DMat3::from_diagonal(terrain.size.extend(1.0)),
        translation: terrain.corner.extend(terrain.height),
    }];
    instances.extend(placements.iter().map(|placement| InstanceInput {
        mesh: used[&placement.prototype.0],
        linear: placement.world_from_object(),
        translation: placement.position,
    }));
    let domain = Domain {
        min: terrain.corner,
        max: terrain.corner + terrain.size,
        boundary: setting.boundary,
    };
    let geometry = accel::Scene::build(&meshes, &instances, domain)?;
    Ok(Stage {
        bands: setting.bands,
        rules: setting.rules,
        corner: terrain.corner,
        size: terrain.size,
        ground: terrain.height,
        periodic: setting.boundary == Boundary::Periodic,
        thermal: Thermal::of(world, &surfaces.ordered),
        surfaces: surfaces.finish(),
        light: Light::of(world, setting.bands),
        geometry,
    })
}

/// Unit square at height 0; its instance scales it exactly to the terrain's rectangle.
fn ground() -> Mesh {
    let corners = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
    Mesh {
        vertices: corners.map(|c| DVec3::from((c, 0.0)).as_vec3()).map(Vec3::from).to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        discs: Vec::new(),
        parts: vec![Part { name: "ground".to_owned(), triangles: 0..2, discs: 0..0 }],
    }
}

/// Surfaces of the stage, numbered as they are first asked for.
struct Surfaces {
    known: BTreeMap<MaterialId, Surface>,
    ids: BTreeMap<MaterialId, u32>,
    ordered: Vec<MaterialId>,
}

impl Surfaces {
    fn new(world: &World, ground: MaterialId) -> Self {
        let known = world
            .query::<(&SceneId, &Name, &SurfaceOptics)>()
            .iter()
            .map(|(id, name, optics)| {
                let bsdf = Bsdf::BiLambertian(BiLambertian::new(optics));
                (MaterialId(id.0), Surface { name: name.0.clone(), bsdf })
            })
            .collect();
        let mut surfaces = Self { known, ids: BTreeMap::new(), ordered: Vec::new() };
        surfaces.id(ground);
        surfaces
    }

    fn id(&mut self, material: MaterialId) -> u32 {
        *self.ids.entry(material).or_insert_with(|| {
            self.ordered.push(material);
            self.ordered.len() as u32 - 1
        })
    }

    fn finish(mut self) -> Vec<Surface> {
        self.ordered
            .iter()
            .map(|id| self.known.remove(id).expect("every part has its material"))
            .collect()
    }
}
