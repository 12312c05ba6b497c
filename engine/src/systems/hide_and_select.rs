use std::collections::BTreeSet;

use hecs::World;

use super::{Changes, Resources};
use crate::components::{PrototypeId, ShownMeshes};
use crate::document::{Diagnostic, Instances, NamePattern, ScenePath, suggestion};
use crate::placement::Pattern;

/// Finds the mesh prototypes of each planting that the patterns of `hide` and `select` leave. Reads
/// `document::Instances`; writes [`ShownMeshes`] of plantings, and marks them as changed only where they are.
pub(super) fn hide_and_select(world: &mut World, resources: &mut Resources) {
    for (index, &planting) in resources.plantings.iter().enumerate() {
        let shown = {
            let instances = world.get::<&Instances>(planting);
            shown(index, &instances.expect("`spawn` gives plantings their source"), resources)
        };
        if world.get::<&ShownMeshes>(planting).is_ok_and(|known| *known == shown) {
            continue;
        }
        world.insert_one(planting, shown).expect("plantings exist");
        resources.changes |= Changes::SHOWN_MESHES;
    }
}

/// Refuses patterns that match nothing of the scene. Reads `document::Instances`.
pub(super) fn check_patterns(world: &mut World, resources: &mut Resources) {
    if resources.hide.is_empty() && resources.select.is_empty() {
        return;
    }
    let mut named: Vec<(String, String)> = Vec::new();
    for (index, &planting) in resources.plantings.iter().enumerate() {
        let instances = world.get::<&Instances>(planting);
        let instances = instances.expect("`spawn` gives plantings their source");
        let meshes = instances.meshes().into_iter();
        named.extend(meshes.map(|mesh| (name_of(index, &instances), mesh.to_owned())));
    }
    for (key, patterns) in [("hide", &resources.hide), ("select", &resources.select)] {
        for (index, text) in patterns.iter().enumerate() {
            let pattern = Pattern::new(text);
            if !named.iter().any(|(name, mesh)| pattern.matches(name, mesh)) {
                let full = named.iter().map(|(name, mesh)| format!("{name}/{mesh}"));
                let mut known: Vec<String> =
                    named.iter().map(|(_, mesh)| mesh.clone()).chain(full).collect();
                known.sort();
                known.dedup();
                let known: Vec<&str> = known.iter().map(String::as_str).collect();
                let help = suggestion(text, &known, "patterns here may be");
                let message = format!("nothing stands there by the name `{text}`");
                let at = ScenePath::from(key).index(index);
                resources.messages.report(Diagnostic::error(at, message).help(help));
            }
        }
    }
}

/// Mesh prototypes to load: those that any planting shows, and all among which a canopy height model chooses.
pub(super) fn needed_meshes(world: &World, resources: &Resources) -> BTreeSet<u32> {
    let mut needed = BTreeSet::new();
    for &planting in &resources.plantings {
        let mut planting = world.query_one::<(&Instances, &ShownMeshes)>(planting);
        let Ok((instances, shown)) = planting.get() else { continue };
        match instances {
            Instances::CanopyHeights(_) => {
                let meshes = instances.meshes().into_iter();
                needed.extend(
                    meshes.filter_map(|mesh| resources.meshes.get_index_of(mesh)).map(|i| i as u32),
                );
            }
            _ => needed.extend(shown.0.iter().map(|prototype| prototype.0)),
        }
    }
    needed
}

/// Mesh prototypes of a planting that are neither hidden nor left out.
fn shown(index: usize, instances: &Instances, resources: &Resources) -> ShownMeshes {
    let Resources { hide, select, meshes, .. } = resources;
    let name = name_of(index, instances);
    let any = |patterns: &[NamePattern], mesh: &str| {
        patterns.iter().any(|pattern| Pattern::new(pattern).matches(&name, mesh))
    };
    let is_shown = |mesh: &&str| (select.is_empty() || any(select, mesh)) && !any(hide, mesh);
    let shown = instances.meshes().into_iter().filter(is_shown);
    let ids = shown.filter_map(|mesh| meshes.get_index_of(mesh));
    ShownMeshes(ids.map(|index| PrototypeId(index as u32)).collect())
}

/// Name of a planting for patterns: the author's, or its place in the document.
fn name_of(index: usize, instances: &Instances) -> String {
    instances.name().map_or_else(|| index.to_string(), str::to_owned)
}
