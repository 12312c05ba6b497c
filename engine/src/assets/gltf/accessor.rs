//! Typed reads of accessors; every range is checked against the bytes that are there.

use ::gltf::Accessor;
use ::gltf::accessor::sparse::IndexType;
use ::gltf::accessor::{DataType, Dimensions};
use ::gltf::buffer::View;

use super::GltfError;
use super::buffers::Buffers;

/// Vectors of three or four numbers, such as positions in the file's unit; integers as
/// `KHR_mesh_quantization` has them.
pub(super) fn vectors<const N: usize>(
    accessor: &Accessor<'_>,
    buffers: &Buffers,
) -> Result<Vec<[f64; N]>, GltfError> {
    let index = accessor.index();
    let (dimensions, wanted) = match N {
        4 => (Dimensions::Vec4, "rotations (VEC4)"),
        _ => (Dimensions::Vec3, "positions (VEC3)"),
    };
    if accessor.dimensions() != dimensions || accessor.data_type() == DataType::U32 {
        return Err(GltfError::WrongType { accessor: index, wanted });
    }
    let (kind, normalized) = (accessor.data_type(), accessor.normalized());
    let component = kind.size();
    let vector = |item: &[u8]| -> [f64; N] {
        std::array::from_fn(|axis| value(kind, normalized, &item[axis * component..]))
    };
    let mut vectors: Vec<[f64; N]> = items(accessor, buffers)?.map(vector).collect();
    let Some(sparse) = accessor.sparse() else { return Ok(vectors) };
    let beyond = GltfError::BeyondBuffer { accessor: index };
    let (places, values) = (sparse.indices(), sparse.values());
    let place_size = match places.index_type() {
        IndexType::U8 => 1,
        IndexType::U16 => 2,
        IndexType::U32 => 4,
    };
    let count = sparse.count();
    let places = strided(&places.view(), places.offset(), count, place_size, buffers);
    let values = strided(&values.view(), values.offset(), count, N * component, buffers);
    let (Some(places), Some(values)) = (places, values) else { return Err(beyond) };
    for (place, item) in places.zip(values) {
        match vectors.get_mut(unsigned(place) as usize) {
            Some(replaced) => *replaced = vector(item),
            None => return Err(beyond),
        }
    }
    Ok(vectors)
}

/// Vertex indices.
pub(super) fn indices(accessor: &Accessor<'_>, buffers: &Buffers) -> Result<Vec<u32>, GltfError> {
    let lawful = matches!(accessor.data_type(), DataType::U8 | DataType::U16 | DataType::U32);
    if !lawful || accessor.dimensions() != Dimensions::Scalar || accessor.sparse().is_some() {
        let wanted = "indices (SCALAR, unsigned, not sparse)";
        return Err(GltfError::WrongType { accessor: accessor.index(), wanted });
    }
    Ok(items(accessor, buffers)?.map(unsigned).collect())
}

fn items<'b>(
    accessor: &Accessor<'_>,
    buffers: &'b Buffers,
) -> Result<impl Iterator<Item = &'b [u8]> + use<'b>, GltfError> {
    let index = accessor.index();
    let view = accessor.view().ok_or(GltfError::NoData { accessor: index })?;
    strided(&view, accessor.offset(), accessor.count(), accessor.size(), buffers)
        .ok_or(GltfError::BeyondBuffer { accessor: index })
}

/// `count` items of `size` bytes in a view; `None` if they do not all lie in it.
fn strided<'b>(
    view: &View<'_>,
    offset: usize,
    count: usize,
    size: usize,
    buffers: &'b Buffers,
) -> Option<impl Iterator<Item = &'b [u8]> + use<'b>> {
    let stride = view.stride().unwrap_or(size);
    let end = view.offset().checked_add(view.length())?;
    let bytes = buffers.0.get(view.buffer().index())?.get(view.offset()..end)?;
    let length = match count {
        0 => 0,
        _ => stride.checked_mul(count - 1)?.checked_add(size)?,
    };
    let bytes = bytes.get(offset..offset.checked_add(length)?)?;
    (stride >= size).then(|| bytes.chunks(stride).take(count).map(move |item| &item[..size]))
}

/// A little-endian unsigned number of up to four bytes.
fn unsigned(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |value, &byte| value << 8 | u32::from(byte))
}

fn value(kind: DataType, normalized: bool, bytes: &[u8]) -> f64 {
    let bits = unsigned(&bytes[..kind.size()]);
    let (value, full) = match kind {
        DataType::I8 => (f64::from(bits as u8 as i8), f64::from(i8::MAX)),
        DataType::U8 => (f64::from(bits as u8), f64::from(u8::MAX)),
        DataType::I16 => (f64::from(bits as u16 as i16), f64::from(i16::MAX)),
        DataType::U16 => (f64::from(bits as u16), f64::from(u16::MAX)),
        DataType::U32 => (f64::from(bits), f64::from(u32::MAX)),
        DataType::F32 => return f64::from(f32::from_bits(bits)),
    };
    if normalized { (value / full).max(-1.0) } else { value }
}
