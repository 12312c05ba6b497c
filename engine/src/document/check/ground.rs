//! The frame, the terrain, and what stands on it.

use super::super::diagnostic::{Diagnostic, suggestion};
use super::super::scene::{INSTANCE_COLUMNS, Instances, Scene, Terrain};
use super::mesh::check_material;
use super::{Report, count};

pub(super) fn check_frame(scene: &Scene, report: &mut Report<'_>) {
    let (x, y, z) = scene.frame.origin_m;
    report.finite("frame.origin_m", &[x, y, z]);
}

pub(super) fn check_terrain(scene: &Scene, report: &mut Report<'_>) {
    let Terrain::Plane { size_m, material, corner_m, height_m } = &scene.terrain;
    report.above_zero("terrain.size_m[0]", size_m.0);
    report.above_zero("terrain.size_m[1]", size_m.1);
    report.finite("terrain.corner_m", &[corner_m.0, corner_m.1]);
    report.finite("terrain.height_m", &[*height_m]);
    check_material("terrain", "material", material, scene, report);
}

pub(super) fn check_instances(scene: &Scene, report: &mut Report<'_>) {
    for (index, instances) in scene.instances.iter().enumerate() {
        let path = format!("instances[{index}]");
        let (Instances::Table { of, .. } | Instances::List { of, .. }) = instances;
        report.name(&format!("{path}.of"), "mesh", of, &scene.meshes, "meshes");
        match instances {
            Instances::Table { columns: Some(columns), .. } => {
                check_columns(&format!("{path}.columns"), columns, report);
            }
            Instances::Table { .. } => {}
            Instances::List { at_m, yaw_deg, scale, .. } => {
                for (index, (x, y, z)) in at_m.iter().enumerate() {
                    if !(x.is_finite() && y.is_finite() && z.is_finite()) {
                        let message = format!("expected finite numbers, found ({x}, {y}, {z})");
                        report.push(Diagnostic::error(format!("{path}.at_m[{index}]"), message));
                    }
                }
                check_count(&path, "yaw_deg", yaw_deg.len(), at_m.len(), report);
                check_count(&path, "scale", scale.len(), at_m.len(), report);
                report.finite(&format!("{path}.yaw_deg"), yaw_deg);
                for (index, &scale) in scale.iter().enumerate() {
                    if !(scale > 0.0 && scale.is_finite()) {
                        report.above_zero(&format!("{path}.scale[{index}]"), scale);
                    }
                }
            }
        }
    }
}

/// One value a place, or none.
fn check_count(path: &str, key: &str, values: usize, places: usize, report: &mut Report<'_>) {
    if values != 0 && values != places && report.is_readable(&format!("{path}.at_m")) {
        let values = count(values, "value");
        let message = format!("`{key}` has {values}, but `at_m` has {places}");
        let help = "write one for each place, or leave the key out";
        report.error(&format!("{path}.{key}"), message, help);
    }
}

fn check_columns(path: &str, columns: &[String], report: &mut Report<'_>) {
    for (index, column) in columns.iter().enumerate() {
        let at = format!("{path}[{index}]");
        if !INSTANCE_COLUMNS.contains(&column.as_str()) {
            let help = suggestion(column, &INSTANCE_COLUMNS, "columns may be");
            report.error(&at, format!("no column `{column}`"), help);
        } else if columns[..index].contains(column) {
            report.error(&at, format!("a second column `{column}`"), "name each column once");
        }
    }
    for needed in ["x_m", "y_m"] {
        if !columns.iter().any(|column| column == needed) && report.is_whole(path) {
            let help = "write, for example, `columns: [\"x_m\", \"y_m\", \"yaw_deg\"]`";
            report.error(path, format!("no column is `{needed}`"), help);
        }
    }
}
