//! The tree of one mesh: its primitives in blocks of eight, found and checked when it is built.

use std::num::NonZeroU32;

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use crate::{components::Mesh, geometry::Bounds};

use super::{
    BuildError, MeshInput, planar,
    simd::{Lanes, Words},
    tree::{self, Box3, Plan, Ref, Tree},
};

/// Set in a lane's id when the lane is a parallelogram.
pub(super) const PARALLELOGRAM: u32 = 1 << 31;

/// Coordinates beyond this would overflow the products of the traversal, m.
const FARTHEST: f32 = 1e9;

const MOST_PRIMITIVES: usize = 1 << 29;

/// Above this many primitives reinsertion tries half of the nodes: it is most of the time of a
/// build, and the other half spares one visit in a hundred.
const LARGE: usize = 1 << 20;

/// Up to eight triangles or parallelograms.
///
/// Corners are kept as the mesh has them, bit for bit, and not as edges: neighbours then agree on
/// which side of their common edge a ray passes.
#[derive(Clone, Debug)]
#[repr(C, align(32))]
pub(super) struct PlanarBlock {
    /// Three corners, each as x, y, z; a parallelogram's fourth is `b + c - a`.
    pub corners: [[Lanes; 3]; 3],
    /// Length of the longer of the two edges at the first corner; negative in an unused lane.
    pub edge: Lanes,
    /// Triangle in the mesh, the first of two with [`PARALLELOGRAM`].
    pub id: Words,
}

/// Up to eight discs.
#[derive(Clone, Debug)]
#[repr(C, align(32))]
pub(super) struct DiscBlock {
    pub center: [Lanes; 3],
    /// Unit within rounding.
    pub normal: [Lanes; 3],
    /// Negative in an unused lane.
    pub radius: Lanes,
    /// Disc in the mesh.
    pub id: Words,
}

/// One mesh, ready to be traced.
#[derive(Debug)]
pub(super) struct MeshTree {
    pub tree: Tree,
    pub planar: Vec<PlanarBlock>,
    pub discs: Vec<DiscBlock>,
    /// Second triangle of each lane of each planar block; empty if there is no parallelogram.
    seconds: Vec<[u32; 8]>,
    /// Box around all primitives, not padded.
    pub bounds: Box3,
    /// Largest absolute coordinate.
    pub reach: f32,
    /// Number of triangles in the mesh: where its discs are counted from.
    pub triangles: u32,
    /// End of each part's triangles, and its surface.
    triangle_surfaces: Vec<(u32, u32)>,
    /// End of each part's discs, and its surface.
    disc_surfaces: Vec<(u32, u32)>,
}

/// A primitive before it has a place in a block.
#[derive(Clone, Copy)]
pub(super) enum Primitive {
    /// A triangle, or, with a second one, a parallelogram.
    Planar {
        corners: [Vec3; 3],
        first: u32,
        second: Option<u32>,
    },
    Disc {
        center: Vec3,
        normal: Vec3,
        radius: f32,
        id: u32,
    },
}

impl MeshTree {
    /// Triangles and discs of the mesh that can be hit or were dropped as degenerate.
    pub(super) fn primitives(&self) -> usize {
        let discs = self.disc_surfaces.last().map_or(0, |&(end, _)| end);
        self.triangles as usize + discs as usize
    }

    /// Memory of the primitives, bytes, the tree's nodes not counted.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&*self.planar) + size_of_val(&*self.discs) + size_of_val(&*self.seconds)
    }

    pub(super) fn build(number: usize, input: &MeshInput<'_>) -> Result<Self, BuildError> {
        let MeshInput { mesh, surfaces } = *input;
        check(number, mesh, surfaces)?;
        let primitives = Primitives::of(mesh);
        let triangles = mesh.triangles.len() as u32;
        let boxes: Vec<_> =
            (0..primitives.len()).into_par_iter().map(|p| primitives.one(p).bounds()).collect();
        let bounds = boxes.par_iter().copied().reduce(|| Box3::EMPTY, Box3::union);
        let reach = if boxes.is_empty() { 0.0 } else { bounds.reach() };
        let reinsertion = if boxes.len() > LARGE { 0.5 } else { 1.0 };
        let plan = Plan { leaf: 8, leaf_cost: 0.6, pad: pad(reach), reinsertion };
        let (mut blocks, mut discs, mut seconds) = (Vec::new(), Vec::new(), Vec::new());
        let pairs = primitives.planar.iter().any(|&(_, second)| second.is_some());
        let is_disc = |p: u32| p >= primitives.planar.len() as u32;
        let tree = tree::build(boxes, plan, is_disc, |leaves| {
            if primitives.discs.is_empty() {
                blocks.reserve_exact(leaves);
            }
            let (blocks, discs, seconds) = (&mut blocks, &mut discs, &mut seconds);
            let (primitives, is_disc) = (&primitives, &is_disc);
            move |leaf: &[u32]| {
                let members = leaf.iter().map(|&p| primitives.one(p));
                if is_disc(leaf[0]) {
                    discs.push(DiscBlock::new(members));
                    return Ref(Ref::LEAF | Ref::OTHER | (discs.len() as u32 - 1));
                }
                if pairs {
                    let mut lanes = [0; 8];
                    for (lane, member) in lanes.iter_mut().zip(members.clone()) {
                        if let Primitive::Planar { second: Some(second), .. } = member {
                            *lane = second;
                        }
                    }
                    seconds.push(lanes);
                }
                blocks.push(PlanarBlock::new(members));
                Ref(Ref::LEAF | (blocks.len() as u32 - 1))
            }
        });
        let ends = |end: fn(&crate::components::MeshPart) -> u32| {
            mesh.parts.iter().zip(surfaces).map(|(part, &surface)| (end(part), surface)).collect()
        };
        Ok(Self {
            tree,
            planar: blocks,
            discs,
            seconds,
            bounds,
            reach,
            triangles,
            triangle_surfaces: ends(|part| part.triangles.end),
            disc_surfaces: ends(|part| part.discs.end),
        })
    }

    /// Where a ray in object space enters the box of the mesh.
    pub(super) fn clip(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        let room = 0.5 * f64::from(pad(self.reach));
        let Box3 { min, max } = self.bounds;
        let bounds = Bounds { min: min.as_dvec3() - room, max: max.as_dvec3() + room };
        bounds.clip(origin, direction).map(|(enter, _)| enter)
    }

    /// The second triangle of a parallelogram.
    pub(super) fn second(&self, block: Ref, lane: u8) -> u32 {
        self.seconds[block.index()][usize::from(lane & 7)]
    }

    /// The surface of a primitive, counted as in [`super::Hit::primitive`].
    pub(super) fn surface(&self, primitive: u32) -> u32 {
        let (ends, index) = if primitive < self.triangles {
            (&self.triangle_surfaces, primitive)
        } else {
            (&self.disc_surfaces, primitive - self.triangles)
        };
        ends[ends.partition_point(|&(end, _)| end <= index)].1
    }
}

/// By how much boxes grow so that the rounding of the slab test never loses a primitive.
///
/// The test runs on `|origin| <= 4 reach`; each of its roundings, of relative size 2⁻²⁴, moves a
/// plane of the box by at most that share of `|origin|`, of the plane's coordinate, or of the
/// distance between the two: together less than 32 · 2⁻²⁴ `reach`.
pub(super) fn pad(reach: f32) -> f32 {
    reach * (-19_f32).exp2()
}

fn check(number: usize, mesh: &Mesh, surfaces: &[u32]) -> Result<(), BuildError> {
    let lawful = |v: Vec3| v.abs().cmple(Vec3::splat(FARTHEST)).all();
    if let Some(vertex) = mesh.vertices.iter().position(|&v| !lawful(v)) {
        let Vec3 { x, y, z } = mesh.vertices[vertex];
        return Err(BuildError::Vertex { mesh: number, vertex, x, y, z, limit: FARTHEST });
    }
    let count = mesh.vertices.len();
    for (triangle, corners) in mesh.triangles.iter().enumerate() {
        if let Some(&vertex) = corners.iter().find(|&&corner| corner as usize >= count) {
            return Err(BuildError::Corner { mesh: number, triangle, vertex, count });
        }
    }
    let fine = |d: &crate::components::Disc| {
        lawful(d.center) && d.normal.is_finite() && d.radius.abs() <= FARTHEST
    };
    if let Some(disc) = mesh.discs.iter().position(|d| !fine(d)) {
        return Err(BuildError::Disc { mesh: number, disc, limit: FARTHEST });
    }
    let primitives = mesh.triangles.len() + mesh.discs.len();
    if primitives > MOST_PRIMITIVES {
        let limit = MOST_PRIMITIVES;
        return Err(BuildError::TooManyPrimitives { mesh: number, count: primitives, limit });
    }
    let parts = mesh.parts.len();
    if parts != surfaces.len() {
        return Err(BuildError::Surfaces { mesh: number, parts, surfaces: surfaces.len() });
    }
    let mut ends = (0, 0);
    for part in &mesh.parts {
        if (part.triangles.start, part.discs.start) != ends {
            break;
        }
        ends = (part.triangles.end.max(ends.0), part.discs.end.max(ends.1));
    }
    let (triangles, discs) = (mesh.triangles.len(), mesh.discs.len());
    if (ends.0 as usize, ends.1 as usize) != (triangles, discs) {
        return Err(BuildError::Parts { mesh: number, triangles, discs });
    }
    Ok(())
}

/// The primitives of a mesh that have an area: planar ones, then discs.
struct Primitives<'a> {
    mesh: &'a Mesh,
    planar: Vec<(u32, Option<NonZeroU32>)>,
    discs: Vec<u32>,
}

impl<'a> Primitives<'a> {
    fn of(mesh: &'a Mesh) -> Self {
        let has_area = |&id: &u32| {
            let disc = &mesh.discs[id as usize];
            disc.radius > 0.0 && disc.normal.as_dvec3().try_normalize().is_some()
        };
        let discs = (0..mesh.discs.len() as u32).filter(has_area).collect();
        Self { mesh, planar: planar::primitives(mesh), discs }
    }

    fn len(&self) -> u32 {
        (self.planar.len() + self.discs.len()) as u32
    }

    fn one(&self, index: u32) -> Primitive {
        if let Some(&(first, second)) = self.planar.get(index as usize) {
            let second = second.map(NonZeroU32::get);
            let corners = planar::corners(self.mesh, first, second);
            return Primitive::Planar { corners, first, second };
        }
        let id = self.discs[index as usize - self.planar.len()];
        let disc = &self.mesh.discs[id as usize];
        let normal = disc.normal.as_dvec3().normalize_or_zero().as_vec3();
        Primitive::Disc { center: disc.center, normal, radius: disc.radius, id }
    }
}

impl Primitive {
    fn bounds(&self) -> Box3 {
        match *self {
            Self::Planar { corners: [a, b, c], second, .. } => {
                let three = Box3 { min: a.min(b).min(c), max: a.max(b).max(c) };
                if second.is_none() {
                    return three;
                }
                let fourth = b.as_dvec3() + c.as_dvec3() - a.as_dvec3();
                three.union(outward(fourth, fourth))
            }
            Self::Disc { center, normal, radius, .. } => {
                // A disc reaches r sqrt(1 - n_i²) along axis i.
                let n = normal.as_dvec3();
                let n = n / n.length();
                let rounding = 1.0 + 1e-12;
                let reach = (DVec3::ONE - n * n + 1e-15).max(DVec3::ZERO).map(f64::sqrt);
                let reach = reach * f64::from(radius) * rounding;
                outward(center.as_dvec3() - reach, center.as_dvec3() + reach)
            }
        }
    }
}

/// The smallest `f32` box around an `f64` one.
pub(super) fn outward(min: DVec3, max: DVec3) -> Box3 {
    use crate::geometry::{round_down, round_up};
    Box3 {
        min: Vec3::new(round_down(min.x), round_down(min.y), round_down(min.z)),
        max: Vec3::new(round_up(max.x), round_up(max.y), round_up(max.z)),
    }
}

impl PlanarBlock {
    fn new(primitives: impl Iterator<Item = Primitive>) -> Self {
        let zero = Lanes([0.0; 8]);
        let mut block = Self { corners: [[zero; 3]; 3], edge: Lanes([-1.0; 8]), id: Words([0; 8]) };
        for (lane, primitive) in primitives.enumerate() {
            let Primitive::Planar { corners, first, second } = primitive else { continue };
            for (to, from) in block.corners.iter_mut().zip(corners) {
                for (axis, lanes) in to.iter_mut().enumerate() {
                    lanes.0[lane] = from[axis];
                }
            }
            let [a, b, c] = corners.map(Vec3::as_dvec3);
            let edge = (b - a).length().max((c - a).length());
            block.edge.0[lane] = crate::geometry::round_up(edge);
            block.id.0[lane] = if second.is_some() { first | PARALLELOGRAM } else { first };
        }
        block
    }

    /// Corners of one lane, m, object space.
    #[inline(always)]
    pub(super) fn lane(&self, lane: usize) -> [DVec3; 3] {
        let lane = lane & 7;
        self.corners.each_ref().map(|corner| {
            DVec3::new(corner[0].0[lane].into(), corner[1].0[lane].into(), corner[2].0[lane].into())
        })
    }
}

impl DiscBlock {
    fn new(primitives: impl Iterator<Item = Primitive>) -> Self {
        let zero = Lanes([0.0; 8]);
        let mut block = Self {
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

    /// Centre, normal and radius of one lane, object space.
    #[inline(always)]
    pub(super) fn lane(&self, lane: usize) -> (DVec3, DVec3, f64) {
        let lane = lane & 7;
        let vector = |of: &[Lanes; 3]| {
            DVec3::new(of[0].0[lane].into(), of[1].0[lane].into(), of[2].0[lane].into())
        };
        (vector(&self.center), vector(&self.normal), self.radius.0[lane].into())
    }
}
