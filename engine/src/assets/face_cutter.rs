//! Faces of a file, cut into triangles.

use crate::counts::{agreeing, counted, noun_of};
use glam::DVec3;

use super::AssetError;
use super::import::MeshCollector;
use super::polygon::{Pieces, Tangled, triangulate};

/// Most corners of a face: cutting a concave polygon takes the square of them.
pub(super) const MOST_CORNERS: usize = 2048;

/// Error of a face that cannot be cut.
pub(super) enum CutError {
    /// Its outline crosses itself too often.
    Tangled,
    /// A point where it crosses itself has a coordinate that f32 cannot hold, m.
    TooFar(f64),
    /// The mesh is full.
    Mesh(AssetError),
}

impl From<AssetError> for CutError {
    fn from(error: AssetError) -> Self {
        Self::Mesh(error)
    }
}

/// Cuts faces, and counts those whose outline crosses itself.
#[derive(Default)]
pub(super) struct FaceCutter {
    /// Number of faces that cross themselves, and the smallest number of one.
    pub(super) crossed: (usize, usize),
    // Buffers that are reused from face to face.
    polygon: Vec<u32>,
    points: Vec<DVec3>,
    pieces: Pieces,
}

impl FaceCutter {
    /// Adds the triangles of a face to a mesh: `corners` are its vertices, `number` its line or its own number.
    ///
    /// Returns false, and adds nothing, if that takes new vertices and `may_add_vertices` is false.
    pub(super) fn cut(
        &mut self,
        mesh: &mut MeshCollector,
        corners: impl Iterator<Item = u32>,
        number: usize,
        part: u32,
        may_add_vertices: bool,
    ) -> Result<bool, CutError> {
        self.polygon.clear();
        for index in corners {
            if self.polygon.last() != Some(&index) {
                self.polygon.push(index);
            }
        }
        self.points.clear();
        self.points.extend(self.polygon.iter().map(|&index| mesh.vertices[index as usize]));
        triangulate(&self.points, &mut self.pieces).map_err(|Tangled| CutError::Tangled)?;
        let crossings = self.pieces.crossings.len();
        if crossings > 0 && !may_add_vertices {
            return Ok(false);
        }
        if self.pieces.is_crossed {
            let (count, first) = self.crossed;
            // Faces that need new vertices may come last.
            let first = if count == 0 { number } else { first.min(number) };
            self.crossed = (count + 1, first);
        }
        if self.pieces.triangles.is_empty() {
            // A face without area, such as one of repeated corners: as a triangle it is dropped and counted.
            let index = self.polygon[0];
            mesh.add_triangle([index; 3], part)?;
        }
        let first = mesh.reserve(crossings)?;
        for &crossing in &self.pieces.crossings {
            mesh.add_vertex(crossing).map_err(CutError::TooFar)?;
        }
        self.polygon.extend((0..crossings as u32).map(|crossing| first + crossing));
        for piece in &self.pieces.triangles {
            mesh.add_triangle(piece.map(|place| self.polygon[place]), part)?;
        }
        Ok(true)
    }

    /// Warns of faces that cross themselves; `place` is what their numbers are, `line` or `face`.
    pub(super) fn warn_crossed(&self, mesh: &mut MeshCollector, place: &str) {
        let (crossed, first) = self.crossed;
        if crossed > 0 {
            mesh.warn(&format!(
                "the {} of {} (first: {place} {first}); what {} counts once: check the order of corners",
                noun_of(crossed, "outline"),
                format_args!(
                    "{} {}",
                    counted(crossed, "face"),
                    agreeing(crossed, "crosses itself", "cross themselves")
                ),
                agreeing(crossed, "it encloses", "they enclose")
            ));
        }
    }
}
