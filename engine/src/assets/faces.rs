//! Polygons that a scene holds itself.

use glam::{DVec3, Vec3};

use super::import::{has_area, too_far};
use super::polygon::{Pieces, Tangled, triangulate};
use super::{AssetError, Loaded};
use crate::components::{Mesh, MeshPart};

/// The mesh of polygons, concave ones too, given by their corners, m. Those whose corners are equal to the
/// last bit are joined without a gap. Of one that crosses itself, what its outline encloses counts once, with
/// a warning.
///
/// # Errors
/// The first polygon without an area, that f32 cannot hold, or that crosses itself too often.
pub fn mesh_of_faces(faces: &[Vec<(f64, f64, f64)>]) -> Result<Loaded<Mesh>, AssetError> {
    let mut mesh = Mesh::default();
    let mut pieces = Pieces::default();
    let mut crossed = Vec::new();
    for (face, corners) in faces.iter().enumerate() {
        let corners: Vec<DVec3> = corners.iter().map(|&corner| corner.into()).collect();
        if corners.iter().any(|&corner| too_far(corner).is_some()) {
            return Err(AssetError::FarFace { face });
        }
        triangulate(&corners, &mut pieces).map_err(|Tangled| AssetError::CrossedFace { face })?;
        if pieces.is_crossed {
            crossed.push(face);
        }
        // As they are kept: what had an area may have none left in f32.
        let kept: Vec<Vec3> =
            corners.iter().chain(&pieces.crossings).map(|corner| corner.as_vec3()).collect();
        pieces.triangles.retain(|piece| has_area(piece.map(|corner| kept[corner].as_dvec3())));
        if pieces.triangles.is_empty() {
            return Err(AssetError::FlatFace { face });
        }
        let first = mesh.vertices.len();
        let triangle = |piece: &[usize; 3]| piece.map(|corner| (first + corner) as u32);
        mesh.triangles.extend(pieces.triangles.iter().map(triangle));
        mesh.vertices.extend(kept);
    }
    let warning = crossed.first().map(|first| {
        format!(
            "the outlines of {} of {} faces cross themselves (first: face {first}); what they enclose \
             counts once: check the order of their corners",
            crossed.len(),
            faces.len()
        )
    });
    let triangles = 0..mesh.triangles.len() as u32;
    mesh.parts.push(MeshPart { name: "faces".to_owned(), triangles, discs: 0..0 });
    Ok(Loaded { value: mesh, warnings: warning.into_iter().collect() })
}
