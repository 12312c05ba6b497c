//! Places the instances of all plantings.
//!
//! | kind of planting | file | height of an instance |
//! |---|---|---|
//! | list, table | `mod.rs`, `table.rs` | as written, m, local frame; with `on_terrain`, or without heights, above the ground |
//! | scatter | `scatter.rs`, [`placement`](crate::placement) | on the ground, less `sink_m` |
//! | canopy height model | `canopy.rs` | on the ground, less `sink_m` |

mod areas;
mod canopy;
mod scatter;
mod table;

use std::collections::BTreeMap;
use std::ops::Range;

use glam::DVec3;
use hecs::{Entity, World};

use super::coordinate_advice::{AdvicePlace, other_coordinates};
use super::georeference::{MapFrame, MapTransform};
use super::{Resources, set_component};
use crate::assets::StemRow;
use crate::components::{
    Instance, InstanceRange, Lean, Mesh, MeshBounds, Placement, PlantingAreas, PlantingId,
    PrototypeId, Scale, SceneId, ShownMeshes,
};
use crate::counts::{agreeing, counted};
use crate::document::{Diagnostic, Instances, ScenePath, Terrain};
use crate::geometry::{Rectangle, place_text};
use crate::sampling::Key;
use crate::terrain::Ground;

use canopy::plant_canopy;
use scatter::scatter;
use table::plant_table;

/// Most instances of a scene: ids are `u32`, and the ray engine keeps some for the ground.
const MOST_INSTANCES: usize = 1 << 30;

/// Shape of a loaded mesh.
#[derive(Clone, Copy, Debug)]
struct Shape {
    /// Box around it; `None` if it has no primitive.
    bounds: Option<MeshBounds>,
    /// True if it has no parts.
    is_empty: bool,
}

/// Data that placing the instances of a planting takes.
struct Site<'a> {
    /// Path of the planting in the document.
    path: ScenePath,
    /// Number of the planting.
    index: usize,
    terrain: &'a Terrain,
    /// The ground; `None` if the terrain has an error.
    ground: Option<&'a Ground>,
    /// Loaded meshes; a hidden mesh is not loaded.
    shapes: &'a BTreeMap<u32, Shape>,
    /// Polygons that it names, once they are read.
    areas: PlantingAreas,
    map: MapFrame,
    resources: &'a mut Resources,
}

impl Site<'_> {
    fn report(&mut self, diagnostic: Diagnostic) {
        self.resources.report(diagnostic);
    }

    /// Relation of the map to the local frame.
    fn transform(&self) -> MapTransform {
        self.map.transform.unwrap_or_else(|| MapTransform::from_frame(self.resources))
    }

    /// Stream of random numbers of the planting, keyed by its name, or its number if it has none.
    fn stream(&self, name: Option<&str>, seed: Option<u64>) -> Key {
        let seed = Key::new(seed.unwrap_or(self.resources.seed)).path("instances");
        name.map_or_else(|| seed.index(self.index as u64), |name| seed.path(name))
    }
}

/// Places the instances of all plantings on the ground. Reads `document::Instances`, [`ShownMeshes`], [`Mesh`],
/// [`MeshBounds`], [`Ground`] and [`MapFrame`]; writes all components of instances, and [`InstanceRange`] and [`PlantingAreas`] of plantings.
pub(super) fn plant(world: &mut World, resources: &mut Resources) {
    despawn_instances(world, resources);
    let shapes = shapes(world);
    let mut placements: Vec<Placement> = Vec::new();
    let mut ranges: Vec<Range<usize>> = Vec::new();
    let mut map = {
        let map = world.get::<&MapFrame>(resources.terrain);
        (*map.expect("`triangulate_terrain` writes it")).clone()
    };
    for (index, planting) in resources.plantings.clone().into_iter().enumerate() {
        let areas;
        let mut placed = {
            let mut source = world.query_one::<(&Instances, &ShownMeshes)>(planting);
            let (instances, shown) = source.get().expect("`hide_and_select` has run");
            let terrain = world.get::<&Terrain>(resources.terrain);
            let ground = world.get::<&Ground>(resources.terrain).ok();
            let mut site = Site {
                path: ScenePath::from("instances").index(index),
                index,
                terrain: &terrain.expect("`spawn` gives the terrain its source"),
                ground: ground.as_deref(),
                shapes: &shapes,
                areas: PlantingAreas::default(),
                map,
                resources,
            };
            let mut placed = placements_of(instances, &mut site);
            (map, areas) = (site.map, site.areas);
            // Crowns without leaves and wood show nothing.
            let is_empty = |id: PrototypeId| shapes.get(&id.0).is_some_and(|shape| shape.is_empty);
            placed.retain(|one| shown.0.contains(&one.prototype) && !is_empty(one.prototype));
            placed
        };
        let has_areas = areas != PlantingAreas::default();
        set_component(world, planting, has_areas.then_some(areas));
        let start = placements.len();
        if start + placed.len() > MOST_INSTANCES {
            let message = format!("more than {MOST_INSTANCES} instances");
            let problem = Diagnostic::error(ScenePath::from("instances").index(index), message);
            resources.report(problem.help("group trees into larger meshes"));
            break;
        }
        placements.append(&mut placed);
        let end = placements.len();
        let range = InstanceRange(start as u32..end as u32);
        world.insert_one(planting, range).expect("plantings exist");
        ranges.push(start..end);
    }
    let placements = &placements;
    let instance = |planting: u32| {
        move |id: usize| Instance {
            id: SceneId(id as u32),
            planting: PlantingId(planting),
            placement: placements[id],
        }
    };
    let instances =
        || (0..).zip(&ranges).flat_map(|(planting, range)| range.clone().map(instance(planting)));
    Instance::spawn(instances, world);
}

/// Removes all instances.
fn despawn_instances(world: &mut World, resources: &Resources) {
    let query = world.query_mut::<Entity>().with::<&PlantingId>();
    let instances: Vec<Entity> = query.into_iter().collect();
    // The last ones first: removing a row moves the last one into its place.
    for instance in instances.into_iter().rev() {
        world.despawn(instance).expect("the query found it");
    }
    for &planting in &resources.plantings {
        // Whatever is absent already need not be removed.
        drop(world.remove_one::<InstanceRange>(planting));
    }
}

/// Shapes of loaded meshes by their id.
fn shapes(world: &World) -> BTreeMap<u32, Shape> {
    let mut query = world.query::<(&SceneId, &Mesh, Option<&MeshBounds>)>();
    let shape = |(id, mesh, bounds): (&SceneId, &Mesh, Option<&MeshBounds>)| {
        (id.0, Shape { bounds: bounds.copied(), is_empty: mesh.parts.is_empty() })
    };
    query.iter().map(shape).collect()
}

/// Placements of a planting, those of hidden meshes included.
fn placements_of(instances: &Instances, site: &mut Site<'_>) -> Vec<Placement> {
    match instances {
        Instances::Table(_) => plant_table(instances, site),
        Instances::List(list) => {
            let rows = listed(&list.at_m, &list.yaw_deg, &list.scale);
            let base = if list.on_terrain { HeightBase::Ground } else { HeightBase::Frame };
            match site.resources.prototype(&list.of, &site.path.key("of")) {
                Some(prototype) => {
                    let prototypes = vec![prototype; rows.len()];
                    plant_rows(instances, &rows, &prototypes, base, site)
                }
                None => Vec::new(),
            }
        }
        // A terrain that has an error was reported.
        Instances::Scatter(rule) => {
            site.ground.map_or_else(Vec::new, |ground| scatter(rule, ground, site))
        }
        Instances::CanopyHeights(canopy) => {
            site.ground.and_then(|ground| plant_canopy(canopy, ground, site)).unwrap_or_default()
        }
    }
}

/// Rectangle of the ground.
fn rectangle_of(ground: &Ground) -> Rectangle {
    Rectangle { min: ground.corner(), max: ground.corner() + ground.size() }
}

/// What heights of instances count from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum HeightBase {
    /// The local frame.
    Frame,
    /// The ground below; places beside it are errors.
    Ground,
    /// The ground below, or the local frame beside it.
    GroundIfAny,
}

/// Instances of the rows of a table or a list.
fn plant_rows(
    instances: &Instances,
    rows: &[StemRow],
    prototypes: &[PrototypeId],
    base: HeightBase,
    site: &mut Site<'_>,
) -> Vec<Placement> {
    let ground = site.ground.filter(|_| base != HeightBase::Frame);
    let mut beside = Vec::new();
    let placed = rows
        .iter()
        .zip(prototypes)
        .filter_map(|(row, &prototype)| {
            let base = match ground.map(|ground| ground.height(row.position.truncate())) {
                Some(None) if base == HeightBase::GroundIfAny => 0.0,
                Some(None) => {
                    beside.push(row.position);
                    return None;
                }
                Some(Some(height)) => height,
                None => 0.0,
            };
            Some(placement(row, base, prototype))
        })
        .collect();
    if let (Some(first), Some(ground)) = (beside.first(), ground) {
        let message = format!(
            "{} of {} {} no terrain below",
            beside.len(),
            counted(rows.len(), "place"),
            agreeing(beside.len(), "has", "have")
        );
        let place = AdvicePlace { terrain: site.terrain, map: &site.map, ground };
        let advice = other_coordinates(instances, &beside, &place, site.resources)
            .unwrap_or_else(|| "move it, or take out `on_terrain`".to_owned());
        let help = format!("{} is one: {advice}", place_text(first.truncate()));
        let problem = Diagnostic::error(site.path.clone(), message).help(help);
        site.resources.report(problem);
    }
    placed
}

fn placement(row: &StemRow, base: f64, prototype: PrototypeId) -> Placement {
    Placement {
        prototype,
        position: row.position + DVec3::Z * base,
        yaw: row.yaw as f32,
        scale: Scale {
            horizontal: row.scale_horizontal as f32,
            vertical: row.scale_vertical as f32,
        },
        lean: Lean { tilt: row.tilt as f32, azimuth: row.tilt_azimuth as f32 },
    }
}

/// Rows of a list; `document::check` has seen to it that its columns are empty or of one length.
fn listed(at_m: &[(f64, f64, f64)], yaw_deg: &[f64], scale: &[f64]) -> Vec<StemRow> {
    at_m.iter()
        .enumerate()
        .map(|(index, &position)| {
            let scale = scale.get(index).copied().unwrap_or(1.0);
            StemRow {
                position: DVec3::from(position),
                yaw: yaw_deg.get(index).copied().unwrap_or(0.0).to_radians(),
                tilt: 0.0,
                tilt_azimuth: 0.0,
                scale_horizontal: scale,
                scale_vertical: scale,
                height: None,
                diameter: None,
                species: None,
                line: 0,
            }
        })
        .collect()
}
