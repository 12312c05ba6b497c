/// Reason why no hierarchy can be built over meshes and instances.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "each variant's message names its fields")]
pub enum BuildError {
    #[error(
        "mesh {mesh}: vertex {vertex} is ({x}, {y}, {z}); coordinates must be finite and within \
         ±{limit:e} m"
    )]
    Vertex { mesh: usize, vertex: usize, x: f32, y: f32, z: f32, limit: f32 },
    #[error("mesh {mesh}: triangle {triangle} names vertex {vertex}, but there are only {count}")]
    Corner { mesh: usize, triangle: usize, vertex: u32, count: usize },
    #[error(
        "mesh {mesh}: disc {disc} needs centre, normal and radius to be finite, and to lie within \
         ±{limit:e} m"
    )]
    Disc { mesh: usize, disc: usize, limit: f32 },
    #[error("mesh {mesh} has {parts} parts but {surfaces} surfaces were given")]
    Surfaces { mesh: usize, parts: usize, surfaces: usize },
    #[error(
        "mesh {mesh}: its parts must cover all {triangles} triangles and {discs} discs in order"
    )]
    Parts { mesh: usize, triangles: usize, discs: usize },
    #[error("{count} primitives in mesh {mesh}; at most {limit} fit")]
    TooManyPrimitives { mesh: usize, count: usize, limit: usize },
    #[error("instance {instance} names mesh {mesh}, but there are only {count}")]
    Mesh { instance: usize, mesh: u32, count: usize },
    #[error(
        "instance {instance}: its translation must be finite and its linear map finite and \
         invertible; use scales that are not 0"
    )]
    Transform { instance: usize },
    #[error(
        "the domain must be a rectangle of finite size above 0, not ({min_x}, {min_y}) to \
         ({max_x}, {max_y})"
    )]
    Domain { min_x: f64, min_y: f64, max_x: f64, max_y: f64 },
    #[error(
        "{count} instances and periodic copies of instances; at most {limit} fit: use \
         a larger tile"
    )]
    TooManyCopies { count: usize, limit: usize },
}
