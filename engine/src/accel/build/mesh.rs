//! Construction of the hierarchy of one mesh: its primitives are checked and put into blocks of eight.

use std::num::NonZeroU32;

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use crate::{
    components::{Disc, Mesh, MeshPart},
    geometry::round_up,
};

use crate::accel::{
    layout::{
        Bounds32, ChildRef, DiscBlock, MeshBvh, PARALLELOGRAM, PlanarBlock, SurfaceRange,
        slab_padding,
    },
    simd::{Lanes, Words, with_huge_pages},
};

use super::{
    BuildError, MeshInput,
    collapse::CollapsedBvh,
    leaves::Leaves,
    parallelogram::{self, PlanarPrimitive},
    wide::{self, BuildSettings},
};

/// Largest absolute coordinate, m: beyond it the products of the traversal would overflow.
const MAX_COORDINATE: f32 = 1e9;

/// Maximum number of primitives of a mesh.
const MAX_PRIMITIVES: usize = 1 << 29;

/// Builds the hierarchy of the mesh with this number.
///
/// # Errors
/// The first part of the mesh that is not valid.
pub(super) fn build(number: usize, input: &MeshInput<'_>) -> Result<MeshBvh, BuildError> {
    let MeshInput { mesh, surfaces } = *input;
    check_geometry(number, mesh)?;
    check_parts(number, mesh, surfaces)?;
    let primitives = Primitives::new(mesh);
    let boxes: Vec<_> =
        (0..primitives.len()).into_par_iter().map(|p| primitives.get(p).bounds()).collect();
    let bounds = boxes.par_iter().copied().reduce(|| Bounds32::EMPTY, Bounds32::union);
    let max_coordinate = if boxes.is_empty() { 0.0 } else { bounds.max_coordinate() };
    let settings =
        BuildSettings { leaf_size: 8, leaf_cost: 0.6, padding: slab_padding(max_coordinate) };
    let CollapsedBvh { mut tree, leaves } = wide::build(boxes, settings, |p| primitives.is_disc(p));
    let Blocks { references, planar, discs, second_triangles } = Blocks::new(&primitives, &leaves);
    wide::link_leaves(&mut tree, |leaf| references[leaf]);
    let ranges = |end: fn(&MeshPart) -> u32| {
        let parts = mesh.parts.iter().zip(surfaces);
        parts.map(|(part, &surface)| SurfaceRange { end: end(part), surface }).collect()
    };
    Ok(MeshBvh {
        tree,
        planar,
        discs,
        second_triangles,
        bounds,
        max_coordinate,
        triangles: mesh.triangles.len() as u32,
        triangle_surfaces: ranges(|part| part.triangles.end),
        disc_surfaces: ranges(|part| part.discs.end),
    })
}

/// Checks coordinates, corners and the number of primitives.
fn check_geometry(number: usize, mesh: &Mesh) -> Result<(), BuildError> {
    let is_valid = |v: Vec3| v.abs().cmple(Vec3::splat(MAX_COORDINATE)).all();
    let limit = MAX_COORDINATE;
    if let Some(vertex) = mesh.vertices.iter().position(|&v| !is_valid(v)) {
        let Vec3 { x, y, z } = mesh.vertices[vertex];
        return Err(BuildError::Vertex { mesh: number, vertex, x, y, z, limit });
    }
    let count = mesh.vertices.len();
    for (triangle, corners) in mesh.triangles.iter().enumerate() {
        if let Some(&vertex) = corners.iter().find(|&&corner| corner as usize >= count) {
            return Err(BuildError::Corner { mesh: number, triangle, vertex, count });
        }
    }
    let is_valid_disc = |disc: &Disc| {
        is_valid(disc.center) && disc.normal.is_finite() && disc.radius.abs() <= MAX_COORDINATE
    };
    if let Some(disc) = mesh.discs.iter().position(|disc| !is_valid_disc(disc)) {
        return Err(BuildError::Disc { mesh: number, disc, limit });
    }
    let count = mesh.triangles.len() + mesh.discs.len();
    if count > MAX_PRIMITIVES {
        return Err(BuildError::TooManyPrimitives { mesh: number, count, limit: MAX_PRIMITIVES });
    }
    Ok(())
}

/// Checks that there is a surface for each part, and that parts cover all primitives in order.
fn check_parts(number: usize, mesh: &Mesh, surfaces: &[u32]) -> Result<(), BuildError> {
    let parts = mesh.parts.len();
    if parts != surfaces.len() {
        return Err(BuildError::Surfaces { mesh: number, parts, surfaces: surfaces.len() });
    }
    let (mut triangle_end, mut disc_end) = (0, 0);
    for part in &mesh.parts {
        if (part.triangles.start, part.discs.start) != (triangle_end, disc_end) {
            break;
        }
        triangle_end = part.triangles.end.max(triangle_end);
        disc_end = part.discs.end.max(disc_end);
    }
    let (triangles, discs) = (mesh.triangles.len(), mesh.discs.len());
    if (triangle_end as usize, disc_end as usize) != (triangles, discs) {
        return Err(BuildError::Parts { mesh: number, triangles, discs });
    }
    Ok(())
}

/// Leaves of a mesh, in the order of the hierarchy.
struct Blocks {
    /// Block of each leaf.
    references: Vec<ChildRef>,
    planar: Vec<PlanarBlock>,
    discs: Vec<DiscBlock>,
    second_triangles: Vec<[u32; 8]>,
}

impl Blocks {
    fn new(primitives: &Primitives<'_>, leaves: &Leaves) -> Self {
        let (mut planar_leaves, mut disc_leaves) = (Vec::new(), Vec::new());
        let number = |leaves: &mut Vec<usize>, leaf, tag| {
            leaves.push(leaf);
            ChildRef(tag | (leaves.len() as u32 - 1))
        };
        let references = (0..leaves.ends.len())
            .map(|leaf| {
                if primitives.is_disc(leaves.get(leaf)[0]) {
                    number(&mut disc_leaves, leaf, ChildRef::LEAF | ChildRef::DISCS)
                } else {
                    number(&mut planar_leaves, leaf, ChildRef::LEAF)
                }
            })
            .collect();
        let members = |&leaf: &usize| leaves.get(leaf).iter().map(|&p| primitives.get(p));
        let mut planar = with_huge_pages(planar_leaves.len());
        let blocks = planar_leaves.par_iter().map(|leaf| planar_block(members(leaf)));
        blocks.collect_into_vec(&mut planar);
        let mut discs = with_huge_pages(disc_leaves.len());
        let blocks = disc_leaves.par_iter().map(|leaf| disc_block(members(leaf)));
        blocks.collect_into_vec(&mut discs);
        let is_apart = |planar: &PlanarPrimitive| {
            planar.second.is_some_and(|second| second.get() != planar.first + 1)
        };
        let second_triangles = if primitives.planar.par_iter().any(is_apart) {
            planar_leaves.par_iter().map(|&leaf| primitives.seconds(leaves.get(leaf))).collect()
        } else {
            Vec::new()
        };
        Self { references, planar, discs, second_triangles }
    }
}

fn planar_block(primitives: impl Iterator<Item = Primitive>) -> PlanarBlock {
    let zero = Lanes([0.0; 8]);
    let mut block =
        PlanarBlock { corners: [[zero; 3]; 3], edge: Lanes([-1.0; 8]), id: Words([0; 8]) };
    for (lane, primitive) in primitives.enumerate() {
        let Primitive::Planar { corners, first, second } = primitive else { continue };
        for (to, from) in block.corners.iter_mut().zip(corners) {
            for (axis, lanes) in to.iter_mut().enumerate() {
                lanes.0[lane] = from[axis];
            }
        }
        let [a, b, c] = corners.map(Vec3::as_dvec3);
        let edge = (b - a).length().max((c - a).length());
        block.edge.0[lane] = round_up(edge);
        block.id.0[lane] = if second.is_some() { first | PARALLELOGRAM } else { first };
    }
    block
}

fn disc_block(primitives: impl Iterator<Item = Primitive>) -> DiscBlock {
    let zero = Lanes([0.0; 8]);
    let mut block = DiscBlock {
        center: [zero; 3],
        normal: [zero; 3],
        radius: Lanes([-1.0; 8]),
        id: Words([0; 8]),
    };
    for (lane, primitive) in primitives.enumerate() {
        let Primitive::Disc { center, normal, radius, id } = primitive else { continue };
        for axis in 0..3 {
            block.center[axis].0[lane] = center[axis];
            block.normal[axis].0[lane] = normal[axis];
        }
        block.radius.0[lane] = radius;
        block.id.0[lane] = id;
    }
    block
}

/// Primitives of a mesh that have an area: planar ones, then discs.
struct Primitives<'a> {
    mesh: &'a Mesh,
    planar: Vec<PlanarPrimitive>,
    discs: Vec<u32>,
}

impl<'a> Primitives<'a> {
    fn new(mesh: &'a Mesh) -> Self {
        let has_area = |&id: &u32| {
            let disc = &mesh.discs[id as usize];
            disc.radius > 0.0 && disc.normal.as_dvec3().try_normalize().is_some()
        };
        let discs = (0..mesh.discs.len() as u32).filter(has_area).collect();
        Self { mesh, planar: parallelogram::planar_primitives(mesh), discs }
    }

    fn len(&self) -> u32 {
        (self.planar.len() + self.discs.len()) as u32
    }

    fn is_disc(&self, index: u32) -> bool {
        index >= self.planar.len() as u32
    }

    /// Second triangles of the planar primitives of a leaf; 0 if there is none.
    fn seconds(&self, leaf: &[u32]) -> [u32; 8] {
        let mut lanes = [0; 8];
        for (lane, &primitive) in lanes.iter_mut().zip(leaf) {
            *lane = self.planar[primitive as usize].second.map_or(0, NonZeroU32::get);
        }
        lanes
    }

    fn get(&self, index: u32) -> Primitive {
        if let Some(&PlanarPrimitive { first, second }) = self.planar.get(index as usize) {
            let second = second.map(NonZeroU32::get);
            let corners = parallelogram::corners(self.mesh, first, second);
            return Primitive::Planar { corners, first, second };
        }
        let id = self.discs[index as usize - self.planar.len()];
        let disc = &self.mesh.discs[id as usize];
        let normal = disc.normal.as_dvec3().normalize_or_zero().as_vec3();
        Primitive::Disc { center: disc.center, normal, radius: disc.radius, id }
    }
}

/// Primitive before it is put into a block.
#[derive(Clone, Copy)]
enum Primitive {
    /// Triangle, or, with a second one, a parallelogram.
    Planar { corners: [Vec3; 3], first: u32, second: Option<u32> },
    /// Disc with a unit normal.
    Disc { center: Vec3, normal: Vec3, radius: f32, id: u32 },
}

impl Primitive {
    fn bounds(&self) -> Bounds32 {
        match *self {
            Self::Planar { corners: [a, b, c], second, .. } => {
                let three = Bounds32 { min: a.min(b).min(c), max: a.max(b).max(c) };
                if second.is_none() {
                    return three;
                }
                let fourth = b.as_dvec3() + c.as_dvec3() - a.as_dvec3();
                three.union(Bounds32::from_f64(fourth, fourth))
            }
            Self::Disc { center, normal, radius, .. } => {
                // A disc extends to r sqrt(1 - n_i²) along axis i.
                let n = normal.as_dvec3();
                let n = n / n.length();
                let rounding = 1.0 + 1e-12;
                let extent = (DVec3::ONE - n * n + 1e-15).max(DVec3::ZERO).map(f64::sqrt);
                let extent = extent * f64::from(radius) * rounding;
                Bounds32::from_f64(center.as_dvec3() - extent, center.as_dvec3() + extent)
            }
        }
    }
}
