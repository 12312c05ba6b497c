use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use super::Spawner;
use super::meshes::Prototype;
use crate::assets::Row;
use crate::components::{Placement, PrototypeId, SceneId};
use crate::document::{Diagnostic, Instances, Scene, suggestion, unknown_name};
use crate::geometry::place_text;
use crate::placement::Pattern;
use crate::terrain::Ground;

/// Most instances of a scene: ids are `u32`, and the ray engine keeps some for the ground.
const MOST_INSTANCES: usize = 1 << 30;

impl Spawner<'_> {
    /// All instances that are not hidden, in document order.
    pub(super) fn instances(
        &mut self,
        meshes: &BTreeMap<u32, Prototype>,
        ground: Option<&Ground>,
    ) -> Vec<Placement> {
        let scene = self.scene;
        let mut placements = Vec::new();
        for (index, instances) in scene.instances.iter().enumerate() {
            let path = format!("instances[{index}]");
            let mut placed = match instances {
                Instances::Table { .. } => self.table(instances, meshes, ground, &path),
                Instances::List { of, at_m, yaw_deg, scale, on_terrain, .. } => {
                    let rows = listed(at_m, yaw_deg, scale);
                    let ground = ground.filter(|_| *on_terrain);
                    match self.prototype(of, format!("{path}.of")) {
                        Some(prototype) => {
                            let prototypes = vec![prototype; rows.len()];
                            self.rows(instances, &rows, &prototypes, ground, &path)
                        }
                        None => Vec::new(),
                    }
                }
                Instances::Scatter { .. } => {
                    // A terrain that could not be built was reported.
                    let Some(ground) = ground else { continue };
                    self.scatter(instances, index, meshes, ground)
                }
                Instances::CanopyHeights { .. } => {
                    let Some(ground) = ground else { continue };
                    self.canopy(instances, index, meshes, ground).unwrap_or_default()
                }
            };
            let shown: Vec<usize> = shown(scene, index, instances)
                .filter_map(|name| scene.meshes.get_index_of(name))
                .collect();
            // Nothing stands of crowns without leaves and wood.
            let is_empty = |prototype: PrototypeId| {
                meshes.get(&prototype.0).is_some_and(|one| one.mesh.parts.is_empty())
            };
            placed.retain(|placement| {
                let prototype = placement.prototype;
                shown.contains(&(prototype.0 as usize)) && !is_empty(prototype)
            });
            if placements.len() + placed.len() > MOST_INSTANCES {
                self.problems.push(
                    Diagnostic::error(path, format!("more than {MOST_INSTANCES} instances"))
                        .help("group trees into larger meshes"),
                );
                break;
            }
            placements.append(&mut placed);
            self.origins.push(index, placements.len());
        }
        for (id, placement) in placements.iter_mut().enumerate() {
            placement.id = SceneId(id as u32);
        }
        placements
    }

    /// The mesh of this name; where there is none, a problem is noted.
    pub(super) fn prototype(&mut self, name: &str, path: String) -> Option<PrototypeId> {
        let scene = self.scene;
        let index = scene.meshes.get_index_of(name);
        if index.is_none() {
            let known = scene.meshes.keys().map(String::as_str);
            self.problems.push(unknown_name(path, "mesh", name, known));
        }
        index.map(|index| PrototypeId(index as u32))
    }

    /// Rows of a table or a list; their heights count from the ground where it is given.
    pub(super) fn rows(
        &mut self,
        instances: &Instances,
        rows: &[Row],
        prototypes: &[PrototypeId],
        ground: Option<&Ground>,
        path: &str,
    ) -> Vec<Placement> {
        let mut beside = Vec::new();
        let placed = rows
            .iter()
            .zip(prototypes)
            .filter_map(|(row, &prototype)| {
                let base = match ground.map(|ground| ground.height(row.position.truncate())) {
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
            let message =
                format!("{} of {} places have no terrain below", beside.len(), rows.len());
            let advice = self
                .other_coordinates(instances, &beside, ground)
                .unwrap_or_else(|| "move it, or take out `on_terrain`".to_owned());
            let help = format!("{} is one: {advice}", place_text(first.truncate()));
            self.problems.push(Diagnostic::error(path, message).help(help));
        }
        placed
    }

    /// Patterns that name nothing of the scene.
    pub(super) fn check_patterns(&mut self) {
        let scene = self.scene;
        if scene.hide.is_empty() && scene.select.is_empty() {
            return;
        }
        let mut named: Vec<(String, &str)> = Vec::new();
        for (index, instances) in scene.instances.iter().enumerate() {
            named.extend(
                instances.meshes().into_iter().map(|mesh| (name_of(index, instances), mesh)),
            );
        }
        for (key, patterns) in [("hide", &scene.hide), ("select", &scene.select)] {
            for (index, text) in patterns.iter().enumerate() {
                let pattern = Pattern::new(text);
                if !named.iter().any(|(name, mesh)| pattern.matches(name, mesh)) {
                    let full = named.iter().map(|(name, mesh)| format!("{name}/{mesh}"));
                    let mut known: Vec<String> =
                        named.iter().map(|&(_, mesh)| mesh.to_owned()).chain(full).collect();
                    known.sort();
                    known.dedup();
                    let known: Vec<&str> = known.iter().map(String::as_str).collect();
                    let help = suggestion(text, &known, "patterns here may be");
                    let message = format!("nothing stands there by the name `{text}`");
                    let at = format!("{key}[{index}]");
                    self.problems.push(Diagnostic::error(at, message).help(help));
                }
            }
        }
    }
}

/// The meshes that any instances place and that are not hidden there, or that are needed to choose
/// among them.
pub(super) fn needed_meshes(scene: &Scene) -> BTreeSet<&str> {
    let mut needed = BTreeSet::new();
    for (index, instances) in scene.instances.iter().enumerate() {
        match instances {
            Instances::CanopyHeights { .. } => needed.extend(instances.meshes()),
            _ => needed.extend(shown(scene, index, instances)),
        }
    }
    needed
}

/// The meshes of these instances that are not hidden.
fn shown<'a>(
    scene: &'a Scene,
    index: usize,
    instances: &'a Instances,
) -> impl Iterator<Item = &'a str> {
    let Scene { hide, select, .. } = scene;
    let name = name_of(index, instances);
    let any = |patterns: &[String], name: &str, mesh: &str| {
        patterns.iter().any(|pattern| Pattern::new(pattern).matches(name, mesh))
    };
    instances.meshes().into_iter().filter(move |mesh| {
        (select.is_empty() || any(select, &name, mesh)) && !any(hide, &name, mesh)
    })
}

/// Name of instances for patterns: the author's, or their number in the list.
fn name_of(index: usize, instances: &Instances) -> String {
    instances.name().map_or_else(|| index.to_string(), str::to_owned)
}

fn placement(row: &Row, base: f64, prototype: PrototypeId) -> Placement {
    Placement {
        position: row.position + DVec3::Z * base,
        yaw: row.yaw as f32,
        tilt: row.tilt as f32,
        tilt_azimuth: row.tilt_azimuth as f32,
        scale_horizontal: row.scale_horizontal as f32,
        scale_vertical: row.scale_vertical as f32,
        prototype,
        id: SceneId(0),
    }
}

/// Rows of a list; `document::check` has seen to it that its columns are empty or of one length.
fn listed(at_m: &[(f64, f64, f64)], yaw_deg: &[f64], scale: &[f64]) -> Vec<Row> {
    at_m.iter()
        .enumerate()
        .map(|(index, &position)| {
            let scale = scale.get(index).copied().unwrap_or(1.0);
            Row {
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
