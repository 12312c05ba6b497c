use glam::DVec3;

use crate::geometry::Bounds;

use super::{Bounds32, ChildRef, DiscBlock, PlanarBlock, WideBvh, slab_padding};

/// Bottom level: the hierarchy over the primitives of one mesh, in object space.
#[derive(Debug)]
pub(in crate::accel) struct MeshBvh {
    pub tree: WideBvh,
    pub planar: Vec<PlanarBlock>,
    pub discs: Vec<DiscBlock>,
    /// Second triangle of each lane of each planar block; empty if that of each parallelogram follows the first.
    pub second_triangles: Vec<[u32; 8]>,
    /// Box around all primitives, not padded.
    pub bounds: Bounds32,
    /// Largest absolute coordinate.
    pub max_coordinate: f32,
    /// Number of triangles in the mesh: discs are counted from there.
    pub triangles: u32,
    /// Surfaces of the triangles, part by part.
    pub triangle_surfaces: Vec<SurfaceRange>,
    /// Surfaces of the discs, part by part.
    pub disc_surfaces: Vec<SurfaceRange>,
}

/// Primitives of one part, which begin where those of the part before end.
#[derive(Clone, Copy, Debug)]
pub(in crate::accel) struct SurfaceRange {
    pub end: u32,
    pub surface: u32,
}

impl MeshBvh {
    /// Number of triangles and discs of the mesh, degenerate ones included.
    pub(in crate::accel) fn primitives(&self) -> usize {
        let discs = self.disc_surfaces.last().map_or(0, |range| range.end);
        self.triangles as usize + discs as usize
    }

    /// Memory of primitives and nodes, bytes.
    pub(in crate::accel) fn bytes(&self) -> usize {
        size_of_val(&*self.planar)
            + size_of_val(&*self.discs)
            + size_of_val(&*self.second_triangles)
            + self.tree.bytes()
    }

    /// Distance at which a ray in object space enters the box of the mesh.
    pub(in crate::accel) fn clip(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        let room = 0.5 * f64::from(slab_padding(self.max_coordinate));
        let Bounds32 { min, max } = self.bounds;
        let bounds = Bounds { min: min.as_dvec3() - room, max: max.as_dvec3() + room };
        bounds.clip(origin, direction).map(|(enter, _)| enter)
    }

    /// Second triangle of the parallelogram in a lane.
    pub(in crate::accel) fn second_triangle(&self, block: ChildRef, lane: u8, first: u32) -> u32 {
        let seconds = self.second_triangles.get(block.index());
        seconds.map_or(first + 1, |seconds| seconds[usize::from(lane & 7)])
    }

    /// Surface of a primitive, counted as in `Hit::primitive`.
    pub(in crate::accel) fn surface(&self, primitive: u32) -> u32 {
        let (ranges, index) = if primitive < self.triangles {
            (&self.triangle_surfaces, primitive)
        } else {
            (&self.disc_surfaces, primitive - self.triangles)
        };
        ranges[ranges.partition_point(|range| range.end <= index)].surface
    }
}
