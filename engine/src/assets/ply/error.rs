/// Error of a PLY file; vertices and faces count from 0.
use crate::counts::counted;

#[non_exhaustive]
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "each variant's message names its fields")]
pub enum PlyError {
    #[error("is no PLY file that can be read: {0}")]
    Malformed(String),
    #[error("has no element `{0}` of vertices with `x`, `y` and `z`; export the mesh again")]
    NoVertices(&'static str),
    #[error(
        "holds points and no faces; make a mesh of them, or a table of discs for `Discs` (radius,x,y,z,nx,ny,nz)"
    )]
    NoFaces,
    #[error("holds triangle strips; export it with plain faces (MeshLab and Blender do)")]
    Strips,
    #[error("vertex {vertex} has the coordinate {value}; write a finite number")]
    NotFinite { vertex: usize, value: f64 },
    #[error(
        "vertex {vertex}: coordinate {value:e} m is too large to keep; check the length of its unit"
    )]
    FarVertex { vertex: usize, value: f64 },
    #[error(
        "face {face} has the vertex {index}, but the file has {} (counted from 0)",
        counted(.count, "vertex")
    )]
    NoSuchVertex { face: usize, index: i64, count: usize },
    #[error("face {face} has {found} corners; write at least three")]
    ShortFace { face: usize, found: usize },
    #[error("face {face} has {found} corners, more than {most}; split it into triangles")]
    LongFace { face: usize, found: usize, most: usize },
    #[error("the outline of face {face} crosses itself too often; split it into triangles")]
    TangledFace { face: usize },
}
