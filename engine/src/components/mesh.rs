use std::ops::Range;

use glam::{DVec3, Vec3};

use super::MaterialId;

/// A flat circular leaf.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// Centre, m, object space.
    pub center: Vec3,
    /// Unit normal of the front side, object space.
    pub normal: Vec3,
    /// Radius, m.
    pub radius: f32,
}

/// A named part of a mesh: the primitives that share one material.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MeshPart {
    /// Name by which the scene binds a material (an OBJ group, a glTF material).
    pub name: String,
    /// Its triangles, as a range of [`Mesh::triangles`].
    pub triangles: Range<u32>,
    /// Its discs, as a range of [`Mesh::discs`].
    pub discs: Range<u32>,
}

/// Geometry of a prototype in object space: metres, z up.
///
/// The front of a triangle is the side from which its corners run counter-clockwise. Parts cover
/// all primitives, in order, without overlap.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Corners, m.
    pub vertices: Vec<Vec3>,
    /// Corner indices, three a triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Discs.
    pub discs: Vec<Disc>,
    /// Parts.
    pub parts: Vec<MeshPart>,
}

/// Reason why numbers are not a mesh.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "each variant's message names its fields")]
pub enum MeshError {
    #[error("vertex {index} is not finite: ({x}, {y}, {z})")]
    VertexNotFinite { index: usize, x: f32, y: f32, z: f32 },
    #[error("triangle {triangle} names vertex {vertex}, but there are only {count}")]
    VertexOutOfRange { triangle: usize, vertex: u32, count: usize },
    #[error(
        "disc {index} needs a finite centre, a finite normal that is not zero and a radius above 0"
    )]
    BadDisc { index: usize },
}

impl Mesh {
    /// The mesh itself when every number in it is lawful.
    ///
    /// # Errors
    /// The first vertex or disc that is not finite, or triangle that names no vertex.
    pub fn checked(self) -> Result<Self, MeshError> {
        if let Some(index) = self.vertices.iter().position(|v| !v.is_finite()) {
            let Vec3 { x, y, z } = self.vertices[index];
            return Err(MeshError::VertexNotFinite { index, x, y, z });
        }
        let count = self.vertices.len();
        for (triangle, corners) in self.triangles.iter().enumerate() {
            if let Some(&vertex) = corners.iter().find(|&&corner| corner as usize >= count) {
                return Err(MeshError::VertexOutOfRange { triangle, vertex, count });
            }
        }
        let lawful = |d: &Disc| {
            d.center.is_finite()
                && d.normal.is_finite()
                && d.normal.length_squared() > 0.0
                && d.radius.is_finite()
                && d.radius > 0.0
        };
        match self.discs.iter().position(|disc| !lawful(disc)) {
            Some(index) => Err(MeshError::BadDisc { index }),
            None => Ok(self),
        }
    }

    /// Corners of one triangle, m.
    #[must_use]
    pub fn corners(&self, triangle: usize) -> [Vec3; 3] {
        self.triangles[triangle].map(|corner| self.vertices[corner as usize])
    }

    /// One-sided area of a part, m²: what a leaf area index counts.
    #[must_use]
    pub fn part_area(&self, part: &MeshPart) -> f64 {
        let triangles = part.triangles.clone().map(|index| {
            let [a, b, c] = self.corners(index as usize).map(Vec3::as_dvec3);
            0.5 * (b - a).cross(c - a).length()
        });
        let discs = self.discs[part.discs.start as usize..part.discs.end as usize]
            .iter()
            .map(|disc| std::f64::consts::PI * f64::from(disc.radius).powi(2));
        triangles.chain(discs).sum()
    }

    /// Vectors of the areas of the surfaces of a part, m²: perpendicular to them, and as long as they are large.
    pub fn area_vectors(&self, part: &MeshPart) -> impl Iterator<Item = DVec3> {
        let triangles = part.triangles.clone().map(|index| {
            let [a, b, c] = self.corners(index as usize).map(Vec3::as_dvec3);
            0.5 * (b - a).cross(c - a)
        });
        let discs = &self.discs[part.discs.start as usize..part.discs.end as usize];
        triangles.chain(discs.iter().map(|disc| {
            let area = std::f64::consts::PI * f64::from(disc.radius).powi(2);
            disc.normal.as_dvec3().normalize_or_zero() * area
        }))
    }

    /// Smallest box around all primitives, m, as its lowest and highest corner; `None` if empty.
    #[must_use]
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        let corners = self.triangles.iter().flatten().map(|&v| self.vertices[v as usize]);
        let corners = corners.map(|v| (v, v));
        let discs = self.discs.iter().map(|d| {
            // A disc reaches r sqrt(1 - n_i²) along axis i.
            let reach = d.radius * (Vec3::ONE - d.normal * d.normal).max(Vec3::ZERO).map(f32::sqrt);
            (d.center - reach, d.center + reach)
        });
        corners.chain(discs).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
    }
}

/// Material of each part of a mesh prototype, in the order of [`Mesh::parts`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PartMaterials(pub Vec<MaterialId>);
