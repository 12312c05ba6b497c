use glam::{DVec2, DVec3, Vec3};

use crate::components::{MaterialId, Mesh, MeshPart, PartMaterials, TerrainPatch};

/// Triangles of the ground over its rectangle, before they are a terrain.
#[derive(Clone, Debug)]
pub(super) struct TerrainSurface {
    pub(super) corner: DVec2,
    pub(super) size: DVec2,
    /// Height of zero, m, and length of the unit of height, m.
    pub(super) base: f64,
    pub(super) unit: f64,
    /// Corners, x and y in units of the extent.
    pub(super) vertices: Vec<Vec3>,
    /// Corner indices, the front upward, with their part.
    pub(super) triangles: Vec<([u32; 3], u16)>,
}

/// Name and material of each part of the ground.
pub type Parts = Vec<(String, MaterialId)>;

impl TerrainSurface {
    /// Creates the surface from corners relative to a rectangle's corner, m, without those that no triangle has.
    pub(super) fn new(
        corner: DVec2,
        size: DVec2,
        corners: &[DVec3],
        mut triangles: Vec<([u32; 3], u16)>,
    ) -> Self {
        let mut ids = vec![u32::MAX; corners.len()];
        let mut used = Vec::new();
        for id in triangles.iter_mut().flat_map(|(ids, _)| ids) {
            let new = &mut ids[*id as usize];
            if *new == u32::MAX {
                *new = used.len() as u32;
                used.push(corners[*id as usize]);
            }
            *id = *new;
        }
        let base = used.iter().map(|v| v.z).reduce(f64::min).unwrap_or(0.0);
        // One scale for height and extent keeps the boxes of the ray engine's tree in proportion.
        let unit = size.max_element();
        let scale = size.extend(unit);
        let vertices = used.iter().map(|v| ((*v - DVec3::Z * base) / scale).as_vec3());
        Self { corner, size, base, unit, vertices: vertices.collect(), triangles }
    }

    /// Walls below the edges of opposite sides that do not match, down to the lowest ground, with
    /// the material of the ground above them: no ray gets under a periodic ground. Beside each
    /// other, the two walls of a seam show what one side rises above the other and no more.
    pub(super) fn close_seams(&mut self) {
        let sides = [0, 1].map(|axis| [0.0, 1.0].map(|side| self.edges_on(axis, side)));
        for (axis, sides) in sides.into_iter().enumerate() {
            if self.profile(axis, &sides[0]) != self.profile(axis, &sides[1]) {
                for edge in sides.concat() {
                    self.add_wall(edge);
                }
            }
        }
    }

    /// Walls below all four sides, as a part of its own: where an isolated ground is cut out of the
    /// earth. None if it is level.
    fn add_cuts(&mut self, part: u16) {
        // The lowest ground is zero.
        if self.vertices.iter().all(|v| v.z <= 0.0) {
            return;
        }
        let sides = [(0, 0.0), (0, 1.0), (1, 0.0), (1, 1.0)];
        let edges = sides.map(|(axis, side)| self.edges_on(axis, side)).concat();
        for (edge, _) in edges {
            self.add_wall((edge, part));
        }
    }

    /// Edges of triangles on a side, with their part; the ground lies to the left of each.
    fn edges_on(&self, axis: usize, side: f32) -> Vec<([u32; 2], u16)> {
        let is_on = |id: u32| self.vertices[id as usize][axis].to_bits() == side.to_bits();
        let mut edges = Vec::new();
        for &([a, b, c], part) in &self.triangles {
            for edge in [[a, b], [b, c], [c, a]] {
                if edge.into_iter().all(is_on) {
                    edges.push((edge, part));
                }
            }
        }
        edges
    }

    /// Heights along a side at the ends of its edges, in order, without points on a straight line.
    fn profile(&self, axis: usize, edges: &[([u32; 2], u16)]) -> Vec<(f32, f32)> {
        let ends = edges.iter().flat_map(|(edge, _)| edge).map(|&id| self.vertices[id as usize]);
        let mut points: Vec<(f32, f32)> = ends.map(|v| (v[1 - axis], v.z)).collect();
        points.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        points.dedup();
        points
    }

    fn add_wall(&mut self, ([a, b], part): ([u32; 2], u16)) {
        let first = self.vertices.len() as u32;
        let [top_a, top_b] = [a, b].map(|id| self.vertices[id as usize]);
        let [foot_a, foot_b] = [top_a, top_b].map(|top| top.with_z(0.0));
        self.vertices.extend([foot_a, foot_b]);
        // The front looks away from the ground.
        if top_a != foot_a {
            self.triangles.push(([b, a, first], part));
        }
        if top_b != foot_b {
            self.triangles.push(([b, first, first + 1], part));
        }
    }

    /// The terrain of these parts; an isolated one gets its cuts.
    pub(super) fn finish(mut self, parts: Parts, is_periodic: bool) -> TerrainPatch {
        let cut = parts.len() as u16;
        if is_periodic {
            self.close_seams();
        } else {
            self.add_cuts(cut);
        }
        self.triangles.sort_by_key(|&(_, part)| part);
        let start = |part: u16| self.triangles.partition_point(|&(_, p)| p < part) as u32;
        let (first_cut, end) = (start(cut), self.triangles.len() as u32);
        let mut named = Vec::new();
        let mut materials = Vec::new();
        for (index, (name, material)) in parts.into_iter().enumerate() {
            let triangles = start(index as u16)..start(index as u16 + 1);
            named.push(MeshPart { name, triangles, discs: 0..0 });
            materials.push(material);
        }
        if let (true, Some(&material)) = (first_cut < end, materials.first()) {
            let name = "cut".to_owned();
            named.push(MeshPart { name, triangles: first_cut..end, discs: 0..0 });
            materials.push(material);
        }
        let mesh = Mesh {
            vertices: self.vertices,
            triangles: self.triangles.into_iter().map(|(ids, _)| ids).collect(),
            discs: Vec::new(),
            parts: named,
        };
        TerrainPatch {
            projection: None,
            corner: self.corner,
            size: self.size,
            base: self.base,
            unit: self.unit,
            mesh,
            materials: PartMaterials(materials),
            first_cut,
        }
    }
}
