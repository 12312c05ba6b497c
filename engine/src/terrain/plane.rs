use glam::{DVec2, Vec3};

use crate::components::{MaterialId, Mesh, MeshPart, PartMaterials, TerrainPatch};

/// A horizontal rectangle of one material.
#[must_use]
pub fn plane(corner: DVec2, size: DVec2, height: f64, material: MaterialId) -> TerrainPatch {
    TerrainPatch {
        projection: None,
        corner,
        size,
        base: height,
        unit: 1.0,
        mesh: Mesh {
            vertices: vec![Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            discs: Vec::new(),
            parts: vec![MeshPart { name: "ground".to_owned(), triangles: 0..2, discs: 0..0 }],
        },
        materials: PartMaterials(vec![material]),
        first_cut: 2,
    }
}
