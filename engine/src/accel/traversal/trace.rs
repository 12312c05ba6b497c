//! Traversal of both levels by one ray, generic over the instruction set.
//!
//! Boxes and primitives are tested eight at a time in `f32`, with bounds on the rounding error, so
//! that the result of a test is "missed", "surely hit" or "perhaps hit". Distances, and whatever is only
//! perhaps hit, are decided in `f64` by [`super::exact`]. The result is therefore the minimum of
//! `(distance, instance, primitive)` over all primitives, and depends neither on the hierarchy nor on
//! the instruction set nor on threads.

use std::{cmp::Ordering, hint::select_unpredictable};

use glam::DVec3;

use crate::accel::{
    layout::{ChildRef, MeshBvh, TwoLevelBvh, WideNode},
    simd::{Isa, Stack, StackMemory, prefetch},
};

use super::{
    exact,
    hit::SkippedLanes,
    ray::{BoxRay, MeshRay, WideRay, planar_distance},
    tiles::TileRay,
};

/// Primitive on a ray.
#[derive(Clone, Copy)]
pub(super) struct Candidate {
    pub distance: f64,
    /// Record of the instance or periodic copy.
    pub record: u32,
    /// Block that holds it.
    pub block: ChildRef,
    /// Lane of the block.
    pub lane: u8,
    /// Id of the lane: triangle or disc.
    pub id: u32,
}

/// Returns the closest primitive on a ray, or, with `any`, one of them.
#[inline(always)]
pub(super) fn trace<I: Isa>(isa: I, tile_ray: &TileRay<'_>, any: bool) -> Option<Candidate> {
    let mut memory = StackMemory::new();
    let mut traversal = Traversal::new(isa, tile_ray.bvh, &mut memory);
    if traversal.start(isa, *tile_ray, any) {
        while traversal.step(isa) {}
    }
    traversal.closest.candidate
}

/// State of the traversal of both levels by one ray.
pub(super) struct Traversal<'a, I: Isa> {
    pub tile_ray: TileRay<'a>,
    /// `true` if the search ends with the first candidate.
    pub any: bool,
    stack: Stack<'a>,
    /// Ray in the space of the hierarchy that it is in.
    boxes: BoxRay<I>,
    /// Nodes of that hierarchy.
    nodes: &'a [WideNode],
    /// Its leaves.
    leaves: LeafMemory,
    /// Distance in that space beyond which nothing counts.
    limit: f32,
    /// Number of entries of the stack that belong to the top level.
    base: usize,
    pub closest: ClosestCandidate,
    /// Distance at which the ray enters the box of the top level.
    enter: f64,
    /// Ray in the space of the top level.
    world: BoxRay<I>,
    mesh: Option<EnteredMesh<'a, I>>,
}

/// Addresses of the leaves of a hierarchy; only ever used to fetch them ahead.
#[derive(Clone, Copy)]
struct LeafMemory {
    /// First leaf.
    start: *const u8,
    /// Size of a leaf, bytes.
    size: usize,
}

impl LeafMemory {
    #[inline(always)]
    fn new<T>(leaves: &[T]) -> Self {
        Self { start: leaves.as_ptr().cast(), size: size_of::<T>() }
    }

    /// Blocks of the kind that the mesh has more of.
    #[inline(always)]
    fn of_mesh(mesh: &MeshBvh) -> Self {
        if mesh.discs.len() > mesh.planar.len() {
            Self::new(&mesh.discs)
        } else {
            Self::new(&mesh.planar)
        }
    }
}

/// Mesh whose hierarchy a ray is in.
struct EnteredMesh<'a, I: Isa> {
    mesh: &'a MeshBvh,
    record: u32,
    ray: MeshRay,
    wide: WideRay<I>,
    /// Lanes that the ray cannot hit here.
    skipped: SkippedLanes,
}

impl<'a, I: Isa> Traversal<'a, I> {
    /// Traversal without a ray; [`Self::start`] gives it one.
    #[inline(always)]
    pub(super) fn new(isa: I, bvh: &'a TwoLevelBvh, memory: &'a mut StackMemory) -> Self {
        let (origin, direction) = (DVec3::ZERO, DVec3::Z);
        let tile_ray = TileRay { bvh, origin, direction, tile: [0; 2], from: None, limit: 0.0 };
        let world = BoxRay::new(isa, [0.0; 3], [0.0, 0.0, 1.0]);
        Self {
            tile_ray,
            any: false,
            stack: Stack::new(memory),
            boxes: world,
            nodes: &bvh.instances.nodes,
            leaves: LeafMemory::new(&bvh.records),
            limit: 0.0,
            base: 0,
            closest: ClosestCandidate { limit: 0.0, candidate: None },
            enter: 0.0,
            world,
            mesh: None,
        }
    }

    /// Starts with a ray; returns `false` if nothing can be on it.
    #[inline(always)]
    pub(super) fn start(&mut self, isa: I, tile_ray: TileRay<'a>, any: bool) -> bool {
        let TileRay { bvh, origin, direction, limit, .. } = tile_ray;
        let Some(enter) = bvh.clip(origin, direction, limit) else {
            return false;
        };
        let start = origin + enter * direction - bvh.center;
        let direction = direction.as_vec3().to_array();
        (self.tile_ray, self.any) = (tile_ray, any);
        self.world = BoxRay::new(isa, start.as_vec3().to_array(), direction);
        self.boxes = self.world;
        self.nodes = &bvh.instances.nodes;
        self.leaves = LeafMemory::new(&bvh.records);
        self.limit = limit_above(limit - enter);
        self.base = 0;
        self.closest = ClosestCandidate { limit, candidate: None };
        self.enter = enter;
        self.mesh = None;
        self.stack.clear();
        self.stack.push(bvh.instances.root.0, 0.0);
        true
    }

    /// Visits the newest entry of the stack; returns whether there is more to do.
    ///
    /// Nothing here branches on how many children are hit or in which order: a branch that the processor
    /// cannot predict costs more than the work that it saves.
    #[inline(always)]
    pub(super) fn step(&mut self, isa: I) -> bool {
        let (at, near) = loop {
            match self.stack.pop(self.base) {
                None => return self.leave_mesh(),
                Some((at, near)) if near <= self.limit => break (ChildRef(at), near),
                Some(_) => {}
            }
        };
        if at.is_inner() {
            let node = &self.nodes[at.index()];
            let (enter, leave) = self.boxes.children(isa, node, isa.splat(self.limit));
            let order = node.order.0[self.boxes.octant & 7];
            self.stack.extend(isa, isa.compress_hits(order, enter, leave, &node.child));
            return true;
        }
        if self.mesh.is_none() {
            self.enter_mesh(isa, at.index() as u32, self.enter + f64::from(near));
            return true;
        }
        self.visit(isa, at);
        !self.any || self.closest.candidate.is_none()
    }

    /// Fetches the newest entry of the stack, which the next step visits unless it is farther than the closest hit.
    #[inline(always)]
    pub(super) fn prefetch(&self) {
        let Some(newest) = self.stack.newest() else { return };
        let newest = ChildRef(newest);
        let node = self.nodes.as_ptr().wrapping_add(newest.index()).cast();
        let leaf = self.leaves.start.wrapping_add(newest.index() * self.leaves.size);
        // No branch: the processor cannot predict what comes next.
        prefetch(select_unpredictable(newest.is_inner(), node, leaf));
    }

    #[inline(always)]
    fn enter_mesh(&mut self, isa: I, record: u32, start: f64) {
        let bvh = self.tile_ray.bvh;
        let mesh = bvh.mesh_of(record);
        let Some(ray) = MeshRay::new(&self.tile_ray, record, mesh, start) else { return };
        self.boxes = BoxRay::new(isa, ray.start_near, ray.direction_near);
        self.nodes = &mesh.tree.nodes;
        self.leaves = LeafMemory::of_mesh(mesh);
        self.limit = limit_above(self.closest.limit - ray.start).min(ray.beyond);
        self.base = self.stack.len();
        self.stack.push(mesh.tree.root.0, 0.0);
        let wide = WideRay::new(isa, &ray);
        let skipped = bvh.skipped(&self.tile_ray, record);
        self.mesh = Some(EnteredMesh { mesh, record, ray, wide, skipped });
    }

    /// Returns to the top level; `false` if the ray was there already.
    #[inline(always)]
    fn leave_mesh(&mut self) -> bool {
        if self.mesh.is_none() {
            return false;
        }
        self.mesh = None;
        self.boxes = self.world;
        self.nodes = &self.tile_ray.bvh.instances.nodes;
        self.leaves = LeafMemory::new(&self.tile_ray.bvh.records);
        self.limit = limit_above(self.closest.limit - self.enter);
        self.base = 0;
        true
    }

    /// Tests the primitives of a block.
    #[inline(always)]
    fn visit(&mut self, isa: I, block: ChildRef) {
        let Some(EnteredMesh { mesh, record, ray, wide, skipped }) = &self.mesh else { return };
        let keep = if block.0 == skipped.block.0 { !skipped.lanes } else { u32::MAX };
        let (mut perhaps, sure) = if block.is_discs() {
            wide.discs(isa, &mesh.discs[block.index()], ray, self.limit, keep)
        } else {
            wide.planar(isa, &mesh.planar[block.index()], self.limit, keep)
        };
        let record = *record;
        if self.any && sure != 0 {
            let (distance, lane, id) = (0.0, 0, 0);
            self.closest.candidate = Some(Candidate { distance, record, block, lane, id });
            return;
        }
        while perhaps != 0 {
            let lane = perhaps.trailing_zeros() as usize;
            perhaps &= perhaps - 1;
            let is_sure = sure >> lane & 1 != 0;
            let (distance, id) = if block.is_discs() {
                let block = &mesh.discs[block.index()];
                let (center, normal, radius) =
                    (block.center(lane), block.normal(lane), block.radius(lane));
                let distance =
                    exact::disc_distance(center, normal, radius, ray.origin, ray.direction);
                (distance, block.id.0[lane & 7])
            } else {
                let block = &mesh.planar[block.index()];
                let id = block.id.0[lane & 7];
                (planar_distance(&self.tile_ray, record, ray, block, lane, is_sure), id)
            };
            let Some(distance) = distance else { continue };
            if distance > 0.0 {
                let candidate = Candidate { distance, record, block, lane: lane as u8, id };
                self.closest.update(self.tile_ray.bvh, candidate);
                if self.any && self.closest.candidate.is_some() {
                    return;
                }
                self.limit = limit_above(self.closest.limit - ray.start).min(ray.beyond);
            }
        }
    }
}

/// `f32` that is not below a length of at least 0, computed without a branch.
#[inline(always)]
fn limit_above(length: f64) -> f32 {
    length as f32 * (1.0 + 2.0 * f32::EPSILON)
}

/// Closest candidate so far.
pub(super) struct ClosestCandidate {
    /// Its distance, or that of the ray's end.
    limit: f64,
    pub candidate: Option<Candidate>,
}

impl ClosestCandidate {
    #[inline(always)]
    fn update(&mut self, bvh: &TwoLevelBvh, candidate: Candidate) {
        let is_closer = match &self.candidate {
            None => candidate.distance < self.limit,
            Some(closest) => match candidate.distance.total_cmp(&closest.distance) {
                Ordering::Less => true,
                Ordering::Equal => bvh.rank(&candidate) < bvh.rank(closest),
                Ordering::Greater => false,
            },
        };
        if is_closer {
            self.limit = candidate.distance;
            self.candidate = Some(candidate);
        }
    }
}
