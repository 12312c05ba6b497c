//! Conversion of a file's axes, unit and origin to a mesh in metres, z up.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use glam::{DVec3, Vec3};
use indexmap::IndexMap;

use super::{AssetError, Loaded};
use crate::components::{Mesh, MeshPart};
use crate::counts::{agreeing, counted};
use crate::document::{Axis, Origin};

/// Most triangles of one file.
const MOST_TRIANGLES: usize = 100_000_000;

/// Most vertices of one file.
const MOST_VERTICES: usize = 3 * MOST_TRIANGLES;

/// Index of a vertex that no triangle uses.
const UNUSED: u32 = u32::MAX;

/// Distance from the origin beyond which f32 coordinates lie more than 0.1 mm apart, m.
const COARSE: f32 = 1024.0;

/// Most parts to name in a warning.
const MOST_SHOWN: usize = 5;

/// Conversion of a file's coordinates to those of a prototype.
#[derive(Clone, Debug, PartialEq)]
pub struct Import {
    /// Axis of the file that points up.
    pub up: Axis,
    /// Length of the file's unit, m.
    pub unit_m: f64,
    /// Point of the file that becomes the origin.
    pub origin: Origin,
}

impl Import {
    /// Converts a point of the file to metres, z up: a rotation and a scale, never a mirror.
    #[must_use]
    pub fn point(&self, DVec3 { x, y, z }: DVec3) -> DVec3 {
        self.unit_m
            * match self.up {
                Axis::X => DVec3::new(y, z, x),
                Axis::Y => DVec3::new(x, -z, y),
                Axis::Z => DVec3::new(x, y, z),
            }
    }

    pub(super) fn check(&self, file: &Path) -> Result<(), AssetError> {
        if self.unit_m.is_finite() && self.unit_m > 0.0 {
            return Ok(());
        }
        Err(AssetError::BadUnit { file: file.to_owned(), unit_m: self.unit_m })
    }
}

/// Triangles of a file in metres, z up, from which a mesh is made.
pub(super) struct MeshCollector {
    pub(super) file: PathBuf,
    pub(super) vertices: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    /// Part of each triangle, in the caller's numbers.
    parts: Vec<u32>,
    pub(super) warnings: Vec<String>,
    /// Parts, in the caller's numbers, that are transparent in their file, each with the statement that says so.
    pub(super) transparent: BTreeMap<u32, String>,
}

impl MeshCollector {
    pub(super) fn new(file: &Path) -> Self {
        Self {
            file: file.to_owned(),
            vertices: Vec::new(),
            triangles: Vec::new(),
            parts: Vec::new(),
            warnings: Vec::new(),
            transparent: BTreeMap::new(),
        }
    }

    /// Returns the index of the next vertex if the mesh has room for `count` more.
    pub(super) fn reserve(&self, count: usize) -> Result<u32, AssetError> {
        let first = self.vertices.len();
        if count > MOST_VERTICES - first {
            return Err(self.too_many("vertices", MOST_VERTICES));
        }
        Ok(first as u32)
    }

    /// Adds a vertex, or returns its coordinate that f32 cannot hold.
    pub(super) fn add_vertex(&mut self, vertex: DVec3) -> Result<(), f64> {
        if let Some(value) = too_far(vertex) {
            return Err(value);
        }
        self.vertices.push(vertex);
        Ok(())
    }

    pub(super) fn add_triangle(&mut self, corners: [u32; 3], part: u32) -> Result<(), AssetError> {
        if self.triangles.len() == MOST_TRIANGLES {
            return Err(self.too_many("triangles", MOST_TRIANGLES));
        }
        self.triangles.push(corners);
        self.parts.push(part);
        Ok(())
    }

    fn too_many(&self, what: &'static str, most: usize) -> AssetError {
        AssetError::TooMany { file: self.file.clone(), what, most }
    }

    pub(super) fn warn(&mut self, what: &str) {
        self.warnings.push(format!("{}: {what}", self.file.display()));
    }

    /// Makes the mesh; `names` has the name of each of the caller's parts, and equal names are one part.
    pub(super) fn finish(
        mut self,
        names: &[String],
        import: &Import,
    ) -> Result<Loaded<Mesh>, AssetError> {
        let total = self.triangles.len();
        let corners = |vertices: &[DVec3], t: [u32; 3]| t.map(|corner| vertices[corner as usize]);
        self.keep_triangles(|vertices, t| has_area(corners(vertices, t)));
        let origin = self.origin(import);
        let vertices: Vec<Vec3> = self.vertices.iter().map(|&v| (v - origin).as_vec3()).collect();
        // What had an area may have none left in f32.
        self.keep_triangles(|_, t| has_area(t.map(|corner| vertices[corner as usize].as_dvec3())));
        if self.triangles.is_empty() {
            return Err(AssetError::NoFaces { file: self.file });
        }
        let dropped = total - self.triangles.len();
        if dropped > 0 {
            self.warn(&format!(
                "{} without area {} dropped",
                counted(dropped, "triangle"),
                agreeing(dropped, "was", "were")
            ));
        }
        self.warn_transparent(&vertices, names);
        let mesh = self.mesh(&vertices, names);
        if let Some(warning) = coarse(&self.file, &mesh, &import.origin) {
            self.warnings.push(warning);
        }
        Ok(Loaded { value: mesh, warnings: self.warnings })
    }

    /// Warns of parts that are opaque here and transparent in their file.
    fn warn_transparent(&mut self, vertices: &[Vec3], names: &[String]) {
        if self.transparent.is_empty() {
            return;
        }
        let (mut whole, mut opaque) = (0.0, 0.0);
        let mut parts: IndexMap<&str, &str> = IndexMap::new();
        for (corners, part) in self.triangles.iter().zip(&self.parts) {
            let [a, b, c] = corners.map(|corner| vertices[corner as usize].as_dvec3());
            let area = 0.5 * (b - a).cross(c - a).length();
            whole += area;
            if let Some(how) = self.transparent.get(part) {
                opaque += area;
                parts.insert(&names[*part as usize], how);
            }
        }
        if parts.is_empty() {
            return;
        }
        let shown = parts.iter().take(MOST_SHOWN).map(|(name, how)| format!("`{name}` ({how})"));
        let mut shown = shown.collect::<Vec<_>>().join(", ");
        if parts.len() > MOST_SHOWN {
            shown = format!("{shown} and {} more", parts.len() - MOST_SHOWN);
        }
        let share = 100.0 * opaque / whole;
        self.warn(&format!(
            "transparency is not read: {shown} of this file are taken as opaque, {opaque:.4} m² of \
             {whole:.4} m² ({share:.1} %); model the outlines of leaves, or make their cards smaller so \
             that these have the area of the leaves"
        ));
    }

    fn keep_triangles(&mut self, keep: impl Fn(&[DVec3], [u32; 3]) -> bool) {
        let mut kept = 0;
        for index in 0..self.triangles.len() {
            if keep(&self.vertices, self.triangles[index]) {
                self.triangles[kept] = self.triangles[index];
                self.parts[kept] = self.parts[index];
                kept += 1;
            }
        }
        self.triangles.truncate(kept);
        self.parts.truncate(kept);
    }

    /// Returns the new origin, from corners of triangles alone: other vertices do not count.
    fn origin(&self, import: &Import) -> DVec3 {
        if import.origin == Origin::File {
            return DVec3::ZERO;
        }
        let corners = self.triangles.iter().flatten().map(|&corner| self.vertices[corner as usize]);
        let bounds = corners.map(|v| (v, v)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        let (low, high) = bounds.unwrap_or_default();
        (0.5 * (low + high)).with_z(low.z)
    }

    /// Makes a mesh of the triangles, sorted by part, without unused vertices; parts are in order of appearance.
    fn mesh(&mut self, vertices: &[Vec3], names: &[String]) -> Mesh {
        let mut merged: IndexMap<&str, u32> = IndexMap::new();
        let part_of: Vec<usize> =
            names.iter().map(|name| merged.insert_full(name.as_str(), 0).0).collect();
        for &part in &self.parts {
            merged[part_of[part as usize]] += 1;
        }
        let mut parts = Vec::new();
        let mut next = Vec::new();
        let mut end = 0;
        let mut empty = Vec::new();
        for (&name, &count) in &merged {
            next.push(end);
            end += count;
            if count == 0 {
                empty.push(name);
                continue;
            }
            parts.push(MeshPart {
                name: name.to_owned(),
                triangles: end - count..end,
                discs: 0..0,
            });
        }
        if let Some(first) = empty.first() {
            let what = match empty.len() {
                1 => format!("part {first:?} has no triangle and was left out"),
                count => {
                    format!("{count} parts have no triangle and were left out, first {first:?}")
                }
            };
            self.warnings.push(format!("{}: {what}", self.file.display()));
        }

        let mut new_of = vec![UNUSED; vertices.len()];
        for &corner in self.triangles.iter().flatten() {
            new_of[corner as usize] = 0;
        }
        let mut used = Vec::new();
        for (new, &vertex) in new_of.iter_mut().zip(vertices).filter(|(new, _)| **new != UNUSED) {
            *new = used.len() as u32;
            used.push(vertex);
        }
        let mut triangles = vec![[0; 3]; self.triangles.len()];
        for (corners, &part) in self.triangles.iter().zip(&self.parts) {
            let place = &mut next[part_of[part as usize]];
            triangles[*place as usize] = corners.map(|corner| new_of[corner as usize]);
            *place += 1;
        }
        Mesh { vertices: used, triangles, discs: Vec::new(), parts }
    }
}

/// Returns a warning for a mesh so far from its origin that f32 keeps less than 0.1 mm.
pub(super) fn coarse(file: &Path, mesh: &Mesh, origin: &Origin) -> Option<String> {
    let (low, high) = mesh.bounds()?;
    let far = low.abs().max(high.abs()).max_element();
    let advice = match origin {
        Origin::File => "; its own place is better kept out of it (origin: BaseCenter)",
        Origin::BaseCenter => "; check the length of its unit",
    };
    (far >= COARSE).then(|| {
        format!(
            "{}: coordinates reach {far} m from the origin, where less than 0.1 mm is kept{advice}",
            file.display()
        )
    })
}

/// Returns the first coordinate that f32 cannot hold.
pub(super) fn too_far(vertex: DVec3) -> Option<f64> {
    // A quarter of the range, so that differences and sums of two stay inside it.
    let far = f64::from(f32::MAX) / 4.0;
    vertex.to_array().into_iter().find(|value| value.is_nan() || value.abs() > far)
}

pub(super) fn has_area([a, b, c]: [DVec3; 3]) -> bool {
    // Scaled to its longest edge, so that the square of no lawful area underflows.
    let (ab, ac) = (b - a, c - a);
    let longest = ab.abs().max(ac.abs()).max_element();
    longest > 0.0 && (ab / longest).cross(ac / longest) != DVec3::ZERO
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "powers of two and their products are exact")]
mod tests {
    use glam::DMat3;

    use super::*;

    #[test]
    fn every_axis_is_a_rotation_that_takes_its_axis_up() {
        for (up, axis) in [(Axis::X, DVec3::X), (Axis::Y, DVec3::Y), (Axis::Z, DVec3::Z)] {
            let import = Import { up, unit_m: 2.0, origin: Origin::File };
            let columns = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| import.point(axis));
            let [x, y, z] = columns;
            assert_eq!(DMat3::from_cols(x, y, z).determinant(), 8.0, "{import:?}");
            assert_eq!(import.point(axis), 2.0 * DVec3::Z, "{import:?}");
        }
        let north = Import { up: Axis::Y, unit_m: 1.0, origin: Origin::File };
        assert_eq!(north.point(DVec3::NEG_Z), DVec3::Y);
    }

    #[test]
    fn tiny_triangles_have_an_area_and_flat_ones_have_none() {
        let at = |x: f64, y: f64| DVec3::new(x, y, 0.0);
        assert!(has_area([at(0.0, 0.0), at(1e-30, 0.0), at(0.0, 1e-30)]));
        assert!(!has_area([at(0.0, 0.0), at(1.0, 1.0), at(3.0, 3.0)]));
        assert!(!has_area([at(0.0, 0.0), at(0.0, 0.0), at(1.0, 2.0)]));
    }
}
