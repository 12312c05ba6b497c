//! The traversal, generic over the instruction set.
//!
//! Boxes and primitives are tested eight at a time in `f32`, with bounds on the rounding error, so
//! that a test says "missed", "certainly hit" or "perhaps". Distances, and whatever is only
//! perhaps hit, are decided in `f64` by [`super::exact`]. The answer is therefore the least
//! `(distance, instance, primitive)` over all primitives, and depends neither on the tree nor on
//! the instruction set nor on threads.

use std::cmp::Ordering;

use glam::{DMat3, DVec3};

use crate::geometry::round_up;

use super::{
    exact,
    mesh::{DiscBlock, MeshTree, PARALLELOGRAM, PlanarBlock},
    scene::Scene,
    simd::{Isa, Lanes, Space, Stack},
    tree::{Node, Ref},
    types::Departure,
};

/// One ray in one tile.
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

/// A ray in the space of one tree.
#[derive(Clone, Copy)]
struct BoxRay<I: Isa> {
    inverse: [I::F; 3],
    shift: [I::F; 3],
    /// 1 where the ray runs down an axis.
    side: [usize; 3],
    /// The same as bits.
    octant: usize,
}

impl<I: Isa> BoxRay<I> {
    #[inline(always)]
    fn new(isa: I, origin: [f32; 3], direction: [f32; 3]) -> Self {
        // A component this small moves the ray by less than the padding of any box.
        let [x, y, z] = direction.map(f32::abs);
        let least = x.max(y).max(z) * 1e-18;
        let inverse = direction.map(|d| 1.0 / if d.abs() < least { least.copysign(d) } else { d });
        let side = direction.map(|d| usize::from(d.is_sign_negative()));
        Self {
            inverse: inverse.map(|i| isa.splat(i)),
            shift: [0, 1, 2].map(|axis| isa.splat(-origin[axis] * inverse[axis])),
            octant: side[0] | side[1] << 1 | side[2] << 2,
            side,
        }
    }

    /// Where the ray enters and leaves the boxes of children, between 0 and `limit`; it meets those
    /// that it enters first.
    #[inline(always)]
    fn children(&self, isa: I, node: &Node, limit: I::F) -> (I::F, I::F) {
        let plane = |axis: usize, side: usize| {
            let bounds = isa.load(&node.bounds[axis][side & 1]);
            isa.mul_add(bounds, self.inverse[axis], self.shift[axis])
        };
        let [sx, sy, sz] = self.side;
        let enter =
            isa.max(isa.max(plane(0, sx), plane(1, sy)), isa.max(plane(2, sz), isa.splat(0.0)));
        let leave =
            isa.min(isa.min(plane(0, sx ^ 1), plane(1, sy ^ 1)), isa.min(plane(2, sz ^ 1), limit));
        (enter, leave)
    }
}

/// The closest primitive on a ray, or any if `ANY`.
#[inline(always)]
pub(super) fn trace<I: Isa, const ANY: bool>(isa: I, query: &Query<'_>) -> Option<Found> {
    let mut space = Space::new();
    let mut walk = Walk::<I, ANY>::new(isa, query, &mut space)?;
    while walk.step(isa) {}
    walk.best.found
}

/// Any primitive on one ray and the closest on another, traced side by side.
///
/// Each step of a walk waits for the one before: for a node, then for what its boxes say. Two
/// walks that know nothing of each other fill each other's waiting time.
#[inline(always)]
pub(super) fn trace_both<I: Isa>(
    isa: I,
    any: &Query<'_>,
    closest: &Query<'_>,
) -> (Option<Found>, Option<Found>) {
    let (mut any_space, mut closest_space) = (Space::new(), Space::new());
    let mut any = Walk::<I, true>::new(isa, any, &mut any_space);
    let mut closest = Walk::<I, false>::new(isa, closest, &mut closest_space);
    let (mut any_goes, mut closest_goes) = (any.is_some(), closest.is_some());
    // One loop for both and for what is left of either: the code of a step is long, and it should
    // stand here once for each.
    while any_goes || closest_goes {
        if any_goes && let Some(walk) = &mut any {
            any_goes = walk.step(isa);
        }
        if closest_goes && let Some(walk) = &mut closest {
            closest_goes = walk.step(isa);
        }
    }
    (any.and_then(|walk| walk.best.found), closest.and_then(|walk| walk.best.found))
}

/// The state of one ray's way through both levels of trees.
struct Walk<'a, I: Isa, const ANY: bool> {
    query: &'a Query<'a>,
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

impl<'a, I: Isa, const ANY: bool> Walk<'a, I, ANY> {
    #[inline(always)]
    fn new(isa: I, query: &'a Query<'a>, space: &'a mut Space) -> Option<Self> {
        let scene = query.scene;
        let enter = scene.clip(query.origin, query.direction, query.limit)?;
        let start = query.origin + enter * query.direction - scene.center();
        let direction = query.direction.as_vec3().to_array();
        let world = BoxRay::new(isa, start.as_vec3().to_array(), direction);
        let mut stack = Stack::new(space);
        stack.push(scene.instances().root.0, 0.0);
        Some(Self {
            query,
            stack,
            boxes: world,
            nodes: &scene.instances().nodes,
            limit: round_up(query.limit - enter),
            base: 0,
            best: Best { limit: query.limit, found: None },
            enter,
            world,
            inside: None,
        })
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
        !ANY || self.best.found.is_none()
    }

    #[inline(always)]
    fn enter_mesh(&mut self, isa: I, record: u32, start: f64) {
        let scene = self.query.scene;
        let mesh = scene.mesh_of(record);
        let Some(ray) = MeshRay::new(self.query, record, mesh, start) else { return };
        self.boxes = BoxRay::new(isa, ray.start_near, ray.direction_near);
        self.nodes = &mesh.tree.nodes;
        self.limit = round_up(self.best.limit - ray.start).min(ray.beyond);
        self.base = self.stack.len();
        self.stack.push(mesh.tree.root.0, 0.0);
        let wide = WideRay {
            origin: ray.start_near.map(|v| isa.splat(v)),
            direction: ray.direction_near.map(|v| isa.splat(v)),
            side_error: isa.splat(ray.side_error),
            distance_error: isa.splat(ray.distance_error),
        };
        let skip = scene.skipped(self.query, record);
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
        self.limit = round_up(self.best.limit - self.enter);
        self.base = 0;
        true
    }

    /// Tests the primitives of a block.
    #[inline(always)]
    fn visit(&mut self, isa: I, block: Ref) {
        let Some(Inside { mesh, record, ray, wide, skip }) = &self.inside else { return };
        let (perhaps, sure) = if block.is_other() {
            wide.discs(isa, &mesh.discs[block.index()], ray, self.limit)
        } else {
            wide.planar(isa, &mesh.planar[block.index()], self.limit)
        };
        let keep = if block.0 == skip.0 { !skip.1 } else { u32::MAX };
        let (mut perhaps, sure) = (perhaps & keep, sure & keep);
        let record = *record;
        if ANY && sure != 0 {
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
                (planar_distance(self.query, record, ray, block, lane, is_sure), id)
            };
            let Some(distance) = distance else { continue };
            if distance > 0.0 {
                let found = Found { distance, record, block, lane: lane as u8, id };
                self.best.offer(self.query.scene, found);
                if ANY && self.best.found.is_some() {
                    return;
                }
                self.limit = round_up(self.best.limit - ray.start).min(ray.beyond);
            }
        }
    }
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

/// A ray in the space of one mesh.
struct MeshRay {
    /// Exact up to `f64` rounding; distances along it are those of the world.
    origin: DVec3,
    direction: DVec3,
    /// Distance at which the `f32` ray starts.
    start: f64,
    start_near: [f32; 3],
    direction_near: [f32; 3],
    /// Bounds of rounding: of side determinants per edge length, and of distances per squared one.
    side_error: f32,
    distance_error: f32,
    /// Beyond the whole mesh, from `start`.
    beyond: f32,
    /// Size of the coordinates that rounding is relative to.
    size: f32,
    length: f32,
}

impl MeshRay {
    #[inline(always)]
    fn new(query: &Query<'_>, record: u32, mesh: &MeshTree, mut start: f64) -> Option<Self> {
        let record = &query.scene.records()[record as usize];
        let object_from_world = DMat3::from_cols_array(&record.object_from_world.map(f64::from));
        let origin = object_from_world * (query.origin - record.translation);
        let direction = object_from_world * query.direction;
        let mut point = origin + start * direction;
        let reach = f64::from(mesh.reach);
        if point.abs().max_element() > 4.0 * reach {
            // The box of a strongly squeezed instance is far from the mesh: go to the mesh's own.
            start = mesh.clip(origin, direction)?;
            point = origin + start * direction;
        }
        // Rounding the ray moves it by 2⁻²⁴ of its coordinates; the products of the tests below
        // then add less than 128 roundings of that size, relative to edges and distances.
        let size = (reach + point.abs().max_element()) as f32;
        let length = direction.length() as f32;
        Some(Self {
            origin,
            direction,
            start,
            start_near: point.as_vec3().to_array(),
            direction_near: direction.as_vec3().to_array(),
            side_error: size * length * ROUNDING,
            distance_error: size * ROUNDING,
            beyond: 4.0 * size / length,
            size,
            length,
        })
    }
}

/// 128 roundings of `f32`.
const ROUNDING: f32 = 128.0 / (1 << 24) as f32;

#[inline(always)]
fn planar_distance(
    query: &Query<'_>,
    record: u32,
    ray: &MeshRay,
    block: &PlanarBlock,
    lane: usize,
    is_sure: bool,
) -> Option<f64> {
    let corners = block.lane(lane);
    let distance = exact::plane_distance(&corners, ray.origin, ray.direction)?;
    let parallelogram = block.id.0[lane & 7] & PARALLELOGRAM != 0;
    let hit = is_sure || {
        let blur = blur(query, record, distance);
        exact::contains(&corners, parallelogram, ray.origin, ray.direction, blur)
    };
    hit.then_some(distance)
}

/// How far, in object space, rounding in `f64` may move the point at a distance along a ray.
#[cold]
fn blur(query: &Query<'_>, record: u32, distance: f64) -> f64 {
    let record = &query.scene.records()[record as usize];
    let stretch: f64 = record.object_from_world.iter().map(|&v| f64::from(v.abs())).sum();
    let place = query.origin.abs().max_element() + record.translation.abs().max_element();
    8.0 * f64::EPSILON * stretch * (place + distance.abs())
}

struct WideRay<I: Isa> {
    origin: [I::F; 3],
    direction: [I::F; 3],
    side_error: I::F,
    distance_error: I::F,
}

impl<I: Isa> WideRay<I> {
    /// Lanes that are perhaps hit between 0 and `limit`, and those that surely are.
    ///
    /// Source: Möller and Trumbore (1997), Fast, minimum storage ray/triangle intersection, with
    /// the division left out.
    #[inline(always)]
    fn planar(&self, isa: I, block: &PlanarBlock, limit: f32) -> (u32, u32) {
        let [a, b, c] =
            block.corners.each_ref().map(|corner| corner.each_ref().map(|v| isa.load(v)));
        let sub = |a: [I::F; 3], b: [I::F; 3]| {
            [isa.sub(a[0], b[0]), isa.sub(a[1], b[1]), isa.sub(a[2], b[2])]
        };
        let cross = |a: [I::F; 3], b: [I::F; 3]| {
            [
                isa.mul_sub(a[1], b[2], isa.mul(a[2], b[1])),
                isa.mul_sub(a[2], b[0], isa.mul(a[0], b[2])),
                isa.mul_sub(a[0], b[1], isa.mul(a[1], b[0])),
            ]
        };
        let dot = |a: [I::F; 3], b: [I::F; 3]| {
            isa.mul_add(a[0], b[0], isa.mul_add(a[1], b[1], isa.mul(a[2], b[2])))
        };
        let (ab, ac, from_a) = (sub(b, a), sub(c, a), sub(self.origin, a));
        let p = cross(self.direction, ac);
        let q = cross(from_a, ab);
        let det = dot(ab, p);
        let u = isa.turn(dot(from_a, p), det);
        let v = isa.turn(dot(self.direction, q), det);
        let t = isa.turn(dot(ac, q), det);
        let det = isa.abs(det);
        let used = isa.pick(isa.add(u, v), isa.max(u, v), isa.load_bits(&block.id));
        let inside = isa.min(isa.min(u, v), isa.sub(det, used));
        let edge = isa.load(&block.edge);
        let side_error = isa.mul(self.side_error, edge);
        let distance_error = isa.mul(isa.mul(self.distance_error, edge), edge);
        let far = isa.mul(isa.splat(limit), det);
        let zero = isa.splat(0.0);
        let perhaps = isa.le(isa.sub(zero, side_error), inside)
            & isa.le(isa.sub(zero, distance_error), t)
            & isa.le(isa.sub(t, distance_error), far);
        if perhaps == 0 {
            return (0, 0);
        }
        let sure = isa.le(side_error, inside)
            & isa.le(distance_error, t)
            & isa.le(isa.add(t, distance_error), far);
        // An unused lane's error is negative: never perhaps, though it may look sure.
        (perhaps, perhaps & sure)
    }

    /// As [`Self::planar`], for discs.
    #[inline(always)]
    fn discs(&self, isa: I, block: &DiscBlock, ray: &MeshRay, limit: f32) -> (u32, u32) {
        let load = |v: &[Lanes; 3]| v.each_ref().map(|v| isa.load(v));
        let (center, normal) = (load(&block.center), load(&block.normal));
        let dot = |a: [I::F; 3], b: [I::F; 3]| {
            isa.mul_add(a[0], b[0], isa.mul_add(a[1], b[1], isa.mul(a[2], b[2])))
        };
        let to = [0, 1, 2].map(|i| isa.sub(center[i], self.origin[i]));
        let slope = dot(normal, self.direction);
        let t = isa.div(dot(normal, to), slope);
        let off = [0, 1, 2].map(|i| isa.sub(isa.mul(self.direction[i], t), to[i]));
        let off = dot(off, off);
        // The distance is off by rounding over the slope, and the point by that along the ray.
        let steep = isa.div(isa.splat(ray.distance_error), isa.abs(slope));
        let error = isa.mul_add(isa.splat(ray.length), steep, isa.splat(ray.size * ROUNDING));
        let radius = isa.load(&block.radius);
        let zero = isa.splat(0.0);
        let (outer, inner) = (isa.add(radius, error), isa.max(isa.sub(radius, error), zero));
        let (low, high) = (isa.sub(t, steep), isa.add(t, steep));
        let limit = isa.splat(limit);
        let used = isa.le(zero, radius);
        let perhaps = isa.not_gt(off, isa.mul(outer, outer))
            & isa.not_gt(zero, high)
            & isa.not_gt(low, limit)
            & used;
        let sure = isa.le(off, isa.mul(inner, inner)) & isa.le(zero, low) & isa.le(high, limit);
        (perhaps, perhaps & sure)
    }
}
