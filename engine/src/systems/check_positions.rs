use std::collections::BTreeMap;

use glam::DVec3;
use hecs::World;

use super::Resources;
use super::coordinate_advice::{
    AdvicePlace, far_from, is_far, other_coordinates, place_of_instance,
};
use super::georeference::MapFrame;
use super::measure_bounds::placed_meshes;
use crate::components::{PlantingId, Position, PrototypeId, SceneId};
use crate::document::{Diagnostic, Instances, Terrain};
use crate::geometry::place_text;
use crate::terrain::Ground;

/// An instance off the ground.
#[derive(Clone, Copy)]
struct Stray {
    id: SceneId,
    planting: PlantingId,
    position: DVec3,
}

/// Refuses instances so far from the ground that other coordinates must be meant, and warns of those beside the ground
/// of an isolated scene. Reads [`Position`], [`Ground`], [`MapFrame`], `document::Instances` and `document::Terrain`.
pub(super) fn check_positions(world: &mut World, resources: &mut Resources) {
    let Ok(ground) = world.get::<&Ground>(resources.terrain) else { return };
    let mut far = Vec::new();
    let mut beside: BTreeMap<u32, Vec<Stray>> = BTreeMap::new();
    let (low, high) = (ground.corner(), ground.corner() + ground.size());
    let mut query = world.query::<(&SceneId, &PlantingId, &PrototypeId, &Position)>();
    for (&id, &planting, prototype, &Position(position)) in &mut query {
        let at = position.truncate();
        let stray = Stray { id, planting, position };
        if is_far(at, &ground) {
            far.push(stray);
        }
        if !resources.is_periodic() && (at.cmplt(low).any() || at.cmpgt(high).any()) {
            beside.entry(prototype.0).or_default().push(stray);
        }
    }
    if !far.is_empty() {
        far.sort_unstable_by_key(|stray| stray.id);
        let (count, distance) = (far.len(), far_from(&ground));
        let message = match count {
            1 => format!("an instance stands more than {distance:.0} m from the ground"),
            _ => format!("{count} instances stand more than {distance:.0} m from the ground"),
        };
        let help = stray_help(&far, &ground, world, resources).unwrap_or_default();
        let (path, _) = place_of_instance(far[0].id, world, resources);
        resources.report(Diagnostic::error(path, message).help(help));
        return;
    }
    let meshes = placed_meshes(world);
    for (prototype, mut strays) in beside {
        let Some(mesh) = meshes.get(&prototype) else { continue };
        strays.sort_unstable_by_key(|stray| stray.id);
        let message = format!("{} of `{}` stand beside the ground", strays.len(), mesh.name);
        let help = stray_help(&strays, &ground, world, resources).unwrap_or_default();
        resources.report(Diagnostic::warning("instances", message).help(help));
    }
}

/// Advice for instances off the ground, in document order.
fn stray_help(
    strays: &[Stray],
    ground: &Ground,
    world: &World,
    resources: &Resources,
) -> Option<String> {
    let planting = strays.first()?.planting;
    let instances = world.get::<&Instances>(resources.plantings[planting.0 as usize]).ok()?;
    let of_planting = strays.iter().filter(|stray| stray.planting == planting);
    let places: Vec<DVec3> = of_planting.map(|stray| stray.position).collect();
    let terrain = world.get::<&Terrain>(resources.terrain).ok()?;
    let map = world.get::<&MapFrame>(resources.terrain).ok()?;
    let place = AdvicePlace { terrain: &terrain, map: &map, ground };
    let advice = other_coordinates(&instances, &places, &place, resources);
    let advice = advice.unwrap_or_else(|| "make it larger, or move them".to_owned());
    let (low, high) = (ground.corner(), ground.corner() + ground.size());
    Some(format!(
        "one stands at {}, and the ground reaches from {} to {} m: {advice}",
        place_text(places.first()?.truncate()),
        place_text(low),
        place_text(high)
    ))
}
