//! Entities that are written.

use glam::{DMat3, DVec3};
use hecs::{Ref, World};

use crate::appearance::{MaterialColour, material_colours};
use crate::components::{
    Disc, Instance, InstanceCount, Mesh, MeshPart, Name, PartMaterials, SceneId, TerrainPatch,
};
use crate::run::{Failure, LoadedScene};

/// Coordinates beyond this are written relative to the corner of the ground, m: `f32` has steps of a millimetre there.
const FAR: f64 = 8192.0;

/// A mesh that is placed.
pub(super) struct PlacedMesh<'a> {
    pub(super) name: String,
    pub(super) mesh: Ref<'a, Mesh>,
    pub(super) materials: Ref<'a, PartMaterials>,
    /// Number of the prototype.
    pub(super) prototype: u32,
}

/// Geometry of a scene.
pub(super) struct ExportedScene<'a> {
    /// Meshes with instances, in document order.
    pub(super) meshes: Vec<PlacedMesh<'a>>,
    /// All instances in document order.
    pub(super) instances: Vec<Instance>,
    pub(super) terrain: Ref<'a, TerrainPatch>,
    /// Colours by material id.
    pub(super) colours: Vec<MaterialColour>,
    /// Place in the local frame that written coordinates count from, m.
    pub(super) anchor: DVec3,
    /// Origin of the local frame on the map, m.
    pub(super) origin: DVec3,
    pub(super) is_periodic: bool,
    pub(super) seed: u64,
    /// Keys and values that tell where the file comes from.
    pub(super) provenance: Vec<(&'static str, String)>,
}

impl<'a> ExportedScene<'a> {
    pub(super) fn new(loaded: &'a LoadedScene) -> Result<Self, Failure> {
        let (world, resources) = (&loaded.world.world, &loaded.world.resources);
        let terrain = world.get::<&TerrainPatch>(resources.terrain);
        let terrain = terrain.expect("a loaded scene has a terrain");
        let is_far = terrain.corner.abs().max_element() > FAR;
        let (x, y, z) = resources.frame.origin_m;
        let title = &loaded.scene().title;
        let provenance = vec![
            ("scene", title.split_whitespace().collect::<Vec<_>>().join(" ")),
            ("hash", loaded.hash()?),
            ("version", env!("CARGO_PKG_VERSION").to_owned()),
            ("seed", resources.seed.to_string()),
        ];
        Ok(Self {
            meshes: placed_meshes(loaded),
            instances: Instance::in_order(world),
            colours: material_colours(world, resources),
            anchor: if is_far { terrain.corner.floor().extend(0.0) } else { DVec3::ZERO },
            origin: DVec3::new(x, y, z),
            is_periodic: resources.is_periodic(),
            seed: resources.seed,
            terrain,
            provenance,
        })
    }

    /// Place of a prototype among [`Self::meshes`].
    pub(super) fn mesh_index(&self, prototype: u32) -> usize {
        let found = self.meshes.binary_search_by_key(&prototype, |mesh| mesh.prototype);
        found.expect("every instance has its prototype")
    }

    /// Ground of the scene without the faces along which it is cut: parts of the mesh.
    pub(super) fn ground_parts(&self) -> Vec<MeshPart> {
        let end = self.terrain.first_cut;
        let cut = |part: &MeshPart| {
            let triangles = part.triangles.start.min(end)..part.triangles.end.min(end);
            MeshPart { triangles, ..part.clone() }
        };
        self.terrain.mesh.parts.iter().map(cut).collect()
    }

    /// Number of all triangles, if a disc becomes a polygon of so many sides.
    pub(super) fn triangles(&self, disc_sides: u32) -> u64 {
        let ground: u64 = self.ground_parts().iter().map(|part| part.triangles.len() as u64).sum();
        let of_meshes: Vec<u64> = self
            .meshes
            .iter()
            .map(|placed| {
                let discs = placed.mesh.discs.len() as u64 * u64::from(disc_sides - 2);
                placed.mesh.triangles.len() as u64 + discs
            })
            .collect();
        let index = |one: &Instance| self.mesh_index(one.placement.prototype.0);
        ground + self.instances.iter().map(|one| of_meshes[index(one)]).sum::<u64>()
    }

    /// Line that says what is written of a periodic scene.
    pub(super) fn told_tile(&self) -> Option<String> {
        let what =
            "a periodic scene as its tile: each instance once, where it stands; nothing repeats";
        self.is_periodic.then(|| what.to_owned())
    }
}

fn placed_meshes(loaded: &LoadedScene) -> Vec<PlacedMesh<'_>> {
    let (world, resources): (&World, _) = (&loaded.world.world, &loaded.world.resources);
    let placed = resources.meshes.values().filter_map(|&entity| {
        let count = world.get::<&InstanceCount>(entity).ok()?;
        Some(PlacedMesh {
            name: world.get::<&Name>(entity).ok()?.0.clone(),
            prototype: world.get::<&SceneId>(entity).ok()?.0,
            mesh: world.get::<&Mesh>(entity).ok().filter(|_| count.0 > 0)?,
            materials: world.get::<&PartMaterials>(entity).ok()?,
        })
    });
    placed.collect()
}

/// Corners of a polygon with the area of a disc, counter-clockwise around its normal, m.
pub(super) fn polygon(disc: &Disc, sides: u32) -> impl Iterator<Item = DVec3> + use<> {
    let (u, v) = crate::geometry::basis(disc.normal.as_dvec3());
    let (center, step) = (disc.center.as_dvec3(), std::f64::consts::TAU / f64::from(sides));
    // A polygon with corners at a distance R has the area n R² sin(2π / n) / 2.
    let radius = f64::from(disc.radius) * (step / step.sin()).sqrt();
    (0..sides).map(move |corner| {
        let (sin, cos) = (f64::from(corner) * step).sin_cos();
        center + radius * (cos * u + sin * v)
    })
}

/// Map of a mesh to the world: linear part, and place of its origin, m.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pose {
    pub(super) linear: DMat3,
    pub(super) origin: DVec3,
}

impl Pose {
    /// Coordinates of the mesh itself.
    pub(super) const IDENTITY: Self = Self { linear: DMat3::IDENTITY, origin: DVec3::ZERO };

    pub(super) fn of_instance(instance: &Instance) -> Self {
        let placement = &instance.placement;
        Self { linear: placement.world_from_object(), origin: placement.position }
    }

    pub(super) fn of_ground(terrain: &TerrainPatch) -> Self {
        let linear = DMat3::from_diagonal(terrain.size.extend(terrain.unit));
        Self { linear, origin: terrain.origin() }
    }

    pub(super) fn apply(&self, point: DVec3) -> DVec3 {
        self.origin + self.linear * point
    }
}

/// Range of `u32` as one of `usize`.
pub(super) fn indices(range: &std::ops::Range<u32>) -> std::ops::Range<usize> {
    range.start as usize..range.end as usize
}
