use glam::{DVec2, DVec3};

use super::surface::{Parts, TerrainSurface};
use crate::components::{Mesh, TerrainPatch};

/// The ground of a mesh that lies at `at`, m: its rectangle is the one around the mesh.
///
/// Triangles that face down are turned up: the front of the ground is the side of the air. Discs
/// are no ground. `None` if the mesh has no extent.
#[must_use]
pub fn mesh(mesh: &Mesh, at: DVec3, parts: Parts, is_periodic: bool) -> Option<TerrainPatch> {
    let corners: Vec<DVec3> = mesh.vertices.iter().map(|v| v.as_dvec3()).collect();
    let used = || mesh.triangles.iter().flatten().map(|&id| corners[id as usize].truncate());
    let low = used().reduce(DVec2::min)?;
    let size = used().reduce(DVec2::max)? - low;
    if size.min_element() <= 0.0 {
        return None;
    }
    let part_of = |triangle: u32| {
        mesh.parts.iter().position(|part| part.triangles.contains(&triangle)).unwrap_or(0) as u16
    };
    let triangles = mesh.triangles.iter().enumerate().map(|(index, &[a, b, c])| {
        let [p, q, r] = [a, b, c].map(|id| corners[id as usize].truncate());
        let faces_down = (q - p).perp_dot(r - p) < 0.0;
        (if faces_down { [a, c, b] } else { [a, b, c] }, part_of(index as u32))
    });
    let relative: Vec<DVec3> = corners.iter().map(|v| *v - low.extend(-at.z)).collect();
    let corner = low + at.truncate();
    let surface = TerrainSurface::new(corner, size, &relative, triangles.collect());
    Some(surface.finish(parts, is_periodic))
}
