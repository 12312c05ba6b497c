//! The traversal, generic over the instruction set.
//!
//! Boxes and primitives are tested eight at a time in `f32`, with bounds on the rounding error, so
//! that a test says "missed", "certainly hit" or "perhaps". Distances, and whatever is only
//! perhaps hit, are decided in `f64` by [`super::exact`]. The answer is therefore the least
//! `(distance, instance, primitive)` over all primitives, and depends neither on the tree nor on
//! the instruction set nor on threads.

use std::cmp::Ordering;

use glam::DVec3;

use super::{
    exact,
    mesh::MeshTree,
    ray::{BoxRay, MeshRay, WideRay, planar_distance},
    scene::Scene,
    simd::{Isa, Space, Stack},
    tile::Tiles,
    tree::{Node, Ref},
    types::{Departure, Hit, Ray},
};

/// One ray in one tile.
#[derive(Clone, Copy)]
pub(super) struct Query<'a> {
    pub scene: &'a Scene,
    /// In the tile's frame.
    pub origin: DVec3,
    pub direction: DVec3,
    /// Which tile: how many periods the frame lies from that of the ray.
    pub tile: [i32; 2],
    pub from: Option<Departure>,
    /// Primitives at this distance or farther do not count.
    pub limit: f64,
}

/// A primitive on a ray.
#[derive(Clone, Copy)]
pub(super) struct Found {
    pub distance: f64,
    /// Which instance or image.
    pub record: u32,
    /// Which block, and which lane of it.
    pub block: Ref,
    pub lane: u8,
    /// Triangle or disc.
    pub id: u32,
}

/// The closest primitive on a ray, or any.
#[inline(always)]
pub(super) fn trace<I: Isa>(isa: I, query: &Query<'_>, any: bool) -> Option<Found> {
    let mut space = Space::new();
    let mut walk = Walk::at_rest(isa, query.scene, &mut space);
    if walk.aim(isa, *query, any) {
        while walk.step(isa) {}
    }
    walk.best.found
}

/// Rays that are traced side by side.
const LINES: usize = 3;

/// Rays, and where to write what is on them.
#[derive(Debug)]
pub struct Batch<'a> {
    /// Rays of which any surface is asked for.
    pub shadows: &'a [Ray],
    /// Of each whether there is one.
    pub dark: &'a mut [bool],
    /// Rays of which the first surface is asked for.
    pub rays: &'a [Ray],
    /// That of each.
    pub hits: &'a mut [Option<Hit>],
}

/// Traces rays side by side, as many as there are lines; a line that has come to its end takes the next.
///
/// Each step of a walk waits for the one before: for a node, then for what its boxes say. Walks that
/// know nothing of each other fill each other's waiting time.
#[inline(always)]
pub(super) fn trace_each<I: Isa>(isa: I, scene: &Scene, batch: Batch<'_>) {
    let Batch { shadows, dark, rays, hits } = batch;
    dark.fill(false);
    hits.fill(None);
    let mut spaces: [Space; LINES] = std::array::from_fn(|_| Space::new());
    // The closest hit takes longer to find: what is short comes last, when lines run empty.
    let mut waiting = rays
        .iter()
        .enumerate()
        .map(|(index, ray)| (index, ray, false))
        .chain(shadows.iter().enumerate().map(|(index, ray)| (index, ray, true)));
    let mut lines = spaces.each_mut().map(|space| Line {
        walk: Walk::at_rest(isa, scene, space),
        tiles: None,
        index: 0,
        goes: true,
    });
    for line in &mut lines {
        line.goes = line.take_ray(isa, scene, &mut waiting);
    }
    let mut going = lines.iter().filter(|line| line.goes).count();
    while going > 0 {
        for line in &mut lines {
            if !line.goes || line.walk.step(isa) {
                continue;
            }
            let Some(found) = line.walk.best.found else {
                line.goes = line.take_tile(isa) || line.take_ray(isa, scene, &mut waiting);
                going -= usize::from(!line.goes);
                continue;
            };
            if line.walk.any {
                dark[line.index] = true;
            } else {
                hits[line.index] = Some(scene.resolve(&line.walk.query, &found));
            }
            line.goes = line.take_ray(isa, scene, &mut waiting);
            going -= usize::from(!line.goes);
        }
    }
}

/// One of the walks of [`trace_each`].
struct Line<'a, I: Isa> {
    walk: Walk<'a, I>,
    /// The rest of its ray's way.
    tiles: Option<Tiles<'a>>,
    /// Which ray it is.
    index: usize,
    goes: bool,
}

impl<'a, I: Isa> Line<'a, I> {
    /// Goes on with its ray in the next tile that holds anything; whether there is one.
    #[inline(always)]
    fn take_tile(&mut self, isa: I) -> bool {
        let Some(tiles) = &mut self.tiles else { return false };
        let any = self.walk.any;
        // No closure: that would not be compiled for the instruction set.
        for query in tiles.by_ref() {
            if self.walk.aim(isa, query, any) {
                return true;
            }
        }
        false
    }

    /// Goes on with the next ray that anything could be on; whether there is one.
    #[inline(always)]
    fn take_ray(
        &mut self,
        isa: I,
        scene: &'a Scene,
        waiting: &mut impl Iterator<Item = (usize, &'a Ray, bool)>,
    ) -> bool {
        for (index, ray, any) in waiting.by_ref() {
            self.index = index;
            self.tiles = Some(Tiles::new(scene, ray, f64::INFINITY));
            self.walk.any = any;
            if self.take_tile(isa) {
                return true;
            }
        }
        false
    }
}

/// The state of one ray's way through both levels of trees.
struct Walk<'a, I: Isa> {
    query: Query<'a>,
    /// Whether any primitive will do.
    any: bool,
    stack: Stack<'a>,
    /// The ray in the space of the tree that it is in.
    boxes: BoxRay<I>,
    /// Nodes of that tree.
    nodes: &'a [Node],
    /// Beyond this, in that tree's distances, nothing counts.
    limit: f32,
    /// Entries of the stack that belong to the tree above.
    base: usize,
    best: Best,
    /// Distance at which the tree over instances starts to count.
    enter: f64,
    /// The ray in the space of that tree.
    world: BoxRay<I>,
    inside: Option<Inside<'a, I>>,
}

/// The mesh that a ray is in.
struct Inside<'a, I: Isa> {
    mesh: &'a MeshTree,
    record: u32,
    ray: MeshRay,
    wide: WideRay<I>,
    /// The block and its lanes that the ray cannot hit here.
    skip: (u32, u32),
}

impl<'a, I: Isa> Walk<'a, I> {
    /// One that has nothing to do until it is aimed.
    #[inline(always)]
    fn at_rest(isa: I, scene: &'a Scene, space: &'a mut Space) -> Self {
        let (origin, direction) = (DVec3::ZERO, DVec3::Z);
        let query = Query { scene, origin, direction, tile: [0; 2], from: None, limit: 0.0 };
        let world = BoxRay::new(isa, [0.0; 3], [0.0, 0.0, 1.0]);
        Self {
            query,
            any: false,
            stack: Stack::new(space),
            boxes: world,
            nodes: &scene.instances().nodes,
            limit: 0.0,
            base: 0,
            best: Best { limit: 0.0, found: None },
            enter: 0.0,
            world,
            inside: None,
        }
    }

    /// Starts on a query; whether anything could be on its ray.
    #[inline(always)]
    fn aim(&mut self, isa: I, query: Query<'a>, any: bool) -> bool {
        let scene = query.scene;
        let Some(enter) = scene.clip(query.origin, query.direction, query.limit) else {
            return false;
        };
        let start = query.origin + enter * query.direction - scene.center();
        let direction = query.direction.as_vec3().to_array();
        (self.query, self.any) = (query, any);
        self.world = BoxRay::new(isa, start.as_vec3().to_array(), direction);
        self.boxes = self.world;
        self.nodes = &scene.instances().nodes;
        self.limit = limit_above(query.limit - enter);
        self.base = 0;
        self.best = Best { limit: query.limit, found: None };
        self.enter = enter;
        self.inside = None;
        self.stack.clear();
        self.stack.push(scene.instances().root.0, 0.0);
        true
    }

    /// Visits the newest entry of the stack; whether there is more to do.
    ///
    /// Nothing here branches on how many children are hit or in which order: what the processor
    /// cannot foresee costs it more than the work that it saves.
    #[inline(always)]
    fn step(&mut self, isa: I) -> bool {
        let (at, near) = loop {
            match self.stack.pop(self.base) {
                None => return self.leave_mesh(),
                Some((at, near)) if near <= self.limit => break (Ref(at), near),
                Some(_) => {}
            }
        };
        if at.is_inner() {
            let node = &self.nodes[at.index()];
            let (enter, leave) = self.boxes.children(isa, node, isa.splat(self.limit));
            let order = node.order.0[self.boxes.octant & 7];
            self.stack.extend(isa, isa.arrange(order, enter, leave, &node.child));
            return true;
        }
        if self.inside.is_none() {
            self.enter_mesh(isa, at.index() as u32, self.enter + f64::from(near));
            return true;
        }
        self.visit(isa, at);
        !self.any || self.best.found.is_none()
    }

    #[inline(always)]
    fn enter_mesh(&mut self, isa: I, record: u32, start: f64) {
        let scene = self.query.scene;
        let mesh = scene.mesh_of(record);
        let Some(ray) = MeshRay::new(&self.query, record, mesh, start) else { return };
        self.boxes = BoxRay::new(isa, ray.start_near, ray.direction_near);
        self.nodes = &mesh.tree.nodes;
        self.limit = limit_above(self.best.limit - ray.start).min(ray.beyond);
        self.base = self.stack.len();
        self.stack.push(mesh.tree.root.0, 0.0);
        let wide = WideRay::new(isa, &ray);
        let skip = scene.skipped(&self.query, record);
        self.inside = Some(Inside { mesh, record, ray, wide, skip });
    }

    /// Back to the tree over instances; whether the ray was in a mesh at all.
    #[inline(always)]
    fn leave_mesh(&mut self) -> bool {
        if self.inside.is_none() {
            return false;
        }
        self.inside = None;
        self.boxes = self.world;
        self.nodes = &self.query.scene.instances().nodes;
        self.limit = limit_above(self.best.limit - self.enter);
        self.base = 0;
        true
    }

    /// Tests the primitives of a block.
    #[inline(always)]
    fn visit(&mut self, isa: I, block: Ref) {
        let Some(Inside { mesh, record, ray, wide, skip }) = &self.inside else { return };
        let keep = if block.0 == skip.0 { !skip.1 } else { u32::MAX };
        let (mut perhaps, sure) = if block.is_other() {
            wide.discs(isa, &mesh.discs[block.index()], ray, self.limit, keep)
        } else {
            wide.planar(isa, &mesh.planar[block.index()], self.limit, keep)
        };
        let record = *record;
        if self.any && sure != 0 {
            let (distance, lane, id) = (0.0, 0, 0);
            self.best.found = Some(Found { distance, record, block, lane, id });
            return;
        }
        while perhaps != 0 {
            let lane = perhaps.trailing_zeros() as usize;
            perhaps &= perhaps - 1;
            let is_sure = sure >> lane & 1 != 0;
            let (distance, id) = if block.is_other() {
                let block = &mesh.discs[block.index()];
                let distance = exact::disc_distance(block.lane(lane), ray.origin, ray.direction);
                (distance, block.id.0[lane & 7])
            } else {
                let block = &mesh.planar[block.index()];
                let id = block.id.0[lane & 7];
                (planar_distance(&self.query, record, ray, block, lane, is_sure), id)
            };
            let Some(distance) = distance else { continue };
            if distance > 0.0 {
                let found = Found { distance, record, block, lane: lane as u8, id };
                self.best.offer(self.query.scene, found);
                if self.any && self.best.found.is_some() {
                    return;
                }
                self.limit = limit_above(self.best.limit - ray.start).min(ray.beyond);
            }
        }
    }
}

/// An `f32` that is not below a length of at least 0, found without a branch.
#[inline(always)]
fn limit_above(length: f64) -> f32 {
    length as f32 * (1.0 + 2.0 * f32::EPSILON)
}

struct Best {
    limit: f64,
    found: Option<Found>,
}

impl Best {
    #[inline(always)]
    fn offer(&mut self, scene: &Scene, found: Found) {
        let closer = match &self.found {
            None => found.distance < self.limit,
            Some(best) => match found.distance.total_cmp(&best.distance) {
                Ordering::Less => true,
                Ordering::Equal => scene.rank(&found) < scene.rank(best),
                Ordering::Greater => false,
            },
        };
        if closer {
            self.limit = found.distance;
            self.found = Some(found);
        }
    }
}
