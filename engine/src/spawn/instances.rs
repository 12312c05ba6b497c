use glam::DVec3;

use super::Spawner;
use crate::assets::{self, Row};
use crate::components::{Placement, PrototypeId, SceneId};
use crate::document::{Diagnostic, Instances, unknown_name};

/// Most instances of a scene: ids are `u32`, and the ray engine keeps some for the ground.
const MOST_INSTANCES: usize = 1 << 30;

impl Spawner<'_> {
    /// All instances in document order.
    pub(super) fn instances(&mut self) -> Vec<Placement> {
        let scene = self.scene;
        let mut placements = Vec::new();
        for (index, instances) in scene.instances.iter().enumerate() {
            let path = format!("instances[{index}]");
            let (of, rows) = match instances {
                Instances::Table { file, of, columns, .. } => {
                    let file = self.file(file);
                    match assets::read_instances(&file, columns.as_deref()) {
                        Ok(rows) => (of, rows),
                        Err(error) => {
                            let problem =
                                Diagnostic::error(format!("{path}.file"), error.to_string());
                            self.problems.push(problem);
                            (of, Vec::new())
                        }
                    }
                }
                Instances::List { of, at_m, yaw_deg, scale, .. } => {
                    (of, listed(at_m, yaw_deg, scale))
                }
                Instances::Scatter { .. } => continue,
            };
            let Some(prototype) = scene.meshes.get_index_of(of) else {
                let known = scene.meshes.keys().map(String::as_str);
                self.problems.push(unknown_name(format!("{path}.of"), "mesh", of, known));
                continue;
            };
            if placements.len() + rows.len() > MOST_INSTANCES {
                self.problems.push(
                    Diagnostic::error(path, format!("more than {MOST_INSTANCES} instances"))
                        .help("group trees into larger meshes"),
                );
                break;
            }
            for row in rows {
                let id = SceneId(placements.len() as u32);
                placements.push(placement(&row, PrototypeId(prototype as u32), id));
            }
        }
        placements
    }
}

fn placement(row: &Row, prototype: PrototypeId, id: SceneId) -> Placement {
    Placement {
        position: row.position,
        yaw: row.yaw as f32,
        tilt: row.tilt as f32,
        tilt_azimuth: row.tilt_azimuth as f32,
        scale_horizontal: row.scale_horizontal as f32,
        scale_vertical: row.scale_vertical as f32,
        prototype,
        id,
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
            }
        })
        .collect()
}
