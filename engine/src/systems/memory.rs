use crate::components::SceneExtents;
use crate::document::Diagnostic;

/// Memory of a triangle or disc while its tree is built, bytes.
const PRIMITIVE_BYTES: u64 = 130;

/// Memory of an instance or an image while the tree over them is built, bytes.
const RECORD_BYTES: u64 = 330;

/// Returns an error if the ray engine will take more memory for the scene than is free, bytes.
pub(crate) fn check_memory(extents: &SceneExtents, free: u64) -> Option<Diagnostic> {
    let meshes = extents.primitives.saturating_mul(PRIMITIVE_BYTES);
    let records = extents.records.saturating_mul(RECORD_BYTES);
    let all = meshes.saturating_add(records);
    if all <= free {
        return None;
    }
    let size = crate::products::data_size;
    let message = format!(
        "the ray engine takes {} of memory for {} triangles and discs in meshes and {} instances, images \
             in neighbouring tiles included, and {} are free",
        size(all),
        extents.primitives,
        extents.records,
        size(free)
    );
    let (path, help) = if records > meshes {
        (&extents.most_records, "place fewer instances, or choose a larger tile")
    } else {
        (&extents.largest_mesh, "take meshes of fewer triangles, and place them more often")
    };
    Some(Diagnostic::error(path, message).help(help))
}
