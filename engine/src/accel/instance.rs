//! Instances: where each stands, its box in the world, and its images in a periodic tile.

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use crate::geometry::Bounds;

use super::{
    BuildError, Domain, InstanceInput,
    mesh::MeshTree,
    tree::{Box3, Ref},
};

/// An instance, or an image of one in the neighbourhood of the tile.
///
/// The map is rounded to `f32` once, when the scene is built, and then exact by definition: rays,
/// points, normals and boxes all follow from it.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Record {
    /// By columns.
    pub object_from_world: [f32; 9],
    pub mesh: u32,
    pub translation: DVec3,
}

const MOST_RECORDS: usize = 1 << 30;

/// Boxes that an instance's box is the sum of.
const CUT: usize = 64;

/// Records of all instances, and their boxes; the box of an instance without primitives is empty.
pub(super) fn records(
    meshes: &[MeshTree],
    instances: &[InstanceInput],
) -> Result<(Vec<Record>, Vec<Bounds>), BuildError> {
    if instances.len() > MOST_RECORDS {
        return Err(BuildError::TooManyImages { count: instances.len(), limit: MOST_RECORDS });
    }
    let cuts: Vec<_> = meshes.iter().map(cut).collect();
    let made: Result<Vec<_>, _> = instances
        .par_iter()
        .enumerate()
        .map(|(number, input)| {
            let Some(cut) = cuts.get(input.mesh as usize) else {
                let (mesh, count) = (input.mesh, meshes.len());
                return Err(BuildError::Mesh { instance: number, mesh, count });
            };
            place(input, cut).ok_or(BuildError::Transform { instance: number })
        })
        .collect();
    Ok(made?.into_iter().unzip())
}

fn place(input: &InstanceInput, cut: &[Box3]) -> Option<(Record, Bounds)> {
    let determinant = input.linear.determinant();
    if !determinant.is_finite() || determinant == 0.0 || !input.translation.is_finite() {
        return None;
    }
    let object_from_world = input.linear.inverse().to_cols_array().map(|v| v as f32);
    let exact = DMat3::from_cols_array(&object_from_world.map(f64::from));
    let determinant = exact.determinant();
    let linear = exact.inverse();
    if !determinant.is_finite() || determinant == 0.0 || !linear.is_finite() {
        return None;
    }
    let absolute = DMat3::from_cols(linear.x_axis.abs(), linear.y_axis.abs(), linear.z_axis.abs());
    let bounds = cut.iter().fold(Bounds::EMPTY, |all, part| {
        let (min, max) = (part.min.as_dvec3(), part.max.as_dvec3());
        let center = linear * (0.5 * (min + max)) + input.translation;
        let half = absolute * (0.5 * (max - min));
        all.union(Bounds { min: center - half, max: center + half })
    });
    let Bounds { min, max } = bounds;
    let lawful = cut.is_empty() || (min.is_finite() && max.is_finite());
    lawful.then_some((
        Record { object_from_world, mesh: input.mesh, translation: input.translation },
        bounds,
    ))
}

/// A few boxes around parts of a mesh: tighter, when turned, than the one around all of it.
fn cut(mesh: &MeshTree) -> Vec<Box3> {
    if mesh.tree.root == Ref::NONE {
        return Vec::new();
    }
    let mut parts = vec![(mesh.bounds, mesh.tree.root)];
    let mut next = 0;
    while next < parts.len() && parts.len() + 7 <= CUT {
        let (_, at) = parts[next];
        if !at.is_inner() {
            next += 1;
            continue;
        }
        parts.remove(next);
        let node = &mesh.tree.nodes[at.index()];
        for slot in 0..8 {
            let child = Ref(node.child.0[slot]);
            if child != Ref::NONE {
                let side = |side: usize| {
                    glam::Vec3::from_array(std::array::from_fn(|axis| {
                        node.bounds[axis][side].0[slot]
                    }))
                };
                // The mesh's own box is not padded.
                let part =
                    Box3 { min: side(0).max(mesh.bounds.min), max: side(1).min(mesh.bounds.max) };
                parts.push((part, child));
            }
        }
    }
    parts.into_iter().map(|(part, _)| part).collect()
}

/// Copies of border-crossing instances; records beyond the originals are theirs.
#[derive(Debug, Default)]
pub(super) struct Images {
    originals: u32,
    /// Original, and how many periods the image stands away from it.
    of: Vec<(u32, [i32; 2])>,
}

impl Images {
    /// Number of images.
    pub(super) fn count(&self) -> usize {
        self.of.len()
    }

    /// Memory of the table, bytes.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&*self.of)
    }

    /// Adds the images that reach into the tile, and cuts every box to the tile: what lies outside
    /// is found as itself by a ray that has left the tile.
    pub(super) fn add(
        records: &mut Vec<Record>,
        boxes: &mut Vec<Bounds>,
        domain: &Domain,
    ) -> Result<Self, BuildError> {
        let size = domain.max - domain.min;
        // Rays may overrun the tile by rounding; see `tile::walk`.
        let place = domain.min.abs().max(domain.max.abs()).max_element();
        let room = place * (-36_f64).exp2();
        let tile = |z: f64, room: f64| Bounds {
            min: (domain.min - room).extend(-z),
            max: (domain.max + room).extend(z),
        };
        let tile = tile(f64::INFINITY, room);
        let originals = records.len();
        let mut of = Vec::new();
        for index in 0..originals {
            let Bounds { min, max } = boxes[index];
            if boxes[index].is_empty() {
                continue;
            }
            // The offsets k for which min + k size <= tile.max and max + k size >= tile.min.
            let first = ((tile.min - max).truncate() / size).ceil();
            let last = ((tile.max - min).truncate() / size).floor();
            let images = (last - first + 1.0).max(glam::DVec2::ZERO);
            let count = (images.x * images.y) as usize;
            if records.len() + count > MOST_RECORDS {
                let count = records.len() + count;
                return Err(BuildError::TooManyImages { count, limit: MOST_RECORDS });
            }
            let mut own = Bounds::EMPTY;
            for j in first.y as i32..=last.y as i32 {
                for i in first.x as i32..=last.x as i32 {
                    let shift = DVec3::new(f64::from(i) * size.x, f64::from(j) * size.y, 0.0);
                    let part = Bounds {
                        min: (min + shift).max(tile.min),
                        max: (max + shift).min(tile.max),
                    };
                    if (i, j) == (0, 0) {
                        own = part;
                        continue;
                    }
                    let record = records[index];
                    records.push(Record { translation: record.translation + shift, ..record });
                    boxes.push(part);
                    of.push((index as u32, [i, j]));
                }
            }
            boxes[index] = own;
        }
        Ok(Self { originals: originals as u32, of })
    }

    /// The instance that a record is, or is an image of, and how many periods it stands away.
    #[inline(always)]
    pub(super) fn original(&self, record: u32) -> (u32, [i32; 2]) {
        match record.checked_sub(self.originals) {
            Some(image) => self.of.get(image as usize).copied().unwrap_or((record, [0, 0])),
            None => (record, [0, 0]),
        }
    }
}
