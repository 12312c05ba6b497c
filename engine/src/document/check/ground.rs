//! The frame and the terrain.

use super::super::scene::{Scene, Terrain};
use super::Report;
use super::mesh::check_material;

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
