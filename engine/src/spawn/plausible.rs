//! Warns of quantities that no forest has: units or decimal points that went wrong.

use std::collections::BTreeMap;

use super::Spawner;
use super::meshes::Prototype;
use crate::components::{Placement, TerrainPatch};
use crate::document::{Diagnostic, Material, Mesh, Terrain};

/// Leaf area over the area of a plant's outline from above; crowns of trees have 2 to 15.
const LEAF_AREA_OF_PLANT: f64 = 40.0;
/// Leaf area over that area from which on a ray meets so many leaves that it takes a second.
const OVERLAID: f64 = 1e4;
/// Leaf area index of a stand; the densest forests have 15 to 20.
const LEAF_AREA_OF_STAND: f64 = 25.0;
/// Plants per hectare of at least [`TREE`], m; a thicket of young trees has 50 000.
const STEMS: f64 = 1e5;
const TREE: f64 = 2.0;

/// Height that no plant reaches, m.
pub(super) const TALLEST: f64 = 200.0;

/// Sums over the instances of a mesh.
struct Plants {
    name: String,
    count: u64,
    /// One-sided leaf area of one plant and of all, m².
    leaf_area: f64,
    all: f64,
    /// Height of the highest plant, m.
    tallest: f64,
    /// Width, depth and height of the mesh, m.
    size: glam::DVec3,
}

impl Spawner<'_> {
    /// Warns of leaf areas and numbers of stems that are beyond any plant or stand.
    pub(super) fn warn_implausible_plants(
        &mut self,
        placements: &[Placement],
        meshes: &BTreeMap<u32, Prototype>,
        area: f64,
    ) {
        let plants: Vec<Plants> = self.plants(placements, meshes);
        for plant in &plants {
            let footprint = plant.size.x * plant.size.y;
            let index = plant.leaf_area / footprint;
            if footprint > 0.0 && index > LEAF_AREA_OF_PLANT {
                let message = format!(
                    "`{}` holds {} m² of leaves over {} m²: a leaf area index of {index:.0}",
                    plant.name,
                    short(plant.leaf_area),
                    short(footprint)
                );
                let help = format!(
                    "crowns have 2 to 15{}",
                    match self.scene.meshes.get(plant.name.as_str()) {
                        Some(Mesh::Crown { .. }) =>
                            "; `leaf_area_m2` is the one-sided area of all leaves of one crown",
                        _ => "; is its unit right, and is it one plant?",
                    }
                );
                let path = format!("meshes.{}", plant.name);
                let problem = if index > OVERLAID {
                    Diagnostic::error(path, format!("{message}; at most {OVERLAID} are traced"))
                } else {
                    Diagnostic::warning(path, message)
                };
                self.problems.push(problem.help(help));
            }
            if plant.tallest > TALLEST && plant.size.z <= TALLEST {
                let message = format!(
                    "instances of `{}` are up to {} m high",
                    plant.name,
                    short(plant.tallest)
                );
                let help = "no plant is higher than 120 m: heights of tables are in metres, and a scale of 1 \
                            leaves the mesh as it is";
                self.problems.push(Diagnostic::warning("instances", message).help(help));
            }
            let per_hectare = plant.count as f64 / area * 1e4;
            if per_hectare > STEMS && plant.count > 10 && plant.size.z >= TREE {
                let message = format!(
                    "{} of `{}`, {:.1} m high, are {} per hectare",
                    plant.count,
                    plant.name,
                    plant.size.z,
                    short(per_hectare)
                );
                let help = "forests have 100 to 10 000 trees per hectare: is the ground's extent right, and \
                            are coordinates and densities in metres?";
                self.problems.push(Diagnostic::warning("instances", message).help(help));
            }
        }
        let index = plants.iter().map(|plant| plant.all).sum::<f64>() / area;
        if index > LEAF_AREA_OF_STAND {
            let message = format!("the leaf area index of the scene is {index:.0}");
            let help = "forests have 1 to 10: are leaf areas, numbers of plants and the ground's extent right?";
            self.problems.push(Diagnostic::warning("instances", message).help(help));
        }
    }

    fn plants(&self, placements: &[Placement], meshes: &BTreeMap<u32, Prototype>) -> Vec<Plants> {
        let mut plants: BTreeMap<u32, Plants> = BTreeMap::new();
        for placement in placements {
            let id = placement.prototype.0;
            let Some(prototype) = meshes.get(&id) else { continue };
            let plant = plants.entry(id).or_insert_with(|| self.plant(prototype));
            plant.count += 1;
            plant.all += plant.leaf_area * placement.area_factor();
            let height = plant.size.z * f64::from(placement.scale_vertical);
            plant.tallest = plant.tallest.max(height);
        }
        plants.into_values().collect()
    }

    fn plant(&self, prototype: &Prototype) -> Plants {
        let is_leaf = |material: u32| {
            let material = self.scene.materials.get_index(material as usize);
            matches!(material, Some((_, Material::Leaf { .. })))
        };
        let parts = prototype.mesh.parts.iter().zip(&prototype.materials.0);
        let of_leaves = parts.filter(|(_, material)| is_leaf(material.0));
        let bounds = prototype.mesh.bounds().unwrap_or_default();
        Plants {
            name: prototype.name.0.clone(),
            count: 0,
            leaf_area: of_leaves.map(|(part, _)| prototype.mesh.part_area(part)).sum(),
            all: 0.0,
            tallest: 0.0,
            size: (bounds.1 - bounds.0).as_dvec3(),
        }
    }

    /// Warns of a raster of heights that are all 0: a mask, or a map without heights.
    pub(super) fn warn_flat_raster(&mut self, patch: &TerrainPatch) {
        let Terrain::Raster { file, .. } = &self.scene.terrain else { return };
        let origin = self.scene.frame.origin_m.2;
        if [patch.lowest(), patch.highest()].iter().all(|height| height + origin == 0.0) {
            let message = format!("all heights in `{file}` are 0");
            let help =
                "is it a raster of elevations? flat ground is `Plane(size_m: (..), material: ..)`";
            self.problems.push(Diagnostic::warning("terrain.file", message).help(help));
        }
    }
}

/// A number with three digits.
fn short(value: f64) -> String {
    if (0.01..1e4).contains(&value) {
        let digits = (2 - value.log10().floor() as i32).clamp(0, 4) as usize;
        format!("{value:.digits$}")
    } else {
        format!("{value:.2e}")
    }
}
