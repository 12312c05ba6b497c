//! Elements of a PLY file as `ply-rs-bw` fills them.

use ply_rs_bw::ply::{BeginList, Property, PropertyAccess, PropertyAccessResult};

/// Names that programs give to the list of a face's vertices.
pub(super) const INDICES: [&str; 2] = ["vertex_indices", "vertex_index"];

/// Number in a scalar of any type.
fn number(property: &Property) -> Option<f64> {
    match *property {
        Property::Char(value) => Some(value.into()),
        Property::UChar(value) => Some(value.into()),
        Property::Short(value) => Some(value.into()),
        Property::UShort(value) => Some(value.into()),
        Property::Int(value) => Some(value.into()),
        Property::UInt(value) => Some(value.into()),
        Property::Float(value) => Some(value.into()),
        Property::Double(value) => Some(value),
        _ => None,
    }
}

/// Place of a vertex, in the file's unit and axes.
#[derive(Debug, Default)]
pub(super) struct PlyVertex(pub(super) [f64; 3]);

impl PlyVertex {
    fn set(&mut self, name: &str, value: f64) -> PropertyAccessResult {
        let place = match name {
            "x" => 0,
            "y" => 1,
            "z" => 2,
            _ => return PropertyAccessResult::Ignored,
        };
        self.0[place] = value;
        PropertyAccessResult::Set
    }
}

impl PropertyAccess for PlyVertex {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        number(&property).map_or(PropertyAccessResult::Ignored, |value| self.set(name, value))
    }

    fn set_float(&mut self, name: &str, value: f32) -> PropertyAccessResult {
        self.set(name, value.into())
    }

    fn set_double(&mut self, name: &str, value: f64) -> PropertyAccessResult {
        self.set(name, value)
    }
}

/// Vertices of a face; one of the lists is empty.
#[derive(Debug, Default)]
pub(super) struct PlyFace {
    signed: Vec<i32>,
    unsigned: Vec<u32>,
}

impl PlyFace {
    /// Indices of its vertices.
    pub(super) fn corners(&self) -> impl Iterator<Item = i64> {
        let signed = self.signed.iter().map(|&index| i64::from(index));
        signed.chain(self.unsigned.iter().map(|&index| i64::from(index)))
    }

    /// Number of its corners.
    pub(super) fn len(&self) -> usize {
        self.signed.len() + self.unsigned.len()
    }
}

impl PropertyAccess for PlyFace {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if !INDICES.contains(&name) {
            return PropertyAccessResult::Ignored;
        }
        self.signed = match property {
            Property::ListChar(list) => list.into_iter().map(i32::from).collect(),
            Property::ListUChar(list) => list.into_iter().map(i32::from).collect(),
            Property::ListShort(list) => list.into_iter().map(i32::from).collect(),
            Property::ListUShort(list) => list.into_iter().map(i32::from).collect(),
            _ => return PropertyAccessResult::UnsupportedType,
        };
        PropertyAccessResult::Set
    }

    fn begin_list_int(&mut self, name: &str, _: usize) -> BeginList<'_, i32> {
        if INDICES.contains(&name) {
            BeginList::Fill(&mut self.signed)
        } else {
            BeginList::UseSetter
        }
    }

    fn begin_list_uint(&mut self, name: &str, _: usize) -> BeginList<'_, u32> {
        if INDICES.contains(&name) {
            BeginList::Fill(&mut self.unsigned)
        } else {
            BeginList::UseSetter
        }
    }
}

/// An element of which nothing is kept.
#[derive(Debug)]
pub(super) struct Skipped;

impl PropertyAccess for Skipped {
    fn new() -> Self {
        Self
    }
}
