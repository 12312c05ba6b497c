//! The frame and the terrain.

use super::super::scene::{NoData, RasterWindow, Scene, Terrain, TerrainPlane, TerrainRaster};
use super::{Report, ScenePath};

pub(super) fn check_frame(scene: &Scene, report: &mut Report<'_>) {
    let (x, y, z) = scene.frame.origin_m;
    report.finite(["frame", "origin_m"], &[x, y, z]);
}

pub(super) fn check_terrain(scene: &Scene, report: &mut Report<'_>) {
    let at = ScenePath::from("terrain");
    match &scene.terrain {
        Terrain::Plane(TerrainPlane { size_m, material: _, corner_m, height_m }) => {
            check_rectangle(Some(*size_m), Some(*corner_m), report);
            report.finite(at.key("height_m"), &[*height_m]);
        }
        Terrain::Raster(TerrainRaster {
            material,
            land_cover,
            tolerance_m,
            no_data,
            corner_m,
            size_m,
            lowest_m,
            window,
            height_unit_m,
            ..
        }) => {
            if let Some(RasterWindow { corner_m: (x, y), size_m: (width, height) }) = window {
                report.finite(at.key("window").key("corner_m"), &[*x, *y]);
                report.above_zero(at.key("window").key("size_m").index(0), *width);
                report.above_zero(at.key("window").key("size_m").index(1), *height);
                if corner_m.is_some() || size_m.is_some() {
                    let message = "a window and a place of the raster's own contradict each other";
                    let help = "take `corner_m` and `size_m` out, or `window`";
                    report.error(at.key("window"), message, help);
                }
            }
            if let Some(unit) = height_unit_m {
                report.above_zero(at.key("height_unit_m"), *unit);
            }
            check_rectangle(*size_m, *corner_m, report);
            report.at_least(at.key("tolerance_m"), *tolerance_m, 0.0);
            report.finite(at.key("lowest_m"), lowest_m.as_slice());
            if let NoData::Height(height) = no_data {
                report.finite(at.key("no_data"), &[*height]);
            }
            check_covering(material.is_some(), land_cover.is_some(), report);
        }
        Terrain::Mesh { mesh: _, at_m: (x, y, z) } => {
            report.finite(at.key("at_m"), &[*x, *y, *z]);
        }
    }
}

fn check_rectangle(size: Option<(f64, f64)>, corner: Option<(f64, f64)>, report: &mut Report<'_>) {
    let at = ScenePath::from("terrain");
    if let Some((width, height)) = size {
        report.above_zero(at.key("size_m").index(0), width);
        report.above_zero(at.key("size_m").index(1), height);
    }
    if let Some((x, y)) = corner {
        report.finite(at.key("corner_m"), &[x, y]);
    }
}

/// One material or one for each class.
fn check_covering(has_material: bool, has_land_cover: bool, report: &mut Report<'_>) {
    let at = ScenePath::from("terrain");
    match (has_material, has_land_cover) {
        (true, true) => {
            let message = "the ground has both a `material` and a `land_cover`";
            report.error(at.key("material"), message, "take one of the two out");
        }
        (false, false) if report.is_whole("terrain") => {
            let help = "write `material: \"soil\"`, or `land_cover: (file: \"classes.asc\", \
                        classes: { \"1\": \"soil\" })`";
            report.error("terrain", "the ground has no material", help);
        }
        _ => {}
    }
}
