use std::collections::BTreeMap;

use glam::DVec3;
use hecs::World;
use rayon::prelude::*;

use super::Resources;
use super::coordinate_advice::terrain_advice;
use super::measure_bounds::{MeshSummary, placed_meshes};
use super::measure_extents::BATCH;
use crate::components::{Instance, InstanceQuery, MeshBounds, Placement};
use crate::document::{Diagnostic, Instances};
use crate::geometry::place_text;
use crate::terrain::Ground;

/// Height of bodies that are flat, and gap over which those do not float, m.
const FLAT: f64 = 0.05;

/// Share of its height by which an instance is sunken: roots are less, and a tree that lies on its side is half.
const SUNKEN: f64 = 0.4;

/// Distance from the ground that is rounding, over the ground's height.
const ROUNDING: f64 = 1e-6;

/// Instances of one mesh that float above the ground, are sunken into it, or are flat and lie in it.
struct Case {
    count: usize,
    /// The first of them in document order, and the heights of its lowest and highest point and of the ground, m.
    first: Instance,
    heights: [f64; 3],
}

impl Case {
    fn add(self, to: &mut Option<Self>) {
        let Some(case) = to else {
            *to = Some(self);
            return;
        };
        case.count += self.count;
        if self.first.id < case.first.id {
            (case.first, case.heights) = (self.first, self.heights);
        }
    }
}

/// Cases of one mesh.
#[derive(Default)]
struct Cases {
    sunken: Option<Case>,
    floating: Option<Case>,
    flat: Option<Case>,
}

impl Cases {
    /// Adds an instance if it is a case.
    fn look_at(&mut self, instance: Instance, bounds: &MeshBounds, below: f64) {
        let (low, high) = vertical_extent(&instance.placement, bounds);
        let (gap, height) = (low - below, high - low);
        let is_flat = height < FLAT && gap.abs() < ROUNDING * (below.abs() + 1.0);
        let floats = gap > height.max(FLAT);
        if !is_flat && !floats && high - below >= (1.0 - SUNKEN) * height {
            return;
        }
        let case = Case { count: 1, first: instance, heights: [low, high, below] };
        case.add(if is_flat {
            &mut self.flat
        } else if floats {
            &mut self.floating
        } else {
            &mut self.sunken
        });
    }

    fn merge(&mut self, other: Self) {
        let Self { sunken, floating, flat } = other;
        let pairs =
            [(sunken, &mut self.sunken), (floating, &mut self.floating), (flat, &mut self.flat)];
        for (case, to) in pairs {
            if let Some(case) = case {
                case.add(to);
            }
        }
    }
}

/// Cases of all instances, by mesh: the same for any order of looking at them.
fn cases(
    world: &World,
    ground: &Ground,
    bounds: &BTreeMap<u32, MeshBounds>,
) -> BTreeMap<u32, Cases> {
    let mut query = world.query::<InstanceQuery<'_>>();
    query
        .iter_batched(BATCH)
        .par_bridge()
        .map(|batch| {
            let mut cases: BTreeMap<u32, Cases> = BTreeMap::new();
            for instance in batch.map(Instance::from_components) {
                let Placement { prototype, position, .. } = instance.placement;
                let Some(bounds) = bounds.get(&prototype.0) else { continue };
                let Some(below) = ground.height(position.truncate()) else { continue };
                cases.entry(prototype.0).or_default().look_at(instance, bounds, below);
            }
            cases
        })
        .reduce(BTreeMap::new, |mut all, some| {
            for (mesh, cases) in some {
                all.entry(mesh).or_default().merge(cases);
            }
            all
        })
}

/// Warns of instances that float above the ground by more than their height, or are sunken into it by two fifths of their
/// height: crowns without trunks, and roots, are left alone. Reads the components of
/// instances, [`MeshBounds`] and [`Ground`].
pub(super) fn warn_floating_instances(world: &mut World, resources: &mut Resources) {
    let Ok(ground) = world.get::<&Ground>(resources.terrain) else { return };
    let meshes = placed_meshes(world);
    let bounds: BTreeMap<u32, MeshBounds> =
        meshes.iter().filter_map(|(&id, mesh)| Some((id, mesh.bounds?))).collect();
    let cases = cases(world, &ground, &bounds);
    for (prototype, Cases { flat, .. }) in &cases {
        let Some(Case { count, first, .. }) = flat else { continue };
        let name = &meshes[prototype].name;
        resources.messages.note(format!(
            "{count} of `{name}` are flat and lie exactly in the ground: at ({}, {}) rays meet the ground or \
             `{name}`, whichever comes first (lift it by a millimetre to see it)",
            first.placement.position.x, first.placement.position.y
        ));
    }
    for (prototype, Cases { sunken, floating, .. }) in &cases {
        let MeshSummary { name, bounds, .. } = &meshes[prototype];
        let lying = bounds.map_or_else(String::new, |bounds| lying_advice(name, bounds));
        for (case, how, rest) in
            [(sunken, "are sunken into", lying.as_str()), (floating, "float above", "")]
        {
            let Some(Case { count, first, heights: [low, high, below] }) = case else { continue };
            let advice = advice(first, [*low, *high], world, resources);
            let message = format!("{count} of `{name}` {how} the ground");
            let help = format!(
                "at {} the ground is {below:.2} m high, and it reaches from {low:.2} to {high:.2} m{advice}{rest}; \
                 heights of instances are those of the local frame",
                place_text(first.placement.position.truncate()),
            );
            resources.messages.report(Diagnostic::warning("instances", message).help(help));
        }
    }
}

/// Advice about a mesh that reaches as far below its origin as a tree that lies on its side, with a separator.
fn lying_advice(name: &str, MeshBounds { low, high }: MeshBounds) -> String {
    if f64::from(-low.z) <= SUNKEN * f64::from(high.z - low.z) {
        return String::new();
    }
    format!(
        "; `{name}` itself reaches from {:.2} to {:.2} m about its origin: is its `up` right?",
        low.z, high.z
    )
}

fn advice(
    instance: &Instance,
    vertical: [f64; 2],
    world: &World,
    resources: &Resources,
) -> &'static str {
    let planting = resources.plantings[instance.planting.0 as usize];
    let instances = world.get::<&Instances>(planting);
    instances.map_or("", |instances| terrain_advice(&instances, vertical, resources))
}

/// Lowest and highest height of the box around a placed mesh, m.
pub(super) fn vertical_extent(placement: &Placement, bounds: &MeshBounds) -> (f64, f64) {
    // The height of a corner is linear in its coordinates, so each axis has its own extremes.
    let up: DVec3 = placement.world_from_object().row(2);
    let (a, b) = (bounds.low.as_dvec3() * up, bounds.high.as_dvec3() * up);
    let z = placement.position.z;
    (z + a.min(b).element_sum(), z + a.max(b).element_sum())
}
