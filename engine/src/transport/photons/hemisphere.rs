use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec3;

/// The upper hemisphere cut into cells of equal solid angle: rings of nearly square cells, and a cap.
///
/// Source: Beckers and Beckers (2012), "A general rule for disk and hemisphere partition into
/// equal-area cells", Comput. Geom. 45; LESS manual eq. 4. Ring counts are rounded and radii follow
/// from them, so that areas are equal exactly.
#[derive(Clone, Debug, PartialEq)]
pub struct Hemisphere {
    rings: Vec<Ring>,
    cells: usize,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Ring {
    first: usize,
    count: usize,
    cos_outer: f64,
    cos_inner: f64,
}

/// One cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Zenith angles of its borders, rad.
    pub zenith: (f64, f64),
    /// Azimuths of its borders, clockwise from north, rad.
    pub azimuth: (f64, f64),
    /// `∫ cos θ dω` over the cell, sr.
    pub projected_solid_angle: f64,
}

impl Cell {
    /// Zenith angle of the circle that halves the cell, rad.
    #[must_use]
    pub fn zenith_center(&self) -> f64 {
        (0.5 * (self.zenith.0.cos() + self.zenith.1.cos())).acos()
    }

    /// Azimuth of its middle, rad.
    #[must_use]
    pub fn azimuth_center(&self) -> f64 {
        0.5 * (self.azimuth.0 + self.azimuth.1)
    }
}

impl Hemisphere {
    /// Cuts the hemisphere into this many cells.
    ///
    /// # Panics
    /// If `cells` is 0.
    #[must_use]
    pub fn new(cells: usize) -> Self {
        assert!(cells > 0, "a hemisphere has cells");
        let cos_within = |inside: usize| 1.0 - inside as f64 / cells as f64;
        let mut rings = Vec::new();
        let mut inside = cells;
        let mut zenith = FRAC_PI_2;
        while inside > 0 {
            // Eq. 4: the ring is as high as its cells are wide.
            let next = zenith - 2.0 * (zenith / 2.0).sin() * (PI / inside as f64).sqrt();
            let ratio = ((next.max(0.0) / 2.0).sin() / (zenith / 2.0).sin()).powi(2);
            let left = (inside as f64 * ratio).round() as usize;
            // Two or fewer cells are the cap.
            let left = if inside <= 2 || next <= 0.0 { 0 } else { left.min(inside - 1) };
            rings.push(Ring {
                first: cells - inside,
                count: inside - left,
                cos_outer: cos_within(inside),
                cos_inner: cos_within(left),
            });
            inside = left;
            zenith = cos_within(inside).clamp(-1.0, 1.0).acos();
        }
        Self { rings, cells }
    }

    /// Number of cells.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.cells
    }

    /// Never: a hemisphere has cells.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        false
    }

    /// Cell that holds an upward direction.
    #[must_use]
    pub fn index(&self, direction: DVec3) -> usize {
        let ring = self.rings.partition_point(|ring| ring.cos_inner <= direction.z);
        let ring = self.rings[ring.min(self.rings.len() - 1)];
        let azimuth = direction.x.atan2(direction.y).rem_euclid(TAU);
        let cell = (azimuth / TAU * ring.count as f64) as usize;
        ring.first + cell.min(ring.count - 1)
    }

    /// All cells, from the horizon to the zenith.
    pub fn cells(&self) -> impl Iterator<Item = Cell> {
        self.rings.iter().flat_map(|ring| {
            (0..ring.count).map(move |i| {
                let border = |i: usize| i as f64 / ring.count as f64 * TAU;
                let width = TAU / ring.count as f64;
                Cell {
                    zenith: (ring.cos_inner.acos(), ring.cos_outer.acos()),
                    azimuth: (border(i), border(i + 1)),
                    projected_solid_angle: 0.5
                        * width
                        * (ring.cos_inner.powi(2) - ring.cos_outer.powi(2)),
                }
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use glam::DVec3;

    use super::Hemisphere;

    #[test]
    fn cells_have_equal_solid_angles_and_cover_the_hemisphere() {
        for n in [1, 2, 3, 7, 150, 1000, 9973] {
            let hemisphere = Hemisphere::new(n);
            let cells: Vec<_> = hemisphere.cells().collect();
            assert_eq!(cells.len(), n);
            for cell in &cells {
                let solid =
                    (cell.zenith.0.cos() - cell.zenith.1.cos()) * (cell.azimuth.1 - cell.azimuth.0);
                assert!((solid * n as f64 / TAU - 1.0).abs() < 1e-9, "{n}: {cell:?}");
            }
            let projected: f64 = cells.iter().map(|cell| cell.projected_solid_angle).sum();
            assert!((projected - PI).abs() < 1e-9, "{n}: {projected}");
        }
    }

    #[test]
    fn a_direction_lies_within_the_borders_of_its_cell() {
        let hemisphere = Hemisphere::new(150);
        let cells: Vec<_> = hemisphere.cells().collect();
        for i in 0..1000 {
            let cos = (f64::from(i) + 0.5) / 1000.0;
            let azimuth = f64::from(i) * 2.399_963;
            let sin = (1.0 - cos * cos).sqrt();
            let direction = DVec3::new(sin * azimuth.sin(), sin * azimuth.cos(), cos);
            let cell = cells[hemisphere.index(direction)];
            let (zenith, azimuth) = (cos.acos(), azimuth.rem_euclid(TAU));
            assert!(cell.zenith.0 <= zenith && zenith <= cell.zenith.1, "{zenith} {cell:?}");
            assert!(cell.azimuth.0 <= azimuth && azimuth <= cell.azimuth.1, "{azimuth} {cell:?}");
        }
    }

    /// Cells are nearly square: all but the cap's are at most 1.6 times as long as wide.
    #[test]
    fn cells_are_nearly_square() {
        for cell in Hemisphere::new(150).cells().filter(|cell| cell.zenith.0 > 0.2) {
            let height = cell.zenith.1 - cell.zenith.0;
            let width = (cell.azimuth.1 - cell.azimuth.0) * cell.zenith_center().sin();
            assert!((0.6..1.7).contains(&(height / width)), "{cell:?}");
        }
    }
}
