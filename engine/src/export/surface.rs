//! Points on surfaces, drawn uniformly by area.

use glam::{DVec3, Vec3};

use super::contents::Pose;
use crate::components::{Mesh, MeshPart};
use crate::sampling::{Key, concentric_disc};

/// Part of a mesh in the world, and the areas of its triangles and discs summed up.
#[derive(Debug)]
pub(super) struct SampledSurface<'a> {
    mesh: &'a Mesh,
    /// Triangles and discs, and the sum of the areas of all up to and including each, m².
    faces: Vec<(FaceIndex, f64)>,
}

/// Triangle or disc of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum FaceIndex {
    Triangle(u32),
    Disc(u32),
}

/// Area of a part of a mesh in the world, m².
pub(super) fn area(mesh: &Mesh, part: &MeshPart, pose: &Pose) -> f64 {
    faces(part).map(|face| face_area(mesh, face, pose)).sum()
}

fn faces(part: &MeshPart) -> impl Iterator<Item = FaceIndex> + use<> {
    let triangles = part.triangles.clone().map(FaceIndex::Triangle);
    triangles.chain(part.discs.clone().map(FaceIndex::Disc))
}

fn face_area(mesh: &Mesh, face: FaceIndex, pose: &Pose) -> f64 {
    match face {
        FaceIndex::Triangle(triangle) => {
            let [a, b, c] = mesh.corners(triangle as usize).map(Vec3::as_dvec3);
            0.5 * (pose.linear * (b - a)).cross(pose.linear * (c - a)).length()
        }
        FaceIndex::Disc(disc) => {
            let disc = &mesh.discs[disc as usize];
            let (u, v) = crate::geometry::basis(disc.normal.as_dvec3());
            let stretch = (pose.linear * u).cross(pose.linear * v).length();
            std::f64::consts::PI * f64::from(disc.radius).powi(2) * stretch
        }
    }
}

impl<'a> SampledSurface<'a> {
    pub(super) fn new(mesh: &'a Mesh, part: &MeshPart, pose: &Pose) -> Self {
        let mut sum = 0.0;
        let faces = faces(part).map(|face| {
            sum += face_area(mesh, face, pose);
            (face, sum)
        });
        Self { mesh, faces: faces.collect() }
    }

    /// Points of a stream, m: one in each of `count` parts of equal area. `pose` maps the mesh to the world, and affine maps
    /// keep uniform points uniform within a face.
    pub(super) fn points(
        &self,
        count: u64,
        pose: &Pose,
        stream: Key,
    ) -> impl Iterator<Item = DVec3> {
        let area = self.faces.last().map_or(0.0, |(_, sum)| *sum);
        let count = if self.faces.is_empty() { 0 } else { count };
        (0..count).map(move |index| {
            let numbers = stream.index(index);
            let at = area * (index as f64 + numbers.uniform(0)) / count as f64;
            let face = self.faces.partition_point(|(_, sum)| *sum < at).min(self.faces.len() - 1);
            pose.apply(self.point(self.faces[face].0, numbers.uniform(1), numbers.uniform(2)))
        })
    }

    fn point(&self, face: FaceIndex, u: f64, v: f64) -> DVec3 {
        match face {
            FaceIndex::Triangle(triangle) => {
                let [a, b, c] = self.mesh.corners(triangle as usize).map(Vec3::as_dvec3);
                // Beyond the diagonal of the parallelogram, the point is turned into the triangle.
                let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
                a + u * (b - a) + v * (c - a)
            }
            FaceIndex::Disc(disc) => {
                let disc = &self.mesh.discs[disc as usize];
                let (x, y) = crate::geometry::basis(disc.normal.as_dvec3());
                let at = f64::from(disc.radius) * concentric_disc(u, v);
                disc.center.as_dvec3() + at.x * x + at.y * y
            }
        }
    }
}
