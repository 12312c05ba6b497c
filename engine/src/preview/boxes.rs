//! Boxes in place of meshes, for views of scenes whose meshes are too many or too large.

use glam::Vec3;

use crate::components::{Mesh, MeshBounds, MeshPart, PartMaterials};
use crate::run::LoadedScene;

/// Replaces each mesh of a scene by the box around it, which has the material of the mesh's largest part.
pub fn replace_by_boxes(loaded: &mut LoadedScene) {
    for (bounds, mesh, materials) in
        loaded.world.world.query_mut::<(&MeshBounds, &mut Mesh, &mut PartMaterials)>()
    {
        let areas = mesh.parts.iter().map(|part| mesh.part_area(part)).zip(&materials.0);
        let Some((_, &material)) = areas.max_by(|a, b| a.0.total_cmp(&b.0)) else { continue };
        *mesh = box_mesh(bounds);
        *materials = PartMaterials(vec![material]);
    }
    loaded.world.forget_geometry();
}

/// Six faces of a box, whose fronts are outside.
fn box_mesh(&MeshBounds { low, high }: &MeshBounds) -> Mesh {
    let corner = |index: u32| {
        let pick = |bit: u32, low: f32, high: f32| if index & bit == 0 { low } else { high };
        Vec3::new(pick(1, low.x, high.x), pick(2, low.y, high.y), pick(4, low.z, high.z))
    };
    // Corners of each face, counter-clockwise seen from outside; bits of a number are its place along x, y and z.
    let faces: [[u32; 4]; 6] =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles: Vec<[u32; 3]> =
        faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let part =
        MeshPart { name: "box".to_owned(), triangles: 0..triangles.len() as u32, discs: 0..0 };
    Mesh { vertices: (0..8).map(corner).collect(), triangles, discs: Vec::new(), parts: vec![part] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_is_closed_and_its_fronts_are_outside() {
        let (low, high) = (Vec3::new(-1.0, 2.0, 0.5), Vec3::new(2.0, 4.0, 5.5));
        let mesh = box_mesh(&MeshBounds { low, high });
        assert_eq!(mesh.bounds(), Some((low, high)));
        // The volume by the divergence theorem is that of the box only if all fronts are outside.
        let volume: f32 = (0..mesh.triangles.len())
            .map(|index| {
                let [a, b, c] = mesh.corners(index).map(|corner| corner - low);
                a.dot(b.cross(c)) / 6.0
            })
            .sum();
        assert!((volume - 30.0).abs() < 1e-4, "{volume}");
        assert!((mesh.part_area(&mesh.parts[0]) - 2.0 * (6.0 + 15.0 + 10.0)).abs() < 1e-4);
    }
}
