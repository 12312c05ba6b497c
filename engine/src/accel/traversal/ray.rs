//! Rays in the space of one hierarchy, and their tests against eight boxes or primitives at a time.

use glam::{DMat3, DVec3};

use crate::accel::{
    layout::{DiscBlock, MeshBvh, PARALLELOGRAM, PlanarBlock, WideNode},
    simd::{Isa, Lanes},
};

use super::{exact, tiles::TileRay};

/// Ray in the space of one hierarchy, for the slab test.
#[derive(Clone, Copy)]
pub(super) struct BoxRay<I: Isa> {
    /// Inverse of the direction.
    pub inverse: [I::F; 3],
    /// `-origin / direction`.
    pub shift: [I::F; 3],
    /// 1 for axes that the ray runs down.
    pub side: [usize; 3],
    /// Bits of `side`.
    pub octant: usize,
}

impl<I: Isa> BoxRay<I> {
    #[inline(always)]
    pub(super) fn new(isa: I, origin: [f32; 3], direction: [f32; 3]) -> Self {
        // A component this small moves the ray by less than the padding of any box.
        let [x, y, z] = direction.map(f32::abs);
        let smallest = x.max(y).max(z) * 1e-18;
        let inverse =
            direction.map(|d| 1.0 / if d.abs() < smallest { smallest.copysign(d) } else { d });
        let side = direction.map(|d| usize::from(d.is_sign_negative()));
        Self {
            inverse: inverse.map(|i| isa.splat(i)),
            shift: [0, 1, 2].map(|axis| isa.splat(-origin[axis] * inverse[axis])),
            octant: side[0] | side[1] << 1 | side[2] << 2,
            side,
        }
    }

    /// Distances at which the ray enters and leaves the boxes of children, between 0 and `limit`; it hits those
    /// that it enters before it leaves them.
    #[inline(always)]
    pub(super) fn children(&self, isa: I, node: &WideNode, limit: I::F) -> (I::F, I::F) {
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

/// Ray in the space of one mesh.
pub(super) struct MeshRay {
    /// Origin, exact up to `f64` rounding; distances along the ray are those of the world.
    pub origin: DVec3,
    pub direction: DVec3,
    /// Distance at which the `f32` ray starts.
    pub start: f64,
    /// Origin of the `f32` ray.
    pub start_near: [f32; 3],
    pub direction_near: [f32; 3],
    /// Bound of the rounding error of side determinants, per edge length.
    pub side_error: f32,
    /// Bound of the rounding error of distances, per squared edge length.
    pub distance_error: f32,
    /// Distance from `start` that is beyond the whole mesh.
    pub beyond: f32,
    /// Size of the coordinates that rounding is relative to.
    pub size: f32,
    /// Bound of the length of the direction.
    pub length: f32,
}

impl MeshRay {
    #[inline(always)]
    pub(super) fn new(
        tile_ray: &TileRay<'_>,
        record: u32,
        mesh: &MeshBvh,
        mut start: f64,
    ) -> Option<Self> {
        let record = &tile_ray.bvh.records[record as usize];
        let object_from_world = DMat3::from_cols_array(&record.object_from_world.map(f64::from));
        let origin = object_from_world * (tile_ray.origin - record.translation);
        let direction = object_from_world * tile_ray.direction;
        let mut point = origin + start * direction;
        let max_coordinate = f64::from(mesh.max_coordinate);
        if point.abs().max_element() > 4.0 * max_coordinate {
            // The box of a strongly squeezed instance is far from the mesh: start at the box of the mesh.
            start = mesh.clip(origin, direction)?;
            point = origin + start * direction;
        }
        // Rounding the ray moves it by 2⁻²⁴ of its coordinates; the products of the tests below
        // then add less than 128 roundings of that size, relative to edges and distances.
        let size = (max_coordinate + point.abs().max_element()) as f32;
        let direction_near = direction.as_vec3();
        // √3 times the largest component bounds the length, and spares a square root.
        let largest = direction_near.abs().max_element();
        let length = 1.75 * largest;
        Some(Self {
            origin,
            direction,
            start,
            start_near: point.as_vec3().to_array(),
            direction_near: direction_near.to_array(),
            side_error: size * length * ROUNDING,
            distance_error: size * ROUNDING,
            beyond: 4.0 * size / largest,
            size,
            length,
        })
    }
}

/// Relative error of 128 roundings of `f32`.
const ROUNDING: f32 = 128.0 / (1 << 24) as f32;

/// Distance of a lane that is perhaps or surely hit; `None` if it is not hit.
#[inline(always)]
pub(super) fn planar_distance(
    tile_ray: &TileRay<'_>,
    record: u32,
    ray: &MeshRay,
    block: &PlanarBlock,
    lane: usize,
    is_sure: bool,
) -> Option<f64> {
    let corners = block.lane(lane);
    let distance = exact::plane_distance(&corners, ray.origin, ray.direction)?;
    let is_parallelogram = block.id.0[lane & 7] & PARALLELOGRAM != 0;
    let is_hit = is_sure || {
        let blur = blur(tile_ray, record, distance);
        exact::contains(&corners, is_parallelogram, ray.origin, ray.direction, blur)
    };
    is_hit.then_some(distance)
}

/// Bound of the error, in object space, that rounding in `f64` makes of the point at a distance along a ray.
#[cold]
fn blur(tile_ray: &TileRay<'_>, record: u32, distance: f64) -> f64 {
    let record = &tile_ray.bvh.records[record as usize];
    let stretch: f64 = record.object_from_world.iter().map(|&v| f64::from(v.abs())).sum();
    let size = tile_ray.origin.abs().max_element() + record.translation.abs().max_element();
    8.0 * f64::EPSILON * stretch * (size + distance.abs())
}

/// Three coordinates of all lanes.
#[inline(always)]
fn load<I: Isa>(isa: I, [x, y, z]: &[Lanes; 3]) -> [I::F; 3] {
    [isa.load(x), isa.load(y), isa.load(z)]
}

/// [`MeshRay`] in all lanes, for the tests of blocks.
///
/// Arrays of vectors are written out where a closure for `map` would not be inlined: it would not be compiled for the
/// instruction set, and call each intrinsic.
pub(super) struct WideRay<I: Isa> {
    pub origin: [I::F; 3],
    pub direction: [I::F; 3],
    pub side_error: I::F,
    pub distance_error: I::F,
}

impl<I: Isa> WideRay<I> {
    #[inline(always)]
    pub(super) fn new(isa: I, ray: &MeshRay) -> Self {
        Self {
            origin: ray.start_near.map(|v| isa.splat(v)),
            direction: ray.direction_near.map(|v| isa.splat(v)),
            side_error: isa.splat(ray.side_error),
            distance_error: isa.splat(ray.distance_error),
        }
    }

    /// Lanes that are perhaps hit between 0 and `limit`, and those that surely are.
    ///
    /// Source: Möller and Trumbore (1997), Fast, minimum storage ray/triangle intersection, with
    /// the division left out.
    #[inline(always)]
    pub(super) fn planar(&self, isa: I, block: &PlanarBlock, limit: f32, keep: u32) -> (u32, u32) {
        let [a, b, c] = &block.corners;
        let (a, b, c) = (load(isa, a), load(isa, b), load(isa, c));
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
        let u = isa.xor_sign(dot(from_a, p), det);
        let v = isa.xor_sign(dot(self.direction, q), det);
        let t = isa.xor_sign(dot(ac, q), det);
        let det = isa.abs(det);
        let used = isa.select(isa.add(u, v), isa.max(u, v), isa.load_bits(&block.id));
        let inside = isa.min(isa.min(u, v), isa.sub(det, used));
        let edge = isa.load(&block.edge);
        let side_error = isa.mul(self.side_error, edge);
        let distance_error = isa.mul(isa.mul(self.distance_error, edge), edge);
        let far = isa.mul(isa.splat(limit), det);
        let zero = isa.splat(0.0);
        let perhaps = isa.le(isa.sub(zero, side_error), inside)
            & isa.le(isa.sub(zero, distance_error), t)
            & isa.le(isa.sub(t, distance_error), far)
            & keep;
        if perhaps == 0 {
            return (0, 0);
        }
        let sure = isa.le(side_error, inside)
            & isa.le(distance_error, t)
            & isa.le(isa.add(t, distance_error), far);
        // An unused lane's error is negative: `perhaps` is false there, though `sure` may be true.
        (perhaps, perhaps & sure)
    }

    /// Lanes of discs that are perhaps hit between 0 and `limit`, and those that surely are.
    #[inline(always)]
    pub(super) fn discs(
        &self,
        isa: I,
        block: &DiscBlock,
        ray: &MeshRay,
        limit: f32,
        keep: u32,
    ) -> (u32, u32) {
        let (center, normal) = (load(isa, &block.center), load(isa, &block.normal));
        let dot = |a: [I::F; 3], b: [I::F; 3]| {
            isa.mul_add(a[0], b[0], isa.mul_add(a[1], b[1], isa.mul(a[2], b[2])))
        };
        let [x, y, z] = self.origin;
        let to_center = [isa.sub(center[0], x), isa.sub(center[1], y), isa.sub(center[2], z)];
        let slope = dot(normal, self.direction);
        let inverse_slope = isa.div(isa.splat(1.0), slope);
        let t = isa.mul(dot(normal, to_center), inverse_slope);
        let [x, y, z] = self.direction;
        let off = [
            isa.mul_sub(x, t, to_center[0]),
            isa.mul_sub(y, t, to_center[1]),
            isa.mul_sub(z, t, to_center[2]),
        ];
        let off = dot(off, off);
        // The distance is off by rounding over the slope, and the point by that along the ray.
        let steep = isa.mul(isa.splat(ray.distance_error), isa.abs(inverse_slope));
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
            & used
            & keep;
        let sure = isa.le(off, isa.mul(inner, inner)) & isa.le(zero, low) & isa.le(high, limit);
        (perhaps, perhaps & sure)
    }
}
