use std::collections::BTreeMap;

use hecs::World;

use super::Resources;
use super::measure_bounds::placed_meshes;
use crate::components::{Instance, InstanceQuery, LeafArea, TerrainPatch};
use crate::document::{Diagnostic, Prototype, ScenePath};

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

/// Warns of leaf areas and numbers of stems that no plant or stand has: units or decimal points that went wrong. Reads
/// the components of instances, [`LeafArea`], `MeshBounds`, `document::Prototype` and [`TerrainPatch`].
pub(super) fn warn_implausible_plants(world: &mut World, resources: &mut Resources) {
    let Ok(patch) = world.get::<&TerrainPatch>(resources.terrain) else { return };
    let area = patch.size.element_product();
    let plants: Vec<Plants> = plants(world, resources);
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
                match world.get::<&Prototype>(resources.meshes[plant.name.as_str()]).as_deref() {
                    Ok(Prototype::Crown(_)) =>
                        "; `leaf_area_m2` is the one-sided area of all leaves of one crown",
                    _ => "; is its unit right, and is it one plant?",
                }
            );
            let path = ScenePath::from("meshes").name(&plant.name);
            let problem = if index > OVERLAID {
                Diagnostic::error(path, format!("{message}; at most {OVERLAID} are traced"))
            } else {
                Diagnostic::warning(path, message)
            };
            resources.report(problem.help(help));
        }
        if plant.tallest > TALLEST && plant.size.z <= TALLEST {
            let message =
                format!("instances of `{}` are up to {} m high", plant.name, short(plant.tallest));
            let help = "no plant is higher than 120 m: heights of tables are in metres, and a scale of 1 \
                            leaves the mesh as it is";
            resources.report(Diagnostic::warning("instances", message).help(help));
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
            resources.report(Diagnostic::warning("instances", message).help(help));
        }
    }
    let index = plants.iter().map(|plant| plant.all).sum::<f64>() / area;
    if index > LEAF_AREA_OF_STAND {
        let message = format!("the leaf area index of the scene is {index:.0}");
        let help = "forests have 1 to 10: are leaf areas, numbers of plants and the ground's extent right?";
        resources.report(Diagnostic::warning("instances", message).help(help));
    }
}

/// Sums over the instances of each mesh.
fn plants(world: &World, resources: &Resources) -> Vec<Plants> {
    let meshes = placed_meshes(world).into_iter();
    let mut plants: BTreeMap<u32, Plants> = meshes
        .map(|(id, mesh)| {
            let leaf_area = world.get::<&LeafArea>(resources.meshes[id as usize]);
            let bounds = mesh.bounds.map(|bounds| bounds.high - bounds.low).unwrap_or_default();
            let plants = Plants {
                name: mesh.name,
                count: 0,
                leaf_area: leaf_area.map_or(0.0, |area| area.0),
                all: 0.0,
                tallest: 0.0,
                size: bounds.as_dvec3(),
            };
            (id, plants)
        })
        .collect();
    for components in &mut world.query::<InstanceQuery<'_>>() {
        let Instance { placement, .. } = Instance::from_components(components);
        let Some(plant) = plants.get_mut(&placement.prototype.0) else { continue };
        plant.count += 1;
        plant.all += plant.leaf_area * placement.area_factor();
        plant.tallest = plant.tallest.max(plant.size.z * f64::from(placement.scale.vertical));
    }
    plants.into_values().collect()
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
