use glam::{DMat3, DVec2, DVec3};

use super::{Mesh, PartMaterials};

/// A projection as ENVI's `map info` names it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Projection {
    /// First item, such as `UTM`.
    pub name: String,
    /// Items between the size of a cell and the units, such as `13, North, WGS-84`.
    pub rest: String,
    /// Number in the registry of EPSG, if it is known.
    pub epsg: Option<u32>,
    /// Well-known text of the system, if it is known.
    pub wkt: Option<String>,
}

/// The ground over a rectangle, which is also the tile of a periodic scene and the reference area on
/// which irradiance is counted.
#[derive(Clone, Debug, PartialEq)]
pub struct TerrainPatch {
    /// South-west corner, m, local frame.
    pub corner: DVec2,
    /// Extent to the east and to the north, m.
    pub size: DVec2,
    /// Height of the mesh's zero, m, local frame.
    pub base: f64,
    /// Length of the mesh's unit of height, m.
    pub unit: f64,
    /// The surface: x and y in units of the extent, so that its edges are exactly 0 and 1; the front
    /// of each triangle is the side of the air.
    pub mesh: Mesh,
    /// Material of each part of the mesh.
    pub materials: PartMaterials,
    /// Projection of the coordinates that `corner` and the scene's anchor add up to, if its raster
    /// tells.
    pub projection: Option<Projection>,
    /// First of the triangles, up to the last one, that are no ground but the faces along which an
    /// isolated ground is cut out of the earth; light that arrives there is lost.
    pub first_cut: u32,
}

impl TerrainPatch {
    /// Linear part of `world_from_object` of the mesh. The ray engine rounds its inverse to `f32`; the ground
    /// is never the shorter for it, which would be a gap along the seam of a periodic scene.
    #[must_use]
    pub fn world_from_object(&self) -> DMat3 {
        DMat3::from_diagonal(self.size.map(reaching).extend(self.unit))
    }

    /// World position of the mesh's origin, m.
    #[must_use]
    pub fn origin(&self) -> DVec3 {
        self.corner.extend(self.base)
    }

    /// Lowest height of the ground, m.
    #[must_use]
    pub fn lowest(&self) -> f64 {
        let heights = self.mesh.vertices.iter().map(|v| f64::from(v.z));
        self.base + self.unit * heights.reduce(f64::min).unwrap_or(0.0)
    }

    /// Highest height of the ground, m.
    #[must_use]
    pub fn highest(&self) -> f64 {
        let heights = self.mesh.vertices.iter().map(|v| f64::from(v.z));
        self.base + self.unit * heights.reduce(f64::max).unwrap_or(0.0)
    }

    /// Mean height of the ground, weighted by horizontal area, m. Cut faces, which are vertical, have
    /// none, and holes have no height.
    #[must_use]
    pub fn mean_height(&self) -> f64 {
        let lowest = self.lowest();
        let (mut volume, mut area) = (0.0, 0.0);
        for (horizontal, height) in self.ground_triangles() {
            // Above the lowest ground, so that a level plain keeps its height to the last bit.
            volume += horizontal * (self.base + self.unit * height - lowest);
            area += horizontal;
        }
        if area > 0.0 { lowest + volume / area } else { lowest }
    }

    /// Returns whether the ground leaves out some of the rectangle, by more than the rounding of its corners.
    #[must_use]
    pub fn has_holes(&self) -> bool {
        self.ground_triangles().map(|(horizontal, _)| horizontal).sum::<f64>() < 1.0 - 1e-6
    }

    /// Horizontal area, as a fraction of the rectangle, and mean height in the mesh's units of each
    /// triangle of the ground.
    fn ground_triangles(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        let triangles = self.mesh.triangles.iter().take(self.first_cut as usize);
        triangles.map(|triangle| {
            let [a, b, c] = triangle.map(|v| self.mesh.vertices[v as usize].as_dvec3());
            let horizontal = 0.5 * (b - a).truncate().perp_dot((c - a).truncate()).abs();
            (horizontal, (a.z + b.z + c.z) / 3.0)
        })
    }
}

/// The least length that is not below this one and the inverse of an `f32`.
fn reaching(length: f64) -> f64 {
    let inverse = (1.0 / length) as f32;
    let is_short = f64::from(inverse) * length > 1.0;
    1.0 / f64::from(if is_short { inverse.next_down() } else { inverse })
}

#[cfg(test)]
mod tests {
    use super::reaching;

    /// In `f32`, a tenth is more than a tenth: a plane of 10 m would end 0.15 µm before its edge.
    #[test]
    #[expect(clippy::float_cmp, reason = "a power of two stays what it is")]
    fn rounding_never_makes_the_ground_shorter() {
        assert_eq!(reaching(8.0), 8.0);
        for step in 1..100_000 {
            let length = 0.01 * f64::from(step);
            let reached = 1.0 / f64::from((1.0 / reaching(length)) as f32);
            assert!(reached >= length * (1.0 - f64::EPSILON), "{length}: {reached}");
            assert!(reached <= length * (1.0 + 2.4e-7), "{length}: {reached}");
        }
    }
}
