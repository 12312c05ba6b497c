use glam::DVec2;

/// A polygon on the ground: an outline and its holes, each a ring of corners, m. The last corner of
/// a ring is joined to the first. A point is inside if a ray from it crosses the rings an odd number
/// of times, so the sense of turning is of no account.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polygon {
    /// The outline, then the holes.
    pub rings: Vec<Vec<DVec2>>,
}

/// A rectangle on the ground, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    /// South-west corner.
    pub min: DVec2,
    /// North-east corner.
    pub max: DVec2,
}

impl Rectangle {
    /// Extent to the east and to the north, m.
    #[must_use]
    pub fn size(self) -> DVec2 {
        self.max - self.min
    }

    /// The point at these fractions of its sides.
    #[must_use]
    pub fn at(self, u: f64, v: f64) -> DVec2 {
        self.min + self.size() * DVec2::new(u, v)
    }
}

impl From<Rectangle> for Polygon {
    fn from(Rectangle { min, max }: Rectangle) -> Self {
        Self { rings: vec![vec![min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)]] }
    }
}
