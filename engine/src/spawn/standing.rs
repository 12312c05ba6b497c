use std::collections::BTreeMap;

use glam::DVec3;

use super::Spawner;
use super::meshes::Prototype;
use crate::components::Placement;
use crate::document::Diagnostic;
use crate::geometry::place_text;
use crate::terrain::Ground;

/// Height of bodies that are flat, and gap over which those do not float, m.
const FLAT: f64 = 0.05;

/// Distance from the ground that is rounding, over the ground's height.
const ROUNDING: f64 = 1e-6;

/// Instances of one mesh that stand wrongly in one way.
struct Case {
    count: usize,
    example: String,
}

impl Spawner<'_> {
    /// Warns of instances that float high over the ground or are sunken deep into it: by their own
    /// height or half of it, so that crowns without trunks and roots are left alone.
    pub(super) fn check_standing(
        &mut self,
        placements: &[Placement],
        meshes: &BTreeMap<u32, Prototype>,
        ground: &Ground,
    ) {
        let mut cases: BTreeMap<(u32, bool), Case> = BTreeMap::new();
        let mut flat: BTreeMap<u32, (usize, DVec3)> = BTreeMap::new();
        // Once a mesh, not once an instance.
        let bounds: BTreeMap<u32, [DVec3; 2]> = meshes
            .iter()
            .filter_map(|(&id, prototype)| Some((id, prototype.mesh.bounds()?)))
            .map(|(id, (low, high))| (id, [low.as_dvec3(), high.as_dvec3()]))
            .collect();
        for placement in placements {
            let Some(&bounds) = bounds.get(&placement.prototype.0) else { continue };
            let (low, high) = vertical_extent(placement, bounds);
            let Some(below) = ground.height(placement.position.truncate()) else { continue };
            let (gap, height) = (low - below, high - low);
            if height < FLAT && gap.abs() < ROUNDING * (below.abs() + 1.0) {
                flat.entry(placement.prototype.0).or_insert((0, placement.position)).0 += 1;
                continue;
            }
            let floats = gap > height.max(FLAT);
            if !floats && high - below >= 0.5 * height {
                continue;
            }
            let case = cases.entry((placement.prototype.0, floats)).or_insert_with(|| Case {
                count: 0,
                example: format!(
                    "at {} the ground is {below:.2} m high, and it reaches from {low:.2} to \
                     {high:.2} m{}",
                    place_text(placement.position.truncate()),
                    self.terrain_advice(placement, [low, high])
                ),
            });
            case.count += 1;
        }
        for (prototype, (count, at)) in flat {
            let name = &meshes[&prototype].name.0;
            self.notes.push(format!(
                "{count} of `{name}` are flat and lie exactly in the ground: at ({}, {}) rays meet the ground or \
                 `{name}`, whichever comes first (lift it by a millimetre to see it)",
                at.x, at.y
            ));
        }
        for ((prototype, floats), Case { count, example }) in cases {
            let name = &meshes[&prototype].name.0;
            let how = if floats { "float above" } else { "are sunken into" };
            let message = format!("{count} of `{name}` {how} the ground");
            let help = format!("{example}; heights of instances are those of the local frame");
            self.problems.push(Diagnostic::warning("instances", message).help(help));
        }
    }
}

/// Lowest and highest height of the box around a placed mesh, m.
pub(super) fn vertical_extent(placement: &Placement, bounds: [DVec3; 2]) -> (f64, f64) {
    // The height of a corner is linear in its coordinates, so each axis has its own extremes.
    let up = placement.world_from_object().row(2);
    let (a, b) = (bounds[0] * up, bounds[1] * up);
    let z = placement.position.z;
    (z + a.min(b).element_sum(), z + a.max(b).element_sum())
}
